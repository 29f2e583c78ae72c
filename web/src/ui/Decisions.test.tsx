// @vitest-environment happy-dom
import { cleanup, render, screen } from "@solidjs/testing-library";
import { afterEach, expect, it } from "vitest";
import { useLanguage } from "../i18n";
import { Decisions } from "./Decisions";
import { testLive } from "./testLive";

afterEach(() => {
  cleanup();
  useLanguage("en");
});

const says = (testId: string): string => screen.getByTestId(testId).textContent;

it("shows belief with none of them, place, route and arrival, each with its reason and by what it is decided", () => {
  const { live, show } = testLive();
  render(() => <Decisions live={live} />);
  show(0.1);
  expect(says("belief")).toMatch(/\d %/);
  expect(says("belief")).toContain("none of them 10 %");
  expect(says("decided-by-rule")).toContain("bayes");
  expect(says("decided-by-standing")).toContain("in-time");
  expect(says("decided-by-motion")).toContain("planner");
  expect(says("why-belief")).toMatch(/^Ada looks (at|\d+° beside) .+, \d\.\d\d m away$/);
  expect(says("why-place")).toContain("the most probable");
  expect(says("decided-route")).toMatch(/m to go/);
  expect(says("decided-arrival")).toMatch(/^in \d+\.\d s; the hand in/);
  useLanguage("fr");
  expect(says("why-belief")).toMatch(/^Ada regarde /);
});

it("claims nothing when nothing is decided, and says what the planner does not foresee", () => {
  const { live, show } = testLive();
  render(() => <Decisions live={live} />);
  expect(says("decided-place")).toBe("–");
  show(0.1, (state) => ({ ...state, column: { ...state.column, decision: null, serves: null, target_m: null, arrival_secs: null } }));
  expect(screen.queryByTestId("belief")).toBeNull();
  expect(["decided-place", "decided-route", "decided-arrival"].map(says)).toEqual(["–", "–", "–"]);
  expect(["why-belief", "why-arrival"].map((testId) => screen.queryByTestId(testId))).toEqual([null, null]);
  show(0.1, (state) => ({ ...state, column: { ...state.column, arrival_secs: null, committed: null } }));
  expect(says("decided-arrival")).toBe("not foreseen");
});
