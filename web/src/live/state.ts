/**
 * What the page knows of the server, as one value and one function of what arrived. It decides how old the shown
 * snapshot is; it must never call something live that is not. Pure: time comes in as an argument.
 */
import type { LinkThresholds, MachineShape, SceneDocument, Snapshot, ToDashboard, WireEvent } from "../api/types";

/** How the socket stands. */
export type Link =
  | { readonly phase: "connecting"; readonly attempt: number }
  | { readonly phase: "open" }
  | { readonly phase: "waiting"; readonly attempt: number; readonly retryAtMillis: number };

/** The server, as its welcome describes it. */
export interface ServerIdentity {
  readonly version: string;
  readonly machine: string;
  readonly shape: MachineShape;
  readonly thresholds: LinkThresholds;
}

/** The active scene. */
export interface ActiveScene {
  readonly id: number;
  readonly version: number;
  readonly scene: SceneDocument;
}

/** Everything that the page knows. */
export interface LiveState {
  readonly link: Link;
  readonly server: ServerIdentity | null;
  readonly scene: ActiveScene | null;
  readonly snapshot: Snapshot | null;
  /** When the shown snapshot was true, on the page's clock, ms; null before the first. */
  readonly snapshotAtMillis: number | null;
  /** Server clock to page clock: page minus server, ms, least seen on this connection. */
  readonly clockOffsetMillis: number | null;
  /** When the offset was last brought up to date, page clock, ms. */
  readonly clockSeenMillis: number;
  /** Newest first. */
  readonly events: readonly WireEvent[];
  /** Frames that were not understood, and the last of them in words. */
  readonly trouble: { readonly count: number; readonly last: string } | null;
}

/** What can happen to it. */
export type LiveAction =
  | { readonly kind: "connecting"; readonly attempt: number }
  | { readonly kind: "opened" }
  | { readonly kind: "closed"; readonly attempt: number; readonly retryAtMillis: number }
  | { readonly kind: "message"; readonly message: ToDashboard; readonly nowMillis: number }
  | { readonly kind: "past_events"; readonly events: readonly WireEvent[] }
  | { readonly kind: "not_understood"; readonly trouble: string };

/** How the shown values stand. */
export type Freshness =
  | { readonly kind: "none" }
  | { readonly kind: "live"; readonly ageMillis: number }
  | { readonly kind: "stale"; readonly ageMillis: number };

/** A snapshot older than this is stale, ms. */
export const STALE_AFTER_MILLIS = 500;

/** Before anything arrived. */
export const NOTHING_YET: LiveState = {
  link: { phase: "connecting", attempt: 0 },
  server: null,
  scene: null,
  snapshot: null,
  snapshotAtMillis: null,
  clockOffsetMillis: null,
  clockSeenMillis: 0,
  events: [],
  trouble: null,
};

/** The next state. */
export function reduce(state: LiveState, action: LiveAction): LiveState {
  switch (action.kind) {
    case "connecting":
      return { ...state, link: { phase: "connecting", attempt: action.attempt } };
    case "opened":
      return { ...state, link: { phase: "open" }, clockOffsetMillis: null };
    case "closed":
      return { ...state, link: { phase: "waiting", attempt: action.attempt, retryAtMillis: action.retryAtMillis } };
    case "not_understood":
      return { ...state, trouble: { count: (state.trouble?.count ?? 0) + 1, last: action.trouble } };
    case "past_events":
      return { ...state, events: mergeEvents(state.events, action.events) };
    case "message":
      return reduceMessage(state, action.message, action.nowMillis);
  }
}

/** How old the shown snapshot is now. */
export function freshness(state: LiveState, nowMillis: number): Freshness {
  if (state.snapshotAtMillis === null) return { kind: "none" };
  const ageMillis = Math.max(0, nowMillis - state.snapshotAtMillis);
  return { kind: state.link.phase === "open" && ageMillis < STALE_AFTER_MILLIS ? "live" : "stale", ageMillis };
}

function reduceMessage(state: LiveState, message: ToDashboard, nowMillis: number): LiveState {
  switch (message.type) {
    case "welcome":
      return {
        ...state,
        server: { version: message.version, machine: message.machine, shape: message.machine_shape, thresholds: message.link_thresholds },
        clockOffsetMillis: null,
      };
    case "scene":
      return { ...state, scene: { id: message.id, version: message.version, scene: message.scene } };
    case "event": {
      const { type, ...event } = message;
      return { ...state, events: mergeEvents([event], state.events) };
    }
    case "snapshot": {
      const { type, ...snapshot } = message;
      return takeSnapshot(state, snapshot, nowMillis);
    }
    case "answer":
      return state;
  }
}

/**
 * A snapshot that arrives late is as old as it is late. The least offset seen stands for an undelayed one; it may
 * grow by the drift of two clocks and no faster, so that a queue that builds up somewhere still looks old.
 */
function takeSnapshot(state: LiveState, snapshot: Snapshot, nowMillis: number): LiveState {
  const known = state.clockOffsetMillis;
  // On one connection the generation only grows: one that does not is no news, and freshens nothing.
  if (known !== null && state.snapshot !== null && snapshot.generation <= state.snapshot.generation) return state;
  const atMillis = snapshot.at_micros / 1000;
  const seen = nowMillis - atMillis;
  const drifted = known === null ? seen : known + (nowMillis - state.clockSeenMillis) * CLOCK_DRIFT;
  const offset = Math.min(seen, drifted);
  return {
    ...state,
    snapshot,
    snapshotAtMillis: atMillis + offset,
    clockOffsetMillis: offset,
    clockSeenMillis: nowMillis,
  };
}

/** Newest first, each once, no more than are shown. */
function mergeEvents(newer: readonly WireEvent[], older: readonly WireEvent[]): readonly WireEvent[] {
  const seen = new Set<string>();
  const merged: WireEvent[] = [];
  for (const event of [...newer, ...older]) {
    const key = `${event.at} ${event.kind} ${event.summary}`;
    if (seen.has(key)) continue;
    seen.add(key);
    merged.push(event);
  }
  merged.sort((one, other) => other.at.localeCompare(one.at));
  return merged.slice(0, EVENTS_KEPT);
}

/** Two crystals differ by less than this. */
const CLOCK_DRIFT = 200e-6;
const EVENTS_KEPT = 200;
