import { describe, expect, it } from "vitest";
import type { ObjectDocument } from "../api/types";
import { elevationOf, heightsOf, wallOf } from "./elevation";

function object(shape: ObjectDocument["shape"], yaw = 0): ObjectDocument {
  return { id: "o", position: [1, 2, 1.5], yaw, shape, prior: 1, enabled: true };
}

function widthOf(shape: ReturnType<typeof elevationOf>): number {
  if (shape.kind === "disc") return 2 * shape.radius;
  const places = shape.corners.map(([place]) => place);
  return Math.max(...places) - Math.min(...places);
}

describe("seen from the side", () => {
  it.each([
    [object({ kind: "sphere", radius: 0.2 }), [1.3, 1.7]],
    [object({ kind: "cylinder", radius: 0.2, height: 1 }), [1, 2]],
    [object({ kind: "box", size: [0.4, 0.2, 3] }), [0, 3]],
    [object({ kind: "convex_mesh", points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0.4]] }), [1.5, 1.9]],
  ] as const)("an object reaches from its foot to its top", (document, [foot, top]) => {
    const heights = heightsOf(elevationOf(document, "x"));
    expect(heights[0]).toBeCloseTo(foot);
    expect(heights[1]).toBeCloseTo(top);
  });

  it("a box is as wide as it is turned", () => {
    const box: ObjectDocument["shape"] = { kind: "box", size: [2, 1, 1] };
    expect(widthOf(elevationOf(object(box), "x"))).toBeCloseTo(2);
    expect(widthOf(elevationOf(object(box), "y"))).toBeCloseTo(1);
    expect(widthOf(elevationOf(object(box, Math.PI / 2), "x"))).toBeCloseTo(1);
    expect(widthOf(elevationOf(object(box, Math.PI / 4), "x"))).toBeCloseTo(3 / Math.SQRT2);
  });

  it("a mesh turns with its heading", () => {
    const mesh = object({ kind: "triangle_mesh", vertices: [[0, 0, 0], [2, 0, 0], [0, 0, 1]], triangles: [[0, 1, 2]] }, Math.PI / 2);
    expect(widthOf(elevationOf(mesh, "x"))).toBeCloseTo(0);
    expect(widthOf(elevationOf(mesh, "y"))).toBeCloseTo(2);
  });

  it("the wall has room for a tall person and for the highest thing", () => {
    const floor = { min: [0, 1], max: [4, 6] } as const;
    expect(wallOf(floor, [], "x")).toEqual({ min: [0, 0], max: [4, 2.2] });
    expect(wallOf(floor, [1, 3], "y")).toEqual({ min: [1, 0], max: [6, 3.1] });
  });
});
