import { describe, expect, it, onTestFinished, vi } from "vitest";
import { useLanguage } from "../i18n";
import { decimal, millis, modeWords, pair, percent, span, timeOfDay } from "./format";

describe("values", () => {
  it.each([
    [0.04, "0.0 s"],
    [9.96, "10.0 s"],
    [59.9, "59 s"],
    [65, "1 min 05 s"],
    [7810, "2 h 10 min"],
    [-1, "0.0 s"],
  ])("a span of %d s reads %s", (secs, text) => {
    expect(span(secs)).toBe(text);
  });

  it("read with their units", () => {
    expect(millis(1.84)).toBe("1.8 ms");
    expect(millis(9.97)).toBe("10 ms");
    expect(percent(0.335)).toBe("34 %");
    expect(modeWords("latched_stop")).toBe("Latched stop");
    expect(timeOfDay("not a moment")).toBe("not a moment");
  });

  it("have a comma in French, and a semicolon between two", () => {
    vi.stubGlobal("document", { documentElement: {} });
    useLanguage("fr");
    onTestFinished(() => {
      useLanguage("en");
      vi.unstubAllGlobals();
    });
    expect(decimal(-0.5, 2)).toBe("-0,50");
    expect(pair([1.25, 3], 1)).toBe("1,3 ; 3,0");
    expect(span(0.42)).toBe("0,4 s");
  });
});
