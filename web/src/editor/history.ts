/** Undo and redo: every document that there was, up to a bound. Changes of one kind that follow one another closely are one step. */

/** A document with what was before it and what was undone. */
export interface History<T> {
  readonly past: readonly T[];
  readonly now: T;
  readonly future: readonly T[];
  /** What the last change was; the next of the same kind joins it. */
  readonly last: string | null;
  readonly lastAtMillis: number;
}

/** A beginning. */
export function begin<T>(now: T): History<T> {
  return { past: [], now, future: [], last: null, lastAtMillis: 0 };
}

/** A change; with a `kind` it joins the one before where that was of the same kind, a moment ago. */
export function changed<T>(history: History<T>, next: T, kind: string | null, atMillis: number): History<T> {
  if (next === history.now) return history;
  const joins = kind !== null && kind === history.last && atMillis - history.lastAtMillis < JOINS_MILLIS;
  const past = joins ? history.past : [...history.past, history.now].slice(-MOST_STEPS);
  return { past, now: next, future: [], last: kind, lastAtMillis: atMillis };
}

/** One step back. */
export function undone<T>(history: History<T>): History<T> {
  const before = history.past.at(-1);
  if (before === undefined) return history;
  return { past: history.past.slice(0, -1), now: before, future: [history.now, ...history.future], last: null, lastAtMillis: 0 };
}

/** One step forward again. */
export function redone<T>(history: History<T>): History<T> {
  const [after, ...rest] = history.future;
  if (after === undefined) return history;
  return { past: [...history.past, history.now], now: after, future: rest, last: null, lastAtMillis: 0 };
}

const JOINS_MILLIS = 800;
const MOST_STEPS = 200;
