// @vitest-environment happy-dom
import { cleanup, render, screen } from "@solidjs/testing-library";
import { afterEach, describe, expect, it } from "vitest";
import { MockMachine } from "../../mock/machine";
import { MOCK_SCENE } from "../../mock/scene";
import type { Person, Snapshot } from "../api/types";
import { useLanguage } from "../i18n";
import type { Live } from "../live/live";
import { Persons } from "./Persons";
import { anybody } from "./testLive";

afterEach(() => {
  cleanup();
  useLanguage("en");
});

function live(change: Partial<Person>): Live {
  const snapshot: Snapshot = new MockMachine(MOCK_SCENE, { latchedBy: null, mode: "following" }, () => undefined).snapshot();
  const [person] = snapshot.persons;
  if (person === undefined) throw new Error("the mock has a person");
  const shown: Snapshot = { ...snapshot, persons: [{ ...person, ...change }] };
  return {
    snapshot: () => shown,
    newest: () => shown,
    freshness: () => ({ kind: "live", ageMillis: 10 }),
    ask: () => Promise.reject(new Error("nothing may be asked")),
    link: () => ({ phase: "open" }),
    server: () => null,
    scene: () => null,
    events: () => [],
    trouble: () => null,
    nowMillis: () => 0,
    stop: () => ({ kind: "idle" }),
    pressStop: () => undefined,
    jog: () => Promise.reject(new Error("nothing may be jogged")),
    connectNow: () => undefined,
    identity: anybody(),
  };
}

const TERMS = { radius_m: 0.45, reaction_m: 0.06, braking_m: 0.2, walking_m: 0.1, age_m: 0.02, binding: "braking" } as const;

describe("a person's separation", () => {
  it("names the term that binds, each term, and what is short, in the page's language", () => {
    const shown = live({ separation: TERMS, required_m: 0.83, distance_m: 0.7, limits_column: true });
    render(() => <Persons live={shown} />);
    expect(screen.getByTestId("binding-1").textContent).toBe("braking binds: 0.20 m");
    expect(screen.getByTestId("slack-1").textContent).toBe("0.13 m too near");
    expect([...screen.getByTestId("terms-1").querySelectorAll("dd")].map((entry) => entry.textContent)).toEqual(["0.45", "0.06", "0.20", "0.10", "0.02", "0.83 m"]);
    expect(screen.getByTestId("limits-1").textContent).toBe("limits the column");
    useLanguage("fr");
    expect(screen.getByTestId("binding-1").textContent).toBe("freinage domine : 0,20 m");
  });

  it("shows no term that the server does not tell, and nothing of who has no pose", () => {
    render(() => <Persons live={live({ separation: null, limits_column: false, required_m: 0.6, distance_m: 1 })} />);
    expect(screen.queryByTestId("binding-1")).toBeNull();
    expect(screen.queryByTestId("limits-1")).toBeNull();
    expect(screen.getByTestId("slack-1").textContent).toBe("0.40 m to spare");
    cleanup();
    render(() => <Persons live={live({ head_m: null, separation: null })} />);
    expect(screen.queryByTestId("distance-1")).toBeNull();
    expect(screen.getByTestId("person-1").textContent).toContain("no pose yet");
  });
});
