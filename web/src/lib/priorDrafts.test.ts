import { describe, expect, it } from "vitest";
import type { PriorChange } from "../api/types";
import { edit, editsTo, overtaken, overwritten, readPrior, setBacksOf, settle, undoable, wanted } from "./priorDrafts";

describe("a typed prior", () => {
  it("is a number from 0 to 1, with a point or a comma", () => {
    expect(["0", "1", "0.4", "0,4", " .5 ", "1."].map(readPrior)).toEqual([0, 1, 0.4, 0.4, 0.5, 1].map((value) => ({ value })));
  });

  it("is refused when it is text, empty, or outside", () => {
    for (const text of ["", "high", "0.4x", "1e-1", "NaN", "0.4.1", "1,0,0"]) expect(readPrior(text)).toEqual({ wrong: "not_a_number" });
    for (const text of ["1.01", "-0.1", "12"]) expect(readPrior(text)).toEqual({ wrong: "out_of_range" });
  });
});

describe("edits", () => {
  const now = { lamp: 0.5, door: 1 };

  it("are kept until they are back at what is in force", () => {
    const moved = edit(edit({}, "lamp", 0.7, 0.5), "door", 0.2, 1);
    expect(wanted(moved)).toEqual({ lamp: 0.7, door: 0.2 });
    expect(wanted(edit(moved, "lamp", 0.5, 0.5))).toEqual({ door: 0.2 });
  });

  it("stay when somebody else changes the object, and are marked", () => {
    const mine = edit({}, "lamp", 0.7, 0.5);
    expect(overtaken(mine, now)).toEqual([]);
    const changed = { lamp: 0.1, door: 1 };
    expect(settle(mine, changed)).toBe(mine);
    expect(overtaken(mine, changed)).toEqual(["lamp"]);
    expect(overtaken(edit(mine, "lamp", 0.8, 0.1), changed)).toEqual(["lamp"]);
  });

  it("go when the scene has no such object, or when somebody set just that", () => {
    const mine = edit(edit({}, "lamp", 0.7, 0.5), "door", 0.2, 1);
    expect(wanted(settle(mine, { door: 1 }))).toEqual({ door: 0.2 });
    expect(wanted(settle(mine, { lamp: 0.7, door: 1 }))).toEqual({ door: 0.2 });
  });

  it("of a preset leave out what is so already", () => {
    expect(wanted(editsTo({}, { lamp: 1, door: 1, ghost: 1 }, now))).toEqual({ lamp: 1 });
  });
});

describe("setting back", () => {
  it("knows what an apply changed, and what was overwritten since", () => {
    const now = { lamp: 0.5, door: 1 };
    const changes = setBacksOf(edit(edit({}, "lamp", 0.7, 0.5), "door", 0.2, 1), now);
    expect(changes).toEqual([{ object: "lamp", from: 0.5, to: 0.7 }, { object: "door", from: 1, to: 0.2 }]);
    expect(overwritten(changes, { lamp: 0.7, door: 0.2 })).toEqual([]);
    expect(overwritten(changes, { lamp: 0.7, door: 0.9 })).toEqual([changes[1]]);
    expect(overwritten(changes, { door: 0.2 })).toEqual([changes[0]]);
  });
});

describe("what can be undone", () => {
  let second = 0;
  const change = (author: string, object: string, from: number, to: number, at = `2026-01-01T00:00:${String(++second).padStart(2, "0")}Z`): PriorChange => ({
    at, author, object, from, to, scene_id: 1, scene_version: 1,
  });
  const list = (...oldestFirst: PriorChange[]): PriorChange[] => oldestFirst.reverse();

  it("are an author's applies, several priors at once being one", () => {
    const changes = list(change("Ada", "lamp", 0.5, 0.7, "a"), change("Ada", "door", 1, 0, "a"), change("Bo", "door", 0, 0.3), change("Ada", "lamp", 0.7, 0.1));
    const now = { lamp: 0.1, door: 0.3 };
    expect(undoable(changes, "Ada", now)).toEqual([
      [{ object: "door", from: 1, to: 0 }, { object: "lamp", from: 0.5, to: 0.7 }],
      [{ object: "lamp", from: 0.7, to: 0.1 }],
    ]);
    expect(undoable(changes, "Cy", now)).toEqual([]);
  });

  it("is not what was set back already, nor the setting back", () => {
    const changes = list(change("Ada", "lamp", 0.5, 0.7), change("Ada", "lamp", 0.7, 0.1), change("Ada", "lamp", 0.1, 0.7));
    expect(undoable(changes, "Ada", { lamp: 0.7 })).toEqual([[{ object: "lamp", from: 0.5, to: 0.7 }]]);
  });

  it("ends where an activation set the priors anew", () => {
    expect(undoable(list(change("Ada", "lamp", 0.5, 0.7)), "Ada", { lamp: 0.5 })).toEqual([]);
    expect(undoable(list(change("Ada", "lamp", 0.5, 0.7), change("Ada", "lamp", 0.5, 0.9)), "Ada", { lamp: 0.9 })).toHaveLength(1);
    expect(undoable(list(change("Ada", "lamp", 0.5, 0.7)), "Ada", { door: 1 })).toEqual([]);
  });
});
