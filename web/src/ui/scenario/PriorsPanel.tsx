/** The priors of the state: what the scene says, what is in force now, and what the rule makes of it. */
import { For, Show, type JSX } from "solid-js";
import type { ObjectState, Scenario, SceneDocument } from "../../api/types";
import { words } from "../../i18n";
import { decimal, percent } from "../../lib/format";
import { labelOf } from "../../lib/labels";

/** The panel. */
export function PriorsPanel(props: { readonly scene: SceneDocument; readonly now: Scenario; readonly objects: readonly ObjectState[] }): JSX.Element {
  const say = () => words().scenario.priors;
  const state = () => props.scene.scenario?.states.find(({ id }) => id === props.now.state);
  const enabled = (): readonly ObjectState[] => props.objects.filter((object) => object.enabled);
  const told = (id: string): string => {
    const prior = state()?.priors?.[id];
    if (prior === undefined) return say().ofScene(decimal(props.scene.objects.find((object) => object.id === id)?.prior ?? 1, 2));
    if (typeof prior === "number") return decimal(prior, 2);
    const changes = [...(prior.per_s === 0 ? [] : [say().perSecond(signed(prior.per_s))]), ...(prior.per_touch === 0 ? [] : [say().perTouch(signed(prior.per_touch))])];
    return [decimal(prior.value, 2), ...changes].join(", ");
  };
  return (
    <section class="panel" aria-labelledby="scenario-priors">
      <h2 id="scenario-priors">{say().title}</h2>
      <Show when={enabled().length > 0} fallback={<p class="empty">{words().scenario.enabledNothing}</p>}>
        <div>
          <table class="fades" data-testid="scenario-priors">
            <thead>
              <tr>
                <th scope="col">{say().object}</th>
                <th scope="col">{say().said}</th>
                <th scope="col">{say().inForce}</th>
                <th scope="col">{say().share}</th>
              </tr>
            </thead>
            <tbody>
              <For each={enabled().map(({ id }) => id)}>
                {(id) => {
                  const object = (): ObjectState | undefined => enabled().find((known) => known.id === id);
                  return (
                    <tr>
                      <th scope="row">{labelOf(props.scene, id)}</th>
                      <td>{told(id)}</td>
                      <td data-testid={`prior-now-${id}`}>{decimal(object()?.prior ?? 0, 2)}</td>
                      <td>{percent(object()?.probability ?? 0)}</td>
                    </tr>
                  );
                }}
              </For>
            </tbody>
          </table>
        </div>
      </Show>
    </section>
  );
}

function signed(value: number): string {
  return `${value > 0 ? "+" : "−"}${decimal(Math.abs(value), 2)}`;
}
