/** What the column decides and why: what it believes, where it is wanted, which way, and when it is there. */
import { createMemo, For, Show, type JSX } from "solid-js";
import type { Column, Reason, Snapshot } from "../api/types";
import { words } from "../i18n";
import { sharesOf, type Share } from "../lib/belief";
import { decimal, pair, percent } from "../lib/format";
import { labelOf } from "../lib/labels";
import { reasonWords } from "../lib/reasonWords";
import type { Live } from "../live/live";

/** Four decisions, each with its value, its reason, and the name of what decides it. */
export function Decisions(props: { readonly live: Live }): JSX.Element {
  const text = (): ReturnType<typeof words>["live"]["decisions"] => words().live.decisions;
  const snapshot = (): Snapshot | null => props.live.snapshot();
  const label = (id: string): string => labelOf(props.live.scene()?.scene ?? null, id);
  const decided = (): boolean => snapshot()?.column.decision !== null && snapshot() !== null;
  const why = (of: keyof NonNullable<Column["decision"]>): string => sentence(snapshot()?.column.decision?.[of] ?? [], label);
  const shares = createMemo((): readonly Share[] => {
    const now = snapshot();
    return now === null || !decided() ? [] : sharesOf(now.objects, now.none_probability);
  });
  const named = ({ of }: Share): string => (of.kind === "object" ? label(of.id) : of.kind === "none" ? text().none : text().others(of.count));

  return (
    <section class="panel decisions" aria-labelledby="decisions-title">
      <h2 id="decisions-title">{text().title}</h2>
      <dl class="fades" data-testid="decisions">
        <div class="decision-belief">
          <dt>{text().belief} <Decider title={text().rule} name={snapshot()?.intention_rule} testId="decided-by-rule" /></dt>
          <dd>
            <Show when={shares().length > 0} fallback={text().nobody}>
              <div class="belief-bar" aria-hidden="true">
                <For each={shares()}>{(share, index) => <i data-kind={share.of.kind} data-rank={index()} style={{ width: `${(share.probability * 100).toFixed(1)}%` }} />}</For>
              </div>
              <ul class="belief" data-testid="belief">
                <For each={shares()}>
                  {(share, index) => (
                    <li data-kind={share.of.kind} data-rank={index()}>
                      <span>{named(share)}</span> <b>{percent(share.probability)}</b>
                    </li>
                  )}
                </For>
              </ul>
            </Show>
            <Why testId="why-belief" text={why("belief")} />
          </dd>
        </div>
        <div>
          <dt>{text().place} <Decider title={text().standing} name={snapshot()?.standing} testId="decided-by-standing" /></dt>
          <dd>
            <span data-testid="decided-place">{decided() ? placeOf(snapshot()?.column ?? null) : text().nothing}</span>
            <Why testId="why-place" text={why("place")} />
          </dd>
        </div>
        <div class="decision-route">
          <dt>{text().route} <Decider title={text().motion} name={snapshot()?.motion} testId="decided-by-motion" /></dt>
          <dd>
            <span data-testid="decided-route">{decided() ? routeOf(snapshot()?.column ?? null) : text().nothing}</span>
            <Why testId="why-route" text={why("route")} />
          </dd>
        </div>
        <div>
          <dt>{text().arrival}</dt>
          <dd>
            <span data-testid="decided-arrival">{decided() ? arrivalOf(snapshot()) : text().nothing}</span>
            <Why testId="why-arrival" text={why("arrival")} />
          </dd>
        </div>
      </dl>
    </section>
  );
}

/** The name, as the configuration has it, of what decides. */
function Decider(props: { readonly title: string; readonly name: string | undefined; readonly testId: string }): JSX.Element {
  return (
    <Show when={props.name}>
      {(name) => (
        <code title={props.title} data-testid={props.testId}>
          <span class="unseen">{props.title} </span>
          {name()}
        </code>
      )}
    </Show>
  );
}

function Why(props: { readonly text: string; readonly testId: string }): JSX.Element {
  return <Show when={props.text}><span class="decision-why" data-testid={props.testId}>{props.text}</span></Show>;
}

/** The server's English sentence is not sent for these: a reason that the page does not know is left out. */
function sentence(reasons: readonly Reason[], label: (id: string) => string): string {
  return reasons.map((reason) => reasonWords(reason, label)).filter((text) => text !== null).join(words().live.betweenClauses);
}

function placeOf(column: Column | null): string {
  const target = column?.target_m ?? null;
  return target === null ? words().live.decisions.nothing : `${pair([target[0], target[1]], 2)} m`;
}

function routeOf(column: Column | null): string {
  if (column === null || column.target_m === null) return words().live.decisions.nothing;
  const left = Math.hypot(column.target_m[0] - column.position_m[0], column.target_m[1] - column.position_m[1]);
  return words().live.decisions.toGo(decimal(left, 2), decimal(Math.hypot(...column.velocity_mps), 2));
}

/** When it is there, and the hand at what it stands for. */
function arrivalOf(snapshot: Snapshot | null): string {
  const text = words().live.decisions;
  const secs = snapshot?.column.arrival_secs ?? null;
  const touched = snapshot?.objects.find(({ id }) => id === snapshot.column.committed)?.touch_secs ?? null;
  const there = secs === null ? text.unforeseen : secs < THERE_SECS ? text.there : text.inSecs(decimal(secs, 1));
  return touched === null ? there : `${there}${words().live.betweenClauses}${text.hand(decimal(touched, 1))}`;
}

/** What reads as 0.0 s. */
const THERE_SECS = 0.05;
