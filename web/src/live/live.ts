/**
 * The page's live side, wired: socket, state, stop and requests behind one value that the views read. It decides how
 * often numbers are repainted; mode, stop and rules are never held back.
 */
import { createSignal, onCleanup, type Accessor } from "solid-js";
import { createStore, reconcile } from "solid-js/store";
import { listEvents, postStop } from "../api/http";
import type { JogAim, MachineRequest, Snapshot, WireEvent } from "../api/types";
import { words } from "../i18n";
import { troubleOf } from "../lib/trouble";
import { Connection } from "./connection";
import { createIdentity, type Identity } from "./identity";
import { Requests, type Answer } from "./requests";
import {
  NOTHING_YET,
  freshness,
  reduce,
  type ActiveScene,
  type Freshness,
  type Link,
  type LiveAction,
  type LiveState,
  type ServerIdentity,
} from "./state";
import { StopSender, type StopState } from "./stop";

/** What the views see. */
export interface Live {
  readonly link: Accessor<Link>;
  readonly server: Accessor<ServerIdentity | null>;
  readonly scene: Accessor<ActiveScene | null>;
  readonly events: Accessor<readonly WireEvent[]>;
  readonly trouble: Accessor<LiveState["trouble"]>;
  /** The newest snapshot, at most some ten times a second; for words and numbers. */
  readonly snapshot: Accessor<Snapshot | null>;
  /** The newest snapshot, each one; for the moving picture. */
  readonly newest: Accessor<Snapshot | null>;
  /** How old it is, going on by itself. */
  readonly freshness: Accessor<Freshness>;
  /** The page's clock, ms, ticking ten times a second. */
  readonly nowMillis: Accessor<number>;
  readonly stop: Accessor<StopState>;
  readonly pressStop: () => void;
  readonly ask: (request: MachineRequest, reason?: string) => Promise<Answer>;
  /** One order to jog, good for a moment; null lets go. */
  readonly jog: (to: JogAim | null, speedMps: number) => Promise<Answer>;
  readonly connectNow: () => void;
  /** Who sits here, and what they may. */
  readonly identity: Identity;
}

/** Connects, and keeps connected until the owner goes. */
export function createLive(): Live {
  const now = (): number => performance.now();
  let state = NOTHING_YET;
  const [link, setLink] = createSignal<Link>(state.link);
  const [server, setServer] = createSignal<ServerIdentity | null>(null);
  const [scene, setScene] = createSignal<ActiveScene | null>(null);
  const [events, setEvents] = createSignal<readonly WireEvent[]>([]);
  const [trouble, setTrouble] = createSignal<LiveState["trouble"]>(null);
  const [newest, setNewest] = createSignal<Snapshot | null>(null);
  const [paced, setPaced] = createStore<{ snapshot: Snapshot | null }>({ snapshot: null });
  const [age, setAge] = createSignal<Freshness>({ kind: "none" });
  const [nowMillis, setNowMillis] = createSignal(now());
  const [stop, setStop] = createSignal<StopState>({ kind: "idle" });

  let shown: Snapshot | null = null;
  let shownAtMillis = -Infinity;

  const show = (snapshot: Snapshot): void => {
    shown = snapshot;
    shownAtMillis = now();
    // The store changes its values in place: it gets its own copy.
    setPaced("snapshot", reconcile(structuredClone(snapshot)));
  };

  const apply = (action: LiveAction): void => {
    const before = state;
    state = reduce(state, action);
    setLink(state.link);
    setServer(state.server);
    setScene(state.scene);
    setEvents(state.events);
    setTrouble(state.trouble);
    if (state.snapshot !== null && state.snapshot !== before.snapshot) {
      setNewest(state.snapshot);
      if (shown === null || differsInWord(shown, state.snapshot) || now() - shownAtMillis >= REPAINT_EVERY_MILLIS) {
        show(state.snapshot);
      }
    }
    setAge(freshness(state, now()));
  };

  const connection = new Connection({
    open: () => new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws/v1/dashboard`),
    nowMillis: now,
    chance: Math.random,
    happened: (action) => {
      apply(action);
      if (action.kind === "opened") {
        stopSender.socketOpened();
        void readPastEvents(apply);
      }
      if (action.kind === "closed") {
        requests.lost();
        // A socket does not say why it was refused.
        void identity.refresh();
      }
      if (action.kind === "message" && action.message.type === "answer") {
        const { request_id, outcome, detail, why, to_drive_micros } = action.message;
        if (!stopSender.socketAnswered(request_id, outcome, detail, why, to_drive_micros)) {
          requests.answered(request_id, outcome, detail, why);
        }
        // A login that has ended shows itself by a refusal that is none of the machine's.
        if (outcome === "refused" && why === null) void identity.refresh();
      }
    },
  });
  const identity = createIdentity(() => {
    // What is open still speaks for whoever sat here before.
    requests.lost();
    connection.renew();
  });
  const requests = new Requests((message) => connection.send(message));
  const stopSender = new StopSender({
    nowMillis: now,
    sendOnSocket: (requestId, reason) => connection.send({ type: "stop", request_id: requestId, reason }),
    post: postStop,
    newRequestId: () => requests.newId(),
    changed: setStop,
  });

  const tick = setInterval(() => {
    setNowMillis(now());
    setAge(freshness(state, now()));
    if (state.snapshot !== null && shown !== state.snapshot && now() - shownAtMillis >= REPAINT_EVERY_MILLIS) {
      show(state.snapshot);
    }
  }, TICK_MILLIS);
  connection.connect();
  onCleanup(() => {
    clearInterval(tick);
    stopSender.dispose();
    connection.end();
  });

  return {
    link,
    server,
    scene,
    events,
    trouble,
    snapshot: () => paced.snapshot,
    newest,
    freshness: age,
    nowMillis,
    stop,
    pressStop: () => {
      stopSender.press(words().shell.stop.pressedHere);
    },
    ask: (request, reason) => requests.ask(request, reason ?? null),
    jog: (to, speedMps) => requests.jog(to, speedMps),
    connectNow: () => {
      connection.connect();
    },
    identity,
  };
}

/** Whether anything but a number changed: that is shown at once. */
function differsInWord(one: Snapshot, other: Snapshot): boolean {
  const words = (snapshot: Snapshot): string =>
    JSON.stringify([
      snapshot.mode,
      snapshot.stop,
      snapshot.requests,
      snapshot.rules.map((rule) => rule.status),
      snapshot.column.committed,
      snapshot.persons.map((person) => [person.id, person.awaits_confirmation, person.tracked]),
    ]);
  return words(one) !== words(other);
}

/** What happened before this page looked. Without it the list begins now, which is what it then says. */
async function readPastEvents(apply: (action: LiveAction) => void): Promise<void> {
  try {
    apply({ kind: "past_events", events: await listEvents(PAST_EVENTS) });
  } catch (error) {
    apply({ kind: "not_understood", trouble: words().shell.trouble.pastEvents(troubleOf(error)) });
  }
}

const TICK_MILLIS = 100;
const REPAINT_EVERY_MILLIS = 120;
const PAST_EVENTS = 60;
