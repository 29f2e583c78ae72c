import { describe, expect, it, vi } from "vitest";
import { recordedFrame } from "../../mock/session";
import { between, densityFor, EVERY_FRAME, momentBetween, Recording, windowsNeeded, type ReadFrames, type TimedFrame } from "./recording";

const LENGTH_SECS = 7200;

/** Ten frames a second, none from 100 s to 104 s. */
function framesOf(fromSecs: number, toSecs: number, everySecs: number): readonly TimedFrame[] {
  const frames: TimedFrame[] = [];
  const step = Math.max(0.1, everySecs);
  for (let index = Math.ceil(fromSecs / step - 1e-9); index * step < toSecs; index += 1) {
    const secs = index * step;
    if (secs > 100 && secs < 104) continue;
    frames.push({ secs, frame: recordedFrame(secs) });
  }
  return frames;
}

function recording(read: ReadFrames, lengthSecs = LENGTH_SECS, grows = false): { held: Recording; changed: () => number } {
  let count = 0;
  return { held: new Recording(read, lengthSecs, grows, () => (count += 1)), changed: () => count };
}

const readAll: ReadFrames = (from, to, every) => Promise.resolve(framesOf(from, to, every));

describe("a recording as the page holds it", () => {
  it("asks for a small window of a long session first", async () => {
    const read = vi.fn<ReadFrames>(readAll);
    const { held } = recording(read);
    held.need(3600, EVERY_FRAME);
    expect(read.mock.calls[0]?.slice(0, 3)).toEqual([3600, 3610, 0]);
    expect(held.at(3600.05, EVERY_FRAME).kind).toBe("loading");
    await vi.waitFor(() => {
      expect(held.at(3600.05, EVERY_FRAME)).toMatchObject({ kind: "frame", interpolated: true });
    });
    expect(read.mock.calls.every(([from, to]) => to - from <= 10)).toBe(true);
  });

  it("holds a bounded number of frames, however far it plays", async () => {
    const { held } = recording(readAll);
    let most = 0;
    for (let at = 0; at < 1200; at += 5) {
      held.need(at, EVERY_FRAME);
      await vi.waitFor(() => {
        expect(held.at(at, EVERY_FRAME).kind).not.toBe("loading");
      }, { interval: 0 });
      most = Math.max(most, held.held);
    }
    expect(most).toBeLessThanOrEqual(8 * 101);
  });

  it("invents nothing where nothing was recorded", async () => {
    const { held } = recording(readAll);
    held.need(100, EVERY_FRAME);
    await vi.waitFor(() => {
      expect(held.at(102, EVERY_FRAME)).toEqual({ kind: "gap", fromSecs: 100, toSecs: 104 });
    });
    expect(held.at(100, EVERY_FRAME).kind).toBe("frame");
    expect(held.at(104, EVERY_FRAME).kind).toBe("frame");
    expect(held.gaps(EVERY_FRAME)).toEqual([[100, 104]]);
  });

  it("gives up windows that a jump has left behind, and still knows the new place", async () => {
    const given: AbortSignal[] = [];
    const { held } = recording((from, to, every, giveUp) => {
      given.push(giveUp);
      return new Promise((resolve, reject) => {
        giveUp.addEventListener("abort", () => { reject(new Error("given up")); });
        if (from >= 5000) resolve(framesOf(from, to, every));
      });
    });
    held.need(50, EVERY_FRAME);
    held.need(5005, EVERY_FRAME);
    expect(given.slice(0, 4).every((signal) => signal.aborted)).toBe(true);
    await vi.waitFor(() => {
      expect(held.at(5005, EVERY_FRAME).kind).toBe("frame");
    });
  });

  it("says what failed, and tries again when asked", async () => {
    let broken = true;
    const { held } = recording((from, to, every) => (broken ? Promise.reject(new Error("no answer")) : Promise.resolve(framesOf(from, to, every))));
    held.need(10, EVERY_FRAME);
    await vi.waitFor(() => {
      expect(held.at(10, EVERY_FRAME)).toEqual({ kind: "failed", detail: "no answer" });
    });
    broken = false;
    held.need(10, EVERY_FRAME);
    expect(held.at(10, EVERY_FRAME).kind).toBe("failed");
    held.retry();
    held.need(10, EVERY_FRAME);
    await vi.waitFor(() => {
      expect(held.at(10, EVERY_FRAME).kind).toBe("frame");
    });
  });

  it("reads a running session on, without a frame twice", async () => {
    let storedSecs = 12;
    const { held } = recording((from, to, every) => Promise.resolve(framesOf(from, Math.min(to, storedSecs), every)), 12, true);
    held.need(11.5, EVERY_FRAME);
    await vi.waitFor(() => {
      expect(held.at(11.5, EVERY_FRAME).kind).toBe("frame");
    });
    storedSecs = 16;
    held.grown(16, true);
    held.need(15, EVERY_FRAME);
    await vi.waitFor(() => {
      expect(held.at(15, EVERY_FRAME)).toMatchObject({ kind: "frame" });
    });
    const times: number[] = [];
    for (let at: number | null = 10; at !== null; at = held.frameBeside(at, 1)) times.push(at);
    expect(times).toHaveLength(60);
    expect(new Set(times.map((secs) => secs.toFixed(2))).size).toBe(60);
  });

  it("steps frame by frame over the edge of a window", async () => {
    const { held } = recording(readAll);
    await held.every(19.9);
    expect(held.frameBeside(19.9, -1)).toBeCloseTo(19.8, 9);
    expect(held.frameBeside(19.9, 1)).toBeNull();
    await held.every(20);
    expect(held.frameBeside(19.9, 1)).toBeCloseTo(20, 9);
  });

  it("asks for fewer frames of more time the faster it plays", () => {
    expect([0.1, 1, 2].map((speed) => densityFor(speed).everySecs)).toEqual([0, 0, 0]);
    expect(densityFor(10)).toEqual({ everySecs: 0.2, windowSecs: 60 });
    expect(densityFor(50)).toEqual({ everySecs: 0.5, windowSecs: 120 });
    expect(windowsNeeded(0, 5, EVERY_FRAME)).toEqual([0]);
    expect(windowsNeeded(35, 60, EVERY_FRAME)).toEqual([3, 4, 5, 2]);
    expect(windowsNeeded(60, 60, EVERY_FRAME)).toEqual([5, 4]);
  });
});

describe("between two frames", () => {
  const frame = recordedFrame(0);
  const timed = (secs: number, change: Partial<typeof frame> = {}): TimedFrame => ({ secs, frame: { ...frame, ...change } });
  const columnAt = (x: number, homed = true) => ({ ...frame.column, position_m: [x, 0] as [number, number], homed });

  it("positions move on, words do not", () => {
    const moment = momentBetween(timed(1, { column: columnAt(0), mode: "following" }), timed(1.1, { column: columnAt(1), mode: "latched_stop" }), 1.025, 0.5);
    expect(moment).toMatchObject({ kind: "frame", interpolated: true, recordedSecs: 1, frame: { mode: "following" } });
    if (moment.kind === "frame") expect(moment.frame.column.position_m[0]).toBeCloseTo(0.25, 9);
  });

  it("nothing is mixed that is too far apart, in time or in space", () => {
    expect(momentBetween(timed(1), timed(1.4), 1.2, 0.5)).toMatchObject({ kind: "frame", interpolated: false });
    expect(momentBetween(timed(1), timed(1.6), 1.2, 0.5)).toEqual({ kind: "gap", fromSecs: 1, toSecs: 1.6 });
    expect(momentBetween(timed(1), undefined, 1.2, 0.5)).toMatchObject({ kind: "frame", interpolated: false });
    expect(momentBetween(timed(1), undefined, 2, 0.5)).toEqual({ kind: "gap", fromSecs: 1, toSecs: null });
    expect(momentBetween(undefined, undefined, 2, 0.5)).toEqual({ kind: "gap", fromSecs: null, toSecs: null });
    expect(between({ ...frame, column: columnAt(0, false) }, { ...frame, column: columnAt(3) }, 0.5).column.position_m[0]).toBe(0);
    const [person] = frame.persons;
    if (person === undefined) throw new Error("somebody is there");
    const jumped = between({ ...frame, persons: [{ ...person, head_m: [0, 0, 1.7] }] }, { ...frame, persons: [{ ...person, head_m: [2, 0, 1.7] }] }, 0.5);
    expect(jumped.persons[0]?.head_m).toEqual([0, 0, 1.7]);
    const lost = between({ ...frame, persons: [{ ...person, head_m: [0, 0, 1.7] }] }, { ...frame, persons: [{ ...person, tracked: false, head_m: [0.1, 0, 1.7] }] }, 0.5);
    expect(lost.persons[0]?.head_m).toEqual([0, 0, 1.7]);
  });

  it("a head turns the short way round", () => {
    const [person] = frame.persons;
    if (person === undefined) throw new Error("somebody is there");
    const turned = between({ ...frame, persons: [{ ...person, head_m: [0, 0, 1], yaw_rad: 3.1 }] }, { ...frame, persons: [{ ...person, head_m: [0, 0, 1], yaw_rad: -3.1 }] }, 0.5);
    expect(Math.abs(turned.persons[0]?.yaw_rad ?? 0)).toBeCloseTo(Math.PI, 2);
  });
});
