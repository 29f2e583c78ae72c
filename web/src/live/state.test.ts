import { describe, expect, it } from "vitest";
import { MockMachine } from "../../mock/machine";
import { LINK_THRESHOLDS, MOCK_SCENE } from "../../mock/scene";
import type { Snapshot, ToDashboard, WireEvent } from "../api/types";
import { freshness, NOTHING_YET, reduce, STALE_AFTER_MILLIS, type LiveState } from "./state";

const BASE: Snapshot = new MockMachine(MOCK_SCENE, { latchedBy: null, mode: "ready" }, () => undefined).snapshot();

function snapshot(generation: number, atMillis: number): ToDashboard {
  return { type: "snapshot", ...BASE, generation, at_micros: atMillis * 1000 };
}

function receive(state: LiveState, message: ToDashboard, nowMillis: number): LiveState {
  return reduce(state, { kind: "message", message, nowMillis });
}

const OPEN = reduce(NOTHING_YET, { kind: "opened" });

describe("what the page knows", () => {
  it("is live while snapshots come, and stale half a second after the last", () => {
    const state = receive(OPEN, snapshot(1, 40), 1000);
    expect(freshness(state, 1010)).toEqual({ kind: "live", ageMillis: 10 });
    expect(freshness(state, 1000 + STALE_AFTER_MILLIS - 1).kind).toBe("live");
    expect(freshness(state, 1000 + STALE_AFTER_MILLIS)).toEqual({ kind: "stale", ageMillis: STALE_AFTER_MILLIS });
    expect(freshness(state, 9000)).toEqual({ kind: "stale", ageMillis: 8000 });
  });

  it("is stale at once when the connection is gone, and none before the first snapshot", () => {
    const state = receive(OPEN, snapshot(1, 40), 1000);
    const closed = reduce(state, { kind: "closed", attempt: 1, retryAtMillis: 2000 });
    expect(freshness(closed, 1001).kind).toBe("stale");
    expect(freshness(OPEN, 1001)).toEqual({ kind: "none" });
  });

  it("calls a stream that lags behind stale, though it never pauses", () => {
    let state = receive(OPEN, snapshot(1, 0), 1000);
    // From here each snapshot comes 800 ms after it was true.
    for (let generation = 2; generation < 40; generation += 1) {
      state = receive(state, snapshot(generation, generation * 33), 1000 + generation * 33 + 800);
    }
    const now = 1000 + 39 * 33 + 800;
    expect(freshness(state, now).kind).toBe("stale");
  });

  it("forgives the drift of two clocks over a long day", () => {
    let state = OPEN;
    let worst = 0;
    for (let second = 0; second < 10 * 3600; second += 1) {
      const server = second * 1000;
      const page = 1000 + server * (1 + 100e-6);
      state = receive(state, snapshot(second + 1, server), page);
      const age = freshness(state, page);
      if (age.kind !== "none") worst = Math.max(worst, age.ageMillis);
    }
    expect(worst).toBeLessThan(10);
  });

  it("is not freshened by a snapshot that is no news", () => {
    const first = receive(OPEN, snapshot(5, 40), 1000);
    expect(receive(first, snapshot(5, 40), 1400)).toBe(first);
    expect(receive(first, snapshot(4, 10), 1400)).toBe(first);
  });

  it("takes a restarted server's first snapshot, whose count begins again", () => {
    const before = receive(OPEN, snapshot(9000, 300_000), 1000);
    const again = reduce(reduce(before, { kind: "closed", attempt: 1, retryAtMillis: 2000 }), { kind: "opened" });
    const state = receive(again, snapshot(1, 20), 5000);
    expect(state.snapshot?.generation).toBe(1);
    expect(freshness(state, 5005)).toEqual({ kind: "live", ageMillis: 5 });
  });

  it("keeps welcome and scene, and strips the tag from snapshots", () => {
    const shape = { travel_m: [0, 0, 4, 4], speed_mps: [1, 1], acceleration_mps2: [1, 1], braking_mps2: [2, 2] } satisfies Extract<ToDashboard, { type: "welcome" }>["machine_shape"];
    let state = receive(OPEN, { type: "welcome", version: "0.1.0", machine: "simulated", machine_shape: shape, link_thresholds: LINK_THRESHOLDS }, 1);
    state = receive(state, { type: "scene", id: 3, version: 2, scene: MOCK_SCENE }, 2);
    state = receive(state, snapshot(1, 0), 3);
    expect(state.server).toEqual({ version: "0.1.0", machine: "simulated", shape, thresholds: LINK_THRESHOLDS });
    expect(state.scene).toEqual({ id: 3, version: 2, scene: MOCK_SCENE });
    expect(state.snapshot).not.toHaveProperty("type");
  });

  it("keeps events newest first, each once, also when past ones are read after live ones came", () => {
    const event = (second: number): WireEvent => ({
      at_micros: second * 1e6,
      at: `2026-01-01T00:00:0${second}Z`,
      kind: "mode_changed",
      summary: `event ${second}`,
      detail: null,
    });
    let state = receive(OPEN, { type: "event", ...event(3) }, 1);
    state = reduce(state, { kind: "past_events", events: [event(3), event(2), event(1)] });
    state = receive(state, { type: "event", ...event(4) }, 2);
    expect(state.events.map((entry) => entry.summary)).toEqual(["event 4", "event 3", "event 2", "event 1"]);
  });

  it("counts what it does not understand", () => {
    const once = reduce(OPEN, { kind: "not_understood", trouble: "a frame that is not JSON" });
    const twice = reduce(once, { kind: "not_understood", trouble: "a frame without a type" });
    expect(twice.trouble).toEqual({ count: 2, last: "a frame without a type" });
  });
});
