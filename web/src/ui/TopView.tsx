/** The live top view: the picture, what the column is about, its numbers, and the legend of what is drawn. */
import { createEffect, createMemo, createSignal, For, onCleanup, onMount, Show, untrack, type Accessor, type JSX } from "solid-js";
import { language, words } from "../i18n";
import { labelOf } from "../lib/labels";
import { clauses } from "../lib/reasonWords";
import { decimal, metres, pair, span } from "../lib/format";
import type { Layout } from "../lib/layout";
import { TrailKeeper, type Trails } from "../lib/trails";
import type { Live } from "../live/live";
import { Arena, type ArenaPicture, type Ghost, type Layers } from "./Arena";

/** The picture of the newest snapshot, with the trails that led to it. */
export function livePicture(live: Live, ghost: Accessor<Ghost | null>): Accessor<ArenaPicture> {
  const keeper = new TrailKeeper();
  const trails = createMemo((): Trails => {
    const snapshot = live.newest();
    if (snapshot !== null) keeper.take(snapshot, snapshot.at_micros);
    return keeper.trails();
  });
  return createMemo(() => ({
    state: live.newest(),
    scene: live.scene()?.scene ?? null,
    shape: live.server()?.shape ?? null,
    trails: trails(),
    ghost: ghost(),
  }));
}

/** Picture, activity, numbers and legend. */
export function TopView(props: { readonly live: Live; readonly picture: Accessor<ArenaPicture>; readonly layout: Layout }): JSX.Element {
  const layers = createMemo(
    (): Layers => {
      const shown = (layer: keyof Layers): boolean => props.layout.flag(`layer_${layer}`, true);
      return { trails: shown("trails"), zones: shown("zones"), path: shown("path"), labels: shown("labels") };
    },
  );
  const stale = createMemo(() => {
    const freshness = props.live.freshness();
    return freshness.kind === "stale" ? freshness : null;
  });
  const numbers = (): ReturnType<typeof columnNumbers> => columnNumbers(props.live);
  const side = (): boolean => props.layout.flag("side_view", false);
  // On a low screen the side view takes the legend's place, unless somebody wants both.
  const legend = (): boolean => props.layout.flag("legend", !(side() && window.innerHeight < LOW_PX));
  const ghosted = createMemo(() => (props.picture().ghost ?? null) !== null);

  return (
    <section class="panel desk-picture" aria-label={words().live.topView}>
      <div class="picture-head">
        <ActivityLine live={props.live} />
        <dl class="column-numbers fades">
          <For each={["position", "speed", "target", "current"] as const}>
            {(name) => (
              <div>
                <dt>{words().live[name]}</dt>
                <dd data-testid={`column-${name}`}>{numbers()[name]}</dd>
              </div>
            )}
          </For>
        </dl>
      </div>
      <div class="canvas-frame">
        <Arena picture={props.picture} layers={layers} label={() => describe(props.live)} describedBy="top-view-summary" testId="top-view" listsKeys>
          <Show when={stale()}>
            {(freshness) => (
              <div class="stale-stamp" aria-hidden="true">
                <b>{words().live.stale}</b>
                <span>{words().live.old(span(freshness().ageMillis / 1000))}</span>
              </div>
            )}
          </Show>
        </Arena>
      </div>
      <Summary live={props.live} />
      <div class="desk-bar" role="group" aria-label={words().live.layers}>
        <For each={LAYERS}>
          {(layer) => (
            <Toggle name={`layer-${layer}`} on={layers()[layer]} word={words().live.layer[layer]} set={(on) => { props.layout.keep(`layer_${layer}`, on); }} />
          )}
        </For>
        <Toggle name="side-view" on={side()} word={words().live.sideView} set={(on) => { props.layout.keep("side_view", on); }} />
        <Toggle name="legend" on={legend()} word={words().live.legend} set={(on) => { props.layout.keep("legend", on); }} />
        <button type="button" class="toggle" data-testid="layout-reset" onClick={() => { props.layout.reset(); }}>
          {words().live.resetLayout}
        </button>
      </div>
      <Show when={legend()}>
        <Legend layers={layers()} ghost={ghosted()} />
      </Show>
    </section>
  );
}

function Toggle(props: { readonly name: string; readonly word: string; readonly on: boolean; readonly set: (on: boolean) => void }): JSX.Element {
  return (
    <button type="button" class="toggle" aria-pressed={props.on} data-testid={`toggle-${props.name}`} onClick={() => { props.set(!props.on); }}>
      {props.word}
    </button>
  );
}

/**
 * Where everybody is, in words, for those who do not see the picture. It changes every few seconds, and is read out only
 * to whoever has the focus in the picture.
 */
function Summary(props: { readonly live: Live }): JSX.Element {
  const [heard, setHeard] = createSignal(false);
  const [text, setText] = createSignal("");
  const tell = (): void => {
    setText(untrack(() => summaryOf(props.live)));
  };
  const focusMoved = (): void => {
    const focused = document.activeElement?.getAttribute("aria-describedby") === SUMMARY_ID;
    if (focused && !heard()) tell();
    setHeard(focused);
  };
  onMount(() => {
    tell();
    const timer = setInterval(tell, SUMMARY_EVERY_MILLIS);
    document.addEventListener("focusin", focusMoved);
    onCleanup(() => {
      clearInterval(timer);
      document.removeEventListener("focusin", focusMoved);
    });
  });
  createEffect(() => {
    language();
    tell();
  });
  return (
    <p class="unseen" id={SUMMARY_ID} data-testid="top-view-summary" aria-live={heard() ? "polite" : "off"}>
      {text()}
    </p>
  );
}

function summaryOf(live: Live): string {
  const snapshot = live.newest();
  if (snapshot === null) return words().live.nothingKnown;
  const { column, persons } = snapshot;
  const at = ([x, y]: readonly [number, number, ...number[]]): [string, string] => [decimal(x, 1), decimal(y, 1)];
  return [
    column.homed ? words().live.columnAt(...at(column.position_m)) : words().live.columnNowhere,
    ...persons.map((person) =>
      person.head_m === null ? words().live.personNowhere(person.name) : words().live.personAt(person.name, ...at(person.head_m), decimal(person.distance_m, 1)),
    ),
  ].join(" ");
}

/** What the column serves and why, large enough to read at a glance. */
export function ActivityLine(props: { readonly live: Live }): JSX.Element {
  const column = (): NonNullable<ReturnType<Live["snapshot"]>>["column"] | undefined => props.live.snapshot()?.column;
  const persons = (): NonNullable<ReturnType<Live["snapshot"]>>["persons"] => props.live.snapshot()?.persons ?? [];
  const served = (): string => {
    const [person, object] = [persons().find((entry) => entry.id === column()?.serves)?.name, column()?.committed ?? null];
    if (person === undefined) return words().live.servingNobody;
    return object === null ? person : words().live.serving(person, labelOf(props.live.scene()?.scene ?? null, object));
  };
  const reason = (): ReturnType<typeof clauses> => {
    const now = column();
    return now === undefined ? { text: "" } : clauses(now.why, now.reason, (id) => labelOf(props.live.scene()?.scene ?? null, id));
  };
  const limiting = (): string => persons().filter((person) => person.limits_column).map((person) => person.name).join(", ");
  return (
    <div class="activity-line fades" data-activity={column()?.activity}>
      <p class="activity-head">
        <b class="activity" data-testid="column-activity">
          {words().live.activities[column()?.activity ?? "released"]}
        </b>
        <span class="served" data-testid="column-serves">{served()}</span>
        <Show when={limiting() !== ""}>
          <span class="limited" data-testid="column-limited">{words().live.limitedBy(limiting())}</span>
        </Show>
      </p>
      <p class="activity-reason" lang={reason().lang} data-testid="column-reason" title={reason().text}>
        {reason().text}
      </p>
    </div>
  );
}

/** Only what the picture shows. */
function Legend(props: { readonly layers: Layers; readonly ghost: boolean }): JSX.Element {
  const keys = (): readonly (keyof ReturnType<typeof words>["live"]["key"])[] => [
    "column",
    "commanded",
    "proxy",
    "target",
    ...(props.layers.path ? (["path"] as const) : []),
    ...(props.layers.path && props.ghost ? (["ghost"] as const) : []),
    "predicted",
    "object",
    "person",
    ...(props.layers.zones ? (["radius", "required", "limit"] as const) : []),
    ...(props.layers.trails ? (["trail"] as const) : []),
    "travel",
    "keepOut",
  ];
  return (
    <ul class="legend" aria-label={words().live.legend}>
      <For each={keys()}>{(key) => <li class={`key-${key}`}>{words().live.key[key]}</li>}</For>
      <Show when={props.layers.zones}>
        <For each={["reaction", "braking", "walking", "age"] as const}>
          {(term) => <li class={`key-term term-${term}`}>{words().live.terms[term]}</li>}
        </For>
      </Show>
    </ul>
  );
}

function columnNumbers(live: Live): Record<"position" | "speed" | "target" | "current", string> {
  const column = live.snapshot()?.column;
  if (column === undefined) return { position: "–", speed: "–", target: "–", current: "–" };
  const [x, y] = column.position_m;
  const [vx, vy] = column.velocity_mps;
  return {
    position: column.homed ? `${pair([x, y], 2)} m` : words().live.notHomed,
    speed: `${metres(Math.hypot(vx, vy))} m/s`,
    target: column.target_m === null ? words().live.none : `${pair([column.target_m[0], column.target_m[1]], 2)} m`,
    current: `${pair([column.current_amps[0], column.current_amps[1]], 1)} A`,
  };
}

function describe(live: Live): string {
  const snapshot = live.snapshot();
  return snapshot === null ? words().live.nothingKnown : words().live.seen(snapshot.persons.length, snapshot.objects.length);
}

const LAYERS = ["trails", "zones", "path", "labels"] as const;
const SUMMARY_ID = "top-view-summary";
const LOW_PX = 860;
const SUMMARY_EVERY_MILLIS = 4000;
