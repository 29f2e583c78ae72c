/**
 * The hand that jogs the column: an order now and ten times a second while a button is held, and one that lets go. The
 * server ends the jog by itself when orders stay away; here nothing is sent that nobody holds.
 */
import type { JogAim } from "../api/types";
import type { Answer } from "./requests";

/** The world, as the hand sees it. */
export interface HandPorts {
  readonly order: (to: JogAim | null, speedMps: number) => Promise<Answer>;
  readonly changed: (state: HandState) => void;
}

/** Whether a button is held, and what the server said last. */
export interface HandState {
  readonly held: boolean;
  readonly answer: Answer | null;
}

/** An order is given anew so often, ms: three before it is too old. */
export const ORDER_EVERY_MILLIS = 100;

/** One hand on one button. */
export class JogHand {
  readonly #ports: HandPorts;
  #timer: ReturnType<typeof setInterval> | null = null;

  constructor(ports: HandPorts) {
    this.#ports = ports;
  }

  /** A button went down. */
  hold(to: JogAim, speedMps: number): void {
    this.letGo();
    const order = async (): Promise<void> => {
      const answer = await this.#ports.order(to, speedMps);
      if (this.#timer !== timer) return;
      // Without a connection nothing is held: the button must be let go and taken anew.
      if (answer.kind === "unanswered") this.#end();
      this.#ports.changed({ held: answer.kind === "answered", answer });
    };
    const timer = setInterval(() => void order(), ORDER_EVERY_MILLIS);
    this.#timer = timer;
    this.#ports.changed({ held: true, answer: null });
    void order();
  }

  /** The button went up, or lost the focus, or the page was hidden. */
  letGo(): void {
    if (this.#timer === null) return;
    this.#end();
    void this.#ports.order(null, 0);
    this.#ports.changed({ held: false, answer: null });
  }

  #end(): void {
    if (this.#timer !== null) clearInterval(this.#timer);
    this.#timer = null;
  }
}
