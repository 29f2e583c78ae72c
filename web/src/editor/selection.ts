/** What is chosen in the editor, and which thing a JSON path of the server's findings is about. */
import type { SceneDocument } from "../api/types";

/** The lists of things that stand in the room. */
export type ThingList = "objects" | "props" | "keep_outs" | "zones";

/** The chosen thing, by its place in the document. */
export type Selection =
  | { readonly kind: "scene" }
  | { readonly kind: "thing"; readonly list: ThingList; readonly index: number }
  | { readonly kind: "state"; readonly index: number }
  | { readonly kind: "anywhere" }
  | { readonly kind: "variables" };

/** The scene as a whole. */
export const SCENE: Selection = { kind: "scene" };

/** The lists, in the order in which they are shown. */
export const THING_LISTS: readonly ThingList[] = ["objects", "props", "keep_outs", "zones"];

/** Whether both are the same. */
export function isSame(one: Selection, other: Selection): boolean {
  if (one.kind === "thing" && other.kind === "thing") return one.list === other.list && one.index === other.index;
  if (one.kind === "state" && other.kind === "state") return one.index === other.index;
  return one.kind === other.kind;
}

/** The JSON path of what is chosen: findings at it or below it are about it. */
export function pathOf(selection: Selection): string {
  switch (selection.kind) {
    case "scene":
      return "$";
    case "thing":
      return `$.${selection.list}[${selection.index}]`;
    case "state":
      return `$.scenario.states[${selection.index}]`;
    case "anywhere":
      return "$.scenario.anywhere";
    case "variables":
      return "$.scenario.variables";
  }
}

/** What a path is about; the scene where it names nothing that can be chosen. */
export function selectionAt(path: string): Selection {
  const thing = /^\$\.(objects|props|keep_outs|zones)\[(\d+)\]/.exec(path);
  if (thing !== null) return { kind: "thing", list: thing[1] as ThingList, index: Number(thing[2]) };
  const state = /^\$\.scenario\.states\[(\d+)\]/.exec(path);
  if (state !== null) return { kind: "state", index: Number(state[1]) };
  if (path.startsWith("$.scenario.anywhere")) return { kind: "anywhere" };
  if (path.startsWith("$.scenario.variables")) return { kind: "variables" };
  return SCENE;
}

/** The same, or the scene where the document does not have it (any more). */
export function within(scene: SceneDocument, selection: Selection): Selection {
  switch (selection.kind) {
    case "thing":
      return selection.index < (scene[selection.list] ?? []).length ? selection : SCENE;
    case "state":
      return selection.index < (scene.scenario?.states.length ?? 0) ? selection : SCENE;
    case "anywhere":
    case "variables":
      return (scene.scenario ?? null) === null ? SCENE : selection;
    case "scene":
      return selection;
  }
}

/** Whether a finding at `path` is about what stands at `at`, or below it. */
export function isAt(path: string, at: string): boolean {
  return path === at || path.startsWith(`${at}.`) || path.startsWith(`${at}[`);
}
