/**
 * A scene as text: how it is written, and where in it a finding stands. Lines and columns come from the server, which has
 * read the very same text.
 */
import type { SceneDocument, SceneError } from "../api/types";

/** A finding at its place in the text. */
export interface PlacedError {
  readonly error: SceneError;
  /** From 1; null when the text has no place for it. */
  readonly line: number | null;
  /** Where in the text, in UTF-16 units, as a text field counts. */
  readonly offset: number;
}

/** Findings in the order of the text; those without a place first. */
export function placeErrors(text: string, errors: readonly SceneError[]): readonly PlacedError[] {
  const starts = lineStarts(text);
  return errors
    .map((error): PlacedError => {
      const start = error.line === null ? undefined : starts[error.line - 1];
      if (error.line === null || start === undefined) return { error, line: null, offset: 0 };
      const line = text.slice(start, (starts[error.line] ?? text.length + 1) - 1);
      return { error, line: error.line, offset: start + unitsIn(line, (error.column ?? 1) - 1) };
    })
    .sort((one, other) => (one.line ?? 0) - (other.line ?? 0) || one.offset - other.offset);
}

/**
 * Findings after the text was changed, until it is checked again: those below the change move with their lines, those in
 * it stay with its first line.
 */
export function moveErrors(errors: readonly SceneError[], before: string, after: string): readonly SceneError[] {
  const [old, now] = [before.split("\n"), after.split("\n")];
  let same = 0;
  while (same < Math.min(old.length, now.length) && old[same] === now[same]) same += 1;
  let tail = 0;
  while (tail < Math.min(old.length, now.length) - same && old[old.length - 1 - tail] === now[now.length - 1 - tail]) tail += 1;
  const moved = now.length - old.length;
  return errors.map((error) => {
    if (error.line === null || error.line <= same) return error;
    if (error.line > old.length - tail) return { ...error, line: error.line + moved };
    return { ...error, line: Math.min(error.line, now.length) };
  });
}

/** Where each line begins. */
export function lineStarts(text: string): readonly number[] {
  const starts = [0];
  for (let at = text.indexOf("\n"); at >= 0; at = text.indexOf("\n", at + 1)) starts.push(at + 1);
  return starts;
}

/** JSON as people write scenes: one field a line, points and lists of points on one. */
export function writeJson(value: unknown, indent = ""): string {
  if (typeof value !== "object" || value === null) return JSON.stringify(value);
  if (Array.isArray(value)) {
    if (value.length === 0) return "[]";
    const flat = numbersIn(value);
    if (flat !== null && flat.length + indent.length <= WIDTH) return flat;
    const items = value.map((item: unknown) => `${indent}  ${writeJson(item, `${indent}  `)}`);
    return `[\n${items.join(",\n")}\n${indent}]`;
  }
  const fields = Object.entries(value).filter(([, field]) => field !== undefined);
  if (fields.length === 0) return "{}";
  return `{\n${fields.map(([name, field]) => `${indent}  ${JSON.stringify(name)}: ${writeJson(field, `${indent}  `)}`).join(",\n")}\n${indent}}`;
}

/** The file that a version is downloaded as. */
export function fileNameOf(name: string, version: number): string {
  const plain = name
    .normalize("NFD")
    .replace(/\p{M}/gu, "")
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, "-")
    .replace(/^-+|-+$/g, "");
  return `${plain === "" ? "scene" : plain}-v${version}.json`;
}

/** A text that the server has passed, with its defaults filled in, to be drawn; null if it is no JSON. */
export function drawable(text: string): SceneDocument | null {
  try {
    const document = JSON.parse(text) as Partial<SceneDocument> & Pick<SceneDocument, "schema" | "name" | "arena" | "objects">;
    return {
      ...document,
      column: document.column ?? { size: [0.15, 0.15] },
      props: (document.props ?? []).map((prop) => ({ ...{ facing: 0, size: [0, 0] as [number, number] }, ...prop })),
      objects: document.objects.map((object) => ({ ...{ yaw: 0, prior: 1, enabled: true }, ...object })),
    };
  } catch {
    return null;
  }
}

/** The name that a text gives itself; null when it says none. */
export function nameIn(text: string): string | null {
  try {
    const found: unknown = JSON.parse(text);
    const name: unknown = typeof found === "object" && found !== null && "name" in found ? found.name : null;
    return typeof name === "string" ? name : null;
  } catch {
    return null;
  }
}

/** The server's columns count bytes. */
function unitsIn(line: string, bytes: number): number {
  let [units, passed] = [0, 0];
  for (const character of line) {
    if (passed >= bytes) break;
    const code = character.codePointAt(0) ?? 0;
    passed += code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x1_0000 ? 3 : 4;
    units += character.length;
  }
  return units;
}

function numbersIn(list: readonly unknown[]): string | null {
  const parts: string[] = [];
  for (const item of list) {
    if (typeof item === "number") parts.push(JSON.stringify(item));
    else if (Array.isArray(item)) {
      const inner = numbersIn(item);
      if (inner === null) return null;
      parts.push(inner);
    } else return null;
  }
  return `[${parts.join(", ")}]`;
}

const WIDTH = 110;
