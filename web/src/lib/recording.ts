/**
 * A session's recording as a page holds it: loaded in windows about the time that is shown, the next ones ahead of need,
 * never more than a few. It decides what is known of a moment; between two frames it interpolates positions only, only
 * over a short time, and never across a gap.
 */
import type { RecordedFrame } from "../api/types";
import { troubleOf } from "./trouble";

/** A frame at its time, s from the session's start. */
export interface TimedFrame {
  readonly secs: number;
  readonly frame: RecordedFrame;
}

/** What is known of a moment. */
export type Moment =
  /** The frame then in force, positions moved on towards the next. */
  | { readonly kind: "frame"; readonly frame: RecordedFrame; readonly recordedSecs: number; readonly interpolated: boolean }
  /** Nothing was recorded between these times; `null`: from the start, or to the end. */
  | { readonly kind: "gap"; readonly fromSecs: number | null; readonly toSecs: number | null }
  | { readonly kind: "loading" }
  | { readonly kind: "failed"; readonly detail: string };

/** How densely frames are asked for, and in which stretches. */
export interface Density {
  /** At most one frame in so many seconds; 0 for every frame. */
  readonly everySecs: number;
  readonly windowSecs: number;
}

/** Reads frames of a stretch of the session, oldest first. */
export type ReadFrames = (fromSecs: number, toSecs: number, everySecs: number, giveUp: AbortSignal) => Promise<readonly TimedFrame[]>;

/** Longer without a frame than this is a gap, s; as live values are stale after it. */
export const GAP_SECS = 0.5;

/** Faster replay needs fewer frames of more time. */
export function densityFor(speed: number): Density {
  return DENSITIES.find(({ upTo }) => speed <= upTo)?.density ?? COARSEST;
}

/** What a replay at this time and speed needs: the window that it stands in, then those ahead, then the one behind. */
export function windowsNeeded(atSecs: number, lengthSecs: number, density: Density): readonly number[] {
  const last = Math.max(0, Math.ceil(lengthSecs / density.windowSecs) - 1);
  const here = Math.min(last, Math.floor(Math.max(0, atSecs) / density.windowSecs));
  return [here, here + 1, here + 2, here - 1].filter((index) => index >= 0 && index <= last);
}

/** The windows that the page holds. */
export class Recording {
  readonly #read: ReadFrames;
  readonly #changed: () => void;
  readonly #windows = new Map<string, Window>();
  #lengthSecs: number;
  #grows: boolean;

  constructor(read: ReadFrames, lengthSecs: number, grows: boolean, changed: () => void) {
    this.#read = read;
    this.#lengthSecs = lengthSecs;
    this.#grows = grows;
    this.#changed = changed;
  }

  /** The session went on; `grows` says whether it may go on still. What was read of its end is read on. */
  grown(lengthSecs: number, grows: boolean): void {
    this.#lengthSecs = Math.max(this.#lengthSecs, lengthSecs);
    this.#grows = grows;
  }

  /** Loads what a replay needs that stands there; forgets what is far. */
  need(atSecs: number, density: Density): void {
    const needed = windowsNeeded(atSecs, this.#lengthSecs, density).map((index) => keyOf(density, index));
    for (const [key, window] of this.#windows) {
      if (needed.includes(key)) continue;
      if (window.state === "loading" && !window.awaited) {
        window.giveUp.abort();
        this.#windows.delete(key);
      }
    }
    for (const index of windowsNeeded(atSecs, this.#lengthSecs, density)) void this.#load(density, index, false);
    this.#forget(needed);
  }

  /** Loads every frame about a time, for whoever steps by frames. */
  async every(atSecs: number): Promise<void> {
    const [index] = windowsNeeded(atSecs, this.#lengthSecs, EVERY_FRAME);
    if (index !== undefined) await this.#load(EVERY_FRAME, index, true);
  }

  /** Tries again what failed. */
  retry(): void {
    for (const [key, window] of this.#windows) if (window.state === "failed") this.#windows.delete(key);
    this.#changed();
  }

  /** Ends all reading. */
  end(): void {
    for (const window of this.#windows.values()) if (window.state === "loading") window.giveUp.abort();
    this.#windows.clear();
  }

  /** How many frames the page holds. */
  get held(): number {
    return [...this.#windows.values()].reduce((sum, window) => sum + window.frames.length, 0);
  }

  /** What is known of a moment, of what this density loads. */
  at(atSecs: number, density: Density): Moment {
    const index = Math.max(0, Math.min(Math.floor(atSecs / density.windowSecs), Math.ceil(this.#lengthSecs / density.windowSecs) - 1));
    const here = this.#windows.get(keyOf(density, index));
    if (here?.state === "failed") return { kind: "failed", detail: here.detail };
    if (here === undefined || (here.state === "loading" && here.frames.length === 0)) return { kind: "loading" };
    // A window that is being read on is known as far as it was read.
    if (here.state === "loading" && atSecs > here.readToSecs) return { kind: "loading" };
    const before = lastUpTo(here.frames, atSecs) ?? this.#windows.get(keyOf(density, index - 1))?.frames.at(-1);
    const after = here.frames.find(({ secs }) => secs > atSecs) ?? this.#windows.get(keyOf(density, index + 1))?.frames[0];
    return momentBetween(before, after, atSecs, Math.max(GAP_SECS, density.everySecs * 2.5));
  }

  /** The time of the frame after (`by` 1) or before (`by` -1) a time; null when none is loaded there. */
  frameBeside(atSecs: number, by: 1 | -1): number | null {
    const index = Math.max(0, Math.floor(atSecs / EVERY_FRAME.windowSecs));
    const near = [index - 1, index, index + 1].flatMap((at) => this.#windows.get(keyOf(EVERY_FRAME, at))?.frames ?? []);
    const found = by > 0 ? near.find(({ secs }) => secs > atSecs + SAME_SECS) : near.findLast(({ secs }) => secs < atSecs - SAME_SECS);
    return found?.secs ?? null;
  }

  /** Stretches without frames, of what is loaded. */
  gaps(density: Density): readonly (readonly [number, number])[] {
    const gapSecs = Math.max(GAP_SECS, density.everySecs * 2.5);
    const found: (readonly [number, number])[] = [];
    for (const window of this.#windows.values()) {
      if (window.density !== density || window.state !== "loaded") continue;
      let from = window.fromSecs;
      for (const secs of [...window.frames.map((timed) => timed.secs), window.readToSecs]) {
        if (secs - from > gapSecs) found.push([from, secs]);
        from = secs;
      }
    }
    return found;
  }

  async #load(density: Density, index: number, awaited: boolean): Promise<void> {
    const key = keyOf(density, index);
    const fromSecs = index * density.windowSecs;
    const toSecs = Math.min(fromSecs + density.windowSecs, this.#lengthSecs);
    const known = this.#windows.get(key);
    if (known?.state === "loading") {
      if (awaited) known.awaited = true;
      return known.done;
    }
    if (known?.state === "failed") return;
    if (known !== undefined && known.readToSecs >= toSecs - (this.#grows ? READ_ON_SECS : 0)) return;
    const readFrom = known === undefined ? fromSecs : known.readToSecs;
    if (toSecs - readFrom < LEAST_STRETCH_SECS) return;
    const window: Window = {
      state: "loading", density, fromSecs, frames: known?.frames ?? [], readToSecs: known?.readToSecs ?? fromSecs,
      giveUp: new AbortController(), awaited, detail: "", done: Promise.resolve(),
    };
    window.done = this.#fill(window, readFrom, toSecs);
    this.#windows.set(key, window);
    await window.done;
  }

  async #fill(window: Window, fromSecs: number, toSecs: number): Promise<void> {
    try {
      const frames = await this.#read(fromSecs, toSecs, window.density.everySecs, window.giveUp.signal);
      const lastSecs = window.frames.at(-1)?.secs ?? -Infinity;
      window.frames = [...window.frames, ...frames.filter(({ secs }) => secs > lastSecs && secs >= window.fromSecs && secs < window.fromSecs + window.density.windowSecs)];
      // Of a running session the newest may not be stored yet: it is read again from the last frame.
      const newestSecs = window.frames.at(-1)?.secs ?? window.fromSecs;
      window.readToSecs = this.#grows && toSecs > this.#lengthSecs - UNSETTLED_SECS ? newestSecs : toSecs;
      window.state = "loaded";
    } catch (error) {
      if (window.giveUp.signal.aborted) return;
      window.state = "failed";
      window.detail = troubleOf(error);
    }
    this.#changed();
  }

  /** Keeps the needed and the latest used, and no more than some windows. */
  #forget(needed: readonly string[]): void {
    for (const key of needed) {
      const window = this.#windows.get(key);
      if (window === undefined) continue;
      this.#windows.delete(key);
      this.#windows.set(key, window);
    }
    for (const [key, window] of this.#windows) {
      if (this.#windows.size <= MOST_WINDOWS) break;
      if (!needed.includes(key) && window.state !== "loading") this.#windows.delete(key);
    }
  }
}

/** What is known between two frames that follow one another. */
export function momentBetween(before: TimedFrame | undefined, after: TimedFrame | undefined, atSecs: number, gapSecs: number): Moment {
  if (before === undefined) {
    if (after === undefined || after.secs - atSecs > gapSecs) return { kind: "gap", fromSecs: null, toSecs: after?.secs ?? null };
    return { kind: "frame", frame: after.frame, recordedSecs: after.secs, interpolated: false };
  }
  if (after === undefined) {
    if (atSecs - before.secs > gapSecs) return { kind: "gap", fromSecs: before.secs, toSecs: null };
    return { kind: "frame", frame: before.frame, recordedSecs: before.secs, interpolated: false };
  }
  const apartSecs = after.secs - before.secs;
  // At a gap's edge the frame stands, for no longer than a frame lasts.
  if (apartSecs > gapSecs && atSecs > before.secs + SAME_SECS) return { kind: "gap", fromSecs: before.secs, toSecs: after.secs };
  if (apartSecs > MOST_BETWEEN_SECS || atSecs <= before.secs) return { kind: "frame", frame: before.frame, recordedSecs: before.secs, interpolated: false };
  const share = (atSecs - before.secs) / apartSecs;
  return { kind: "frame", frame: between(before.frame, after.frame, share), recordedSecs: before.secs, interpolated: true };
}

/** The first frame with its positions moved on towards the other; everything else is the first one's. */
export function between(first: RecordedFrame, other: RecordedFrame, share: number): RecordedFrame {
  const mixed = (from: number, to: number): number => from + (to - from) * share;
  const point = (from: [number, number], to: [number, number]): [number, number] => [mixed(from[0], to[0]), mixed(from[1], to[1])];
  const others = new Map(other.persons.map((person) => [person.id, person]));
  // A column that was homed between the two jumped from counts into the room.
  const sameRoom = first.column.homed === other.column.homed;
  return {
    ...first,
    column: !sameRoom
      ? first.column
      : {
          ...first.column,
          position_m: point(first.column.position_m, other.column.position_m),
          commanded_m: point(first.column.commanded_m, other.column.commanded_m),
          proxy_m: point(first.column.proxy_m, other.column.proxy_m),
        },
    persons: first.persons.map((person) => {
      const next = others.get(person.id);
      if (next === undefined || !person.tracked || !next.tracked || person.head_m === null || next.head_m === null) return person;
      const [from, to] = [person.head_m, next.head_m];
      // Farther than a head can: its origin was changed.
      if (Math.hypot(to[0] - from[0], to[1] - from[1]) > MOST_STEP_M) return person;
      return {
        ...person,
        head_m: [mixed(from[0], to[0]), mixed(from[1], to[1]), mixed(from[2], to[2])],
        yaw_rad: person.yaw_rad + Math.atan2(Math.sin(next.yaw_rad - person.yaw_rad), Math.cos(next.yaw_rad - person.yaw_rad)) * share,
        pitch_rad: mixed(person.pitch_rad, next.pitch_rad),
      };
    }),
  };
}

interface Window {
  state: "loading" | "loaded" | "failed";
  readonly density: Density;
  readonly fromSecs: number;
  frames: readonly TimedFrame[];
  /** How far the session was read in this window, s. */
  readToSecs: number;
  readonly giveUp: AbortController;
  /** Somebody waits for it: it is not given up when the replay moves away. */
  awaited: boolean;
  detail: string;
  done: Promise<void>;
}

function keyOf(density: Density, index: number): string {
  return `${density.everySecs}/${index}`;
}

function lastUpTo(frames: readonly TimedFrame[], atSecs: number): TimedFrame | undefined {
  let [low, high] = [0, frames.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((frames[middle]?.secs ?? Infinity) <= atSecs) low = middle + 1;
    else high = middle;
  }
  return frames[low - 1];
}

/** Every frame that was recorded. */
export const EVERY_FRAME: Density = { everySecs: 0, windowSecs: 10 };
const COARSEST: Density = { everySecs: 0.5, windowSecs: 120 };
/** At 60 pictures a second, 20 times the speed shows a third of a second a picture. */
const DENSITIES: readonly { readonly upTo: number; readonly density: Density }[] = [
  { upTo: 2, density: EVERY_FRAME },
  { upTo: 20, density: { everySecs: 0.2, windowSecs: 60 } },
  { upTo: 50, density: COARSEST },
];
/** About two thousand frames of some kilobytes at 30 a second. */
const MOST_WINDOWS = 8;
/** Positions farther apart in time are not mixed, s. */
const MOST_BETWEEN_SECS = 0.3;
/** A head that moves farther between two frames was moved by its tracking, m. */
const MOST_STEP_M = 0.5;
/** A time this near to a frame's is the frame's, s. */
const SAME_SECS = 0.0005;
/** The end of a running session is read on when it grew by this, s. */
const READ_ON_SECS = 0.5;
/** The server refuses a stretch of no length; times are told in ms. */
const LEAST_STRETCH_SECS = 0.001;
/** Recordings are written in blocks: frames this new may still be missing, s. */
const UNSETTLED_SECS = 5;
