import { expect, it } from "vitest";
import type { ObjectState, WireEvent } from "../api/types";
import { barsOf, heavierThan, NO_WEIGHTS, servedIn, weigh } from "./weights";

const SEC = 1e6;

function object(id: string, weight: number): ObjectState {
  return { id, weight, probability: 0, prior: 1, enabled: true, column_place_m: [0, 0], arrival_secs: 1, touch_secs: null, late_by_s: null, in_time_probability: null, angle_rad: null, distance_m: null };
}

function after(...moments: readonly (readonly [number, readonly ObjectState[], string | null])[]): typeof NO_WEIGHTS {
  return moments.reduce((history, [secs, objects, committed]) => {
    const column = { committed } as Parameters<typeof weigh>[1]["column"];
    return weigh(history, { at_micros: secs * SEC, objects: [...objects], column });
  }, NO_WEIGHTS);
}

it("keeps the greatest weight of each half second, and what the column was committed to", () => {
  const history = after([10, [object("lamp", 0.2)], null], [10.1, [object("lamp", 0.6)], "lamp"], [10.3, [object("lamp", 0.4)], "lamp"]);
  expect(barsOf(history, "lamp", 10.4 * SEC).at(-1)).toEqual({ weight: 0.6, committed: true });
});

it("shows nothing, not zero, where an object or the connection was not there", () => {
  const history = after([10, [object("lamp", 0.2)], null], [11.2, [object("lamp", 0), object("door", 0.7)], "door"]);
  expect(barsOf(history, "lamp", 11.2 * SEC).slice(-3)).toEqual([{ weight: 0.2, committed: false }, null, { weight: 0, committed: false }]);
  expect(barsOf(history, "door", 11.2 * SEC).slice(-3)).toEqual([null, null, { weight: 0.7, committed: true }]);
});

it("filters by what was heavy at some time of the minute, so that rows do not jump about", () => {
  const now = [object("lamp", 0.01), object("door", 0.02), object("desk", 0.5)];
  const history = after([10, [object("lamp", 0.4), object("door", 0.02)], null], [11, now, null]);
  expect(heavierThan(history, now, 0.1, 11 * SEC).map(({ id }) => id)).toEqual(["lamp", "desk"]);
  expect(heavierThan(history, now, 0.1, 75 * SEC).map(({ id }) => id)).toEqual(["desk"]);
});

it("places the moments when an object was served in its strip", () => {
  const served = (secs: number, id: unknown): WireEvent => ({ at_micros: secs * SEC, at: "", kind: "served", summary: "", detail: { object: id } });
  const found = servedIn(NO_WEIGHTS, [served(99.9, "lamp"), served(40, "lamp"), served(39, "lamp"), served(60, null)], 99.9 * SEC);
  expect([...found]).toEqual([["lamp", [119, 0]]]);
});
