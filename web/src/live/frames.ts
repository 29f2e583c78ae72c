/**
 * Decides whether a text frame is a message of the dashboard protocol. It never throws, and never lets an unknown
 * shape through: a frame that is not understood is counted and shown, not guessed at.
 */
import type { ToDashboard } from "../api/types";

/** A message, or why the frame is none. */
export type Parsed = { readonly message: ToDashboard } | { readonly trouble: string };

/** Reads one text frame. */
export function parseFrame(text: string): Parsed {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    return { trouble: "a frame that is not JSON" };
  }
  if (typeof value !== "object" || value === null || !("type" in value)) return { trouble: "a frame without a type" };
  const type = value.type;
  if (typeof type !== "string" || !isKnown(type)) return { trouble: `a frame of unknown type ${JSON.stringify(type)}` };
  for (const [field, kind] of FIELDS[type]) {
    if (kindOf((value as Record<string, unknown>)[field]) !== kind) {
      return { trouble: `${type}: ${field} is not of kind ${kind}` };
    }
  }
  return { message: value as ToDashboard };
}

type Kind = "number" | "string" | "array" | "object";

function isKnown(type: string): type is ToDashboard["type"] {
  return Object.hasOwn(FIELDS, type);
}

function kindOf(value: unknown): string {
  if (Array.isArray(value)) return "array";
  return value === null ? "null" : typeof value;
}

/** What the page would break without, by message. */
const FIELDS: Readonly<Record<ToDashboard["type"], readonly (readonly [string, Kind])[]>> = {
  welcome: [
    ["version", "string"],
    ["machine", "string"],
    ["machine_shape", "object"],
    ["link_thresholds", "object"],
  ],
  scene: [
    ["id", "number"],
    ["version", "number"],
    ["scene", "object"],
  ],
  snapshot: [
    ["generation", "number"],
    ["at_micros", "number"],
    ["mode", "string"],
    ["requests", "array"],
    ["rules", "array"],
    ["column", "object"],
    ["persons", "array"],
    ["objects", "array"],
    ["control_loop", "object"],
    ["clients", "array"],
  ],
  event: [
    ["at_micros", "number"],
    ["at", "string"],
    ["kind", "string"],
    ["summary", "string"],
  ],
  answer: [
    ["request_id", "number"],
    ["outcome", "string"],
    ["detail", "string"],
  ],
};
