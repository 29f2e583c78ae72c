/**
 * The one socket of the page. It keeps trying: a connection that closes, never opens, or goes silent is replaced. It
 * never decides what a message means.
 */
import type { FromDashboard } from "../api/types";
import { waitMillis } from "./backoff";
import { parseFrame } from "./frames";
import type { LiveAction } from "./state";

/** The world, as the connection sees it. */
export interface ConnectionPorts {
  readonly open: () => WebSocket;
  /** Monotonic, ms. */
  readonly nowMillis: () => number;
  /** From 0 to 1. */
  readonly chance: () => number;
  readonly happened: (action: LiveAction) => void;
}

/** No opening within this: give the attempt up, ms. */
export const OPEN_DEADLINE_MILLIS = 3000;
/** An open socket without any frame for this long is dead, ms. */
export const SILENCE_DEADLINE_MILLIS = 2500;

/** Keeps one socket open. */
export class Connection {
  readonly #ports: ConnectionPorts;
  #socket: WebSocket | null = null;
  #attempt = 0;
  #retry: ReturnType<typeof setTimeout> | null = null;
  #deadline: ReturnType<typeof setTimeout> | null = null;
  #ended = false;

  constructor(ports: ConnectionPorts) {
    this.#ports = ports;
  }

  /** Begins, or tries at once instead of waiting. */
  connect(): void {
    if (this.#ended || this.#socket !== null) return;
    if (this.#retry !== null) clearTimeout(this.#retry);
    this.#retry = null;
    this.#ports.happened({ kind: "connecting", attempt: this.#attempt });
    const socket = this.#ports.open();
    this.#socket = socket;
    this.#watch(OPEN_DEADLINE_MILLIS);
    socket.addEventListener("open", () => {
      if (this.#socket !== socket) return;
      this.#attempt = 0;
      this.#watch(SILENCE_DEADLINE_MILLIS);
      this.#ports.happened({ kind: "opened" });
    });
    socket.addEventListener("message", (event: MessageEvent<unknown>) => {
      if (this.#socket !== socket) return;
      this.#watch(SILENCE_DEADLINE_MILLIS);
      const parsed = typeof event.data === "string" ? parseFrame(event.data) : { trouble: "a binary frame" };
      if ("message" in parsed) {
        this.#ports.happened({ kind: "message", message: parsed.message, nowMillis: this.#ports.nowMillis() });
      } else {
        this.#ports.happened({ kind: "not_understood", trouble: parsed.trouble });
      }
    });
    socket.addEventListener("close", () => {
      this.#lost(socket);
    });
  }

  /** Sends if the socket is open; false if it is not. */
  send(message: FromDashboard): boolean {
    if (this.#socket === null || this.#socket.readyState !== OPEN) return false;
    this.#socket.send(JSON.stringify(message));
    return true;
  }

  /** Lets the open socket go and begins anew: another person sits here now. */
  renew(): void {
    const socket = this.#socket;
    this.#socket = null;
    socket?.close();
    this.connect();
  }

  /** Closes for good. */
  end(): void {
    this.#ended = true;
    if (this.#retry !== null) clearTimeout(this.#retry);
    if (this.#deadline !== null) clearTimeout(this.#deadline);
    this.#socket?.close();
    this.#socket = null;
  }

  #watch(millis: number): void {
    if (this.#deadline !== null) clearTimeout(this.#deadline);
    this.#deadline = setTimeout(() => {
      const socket = this.#socket;
      if (socket === null) return;
      // The closing handshake of a dead peer takes as long as it likes: let go now.
      socket.close();
      this.#lost(socket);
    }, millis);
  }

  #lost(socket: WebSocket): void {
    if (this.#ended || this.#socket !== socket) return;
    this.#socket = null;
    if (this.#deadline !== null) clearTimeout(this.#deadline);
    this.#deadline = null;
    this.#attempt += 1;
    const wait = waitMillis(this.#attempt, this.#ports.chance());
    this.#ports.happened({ kind: "closed", attempt: this.#attempt, retryAtMillis: this.#ports.nowMillis() + wait });
    this.#retry = setTimeout(() => {
      this.#retry = null;
      this.connect();
    }, wait);
  }
}

/** `WebSocket.OPEN`, which a page without a socket of its own need not have. */
const OPEN = 1;
