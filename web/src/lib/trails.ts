/** Where the column and the heads were in the last seconds. What was not seen leaves a gap; nothing is joined over it. */
import type { Point } from "./plan";

/** One place on the way. */
export interface TrailPoint {
  readonly at: Point;
  readonly atMicros: number;
  /** It was reached from the one before. */
  readonly joined: boolean;
}

/** The way of the column, or of a person by number; oldest first. */
export interface Trail {
  readonly of: "column" | number;
  readonly points: readonly TrailPoint[];
}

/** All ways, and the moment that they lead to. */
export interface Trails {
  readonly nowMicros: number;
  readonly lines: readonly Trail[];
}

/** What leaves a trail. */
export interface Walker {
  readonly column: { readonly position_m: Point; readonly homed: boolean };
  readonly persons: readonly { readonly id: number; readonly head_m: readonly [number, number, number] | null; readonly tracked: boolean }[];
}

/** How long a trail is kept, s. */
export const TRAIL_SECS = 10;

/** Keeps trails while states come. */
export class TrailKeeper {
  readonly #lines = new Map<"column" | number, TrailPoint[]>();
  #nowMicros = -Infinity;

  /** Takes the next state; one from before the last (a restarted server, a recording wound back) begins anew. */
  take(state: Walker, atMicros: number): void {
    if (atMicros < this.#nowMicros) this.#lines.clear();
    this.#nowMicros = atMicros;
    if (state.column.homed) this.#add("column", state.column.position_m, atMicros);
    for (const { id, head_m, tracked } of state.persons) {
      if (head_m !== null && tracked) this.#add(id, [head_m[0], head_m[1]], atMicros);
    }
    const oldest = atMicros - TRAIL_SECS * 1e6;
    for (const [of, points] of this.#lines) {
      const keep = points.findIndex((point) => point.atMicros >= oldest);
      if (keep < 0) this.#lines.delete(of);
      else if (keep > 0) points.splice(0, keep);
    }
  }

  /** The trails now. */
  trails(): Trails {
    return { nowMicros: this.#nowMicros, lines: [...this.#lines].map(([of, points]) => ({ of, points })) };
  }

  #add(of: "column" | number, at: Point, atMicros: number): void {
    const points = this.#lines.get(of);
    const last = points?.at(-1);
    if (points === undefined || last === undefined) {
      this.#lines.set(of, [{ at, atMicros, joined: false }]);
      return;
    }
    if (atMicros - last.atMicros < EVERY_MICROS) return;
    points.push({ at, atMicros, joined: atMicros - last.atMicros <= GAP_MICROS });
  }
}

/** Ten places a second are a smooth line. */
const EVERY_MICROS = 95_000;
/** Longer without a place: it was not seen, and no line claims to know. */
const GAP_MICROS = 500_000;
