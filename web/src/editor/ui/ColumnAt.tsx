/** The column where it would serve what is chosen, with its props; a prop is dragged about the column. */
import { createMemo, For, Show, type JSX } from "solid-js";
import type { PropDocument, SceneDocument } from "../../api/types";
import type { Plan, Point } from "../../lib/plan";
import { nameOf } from "../../ui/drawing/picture";
import type { Selection } from "../selection";
import { pointsOf } from "./PlanShapes";

/** Column and props. */
export function ColumnAt(props: {
  readonly plan: Plan;
  readonly scene: SceneDocument;
  readonly selection: Selection;
  readonly hold: (prop: number, event: PointerEvent) => void;
  readonly key: (prop: number, event: KeyboardEvent) => void;
  readonly said: (prop: number) => string;
}): JSX.Element {
  const at = createMemo(() => columnPlace(props.scene, props.selection));
  const chosenProp = (): number | null => (props.selection.kind === "thing" && props.selection.list === "props" ? props.selection.index : null);
  return (
    <Show when={at()}>
      {(place) => (
        <>
          <polygon class="plan-column" points={pointsOf(props.plan, rectangle(place(), props.scene.column.size))} aria-hidden="true" />
          <For each={(props.scene.props ?? []).map((_, index) => index)}>
            {(index) => (
              <Show when={props.scene.props?.[index]}>
                {(prop) => (
                  <g
                    class="plan-thing plan-prop"
                    classList={{ chosen: chosenProp() === index }}
                    tabindex="0"
                    role="button"
                    aria-pressed={chosenProp() === index}
                    aria-label={props.said(index)}
                    data-testid={`plan-props-${prop().id}`}
                    onPointerDown={(event) => { props.hold(index, event); }}
                    onKeyDown={(event) => { props.key(index, event); }}
                  >
                    <PropShape plan={props.plan} column={place()} prop={prop()} />
                  </g>
                )}
              </Show>
            )}
          </For>
        </>
      )}
    </Show>
  );
}

function PropShape(props: { readonly plan: Plan; readonly column: Point; readonly prop: PropDocument }): JSX.Element {
  const centre = (): Point => [props.column[0] + props.prop.offset[0], props.column[1] + props.prop.offset[1]];
  const px = (): Point => props.plan.toPx(centre());
  const nose = (): Point => {
    const [x, y] = centre();
    return props.plan.toPx([x + NOSE_M * Math.cos(props.prop.facing), y + NOSE_M * Math.sin(props.prop.facing)]);
  };
  return (
    <>
      <line class="plan-arm" x1={props.plan.toPx(props.column)[0]} y1={props.plan.toPx(props.column)[1]} x2={px()[0]} y2={px()[1]} />
      <polygon class="plan-shape" points={pointsOf(props.plan, rectangle(centre(), props.prop.size))} />
      <line class="plan-nose" x1={px()[0]} y1={px()[1]} x2={nose()[0]} y2={nose()[1]} />
      <circle class="plan-hold" cx={px()[0]} cy={px()[1]} r="11" />
      <circle class="plan-dot" cx={px()[0]} cy={px()[1]} r="4" />
      <text class="plan-name" x={px()[0]} y={px()[1] + 16} text-anchor="middle">{nameOf(props.prop)}</text>
    </>
  );
}

/** Where the column stands in the picture: for the object that is chosen, in the arena's middle for a prop. */
function columnPlace(scene: SceneDocument, selection: Selection): Point | null {
  if (selection.kind !== "thing") return null;
  const { min, max } = scene.arena;
  if (selection.list === "props") return [(min[0] + max[0]) / 2, (min[1] + max[1]) / 2];
  const object = selection.list === "objects" ? scene.objects[selection.index] : undefined;
  if (object === undefined) return null;
  const offset = scene.props?.find(({ id }) => id === object.prop)?.offset ?? [0, 0];
  return [object.position[0] - offset[0], object.position[1] - offset[1]];
}

function rectangle([x, y]: Point, [width, height]: readonly [number, number]): readonly Point[] {
  return [[x - width / 2, y - height / 2], [x + width / 2, y - height / 2], [x + width / 2, y + height / 2], [x - width / 2, y + height / 2]];
}

const NOSE_M = 0.2;
