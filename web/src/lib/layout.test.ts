import { createRoot } from "solid-js";
import { describe, expect, it } from "vitest";
import { createLayout, type Layout } from "./layout";
import type { Preferences, PreferenceStore } from "./preferences";

function layoutOf(layout: Preferences["layout"]): { layout: Layout; now: () => Preferences } {
  let preferences: Preferences = { theme: "light", ...(layout === undefined ? {} : { layout }) };
  const store: PreferenceStore = {
    preferences: () => preferences,
    change: (change) => {
      preferences = change.layout === undefined ? preferences : { ...preferences, layout: change.layout };
    },
    switchTo: () => undefined,
  };
  return createRoot(() => ({ layout: createLayout(store), now: () => preferences }));
}

const WIDTH = { least: 200, greatest: 400, standard: 280 };

describe("the layout", () => {
  it("keeps each key beside the others, and forgets all at once", () => {
    const { layout, now } = layoutOf({ left: 300 });
    layout.keep("fold.rules", true);
    expect(layout.size("left", WIDTH)).toBe(300);
    expect(layout.flag("fold.rules", false)).toBe(true);
    layout.reset();
    expect(layout.flag("fold.rules", false)).toBe(false);
    expect(layout.size("left", WIDTH)).toBe(280);
    expect(now().theme).toBe("light");
  });

  it("is the standard where something unfit was kept", () => {
    const { layout } = layoutOf({ left: "wide", side: 1, axis: "w", huge: 1e9, none: Number.NaN });
    expect(layout.size("left", WIDTH)).toBe(280);
    expect(layout.size("none", WIDTH)).toBe(280);
    expect(layout.size("huge", WIDTH)).toBe(400);
    expect(layout.flag("side", true)).toBe(true);
    expect(layout.choice("axis", ["x", "y"])).toBe("x");
  });
});
