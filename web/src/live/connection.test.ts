import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { waitMillis } from "./backoff";
import { Connection, OPEN_DEADLINE_MILLIS, SILENCE_DEADLINE_MILLIS } from "./connection";
import type { LiveAction } from "./state";

/** A socket that does what the test says. */
class FakeSocket extends EventTarget {
  readyState = 0;
  readonly sent: string[] = [];
  send(text: string): void {
    this.sent.push(text);
  }
  close(): void {
    // A dead peer's closing handshake never ends: no event follows by itself.
    this.readyState = 2;
  }
  opens(): void {
    this.readyState = 1;
    this.dispatchEvent(new Event("open"));
  }
  says(text: string): void {
    this.dispatchEvent(new MessageEvent("message", { data: text }));
  }
  drops(): void {
    this.readyState = 3;
    this.dispatchEvent(new Event("close"));
  }
}

function world(): { connection: Connection; sockets: FakeSocket[]; actions: LiveAction[] } {
  const sockets: FakeSocket[] = [];
  const actions: LiveAction[] = [];
  const connection = new Connection({
    open: () => {
      const socket = new FakeSocket();
      sockets.push(socket);
      return socket as unknown as WebSocket;
    },
    nowMillis: () => Date.now(),
    chance: () => 0.5,
    happened: (action) => actions.push(action),
  });
  return { connection, sockets, actions };
}

const EVENT = JSON.stringify({ type: "event", at_micros: 1, at: "2026-01-01T00:00:00Z", kind: "mode_changed", summary: "ready", detail: null });

describe("the connection", () => {
  beforeEach(() => vi.useFakeTimers());
  afterEach(() => vi.useRealTimers());

  it("tells what arrives and sends only when open", () => {
    const { connection, sockets, actions } = world();
    connection.connect();
    expect(connection.send({ type: "stop", request_id: 1, reason: null })).toBe(false);
    sockets[0]?.opens();
    sockets[0]?.says(EVENT);
    sockets[0]?.says("nonsense");
    expect(connection.send({ type: "stop", request_id: 1, reason: null })).toBe(true);
    expect(sockets[0]?.sent).toEqual(['{"type":"stop","request_id":1,"reason":null}']);
    expect(actions.map((action) => action.kind)).toEqual(["connecting", "opened", "message", "not_understood"]);
  });

  it("tries again and again, waiting longer each time, and from the start after a success", () => {
    const { connection, sockets, actions } = world();
    connection.connect();
    for (const wait of [250, 500, 1000, 2000, 3000, 3000]) {
      sockets.at(-1)?.drops();
      const count = sockets.length;
      vi.advanceTimersByTime(wait - 1);
      expect(sockets).toHaveLength(count);
      vi.advanceTimersByTime(1);
      expect(sockets).toHaveLength(count + 1);
    }
    sockets.at(-1)?.opens();
    sockets.at(-1)?.drops();
    expect(actions.at(-1)).toEqual({ kind: "closed", attempt: 1, retryAtMillis: Date.now() + 250 });
  });

  it("gives up a socket that never opens or goes silent, though no close event comes", () => {
    const { connection, sockets, actions } = world();
    connection.connect();
    vi.advanceTimersByTime(OPEN_DEADLINE_MILLIS);
    expect(actions.at(-1)?.kind).toBe("closed");
    vi.advanceTimersByTime(250);
    sockets[1]?.opens();
    vi.advanceTimersByTime(SILENCE_DEADLINE_MILLIS - 1);
    sockets[1]?.says(EVENT);
    vi.advanceTimersByTime(SILENCE_DEADLINE_MILLIS - 1);
    expect(actions.at(-1)?.kind).toBe("message");
    vi.advanceTimersByTime(1);
    expect(actions.at(-1)?.kind).toBe("closed");
  });

  it("hears nothing more from a socket that it let go", () => {
    const { connection, sockets, actions } = world();
    connection.connect();
    vi.advanceTimersByTime(OPEN_DEADLINE_MILLIS + 250);
    const count = actions.length;
    sockets[0]?.opens();
    sockets[0]?.says(EVENT);
    sockets[0]?.drops();
    expect(actions).toHaveLength(count);
  });

  it("lets an open socket go for a new one, and hears nothing more from it", () => {
    const { connection, sockets, actions } = world();
    connection.connect();
    sockets[0]?.opens();
    connection.renew();
    expect(sockets.map(({ readyState }) => readyState)).toEqual([2, 0]);
    const count = actions.length;
    sockets[0]?.says(EVENT);
    sockets[0]?.drops();
    expect(actions).toHaveLength(count);
    sockets[1]?.opens();
    expect(actions.at(-1)?.kind).toBe("opened");
  });

  it("connects at once when told to, and never after its end", () => {
    const { connection, sockets } = world();
    connection.connect();
    sockets[0]?.drops();
    connection.connect();
    expect(sockets).toHaveLength(2);
    connection.end();
    vi.advanceTimersByTime(60_000);
    expect(sockets).toHaveLength(2);
  });
});

describe("the wait", () => {
  it("differs from page to page by half, and is bounded", () => {
    expect(waitMillis(1, 0)).toBe(187.5);
    expect(waitMillis(1, 1)).toBe(312.5);
    expect(waitMillis(40, 1)).toBe(3750);
  });
});
