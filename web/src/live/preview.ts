/**
 * Asks what edited priors would lead to. The newest question wins; while there are edits the question is repeated,
 * because people walk on.
 */
import type { PriorPreview } from "../api/types";
import { troubleOf } from "../lib/trouble";

/** How the preview stands. */
export type PreviewState =
  | { readonly kind: "none" }
  | { readonly kind: "asking"; readonly last: PriorPreview | null }
  | { readonly kind: "shown"; readonly preview: PriorPreview }
  | { readonly kind: "failed"; readonly why: string };

/** Waits this long for a slider to come to rest, ms. */
export const DEBOUNCE_MILLIS = 120;
/** Asks again this often while edits wait, ms. */
export const REPEAT_MILLIS = 1000;

/** One asker. */
export class Previewer {
  readonly #ask: (priors: Readonly<Record<string, number>>, giveUp: AbortSignal) => Promise<PriorPreview>;
  readonly #changed: (state: PreviewState) => void;
  #timer: ReturnType<typeof setTimeout> | null = null;
  #asking: AbortController | null = null;
  #last: PriorPreview | null = null;

  constructor(
    ask: (priors: Readonly<Record<string, number>>, giveUp: AbortSignal) => Promise<PriorPreview>,
    changed: (state: PreviewState) => void,
  ) {
    this.#ask = ask;
    this.#changed = changed;
  }

  /** Other edits, or none any more: then there is nothing to show. */
  edited(priors: Readonly<Record<string, number>>): void {
    this.end();
    if (Object.keys(priors).length === 0) {
      this.#last = null;
      this.#changed({ kind: "none" });
      return;
    }
    this.#changed({ kind: "asking", last: this.#last });
    this.#in(DEBOUNCE_MILLIS, priors);
  }

  /** Asks no more. */
  end(): void {
    if (this.#timer !== null) clearTimeout(this.#timer);
    this.#timer = null;
    this.#asking?.abort();
    this.#asking = null;
  }

  #in(millis: number, priors: Readonly<Record<string, number>>): void {
    this.#timer = setTimeout(() => void this.#now(priors), millis);
  }

  async #now(priors: Readonly<Record<string, number>>): Promise<void> {
    const asking = new AbortController();
    this.#asking = asking;
    let state: PreviewState;
    try {
      const preview = await this.#ask(priors, asking.signal);
      state = { kind: "shown", preview };
    } catch (error) {
      const why = troubleOf(error);
      state = { kind: "failed", why };
    }
    // A question that was overtaken has no say any more.
    if (asking.signal.aborted) return;
    this.#last = state.kind === "shown" ? state.preview : null;
    this.#changed(state);
    this.#in(REPEAT_MILLIS, priors);
  }
}
