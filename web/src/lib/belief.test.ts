import { expect, it } from "vitest";
import type { ObjectState } from "../api/types";
import { sharesOf } from "./belief";

function object(id: string, probability: number): ObjectState {
  return { id, probability, weight: probability, prior: 1, enabled: true, column_place_m: [0, 0], arrival_secs: 0, touch_secs: null, late_by_s: null, in_time_probability: null, angle_rad: null, distance_m: null };
}

it("shows the likeliest objects, the others together, and none of them", () => {
  const objects = [object("a", 0.05), object("b", 0.4), object("c", 0.2), object("d", 0.08), object("e", 0.02)];
  const shares = sharesOf(objects, 0.25);
  expect(shares.map(({ of }) => ("id" in of ? of.id : of.kind))).toEqual(["b", "c", "d", "others", "none"]);
  expect(shares.at(3)).toEqual({ of: { kind: "others", count: 2 }, probability: expect.closeTo(0.07, 9) as number });
  expect(shares.reduce((sum, { probability }) => sum + probability, 0)).toBeCloseTo(1, 9);
});

it("shows no share that reads as 0 %, and nothing without a belief", () => {
  expect(sharesOf([object("a", 0.997), object("b", 0.003)], 0.0004).map(({ of }) => of.kind)).toEqual(["object"]);
  expect(sharesOf([object("a", 0)], 0)).toEqual([]);
});
