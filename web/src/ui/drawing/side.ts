/**
 * Paints the arena from the side: what is at which height. A scene gives column and props no heights, so they are drawn
 * from floor to ceiling, and stronger over the heights at which objects ask for them.
 */
import type { SceneDocument } from "../../api/types";
import { words } from "../../i18n";
import { along, elevationOf, heightsOf, type SideAxis } from "../../lib/elevation";
import { metres } from "../../lib/format";
import { LINE_PX, placeLabels, type Box, type Label } from "../../lib/placement";
import type { Bounds, Footprint } from "../../lib/plan";
import { disc, FONT_LABEL, FONT_SMALL, line, pixelsAround, tracePath, widthOf, write, type Brush } from "./brush";
import { COLUMN_SIZE_M } from "./column";
import { HEAD_M } from "./persons";
import { nameOf, type ArenaPicture, type ArenaState, type DrawnPerson } from "./picture";
import { drawGrid } from "./scenery";

/** Everything, from the wall's back to its front. */
export function drawSide(brush: Brush, picture: ArenaPicture, axis: SideAxis, wall: Bounds, names: boolean): void {
  const { context, palette, plan, widthPx, heightPx } = brush;
  const { state, scene } = picture;
  context.clearRect(0, 0, widthPx, heightPx);
  drawGrid(brush, wall);
  const [left, floor] = plan.toPx(wall.min);
  const [right] = plan.toPx(wall.max);
  context.lineWidth = 2.5;
  line(context, [left, floor], [right, floor], palette.arena);
  if (state?.column.homed === true) drawColumn(brush, state, scene, axis, wall);
  for (const document of scene?.objects ?? []) {
    const predicted = state?.column.committed === document.id;
    const colour = predicted ? palette.predicted : palette.object;
    tracePath(brush, elevationKept(document, axis));
    context.globalAlpha = document.enabled ? 0.4 : 0.12;
    context.fillStyle = colour;
    context.fill();
    context.globalAlpha = 1;
    context.lineWidth = predicted ? 2 : 1.5;
    context.strokeStyle = colour;
    context.stroke();
  }
  for (const person of state?.persons ?? []) drawHead(brush, person, axis, state?.column.serves === person.id);
  if (names && scene !== null) drawHeights(brush, scene, state, axis);
}

/** An object seen from the side, worked out once. */
export function elevationKept(object: SceneDocument["objects"][number], axis: SideAxis): Footprint {
  const kept = ELEVATIONS[axis];
  let elevation = kept.get(object);
  if (elevation === undefined) kept.set(object, (elevation = elevationOf(object, axis)));
  return elevation;
}

function drawColumn(brush: Brush, { column }: ArenaState, scene: SceneDocument | null, axis: SideAxis, wall: Bounds): void {
  const { context, palette, plan } = brush;
  const ceiling = wall.max[1];
  const strip = (middle: number, wide: number, from: number, to: number, colour: string, alpha: number): void => {
    const [x, top] = plan.toPx([middle - wide / 2, to]);
    context.globalAlpha = alpha;
    context.fillStyle = colour;
    context.fillRect(x, top, Math.max(2, wide * plan.pxPerMetre), (to - from) * plan.pxPerMetre);
    context.globalAlpha = 1;
  };
  const middle = along(axis, column.position_m);
  const asked = (prop: string | null): readonly (readonly [number, number])[] =>
    (scene?.objects ?? []).filter((object) => object.enabled && (object.prop ?? null) === prop).map((object) => heightsOf(elevationKept(object, axis)));
  for (const prop of scene?.props ?? []) {
    const at = middle + along(axis, prop.offset);
    const wide = Math.max(along(axis, prop.size), LEAST_PROP_M);
    strip(at, wide, 0, ceiling, palette.prop, 0.16);
    for (const [from, to] of asked(prop.id)) strip(at, wide, Math.max(0, from), to, palette.prop, 0.75);
  }
  const wide = along(axis, scene?.column.size ?? COLUMN_SIZE_M);
  strip(middle, wide, 0, ceiling, palette.column, 0.5);
  for (const [from, to] of asked(null)) strip(middle, wide, Math.max(0, from), to, palette.column, 0.5);
  if (column.target_m !== null) {
    const target = along(axis, column.target_m);
    context.setLineDash([4, 4]);
    context.lineWidth = 1.5;
    line(context, plan.toPx([target, 0]), plan.toPx([target, ceiling]), palette.predicted);
    context.setLineDash([]);
  }
}

function drawHead(brush: Brush, person: DrawnPerson, axis: SideAxis, served: boolean): void {
  if (person.head_m === null) return;
  const { context, palette, plan } = brush;
  const colour = person.tracked ? palette.person : palette.danger;
  const at = along(axis, person.head_m);
  const z = person.head_m[2];
  const [px, py] = plan.toPx([at, z]);
  context.lineWidth = 1.5;
  context.setLineDash([2, 4]);
  line(context, [px, py], plan.toPx([at, 0]), colour);
  context.setLineDash([]);
  const facing = Math.cos(person.pitch_rad) * (axis === "x" ? Math.cos(person.yaw_rad) : Math.sin(person.yaw_rad));
  context.lineWidth = 2.5;
  line(context, [px, py], plan.toPx([at + VIEW_M * facing, z + VIEW_M * Math.sin(person.pitch_rad)]), colour);
  disc(context, [px, py], HEAD_M * plan.pxPerMetre);
  context.fillStyle = served ? colour : palette.ground;
  context.fill();
  context.strokeStyle = colour;
  context.stroke();
  const note = person.tracked ? "" : ` (${words().live.notTracked})`;
  write(brush, `${person.name} ${metres(z)} m${note}`, [px, py - HEAD_M * plan.pxPerMetre - 9], colour, FONT_LABEL);
}

/** Names, each with the heights from its foot to its top. */
function drawHeights(brush: Brush, scene: SceneDocument, state: ArenaState | null, axis: SideAxis): void {
  const { palette, plan, widthPx, heightPx } = brush;
  const taken: Box[] = [];
  for (const { head_m, name } of state?.persons ?? []) {
    if (head_m === null) continue;
    const [px, py] = plan.toPx([along(axis, head_m), head_m[2]]);
    const half = widthOf(brush, `${name} 0.00 m`, FONT_LABEL, palette.person) / 2;
    taken.push({ left: px - half, top: py - 30, right: px + half, bottom: py + 12 });
  }
  const labels: Label[] = [];
  for (const [index, document] of scene.objects.entries()) {
    const elevation = elevationKept(document, axis);
    const about = pixelsAround(elevation, plan);
    if (about.right < 0 || about.left > widthPx || about.bottom < 0 || about.top > heightPx) continue;
    const [from, to] = heightsOf(elevation);
    const name = nameOf(document);
    const number = `${metres(from)}–${metres(to)} m`;
    const urgency = document.id === state?.column.committed ? Infinity : -index;
    labels.push({ name, number, nameWidth: widthOf(brush, name, FONT_LABEL, palette.text), numberWidth: widthOf(brush, number, FONT_SMALL, palette.muted), about, urgency });
  }
  for (const { label, at } of placeLabels(labels, taken)) {
    write(brush, label.name, at, label.urgency === Infinity ? palette.predicted : palette.text, FONT_LABEL);
    write(brush, label.number, [at[0], at[1] + LINE_PX], palette.muted, FONT_SMALL);
  }
}

const ELEVATIONS: Readonly<Record<SideAxis, WeakMap<SceneDocument["objects"][number], Footprint>>> = { x: new WeakMap(), y: new WeakMap() };
const LEAST_PROP_M = 0.04;
/** How far ahead a head's view is drawn, m. */
const VIEW_M = 0.35;
