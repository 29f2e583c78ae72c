/** A live side for the tests of panels: a mock machine behind it, and hands on its clock and its link. */
import { createSignal } from "solid-js";
import { MockMachine } from "../../mock/machine";
import { LINK_THRESHOLDS, MACHINE_SHAPE, MOCK_SCENE } from "../../mock/scene";
import type { SceneDocument, Snapshot, WireEvent } from "../api/types";
import type { Identity } from "../live/identity";
import type { Live } from "../live/live";
import type { Freshness } from "../live/state";

/** What a test holds. */
export interface TestLive {
  readonly live: Live;
  readonly machine: MockMachine;
  /** Moves the machine on and shows its state, changed as wanted. */
  readonly show: (secs: number, change?: (snapshot: Snapshot) => Snapshot) => void;
  readonly setFreshness: (freshness: Freshness) => void;
}

/** Somebody whom the server asks nothing. */
export function anybody(): Identity {
  return {
    me: () => null,
    mustSignIn: () => false,
    may: () => true,
    refresh: () => Promise.resolve(),
    signIn: () => Promise.resolve(null),
    signOut: () => Promise.resolve(),
  };
}

/** A following machine with its scene. */
export function testLive(scene: SceneDocument = MOCK_SCENE): TestLive {
  const [events, setEvents] = createSignal<readonly WireEvent[]>([]);
  const machine = new MockMachine(scene, { latchedBy: null, mode: "following" }, (event) => setEvents((before) => [event, ...before]));
  const [snapshot, setSnapshot] = createSignal<Snapshot | null>(null);
  const [freshness, setFreshness] = createSignal<Freshness>({ kind: "none" });
  return {
    machine,
    show: (secs, change = (same) => same) => {
      machine.step(secs);
      setSnapshot(change(machine.snapshot()));
      setFreshness({ kind: "live", ageMillis: 0 });
    },
    setFreshness,
    live: {
      snapshot,
      newest: snapshot,
      freshness,
      events,
      link: () => ({ phase: "open" }),
      server: () => ({ version: "test", machine: "simulated", shape: MACHINE_SHAPE, thresholds: LINK_THRESHOLDS }),
      scene: () => ({ id: 1, version: 1, scene }),
      trouble: () => null,
      nowMillis: () => 0,
      stop: () => ({ kind: "idle" }),
      pressStop: () => undefined,
      ask: () => Promise.reject(new Error("nothing may be asked")),
      jog: () => Promise.reject(new Error("nothing may be jogged")),
      connectNow: () => undefined,
      identity: anybody(),
    },
  };
}
