import { expect, it } from "vitest";
import type { Client } from "../api/types";
import { MockMachine } from "../../mock/machine";
import { MOCK_SCENE } from "../../mock/scene";
import { gradeOf, growth, keyed, NO_LINKS, takeLinks, trace, worst } from "./links";

const SNAPSHOT = new MockMachine(MOCK_SCENE, { latchedBy: null, mode: "following" }, () => undefined).snapshot();

function client(name: string, jitter: number | null): Client {
  return { name, convention: "unity", poses: 0, pose_rate_hz: 72, rtt_millis: null, persons: [], pose_age_millis: null, jitter_millis: jitter, loss_percent: null, errors: 0 };
}

it("grades by the server's thresholds, each from its own value on", () => {
  const threshold = { weak: 50, bad: 150 };
  expect([0, 49.9, 50, 149.9, 150].map((value) => gradeOf(value, threshold))).toEqual(["good", "good", "weak", "weak", "bad"]);
  expect(gradeOf(null, threshold)).toBe("unknown");
  expect(gradeOf(3, null)).toBe("unknown");
  expect(worst(["good", "unknown", "weak"])).toBe("weak");
  expect(worst(["unknown"])).toBe("unknown");
});

it("tells two clients of one name apart", () => {
  expect(keyed([client("quest", 1), client("index", 2), client("quest", 3)]).map(({ key }) => key)).toEqual(["quest", "index", "quest 2"]);
});

it("keeps each client's values second by second, unknown while it was away", () => {
  let history = NO_LINKS;
  for (const [secs, clients] of [[1, [client("quest", 1)]], [2, []], [3.1, [client("quest", null)]], [3.4, [client("quest", 5)]]] as const) {
    history = takeLinks(history, { ...SNAPSHOT, at_micros: secs * 1e6, clients: [...clients] });
  }
  expect(trace(history, 3.9e6, (seen) => seen.clients.get("quest")?.jitter_millis).slice(-3)).toEqual([1, null, 5]);
  expect(trace(history, 3.9e6, (seen) => seen.snapshots).slice(-4)).toEqual([null, 1, 1, 2]);
});

it("counts what grew while it looked", () => {
  expect(growth([null, 7, null, 7, 9])).toBe(2);
  expect(growth([9, 0])).toBe(0);
  expect(growth([])).toBe(0);
});
