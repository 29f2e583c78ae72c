/** The states of the scenario as a graph: where it is, what can be next; each state is a button that chooses it. */
import { createMemo, For, Show, type JSX } from "solid-js";
import type { Scenario, SceneDocument } from "../../api/types";
import { words } from "../../i18n";
import { BOX, stateGraph, type StateArrow, type StateBox } from "../../lib/stateGraph";
import { stateLabel } from "../../lib/scenarioWords";

/** The panel. */
export function StateGraphPanel(props: {
  readonly scene: SceneDocument;
  readonly now: Scenario;
  readonly choose: (state: string) => void;
}): JSX.Element {
  const say = () => words().scenario;
  const graph = createMemo(() => {
    const { scenario } = props.scene;
    return scenario === null || scenario === undefined ? null : stateGraph(scenario);
  });
  const next = createMemo(() => new Set(props.now.next.flatMap(({ to }) => (to === null ? [] : [to]))));
  const isOpen = (arrow: StateArrow): boolean => arrow.from === props.now.state && next().has(arrow.to);
  const marks = (box: StateBox): readonly string[] => [
    ...(props.now.state === box.id ? [say().here] : []),
    ...(next().has(box.id) ? [say().next] : []),
    ...(props.now.left_in === box.id ? [say().leftIn] : []),
    ...(box.isInitial ? [say().initial] : []),
    ...(box.isFinal ? [say().final] : []),
  ];
  return (
    <section class="panel" aria-labelledby="scenario-graph">
      <h2 id="scenario-graph">{say().graph}</h2>
      <p class="empty">{say().graphMeans}</p>
      <Show when={graph()}>
        {(drawn) => (
          <div class="state-graph scrolls" tabindex="0" role="group" aria-labelledby="scenario-graph" data-testid="state-graph">
            <div class="state-plane" style={{ width: `${String(drawn().width)}px`, height: `${String(drawn().height)}px` }}>
              <svg viewBox={`0 0 ${String(drawn().width)} ${String(drawn().height)}`} width={drawn().width} height={drawn().height} aria-hidden="true">
                <defs>
                  <For each={["arrow-head", "arrow-head-open"]}>
                    {(id) => (
                      <marker id={id} viewBox="0 0 8 8" refX="7" refY="4" markerWidth="10" markerHeight="10" markerUnits="userSpaceOnUse" orient="auto">
                        <path d="M0 0 L8 4 L0 8 Z" />
                      </marker>
                    )}
                  </For>
                </defs>
                <For each={drawn().arrows}>
                  {(arrow) => (
                    <path
                      class="state-arrow"
                      classList={{ open: isOpen(arrow) }}
                      d={arrow.path}
                      marker-end={isOpen(arrow) ? "url(#arrow-head-open)" : "url(#arrow-head)"}
                    />
                  )}
                </For>
              </svg>
              <For each={drawn().boxes}>
                {(box) => (
                  <button
                    type="button"
                    class="state-box"
                    data-testid={`state-${box.id}`}
                    classList={{ here: props.now.state === box.id, next: next().has(box.id), final: box.isFinal }}
                    style={{ left: `${String(box.x)}px`, top: `${String(box.y)}px`, width: `${String(BOX.width)}px`, height: `${String(BOX.height)}px` }}
                    aria-current={props.now.state === box.id ? "step" : undefined}
                    title={stateLabel(props.scene, box.id)}
                    onClick={() => { props.choose(box.id); }}
                  >
                    <span class="state-name">{stateLabel(props.scene, box.id)}</span>
                    <span class="state-marks">{marks(box).join(", ")}</span>
                  </button>
                )}
              </For>
            </div>
          </div>
        )}
      </Show>
    </section>
  );
}
