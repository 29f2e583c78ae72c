import { describe, expect, it } from "vitest";
import { TRAIL_SECS, TrailKeeper, type Walker } from "./trails";

function state(x: number, tracked = true, homed = true): Walker {
  return { column: { position_m: [x, 0], homed }, persons: [{ id: 7, head_m: [x, 1, 1.7], tracked }] };
}

function walk(keeper: TrailKeeper, fromSecs: number, toSecs: number, tracked = true): void {
  for (let step = Math.round(fromSecs * 30); step < Math.round(toSecs * 30); step += 1) keeper.take(state(step / 30, tracked), (step / 30) * 1e6);
}

describe("trails", () => {
  it("keep the last seconds of the column and of every head", () => {
    const keeper = new TrailKeeper();
    walk(keeper, 0, 25);
    const { lines, nowMicros } = keeper.trails();
    expect(lines.map((line) => line.of)).toEqual(["column", 7]);
    for (const { points } of lines) {
      expect(nowMicros - (points[0]?.atMicros ?? 0)).toBeLessThanOrEqual(TRAIL_SECS * 1e6);
      expect(points.length).toBeGreaterThan(70);
      expect(points.length).toBeLessThanOrEqual(TRAIL_SECS * 10 + 2);
    }
  });

  it("leave a gap where a head was not tracked", () => {
    const keeper = new TrailKeeper();
    walk(keeper, 0, 2);
    walk(keeper, 2, 4, false);
    walk(keeper, 4, 5);
    const head = keeper.trails().lines.find((line) => line.of === 7);
    expect(head?.points.filter((point) => !point.joined).length).toBe(2);
    expect(keeper.trails().lines[0]?.points.filter((point) => !point.joined).length).toBe(1);
  });

  it("end for who is gone, do not begin before homing, and begin anew when time goes back", () => {
    const keeper = new TrailKeeper();
    keeper.take(state(0, true, false), 0);
    expect(keeper.trails().lines.map((line) => line.of)).toEqual([7]);
    keeper.take({ column: { position_m: [0, 0], homed: true }, persons: [] }, 11e6);
    expect(keeper.trails().lines.map((line) => line.of)).toEqual(["column"]);
    keeper.take(state(3), 1e6);
    expect(keeper.trails().lines.map((line) => line.points.length)).toEqual([1, 1]);
  });
});
