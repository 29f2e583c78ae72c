/** What an object covers seen from the side: along x or y to the right, z up, m. */
import type { ObjectDocument } from "../api/types";
import { convexHull, type Bounds, type Footprint, type Point } from "./plan";

/** The floor's axis that lies to the right. */
export type SideAxis = "x" | "y";

/** The part of a place along the axis. */
export function along(axis: SideAxis, place: Point | readonly [number, number, number]): number {
  return axis === "x" ? place[0] : place[1];
}

/** The object's shadow on the wall. */
export function elevationOf(object: ObjectDocument, axis: SideAxis): Footprint {
  const { shape, yaw, position } = object;
  const middle = along(axis, position);
  const z = position[2];
  switch (shape.kind) {
    case "sphere":
      return { kind: "disc", centre: [middle, z], radius: shape.radius };
    case "cylinder":
      return rectangle(middle, z, shape.radius, shape.height / 2);
    case "box": {
      const [halfX, halfY] = [shape.size[0] / 2, shape.size[1] / 2];
      const [cos, sin] = [Math.abs(Math.cos(yaw)), Math.abs(Math.sin(yaw))];
      return rectangle(middle, z, axis === "x" ? halfX * cos + halfY * sin : halfX * sin + halfY * cos, shape.size[2] / 2);
    }
    case "convex_mesh":
      return hullOf(shape.points, object, axis);
    case "triangle_mesh":
      return hullOf(shape.vertices, object, axis);
  }
}

/** From its lowest to its highest point, m above the floor. */
export function heightsOf(elevation: Footprint): readonly [number, number] {
  if (elevation.kind === "disc") return [elevation.centre[1] - elevation.radius, elevation.centre[1] + elevation.radius];
  const heights = elevation.corners.map(([, z]) => z);
  return [Math.min(...heights), Math.max(...heights)];
}

/** The wall that shows the floor's extent and everything that stands on it. */
export function wallOf(floor: Bounds, tops: readonly number[], axis: SideAxis): Bounds {
  const highest = tops.reduce((top, next) => Math.max(top, next), LEAST_WALL_M - ABOVE_M);
  return { min: [along(axis, floor.min), 0], max: [along(axis, floor.max), highest + ABOVE_M] };
}

function rectangle(middle: number, z: number, halfWide: number, halfHigh: number): Footprint {
  return {
    kind: "polygon",
    corners: [
      [middle - halfWide, z - halfHigh],
      [middle + halfWide, z - halfHigh],
      [middle + halfWide, z + halfHigh],
      [middle - halfWide, z + halfHigh],
    ],
  };
}

function hullOf(points: readonly (readonly [number, number, number])[], { position, yaw }: ObjectDocument, axis: SideAxis): Footprint {
  const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
  const flat = points.map(([x, y, z]): Point => [along(axis, position) + (axis === "x" ? x * cos - y * sin : x * sin + y * cos), position[2] + z]);
  return { kind: "polygon", corners: convexHull(flat) };
}

/** Room for a tall person, m. */
const LEAST_WALL_M = 2.2;
const ABOVE_M = 0.1;
