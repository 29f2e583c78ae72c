/**
 * One session from its recording: the arena as it was at a time, and what happened. It never looks live: a banner, its
 * own frame, and no picture where nothing was recorded. It sends nothing to the machine.
 */
import { createEffect, createMemo, createSignal, For, on, onCleanup, Show, untrack, type JSX } from "solid-js";
import { exportAddress, listSessionEvents, readFrames, readScene, readSession } from "../../api/http";
import type { RecordedFrame, SceneDocument, SessionDetail, WireEvent } from "../../api/types";
import { words } from "../../i18n";
import { dayAndTime, decimal, metres, span } from "../../lib/format";
import { labelOf } from "../../lib/labels";
import { clockOf, play, playerAt, timeBeside, type Player, type PlayerAction } from "../../lib/player";
import { densityFor, EVERY_FRAME, Recording, type Density, type Moment } from "../../lib/recording";
import { Arena } from "../Arena";
import { EventSaid } from "../EventSaid";
import { howEnded, sizeOf } from "./SessionList";
import { markOf, Transport } from "./Transport";
import { troubleOf } from "../../lib/trouble";

/** The session, standing at a time at first. */
export function Replay(props: { readonly session: SessionDetail; readonly startSecs: number; readonly seekTo: () => number | null }): JSX.Element {
  const id = props.session.id;
  const [session, setSession] = createSignal(props.session);
  const [player, setPlayer] = createSignal<Player>(playerAt(props.startSecs, lengthOf(props.session)));
  const [events, setEvents] = createSignal<readonly WireEvent[] | null>(null);
  const [eventsTrouble, setEventsTrouble] = createSignal<string | null>(null);
  const [scenes, setScenes] = createSignal<ReadonlyMap<string, SceneDocument>>(new Map());
  /** Grows when the recording knows more. */
  const [read, setRead] = createSignal(0);
  const running = (): boolean => session().ended_at === null;
  const recorded = (): boolean => session().first_micros !== null && session().recording_removed_at === null && (running() || session().recorded_frames > 0);
  const secsOf = (micros: number): number => (micros - (session().first_micros ?? 0)) / 1e6;
  let gone = false;

  const recording = new Recording(
    async (fromSecs, toSecs, everySecs, giveUp) =>
      (await readFrames(id, fromSecs, toSecs, everySecs, giveUp)).map((frame) => ({ secs: secsOf(frame.at_micros), frame })),
    lengthOf(props.session),
    untrack(running),
    () => setRead((count) => count + 1),
  );
  const act = (action: PlayerAction): void => {
    setPlayer((before) => play(before, action));
  };
  const density = createMemo((): Density => (player().playing ? densityFor(player().speed) : EVERY_FRAME));
  createEffect(() => {
    read();
    if (recorded()) recording.need(player().atSecs, density());
  });
  const moment = createMemo((): Moment => {
    read();
    return recording.at(player().atSecs, density());
  });
  /** While the next is read the last stays, marked as waiting; nothing stays over a gap. */
  const frame = createMemo((before: RecordedFrame | null): RecordedFrame | null => {
    const now = moment();
    return now.kind === "frame" ? now.frame : now.kind === "loading" ? before : null;
  }, null);
  const gaps = createMemo(() => {
    read();
    return recording.gaps(density());
  });

  // The clock, at the display's pace; it waits where the recording is still being read.
  let lastMillis: number | null = null;
  let requested = 0;
  const tick = (nowMillis: number): void => {
    const passedSecs = lastMillis === null ? 0 : (nowMillis - lastMillis) / 1000;
    lastMillis = nowMillis;
    if (untrack(moment).kind !== "loading" || untrack(player).following) act({ kind: "tick", passedSecs: Math.min(passedSecs, MOST_TICK_SECS) });
    requested = requestAnimationFrame(tick);
  };
  const going = createMemo(() => player().playing || player().following);
  createEffect(() => {
    if (!going()) return;
    lastMillis = null;
    requested = requestAnimationFrame(tick);
    onCleanup(() => { cancelAnimationFrame(requested); });
  });

  createEffect(on(props.seekTo, (toSecs) => {
    if (toSecs !== null) act({ kind: "seek", toSecs });
  }, { defer: true }));
  // The address keeps the time: at rest at once, playing now and then.
  const place = createMemo(() => (player().playing || player().following ? Math.floor(player().atSecs / 2) * 2 : Number(player().atSecs.toFixed(3))));
  let keeping: ReturnType<typeof setTimeout> | undefined;
  createEffect(on(place, (secs) => {
    clearTimeout(keeping);
    keeping = setTimeout(() => { history.replaceState(null, "", `#/sessions/${id}?t=${secs}`); }, KEEP_AFTER_MILLIS);
  }, { defer: true }));

  const readEvents = async (): Promise<void> => {
    try {
      const found = await listSessionEvents(id);
      if (gone) return;
      setEvents(found);
      setEventsTrouble(null);
    } catch (error) {
      if (!gone) setEventsTrouble(troubleOf(error));
    }
  };
  void readEvents();
  /** Polls after the end: the last of a recording is stored a moment after its session ended. */
  let polls = untrack(running) ? POLLS_AFTER_END : 0;
  const poll = setInterval(() => {
    if (!untrack(running)) polls -= 1;
    if (polls < 0) {
      clearInterval(poll);
      return;
    }
    void readSession(id).then((now) => {
      if (gone) return;
      const grew = now.last_micros !== untrack(session).last_micros;
      recording.grown(lengthOf(now), now.ended_at === null || polls > 0);
      setSession(now);
      act({ kind: "grown", lengthSecs: lengthOf(now) });
      if (now.ended_at !== null && untrack(player).following) act({ kind: "pause" });
      if (grew) void readEvents();
      setRead((count) => count + 1);
    }, () => undefined /* the next poll asks again; the page's own banner says that the server is away */);
  }, POLL_MILLIS);
  onCleanup(() => {
    gone = true;
    clearInterval(poll);
    clearTimeout(keeping);
    recording.end();
  });

  const sceneKey = createMemo(() => {
    const inForce = session().scenes.findLast(({ from_secs }) => from_secs <= player().atSecs) ?? session().scenes[0];
    return inForce === undefined ? `${session().scene_id}/${session().scene_version}` : `${inForce.id}/${inForce.version}`;
  });
  createEffect(on(sceneKey, (key) => {
    if (untrack(scenes).has(key)) return;
    const [scene, version] = key.split("/").map(Number) as [number, number];
    void readScene(scene, version).then((found) => {
      if (!gone) setScenes((known) => new Map([...known, [key, found]]));
    }, () => undefined /* the picture then has no scene; frames and events stand without it */);
  }));
  const scene = createMemo(() => scenes().get(sceneKey()) ?? null);

  const marks = createMemo(() => (events() ?? []).flatMap((event) => {
    const kind = markOf(event);
    return kind === null ? [] : [{ secs: secsOf(event.at_micros), kind }];
  }));
  const eventTimes = createMemo(() => (events() ?? []).map((event) => Math.max(0, secsOf(event.at_micros))));
  const current = createMemo(() => eventTimes().findLastIndex((secs) => secs <= player().atSecs + 0.001));
  const seek = (toSecs: number): void => {
    act({ kind: "pause" });
    act({ kind: "seek", toSecs });
  };
  const stepEvent = (by: 1 | -1): void => {
    const to = timeBeside(eventTimes(), player().atSecs, by);
    if (to !== null) seek(to);
  };
  const stepFrame = (by: 1 | -1): void => {
    const from = player().atSecs;
    act({ kind: "pause" });
    void (async () => {
      let to = recording.frameBeside(from, by);
      if (to === null) {
        await recording.every(from);
        await recording.every(from + by * EVERY_FRAME.windowSecs);
        to = recording.frameBeside(from, by);
      }
      if (to !== null && !gone) seek(to);
    })();
  };

  return (
    <div class="replay" data-testid="replay">
      <div class="replay-banner" role="note" data-testid="replay-banner">
        <b>● {words().records.replay.banner(id)}</b>
        <span>{words().records.replay.notLive}</span>
        <a href="#/sessions" data-testid="replay-back">{words().records.replay.back}</a>
      </div>
      <section class="panel replay-picture" aria-label={words().records.replay.banner(id)} classList={{ waiting: moment().kind === "loading" }}>
        <Show
          when={recorded()}
          fallback={
            <p class="empty replay-none" data-testid="no-recording">
              {session().recording_removed_at === null ? words().records.replay.noRecording : words().records.replay.removed(dayAndTime(session().recording_removed_at ?? ""))}
            </p>
          }
        >
          <div class="replay-canvas">
            <Arena
              testId="replay-arena"
              label={() => words().records.replay.picture(id, clockOf(player().atSecs))}
              picture={() => ({ state: frame(), scene: scene(), shape: session().machine_shape })}
            />
            <p class="replay-over" role="status" data-testid="replay-status" data-kind={moment().kind}>{statusOf(moment())}</p>
            <Show when={moment().kind === "failed"}>
              <button type="button" class="replay-retry" data-testid="replay-retry" onClick={() => { recording.retry(); }}>{words().records.replay.again}</button>
            </Show>
          </div>
          <Transport player={player()} act={act} marks={marks()} gaps={gaps()} running={running()} stepFrame={stepFrame} stepEvent={stepEvent} />
        </Show>
      </section>
      <div class="replay-side">
        <Facts session={session()} />
        <Show when={recorded()}><Now frame={frame()} scene={scene()} moment={moment()} /></Show>
        <section class="panel grows" aria-labelledby="session-events-title">
          <h2 id="session-events-title">{words().records.replay.events}</h2>
          <Show when={eventsTrouble()}>{(why) => <p class="answer refused" role="alert">{words().records.replay.eventsFailed(why())}</p>}</Show>
          <Show when={events()?.length === 0}><p class="empty">{words().records.replay.noEvents}</p></Show>
          <ol class="session-events scrolls" data-testid="session-events">
            <For each={events() ?? []}>
              {(event, index) => (
                <li>
                  <button
                    type="button"
                    data-kind={markOf(event) ?? event.kind}
                    data-testid="session-event"
                    aria-current={current() === index() ? "true" : undefined}
                    ref={(button) => {
                      // The list keeps to the time without taking the focus.
                      createEffect(() => {
                        if (current() === index() && button.isConnected) keepInSight(button);
                      });
                    }}
                    onClick={() => { seek(eventTimes()[index()] ?? 0); }}
                  >
                    <time>{clockOf(eventTimes()[index()] ?? 0)}</time>
                    <span class="event-kind">{kindOf(event.kind)}</span>
                    <EventSaid event={event} label={(object) => labelOf(scene(), object)} />
                  </button>
                </li>
              )}
            </For>
          </ol>
        </section>
      </div>
    </div>
  );
}

/** What is known of the session as a whole, and the ways to take it away. */
function Facts(props: { readonly session: SessionDetail }): JSX.Element {
  const say = () => words().records;
  return (
    <section class="panel" aria-label={say().replay.facts(props.session.id)}>
      <dl class="session-facts" data-testid="session-facts">
        <Fact name={say().sessions.began} value={dayAndTime(props.session.started_at)} />
        <Fact name={say().sessions.lasted} value={span(lengthOf(props.session))} />
        <Fact name={say().sessions.served} value={say().sessions.servedOf(props.session.reaches_served, props.session.reaches)} />
        <Fact name={say().sessions.stops} value={String(props.session.stops)} />
        <Fact name={say().sessions.ended} value={props.session.ended_at === null ? say().sessions.running : howEnded(props.session.how)} />
        <Fact name={say().sessions.scene} value={props.session.scene} />
        <Fact name={say().replay.persons} value={props.session.persons.length === 0 ? say().replay.nobody : props.session.persons.join(", ")} />
        <Fact name={say().sessions.size} value={sizeOf(props.session)} />
      </dl>
      <Show when={props.session.dropped_frames > 0}><p class="answer">{say().replay.dropped(props.session.dropped_frames)}</p></Show>
      <p class="exports">
        <a class="button" download="" href={exportAddress(props.session.id, "csv")} data-testid="export-csv">{say().replay.exportCsv}</a>
        <a class="button" download="" href={exportAddress(props.session.id, "json")} data-testid="export-json">{say().replay.exportJson}</a>
      </p>
    </section>
  );
}

function Fact(props: { readonly name: string; readonly value: string }): JSX.Element {
  return (
    <div>
      <dt>{props.name}</dt>
      <dd>{props.value}</dd>
    </div>
  );
}

/** The moment in words and weights. */
function Now(props: { readonly frame: RecordedFrame | null; readonly scene: SceneDocument | null; readonly moment: Moment }): JSX.Element {
  const say = () => words().records.replay;
  const served = (): string => {
    const { frame } = props;
    if (frame === null || frame.column.serves === null) return say().nothing;
    return frame.persons.find((person) => person.id === frame.column.serves)?.name ?? String(frame.column.serves);
  };
  const committed = (): string | null => props.frame?.column.committed ?? null;
  return (
    <section class="panel" aria-labelledby="now-title">
      <h2 id="now-title">{say().weights}</h2>
      <dl class="session-facts" data-testid="replay-now">
        <Fact name={say().mode} value={props.frame === null ? say().nothing : say().modes[props.frame.mode]} />
        <Fact name={say().serves} value={served()} />
        <Fact name={say().committed} value={committed() === null ? say().nothing : labelOf(props.scene, committed() ?? "")} />
        <Fact name={say().speedNow} value={props.frame === null ? say().nothing : `${metres(Math.hypot(...props.frame.column.velocity_mps))} m/s`} />
      </dl>
      <Show when={props.frame}>
        {(frame) => (
          <div class="scrolls now-weights" role="group" tabindex="0" aria-labelledby="now-title">
          <table data-testid="replay-weights">
            <thead>
              <tr>
                <th scope="col">{say().object}</th>
                <th scope="col" class="number">{say().weight}</th>
                <th scope="col" class="number">{say().share}</th>
                <th scope="col" class="number">{say().prior}</th>
              </tr>
            </thead>
            <tbody>
              <For each={frame().objects.map(({ id }) => id)}>
                {(objectId) => {
                  const object = () => frame().objects.find((entry) => entry.id === objectId);
                  return (
                    <tr classList={{ predicted: committed() === objectId }}>
                      <th scope="row">{labelOf(props.scene, objectId)}</th>
                      <td class="number weight" style={{ "--share": String(object()?.probability ?? 0) }}>{twoDigits(object()?.weight)}</td>
                      <td class="number">{Math.round((object()?.probability ?? 0) * 100)} %</td>
                      <td class="number">{twoDigits(object()?.prior)}</td>
                    </tr>
                  );
                }}
              </For>
            </tbody>
          </table>
          </div>
        )}
      </Show>
      <small data-testid="replay-source">
        {props.moment.kind === "frame" ? `${say().recordedAt(clockOf(props.moment.recordedSecs))}${props.moment.interpolated ? `, ${say().between}` : ""}` : " "}
      </small>
    </section>
  );
}

/** How long a session is, s: its recording may end after the last that its row knows. */
export function lengthOf(session: SessionDetail): number {
  const recorded = session.first_micros === null || session.last_micros === null ? 0 : (session.last_micros - session.first_micros) / 1e6;
  // Of a running session only what is stored can be shown.
  return Math.max(0, session.ended_at === null ? recorded : Math.max(recorded, session.length_secs ?? 0));
}

function statusOf(moment: Moment): string {
  const say = words().records.replay;
  switch (moment.kind) {
    case "frame":
      return "";
    case "loading":
      return say.loading;
    case "failed":
      return say.failed(moment.detail);
    case "gap":
      if (moment.fromSecs === null) return moment.toSecs === null ? say.gapNothing : say.gapFromStart(clockOf(moment.toSecs));
      return moment.toSecs === null ? say.gapToEnd(clockOf(moment.fromSecs)) : say.gap(clockOf(moment.fromSecs), clockOf(moment.toSecs));
  }
}

function kindOf(kind: string): string {
  return words().records.replay.kinds[kind] ?? kind.replaceAll("_", " ");
}

/** Scrolls its list, and nothing else, as far as it must. */
function keepInSight(button: HTMLElement): void {
  const list = button.closest("ol");
  if (list === null) return;
  const [inner, outer] = [button.getBoundingClientRect(), list.getBoundingClientRect()];
  if (inner.top < outer.top) list.scrollTop -= outer.top - inner.top;
  else if (inner.bottom > outer.bottom) list.scrollTop += inner.bottom - outer.bottom;
}

function twoDigits(value: number | undefined): string {
  return value === undefined ? "" : decimal(value, 2);
}

/** A page that slept does not leap. */
const MOST_TICK_SECS = 0.25;
const KEEP_AFTER_MILLIS = 250;
const POLL_MILLIS = 1000;
const POLLS_AFTER_END = 4;
