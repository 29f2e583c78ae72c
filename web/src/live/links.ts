/** How the links stood over the last minute, second by second, and how a value stands by its thresholds. Pure. */
import type { Client, ControlLoop, Snapshot, Threshold } from "../api/types";
import { noSlots, put, slotAt, windowOf, type Slots } from "./slots";

/** How a measure stands; `unknown` when it was not measured. */
export type Grade = "good" | "weak" | "bad" | "unknown";

/** What is kept of one client; nulls were not measured. */
export type ClientMeasure = "pose_rate_hz" | "pose_age_millis" | "jitter_millis" | "loss_percent" | "rtt_millis" | "errors";

/** What was seen in one second. */
export interface LinksSeen {
  readonly clients: ReadonlyMap<string, Pick<Client, ClientMeasure>>;
  readonly loop: ControlLoop;
  /** Snapshots that this page took in. */
  readonly snapshots: number;
}

/** A client and what tells it from others of the same name. */
export interface KeyedClient {
  readonly key: string;
  readonly client: Client;
}

/** A minute in seconds. */
export const NO_LINKS: Slots<LinksSeen> = noSlots(1, 60);

/** Takes a snapshot in: of each second, the last values count. */
export function takeLinks(history: Slots<LinksSeen>, snapshot: Pick<Snapshot, "at_micros" | "clients" | "control_loop">): Slots<LinksSeen> {
  return put(history, snapshot.at_micros, (seen) => ({
    clients: new Map(keyed(snapshot.clients).map(({ key, client }) => [key, client])),
    loop: snapshot.control_loop,
    snapshots: (seen?.snapshots ?? 0) + 1,
  }));
}

/** The clients in their order; of two with one name, the second is `name 2`. */
export function keyed(clients: readonly Client[]): readonly KeyedClient[] {
  const named = new Map<string, number>();
  return clients.map((client) => {
    const count = (named.get(client.name) ?? 0) + 1;
    named.set(client.name, count);
    return { key: count === 1 ? client.name : `${client.name} ${count}`, client };
  });
}

/** One value over the minute up to a moment; null where there was none. */
export function trace(history: Slots<LinksSeen>, untilMicros: number, pick: (seen: LinksSeen) => number | null | undefined): readonly (number | null)[] {
  return windowOf(history, slotAt(history, untilMicros)).map((seen) => (seen === null ? null : (pick(seen) ?? null)));
}

/** By how much a count grew over the minute; what was before the page looked does not count. */
export function growth(values: readonly (number | null)[]): number {
  const known = values.filter((value) => value !== null);
  return Math.max(0, (known.at(-1) ?? 0) - (known[0] ?? 0));
}

/** How a value stands; more is worse. */
export function gradeOf(value: number | null, threshold: Threshold | null): Grade {
  if (value === null || threshold === null) return "unknown";
  return value >= threshold.bad ? "bad" : value >= threshold.weak ? "weak" : "good";
}

/** The worst of some. */
export function worst(grades: readonly Grade[]): Grade {
  return (["bad", "weak", "good"] as const).find((grade) => grades.includes(grade)) ?? "unknown";
}
