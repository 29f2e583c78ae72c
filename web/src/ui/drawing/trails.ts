/** Paints trails, the older the fainter. */
import { TRAIL_SECS, type Trails } from "../../lib/trails";
import type { Brush } from "./brush";

/** All of them, in a few steps of faintness. */
export function drawTrails({ context, palette, plan }: Brush, trails: Trails): void {
  context.lineWidth = 2;
  context.lineCap = "round";
  for (const { of, points } of trails.lines) {
    context.strokeStyle = of === "column" ? palette.column : palette.person;
    let shade = -1;
    let open = false;
    for (const [index, point] of points.entries()) {
      const before = points[index - 1];
      if (before === undefined || !point.joined) continue;
      const age = (trails.nowMicros - point.atMicros) / (TRAIL_SECS * 1e6);
      const next = Math.max(0, Math.min(SHADES - 1, Math.floor((1 - age) * SHADES)));
      const [x, y] = plan.toPx(point.at);
      if (next !== shade || !open) {
        if (open) context.stroke();
        shade = next;
        open = true;
        context.globalAlpha = 0.08 + (0.5 * (shade + 1)) / SHADES;
        context.beginPath();
      }
      const [fromX, fromY] = plan.toPx(before.at);
      context.moveTo(fromX, fromY);
      context.lineTo(x, y);
    }
    if (open) context.stroke();
  }
  context.lineCap = "butt";
  context.globalAlpha = 1;
}

const SHADES = 8;
