/** What changed between two versions of a scene: line by line, and in terms of the room. */
import { diffLines } from "diff";
import type { KeepOutDocument, ObjectDocument, PropDocument, SceneDocument, StateDocument } from "../api/types";
import { writeJson } from "./sceneText";

/** A line of a comparison; numbers count from 1, null where the version does not have it. */
export interface DiffLine {
  readonly kind: "same" | "added" | "removed";
  readonly from: number | null;
  readonly to: number | null;
  readonly text: string;
}

/** A stretch of lines, or of unchanged lines that are left out. */
export type DiffPart = { readonly kind: "lines"; readonly lines: readonly DiffLine[] } | { readonly kind: "skipped"; readonly lines: readonly DiffLine[] };

/** What a scene consists of. */
export type Part = "objects" | "props" | "keep_outs" | "zones" | "states";

/** A change in terms of the room. */
export type SceneChange =
  | { readonly kind: "field"; readonly field: "name" | "description" | "arena" | "column" | "scenario" }
  | { readonly kind: "added" | "removed"; readonly part: Part; readonly name: string }
  | { readonly kind: "moved"; readonly name: string; readonly byM: number }
  | { readonly kind: "prior"; readonly name: string; readonly from: number; readonly to: number }
  | { readonly kind: "switched"; readonly name: string; readonly on: boolean }
  | { readonly kind: "changed"; readonly part: Part; readonly name: string; readonly fields: readonly string[] };

/** Both versions, written alike, line by line. */
export function diffScenes(before: SceneDocument, after: SceneDocument): readonly DiffLine[] {
  const lines: DiffLine[] = [];
  let [from, to] = [0, 0];
  for (const change of diffLines(`${writeJson(before)}\n`, `${writeJson(after)}\n`)) {
    const kind = change.added ? "added" : change.removed ? "removed" : "same";
    for (const text of change.value.replace(/\n$/, "").split("\n")) {
      if (kind !== "added") from += 1;
      if (kind !== "removed") to += 1;
      lines.push({ kind, from: kind === "added" ? null : from, to: kind === "removed" ? null : to, text });
    }
  }
  return lines;
}

/** The changed lines with some unchanged ones about them; the rest is skipped. */
export function foldDiff(lines: readonly DiffLine[], around: number): readonly DiffPart[] {
  const shown = new Uint8Array(lines.length);
  lines.forEach((line, index) => {
    if (line.kind !== "same") shown.fill(1, Math.max(0, index - around), index + around + 1);
  });
  const parts: { kind: DiffPart["kind"]; lines: DiffLine[] }[] = [];
  lines.forEach((line, index) => {
    const kind = shown[index] === 1 ? "lines" : "skipped";
    const last = parts.at(-1);
    if (last?.kind === kind) last.lines.push(line);
    else parts.push({ kind, lines: [line] });
  });
  return parts;
}

/** What changed, in the order of the document. */
export function changesBetween(before: SceneDocument, after: SceneDocument): readonly SceneChange[] {
  const changes: SceneChange[] = [];
  for (const field of ["name", "description", "arena", "column"] as const) {
    if (!same(before[field] ?? "", after[field] ?? "")) changes.push({ kind: "field", field });
  }
  compare<PropDocument>("props", before.props, after.props, changes);
  compare<ObjectDocument>("objects", before.objects, after.objects, changes, (old, now, name) => {
    const told: string[] = [];
    if (!same(old.position, now.position)) {
      changes.push({ kind: "moved", name, byM: Math.hypot(...now.position.map((value, axis) => value - (old.position[axis] ?? 0))) });
      told.push("position");
    }
    if (old.prior !== now.prior) {
      changes.push({ kind: "prior", name, from: old.prior, to: now.prior });
      told.push("prior");
    }
    if (old.enabled !== now.enabled) {
      changes.push({ kind: "switched", name, on: now.enabled });
      told.push("enabled");
    }
    return told;
  });
  compare<KeepOutDocument>("keep_outs", before.keep_outs, after.keep_outs, changes);
  compare<KeepOutDocument>("zones", before.zones, after.zones, changes);
  // Beside its states: where it begins, its variables, what leads on from anywhere.
  const rest = ({ scenario }: SceneDocument): unknown => (scenario === null || scenario === undefined ? null : { ...scenario, states: null });
  if (!same(rest(before), rest(after))) changes.push({ kind: "field", field: "scenario" });
  compare<StateDocument>("states", before.scenario?.states, after.scenario?.states, changes);
  return changes;
}

/** Things are the same by their id; `tell` reports some of a thing's fields itself and names them. */
function compare<T extends { readonly id: string; readonly label?: string }>(
  part: Part,
  before: readonly T[] = [],
  after: readonly T[] = [],
  changes: SceneChange[],
  tell: (old: T, now: T, name: string) => readonly string[] = () => [],
): void {
  const [old, now] = [new Map(before.map((thing) => [thing.id, thing])), new Set(after.map((thing) => thing.id))];
  for (const thing of before) if (!now.has(thing.id)) changes.push({ kind: "removed", part, name: nameOf(thing) });
  for (const thing of after) {
    const former = old.get(thing.id);
    if (former === undefined) {
      changes.push({ kind: "added", part, name: nameOf(thing) });
      continue;
    }
    const told = tell(former, thing, nameOf(thing));
    const fields = fieldsOf(former, thing).filter((field) => !told.includes(field));
    if (fields.length > 0) changes.push({ kind: "changed", part, name: nameOf(thing), fields });
  }
}

function fieldsOf(old: object, now: object): readonly string[] {
  const [one, other] = [new Map<string, unknown>(Object.entries(old)), new Map<string, unknown>(Object.entries(now))];
  return [...new Set([...one.keys(), ...other.keys()])].filter((field) => !same(one.get(field) ?? null, other.get(field) ?? null));
}

function nameOf(thing: { readonly id: string; readonly label?: string }): string {
  return thing.label !== undefined && thing.label !== "" ? thing.label : thing.id;
}

function same(one: unknown, other: unknown): boolean {
  return JSON.stringify(one) === JSON.stringify(other);
}
