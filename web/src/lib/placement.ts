/** Decides where names are written in the top view, so that none covers another; what finds no place is left out. */
import type { Point } from "./plan";

/** A rectangle of the canvas, px. */
export interface Box {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

/** Two lines about a thing: its name, and a number under it. */
export interface Label {
  readonly name: string;
  readonly number: string;
  readonly nameWidth: number;
  readonly numberWidth: number;
  /** The thing itself. */
  readonly about: Box;
  /** The most urgent finds its place first; infinity is written in any case. */
  readonly urgency: number;
}

/** From the middle of the first line to that of the second, px. */
export const LINE_PX = 14;

/** Places labels above, below, right or left of their things; `at` is the middle of the first line. */
export function placeLabels<L extends Label>(
  labels: readonly L[],
  taken: readonly Box[],
): readonly { readonly label: L; readonly at: Point }[] {
  const occupied = [...taken];
  const placed: { label: L; at: Point }[] = [];
  for (const label of [...labels].sort((one, other) => other.urgency - one.urgency)) {
    const candidates = placesFor(label);
    const free = candidates.find((at) => !occupied.some((box) => overlap(box, boxOf(label, at))));
    const at = free ?? (label.urgency === Infinity ? candidates[0] : undefined);
    if (at === undefined) continue;
    occupied.push(boxOf(label, at));
    placed.push({ label, at });
  }
  return placed;
}

function placesFor({ about, nameWidth, numberWidth }: Label): readonly Point[] {
  const x = (about.left + about.right) / 2;
  const y = (about.top + about.bottom) / 2 - LINE_PX / 2;
  const half = Math.max(nameWidth, numberWidth) / 2;
  return [
    [x, about.top - GAP_PX - LINE_PX * 1.5],
    [x, about.bottom + GAP_PX + LINE_PX / 2],
    [about.right + GAP_PX + half, y],
    [about.left - GAP_PX - half, y],
    [x, y],
  ];
}

function boxOf({ nameWidth, numberWidth }: Label, [x, y]: Point): Box {
  const half = Math.max(nameWidth, numberWidth) / 2 + 1;
  return { left: x - half, top: y - LINE_PX / 2, right: x + half, bottom: y + LINE_PX * 1.5 };
}

function overlap(one: Box, other: Box): boolean {
  return one.left < other.right && other.left < one.right && one.top < other.bottom && other.top < one.bottom;
}

const GAP_PX = 4;
