/**
 * Priors that a game master moves about before applying them. They stay when somebody else changes the same object,
 * and are marked then. Pure.
 */
import type { PriorChange } from "../api/types";

/** One prior as it would be. */
export interface Draft {
  readonly value: number;
  /** The prior in force when the edit began. */
  readonly base: number;
}

/** By object. */
export type Drafts = Readonly<Record<string, Draft>>;

/** What is known of the objects now, by id. */
export type PriorsNow = Readonly<Record<string, number>>;

/** What a typed prior is, or why it is none. */
export type TypedPrior = { readonly value: number } | { readonly wrong: "not_a_number" | "out_of_range" };

/** One change that was applied, to be set back. */
export interface SetBack {
  readonly object: string;
  /** What it was before. */
  readonly from: number;
  /** What it was set to. */
  readonly to: number;
}

/** Closer than this is the same prior; the page shows two digits. */
export const SAME_PRIOR = 0.0005;

/** Whether two priors are one. */
export function samePrior(one: number, other: number): boolean {
  return Math.abs(one - other) < SAME_PRIOR;
}

/** Reads a typed prior; a comma is a decimal point as well. */
export function readPrior(text: string): TypedPrior {
  const plain = text.trim().replace(",", ".");
  if (!/^[-+]?(\d+\.?\d*|\.\d+)$/.test(plain)) return { wrong: "not_a_number" };
  const value = Number(plain);
  return value >= 0 && value <= 1 ? { value } : { wrong: "out_of_range" };
}

/** Moves one object's prior; moved back to what is in force, it is no edit any more. */
export function edit(drafts: Drafts, object: string, value: number, inForce: number): Drafts {
  const { [object]: before, ...others } = drafts;
  if (samePrior(value, inForce)) return others;
  return { ...others, [object]: { value, base: before?.base ?? inForce } };
}

/** Leaves one object's edit out. */
export function drop(drafts: Drafts, object: string): Drafts {
  const { [object]: _dropped, ...others } = drafts;
  return others;
}

/** Edits of objects that the scene still has; what somebody else has set to the same is done. */
export function settle(drafts: Drafts, now: PriorsNow): Drafts {
  const kept = Object.entries(drafts).filter(([object, draft]) => {
    const inForce = now[object];
    return inForce !== undefined && !samePrior(draft.value, inForce);
  });
  return kept.length === Object.keys(drafts).length ? drafts : Object.fromEntries(kept);
}

/** Edited objects whose prior somebody else changed since the edit began. */
export function overtaken(drafts: Drafts, now: PriorsNow): readonly string[] {
  return Object.keys(drafts).filter((object) => {
    const [draft, inForce] = [drafts[object], now[object]];
    return draft !== undefined && inForce !== undefined && !samePrior(draft.base, inForce);
  });
}

/** What is sent: object and prior. */
export function wanted(drafts: Drafts): Readonly<Record<string, number>> {
  return Object.fromEntries(Object.entries(drafts).map(([object, draft]) => [object, draft.value]));
}

/** Edits that make the priors so; objects that are so already stay out. */
export function editsTo(drafts: Drafts, target: PriorsNow, now: PriorsNow): Drafts {
  return Object.entries(target).reduce((edits, [object, value]) => {
    const inForce = now[object];
    return inForce === undefined ? edits : edit(edits, object, value, inForce);
  }, drafts);
}

/** What an apply will have changed, for setting it back. */
export function setBacksOf(drafts: Drafts, now: PriorsNow): readonly SetBack[] {
  return Object.entries(drafts).flatMap(([object, { value }]) => {
    const from = now[object];
    return from === undefined || samePrior(from, value) ? [] : [{ object, from, to: value }];
  });
}

/** Of some changes to set back, those that something else has overwritten since: setting back would undo that too. */
export function overwritten(changes: readonly SetBack[], now: PriorsNow): readonly SetBack[] {
  return changes.filter(({ object, to }) => {
    const inForce = now[object];
    return inForce === undefined || !samePrior(inForce, to);
  });
}

/**
 * What an author's applies changed and what was not set back since, oldest first, by the list of everybody's changes,
 * newest first. The list is followed back as long as each change leads to what came after it, the last to what is in
 * force: where it does not, the scene was activated anew, and what was before cannot be set back.
 */
export function undoable(changes: readonly PriorChange[], author: string, now: PriorsNow): readonly (readonly SetBack[])[] {
  const known: Record<string, number> = { ...now };
  const applies: { at: string; backs: SetBack[] }[] = [];
  for (const { at, author: by, object, from, to } of changes) {
    if (!samePrior(known[object] ?? NaN, to)) break;
    known[object] = from;
    if (by !== author) continue;
    const newest = applies.at(-1);
    if (newest?.at === at && newest.backs.every((back) => back.object !== object)) newest.backs.push({ object, from, to });
    else applies.push({ at, backs: [{ object, from, to }] });
  }
  const standing: (readonly SetBack[])[] = [];
  for (const { backs } of applies.reverse()) {
    const before = standing.at(-1);
    if (before !== undefined && undoes(backs, before)) standing.pop();
    else standing.push(backs);
  }
  return standing;
}

/** Who changed an object last, by the list of changes, newest first. */
export function lastChangeOf(changes: readonly PriorChange[], object: string): PriorChange | null {
  return changes.find((change) => change.object === object) ?? null;
}

function undoes(backs: readonly SetBack[], before: readonly SetBack[]): boolean {
  return backs.length === before.length && backs.every(({ object, to }) => before.some((back) => back.object === object && samePrior(back.from, to)));
}
