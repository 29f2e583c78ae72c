/** Maps the room frame (x right, y up, m) to the canvas (x right, y down, CSS pixels), and back to shapes on the floor. */
import type { ObjectDocument } from "../api/types";

/** A point on the floor, m, or on the canvas, px. */
export type Point = readonly [number, number];

/** A rectangle of the room, m. */
export interface Bounds {
  readonly min: Point;
  readonly max: Point;
}

/** A scale and where the room's origin falls. */
export interface Plan {
  readonly pxPerMetre: number;
  readonly toPx: (point: Point) => Point;
  readonly toRoom: (point: Point) => Point;
}

/** The largest plan that shows the bounds whole, centred, with a margin in px. */
export function fitPlan(bounds: Bounds, widthPx: number, heightPx: number, marginPx: number): Plan {
  const spanX = Math.max(bounds.max[0] - bounds.min[0], LEAST_SPAN_M);
  const spanY = Math.max(bounds.max[1] - bounds.min[1], LEAST_SPAN_M);
  const pxPerMetre = Math.max(
    1,
    Math.min((widthPx - 2 * marginPx) / spanX, (heightPx - 2 * marginPx) / spanY),
  );
  const centre: Point = [(bounds.min[0] + bounds.max[0]) / 2, (bounds.min[1] + bounds.max[1]) / 2];
  return {
    pxPerMetre,
    toPx: ([x, y]) => [widthPx / 2 + (x - centre[0]) * pxPerMetre, heightPx / 2 - (y - centre[1]) * pxPerMetre],
    toRoom: ([px, py]) => [centre[0] + (px - widthPx / 2) / pxPerMetre, centre[1] - (py - heightPx / 2) / pxPerMetre],
  };
}

/** The least rectangle about both. */
export function boundsAround(one: Bounds, other: Bounds): Bounds {
  return {
    min: [Math.min(one.min[0], other.min[0]), Math.min(one.min[1], other.min[1])],
    max: [Math.max(one.max[0], other.max[0]), Math.max(one.max[1], other.max[1])],
  };
}

/** What an object covers on the floor. */
export type Footprint =
  | { readonly kind: "disc"; readonly centre: Point; readonly radius: number }
  | { readonly kind: "polygon"; readonly corners: readonly Point[] };

/** The object's shadow straight down. */
export function footprintOf(object: ObjectDocument): Footprint {
  const centre: Point = [object.position[0], object.position[1]];
  const shape = object.shape;
  switch (shape.kind) {
    case "sphere":
    case "cylinder":
      return { kind: "disc", centre, radius: shape.radius };
    case "box": {
      const [halfX, halfY] = [shape.size[0] / 2, shape.size[1] / 2];
      const corners: Point[] = [
        [-halfX, -halfY],
        [halfX, -halfY],
        [halfX, halfY],
        [-halfX, halfY],
      ];
      return { kind: "polygon", corners: corners.map((corner) => placed(corner, centre, object.yaw)) };
    }
    case "convex_mesh":
      return meshFootprint(shape.points, centre, object.yaw);
    case "triangle_mesh":
      return meshFootprint(shape.vertices, centre, object.yaw);
  }
}

/** The corners of the convex hull, counter-clockwise. */
export function convexHull(points: readonly Point[]): readonly Point[] {
  const sorted = [...points].sort((one, other) => one[0] - other[0] || one[1] - other[1]);
  if (sorted.length < 3) return sorted;
  const lower = chain(sorted);
  const upper = chain(sorted.reverse());
  return [...lower.slice(0, -1), ...upper.slice(0, -1)];
}

function chain(points: readonly Point[]): Point[] {
  const kept: Point[] = [];
  for (const point of points) {
    for (;;) {
      const last = kept.at(-1);
      const before = kept.at(-2);
      if (last === undefined || before === undefined || turns(before, last, point) > 0) break;
      kept.pop();
    }
    kept.push(point);
  }
  return kept;
}

/** Positive when the way from a over b to c turns left. */
function turns(a: Point, b: Point, c: Point): number {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

function meshFootprint(points: readonly (readonly [number, number, number])[], centre: Point, yaw: number): Footprint {
  const flat = points.map(([x, y]): Point => placed([x, y], centre, yaw));
  return { kind: "polygon", corners: convexHull(flat) };
}

function placed([x, y]: Point, centre: Point, yaw: number): Point {
  const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
  return [centre[0] + x * cos - y * sin, centre[1] + x * sin + y * cos];
}

const LEAST_SPAN_M = 0.5;
