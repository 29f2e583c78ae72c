/** What a thing covers on the floor, drawn, with its name. */
import { Match, Show, Switch, type JSX } from "solid-js";
import type { KeepOutDocument, ObjectDocument, SceneDocument } from "../../api/types";
import { type Footprint, type Plan, type Point } from "../../lib/plan";
import { footprintKept, footprintOfKeepOut, nameOf } from "../../ui/drawing/picture";
import { placeOf, thingsOf } from "../scene";
import type { ThingList } from "../selection";

/** A thing that stands on the floor. */
export function footprintOfThing(scene: SceneDocument, list: ThingList, index: number): { readonly footprint: Footprint; readonly middle: Point } {
  const thing = thingsOf(scene, list)[index];
  const middle = placeOf(scene, list, index) ?? [0, 0];
  if (thing === undefined || "offset" in thing) return { footprint: { kind: "disc", centre: middle, radius: 0 }, middle };
  return { footprint: list === "objects" ? footprintKept(thing as ObjectDocument) : footprintOfKeepOut(thing as KeepOutDocument), middle };
}

/** Outline, mark and name. */
export function FootprintShape(props: { readonly plan: Plan; readonly scene: SceneDocument; readonly list: ThingList; readonly index: number; readonly grade: "error" | "warning" | undefined }): JSX.Element {
  const drawn = () => footprintOfThing(props.scene, props.list, props.index);
  const disc = () => {
    const { footprint } = drawn();
    return footprint.kind === "disc" ? footprint : null;
  };
  const points = (): string => {
    const { footprint } = drawn();
    return footprint.kind === "polygon" ? pointsOf(props.plan, footprint.corners) : "";
  };
  const at = (): Point => props.plan.toPx(drawn().middle);
  const name = (): string => {
    const thing = thingsOf(props.scene, props.list)[props.index];
    return thing === undefined ? "" : nameOf(thing);
  };
  return (
    <>
      <Switch>
        <Match when={disc()}>
          {(shown) => <circle class="plan-shape" cx={props.plan.toPx(shown().centre)[0]} cy={props.plan.toPx(shown().centre)[1]} r={Math.max(3, shown().radius * props.plan.pxPerMetre)} />}
        </Match>
        <Match when={true}>
          <polygon class="plan-shape" points={points()} />
        </Match>
      </Switch>
      {/* Something to take hold of, however small it is drawn. */}
      <circle class="plan-hold" cx={at()[0]} cy={at()[1]} r={HOLD_PX} />
      <text class="plan-name" x={at()[0]} y={at()[1] - NAME_PX} text-anchor="middle">{name()}</text>
      <Show when={props.grade}>
        <text class="plan-mark" x={at()[0] + HOLD_PX} y={at()[1] - HOLD_PX + 4} text-anchor="middle" aria-hidden="true">{props.grade === "error" ? "✕" : "!"}</text>
      </Show>
    </>
  );
}

/** Corners as SVG has them. */
export function pointsOf(plan: Plan, corners: readonly Point[]): string {
  return corners.map((corner) => plan.toPx(corner).map((px) => px.toFixed(1)).join(",")).join(" ");
}

const HOLD_PX = 14;
const NAME_PX = 8;
