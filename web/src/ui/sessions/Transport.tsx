/** The replay's controls: play, speed, steps, and a slider over the whole session with its events and gaps marked. */
import { createMemo, For, Show, type JSX } from "solid-js";
import type { WireEvent } from "../../api/types";
import { words } from "../../i18n";
import { clockOf, speedBeside, SPEEDS, type Player, type PlayerAction } from "../../lib/player";

/** What a mark on the slider stands for. */
export type MarkKind = "stop" | "served" | "touch";

/** The kind of mark that an event deserves; null for none. */
export function markOf(event: WireEvent): MarkKind | null {
  if (event.kind === "served") return "served";
  if (event.kind === "touch_began") return "touch";
  if (event.kind === "stop_pressed") return "stop";
  if (event.kind !== "mode_changed") return null;
  const to: unknown = typeof event.detail === "object" && event.detail !== null && "to" in event.detail ? event.detail.to : null;
  return to === "protective_stop" || to === "latched_stop" || to === "faulted" ? "stop" : null;
}

/** Buttons and slider. */
export function Transport(props: {
  readonly player: Player;
  readonly act: (action: PlayerAction) => void;
  readonly marks: readonly { readonly secs: number; readonly kind: MarkKind }[];
  readonly gaps: readonly (readonly [number, number])[];
  readonly running: boolean;
  readonly stepFrame: (by: 1 | -1) => void;
  readonly stepEvent: (by: 1 | -1) => void;
}): JSX.Element {
  const share = (secs: number): string => `${props.player.lengthSecs === 0 ? 0 : (Math.min(props.player.lengthSecs, secs) / props.player.lengthSecs) * 100}%`;
  /** One mark of a kind at a place, however many there are: two hours have thousands. */
  const marks = createMemo(() => {
    const taken = new Set<string>();
    return props.marks.filter(({ secs, kind }) => {
      const key = `${kind} ${Math.round((secs / Math.max(1, props.player.lengthSecs)) * PLACES)}`;
      if (taken.has(key)) return false;
      taken.add(key);
      return true;
    });
  });
  const seek = (toSecs: number): void => {
    props.act({ kind: "seek", toSecs });
  };
  const moved = (event: KeyboardEvent): void => {
    const by = STEPS[event.key];
    if (by === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    seek(by === "home" ? 0 : by === "end" ? props.player.lengthSecs : props.player.atSecs + by);
  };
  return (
    <div class="transport" role="group" aria-label={words().records.replay.time}>
      <div class="transport-line">
        <button
          type="button"
          class="play"
          data-testid="play"
          disabled={props.player.lengthSecs === 0}
          onClick={() => { props.act({ kind: props.player.playing ? "pause" : "play" }); }}
        >
          {props.player.playing ? `‖ ${words().records.replay.pause}` : `▶ ${words().records.replay.play}`}
        </button>
        <Step label={words().records.replay.eventBack} sign="|◂" testId="event-back" go={() => { props.stepEvent(-1); }} />
        <Step label={words().records.replay.frameBack} sign="◂" testId="frame-back" go={() => { props.stepFrame(-1); }} />
        <Step label={words().records.replay.frameOn} sign="▸" testId="frame-on" go={() => { props.stepFrame(1); }} />
        <Step label={words().records.replay.eventOn} sign="▸|" testId="event-on" go={() => { props.stepEvent(1); }} />
        <output class="clock" data-testid="replay-clock">
          <b>{clockOf(props.player.atSecs)}</b> / {clockOf(props.player.lengthSecs)}
        </output>
        <span class="speeds">
          <Step label={words().records.replay.slower} sign="−" testId="slower" go={() => { props.act({ kind: "speed", speed: speedBeside(props.player.speed, -1) }); }} />
          <select
            data-testid="speed"
            aria-label={words().records.replay.speed}
            onChange={(event) => { props.act({ kind: "speed", speed: Number(event.currentTarget.value) }); }}
          >
            <For each={SPEEDS}>
              {(speed) => <option value={speed} selected={props.player.speed === speed}>{words().records.replay.times(speed)}</option>}
            </For>
          </select>
          <Step label={words().records.replay.faster} sign="+" testId="faster" go={() => { props.act({ kind: "speed", speed: speedBeside(props.player.speed, 1) }); }} />
        </span>
        <Show when={props.running}>
          <button type="button" data-testid="follow" aria-pressed={props.player.following} onClick={() => { props.act({ kind: "follow", on: !props.player.following }); }}>
            {words().records.replay.follow}
          </button>
        </Show>
      </div>
      <div class="scrubber">
        <div class="marks" aria-hidden="true">
          <For each={props.gaps}>
            {([from, to]) => <i class="mark-gap" style={{ left: share(from), width: `calc(${share(to)} - ${share(from)})` }} />}
          </For>
          <For each={marks()}>{({ secs, kind }) => <i class={`mark-${kind}`} data-testid="mark" style={{ left: share(secs) }} />}</For>
        </div>
        <input
          type="range"
          data-testid="scrub"
          min="0"
          max={props.player.lengthSecs}
          step="any"
          aria-label={words().records.replay.time}
          aria-valuetext={words().records.replay.timeText(clockOf(props.player.atSecs), clockOf(props.player.lengthSecs))}
          aria-describedby="scrub-keys"
          value={props.player.atSecs}
          onInput={(event) => { seek(Number(event.currentTarget.value)); }}
          onKeyDown={moved}
        />
      </div>
      <p class="scrub-notes">
        <span class="mark-key mark-key-stop">{words().records.replay.marks.stop}</span>
        <span class="mark-key mark-key-served">{words().records.replay.marks.served}</span>
        <span class="mark-key mark-key-touch">{words().records.replay.marks.touch}</span>
        <span id="scrub-keys">{words().records.replay.keys}</span>
      </p>
    </div>
  );
}

function Step(props: { readonly label: string; readonly sign: string; readonly testId: string; readonly go: () => void }): JSX.Element {
  return (
    <button type="button" aria-label={props.label} title={props.label} data-testid={props.testId} onClick={() => { props.go(); }}>
      {props.sign}
    </button>
  );
}

const PLACES = 500;
const STEPS: Readonly<Record<string, number | "home" | "end" | undefined>> = {
  ArrowLeft: -1,
  ArrowDown: -1,
  ArrowRight: 1,
  ArrowUp: 1,
  PageDown: -10,
  PageUp: 10,
  Home: "home",
  End: "end",
};
