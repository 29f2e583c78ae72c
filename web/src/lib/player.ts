/**
 * The replay's clock: where it stands in a session, how fast it goes, and whether it follows a session that still runs.
 * It decides nothing about frames; it never leaves the session. Pure: the time that passed comes in as an argument.
 */
import { decimal } from "./format";

/** How a replay stands. Seconds count from the session's start. */
export interface Player {
  readonly atSecs: number;
  readonly lengthSecs: number;
  readonly playing: boolean;
  readonly speed: number;
  /** Keeps to the end of a session that still grows. */
  readonly following: boolean;
}

/** What can happen to it. */
export type PlayerAction =
  | { readonly kind: "tick"; readonly passedSecs: number }
  | { readonly kind: "play" }
  | { readonly kind: "pause" }
  | { readonly kind: "seek"; readonly toSecs: number }
  | { readonly kind: "speed"; readonly speed: number }
  | { readonly kind: "follow"; readonly on: boolean }
  | { readonly kind: "grown"; readonly lengthSecs: number };

/** The speeds that are offered, slowest first. */
export const SPEEDS: readonly number[] = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50];

/** A replay that stands at a time of a session. */
export function playerAt(atSecs: number, lengthSecs: number): Player {
  return { atSecs: within(atSecs, lengthSecs), lengthSecs, playing: false, speed: 1, following: false };
}

/** What comes of it. */
export function play(player: Player, action: PlayerAction): Player {
  switch (action.kind) {
    case "tick": {
      if (player.following) return { ...player, atSecs: followed(player.atSecs + Math.max(0, action.passedSecs), player.lengthSecs) };
      if (!player.playing) return player;
      const atSecs = within(player.atSecs + Math.max(0, action.passedSecs) * player.speed, player.lengthSecs);
      return { ...player, atSecs, playing: atSecs < player.lengthSecs };
    }
    case "play":
      // At the end, playing begins anew.
      return { ...player, playing: player.lengthSecs > 0, following: false, atSecs: player.atSecs >= player.lengthSecs ? 0 : player.atSecs };
    case "pause":
      return { ...player, playing: false, following: false };
    case "seek":
      return { ...player, atSecs: within(action.toSecs, player.lengthSecs), following: false };
    case "speed":
      return SPEEDS.includes(action.speed) ? { ...player, speed: action.speed } : player;
    case "follow":
      return action.on ? { ...player, following: true, playing: false, atSecs: followed(Infinity, player.lengthSecs) } : { ...player, following: false };
    case "grown":
      return { ...player, lengthSecs: Math.max(player.lengthSecs, action.lengthSecs) };
  }
}

/** The next faster or slower speed; the same at either end. */
export function speedBeside(speed: number, by: 1 | -1): number {
  return SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, SPEEDS.indexOf(speed) + by))] ?? speed;
}

/** The nearest of some times after (`by` 1) or before (`by` -1) a time, ascending; null when there is none. */
export function timeBeside(times: readonly number[], atSecs: number, by: 1 | -1): number | null {
  if (by > 0) return times.find((time) => time > atSecs + SAME_SECS) ?? null;
  return times.findLast((time) => time < atSecs - SAME_SECS) ?? null;
}

/** A time of a session as `1:02:03.4`, without hours below one. */
export function clockOf(secs: number): string {
  const tenths = Math.round(Math.max(0, secs) * 10);
  const [hours, minutes] = [Math.floor(tenths / 36_000), Math.floor(tenths / 600) % 60];
  const rest = decimal((tenths % 600) / 10, 1).padStart(4, "0");
  return hours > 0 ? `${hours}:${String(minutes).padStart(2, "0")}:${rest}` : `${minutes}:${rest}`;
}

function within(secs: number, lengthSecs: number): number {
  return Number.isFinite(secs) ? Math.max(0, Math.min(lengthSecs, secs)) : 0;
}

/** Where a follower stands: behind the end, of which the newest may not be stored yet; not far behind. */
function followed(atSecs: number, lengthSecs: number): number {
  const end = Math.max(0, lengthSecs - BEHIND_SECS);
  return atSecs > end || atSecs < end - LAG_SECS ? end : atSecs;
}

/** Recordings are written in blocks: the newest second may still be on its way. */
const BEHIND_SECS = 1.5;
/** A follower that fell behind by more jumps to the end. */
const LAG_SECS = 3;
/** Two times nearer than this are one, s: a jump to the next event leaves the one that it stands at. */
const SAME_SECS = 0.02;
