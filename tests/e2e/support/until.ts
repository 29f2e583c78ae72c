/** Waiting on conditions, with deadlines; never on time alone. */

/** Polls until the condition gives something; throws with what was awaited when the deadline passes. */
export async function until<T>(
  what: string,
  deadlineMillis: number,
  condition: () => T | null | undefined | false | Promise<T | null | undefined | false>,
): Promise<T> {
  const ends = performance.now() + deadlineMillis;
  let trouble: unknown = null;
  for (;;) {
    try {
      const found = await condition();
      if (found !== null && found !== undefined && found !== false) return found;
      trouble = null;
    } catch (error) {
      trouble = error;
    }
    if (performance.now() > ends) {
      const why = trouble instanceof Error ? `: ${trouble.message}` : "";
      throw new Error(`${what}: not within ${deadlineMillis / 1000} s${why}`);
    }
    await new Promise((resolve) => setTimeout(resolve, POLL_MILLIS));
  }
}

const POLL_MILLIS = 20;
