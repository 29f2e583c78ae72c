import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { FromDashboard } from "../api/types";
import { ANSWER_DEADLINE_MILLIS, Requests } from "./requests";

describe("requests", () => {
  beforeEach(() => vi.useFakeTimers());
  afterEach(() => vi.useRealTimers());

  it("get their own answers, in any order", async () => {
    const sent: FromDashboard[] = [];
    const requests = new Requests((message) => sent.push(message) > 0);
    const home = requests.ask("home", null);
    const reset = requests.ask("reset", "cable checked");
    expect(sent).toEqual([
      { type: "request", request_id: 1, request: "home", reason: null },
      { type: "request", request_id: 2, request: "reset", reason: "cable checked" },
    ]);
    requests.answered(2, "refused", "nothing to reset", { id: "nothing_to_reset" });
    requests.answered(1, "accepted", "homing", null);
    expect(await reset).toEqual({ kind: "answered", outcome: "refused", detail: "nothing to reset", why: { id: "nothing_to_reset" } });
    expect(await home).toEqual({ kind: "answered", outcome: "accepted", detail: "homing", why: null });
  });

  it("are reported unanswered: unsent, too late, or cut off; and are never sent again", async () => {
    let open = false;
    let sent = 0;
    const requests = new Requests(() => {
      sent += open ? 1 : 0;
      return open;
    });
    expect((await requests.ask("arm", null)).kind).toBe("unanswered");
    open = true;
    const late = requests.ask("arm", null);
    vi.advanceTimersByTime(ANSWER_DEADLINE_MILLIS);
    expect((await late).kind).toBe("unanswered");
    const cut = requests.ask("arm", null);
    requests.lost();
    expect(await cut).toEqual({ kind: "unanswered", because: "lost" });
    vi.advanceTimersByTime(60_000);
    expect(sent).toBe(2);
  });
});
