// @vitest-environment happy-dom
import { cleanup, fireEvent, render, screen } from "@solidjs/testing-library";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import * as http from "../api/http";
import type { PriorChange } from "../api/types";
import { Priors, type PriorGhost } from "./Priors";
import { testLive, type TestLive } from "./testLive";

vi.mock("../api/http", { spy: true });

let desk: TestLive;
let ghost: PriorGhost | null;
let changes: PriorChange[];

beforeEach(() => {
  desk = testLive();
  desk.show(0.1);
  ghost = null;
  changes = [];
  vi.mocked(http.listPriorChanges).mockImplementation(() => Promise.resolve([...changes]));
  vi.mocked(http.previewPriors).mockImplementation((priors) => {
    const found = desk.machine.preview(priors);
    return "unknown" in found ? Promise.reject(new Error("no such object")) : Promise.resolve(found);
  });
  vi.mocked(http.changePriors).mockImplementation((priors, author) => {
    setPriors(priors, author);
    return Promise.resolve();
  });
  render(() => <Priors live={desk.live} author="Grace" onGhost={(next) => { ghost = next; }} />);
});
afterEach(() => {
  cleanup();
  vi.clearAllMocks();
});

/** What the server does at anybody's change. */
function setPriors(priors: Readonly<Record<string, number>>, author: string): void {
  for (const [object, to] of Object.entries(priors)) {
    const from = desk.machine.setPrior(object, to) ?? 0;
    changes.unshift({ at: new Date().toISOString(), author, object, from, to, scene_id: 1, scene_version: 1 });
    desk.machine.event("prior_changed", "", { author, object, from, to });
  }
  desk.show(0.1);
}

function priorOf(id: string): number | undefined {
  return desk.machine.snapshot().objects.find((object) => object.id === id)?.prior;
}

function slide(id: string, value: number): void {
  fireEvent.input(screen.getByTestId(`prior-${id}`), { target: { value: String(value) } });
}

function type(id: string, text: string): void {
  fireEvent.change(screen.getByTestId(`prior-number-${id}`), { target: { value: text } });
}

it("shows what an edit would lead to, and applies nothing before it is told to", async () => {
  slide("bulb", 0);
  type("rock", "0,25");
  await vi.waitFor(() => {
    expect(screen.getByTestId("prior-preview").dataset["state"]).toBe("shown");
  });
  expect(vi.mocked(http.previewPriors).mock.lastCall?.[0]).toEqual({ bulb: 0, rock: 0.25 });
  expect(screen.getByTestId("prior-would-serve").textContent).toMatch(/ for Ada$/);
  expect(ghost?.target_m).toHaveLength(2);
  expect(http.changePriors).not.toHaveBeenCalled();
  expect(screen.getByTestId("prior-value-bulb").textContent).toBe("1.00");
  fireEvent.click(screen.getByTestId("prior-apply"));
  await vi.waitFor(() => {
    expect(screen.getByTestId("prior-value-bulb").textContent).toBe("0.00");
  });
  expect(http.changePriors).toHaveBeenCalledExactlyOnceWith({ bulb: 0, rock: 0.25 }, "Grace");
  await vi.waitFor(() => {
    expect(ghost).toBeNull();
  });
  expect(screen.queryByTestId("prior-preview")).toBeNull();
});

it("discards edits", () => {
  slide("bulb", 0.3);
  fireEvent.click(screen.getByTestId("prior-discard"));
  expect(screen.queryByTestId("prior-edited-bulb")).toBeNull();
  expect(screen.getByTestId("prior-apply").hasAttribute("disabled")).toBe(true);
});

it("refuses text and numbers out of range, and does not apply them by Enter", () => {
  type("bulb", "high");
  expect(screen.getByTestId("prior-wrong-bulb").textContent).toBe("“high” is not a number; expected 0 to 1");
  type("bulb", "1.5");
  expect(screen.getByTestId("prior-wrong-bulb").textContent).toBe("1.5 is out of range; expected 0 to 1");
  fireEvent.keyDown(screen.getByTestId("prior-number-bulb"), { key: "Enter" });
  expect(http.changePriors).not.toHaveBeenCalled();
  expect(screen.getByTestId("prior-apply").hasAttribute("disabled")).toBe(true);
  type("bulb", "0.5");
  expect(screen.queryByTestId("prior-wrong-bulb")).toBeNull();
});

it("applies by Enter, and undoes its own last apply by Ctrl+Z", async () => {
  type("bulb", "0.5");
  fireEvent.keyDown(screen.getByTestId("prior-number-bulb"), { key: "Enter" });
  await vi.waitFor(() => {
    expect(priorOf("bulb")).toBe(0.5);
  });
  const undo = screen.getByTestId("prior-undo");
  await vi.waitFor(() => {
    expect(undo.textContent).toContain("Light bulb 0.50 → 1.00");
  });
  fireEvent.keyDown(screen.getByTestId("prior-bulb"), { key: "z", ctrlKey: true });
  await vi.waitFor(() => {
    expect(priorOf("bulb")).toBe(1);
  });
  await vi.waitFor(() => {
    expect(undo.hasAttribute("disabled")).toBe(true);
  });
});

it("undoes what was applied before the page was read again", async () => {
  slide("bulb", 0.5);
  fireEvent.click(screen.getByTestId("prior-apply"));
  await vi.waitFor(() => {
    expect(priorOf("bulb")).toBe(0.5);
  });
  cleanup();
  render(() => <Priors live={desk.live} author="Grace" />);
  await vi.waitFor(() => {
    expect(screen.getByTestId("prior-undo").textContent).toContain("Light bulb 0.50 → 1.00");
  });
  fireEvent.click(screen.getByTestId("prior-undo"));
  await vi.waitFor(() => {
    expect(priorOf("bulb")).toBe(1);
  });
});

it("asks before it undoes what somebody else has changed since", async () => {
  slide("bulb", 0.5);
  fireEvent.click(screen.getByTestId("prior-apply"));
  await vi.waitFor(() => {
    expect(screen.getByTestId("prior-undo").hasAttribute("disabled")).toBe(false);
  });
  desk.machine.event("scene_event", "bell", { name: "bell" });
  setPriors({ bulb: 0.2 }, "Bo");
  await vi.waitFor(() => {
    expect(screen.getByTestId("prior-last-change").textContent).toContain("Bo: Light bulb 0.50 → 0.20");
  });
  fireEvent.click(screen.getByTestId("prior-undo"));
  expect(screen.getByTestId("prior-question").textContent).toContain("Light bulb 0.20 (Bo)");
  expect(priorOf("bulb")).toBe(0.2);
  fireEvent.click(screen.getByTestId("prior-question-yes"));
  await vi.waitFor(() => {
    expect(priorOf("bulb")).toBe(1);
  });
});

it("shows another's change at once, keeps one's own edit marked, and asks before overwriting", async () => {
  slide("bulb", 0.5);
  setPriors({ bulb: 0.9, rock: 0.1 }, "Bo");
  expect(screen.getByTestId("prior-value-bulb").textContent).toBe("0.90");
  expect(screen.getByTestId("prior-value-rock").textContent).toBe("0.10");
  await vi.waitFor(() => {
    expect(screen.getByTestId("prior-overtaken-bulb").textContent).toBe("Bo set 0.90 meanwhile");
  });
  fireEvent.click(screen.getByTestId("prior-apply"));
  expect(http.changePriors).not.toHaveBeenCalled();
  fireEvent.click(screen.getByTestId("prior-question-no"));
  expect(priorOf("bulb")).toBe(0.9);
  expect(screen.getByTestId("prior-edited-bulb").textContent).toContain("0.90");
});

it("freezes with the reason when the state is stale, and keeps the edits", () => {
  slide("bulb", 0.5);
  desk.setFreshness({ kind: "stale", ageMillis: 900 });
  expect(screen.getByTestId("prior-status").textContent).toContain("Stale: priors cannot be changed.");
  for (const id of ["prior-bulb", "prior-number-bulb", "prior-apply", "preset-equal"]) expect(screen.getByTestId(id).hasAttribute("disabled")).toBe(true);
  fireEvent.keyDown(screen.getByTestId("prior-bulb"), { key: "Enter" });
  expect(http.changePriors).not.toHaveBeenCalled();
  desk.show(0.1);
  expect(screen.getByTestId("prior-edited-bulb")).toBeTruthy();
});

it("says what the server refused, and keeps the edit", async () => {
  vi.mocked(http.changePriors).mockRejectedValueOnce(new Error("bulb: found 2, expected a number from 0 to 1"));
  vi.mocked(http.previewPriors).mockRejectedValue(new Error("no preview while faulted"));
  slide("bulb", 0.5);
  await vi.waitFor(() => {
    expect(screen.getByTestId("prior-preview-failed").textContent).toBe("No preview: no preview while faulted");
  });
  expect(ghost).toBeNull();
  fireEvent.click(screen.getByTestId("prior-apply"));
  await vi.waitFor(() => {
    expect(screen.getByTestId("prior-status").textContent).toBe("Not applied: bulb: found 2, expected a number from 0 to 1");
  });
  expect(screen.getByTestId("prior-edited-bulb")).toBeTruthy();
});

it("undoes nothing of before another activation", async () => {
  slide("bulb", 0.5);
  fireEvent.click(screen.getByTestId("prior-apply"));
  await vi.waitFor(() => {
    expect(screen.getByTestId("prior-undo").hasAttribute("disabled")).toBe(false);
  });
  desk.machine.event("scene_activated", "the same scene anew", null);
  expect(screen.getByTestId("prior-undo").hasAttribute("disabled")).toBe(true);
});

it("edits to the scene's own priors and to equal ones", () => {
  fireEvent.click(screen.getByTestId("preset-equal"));
  expect(screen.getByTestId("prior-status").textContent).toContain("1 prior changed");
  expect(screen.getByTestId("prior-edited-lever")).toBeTruthy();
  fireEvent.click(screen.getByTestId("preset-scene"));
  expect(screen.queryByTestId("prior-edited-lever")).toBeNull();
});
