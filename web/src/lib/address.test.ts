import { expect, it } from "vitest";
import { addressOf, secondsOf, wholeNumber } from "./address";

it("reads what follows the view's name", () => {
  expect(addressOf("#/sessions/12?t=34.5")).toEqual({ parts: ["12"], query: new Map([["t", "34.5"]]) });
  expect(addressOf("#/scenes")).toEqual({ parts: [], query: new Map() });
  expect(addressOf("")).toEqual({ parts: [], query: new Map() });
});

it("takes numbers only as they are written in links", () => {
  expect([undefined, "", "0", "-1", "1.5", "1e3", "NaN", "9".repeat(16)].map(wholeNumber)).toEqual(Array(8).fill(null));
  expect(wholeNumber("12")).toBe(12);
  expect([undefined, "", "-1", "1e3", "Infinity"].map(secondsOf)).toEqual(Array(5).fill(null));
  expect(secondsOf("34.5")).toBe(34.5);
});
