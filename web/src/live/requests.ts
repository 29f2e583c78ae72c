/**
 * Requests to the machine and their answers. A request that the server does not answer in time is reported as
 * unanswered, never repeated: unlike a stop, it may move the machine.
 */
import type { FromDashboard, JogAim, MachineRequest, Outcome, Reason } from "../api/types";

/** What came of a request. */
export type Answer =
  | { readonly kind: "answered"; readonly outcome: Outcome; readonly detail: string; readonly why: Reason | null }
  | { readonly kind: "unanswered"; readonly because: Silence };

/** Why there is no answer. */
export type Silence = "not_sent" | "too_late" | "lost";

/** Waits for an answer this long, ms. */
export const ANSWER_DEADLINE_MILLIS = 3000;

/** Numbers requests and matches answers. */
export class Requests {
  readonly #send: (message: FromDashboard) => boolean;
  readonly #waiting = new Map<number, (answer: Answer) => void>();
  #lastId = 0;

  constructor(send: (message: FromDashboard) => boolean) {
    this.#send = send;
  }

  /** A number that no request of this page had. */
  newId(): number {
    this.#lastId += 1;
    return this.#lastId;
  }

  /** Asks, and waits for the answer. */
  ask(request: MachineRequest, reason: string | null): Promise<Answer> {
    return this.#put((request_id) => ({ type: "request", request_id, request, reason }));
  }

  /** One order to jog, good for a moment; null lets go. */
  jog(to: JogAim | null, speedMps: number): Promise<Answer> {
    return this.#put((request_id) => ({ type: "jog", request_id, to, speed_mps: speedMps }));
  }

  #put(message: (requestId: number) => FromDashboard): Promise<Answer> {
    const requestId = this.newId();
    if (!this.#send(message(requestId))) {
      return Promise.resolve({ kind: "unanswered", because: "not_sent" });
    }
    return new Promise((resolve) => {
      const deadline = setTimeout(() => {
        this.#waiting.delete(requestId);
        resolve({ kind: "unanswered", because: "too_late" });
      }, ANSWER_DEADLINE_MILLIS);
      this.#waiting.set(requestId, (answer) => {
        clearTimeout(deadline);
        this.#waiting.delete(requestId);
        resolve(answer);
      });
    });
  }

  /** An answer arrived. */
  answered(requestId: number, outcome: Outcome, detail: string, why: Reason | null): void {
    this.#waiting.get(requestId)?.({ kind: "answered", outcome, detail, why });
  }

  /** The connection went: whoever waits is told so now. */
  lost(): void {
    for (const tell of [...this.#waiting.values()]) {
      tell({ kind: "unanswered", because: "lost" });
    }
  }
}
