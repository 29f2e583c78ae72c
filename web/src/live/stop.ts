/**
 * The software stop's sender. It decides when a press counts as acknowledged, and must never give up before: it says
 * "not acknowledged" until the server has said otherwise, over whichever lane answers first.
 */
import { Unanswered } from "../api/http";
import type { Outcome, Reason } from "../api/types";

/** Which way an acknowledgement came. */
export type StopLane = "websocket" | "http";

/** How the last press stands. Times in ms. */
export type StopState =
  | { readonly kind: "idle" }
  | {
      readonly kind: "pending";
      readonly pressedAtMillis: number;
      /** Sendings so far, both lanes together. */
      readonly sent: number;
      /** The last trouble; null before any. */
      readonly trouble: StopTrouble | null;
    }
  | {
      readonly kind: "acknowledged";
      readonly pressedAtMillis: number;
      /** From the press to the acknowledgement. */
      readonly acknowledgedMillis: number;
      /** From the server's reception to the drive, microseconds; null when it was stopped already. */
      readonly toDriveMicros: number | null;
      readonly lane: StopLane;
      readonly sent: number;
      readonly detail: string | null;
    };

/** Why a sending was not acknowledged. */
export type StopTrouble =
  | { readonly kind: "refused"; readonly detail: string; readonly why: Reason | null }
  | { readonly kind: "no_socket" }
  | { readonly kind: "not_acknowledged" }
  | { readonly kind: "failed"; readonly error: unknown };

/** The server's word over HTTP. */
export interface HttpStopAnswer {
  readonly acknowledged: boolean;
  readonly to_drive_micros: number | null;
}

/** The world, as the sender sees it. */
export interface StopPorts {
  /** Monotonic, ms. */
  readonly nowMillis: () => number;
  /** Sends a stop on the socket; false when there is no open one. */
  readonly sendOnSocket: (requestId: number, reason: string | null) => boolean;
  /** Posts a stop; rejects with an Error on anything but an answer. */
  readonly post: (reason: string | null, giveUp: AbortSignal) => Promise<HttpStopAnswer>;
  /** A number that no other request of this page has. */
  readonly newRequestId: () => number;
  /** Told of every change. */
  readonly changed: (state: StopState) => void;
}

/** An answer is waited for this long before HTTP joins in, and before each retry, ms. */
export const RETRY_EVERY_MILLIS = 300;
/** A post that has not answered by then is given up, ms; the next one is long under way. */
export const POST_DEADLINE_MILLIS = 2000;

/** Sends stops until one is acknowledged. */
export class StopSender {
  readonly #ports: StopPorts;
  #state: StopState = { kind: "idle" };
  #requestId: number | null = null;
  #reason: string | null = null;
  #timer: ReturnType<typeof setTimeout> | null = null;
  readonly #posts = new Set<AbortController>();

  constructor(ports: StopPorts) {
    this.#ports = ports;
  }

  /** The button or a key went down. A press while one is pending sends at once on both lanes. */
  press(reason: string | null): void {
    if (this.#state.kind === "pending") {
      this.#sendBoth();
      return;
    }
    this.#reason = reason;
    this.#requestId = this.#ports.newRequestId();
    this.#become({ kind: "pending", pressedAtMillis: this.#ports.nowMillis(), sent: 0, trouble: null });
    if (!this.#trySocket()) this.#post();
    this.#schedule();
  }

  /** The socket came (back) up: a pending stop goes out on it at once. */
  socketOpened(): void {
    if (this.#state.kind === "pending") this.#trySocket();
  }

  /** An answer came over the socket; true if it was a stop's. */
  socketAnswered(requestId: number, outcome: Outcome, detail: string, why: Reason | null, toDriveMicros: number | null): boolean {
    if (requestId !== this.#requestId) return false;
    if (outcome === "refused") this.#troubled({ kind: "refused", detail, why });
    else this.#acknowledged("websocket", toDriveMicros, detail);
    return true;
  }

  /** Leaves nothing running; for when the page goes. */
  dispose(): void {
    this.#quiet();
  }

  /** How the last press stands. */
  get state(): StopState {
    return this.#state;
  }

  #sendBoth(): void {
    this.#trySocket();
    this.#post();
  }

  #trySocket(): boolean {
    if (this.#requestId === null) return false;
    const sent = this.#ports.sendOnSocket(this.#requestId, this.#reason);
    if (sent) this.#counted();
    else this.#troubled({ kind: "no_socket" });
    return sent;
  }

  #post(): void {
    // A hanging post must not hold up the next one, nor may they pile up without end.
    if (this.#posts.size >= POSTS_AT_ONCE) return;
    const controller = new AbortController();
    const deadline = setTimeout(() => {
      controller.abort(new Unanswered(POST_DEADLINE_MILLIS / 1000));
    }, POST_DEADLINE_MILLIS);
    this.#posts.add(controller);
    this.#counted();
    this.#ports
      .post(this.#reason, controller.signal)
      .then((answer) => {
        if (answer.acknowledged) this.#acknowledged("http", answer.to_drive_micros, null);
        else this.#troubled({ kind: "not_acknowledged" });
      })
      .catch((error: unknown) => {
        this.#troubled({ kind: "failed", error });
      })
      .finally(() => {
        clearTimeout(deadline);
        this.#posts.delete(controller);
      });
  }

  #schedule(): void {
    this.#timer = setTimeout(() => {
      this.#sendBoth();
      this.#schedule();
    }, RETRY_EVERY_MILLIS);
  }

  #acknowledged(lane: StopLane, toDriveMicros: number | null, detail: string | null): void {
    if (this.#state.kind !== "pending") return;
    const { pressedAtMillis, sent } = this.#state;
    this.#become({
      kind: "acknowledged",
      pressedAtMillis,
      acknowledgedMillis: this.#ports.nowMillis() - pressedAtMillis,
      toDriveMicros,
      lane,
      sent,
      detail,
    });
    this.#quiet();
  }

  #counted(): void {
    if (this.#state.kind === "pending") this.#become({ ...this.#state, sent: this.#state.sent + 1 });
  }

  #troubled(trouble: StopTrouble): void {
    if (this.#state.kind === "pending") this.#become({ ...this.#state, trouble });
  }

  #become(state: StopState): void {
    this.#state = state;
    this.#ports.changed(state);
  }

  #quiet(): void {
    if (this.#timer !== null) clearTimeout(this.#timer);
    this.#timer = null;
    for (const controller of this.#posts) controller.abort();
  }
}

const POSTS_AT_ONCE = 4;
