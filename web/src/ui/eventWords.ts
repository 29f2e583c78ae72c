/** What an event says, in the page's language where its kind and particulars tell; the server's own words beside it. */
import type { Mode, WireEvent } from "../api/types";
import { words } from "../i18n";
import { decimal, millis, modeWords } from "../lib/format";

/** An event in words. */
export interface EventWords {
  /** In the page's language; null when only the server's sentence tells. */
  readonly text: string | null;
  /** What the server adds, English. */
  readonly server: string | null;
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
  const said = textOf(event, label);
  return said ?? { text: null, server: event.summary };
}

function textOf(event: WireEvent, label: (object: string) => string): EventWords | null {
  const text = words().desk.events;
  const detail = fieldsOf(event.detail);
  const field = (name: string): string | null => (typeof detail[name] === "string" ? detail[name] : null);
  const number = (name: string): number | null => (typeof detail[name] === "number" ? detail[name] : null);
  const of = (say: (...given: [string, string]) => string, names: readonly string[], server: string | null = null): EventWords | null => {
    const given = names.map((name) => (name === "object" ? mapped(field(name), label) : field(name)));
    return given.every((value) => value !== null) ? { text: say(given[0] ?? "", given[1] ?? ""), server } : null;
  };
  switch (event.kind) {
    case "mode_changed": {
      const [from, to] = [field("from"), field("to")];
      return isMode(from) && isMode(to) ? { text: text.mode_changed(modeWords(from), modeWords(to)), server: field("because") } : null;
    }
    case "rule_breached":
      return of(text.rule_breached, ["rule"], field("reason"));
    case "rule_cleared":
      return of(text.rule_cleared, ["rule"]);
    case "request_accepted":
    case "request_refused": {
      const [request, author] = [field("request"), field("author")];
      if (request === null || author === null) return null;
      const name = isRequest(request) ? text.requests[request] : request;
      return { text: text[event.kind](name, author), server: field("detail") };
    }
    case "stop_pressed": {
      const author = field("author");
      if (author === null) return null;
      const micros = number("to_drive_micros");
      return { text: `${text.stop_pressed(author)}; ${micros === null ? text.notAtDrive : text.atDrive(millis(micros / 1000))}`, server: field("reason") };
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
    case "served":
      return of(text.served, ["object", "name"]);
    case "touch_began":
    case "touch_ended":
      return of(text[event.kind], ["name", "object"]);
    case "scene_event":
      return of(text.scene_event, ["name"]);
    case "scene_activated":
      return of(text.scene_activated, ["name", "author"]);
    case "client_connected":
    case "client_gone":
      return of(text[event.kind], ["client"]);
    case "client_error":
      return of(text.client_error, ["client"], field("message"));
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

function valueOf(kind: string, name: string, value: unknown, label: (object: string) => string): Omit<Particular, "name"> {
  const { details } = words().desk;
  if (value === null) return { value: details.nothing, foreign: false };
  if (typeof value === "boolean") return { value: value ? details.yes : details.no, foreign: false };
  if (name === "to_drive_micros" && typeof value === "number") return { value: millis(value / 1000), foreign: false };
  if (typeof value === "number") return { value: kind === "prior_changed" ? decimal(value, 2) : String(value), foreign: false };
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

function isMode(value: string | null): value is Mode {
  return value !== null && MODES.has(value);
}

function isRequest(value: string): value is keyof ReturnType<typeof words>["desk"]["events"]["requests"] {
  return Object.hasOwn(words().desk.events.requests, value);
}

function isNamed(name: string): name is keyof ReturnType<typeof words>["desk"]["details"] {
  return Object.hasOwn(words().desk.details, name);
}

const MODES: ReadonlySet<string> = new Set<Mode>(["disarmed", "homing", "ready", "following", "protective_stop", "latched_stop", "faulted"]);
/** Fields that hold a sentence of the server. */
const SENTENCES: ReadonlySet<string> = new Set(["because", "detail", "message", "title"]);
