/** What every picture is painted with: simple shapes, and text that is set once and then stamped. */
import type { Footprint, Plan, Point } from "../../lib/plan";
import type { Box } from "../../lib/placement";
import type { Palette } from "../../lib/theme";

/** A canvas whose unit is the CSS pixel, and what is needed to paint on it. */
export interface Brush {
  readonly context: CanvasRenderingContext2D;
  readonly palette: Palette;
  readonly plan: Plan;
  readonly widthPx: number;
  readonly heightPx: number;
  /** Device pixels to a CSS pixel. */
  readonly ratio: number;
  readonly text: Stamps;
}

/** A text, painted once. */
export interface Stamp {
  readonly canvas: HTMLCanvasElement;
  readonly widthPx: number;
}

/** Painted texts. Setting type is what costs most in a picture of two hundred names, and they hardly change. */
export class Stamps {
  readonly #stamps = new Map<string, Stamp>();
  #made = "";

  /** The text with a rim in the ground's colour, so that it reads over anything. */
  of(text: string, font: string, colour: string, rim: string, ratio: number): Stamp {
    const made = `${rim} ${ratio}`;
    if (made !== this.#made || this.#stamps.size > STAMPS_KEPT) {
      this.#stamps.clear();
      this.#made = made;
    }
    const key = `${font}|${colour}|${text}`;
    let stamp = this.#stamps.get(key);
    if (stamp === undefined) this.#stamps.set(key, (stamp = paintStamp(text, font, colour, rim, ratio)));
    return stamp;
  }
}

function paintStamp(text: string, font: string, colour: string, rim: string, ratio: number): Stamp {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d");
  if (context === null) return { canvas, widthPx: 0 };
  context.font = font;
  const widthPx = context.measureText(text).width;
  canvas.width = Math.ceil((widthPx + 2 * RIM_PX) * ratio);
  canvas.height = Math.ceil(STAMP_HEIGHT_PX * ratio);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.font = font;
  context.textBaseline = "middle";
  context.lineJoin = "round";
  context.lineWidth = 3;
  context.strokeStyle = rim;
  context.strokeText(text, RIM_PX, STAMP_HEIGHT_PX / 2);
  context.fillStyle = colour;
  context.fillText(text, RIM_PX, STAMP_HEIGHT_PX / 2);
  return { canvas, widthPx };
}

/** How wide a text is, px. */
export function widthOf({ text, palette, ratio }: Brush, words: string, font: string, colour: string): number {
  return text.of(words, font, colour, palette.ground, ratio).widthPx;
}

/** Writes a text about a point. */
export function write(brush: Brush, words: string, [x, y]: Point, colour: string, font: string): void {
  const { context, palette, ratio } = brush;
  const { canvas, widthPx } = brush.text.of(words, font, colour, palette.ground, ratio);
  if (canvas.width === 0) return;
  // On whole device pixels, else the text blurs.
  const left = Math.round((x - widthPx / 2 - RIM_PX) * ratio) / ratio;
  const top = Math.round((y - STAMP_HEIGHT_PX / 2) * ratio) / ratio;
  context.drawImage(canvas, left, top, canvas.width / ratio, canvas.height / ratio);
}

/** A path about a disc. */
export function disc(context: CanvasRenderingContext2D, [x, y]: Point, radius: number): void {
  context.beginPath();
  context.arc(x, y, Math.max(0, radius), 0, 2 * Math.PI);
}

/** A straight line. */
export function line(context: CanvasRenderingContext2D, from: Point, to: Point, colour: string): void {
  context.strokeStyle = colour;
  context.beginPath();
  context.moveTo(from[0], from[1]);
  context.lineTo(to[0], to[1]);
  context.stroke();
}

/** A line through points of the room. */
export function polyline({ context, plan }: Brush, points: readonly Point[]): void {
  context.beginPath();
  for (const [index, point] of points.entries()) {
    const [x, y] = plan.toPx(point);
    if (index === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  }
}

/** The edge of a rectangle of the room. */
export function strokeRect({ context, plan }: Brush, min: Point, max: Point): void {
  const [left, top] = plan.toPx([min[0], max[1]]);
  context.strokeRect(left, top, (max[0] - min[0]) * plan.pxPerMetre, (max[1] - min[1]) * plan.pxPerMetre);
}

/** A cross of two lines, upright or aslant. */
export function cross(context: CanvasRenderingContext2D, [x, y]: Point, armPx: number, colour: string, aslant: boolean): void {
  const [a, b] = aslant ? [armPx, armPx] : [armPx, 0];
  line(context, [x - a, y - b], [x + a, y + b], colour);
  line(context, [x - b, y + a], [x + b, y - a], colour);
}

/** A path about a footprint. */
export function tracePath(brush: Brush, footprint: Footprint): void {
  const { context, plan } = brush;
  if (footprint.kind === "disc") {
    disc(context, plan.toPx(footprint.centre), Math.max(2, footprint.radius * plan.pxPerMetre));
    return;
  }
  polyline(brush, footprint.corners);
  context.closePath();
}

/** The least box of the canvas about a footprint. */
export function pixelsAround(footprint: Footprint, plan: Plan): Box {
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

/** Slanting lines across a box. */
export function hatch(context: CanvasRenderingContext2D, box: Box, colour: string): void {
  const height = box.bottom - box.top;
  context.lineWidth = 1;
  for (let x = box.left - height; x < box.right; x += HATCH_PX) {
    line(context, [x, box.bottom], [x + height, box.top], colour);
  }
}

/** Numbers and notes. */
export const FONT_SMALL = "11px system-ui, sans-serif";
/** Names. */
export const FONT_LABEL = "600 12px system-ui, sans-serif";
const HATCH_PX = 9;
const RIM_PX = 2;
const STAMP_HEIGHT_PX = 18;
const STAMPS_KEPT = 2000;
