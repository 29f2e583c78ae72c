/** What an event says, in the page's language where its kind and particulars tell; the server's own words beside it. */
import type { Mode, WireEvent } from "../api/types";
import { isReason } from "../api/reason";
import { words } from "../i18n";
import { decimal, millis, modeWords } from "../lib/format";
import { requestWords, said, type Said } from "../lib/reasonWords";

/** An event in words. */
export interface EventWords {
  /** In the page's language; null when only the server's sentence tells. */
  readonly text: string | null;
  /** Why, or what somebody said; in the server's English where the page does not know the reason. */
  readonly server: Said | null;
}

/** One particular of an event. */
export interface Particular {
  readonly name: string;
  readonly value: string;
  /** The value is the server's or somebody's sentence. */
  readonly foreign: boolean;
}

/** What happened. */
export function eventWords(event: WireEvent, label: (object: string) => string): EventWords {
  const told = textOf(event, label);
  return told ?? { text: null, server: { text: event.summary, lang: "en" } };
}

function textOf(event: WireEvent, label: (object: string) => string): EventWords | null {
  const text = words().desk.events;
  const detail = fieldsOf(event.detail);
  const field = (name: string): string | null =>
    name === "author" ? whoOf(detail) : typeof detail[name] === "string" ? detail[name] : null;
  /** The reason that comes with a sentence of the server, else that sentence. */
  const why = (name: string): Said | null => {
    const english = field(name);
    return english === null ? null : said(isReason(detail["why"]) ? detail["why"] : null, english, label);
  };
  const number = (name: string): number | null => (typeof detail[name] === "number" ? detail[name] : null);
  const of = (say: (...given: [string, string]) => string, names: readonly string[], server: Said | null = null): EventWords | null => {
    const given = names.map((name) => (name === "object" ? mapped(field(name), label) : field(name)));
    return given.every((value) => value !== null) ? { text: say(given[0] ?? "", given[1] ?? ""), server } : null;
  };
  switch (event.kind) {
    case "mode_changed": {
      const [from, to] = [field("from"), field("to")];
      return isMode(from) && isMode(to) ? { text: text.mode_changed(modeWords(from), modeWords(to)), server: becauseOf(field("rule"), why("because")) } : null;
    }
    case "rule_breached":
      return of(text.rule_breached, ["rule"], why("reason"));
    case "rule_cleared":
      return of(text.rule_cleared, ["rule"]);
    case "request_accepted":
    case "request_refused": {
      const [request, author] = [field("request"), field("author")];
      if (request === null || author === null) return null;
      const name = requestWords(request);
      const person = field("name");
      return { text: text[event.kind](person === null ? name : `${name} (${person})`, author), server: why("detail") };
    }
    case "stop_pressed": {
      const author = field("author");
      if (author === null) return null;
      const micros = number("to_drive_micros");
      const isInput = detail["by"] === "input";
      const who = isInput ? text.stop_by_input(author) : text.stop_pressed(author);
      const reached = micros === null ? text.notAtDrive : text.atDrive(millis(micros / 1000));
      return { text: `${who}; ${reached}`, server: isInput ? why("reason") : spoken(field("reason")) };
    }
    case "prior_changed": {
      const [from, to] = [number("from"), number("to")];
      if (from === null || to === null) return null;
      return of((author: string, object: string) => text.prior_changed(author, object, decimal(from, 2), decimal(to, 2)), ["author", "object"]);
    }
    case "person_entered":
    case "person_left":
    case "origin_changed":
      return of(text[event.kind], ["name"]);
    case "machine_commissioned":
      return of(text.machine_commissioned, ["author"]);
    case "note":
      return of(text.note, ["author", "text"]);
    case "checklist_ticked":
      return of(detail["ticked"] === false ? text.checklist_unticked : text.checklist_ticked, ["author", "text"]);
    case "commissioning_refused":
      return of(text.commissioning_refused, ["author"], why("detail"));
    case "homed": {
      const found = detail["repeatability_m"];
      const off = Array.isArray(found) ? found.map((axis) => decimal(Number(axis) * 1000, 2)) : null;
      return { text: off === null ? text.homed : text.homed_within(off[0] ?? "", off[1] ?? ""), server: null };
    }
    case "came_to_rest": {
      const way = detail["distance_m"];
      const secs = number("secs");
      if (!Array.isArray(way) || secs === null) return null;
      return { text: text.came_to_rest(decimal(Math.hypot(...way.map(Number)), 3), decimal(secs, 2)), server: null };
    }
    case "jog_began":
      return { text: text.jog_began, server: null };
    case "jog_ended": {
      const because = detail["why"];
      return { text: text.jog_ended, server: isReason(because) ? said(because, event.summary, label) : null };
    }
    case "interaction_began":
    case "interaction_ended": {
      const [name, object, because] = [field("interaction"), field("object"), detail["why"]];
      if (name === null || object === null || !Object.hasOwn(text.interactions, name)) return null;
      const interaction = text.interactions[name as keyof typeof text.interactions];
      return { text: text[event.kind](interaction, label(object)), server: isReason(because) ? said(because, event.summary, label) : null };
    }
    case "contact_over":
      return of(text.contact_over, ["name"], why("detail"));
    case "served":
      return of(text.served, ["object", "name"]);
    case "touch_began":
    case "touch_ended":
      return of(text[event.kind], ["name", "object"]);
    case "scene_event":
      return of(text.scene_event, ["name"]);
    case "scene_activated":
      return of(text.scene_activated, ["name", "author"]);
    case "state_entered": {
      const by = field("by");
      const what = field("object") ?? field("zone") ?? field("event") ?? field("cue") ?? field("reason") ?? "";
      const why = by !== null && isStateCause(by) ? text.stateBy[by](field("name") ?? "", field("object") === null ? what : label(what)) : null;
      return of(text.state_entered, ["state"], spoken(why));
    }
    case "scenario_cut":
      return of(text.scenario_cut, ["state"]);
    case "client_connected":
    case "client_gone":
      return of(text[event.kind], ["client"]);
    case "client_error":
      return of(text.client_error, ["client"], clientErrorOf(field("code"), field("message")));
    case "calibration_accepted":
    case "calibration_chosen":
      return of(text[event.kind], ["author", "subject"]);
    case "calibration_refused":
      return of(text.calibration_refused, ["author", "subject"], why("detail"));
    default:
      return null;
  }
}

/** The particulars of an event, in the order of the server; those that it has not are left out. */
export function particularsOf(event: WireEvent, label: (object: string) => string): readonly Particular[] {
  const names = words().desk.details;
  return Object.entries(fieldsOf(event.detail)).map(([name, value]) => ({
    name: isNamed(name) ? names[name] : name,
    ...valueOf(event.kind, name, value, label),
  }));
}

/** The name that somebody gave, with the token and role behind it: `Ada (front desk, game master)`. */
function whoOf(detail: Readonly<Record<string, unknown>>): string | null {
  const author = detail["author"];
  if (typeof author !== "string") return null;
  const actor = actorOf(detail["actor"]);
  if (actor === null) return author;
  return actor.token === author ? `${author} (${actor.role})` : `${author} (${actor.token}, ${actor.role})`;
}

function actorOf(value: unknown): { readonly token: string; readonly role: string } | null {
  const { token, role } = fieldsOf(value);
  if (typeof token !== "string" || typeof role !== "string") return null;
  const { roles } = words().shell.access;
  return { token, role: Object.hasOwn(roles, role) ? roles[role as keyof typeof roles] : role };
}

function valueOf(kind: string, name: string, value: unknown, label: (object: string) => string): Omit<Particular, "name"> {
  const { details } = words().desk;
  if (value === null) return { value: details.nothing, foreign: false };
  if (typeof value === "boolean") return { value: value ? details.yes : details.no, foreign: false };
  if (name === "to_drive_micros" && typeof value === "number") return { value: millis(value / 1000), foreign: false };
  if (typeof value === "number") return { value: kind === "prior_changed" ? decimal(value, 2) : String(value), foreign: false };
  const actor = name === "actor" ? actorOf(value) : null;
  if (actor !== null) return { value: `${actor.token}, ${actor.role}`, foreign: false };
  if (typeof value !== "string") return { value: JSON.stringify(value), foreign: false };
  if (name === "object") return { value: label(value), foreign: false };
  if (kind === "mode_changed" && isMode(value)) return { value: modeWords(value), foreign: false };
  return { value, foreign: SENTENCES.has(name) };
}

function fieldsOf(detail: unknown): Readonly<Record<string, unknown>> {
  return typeof detail === "object" && detail !== null && !Array.isArray(detail) ? (detail as Readonly<Record<string, unknown>>) : {};
}

function mapped(value: string | null, map: (value: string) => string): string | null {
  return value === null ? null : map(value);
}

function isStateCause(by: string): by is keyof ReturnType<typeof words>["desk"]["events"]["stateBy"] {
  return Object.hasOwn(words().desk.events.stateBy, by);
}

function isMode(value: string | null): value is Mode {
  return value !== null && MODES.has(value);
}

/** A mode that a rule led to. */
function becauseOf(rule: string | null, why: Said | null): Said | null {
  // The server's own sentence begins with its rule.
  return rule === null || why === null || why.lang !== undefined ? why : { text: words().desk.events.byRule(rule, why.text) };
}

/** What a person said, in whatever language. */
function spoken(text: string | null): Said | null {
  return text === null ? null : { text };
}

function clientErrorOf(code: string | null, message: string | null): Said | null {
  const codes: Readonly<Record<string, string>> = words().desk.clientErrors;
  const known = code === null ? undefined : codes[code];
  if (known !== undefined) return { text: known };
  return message === null ? null : { text: message, lang: "en" };
}

function isNamed(name: string): name is keyof ReturnType<typeof words>["desk"]["details"] {
  return Object.hasOwn(words().desk.details, name);
}

const MODES: ReadonlySet<string> = new Set<Mode>(["disarmed", "homing", "ready", "following", "protective_stop", "latched_stop", "faulted"]);
/** Fields that hold a sentence of the server; what they say is said above them in the page's language. */
const SENTENCES: ReadonlySet<string> = new Set(["because", "detail", "message", "title"]);
