import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { JogAim } from "../api/types";
import { JogHand, ORDER_EVERY_MILLIS, type HandState } from "./jog";
import type { Answer } from "./requests";

const ALONG: JogAim = { along: [1, 0] };
const MOVES: Answer = { kind: "answered", outcome: "accepted", detail: "moves", why: null };

function hand(answer: () => Promise<Answer>) {
  const orders: (JogAim | null)[] = [];
  const states: HandState[] = [];
  const made = new JogHand({
    order: (to) => {
      orders.push(to);
      return answer();
    },
    changed: (state) => states.push(state),
  });
  return { hand: made, orders, states };
}

describe("a hand on a jog button", () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  it("orders at once and again while it is held, and lets go once", async () => {
    const { hand: held, orders, states } = hand(() => Promise.resolve(MOVES));
    held.hold(ALONG, 0.1);
    await vi.advanceTimersByTimeAsync(3 * ORDER_EVERY_MILLIS);
    expect(orders).toEqual([ALONG, ALONG, ALONG, ALONG]);
    held.letGo();
    held.letGo();
    await vi.advanceTimersByTimeAsync(10 * ORDER_EVERY_MILLIS);
    expect(orders).toEqual([ALONG, ALONG, ALONG, ALONG, null]);
    expect(states.at(-1)).toEqual({ held: false, answer: null });
  });

  it("goes on through a refusal, which may pass, and shows it", async () => {
    const refused: Answer = { kind: "answered", outcome: "refused", detail: "not yet", why: { id: "jog_not_yet" } };
    const { hand: held, orders, states } = hand(() => Promise.resolve(refused));
    held.hold(ALONG, 0.1);
    await vi.advanceTimersByTimeAsync(ORDER_EVERY_MILLIS);
    expect(orders).toHaveLength(2);
    expect(states.at(-1)).toEqual({ held: true, answer: refused });
  });

  it("is let go of when the connection is", async () => {
    const gone: Answer = { kind: "unanswered", because: "not_sent" };
    const { hand: held, orders, states } = hand(() => Promise.resolve(gone));
    held.hold(ALONG, 0.1);
    await vi.advanceTimersByTimeAsync(5 * ORDER_EVERY_MILLIS);
    expect(orders).toHaveLength(1);
    expect(states.at(-1)).toEqual({ held: false, answer: gone });
  });

  it("holds one button at a time", async () => {
    const { hand: held, orders } = hand(() => Promise.resolve(MOVES));
    held.hold(ALONG, 0.1);
    held.hold({ place: [1, 2] }, 0.1);
    await vi.advanceTimersByTimeAsync(ORDER_EVERY_MILLIS);
    expect(orders).toEqual([ALONG, null, { place: [1, 2] }, { place: [1, 2] }]);
  });
});
