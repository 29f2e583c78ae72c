/** What the column does at an object in a state: its kinds with their usual values, and the places of a path. */
import type { SceneDocument, StateDocument } from "../api/types";
import type { Point } from "../lib/plan";
import { rounded } from "./scene";
import { withState } from "./scenario";
import type { Selection } from "./selection";

/** One interaction. */
export type Interaction = NonNullable<StateDocument["interactions"]>[string];

/** One that leads along a path. */
export type Course = Extract<Interaction, { readonly kind: "lead" | "transport" }>;

/** A path in the scenario. */
export interface Path {
  readonly state: number;
  readonly object: string;
  readonly places: readonly Point[];
}

/** As the schema has them; which values hold, the check says. */
export const INTERACTIONS = ["hold", "step_back", "lead", "transport", "brush", "park"] as const satisfies readonly Interaction["kind"][];

/** An interaction of a kind at an object, with usual values; a path stays a path. */
export function newInteraction(kind: Interaction["kind"], scene: SceneDocument, object: string, before: Interaction | undefined): Interaction {
  const [x, y] = scene.objects.find(({ id }) => id === object)?.position ?? [0, 0];
  const course = before !== undefined && "path" in before ? { path: before.path, speed: before.speed } : { path: [[rounded(x + 0.5), y] as [number, number]], speed: 0.4 };
  switch (kind) {
    case "hold":
    case "park":
      return { kind };
    case "step_back":
      return { kind, distance: 0.5 };
    case "lead":
    case "transport":
      return { kind, ...course };
    case "brush":
      return { kind, speed: 0.25, secs: 1 };
  }
}

/** A state with an interaction at an object, or without one. */
export function withInteraction(scene: SceneDocument, state: number, object: string, interaction: Interaction | null): SceneDocument {
  const before = scene.scenario?.states[state]?.interactions ?? {};
  const others = Object.entries(before).filter(([id]) => id !== object);
  return withState(scene, state, { interactions: Object.fromEntries(interaction === null ? others : [...others, [object, interaction]]) });
}

/** A path, changed; the last place stays: a path has one at least. */
export function withPath(scene: SceneDocument, { state, object }: Pick<Path, "state" | "object">, change: (places: readonly Point[]) => readonly Point[]): SceneDocument {
  const course = scene.scenario?.states[state]?.interactions?.[object];
  if (course === undefined || !("path" in course)) return scene;
  const path = change(course.path).map(([x, y]): [number, number] => [rounded(x), rounded(y)]);
  return path.length === 0 ? scene : withInteraction(scene, state, object, { ...course, path });
}

/** One more place at the end, half a metre on. */
export function onward(scene: SceneDocument, object: string, places: readonly Point[]): readonly Point[] {
  const start = scene.objects.find(({ id }) => id === object)?.position ?? [0, 0, 0];
  const all: readonly Point[] = [[start[0], start[1]], ...places];
  const [last, before] = [all.at(-1) ?? [0, 0], all.at(-2) ?? all.at(-1) ?? [0, 0]];
  const [dx, dy] = [last[0] - before[0], last[1] - before[1]];
  const length = Math.hypot(dx, dy);
  return [...places, length < 1e-6 ? [last[0] + ONWARD_M, last[1]] : [last[0] + (dx / length) * ONWARD_M, last[1] + (dy / length) * ONWARD_M]];
}

/** The paths that what is chosen is about: those of a state, or those at an object. */
export function pathsOf(scene: SceneDocument, selection: Selection): readonly Path[] {
  const object = selection.kind === "thing" && selection.list === "objects" ? scene.objects[selection.index]?.id : undefined;
  return (scene.scenario?.states ?? []).flatMap((known, state) =>
    Object.entries(known.interactions ?? {}).flatMap(([id, interaction]) => {
      const isChosen = (selection.kind === "state" && selection.index === state) || id === object;
      return isChosen && "path" in interaction ? [{ state, object: id, places: interaction.path }] : [];
    }),
  );
}

const ONWARD_M = 0.5;
