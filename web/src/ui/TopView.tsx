/** The live top view: the picture, what the column is about, its numbers, and the legend of what is drawn. */
import { createMemo, For, Show, type JSX } from "solid-js";
import { words } from "../i18n";
import { labelOf } from "../lib/labels";
import { metres, span } from "../lib/format";
import { TrailKeeper } from "../lib/trails";
import type { Live } from "../live/live";
import { Arena, type ArenaPicture, type Ghost, type Layers } from "./Arena";
import { ALL_LAYERS } from "./drawing/picture";

/** Picture, activity, numbers and legend. */
export function TopView(props: { readonly live: Live; readonly ghost?: Ghost | null; readonly layers?: Layers }): JSX.Element {
  const keeper = new TrailKeeper();
  const layers = (): Layers => props.layers ?? ALL_LAYERS;
  const picture = createMemo((): ArenaPicture => {
    const snapshot = props.live.newest();
    if (snapshot !== null) keeper.take(snapshot, snapshot.at_micros);
    return {
      state: snapshot,
      scene: props.live.scene()?.scene ?? null,
      shape: props.live.server()?.shape ?? null,
      trails: keeper.trails(),
      ghost: props.ghost ?? null,
    };
  });
  const stale = createMemo(() => {
    const freshness = props.live.freshness();
    return freshness.kind === "stale" ? freshness : null;
  });
  const numbers = (): ReturnType<typeof columnNumbers> => columnNumbers(props.live);

  return (
    <section class="panel top-view" aria-label={words().live.topView}>
      <ActivityLine live={props.live} />
      <div class="canvas-frame">
        <Arena picture={picture} layers={layers} label={() => describe(props.live)} testId="top-view">
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
      <Legend layers={layers()} ghost={props.ghost !== undefined && props.ghost !== null} />
    </section>
  );
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
      <p class="activity-reason" lang="en" data-testid="column-reason" title={column()?.reason}>
        {column()?.reason ?? ""}
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
    position: column.homed ? `${metres(x)}, ${metres(y)} m` : words().live.notHomed,
    speed: `${metres(Math.hypot(vx, vy))} m/s`,
    target: column.target_m === null ? words().live.none : `${metres(column.target_m[0])}, ${metres(column.target_m[1])} m`,
    current: `${column.current_amps[0].toFixed(1)}, ${column.current_amps[1].toFixed(1)} A`,
  };
}

function describe(live: Live): string {
  const snapshot = live.snapshot();
  return snapshot === null ? words().live.nothingKnown : words().live.seen(snapshot.persons.length, snapshot.objects.length);
}
