import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { PriorPreview } from "../api/types";
import { DEBOUNCE_MILLIS, Previewer, REPEAT_MILLIS, type PreviewState } from "./preview";

beforeEach(() => vi.useFakeTimers());
afterEach(() => vi.useRealTimers());

function previewOf(committed: string): PriorPreview {
  return { target_m: null, serves: null, committed, planned_path_m: [], objects: [] };
}

function askedOf(ask: (priors: Readonly<Record<string, number>>, giveUp: AbortSignal) => Promise<PriorPreview>) {
  const states: PreviewState[] = [];
  const asking = vi.fn(ask);
  return { states, asking, previewer: new Previewer(asking, (state) => states.push(state)) };
}

it("waits until the hand rests, then asks once, and again while the edit waits", async () => {
  const { states, asking, previewer } = askedOf(() => Promise.resolve(previewOf("lamp")));
  for (const lamp of [0.1, 0.2, 0.3]) {
    previewer.edited({ lamp });
    await vi.advanceTimersByTimeAsync(DEBOUNCE_MILLIS - 1);
  }
  expect(asking).not.toHaveBeenCalled();
  await vi.advanceTimersByTimeAsync(1);
  expect(asking.mock.calls.map(([priors]) => priors)).toEqual([{ lamp: 0.3 }]);
  expect(states.at(-1)).toEqual({ kind: "shown", preview: previewOf("lamp") });
  await vi.advanceTimersByTimeAsync(REPEAT_MILLIS);
  expect(asking).toHaveBeenCalledTimes(2);
});

it("lets the newest question win, however late an older answer comes", async () => {
  const answers: ((preview: PriorPreview) => void)[] = [];
  const { states, asking, previewer } = askedOf(() => new Promise((resolve) => answers.push(resolve)));
  previewer.edited({ lamp: 0.1 });
  await vi.advanceTimersByTimeAsync(DEBOUNCE_MILLIS);
  previewer.edited({ lamp: 0.9 });
  await vi.advanceTimersByTimeAsync(DEBOUNCE_MILLIS);
  expect(asking.mock.calls[0]?.[1].aborted).toBe(true);
  answers[1]?.(previewOf("new"));
  answers[0]?.(previewOf("old"));
  await vi.advanceTimersByTimeAsync(0);
  expect(states.at(-1)).toEqual({ kind: "shown", preview: previewOf("new") });
});

it("says why there is none, and shows nothing when the edits are gone", async () => {
  const { states, asking, previewer } = askedOf(() => Promise.reject(new Error("lamp: found 3, expected a number from 0 to 1")));
  previewer.edited({ lamp: 3 });
  await vi.advanceTimersByTimeAsync(DEBOUNCE_MILLIS);
  expect(states.at(-1)).toEqual({ kind: "failed", why: "lamp: found 3, expected a number from 0 to 1" });
  previewer.edited({});
  expect(states.at(-1)).toEqual({ kind: "none" });
  await vi.advanceTimersByTimeAsync(REPEAT_MILLIS * 3);
  expect(asking).toHaveBeenCalledTimes(1);
});
