/** Everybody in the arena: separation, age of the pose, and the floor mark to confirm. */
import { createSignal, For, Show, type JSX } from "solid-js";
import type { Live } from "../live/live";
import type { Answer } from "../live/requests";
import { metres } from "../lib/format";
import { wordsOf } from "./Controls";

/** The list of persons. */
export function Persons(props: { readonly live: Live }): JSX.Element {
  const [answer, setAnswer] = createSignal<Answer | null>(null);
  const persons = (): NonNullable<ReturnType<Live["snapshot"]>>["persons"] => props.live.snapshot()?.persons ?? [];
  const live = (): boolean => props.live.freshness().kind === "live";
  return (
    <section class="panel" aria-labelledby="persons-title">
      <h2 id="persons-title">Persons</h2>
      <Show when={persons().length > 0} fallback={<p class="empty">Nobody is in the arena.</p>}>
        <ul class="persons fades">
          <For each={persons()}>
            {(person) => (
              <li data-testid={`person-${person.id}`} classList={{ close: person.distance_m < person.required_m }}>
                <div class="person-head">
                  <b>{person.name}</b>
                  <span classList={{ bad: !person.tracked }}>
                    {person.head_m === null
                      ? "no pose yet"
                      : `${person.tracked ? "tracked" : "not tracked"}, ${Math.round(person.pose_age_secs * 1000)} ms`}
                  </span>
                </div>
                <Show when={person.head_m !== null}>
                  <div class="person-distance">
                    <span>
                      {metres(person.distance_m)} m away, {metres(person.required_m)} m due, r{" "}
                      {metres(person.separation_radius_m)} m
                    </span>
                    <meter
                      aria-label={`Distance of ${person.name}`}
                      min="0"
                      max={DISTANCE_SHOWN_M}
                      low={person.required_m}
                      optimum={DISTANCE_SHOWN_M}
                      value={Math.min(DISTANCE_SHOWN_M, person.distance_m)}
                    />
                  </div>
                </Show>
                <Show when={!person.tracked && !person.awaits_confirmation}>
                  <button
                    type="button"
                    class="confirm"
                    data-testid={`left-${person.id}`}
                    disabled={!live()}
                    onClick={() => void props.live.ask({ confirm_left: person.id }).then(setAnswer)}
                  >
                    I see that {person.name} has left the arena
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
                    {person.name} stands on the floor mark
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

const DISTANCE_SHOWN_M = 3;
