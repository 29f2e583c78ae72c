/** The objects: weight, probability, who will be first, column or hand, and the prior that the game master sets. */
import { createEffect, createSignal, For, Index, on, onCleanup, Show, type JSX } from "solid-js";
import { changePriors, listPriorChanges } from "../api/http";
import type { ObjectState, PriorChange } from "../api/types";
import type { Live } from "../live/live";
import { dayAndTime, lateBySecs, percent, timeOfDay } from "../lib/format";
import { labelOf } from "../lib/labels";

/** Table, sliders, and who changed what. */
export function Objects(props: { readonly live: Live; readonly author: string }): JSX.Element {
  const [changes, setChanges] = createSignal<readonly PriorChange[]>([]);
  const [trouble, setTrouble] = createSignal<string | null>(null);
  const objects = (): readonly ObjectState[] => props.live.snapshot()?.objects ?? [];
  const scene = (): NonNullable<ReturnType<Live["scene"]>>["scene"] | null => props.live.scene()?.scene ?? null;
  const frozen = (): string | null => {
    const kind = props.live.freshness().kind;
    return kind === "live" ? null : kind === "stale" ? "Stale: priors cannot be changed." : "No state yet: priors cannot be changed.";
  };
  const readChanges = async (): Promise<void> => {
    try {
      setChanges(await listPriorChanges());
    } catch (error) {
      setTrouble(`who changed what could not be read: ${messageOf(error)}`);
    }
  };
  // Anybody's change arrives as an event: the list is read again.
  createEffect(
    on(
      () => [props.live.link().phase === "open", props.live.events().find((event) => event.kind === "prior_changed")?.at],
      ([open]) => {
        if (open === true) void readChanges();
      },
    ),
  );
  const change = async (id: string, prior: number): Promise<void> => {
    setTrouble(null);
    try {
      await changePriors({ [id]: prior }, props.author);
    } catch (error) {
      setTrouble(`prior of ${labelOf(scene(), id)} not changed: ${messageOf(error)}`);
      throw error;
    }
  };

  return (
    <section class="panel grows objects" aria-labelledby="objects-title">
      <h2 id="objects-title">
        Objects <small>rule: {props.live.snapshot()?.intention_rule ?? "unknown"}</small>
      </h2>
      <div class="scrolls" tabindex="0" role="region" aria-label="Table of objects">
        <table>
          <thead>
            <tr>
              <th scope="col">object</th>
              <th scope="col" title="W, prior included">weight</th>
              <th scope="col" title="share of the weight">share</th>
              <th scope="col" title="seconds until the column could be there">column</th>
              <th scope="col" title="seconds until the visitor could touch it">touch</th>
              <th scope="col">late by</th>
              <th scope="col">prior</th>
            </tr>
          </thead>
          <tbody>
            <For each={objects()}>
              {(object) => (
                <Row
                  object={object}
                  label={labelOf(scene(), object.id)}
                  enabled={scene()?.objects.find((entry) => entry.id === object.id)?.enabled !== false}
                  predicted={props.live.snapshot()?.column.committed === object.id}
                  frozen={frozen() !== null}
                  change={(prior) => change(object.id, prior)}
                />
              )}
            </For>
          </tbody>
        </table>
      </div>
      <p class="answer" classList={{ refused: trouble() !== null }} role="status" data-testid="prior-status">
        {frozen() ?? trouble() ?? "A prior applies when the slider is let go."}
      </p>
      <Show when={changes().length > 0}>
        <details class="prior-changes">
          <summary data-testid="prior-last-change">Last prior change: {changeWords(changes()[0], scene())}</summary>
          <ul class="scrolls" data-testid="prior-changes">
            <Index each={changes()}>
              {(entry) => (
                <li>
                  <time datetime={entry().at} title={dayAndTime(entry().at)}>{timeOfDay(entry().at)}</time>{" "}
                  {changeWords(entry(), scene())}
                </li>
              )}
            </Index>
          </ul>
        </details>
      </Show>
    </section>
  );
}

function Row(props: {
  readonly object: ObjectState;
  readonly label: string;
  readonly enabled: boolean;
  readonly predicted: boolean;
  readonly frozen: boolean;
  readonly change: (prior: number) => Promise<void>;
}): JSX.Element {
  /** What the hand holds, until the server shows the same. */
  const [held, setHeld] = createSignal<number | null>(null);
  let letGo: ReturnType<typeof setTimeout> | null = null;
  const release = (): void => {
    if (letGo !== null) clearTimeout(letGo);
    letGo = null;
    setHeld(null);
  };
  onCleanup(release);
  createEffect(() => {
    const value = held();
    if (letGo !== null && value !== null && Math.abs(props.object.prior - value) < SAME_PRIOR) release();
  });
  const apply = async (prior: number): Promise<void> => {
    setHeld(prior);
    try {
      await props.change(prior);
      letGo = setTimeout(release, SHOWN_WITHIN_MILLIS);
    } catch {
      release();
    }
  };
  const late = (): number | null => lateBySecs(props.object.arrival_secs, props.object.touch_secs);
  const prior = (): number => held() ?? props.object.prior;

  return (
    <tr class="fades" classList={{ predicted: props.predicted, off: !props.enabled }} data-testid={`object-${props.object.id}`}>
      <th scope="row">
        {props.label}
        <Show when={props.predicted}>
          <span class="unseen">, predicted</span>
        </Show>
      </th>
      <td class="weight" style={{ "--share": String(Math.min(1, props.object.weight)) }}>
        {props.object.weight.toFixed(2)}
      </td>
      <Show when={props.enabled} fallback={<td colspan="4">off in this scene</td>}>
        <td>{percent(props.object.probability)}</td>
        <td>{secsOf(props.object.arrival_secs)}</td>
        <td>{props.object.touch_secs === null ? "–" : secsOf(props.object.touch_secs)}</td>
        <td classList={{ bad: isLate(late()) }}>{lateWords(late())}</td>
      </Show>
      <td>
        <div class="prior">
        <input
          type="range"
          min="0"
          max="1"
          step="0.05"
          value={prior()}
          disabled={props.frozen}
          aria-label={`Prior of ${props.label}`}
          aria-valuetext={prior().toFixed(2)}
          data-testid={`prior-${props.object.id}`}
          onInput={(event) => setHeld(event.currentTarget.valueAsNumber)}
          onChange={(event) => void apply(event.currentTarget.valueAsNumber)}
        />
        <output data-testid={`prior-value-${props.object.id}`}>{prior().toFixed(2)}</output>
        </div>
      </td>
    </tr>
  );
}

function secsOf(secs: number): string {
  return Number.isFinite(secs) && secs < 100 ? `${secs.toFixed(1)} s` : "–";
}

function isLate(late: number | null): boolean {
  return late !== null && late >= LATE_FROM_SECS;
}

function lateWords(late: number | null): string {
  if (late === null || !Number.isFinite(late)) return "–";
  return isLate(late) ? `${late.toFixed(1)} s` : "in time";
}

function changeWords(change: PriorChange | undefined, scene: Parameters<typeof labelOf>[0]): string {
  if (change === undefined) return "none";
  return `${change.author || "somebody"}: ${labelOf(scene, change.object)} ${change.from.toFixed(2)} → ${change.to.toFixed(2)}`;
}

function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

/** What reads as 0.1 s and more. */
const LATE_FROM_SECS = 0.05;
const SAME_PRIOR = 0.0005;
/** The server publishes about 30 times a second: by then its word counts, whatever it is, ms. */
const SHOWN_WITHIN_MILLIS = 1500;
