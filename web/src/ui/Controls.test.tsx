// @vitest-environment happy-dom
import { cleanup, fireEvent, render, screen } from "@solidjs/testing-library";
import { createSignal } from "solid-js";
import { afterEach, describe, expect, it, vi } from "vitest";
import { MockMachine } from "../../mock/machine";
import { MOCK_SCENE } from "../../mock/scene";
import type { Mode, Snapshot } from "../api/types";
import type { Live } from "../live/live";
import type { Freshness } from "../live/state";
import { Controls } from "./Controls";
import { anybody } from "./testLive";

afterEach(cleanup);

function snapshotIn(mode: Mode, latchedBy: string | null): Snapshot {
  return new MockMachine(MOCK_SCENE, { latchedBy, mode }, () => undefined).snapshot();
}

/** A live side that shows one snapshot and answers every request alike. */
function live(snapshot: Snapshot | null, freshness: Freshness, ask: Live["ask"]): Live {
  const [shown] = createSignal(snapshot);
  const [age] = createSignal(freshness);
  return {
    snapshot: shown,
    newest: shown,
    freshness: age,
    ask,
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

const LIVE: Freshness = { kind: "live", ageMillis: 10 };
const never: Live["ask"] = () => Promise.reject(new Error("nothing may be asked"));

describe("the machine's buttons", () => {
  it("are offered or refused as the server says, with its reason as text", () => {
    render(() => <Controls live={live(snapshotIn("disarmed", null), LIVE, never)} />);
    expect(screen.getByTestId("home").hasAttribute("disabled")).toBe(false);
    expect(screen.getByTestId("arm").hasAttribute("disabled")).toBe(true);
    expect(screen.getByTestId("why-not-arm").textContent).toBe("not homed: home first");
  });

  it("are all refused when the state is stale or none came", () => {
    const cases: [Snapshot | null, Freshness, string][] = [
      [snapshotIn("disarmed", null), { kind: "stale", ageMillis: 900 }, "the state shown is stale"],
      [null, { kind: "none" }, "no state from the server yet"],
    ];
    for (const [snapshot, freshness, reason] of cases) {
      render(() => <Controls live={live(snapshot, freshness, never)} />);
      for (const request of ["home", "arm", "disarm", "reset"]) {
        expect(screen.getByTestId(request).hasAttribute("disabled")).toBe(true);
        expect(screen.getByTestId(`why-not-${request}`).textContent).toBe(reason);
      }
      cleanup();
    }
  });

  it("ask for a reason before a reset, and send it", async () => {
    const ask = vi.fn<Live["ask"]>(() => Promise.resolve({ kind: "answered", outcome: "accepted", detail: "now disarmed", why: { id: "now_in", mode: "disarmed" } }));
    render(() => <Controls live={live(snapshotIn("disarmed", "pressed"), LIVE, ask)} />);
    fireEvent.click(screen.getByTestId("reset"));
    expect(screen.getByTestId("reset-confirm").hasAttribute("disabled")).toBe(true);
    fireEvent.input(screen.getByTestId("reset-reason"), { target: { value: "  cable checked " } });
    fireEvent.click(screen.getByTestId("reset-confirm"));
    expect(ask).toHaveBeenCalledExactlyOnceWith("reset", "cable checked");
    await vi.waitFor(() => {
      expect(screen.getByTestId("answer").textContent).toBe("reset: accepted, now disarmed");
    });
    expect(screen.queryByTestId("reset-reason")).toBeNull();
  });

  it("show a refusal and an unanswered request in words", async () => {
    render(() => (
      <Controls
        live={live(snapshotIn("disarmed", null), LIVE, () =>
          Promise.resolve({ kind: "unanswered", because: "too_late" }),
        )}
      />
    ));
    fireEvent.click(screen.getByTestId("home"));
    await vi.waitFor(() => {
      expect(screen.getByTestId("answer").textContent).toBe("home: unanswered, no answer within 3 s");
    });
  });
});
