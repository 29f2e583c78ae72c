/** The arena from the side, so that a designer sees what is at which height. */
import { createMemo, For, type JSX } from "solid-js";
import { language, words } from "../i18n";
import { heightsOf, wallOf, type SideAxis } from "../lib/elevation";
import type { Bounds } from "../lib/plan";
import { drawSide, elevationKept } from "./drawing/side";
import { boundsOf, type ArenaPicture } from "./drawing/picture";
import { PlanCanvas } from "./PlanCanvas";
import { decimal } from "../lib/format";

/** Picture and the choice of its axis. */
export function SideView(props: {
  readonly picture: () => ArenaPicture;
  readonly axis: SideAxis;
  readonly setAxis: (axis: SideAxis) => void;
  readonly names?: boolean;
}): JSX.Element {
  const scene = createMemo(() => props.picture().scene);
  const shape = createMemo(() => props.picture().shape);
  const wall = createMemo((): Bounds | null => {
    const floor = boundsOf(scene(), shape());
    if (floor === null) return null;
    return wallOf(floor, (scene()?.objects ?? []).map((object) => heightsOf(elevationKept(object, props.axis))[1]), props.axis);
  });
  const axisWord = (axis: SideAxis): string => (axis === "x" ? words().live.alongX : words().live.alongY);
  return (
    <section class="panel side-view" aria-label={words().live.sideView}>
      <div class="side-axis" role="group" aria-label={words().live.along}>
        <For each={["x", "y"] as const}>
          {(axis) => (
            <button type="button" class="toggle" aria-pressed={props.axis === axis} data-testid={`side-${axis}`} onClick={() => { props.setAxis(axis); }}>
              {axisWord(axis)}
            </button>
          )}
        </For>
      </div>
      <div class="canvas-frame" title={words().live.columnHeightUnknown}>
        <PlanCanvas
          bounds={wall}
          marginPx={MARGIN_PX}
          painting={() => {
            const [picture, axis, seen, names] = [props.picture(), props.axis, wall(), props.names !== false];
            language();
            return (brush) => {
              if (seen !== null) drawSide(brush, picture, axis, seen, names);
            };
          }}
          label={() => `${words().live.sideSeen(axisWord(props.axis))}. ${headWords(props.picture())}`}
          testId="side-view"
        />
      </div>
    </section>
  );
}

function headWords({ state }: ArenaPicture): string {
  return (state?.persons ?? [])
    .filter((person) => person.head_m !== null)
    // A tenth is enough to hear, and changes less often.
    .map((person) => words().live.headHeight(person.name, decimal(person.head_m?.[2] ?? 0, 1)))
    .join("; ");
}

const MARGIN_PX = 26;
