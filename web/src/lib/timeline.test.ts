import { describe, expect, it } from "vitest";
import type { WireEvent } from "../api/types";
import { groupOf, kindsOf, marksOf, merged, NO_FILTER, passes, personOf } from "./timeline";

function event(at: string, kind: string, summary = "", detail: unknown = null): WireEvent {
  return { at, at_micros: 0, kind, summary, detail };
}

const ADA = event("2026-01-01T10:00:02Z", "person_entered", "Ada entered", { person: 1, name: "Ada" });
const STOP = event("2026-01-01T10:00:01Z", "stop_pressed", "Bo pressed stop");
const SCENE = event("2026-01-01T10:00:03Z", "scene_activated", "scene", { scene: 1, name: "Ada" });

describe("the timeline", () => {
  it("puts every kind into one group, and an unknown one somewhere visible", () => {
    expect([groupOf("touch_began"), groupOf("rule_cleared"), groupOf("made_up")]).toEqual(["people", "rules", "mode"]);
    expect(kindsOf({ ...NO_FILTER, groups: ["stops", "priors"] })).toEqual(["stop_pressed", "came_to_rest", "prior_changed"]);
    expect(kindsOf(NO_FILTER)).toBeNull();
  });

  it("filters by group, text and person", () => {
    const passing = (filter: Partial<typeof NO_FILTER>): WireEvent[] => [ADA, STOP, SCENE].filter((entry) => passes(entry, { ...NO_FILTER, ...filter }));
    expect(passing({})).toHaveLength(3);
    expect(passing({ groups: ["stops", "people"] })).toEqual([ADA, STOP]);
    expect(passing({ search: "PRESSED" })).toEqual([STOP]);
    expect(passing({ person: "Ada" })).toEqual([ADA]);
    expect(personOf(SCENE)).toBeNull();
  });

  it("puts pages together, each event once, newest first", () => {
    expect(merged([STOP], [ADA, STOP], [SCENE])).toEqual([SCENE, ADA, STOP]);
  });

  it("marks what lies in the bar's span, oldest first", () => {
    const now = Date.parse("2026-01-01T10:00:04Z");
    expect(marksOf([SCENE, ADA, STOP], now, 2000).map(({ event: { kind }, place }) => [kind, place])).toEqual([
      ["person_entered", 0],
      ["scene_activated", 0.5],
    ]);
    expect(marksOf([event("never", "served")], now, 2000)).toEqual([]);
  });
});
