/** The states as a graph: each is chosen, led from and led to; what is found is marked at it. */
import { createMemo, createSignal, For, Show, type JSX } from "solid-js";
import { BOX, stateGraph } from "../../lib/stateGraph";
import { nameOf } from "../../ui/drawing/picture";
import type { Editor } from "../editor";
import { withNewState, withWays } from "../scenario";
import { pathOf, type Selection } from "../selection";
import { say } from "../words";

/** The graph. */
export function GraphEditor(props: { readonly editor: Editor; readonly chose: (selection: Selection) => void }): JSX.Element {
  const scenario = () => props.editor.scene().scenario ?? null;
  const graph = createMemo(() => {
    const now = scenario();
    return now === null ? null : stateGraph(now);
  });
  /** The state that leads to the next that is chosen. */
  const [leading, setLeading] = createSignal<number | null>(null);
  const chosen = (): number | null => {
    const selection = props.editor.selection();
    return selection.kind === "state" ? selection.index : null;
  };
  const nameAt = (index: number): string => {
    const state = scenario()?.states[index];
    return state === undefined ? "" : nameOf(state);
  };
  const press = (index: number): void => {
    const from = leading();
    const to = scenario()?.states[index]?.id;
    setLeading(null);
    if (from === null || to === undefined) {
      props.chose({ kind: "state", index });
      return;
    }
    props.editor.change((scene) => withWays(scene, from, (ways) => [...ways, { on: [{ kind: "cue", name: "next" }], to }]));
    props.chose({ kind: "state", index: from });
  };
  const grade = (index: number): "error" | "warning" | undefined => {
    const found = props.editor.at(pathOf({ kind: "state", index }));
    return found.some((finding) => finding.grade === "error") ? "error" : found.length > 0 ? "warning" : undefined;
  };
  return (
    <section class="panel edit-graph" aria-labelledby="edit-graph-title">
      <h2 id="edit-graph-title">{say().graph.title}</h2>
      <p class="empty">{say().graph.means}</p>
      <div class="edit-buttons">
        <button type="button" data-testid="graph-add" onClick={() => {
          const index = scenario()?.states.length ?? 0;
          props.editor.change(withNewState);
          props.chose({ kind: "state", index });
        }}>
          + {scenario() === null ? say().list.firstState : say().list.addState}
        </button>
        <button type="button" data-testid="graph-lead" aria-pressed={leading() !== null} disabled={chosen() === null} onClick={() => setLeading(leading() === null ? chosen() : null)}>
          {leading() === null ? say().graph.lead : say().graph.stop}
        </button>
        <span role="status">{leading() === null ? "" : say().graph.leadWhere(nameAt(leading() ?? 0))}</span>
      </div>
      <Show when={graph()} fallback={<p class="empty">{say().graph.none}</p>}>
        {(drawn) => (
          <div class="state-graph scrolls" tabindex="0" role="group" aria-labelledby="edit-graph-title" data-testid="graph-editor">
            <div class="state-plane" style={{ width: `${String(drawn().width)}px`, height: `${String(drawn().height)}px` }}>
              <svg viewBox={`0 0 ${String(drawn().width)} ${String(drawn().height)}`} width={drawn().width} height={drawn().height} aria-hidden="true">
                <defs>
                  <marker id="edit-arrow" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="10" markerHeight="10" markerUnits="userSpaceOnUse" orient="auto">
                    <path d="M0 0 L8 4 L0 8 Z" />
                  </marker>
                </defs>
                <For each={drawn().arrows}>{(arrow) => <path class="state-arrow" classList={{ open: scenario()?.states[chosen() ?? -1]?.id === arrow.from }} d={arrow.path} marker-end="url(#edit-arrow)" />}</For>
              </svg>
              <For each={drawn().boxes.map((_, index) => index)}>
                {(index) => (
                  <Show when={drawn().boxes[index]}>
                    {(box) => (
                      <button
                        type="button"
                        class="state-box"
                        classList={{ final: box().isFinal, here: chosen() === index }}
                        data-grade={grade(index)}
                        data-testid={`graph-state-${box().id}`}
                        aria-pressed={chosen() === index}
                        style={{ left: `${String(box().x)}px`, top: `${String(box().y)}px`, width: `${String(BOX.width)}px`, height: `${String(BOX.height)}px` }}
                        onClick={() => { press(index); }}
                      >
                        <span class="state-name">{box().label === "" ? box().id : box().label}</span>
                        <span class="state-marks">
                          {[...(box().isInitial ? [say().graph.initial] : []), ...(box().isFinal ? [say().graph.final] : []), ...(grade(index) === undefined ? [] : [say().check[grade(index) === "error" ? "error" : "warning"]])].join(", ")}
                        </span>
                      </button>
                    )}
                  </Show>
                )}
              </For>
            </div>
          </div>
        )}
      </Show>
    </section>
  );
}
