import { describe, expect, it } from "vitest";
import { noSlots, put, windowOf, type Slots } from "./slots";

const SEC = 1e6;

function seen(...values: readonly (readonly [number, number])[]): Slots<number> {
  let history = noSlots<number>(0.5, 4);
  for (const [secs, value] of values) history = put(history, secs * SEC, (before) => Math.max(before ?? -Infinity, value));
  return history;
}

describe("the slots of the last minute", () => {
  it("merge what falls into one slot", () => {
    expect(windowOf(seen([1, 3], [1.2, 7], [1.4, 5]), 2)).toEqual([null, null, null, 7]);
  });

  it("keep a gap a gap, not a zero", () => {
    expect(windowOf(seen([1, 3], [2.1, 4]), 4)).toEqual([null, 3, null, 4]);
  });

  it("forget what is older than they keep", () => {
    const history = seen([0, 1], [0.5, 2], [1, 3], [1.5, 4], [2, 5]);
    expect(history.slots.map((slot) => slot.value)).toEqual([2, 3, 4, 5]);
    expect(seen([0, 1], [90, 2]).slots).toHaveLength(1);
  });

  it("move on while nothing arrives", () => {
    expect(windowOf(seen([1, 3], [1.5, 4]), 5)).toEqual([3, 4, null, null]);
    expect(windowOf(seen([1, 3]), 50)).toEqual([null, null, null, null]);
  });

  it("begin anew when the server began anew", () => {
    expect(seen([100, 1], [100.5, 2], [0.2, 9]).slots).toEqual([{ index: 0, value: 9 }]);
  });
});
