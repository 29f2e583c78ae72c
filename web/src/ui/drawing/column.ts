/** Paints the column: where it is, where it is wanted, and where it means to go. */
import type { SceneDocument } from "../../api/types";
import type { Point } from "../../lib/plan";
import { cross, disc, FONT_SMALL, line, polyline, write, type Brush } from "./brush";
import { words } from "../../i18n";
import type { ArenaState, Ghost } from "./picture";

/** The way ahead: a line, and a dot for each half second of it. */
export function drawPlannedPath(brush: Brush, { column }: ArenaState): void {
  const path = column.planned_path_m ?? [];
  if (path.length < 2) return;
  const { context, palette, plan } = brush;
  context.globalAlpha = 0.85;
  context.lineWidth = 2.5;
  context.strokeStyle = palette.column;
  context.lineJoin = "round";
  polyline(brush, path);
  context.stroke();
  context.fillStyle = palette.column;
  for (const [index, point] of path.entries()) {
    if (index % PATH_DOT_EVERY !== 0 || index === 0) continue;
    disc(context, plan.toPx(point), 3.5);
    context.fill();
  }
  context.globalAlpha = 1;
}

/** Where it would go instead: dashed, with an empty target, and said so. */
export function drawGhost(brush: Brush, ghost: Ghost): void {
  const { context, palette, plan } = brush;
  context.setLineDash([3, 5]);
  context.lineWidth = 2;
  context.strokeStyle = palette.text;
  if (ghost.path_m.length > 1) {
    polyline(brush, ghost.path_m);
    context.stroke();
  }
  context.setLineDash([]);
  if (ghost.target_m === null) return;
  const at = plan.toPx(ghost.target_m);
  disc(context, at, 11);
  context.strokeStyle = palette.text;
  context.stroke();
  cross(context, at, 5, palette.text, true);
  write(brush, words().live.preview, [at[0], at[1] - 20], palette.text, FONT_SMALL);
}

/** The column with its props, its velocity, target, proxy and command. */
export function drawColumn(brush: Brush, { column }: ArenaState, scene: SceneDocument | null): void {
  const { context, palette, plan } = brush;
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
  if (column.target_m !== null) {
    context.lineWidth = 2;
    cross(context, plan.toPx(column.target_m), 6, palette.predicted, true);
  }
  context.lineWidth = 1.5;
  context.strokeStyle = palette.text;
  disc(context, plan.toPx(column.proxy_m), 5);
  context.stroke();
  cross(context, plan.toPx(column.commanded_m), 8, palette.text, false);
}

/** The column's footprint while no scene says it, m. */
export const COLUMN_SIZE_M: Point = [0.15, 0.15];
/** The planned path has a point each 0.1 s. */
const PATH_DOT_EVERY = 5;
const LEAST_PROP_M = 0.05;
const FACING_M = 0.12;
/** The column's velocity is drawn as the way of this time. */
const LOOKAHEAD_SECS = 0.5;
