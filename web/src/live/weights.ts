/** What the objects weighed over the last minute, from snapshots. Pure. */
import type { ObjectState, Snapshot, WireEvent } from "../api/types";
import { noSlots, put, slotAt, windowOf, type Slots } from "./slots";

/** What was seen in half a second. */
export interface Weighed {
  /** Greatest weight by object. */
  readonly weights: ReadonlyMap<string, number>;
  /** The object that the column was committed to last. */
  readonly committed: string | null;
}

/** One bar of an object's strip. */
export interface Bar {
  readonly weight: number;
  readonly committed: boolean;
}

/** A minute in half seconds. */
export const NO_WEIGHTS: Slots<Weighed> = noSlots(0.5, 120);

/** Takes a snapshot in. */
export function weigh(history: Slots<Weighed>, snapshot: Pick<Snapshot, "at_micros" | "objects" | "column">): Slots<Weighed> {
  return put(history, snapshot.at_micros, (seen) => ({
    weights: new Map(snapshot.objects.map(({ id, weight }) => [id, Math.max(seen?.weights.get(id) ?? 0, weight)])),
    committed: snapshot.column.committed,
  }));
}

/** The strip of one object up to a moment; null where nothing is known of it. */
export function barsOf(history: Slots<Weighed>, id: string, untilMicros: number): readonly (Bar | null)[] {
  return windowOf(history, slotAt(history, untilMicros)).map((slot) => {
    const weight = slot?.weights.get(id);
    return slot === null || weight === undefined ? null : { weight, committed: slot.committed === id };
  });
}

/** Objects that weighed more than this at some time of the minute, in the scene's order. */
export function heavierThan(history: Slots<Weighed>, objects: readonly ObjectState[], least: number, untilMicros: number): readonly ObjectState[] {
  const window = windowOf(history, slotAt(history, untilMicros));
  return objects.filter(({ id, weight }) => weight > least || window.some((slot) => (slot?.weights.get(id) ?? 0) > least));
}

/** When the column stood at each object for somebody, as slots from the window's left, by object. */
export function servedIn(history: Slots<Weighed>, events: readonly WireEvent[], untilMicros: number): ReadonlyMap<string, readonly number[]> {
  const first = slotAt(history, untilMicros) - history.kept + 1;
  const served = new Map<string, number[]>();
  for (const { kind, detail, at_micros } of events) {
    if (kind !== "served" || typeof detail !== "object" || detail === null || !("object" in detail)) continue;
    const place = slotAt(history, at_micros) - first;
    if (typeof detail.object !== "string" || place < 0 || place >= history.kept) continue;
    served.set(detail.object, [...(served.get(detail.object) ?? []), place]);
  }
  return served;
}
