import { describe, expect, it } from "vitest";
import { LINE_PX, placeLabels, type Label } from "./placement";

function label(name: string, x: number, y: number, urgency: number): Label {
  return { name, number: "0.50", nameWidth: 60, numberWidth: 24, about: { left: x - 10, top: y - 10, right: x + 10, bottom: y + 10 }, urgency };
}

describe("names in the top view", () => {
  it("stand above their things where nothing is in the way", () => {
    const [only] = placeLabels([label("lamp", 100, 100, 0.5)], []);
    expect(only?.at[0]).toBe(100);
    expect(only?.at[1]).toBeLessThan(90 - LINE_PX);
  });

  it("never cover each other, however crowded", () => {
    const crowd = Array.from({ length: 40 }, (_, index) => label(`thing ${index}`, 100 + (index % 8) * 25, 100 + Math.floor(index / 8) * 25, index));
    const boxes = placeLabels(crowd, []).map(({ at: [x, y] }) => ({ left: x - 30, right: x + 30, top: y - 7, bottom: y + 21 }));
    expect(boxes.length).toBeGreaterThan(4);
    for (const [index, one] of boxes.entries()) {
      for (const other of boxes.slice(index + 1)) {
        const apart = one.right <= other.left || other.right <= one.left || one.bottom <= other.top || other.bottom <= one.top;
        expect(apart).toBe(true);
      }
    }
  });

  it("are left out by urgency, and the most urgent is written in any case", () => {
    const full = [{ left: -1000, top: -1000, right: 1000, bottom: 1000 }];
    const placed = placeLabels([label("other", 50, 50, 0.9), label("predicted", 0, 0, Infinity)], full);
    expect(placed.map((entry) => entry.label.name)).toEqual(["predicted"]);
  });
});
