/**
 * The last minute of something, in slots of equal length on the server's clock. A slot in which nothing arrived is
 * absent: a gap stays a gap. Pure: time comes in with each value.
 */

/** One slot with what was seen in it. */
export interface Slot<T> {
  /** Slots since the server's start. */
  readonly index: number;
  readonly value: T;
}

/** Slots, oldest first; at most `kept` of them behind the newest. */
export interface Slots<T> {
  readonly secs: number;
  readonly kept: number;
  readonly slots: readonly Slot<T>[];
}

/** Nothing seen yet. */
export function noSlots<T>(secs: number, kept: number): Slots<T> {
  return { secs, kept, slots: [] };
}

/** The slot of a moment, server time in microseconds. */
export function slotAt(history: { readonly secs: number }, atMicros: number): number {
  return Math.floor(atMicros / (history.secs * 1e6));
}

/** Takes a value in. A time before the newest slot is another run of the server: what was before belongs to the old one. */
export function put<T>(history: Slots<T>, atMicros: number, merge: (seen: T | null) => T): Slots<T> {
  const index = slotAt(history, atMicros);
  const newest = history.slots.at(-1);
  if (newest !== undefined && index < newest.index) return { ...history, slots: [{ index, value: merge(null) }] };
  if (newest?.index === index) return { ...history, slots: [...history.slots.slice(0, -1), { index, value: merge(newest.value) }] };
  const oldest = index - history.kept + 1;
  return { ...history, slots: [...history.slots.filter((slot) => slot.index >= oldest), { index, value: merge(null) }] };
}

/** The window that ends with a slot, gaps as null, oldest first. */
export function windowOf<T>(history: Slots<T>, last: number): readonly (T | null)[] {
  const first = last - history.kept + 1;
  const window: (T | null)[] = Array.from({ length: history.kept }, () => null);
  for (const { index, value } of history.slots) if (index >= first && index <= last) window[index - first] = value;
  return window;
}
