/** Changes of a scene, each a new document: what an editor does, without a page. References follow what they name. */
import type { KeepOutDocument, ObjectDocument, PropDocument, SceneDocument } from "../api/types";
import type { Point } from "../lib/plan";
import { forgetObject, renameInScenario } from "./references";
import type { ThingList } from "./selection";

/** Anything that stands in a list of things. */
export type Thing = ObjectDocument | PropDocument | KeepOutDocument;

/** Fields of a thing that change; which ones it has is its list's. */
export type ThingChange = Partial<Omit<ObjectDocument, "shape">> & Partial<Omit<PropDocument, "id">> & { readonly shape?: ObjectDocument["shape"] | KeepOutDocument["shape"] };

/** A room with nothing in it. A scene needs an object: the check says so. */
export function emptyScene(name: string, travel: readonly [number, number, number, number] | null): SceneDocument {
  const [minX, minY, maxX, maxY] = travel ?? [0, 0, 4, 4];
  return { schema: "covr.scene.v2", name, arena: { min: [minX, minY], max: [maxX, maxY] }, column: { size: [0.15, 0.15] }, objects: [] };
}

/** The things of a list. */
export function thingsOf(scene: SceneDocument, list: ThingList): readonly Thing[] {
  return scene[list] ?? [];
}

/** A new thing of a list, at a place of the room; its index is the last. */
export function withNew(scene: SceneDocument, list: ThingList, at: Point): SceneDocument {
  const [x, y] = [rounded(at[0]), rounded(at[1])];
  const id = freeId(thingsOf(scene, list).map((thing) => thing.id), ID_OF[list]);
  switch (list) {
    case "objects":
      return { ...scene, objects: [...scene.objects, { id, position: [x, y, 1], yaw: 0, shape: { kind: "sphere", radius: 0.1 }, prior: 1, enabled: true }] };
    case "props":
      return { ...scene, props: [...(scene.props ?? []), { id, offset: [0, 0], facing: 0, size: [0, 0] }] };
    case "keep_outs":
      return { ...scene, keep_outs: [...(scene.keep_outs ?? []), { id, shape: { kind: "circle", centre: [x, y], radius: 0.3 } }] };
    case "zones":
      return { ...scene, zones: [...(scene.zones ?? []), { id, shape: { kind: "circle", centre: [x, y], radius: 0.4 } }] };
  }
}

/** A thing with some fields changed. */
export function withThing(scene: SceneDocument, list: ThingList, index: number, change: ThingChange): SceneDocument {
  const things = thingsOf(scene, list).map((thing, at) => (at === index ? cleaned({ ...thing, ...change }) : thing));
  return { ...scene, [list]: things };
}

/** A thing under another id; what speaks of it follows. */
export function withId(scene: SceneDocument, list: ThingList, index: number, id: string): SceneDocument {
  const before = thingsOf(scene, list)[index]?.id;
  if (before === undefined || before === id) return scene;
  const renamed = withThing(scene, list, index, { id });
  // Two things of one id are an error until one is renamed: which of them is meant is nobody's to guess.
  if (thingsOf(scene, list).some((thing, at) => at !== index && (thing.id === before || thing.id === id))) return renamed;
  if (list === "props") return { ...renamed, objects: renamed.objects.map((object) => (object.prop === before ? { ...object, prop: id } : object)) };
  if (list === "keep_outs") return renamed;
  return withScenario(renamed, (scenario) => renameInScenario(scenario, list === "objects" ? "object" : "zone", before, id));
}

/** Without a thing, and without what spoke of it. */
export function without(scene: SceneDocument, list: ThingList, index: number): SceneDocument {
  const gone = thingsOf(scene, list)[index];
  if (gone === undefined) return scene;
  const left = thingsOf(scene, list).filter((_, at) => at !== index);
  const { [list]: _, ...others } = scene;
  const less = (left.length === 0 && list !== "objects" ? others : { ...scene, [list]: left }) as SceneDocument;
  if (list === "props") return { ...less, objects: less.objects.map(({ prop, ...object }) => (prop === gone.id || prop === null || prop === undefined ? object : { ...object, prop })) };
  // What waits for a thing that is gone stays: the check names it, and the designer says what leads on instead.
  return list === "objects" ? withScenario(less, (scenario) => forgetObject(scenario, gone.id)) : less;
}

/** Where a thing stands on the floor; null for a prop, which hangs on the column. */
export function placeOf(scene: SceneDocument, list: ThingList, index: number): Point | null {
  const thing = thingsOf(scene, list)[index];
  if (thing === undefined || list === "props") return null;
  if ("position" in thing) return [thing.position[0], thing.position[1]];
  const { shape } = thing as KeepOutDocument;
  return shape.kind === "circle" ? shape.centre : middleOf(shape.corners);
}

/** A thing moved by some metres; a prop on its column. */
export function moved(scene: SceneDocument, list: ThingList, index: number, [dx, dy]: Point): SceneDocument {
  const thing = thingsOf(scene, list)[index];
  if (thing === undefined) return scene;
  const by = ([x, y]: readonly [number, number]): [number, number] => [rounded(x + dx), rounded(y + dy)];
  if ("offset" in thing) return withThing(scene, list, index, { offset: by(thing.offset) });
  if ("position" in thing) return withThing(scene, list, index, { position: [...by([thing.position[0], thing.position[1]]), thing.position[2]] });
  const { shape } = thing;
  const shifted = shape.kind === "circle" ? { ...shape, centre: by(shape.centre) } : { ...shape, corners: shape.corners.map(by) };
  return withThing(scene, list, index, { shape: shifted });
}

/** A corner of a polygon at another place. */
export function withCorner(scene: SceneDocument, list: "keep_outs" | "zones", index: number, corner: number, to: Point): SceneDocument {
  const shape = scene[list]?.[index]?.shape;
  if (shape?.kind !== "polygon") return scene;
  const corners = shape.corners.map((from, at) => (at === corner ? ([rounded(to[0]), rounded(to[1])] as [number, number]) : from));
  return withThing(scene, list, index, { shape: { ...shape, corners } });
}

/** The scenario changed, where there is one. */
export function withScenario(scene: SceneDocument, change: (scenario: NonNullable<SceneDocument["scenario"]>) => NonNullable<SceneDocument["scenario"]>): SceneDocument {
  const { scenario } = scene;
  return scenario === null || scenario === undefined ? scene : { ...scene, scenario: change(scenario) };
}

/** An id that nobody has yet: `object`, `object_2`, ... */
export function freeId(taken: readonly string[], wanted: string): string {
  if (!taken.includes(wanted)) return wanted;
  for (let number = 2; ; number += 1) if (!taken.includes(`${wanted}_${number}`)) return `${wanted}_${number}`;
}

/** To the millimetre: what is dragged or typed is no finer. */
export function rounded(value: number): number {
  const whole = Math.round(value * 1000) / 1000;
  return Object.is(whole, -0) ? 0 : whole;
}

/** Without fields that say nothing: an empty label, no prop. */
export function cleaned<T extends object>(thing: T): T {
  return Object.fromEntries(Object.entries(thing).filter(([name, value]) => value !== undefined && value !== null && !(value === "" && (name === "label" || name === "note")))) as T;
}

function middleOf(corners: readonly (readonly [number, number])[]): Point {
  const count = Math.max(1, corners.length);
  return [corners.reduce((sum, [x]) => sum + x, 0) / count, corners.reduce((sum, [, y]) => sum + y, 0) / count];
}

const ID_OF: Readonly<Record<ThingList, string>> = { objects: "object", props: "prop", keep_outs: "keep_out", zones: "zone" };
