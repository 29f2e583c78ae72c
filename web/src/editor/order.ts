/** A scene with its fields in the order in which the server writes them, so that a comparison shows changes and nothing else. */
import type { SceneDocument } from "../api/types";

/** The same document. */
export function inOrder(scene: SceneDocument): SceneDocument {
  return ordered(scene) as SceneDocument;
}

function ordered(value: unknown, isMap = false): unknown {
  if (Array.isArray(value)) return value.map((item: unknown) => ordered(item));
  if (typeof value !== "object" || value === null) return value;
  const fields = Object.entries(value);
  // What is named by its designer stands by the name, as the server sorts it.
  fields.sort(([one], [other]) => (isMap ? (one < other ? -1 : 1) : rank(one) - rank(other)));
  return Object.fromEntries(fields.map(([name, field]) => [name, ordered(field, !isMap && (name === "priors" || name === "interactions"))]));
}

function rank(name: string): number {
  const at = ORDER.indexOf(name);
  return at < 0 ? ORDER.length : at;
}

/** One order that suits every part of a scene. */
const ORDER: readonly string[] = [
  ..."schema name description arena column props objects keep_outs zones scenario checklist".split(" "),
  ..."initial variables states anywhere".split(" "),
  ..."kind id start label note position offset facing yaw shape".split(" "),
  ..."centre radius height size corners points vertices triangles min max".split(" "),
  ..."prop prior enabled priors interactions entry transitions final".split(" "),
  ..."value per_s per_touch least most".split(" "),
  ..."distance path speed".split(" "),
  ..."on when to acts object zone secs variable is amount conditions condition".split(" "),
];
