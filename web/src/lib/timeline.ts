/** Events as the timeline shows them: groups, filters, pages put together, and marks on the time bar. Pure. */
import type { WireEvent } from "../api/types";

/** The kinds, by what they are about. */
export const GROUPS = {
  stops: ["stop_pressed", "came_to_rest"],
  rules: ["rule_breached", "rule_cleared"],
  mode: ["mode_changed", "request_accepted", "request_refused", "homed", "jog_began", "jog_ended"],
  people: ["person_entered", "person_left", "served", "origin_changed", "touch_began", "touch_ended", "interaction_began", "interaction_ended", "contact_over"],
  priors: ["prior_changed"],
  scenes: ["scene_activated", "scene_stored", "scene_event", "state_entered", "scenario_cut", "note", "checklist_ticked"],
  clients: ["client_connected", "client_gone", "client_error", "signed_in", "signed_out", "token_made", "token_revoked", "token_taken_back"],
  calibration: ["calibration_accepted", "calibration_refused", "calibration_chosen", "machine_commissioned", "commissioning_refused"],
} as const satisfies Readonly<Record<string, readonly string[]>>;

/** What an event is about. */
export type Group = keyof typeof GROUPS;

/** Every group, in the order of the page. */
export const GROUP_NAMES = Object.keys(GROUPS) as readonly Group[];

/** What is wanted. */
export interface Filter {
  /** No group at all means every one. */
  readonly groups: readonly Group[];
  readonly search: string;
  readonly person: string | null;
  readonly session: number | null;
}

/** Everything. */
export const NO_FILTER: Filter = { groups: [], search: "", person: null, session: null };

/** The group of a kind; a kind that the page does not know is about the mode. */
export function groupOf(kind: string): Group {
  return GROUP_NAMES.find((group) => (GROUPS[group] as readonly string[]).includes(kind)) ?? "mode";
}

/** The kinds that a filter lets through; null for all. */
export function kindsOf(filter: Filter): readonly string[] | null {
  return filter.groups.length === 0 ? null : filter.groups.flatMap((group) => GROUPS[group]);
}

/** Whether an event that has just arrived passes, as the server would judge it. The session is not in an event. */
export function passes(event: WireEvent, filter: Filter): boolean {
  if (filter.groups.length > 0 && !filter.groups.includes(groupOf(event.kind))) return false;
  if (filter.search !== "" && !event.summary.toLowerCase().includes(filter.search.toLowerCase())) return false;
  return filter.person === null || personOf(event) === filter.person;
}

/** Whom an event is about, by name; null for nobody. */
export function personOf(event: WireEvent): string | null {
  const { detail } = event;
  if (typeof detail !== "object" || detail === null || !("person" in detail) || !("name" in detail)) return null;
  return typeof detail.name === "string" ? detail.name : null;
}

/** What tells an event from any other. */
export function keyOf(event: WireEvent): string {
  return `${event.at} ${event.kind} ${event.summary}`;
}

/** Lists put together: newest first, each once. */
export function merged(...lists: readonly (readonly WireEvent[])[]): readonly WireEvent[] {
  const byKey = new Map<string, WireEvent>();
  for (const event of lists.flat()) if (!byKey.has(keyOf(event))) byKey.set(keyOf(event), event);
  return [...byKey.values()].sort((one, other) => other.at.localeCompare(one.at));
}

/** A mark on the time bar. */
export interface Mark {
  readonly event: WireEvent;
  readonly group: Group;
  /** From the bar's left end, 0 to 1. */
  readonly place: number;
}

/** The events of the last minutes before a moment (wall clock, ms), oldest first. */
export function marksOf(events: readonly WireEvent[], nowMillis: number, spanMillis: number): readonly Mark[] {
  return events
    .flatMap((event) => {
      const place = 1 - (nowMillis - Date.parse(event.at)) / spanMillis;
      return place >= 0 && place <= 1 ? [{ event, group: groupOf(event.kind), place }] : [];
    })
    .reverse();
}
