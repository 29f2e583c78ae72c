import { describe, expect, it } from "vitest";
import type { ObjectDocument } from "../api/types";
import { boundsAround, convexHull, fitPlan, footprintOf } from "./plan";

const ARENA = { min: [0, 0], max: [4, 2] } as const;

function object(shape: ObjectDocument["shape"], yaw: number): ObjectDocument {
  return { id: "o", position: [1, 2, 1], yaw, shape, prior: 1, enabled: true };
}

describe("the plan", () => {
  it("shows x to the right and y up, whole and centred", () => {
    const plan = fitPlan(ARENA, 500, 500, 50);
    expect(plan.pxPerMetre).toBe(100);
    expect(plan.toPx([0, 0])).toEqual([50, 350]);
    expect(plan.toPx([4, 2])).toEqual([450, 150]);
  });

  it("keeps a scale in a window smaller than its margins", () => {
    expect(fitPlan(ARENA, 20, 20, 50).pxPerMetre).toBe(1);
  });

  it("covers both rectangles", () => {
    expect(boundsAround(ARENA, { min: [-1, 0.5], max: [3, 3] })).toEqual({ min: [-1, 0], max: [4, 3] });
  });
});

describe("a footprint", () => {
  it("of a ball is a disc", () => {
    expect(footprintOf(object({ kind: "sphere", radius: 0.1 }, 0))).toEqual({ kind: "disc", centre: [1, 2], radius: 0.1 });
  });

  it("of a turned box turns counter-clockwise with its heading", () => {
    const footprint = footprintOf(object({ kind: "box", size: [2, 1, 1] }, Math.PI / 2));
    if (footprint.kind !== "polygon") throw new Error("a box is a polygon");
    const [first] = footprint.corners;
    expect(first?.[0]).toBeCloseTo(1.5);
    expect(first?.[1]).toBeCloseTo(1);
  });

  it("of a mesh is its hull", () => {
    const points: [number, number, number][] = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 1], [0, 0, 3]];
    const footprint = footprintOf(object({ kind: "convex_mesh", points }, 0));
    expect(footprint).toMatchObject({ kind: "polygon", corners: { length: 4 } });
  });
});

describe("the hull", () => {
  it("goes counter-clockwise and leaves out what lies inside or on an edge", () => {
    const hull = convexHull([[0, 0], [2, 0], [1, 0], [2, 2], [1, 1], [0, 2], [0, 1]]);
    expect(hull).toEqual([[0, 0], [2, 0], [2, 2], [0, 2]]);
  });

  it("of fewer than three points is those points", () => {
    expect(convexHull([[1, 1], [0, 0]])).toEqual([[0, 0], [1, 1]]);
  });
});
