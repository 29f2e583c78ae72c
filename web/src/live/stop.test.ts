import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { POST_DEADLINE_MILLIS, RETRY_EVERY_MILLIS, StopSender, type HttpStopAnswer, type StopState } from "./stop";

interface World {
  readonly sender: StopSender;
  readonly sockets: number[];
  readonly posts: { answer: (answer: HttpStopAnswer) => void; fail: (error: Error) => void; signal: AbortSignal }[];
  readonly seen: StopState[];
  socketOpen: boolean;
}

function world(socketOpen: boolean): World {
  let lastId = 0;
  const made: World = {
    sockets: [],
    posts: [],
    seen: [],
    socketOpen,
    sender: new StopSender({
      nowMillis: () => Date.now(),
      sendOnSocket: (requestId) => {
        if (made.socketOpen) made.sockets.push(requestId);
        return made.socketOpen;
      },
      post: (_reason, signal) =>
        new Promise((resolve, reject) => {
          signal.addEventListener("abort", () => {
            reject(signal.reason instanceof Error ? signal.reason : new Error("aborted"));
          });
          made.posts.push({ answer: resolve, fail: reject, signal });
        }),
      newRequestId: () => (lastId += 1),
      changed: (state) => made.seen.push(state),
    }),
  };
  return made;
}

describe("the software stop's sender", () => {
  beforeEach(() => vi.useFakeTimers());
  afterEach(() => vi.useRealTimers());

  it("is acknowledged over the socket, with both times, and posts nothing", () => {
    const { sender, sockets, posts } = world(true);
    sender.press(null);
    expect(sender.state.kind).toBe("pending");
    vi.advanceTimersByTime(12);
    expect(sender.socketAnswered(1, "accepted", "stopped", null, 1840)).toBe(true);
    expect(sender.state).toMatchObject({ kind: "acknowledged", acknowledgedMillis: 12, toDriveMicros: 1840, lane: "websocket", sent: 1 });
    vi.advanceTimersByTime(10 * RETRY_EVERY_MILLIS);
    expect(sockets).toEqual([1]);
    expect(posts).toHaveLength(0);
  });

  it("posts at once when the socket is down", async () => {
    const { sender, posts } = world(false);
    sender.press(null);
    expect(posts).toHaveLength(1);
    vi.advanceTimersByTime(5);
    posts[0]?.answer({ acknowledged: true, to_drive_micros: 900 });
    await vi.advanceTimersByTimeAsync(0);
    expect(sender.state).toMatchObject({ kind: "acknowledged", acknowledgedMillis: 5, toDriveMicros: 900, lane: "http" });
  });

  it("posts too when the open socket has not answered in time", () => {
    const { sender, sockets, posts } = world(true);
    sender.press(null);
    vi.advanceTimersByTime(RETRY_EVERY_MILLIS - 1);
    expect(posts).toHaveLength(0);
    vi.advanceTimersByTime(1);
    expect(posts).toHaveLength(1);
    expect(sockets).toEqual([1, 1]);
  });

  it("retries both lanes until acknowledged, however often they fail", async () => {
    const made = world(false);
    made.sender.press(null);
    for (let round = 0; round < 50; round += 1) {
      made.posts.at(-1)?.fail(new Error("connection refused"));
      await vi.advanceTimersByTimeAsync(RETRY_EVERY_MILLIS);
      expect(made.sender.state).toMatchObject({ kind: "pending", trouble: { kind: expect.any(String) as unknown } });
    }
    expect(made.posts).toHaveLength(51);
    made.posts.at(-1)?.answer({ acknowledged: true, to_drive_micros: null });
    await vi.advanceTimersByTimeAsync(0);
    expect(made.sender.state).toMatchObject({ kind: "acknowledged", toDriveMicros: null, lane: "http" });
  });

  it("does not wait for a post that hangs, and bounds how many do", async () => {
    const { sender, posts } = world(false);
    sender.press(null);
    await vi.advanceTimersByTimeAsync(POST_DEADLINE_MILLIS - 1);
    expect(posts).toHaveLength(4);
    await vi.advanceTimersByTimeAsync(RETRY_EVERY_MILLIS + 1);
    expect(posts.length).toBeGreaterThan(4);
    expect(posts[0]?.signal.aborted).toBe(true);
  });

  it("goes out on the socket the moment it comes back", () => {
    const made = world(false);
    made.sender.press(null);
    made.socketOpen = true;
    made.sender.socketOpened();
    expect(made.sockets).toEqual([1]);
  });

  it("takes neither a refusal nor an unacknowledging answer nor another's answer for an acknowledgement", async () => {
    const { sender, posts } = world(true);
    sender.press(null);
    expect(sender.socketAnswered(7, "accepted", "homing", null, null)).toBe(false);
    expect(sender.socketAnswered(1, "refused", "busy", null, null)).toBe(true);
    vi.advanceTimersByTime(RETRY_EVERY_MILLIS);
    posts[0]?.answer({ acknowledged: false, to_drive_micros: null });
    await vi.advanceTimersByTimeAsync(0);
    expect(sender.state.kind).toBe("pending");
  });

  it("lets the first acknowledgement stand and the later one pass", async () => {
    const { sender, posts } = world(true);
    sender.press(null);
    vi.advanceTimersByTime(RETRY_EVERY_MILLIS);
    sender.socketAnswered(1, "already_so", "stopped already", null, null);
    posts[0]?.answer({ acknowledged: true, to_drive_micros: 5 });
    await vi.advanceTimersByTimeAsync(0);
    expect(sender.state).toMatchObject({ kind: "acknowledged", lane: "websocket", acknowledgedMillis: RETRY_EVERY_MILLIS });
  });

  it("sends on both lanes at once when pressed again while pending, and measures from the first press", () => {
    const { sender, sockets, posts } = world(true);
    sender.press(null);
    vi.advanceTimersByTime(100);
    sender.press(null);
    expect(sockets).toEqual([1, 1]);
    expect(posts).toHaveLength(1);
    sender.socketAnswered(1, "accepted", "stopped", null, 10);
    expect(sender.state).toMatchObject({ acknowledgedMillis: 100 });
  });

  it("begins anew with a press after an acknowledgement", () => {
    const { sender, sockets } = world(true);
    sender.press(null);
    sender.socketAnswered(1, "accepted", "stopped", null, 10);
    sender.press(null);
    expect(sender.state.kind).toBe("pending");
    expect(sockets).toEqual([1, 2]);
    expect(sender.socketAnswered(1, "accepted", "late echo", null, 10)).toBe(false);
    expect(sender.state.kind).toBe("pending");
  });
});
