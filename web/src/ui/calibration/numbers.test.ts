import { expect, it } from "vitest";
import { numbersOf } from "./numbers";

it("takes three numbers, with a point or a comma", () => {
  expect(numbersOf(["1", "-0.5", "0"])).toEqual([1, -0.5, 0]);
  expect(numbersOf(["1,25", " 2 ", ".5"])).toEqual([1.25, 2, 0.5]);
});

it("tells nothing from something else", () => {
  expect(numbersOf(["", " ", ""])).toBeNull();
  for (const typed of [["1", "", "0"], ["a", "1", "2"], ["1e3", "0", "0"], ["1.2.3", "0", "0"]] as const) {
    expect(numbersOf(typed)).toBe("bad");
  }
});
