/** Decides how long to wait before the next attempt to connect: doubling, capped, never in step with other pages. */

/** The wait before an attempt, ms. Attempt 1 is the first retry; chance is from 0 to 1. */
export function waitMillis(attempt: number, chance: number): number {
  const whole = Math.min(LONGEST_MILLIS, SHORTEST_MILLIS * 2 ** Math.max(0, attempt - 1));
  return whole * (0.75 + 0.5 * chance);
}

const SHORTEST_MILLIS = 250;
const LONGEST_MILLIS = 3000;
