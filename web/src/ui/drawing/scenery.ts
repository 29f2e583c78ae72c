/** Paints what stays while people move: grid, arena, travel and keep-outs. */
import type { KeepOutDocument, MachineShape, SceneDocument } from "../../api/types";
import type { Bounds, Footprint, Point } from "../../lib/plan";
import { FONT_SMALL, hatch, line, pixelsAround, strokeRect, tracePath, write, type Brush } from "./brush";
import { footprintOfKeepOut, nameOf } from "./picture";

/** All of it. */
export function drawScenery(brush: Brush, bounds: Bounds, scene: SceneDocument | null, shape: MachineShape | null): void {
  drawGrid(brush, bounds);
  if (shape !== null) drawTravel(brush, shape);
  if (scene === null) return;
  brush.context.lineWidth = 2;
  brush.context.strokeStyle = brush.palette.arena;
  strokeRect(brush, scene.arena.min, scene.arena.max);
  for (const keepOut of scene.keep_outs ?? []) drawKeepOut(brush, keepOut);
}

/** Lines each half metre, closer when there is room for them; numbers stay in view wherever the picture is panned. */
export function drawGrid(brush: Brush, bounds: Bounds): void {
  const { context, palette, plan, heightPx } = brush;
  const parts = plan.pxPerMetre > CLOSE_PX ? 10 : 2;
  const numbered = plan.pxPerMetre > CLOSE_PX ? 5 : plan.pxPerMetre < FAR_PX ? 4 : 2;
  context.lineWidth = 1;
  const marks = (from: number, to: number): number[] => {
    const found: number[] = [];
    for (let mark = Math.ceil(from * parts - 1e-9); mark <= Math.floor(to * parts + 1e-9); mark += 1) found.push(mark);
    return found;
  };
  const numberOf = (mark: number, last: boolean): string | null => {
    if (mark % numbered !== 0) return null;
    return `${mark / parts}${last ? " m" : ""}`;
  };
  const [left, bottom] = plan.toPx(bounds.min);
  const [right, top] = plan.toPx(bounds.max);
  const across = marks(bounds.min[0], bounds.max[0]);
  for (const mark of across) {
    const [px] = plan.toPx([mark / parts, 0]);
    line(context, [px, bottom], [px, top], mark % parts === 0 ? palette.gridWhole : palette.grid);
  }
  const up = marks(bounds.min[1], bounds.max[1]);
  for (const mark of up) {
    const [, py] = plan.toPx([0, mark / parts]);
    line(context, [left, py], [right, py], mark % parts === 0 ? palette.gridWhole : palette.grid);
  }
  const lastOf = (all: readonly number[]): number | undefined => all.findLast((mark) => numberOf(mark, false) !== null);
  const lastAcross = lastOf(across);
  for (const mark of across) {
    const number = numberOf(mark, mark === lastAcross);
    if (number !== null) write(brush, number, [plan.toPx([mark / parts, 0])[0], Math.min(bottom + 13, heightPx - 9)], palette.muted, FONT_SMALL);
  }
  const lastUp = lastOf(up);
  for (const mark of up) {
    const number = numberOf(mark, mark === lastUp);
    if (number !== null) write(brush, number, [Math.max(left - 16, 14), Math.min(plan.toPx([0, mark / parts])[1], heightPx)], palette.muted, FONT_SMALL);
  }
}

function drawTravel(brush: Brush, shape: MachineShape): void {
  const { context, palette } = brush;
  const [minX, minY, maxX, maxY] = shape.travel_m;
  context.setLineDash([6, 5]);
  context.lineWidth = 1.25;
  context.strokeStyle = palette.travel;
  strokeRect(brush, [minX, minY], [maxX, maxY]);
  context.setLineDash([]);
}

function drawKeepOut(brush: Brush, keepOut: KeepOutDocument): void {
  const { context, palette, plan } = brush;
  const footprint = footprintOfKeepOut(keepOut);
  tracePath(brush, footprint);
  context.save();
  context.globalAlpha = 0.13;
  context.fillStyle = palette.keepOut;
  context.fill();
  context.globalAlpha = 0.5;
  context.clip();
  hatch(context, pixelsAround(footprint, plan), palette.keepOut);
  context.restore();
  tracePath(brush, footprint);
  context.lineWidth = 1.5;
  context.strokeStyle = palette.keepOut;
  context.stroke();
  write(brush, nameOf(keepOut), plan.toPx(middleOf(footprint)), palette.keepOut, FONT_SMALL);
}

function middleOf(footprint: Footprint): Point {
  if (footprint.kind === "disc") return footprint.centre;
  const count = Math.max(1, footprint.corners.length);
  return [
    footprint.corners.reduce((sum, [x]) => sum + x, 0) / count,
    footprint.corners.reduce((sum, [, y]) => sum + y, 0) / count,
  ];
}

/** From here on tenths of a metre have room, px to the metre. */
const CLOSE_PX = 260;
/** Below this only every second metre is numbered. */
const FAR_PX = 34;
