/** What each object weighs, and weighed over the last minute; which one the column was committed to, and when it was served. */
import { createMemo, createSignal, For, Show, type JSX } from "solid-js";
import type { ObjectState, SceneDocument } from "../api/types";
import { words } from "../i18n";
import { decimal, percent } from "../lib/format";
import { labelOf } from "../lib/labels";
import { createRing, nowMicros } from "../live/ring";
import type { Live } from "../live/live";
import { barsOf, heavierThan, NO_WEIGHTS, servedIn, weigh, type Bar } from "../live/weights";
import { WeightStrip } from "./WeightStrip";

/** A row with a strip for every object, in the scene's order. */
export function Weights(props: { readonly live: Live }): JSX.Element {
  const [search, setSearch] = createSignal("");
  const [onlyHeavy, setOnlyHeavy] = createSignal(false);
  const history = createRing(props.live, NO_WEIGHTS, weigh);
  const objects = (): readonly ObjectState[] => props.live.snapshot()?.objects ?? [];
  const scene = (): SceneDocument | null => props.live.scene()?.scene ?? null;
  const until = createMemo(() => nowMicros(props.live, REDRAWN_EVERY_MICROS));
  const served = createMemo(() => servedIn(history(), props.live.events(), until()));
  const shown = createMemo((): readonly ObjectState[] => {
    const wanted = search().trim().toLowerCase();
    const found = objects().filter(({ id }) => wanted === "" || id.toLowerCase().includes(wanted) || labelOf(scene(), id).toLowerCase().includes(wanted));
    return onlyHeavy() ? heavierThan(history(), found, HEAVY_FROM, until()) : found;
  });
  const text = (): ReturnType<typeof words>["desk"]["weights"] => words().desk.weights;

  return (
    <section class="panel grows weights" aria-labelledby="weights-title">
      <h2 id="weights-title">
        {text().title} <small>{props.live.snapshot()?.intention_rule ?? ""}</small>
        <small class="count" role="status" data-testid="weights-shown">
          {text().shown(shown().length, objects().length)}
        </small>
      </h2>
      <div class="filters">
        <input
          type="search"
          data-testid="weights-search"
          aria-label={text().search}
          placeholder={text().search}
          value={search()}
          onInput={(event) => setSearch(event.currentTarget.value)}
        />
        <button
          type="button"
          class="chip"
          data-testid="weights-heavy"
          aria-pressed={onlyHeavy()}
          title={text().onlyHeavyMeans}
          onClick={() => setOnlyHeavy((only) => !only)}
        >
          {text().onlyHeavy(decimal(HEAVY_FROM, 1))}
        </button>
      </div>
      <Show when={shown().length > 0} fallback={<p class="empty">{objects().length === 0 ? text().empty : text().nothingFound}</p>}>
        <div class="weight-head" aria-hidden="true">
          <span />
          <span>{text().lastMinute}</span>
          <span>{text().weight}</span>
          <span>{text().share}</span>
          <span title={text().lateMeans}>{text().late}</span>
        </div>
        <ul class="weight-rows scrolls fades" tabindex="0" aria-label={text().list} data-testid="weights">
          <For each={shown()}>
            {(object) => (
              <Row
                object={object}
                label={labelOf(scene(), object.id)}
                enabled={scene()?.objects.find((entry) => entry.id === object.id)?.enabled !== false}
                committed={props.live.snapshot()?.column.committed === object.id}
                bars={() => barsOf(history(), object.id, until())}
                served={() => served().get(object.id) ?? []}
              />
            )}
          </For>
        </ul>
        <ul class="weight-legend" aria-hidden="true">
          <li class="key-weight">{text().legend.weight}</li>
          <li class="key-committed">{text().legend.committed}</li>
          <li class="key-served">{text().legend.served}</li>
          <li class="key-gap">{text().legend.gap}</li>
        </ul>
      </Show>
    </section>
  );
}

function Row(props: {
  readonly object: ObjectState;
  readonly label: string;
  readonly enabled: boolean;
  readonly committed: boolean;
  readonly bars: () => readonly (Bar | null)[];
  readonly served: () => readonly number[];
}): JSX.Element {
  const late = (): number | null => props.object.late_by_s;
  const isLate = (): boolean => (late() ?? 0) >= LATE_FROM_SECS;
  return (
    <li class="weight-row" classList={{ predicted: props.committed, off: !props.enabled }} data-testid={`object-${props.object.id}`}>
      <span class="weight-name" title={props.label}>
        {props.label}
        <Show when={props.committed}>
          <span class="unseen">, {words().desk.weights.committed}</span>
        </Show>
      </span>
      <Show when={props.enabled} fallback={<span class="weight-off">{words().desk.weights.off}</span>}>
        <WeightStrip bars={props.bars} served={props.served} />
        <span class="weight-now" data-testid={`weight-${props.object.id}`}>{decimal(props.object.weight, 2)}</span>
        <span class="weight-share">{percent(props.object.probability)}</span>
        <span class="weight-late" classList={{ bad: isLate() }}>
          {late() === null || !Number.isFinite(late()) ? "–" : isLate() ? `${decimal(late() ?? 0, 1)} s` : words().desk.weights.inTime}
        </span>
      </Show>
    </li>
  );
}

/** What weighs less is of little account. */
const HEAVY_FROM = 0.1;
/** What reads as 0.1 s and more. */
const LATE_FROM_SECS = 0.05;
const REDRAWN_EVERY_MICROS = 250_000;
