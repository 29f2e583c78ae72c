/** What is pulled of what is chosen: the corners of a polygon, the radius of a circle, the places of a path. */
import { createMemo, createSignal, For, Show, type JSX } from "solid-js";
import type { Plan, Point } from "../../lib/plan";
import type { Editor } from "../editor";
import { pathsOf, withPath, type Path } from "../interactions";
import { rounded, withCorner, withThing } from "../scene";
import { say } from "../words";
import { Grip } from "./Grip";
import { pointsOf } from "./PlanShapes";

interface HandlesProps {
  readonly editor: Editor;
  readonly plan: Plan;
  readonly placeOf: (event: MouseEvent) => Point;
}

/** The handles. */
export function Handles(props: HandlesProps): JSX.Element {
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
  const paths = createMemo(() => pathsOf(props.editor.scene(), props.editor.selection()));
  return (
    <>
      <Show when={chosen()}>
        {(now) => (
          <For each={places().map((_, index) => index)}>
            {(handle) => (
              <Grip
                plan={props.plan}
                at={places()[handle] ?? [0, 0]}
                label={now().shape.kind === "polygon" ? say().plan.corner(handle + 1) : say().plan.radius}
                testId={`plan-handle-${handle}`}
                placeOf={props.placeOf}
                put={(to, kind) => { put(handle, to, kind); }}
              />
            )}
          </For>
        )}
      </Show>
      <For each={paths().map((_, index) => index)}>{(index) => <Show when={paths()[index]}>{(path) => <PathGrips {...props} path={path()} />}</Show>}</For>
    </>
  );
}

/** A path from its object on, place by place. */
function PathGrips(props: HandlesProps & { readonly path: Path }): JSX.Element {
  const [pulled, setPulled] = createSignal<{ readonly place: number; readonly to: Point } | null>(null);
  const start = (): Point => {
    const position = props.editor.scene().objects.find(({ id }) => id === props.path.object)?.position;
    return position === undefined ? [0, 0] : [position[0], position[1]];
  };
  const line = (): readonly Point[] => [start(), ...props.path.places.map((place, index) => (pulled()?.place === index ? (pulled()?.to ?? place) : place))];
  return (
    <>
      <polyline class="plan-path" points={pointsOf(props.plan, line())} aria-hidden="true" />
      <For each={props.path.places.map((_, index) => index)}>
        {(index) => (
          <Grip
            plan={props.plan}
            at={props.path.places[index] ?? [0, 0]}
            label={`${props.path.object}: ${say().plan.place(index + 1)}`}
            testId={`plan-path-${props.path.object}-${index}`}
            placeOf={props.placeOf}
            pulled={(to) => setPulled(to === null ? null : { place: index, to })}
            put={(to, kind) => { props.editor.change((scene) => withPath(scene, props.path, (places) => places.map((old, at) => (at === index ? to : old))), kind); }}
            remove={() => { props.editor.change((scene) => withPath(scene, props.path, (places) => places.filter((_, at) => at !== index))); }}
          />
        )}
      </For>
    </>
  );
}
