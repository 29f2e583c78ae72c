/** Everybody in the arena: separation term by term, age of the pose, and the floor mark to confirm. */
import { createSignal, For, Index, Show, type JSX } from "solid-js";
import type { Person } from "../api/types";
import { words } from "../i18n";
import { metres } from "../lib/format";
import { bindingMetres, nearnessOf, ringsOf, type Ring } from "../lib/separation";
import type { Live } from "../live/live";
import type { Answer } from "../live/requests";
import { wordsOf } from "./Controls";

/** The list of persons. */
export function Persons(props: { readonly live: Live }): JSX.Element {
  const [answer, setAnswer] = createSignal<Answer | null>(null);
  const persons = (): readonly Person[] => props.live.snapshot()?.persons ?? [];
  const live = (): boolean => props.live.freshness().kind === "live";
  return (
    <section class="panel" aria-labelledby="persons-title">
      <h2 id="persons-title">{words().live.persons}</h2>
      <Show when={persons().length > 0} fallback={<p class="empty">{words().live.nobody}</p>}>
        <ul class="persons fades">
          <For each={persons()}>
            {(person) => (
              <li data-testid={`person-${person.id}`} data-nearness={person.head_m === null ? undefined : nearnessOf(person)}>
                <div class="person-head">
                  <b>{person.name}</b>
                  <Show when={person.limits_column}>
                    <span class="tag limits-tag" data-testid={`limits-${person.id}`}>{words().live.limitsColumn}</span>
                  </Show>
                  <span class="person-pose" classList={{ bad: !person.tracked }}>
                    {person.head_m === null
                      ? words().live.noPose
                      : `${person.tracked ? words().live.tracked : words().live.notTracked}, ${Math.round(person.pose_age_secs * 1000)} ms`}
                  </span>
                </div>
                <Show when={person.head_m !== null}>
                  <Separation person={person} />
                </Show>
                <Show when={!person.tracked && !person.awaits_confirmation}>
                  <button
                    type="button"
                    class="confirm"
                    data-testid={`left-${person.id}`}
                    disabled={!live()}
                    onClick={() => void props.live.ask({ confirm_left: person.id }).then(setAnswer)}
                  >
                    {words().live.left(person.name)}
                  </button>
                </Show>
                <Show when={person.awaits_confirmation}>
                  <button
                    type="button"
                    class="confirm"
                    data-testid={`confirm-${person.id}`}
                    disabled={!live()}
                    onClick={() => void props.live.ask({ confirm_origin: person.id }).then(setAnswer)}
                  >
                    {words().live.onMark(person.name)}
                  </button>
                </Show>
              </li>
            )}
          </For>
        </ul>
      </Show>
      <Show when={answer()}>{(last) => <p class="answer" role="status">{wordsOf(last())}</p>}</Show>
    </section>
  );
}

/** What is required as a bar of its terms, and where the person is on the same scale: the mark must be right of the bar. */
function Separation(props: { readonly person: Person }): JSX.Element {
  const rings = (): readonly Ring[] => (props.person.separation === null ? [] : ringsOf(props.person.separation));
  const slack = (): number => props.person.distance_m - props.person.required_m;
  const share = (distance: number): string => `${Math.min(100, Math.max(0, (distance / DISTANCE_SHOWN_M) * 100)).toFixed(1)}%`;
  return (
    <div class="separation">
      <p class="person-distance">
        <span data-testid={`distance-${props.person.id}`}>{metres(props.person.distance_m)} m {words().live.away}</span>
        <span class="slack" data-testid={`slack-${props.person.id}`}>{slack() < 0 ? words().live.short(metres(-slack())) : words().live.slack(metres(slack()))}</span>
      </p>
      <div
        class="terms-bar"
        role="meter"
        aria-label={words().live.distanceOf(props.person.name)}
        aria-valuemin={0}
        aria-valuemax={DISTANCE_SHOWN_M}
        aria-valuenow={Math.min(DISTANCE_SHOWN_M, props.person.distance_m)}
        aria-valuetext={`${metres(props.person.distance_m)} m ${words().live.away}, ${metres(props.person.required_m)} m ${words().live.required}`}
      >
        <Index each={rings()}>
          {(ring) => <i class={`term-${ring().term}`} classList={{ binds: ring().binds }} style={{ width: share(ring().metres) }} />}
        </Index>
        <b class="terms-mark" style={{ left: share(props.person.distance_m) }} />
      </div>
      <Show when={props.person.separation}>
        {(terms) => (
          <>
            <p class={`binding term-${terms().binding}`} data-testid={`binding-${props.person.id}`}>
              {words().live.binds(words().live.terms[terms().binding], metres(bindingMetres(terms())))}
            </p>
            <dl class="terms" data-testid={`terms-${props.person.id}`}>
              <Index each={rings()}>
                {(ring) => (
                  <div class={`term-${ring().term}`}>
                    <dt>{termWord(ring().term)}</dt>
                    <dd>{metres(ring().metres)}</dd>
                  </div>
                )}
              </Index>
              <div>
                <dt>{words().live.required}</dt>
                <dd>{metres(props.person.required_m)} m</dd>
              </div>
            </dl>
          </>
        )}
      </Show>
    </div>
  );
}

function termWord(term: Ring["term"]): string {
  return term === "radius" ? words().live.radius : words().live.terms[term];
}

const DISTANCE_SHOWN_M = 3;
