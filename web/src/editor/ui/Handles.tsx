/** What of the chosen keep-out or zone is pulled: the corners of a polygon, the radius of a circle. */
import { createMemo, createSignal, For, Show, type JSX } from "solid-js";
import type { Plan, Point } from "../../lib/plan";
import type { Editor } from "../editor";
import { rounded, withCorner, withThing } from "../scene";
import { say } from "../words";

/** The handles. */
export function Handles(props: { readonly editor: Editor; readonly plan: Plan; readonly placeOf: (event: MouseEvent) => Point }): JSX.Element {
  const chosen = createMemo(() => {
    const selection = props.editor.selection();
    if (selection.kind !== "thing" || (selection.list !== "keep_outs" && selection.list !== "zones")) return null;
    const shape = props.editor.scene()[selection.list]?.[selection.index]?.shape;
    return shape === undefined ? null : { list: selection.list, index: selection.index, shape };
  });
  const places = createMemo((): readonly Point[] => {
    const shape = chosen()?.shape;
    if (shape === undefined) return [];
    return shape.kind === "polygon" ? shape.corners : [[shape.centre[0] + shape.radius, shape.centre[1]]];
  });
  const [held, setHeld] = createSignal<{ readonly handle: number; readonly at: Point } | null>(null);
  const put = (handle: number, to: Point, kind: string): void => {
    const now = chosen();
    if (now === null) return;
    const { shape } = now;
    if (shape.kind === "polygon") props.editor.change((scene) => withCorner(scene, now.list, now.index, handle, to), kind);
    else {
      const radius = Math.max(0.01, rounded(Math.hypot(to[0] - shape.centre[0], to[1] - shape.centre[1])));
      props.editor.change((scene) => withThing(scene, now.list, now.index, { shape: { ...shape, radius } }), kind);
    }
  };
  return (
    <Show when={chosen()}>
      {(now) => (
        <For each={places().map((_, index) => index)}>
          {(handle) => {
            const at = (): Point => (held()?.handle === handle ? held()?.at : undefined) ?? places()[handle] ?? [0, 0];
            return (
              <circle
                class="plan-handle"
                cx={props.plan.toPx(at())[0]}
                cy={props.plan.toPx(at())[1]}
                r="7"
                tabindex="0"
                role="button"
                aria-label={now().shape.kind === "polygon" ? say().plan.corner(handle + 1) : say().plan.radius}
                data-testid={`plan-handle-${handle}`}
                onPointerDown={(event) => {
                  if (event.button !== 0) return;
                  event.stopPropagation();
                  event.currentTarget.setPointerCapture(event.pointerId);
                  setHeld({ handle, at: at() });
                }}
                onPointerMove={(event) => {
                  if (held()?.handle !== handle) return;
                  event.stopPropagation();
                  const [x, y] = props.plan.toRoom(props.placeOf(event));
                  setHeld({ handle, at: [Math.round(x * 100) / 100, Math.round(y * 100) / 100] });
                }}
                onPointerUp={(event) => {
                  const last = held();
                  if (last?.handle !== handle) return;
                  event.stopPropagation();
                  setHeld(null);
                  put(handle, last.at, `corner ${handle} ${event.timeStamp}`);
                }}
                onPointerCancel={() => setHeld(null)}
                onKeyDown={(event) => {
                  const way = ARROWS[event.key];
                  if (way === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
                  event.preventDefault();
                  event.stopPropagation();
                  const by = event.shiftKey ? 0.01 : 0.05;
                  const [x, y] = at();
                  put(handle, [x + way[0] * by, y + way[1] * by], `corner ${handle}`);
                }}
              />
            );
          }}
        </For>
      )}
    </Show>
  );
}

const ARROWS: Readonly<Record<string, Point | undefined>> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
