import { describe, expect, it } from "vitest";
import type { ScenarioDocument } from "../api/types";
import { BOX, stateGraph } from "./stateGraph";

const way = (to: string): { readonly to: string } => ({ to });

const SCENARIO: ScenarioDocument = {
  initial: "a",
  states: [
    { id: "a", label: "first", transitions: [way("b"), way("c"), way("b")] },
    { id: "b", transitions: [way("d"), way("a")] },
    { id: "c", transitions: [way("c"), way("nowhere")] },
    { id: "d", final: true },
    { id: "island" },
  ],
};

describe("the graph of a scenario", () => {
  const graph = stateGraph(SCENARIO);
  const box = (id: string) => graph.boxes.find((known) => known.id === id);

  it("goes from left to right by how many ways it takes", () => {
    expect(box("a")?.x).toBeLessThan(box("b")?.x ?? 0);
    expect(box("b")?.x).toBe(box("c")?.x);
    expect(box("c")?.x).toBeLessThan(box("d")?.x ?? 0);
    expect(box("d")?.x).toBeLessThan(box("island")?.x ?? 0);
  });

  it("lays no box over another, and holds them all", () => {
    for (const one of graph.boxes) {
      expect(one.x + BOX.width).toBeLessThanOrEqual(graph.width);
      expect(one.y + BOX.height).toBeLessThanOrEqual(graph.height);
      for (const other of graph.boxes) {
        const apart = Math.abs(one.x - other.x) >= BOX.width || Math.abs(one.y - other.y) >= BOX.height;
        expect(one === other || apart).toBe(true);
      }
    }
  });

  it("draws each pair of states once, and none to what is not there", () => {
    expect(graph.arrows.map(({ from, to }) => `${from}-${to}`)).toEqual(["a-b", "a-c", "b-d", "b-a", "c-c"]);
  });
});
