/** Keeps the last minute of something while a panel is shown, from the snapshots as they come. */
import { createEffect, createSignal, on, type Accessor } from "solid-js";
import type { Snapshot } from "../api/types";
import type { Live } from "./live";
import type { Slots } from "./slots";

/** A ring that takes in each new snapshot, no more often than some milliseconds. */
export function createRing<T>(
  live: Live,
  empty: Slots<T>,
  take: (history: Slots<T>, snapshot: Snapshot) => Slots<T>,
  everyMillis = 100,
): Accessor<Slots<T>> {
  const [history, setHistory] = createSignal(empty);
  let takenMicros = -Infinity;
  createEffect(
    on(live.newest, (snapshot) => {
      if (snapshot === null) return;
      const since = snapshot.at_micros - takenMicros;
      // A step back in time is another run of the server.
      if (since >= 0 && since < everyMillis * 1000) return;
      takenMicros = snapshot.at_micros;
      setHistory((before) => take(before, snapshot));
    }),
  );
  return history;
}

/** The server's clock now, microseconds, in steps; it goes on while nothing arrives. */
export function nowMicros(live: Live, stepMicros: number): number {
  const snapshot = live.newest();
  const freshness = live.freshness();
  if (snapshot === null) return 0;
  const now = snapshot.at_micros + (freshness.kind === "none" ? 0 : freshness.ageMillis * 1000);
  return Math.floor(now / stepMicros) * stepMicros;
}
