import { describe, expect, it } from "vitest";
import { bindingMetres, nearnessOf, ringsOf } from "./separation";

const TERMS = { radius_m: 0.45, reaction_m: 0.06, braking_m: 0.2, walking_m: 0.1, age_m: 0, binding: "braking" } as const;

describe("the separation rule's terms", () => {
  it("are rings that add up, without one of nothing", () => {
    const rings = ringsOf(TERMS);
    expect(rings.map((ring) => ring.term)).toEqual(["radius", "reaction", "braking", "walking"]);
    expect(rings.at(-1)?.outer).toBeCloseTo(0.81);
    expect(rings.filter((ring) => ring.binds).map((ring) => ring.term)).toEqual(["braking"]);
    expect(bindingMetres(TERMS)).toBe(0.2);
  });

  it.each([
    [0.8, 0.81, "breached"],
    [0.81, 0.81, "near"],
    [0.9, 0.81, "near"],
    [0.92, 0.81, "clear"],
  ] as const)("%d m away where %d m are required is %s", (distance_m, required_m, nearness) => {
    expect(nearnessOf({ distance_m, required_m })).toBe(nearness);
  });
});
