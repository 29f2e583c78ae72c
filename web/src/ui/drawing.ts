/**
 * Paints the top view. It decides what is drawn over what; it must never invent a position: whatever the snapshot does
 * not say is not drawn.
 */
import type { KeepOutDocument, MachineShape, ObjectState, Person, SceneDocument, Snapshot } from "../api/types";
import { boundsAround, fitPlan, footprintOf, type Bounds, type Footprint, type Plan, type Point } from "../lib/plan";
import { LINE_PX, placeLabels, type Box, type Label } from "../lib/placement";
import type { Palette } from "../lib/theme";

/** All that is painted. */
export interface Picture {
  readonly snapshot: Snapshot | null;
  readonly scene: SceneDocument | null;
  readonly shape: MachineShape | null;
}

/** Paints everything, on a context whose unit is the CSS pixel. */
export function drawTopView(
  context: CanvasRenderingContext2D,
  widthPx: number,
  heightPx: number,
  picture: Picture,
  palette: Palette,
): void {
  context.clearRect(0, 0, widthPx, heightPx);
  const bounds = boundsOf(picture);
  if (bounds === null) return;
  const view: View = { context, palette, plan: fitPlan(bounds, widthPx, heightPx, MARGIN_PX) };
  drawGrid(view, bounds);
  if (picture.shape !== null) drawTravel(view, picture.shape);
  if (picture.scene !== null) {
    drawArena(view, picture.scene);
    for (const keepOut of picture.scene.keep_outs ?? []) drawKeepOut(view, keepOut);
  }
  const { snapshot, scene } = picture;
  for (const person of snapshot?.persons ?? []) drawZone(view, person);
  if (scene !== null) drawObjects(view, scene, snapshot);
  // Before homing the column's numbers are not places in the room.
  if (snapshot?.column.homed === true) drawColumn(view, snapshot, scene);
  for (const person of snapshot?.persons ?? []) drawPerson(view, person, snapshot?.column.serves === person.id);
  if (scene !== null) drawLabels(view, scene, snapshot);
}

interface View {
  readonly context: CanvasRenderingContext2D;
  readonly palette: Palette;
  readonly plan: Plan;
}

function boundsOf({ scene, shape }: Picture): Bounds | null {
  const arena: Bounds | null = scene === null ? null : { min: scene.arena.min, max: scene.arena.max };
  if (shape === null) return arena;
  const [minX, minY, maxX, maxY] = shape.travel_m;
  const travel: Bounds = { min: [minX, minY], max: [maxX, maxY] };
  return arena === null ? travel : boundsAround(arena, travel);
}

function drawGrid({ context, palette, plan }: View, bounds: Bounds): void {
  context.lineWidth = 1;
  context.font = FONT_SMALL;
  context.fillStyle = palette.muted;
  const halves = (from: number, to: number): number[] => {
    const marks: number[] = [];
    for (let mark = Math.ceil(from * 2); mark <= Math.floor(to * 2 + 1e-9); mark += 1) marks.push(mark / 2);
    return marks;
  };
  for (const x of halves(bounds.min[0], bounds.max[0])) {
    const [px, bottom] = plan.toPx([x, bounds.min[1]]);
    const [, top] = plan.toPx([x, bounds.max[1]]);
    line(context, [px, bottom], [px, top], Number.isInteger(x) ? palette.gridWhole : palette.grid);
    if (Number.isInteger(x)) {
      context.textAlign = "center";
      context.textBaseline = "top";
      context.fillText(`${x}${x === Math.floor(bounds.max[0]) ? " m" : ""}`, px, bottom + 6);
    }
  }
  for (const y of halves(bounds.min[1], bounds.max[1])) {
    const [left, py] = plan.toPx([bounds.min[0], y]);
    const [right] = plan.toPx([bounds.max[0], y]);
    line(context, [left, py], [right, py], Number.isInteger(y) ? palette.gridWhole : palette.grid);
    if (Number.isInteger(y)) {
      context.textAlign = "right";
      context.textBaseline = "middle";
      context.fillText(`${y}${y === Math.floor(bounds.max[1]) ? " m" : ""}`, left - 6, py);
    }
  }
}

function drawTravel({ context, palette, plan }: View, shape: MachineShape): void {
  const [minX, minY, maxX, maxY] = shape.travel_m;
  context.setLineDash([6, 5]);
  context.lineWidth = 1.25;
  context.strokeStyle = palette.travel;
  strokeRect(context, plan, [minX, minY], [maxX, maxY]);
  context.setLineDash([]);
}

function drawArena({ context, palette, plan }: View, scene: SceneDocument): void {
  context.lineWidth = 2;
  context.strokeStyle = palette.arena;
  strokeRect(context, plan, scene.arena.min, scene.arena.max);
}

function drawKeepOut(view: View, keepOut: KeepOutDocument): void {
  const { context, palette, plan } = view;
  const shape = keepOut.shape;
  const footprint: Footprint =
    shape.kind === "circle"
      ? { kind: "disc", centre: shape.centre, radius: shape.radius }
      : { kind: "polygon", corners: shape.corners };
  tracePath(view, footprint);
  context.save();
  context.globalAlpha = 0.13;
  context.fillStyle = palette.keepOut;
  context.fill();
  context.globalAlpha = 0.5;
  context.clip();
  hatch(context, pixelsAround(footprint, plan), palette.keepOut);
  context.restore();
  tracePath(view, footprint);
  context.lineWidth = 1.5;
  context.strokeStyle = palette.keepOut;
  context.stroke();
  write(view, keepOut.label || keepOut.id, plan.toPx(middleOf(footprint)), palette.keepOut, FONT_SMALL);
}

function drawZone({ context, palette, plan }: View, person: Person): void {
  if (person.head_m === null) return;
  const centre = plan.toPx([person.head_m[0], person.head_m[1]]);
  const breached = person.distance_m < person.required_m;
  const near = !breached && person.distance_m < person.required_m + NEAR_M;
  const colour = breached ? palette.danger : near ? palette.near : palette.person;
  disc(context, centre, person.separation_radius_m * plan.pxPerMetre);
  context.globalAlpha = 0.14;
  context.fillStyle = colour;
  context.fill();
  context.globalAlpha = 0.9;
  context.lineWidth = 1.5;
  context.strokeStyle = colour;
  context.stroke();
  disc(context, centre, person.required_m * plan.pxPerMetre);
  context.setLineDash([4, 4]);
  context.lineWidth = 1.25;
  context.stroke();
  context.setLineDash([]);
  context.globalAlpha = 1;
}

function drawObjects(view: View, scene: SceneDocument, snapshot: Snapshot | null): void {
  const { context, palette, plan } = view;
  const states = new Map<string, ObjectState>(snapshot?.objects.map((object) => [object.id, object]));
  for (const document of scene.objects) {
    const state = states.get(document.id);
    const weight = state?.weight ?? 0;
    const footprint = footprintOf(document);
    const centre = plan.toPx([document.position[0], document.position[1]]);
    const predicted = snapshot?.column.committed === document.id;
    const colour = predicted ? palette.predicted : palette.object;
    if (state !== undefined && document.enabled) {
      // The halo's area grows with the weight: twice as sure, twice as much colour.
      disc(context, centre, HALO_M * Math.sqrt(Math.max(0, weight)) * plan.pxPerMetre);
      context.globalAlpha = 0.1 + 0.3 * Math.min(1, weight);
      context.fillStyle = colour;
      context.fill();
      context.globalAlpha = 1;
    }
    tracePath(view, footprint);
    context.globalAlpha = document.enabled ? 0.25 + 0.45 * Math.min(1, weight) : 0.15;
    context.fillStyle = colour;
    context.fill();
    context.globalAlpha = 1;
    context.lineWidth = 1.5;
    context.strokeStyle = colour;
    tracePath(view, footprint);
    context.stroke();
    if (predicted) drawPredicted(view, state, centre);
  }
}

/** Names and weights, over everything, and none over another: the predicted first, then in the scene's order, which stays. */
function drawLabels(view: View, scene: SceneDocument, snapshot: Snapshot | null): void {
  const { context, palette, plan } = view;
  const states = new Map<string, ObjectState>(snapshot?.objects.map((object) => [object.id, object]));
  const committed = snapshot?.column.committed ?? null;
  const taken: Box[] = [];
  for (const person of snapshot?.persons ?? []) {
    if (person.head_m === null) continue;
    const [px, py] = plan.toPx([person.head_m[0], person.head_m[1]]);
    const head = HEAD_M * plan.pxPerMetre;
    context.font = FONT_LABEL;
    const half = context.measureText(person.name).width / 2;
    taken.push({ left: px - Math.max(half, head), top: py - head, right: px + Math.max(half, head), bottom: py + head + 18 });
  }
  const labels = scene.objects.map((document, index): Label => {
    const state = states.get(document.id);
    const name = document.label !== undefined && document.label !== "" ? document.label : document.id;
    const number = !document.enabled ? "off" : state === undefined ? "" : state.weight.toFixed(2);
    context.font = FONT_LABEL;
    const nameWidth = context.measureText(name).width;
    context.font = FONT_SMALL;
    const about = pixelsAround(footprintOf(document), plan);
    const urgency = document.id === committed ? Infinity : -index;
    return { name, number, nameWidth, numberWidth: context.measureText(number).width, about, urgency };
  });
  for (const { label, at } of placeLabels(labels, taken)) {
    const colour = label.urgency === Infinity ? palette.predicted : palette.text;
    write(view, label.name, at, colour, FONT_LABEL);
    write(view, label.number, [at[0], at[1] + LINE_PX], palette.muted, FONT_SMALL);
  }
}

/** A ring about the object, and where the column must stand for it. */
function drawPredicted({ context, palette, plan }: View, state: ObjectState | undefined, centre: Point): void {
  context.strokeStyle = palette.predicted;
  context.lineWidth = 2;
  disc(context, centre, PREDICTED_RING_M * plan.pxPerMetre);
  context.stroke();
  if (state === undefined) return;
  const place = plan.toPx(state.column_place_m);
  if (Math.hypot(place[0] - centre[0], place[1] - centre[1]) < 3) return;
  context.setLineDash([2, 4]);
  line(context, centre, place, palette.predicted);
  context.setLineDash([]);
  context.strokeRect(place[0] - 4, place[1] - 4, 8, 8);
}

function drawColumn(view: View, snapshot: Snapshot, scene: SceneDocument | null): void {
  const { context, palette, plan } = view;
  const { column } = snapshot;
  const [x, y] = column.position_m;
  const size = scene?.column.size ?? COLUMN_SIZE_M;
  for (const prop of scene?.props ?? []) {
    const at: Point = [x + prop.offset[0], y + prop.offset[1]];
    const [width, depth] = [Math.max(prop.size[0], LEAST_PROP_M), Math.max(prop.size[1], LEAST_PROP_M)];
    context.lineWidth = 1;
    line(context, plan.toPx([x, y]), plan.toPx(at), palette.prop);
    const [left, top] = plan.toPx([at[0] - width / 2, at[1] + depth / 2]);
    context.fillStyle = palette.prop;
    context.fillRect(left, top, width * plan.pxPerMetre, depth * plan.pxPerMetre);
    const facing: Point = [at[0] + FACING_M * Math.cos(prop.facing), at[1] + FACING_M * Math.sin(prop.facing)];
    context.lineWidth = 2;
    line(context, plan.toPx(at), plan.toPx(facing), palette.prop);
  }
  const [left, top] = plan.toPx([x - size[0] / 2, y + size[1] / 2]);
  const [widthPx, heightPx] = [size[0] * plan.pxPerMetre, size[1] * plan.pxPerMetre];
  context.fillStyle = palette.column;
  context.fillRect(left, top, widthPx, heightPx);
  context.strokeStyle = palette.ground;
  context.lineWidth = 1;
  context.strokeRect(left + 0.5, top + 0.5, widthPx - 1, heightPx - 1);
  const ahead: Point = [x + column.velocity_mps[0] * LOOKAHEAD_SECS, y + column.velocity_mps[1] * LOOKAHEAD_SECS];
  context.lineWidth = 3;
  line(context, plan.toPx([x, y]), plan.toPx(ahead), palette.column);

  const target = column.target_m === null ? null : plan.toPx(column.target_m);
  if (target !== null) {
    context.lineWidth = 2;
    line(context, [target[0] - 6, target[1] - 6], [target[0] + 6, target[1] + 6], palette.predicted);
    line(context, [target[0] - 6, target[1] + 6], [target[0] + 6, target[1] - 6], palette.predicted);
  }
  context.lineWidth = 1.5;
  context.strokeStyle = palette.text;
  disc(context, plan.toPx(column.proxy_m), 5);
  context.stroke();
  const commanded = plan.toPx(column.commanded_m);
  line(context, [commanded[0] - 8, commanded[1]], [commanded[0] + 8, commanded[1]], palette.text);
  line(context, [commanded[0], commanded[1] - 8], [commanded[0], commanded[1] + 8], palette.text);
}

function drawPerson(view: View, person: Person, served: boolean): void {
  const { context, palette, plan } = view;
  if (person.head_m === null) return;
  const [px, py] = plan.toPx([person.head_m[0], person.head_m[1]]);
  const colour = person.tracked ? palette.person : palette.danger;
  const reach = VIEW_M * Math.max(0.25, Math.cos(person.pitch_rad)) * plan.pxPerMetre;
  // The canvas's y points down, so headings turn the other way.
  const heading = -person.yaw_rad;
  const fade = context.createRadialGradient(px, py, 0, px, py, reach);
  fade.addColorStop(0, colour);
  // Towards the same colour (#rrggbb) unseen: plain `transparent` is black, and greys the fading.
  fade.addColorStop(1, `${colour}00`);
  context.globalAlpha = 0.45;
  context.fillStyle = fade;
  context.beginPath();
  context.moveTo(px, py);
  context.arc(px, py, reach, heading - VIEW_HALF_RAD, heading + VIEW_HALF_RAD);
  context.closePath();
  context.fill();
  context.globalAlpha = 1;
  context.lineWidth = 2.5;
  const head = HEAD_M * plan.pxPerMetre;
  line(context, [px, py], [px + 2 * head * Math.cos(heading), py + 2 * head * Math.sin(heading)], colour);
  disc(context, [px, py], head);
  context.fillStyle = palette.ground;
  context.fill();
  context.strokeStyle = colour;
  context.stroke();
  if (served) {
    disc(context, [px, py], head * 0.45);
    context.fillStyle = colour;
    context.fill();
  }
  const note = !person.tracked ? " (not tracked)" : person.awaits_confirmation ? " (floor mark?)" : "";
  write(view, person.name + note, [px, py + head + 10], colour, FONT_LABEL);
}

function pixelsAround(footprint: Footprint, plan: Plan): Box {
  if (footprint.kind === "disc") {
    const [x, y] = plan.toPx(footprint.centre);
    const radius = footprint.radius * plan.pxPerMetre;
    return { left: x - radius, top: y - radius, right: x + radius, bottom: y + radius };
  }
  const corners = footprint.corners.map(plan.toPx);
  const xs = corners.map(([x]) => x);
  const ys = corners.map(([, y]) => y);
  return { left: Math.min(...xs), top: Math.min(...ys), right: Math.max(...xs), bottom: Math.max(...ys) };
}

function middleOf(footprint: Footprint): Point {
  if (footprint.kind === "disc") return footprint.centre;
  const count = Math.max(1, footprint.corners.length);
  return [
    footprint.corners.reduce((sum, [x]) => sum + x, 0) / count,
    footprint.corners.reduce((sum, [, y]) => sum + y, 0) / count,
  ];
}

function tracePath({ context, plan }: View, footprint: Footprint): void {
  if (footprint.kind === "disc") {
    disc(context, plan.toPx(footprint.centre), Math.max(2, footprint.radius * plan.pxPerMetre));
    return;
  }
  context.beginPath();
  footprint.corners.forEach((corner, index) => {
    const [x, y] = plan.toPx(corner);
    if (index === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  });
  context.closePath();
}

function hatch(context: CanvasRenderingContext2D, box: Box, colour: string): void {
  const height = box.bottom - box.top;
  context.lineWidth = 1;
  for (let x = box.left - height; x < box.right; x += HATCH_PX) {
    line(context, [x, box.bottom], [x + height, box.top], colour);
  }
}

function disc(context: CanvasRenderingContext2D, [x, y]: Point, radius: number): void {
  context.beginPath();
  context.arc(x, y, Math.max(0, radius), 0, 2 * Math.PI);
}

function line(context: CanvasRenderingContext2D, from: Point, to: Point, colour: string): void {
  context.strokeStyle = colour;
  context.beginPath();
  context.moveTo(from[0], from[1]);
  context.lineTo(to[0], to[1]);
  context.stroke();
}

function strokeRect(context: CanvasRenderingContext2D, plan: Plan, min: Point, max: Point): void {
  const [left, top] = plan.toPx([min[0], max[1]]);
  context.strokeRect(left, top, (max[0] - min[0]) * plan.pxPerMetre, (max[1] - min[1]) * plan.pxPerMetre);
}

/** Text with a rim in the ground's colour, so that it reads over anything. */
function write({ context, palette }: View, text: string, [x, y]: Point, colour: string, font: string): void {
  context.font = font;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.lineJoin = "round";
  context.lineWidth = 3;
  context.strokeStyle = palette.ground;
  context.strokeText(text, x, y);
  context.fillStyle = colour;
  context.fillText(text, x, y);
}

const MARGIN_PX = 34;
const FONT_SMALL = "11px system-ui, sans-serif";
const FONT_LABEL = "600 12px system-ui, sans-serif";
/** The halo of an object of weight one, m. */
const HALO_M = 0.36;
const PREDICTED_RING_M = 0.26;
const COLUMN_SIZE_M: Point = [0.15, 0.15];
const LEAST_PROP_M = 0.05;
const FACING_M = 0.12;
/** The column's velocity is drawn as the way of this time. */
const LOOKAHEAD_SECS = 0.5;
const VIEW_M = 1.1;
/** Half the angle within which the paper counts an object as looked at: about 20 degrees. */
const VIEW_HALF_RAD = (20 * Math.PI) / 180;
const HEAD_M = 0.1;
/** Within this of the required distance the zone is drawn as near. */
const NEAR_M = 0.1;
const HATCH_PX = 9;
