import { describe, expect, it } from "vitest";
import { GREATEST_ZOOM, LEAST_ZOOM, pannedBy, planOf, zoomedAbout, type Frame } from "./camera";
import type { Point } from "./plan";

const FRAME: Frame = { bounds: { min: [0, 0], max: [4, 2] }, widthPx: 500, heightPx: 300, marginPx: 50 };

function near(one: Point, other: Point): void {
  expect(one[0]).toBeCloseTo(other[0], 9);
  expect(one[1]).toBeCloseTo(other[1], 9);
}

describe("the camera", () => {
  it("goes from the room to the canvas and back", () => {
    for (const camera of [null, { centre: [1, 0.5], zoom: 3 }] as const) {
      const plan = planOf(FRAME, camera);
      near(plan.toRoom(plan.toPx([0.3, 1.7])), [0.3, 1.7]);
    }
  });

  it("keeps in its place what lies under the pointer", () => {
    const at: Point = [320, 190];
    const before = planOf(FRAME, null).toRoom(at);
    const closer = zoomedAbout(FRAME, null, 2, at);
    near(planOf(FRAME, closer).toRoom(at), before);
    near(planOf(FRAME, zoomedAbout(FRAME, closer, 1.7, at)).toRoom(at), before);
    expect(planOf(FRAME, closer).pxPerMetre).toBeCloseTo(2 * planOf(FRAME, null).pxPerMetre);
  });

  it("moves the picture with the hand that drags it", () => {
    const place: Point = [2, 1];
    const before = planOf(FRAME, null).toPx(place);
    near(planOf(FRAME, pannedBy(FRAME, null, [30, -12])).toPx(place), [before[0] + 30, before[1] - 12]);
  });

  it("never zooms beyond its limits, nor loses the arena", () => {
    expect(zoomedAbout(FRAME, null, 1e6, [0, 0]).zoom).toBe(GREATEST_ZOOM);
    expect(zoomedAbout(FRAME, null, 1e-6, [0, 0]).zoom).toBe(LEAST_ZOOM);
    expect(pannedBy(FRAME, null, [1e6, 1e6]).centre).toEqual([0, 2]);
    expect(pannedBy(FRAME, null, [-1e6, -1e6]).centre).toEqual([4, 0]);
  });
});
