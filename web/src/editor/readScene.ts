/**
 * A JSON document as the editor can hold it: built as a scene is, whatever its values are. What is not is told with its path, and
 * is for the text editor; the server's check says all the rest.
 */
import type { Condition, SceneDocument, ScenarioDocument, StateDocument, TransitionDocument } from "../api/types";

type Interaction = NonNullable<StateDocument["interactions"]>[string];
type Prior = NonNullable<StateDocument["priors"]>[string];

/** A scene to edit, or where it is not built as one. */
export type Read = { readonly kind: "scene"; readonly scene: SceneDocument } | { readonly kind: "broken"; readonly path: string } | { readonly kind: "no_json" };

/** Reads a text. */
export function readScene(text: string): Read {
  let found: unknown;
  try {
    found = JSON.parse(text);
  } catch {
    return { kind: "no_json" };
  }
  const path = SCENE_SHAPE(found, "$");
  if (path !== null) return { kind: "broken", path };
  return { kind: "scene", scene: filled(found as Partial<SceneDocument> & Pick<SceneDocument, "schema" | "name" | "arena" | "objects">) };
}

/** With what may be left out, as the server fills it in. */
function filled(scene: Partial<SceneDocument> & Pick<SceneDocument, "schema" | "name" | "arena" | "objects">): SceneDocument {
  return {
    ...scene,
    schema: scene.schema === "covr.scene.v1" ? "covr.scene.v2" : scene.schema,
    column: scene.column ?? { size: [0.15, 0.15] },
    ...(scene.props === undefined ? {} : { props: scene.props.map((prop) => ({ ...{ facing: 0, size: [0, 0] as [number, number] }, ...prop })) }),
    objects: scene.objects.map((object) => ({ ...{ yaw: 0, prior: 1, enabled: true }, ...object })),
    ...(scene.scenario === null || scene.scenario === undefined ? {} : { scenario: filledScenario(scene.scenario) }),
  };
}

function filledScenario(scenario: ScenarioDocument): ScenarioDocument {
  const way = (one: TransitionDocument): TransitionDocument => (one.when === null || one.when === undefined ? one : { ...one, when: filledCondition(one.when) });
  const prior = (one: Prior): Prior => (typeof one === "number" ? one : { ...{ per_s: 0, per_touch: 0, least: 0, most: 1 }, ...one });
  return {
    ...scenario,
    states: scenario.states.map((state) => ({
      ...state,
      ...(state.priors === undefined ? {} : { priors: Object.fromEntries(Object.entries(state.priors).map(([id, one]) => [id, prior(one)])) }),
      ...(state.interactions === undefined ? {} : { interactions: Object.fromEntries(Object.entries(state.interactions).map(([id, one]) => [id, filledInteraction(one)])) }),
      ...(state.transitions === undefined ? {} : { transitions: state.transitions.map(way) }),
    })),
    ...(scenario.anywhere === undefined ? {} : { anywhere: scenario.anywhere.map(way) }),
  };
}

/** Speeds and times as the server has them where none is given. */
function filledInteraction(one: Interaction): Interaction {
  switch (one.kind) {
    case "lead":
    case "transport":
      return { ...one, speed: (one as { readonly speed?: number }).speed ?? 0.4 };
    case "brush":
      return { ...one, speed: (one as { readonly speed?: number }).speed ?? 0.25, secs: (one as { readonly secs?: number }).secs ?? 1 };
    default:
      return one;
  }
}

function filledCondition(part: Condition): Condition {
  switch (part.kind) {
    case "touching":
    case "looks_at":
      return { ...part, secs: (part as { readonly secs?: number }).secs ?? 0 };
    case "all":
    case "any":
      return { ...part, conditions: part.conditions.map(filledCondition) };
    case "not":
      return { ...part, condition: filledCondition(part.condition) };
    default:
      return part;
  }
}

/** Null where a value is built so, else the path of what is not. */
type Shape = (value: unknown, path: string) => string | null;

function plain(type: "string" | "number" | "boolean"): Shape {
  return (value, path) => (typeof value === type && !(typeof value === "number" && !Number.isFinite(value)) ? null : path);
}

function listOf(item: Shape, count?: number): Shape {
  return (value, path) => {
    if (!Array.isArray(value) || (count !== undefined && value.length !== count)) return path;
    return first(value.map((one: unknown, index) => item(one, `${path}[${index}]`)));
  };
}

function fields(due: Readonly<Record<string, Shape>>, more: Readonly<Record<string, Shape>> = {}): Shape {
  return (value, path) => {
    if (typeof value !== "object" || value === null || Array.isArray(value)) return path;
    const has = new Map<string, unknown>(Object.entries(value));
    return first([
      ...Object.entries(due).map(([name, shape]) => shape(has.get(name), `${path}.${name}`)),
      ...Object.entries(more).map(([name, shape]) => (has.has(name) ? shape(has.get(name), `${path}.${name}`) : null)),
      // What nobody knows would be lost without a word.
      ...[...has.keys()].map((name) => (name in due || name in more ? null : `${path}.${name}`)),
    ]);
  };
}

function byKind(kinds: Readonly<Record<string, Readonly<Record<string, Shape>>>>): Shape {
  return (value, path) => {
    const kind: unknown = typeof value === "object" && value !== null && "kind" in value ? value.kind : null;
    const of = typeof kind === "string" && Object.hasOwn(kinds, kind) ? kinds[kind] : undefined;
    return of === undefined ? `${path}.kind` : fields({ kind: TEXT, ...of })(value, path);
  };
}

function mapOf(item: Shape): Shape {
  return (value, path) =>
    typeof value !== "object" || value === null || Array.isArray(value) ? path : first(Object.entries(value).map(([name, one]) => item(one, `${path}.${name}`)));
}

function either(one: Shape, other: Shape): Shape {
  return (value, path) => (one(value, path) === null ? null : other(value, path));
}

function orNull(shape: Shape): Shape {
  return (value, path) => (value === null ? null : shape(value, path));
}

function later(shape: () => Shape): Shape {
  return (value, path) => shape()(value, path);
}

function optional(shape: Shape): Shape {
  return (value, path) => (value === undefined ? null : shape(value, path));
}

function first(paths: readonly (string | null)[]): string | null {
  return paths.find((path) => path !== null) ?? null;
}

const TEXT = plain("string");
const NUMBER = plain("number");
const YES_NO = plain("boolean");
const PAIR = listOf(NUMBER, 2);
const TRIPLE = listOf(NUMBER, 3);
const VALUE = either(NUMBER, YES_NO);
const FLOOR_SHAPE = byKind({ circle: { centre: PAIR, radius: NUMBER }, polygon: { corners: listOf(PAIR) } });
const PLACED = fields({ id: TEXT, shape: FLOOR_SHAPE }, { label: TEXT });
const OBJECT_SHAPE = byKind({
  sphere: { radius: NUMBER },
  box: { size: TRIPLE },
  cylinder: { radius: NUMBER, height: NUMBER },
  convex_mesh: { points: listOf(TRIPLE) },
  triangle_mesh: { vertices: listOf(TRIPLE), triangles: listOf(TRIPLE) },
});
const CONDITION: Shape = byKind({
  touching: { object: TEXT, secs: optional(NUMBER) },
  in_zone: { zone: TEXT },
  looks_at: { object: TEXT, secs: optional(NUMBER) },
  in_place: { object: TEXT },
  time_in_state: { secs: NUMBER },
  variable: { variable: TEXT, is: TEXT, value: VALUE },
  all: { conditions: listOf(later(() => CONDITION)) },
  any: { conditions: listOf(later(() => CONDITION)) },
  not: { condition: later(() => CONDITION) },
});
const TRIGGER = byKind({ touch_began: { object: TEXT }, touch_ended: { object: TEXT }, interaction_done: { object: TEXT }, zone_entered: { zone: TEXT }, zone_left: { zone: TEXT }, client_event: { name: TEXT }, cue: { name: TEXT } });
const ACTS = listOf(byKind({ set: { variable: TEXT, value: VALUE }, add: { variable: TEXT, amount: NUMBER } }));
const WAY = fields({}, { label: TEXT, on: listOf(TRIGGER), when: orNull(CONDITION), to: orNull(TEXT), acts: ACTS });
const PRIOR = either(NUMBER, fields({ value: NUMBER }, { per_s: NUMBER, per_touch: NUMBER, least: NUMBER, most: NUMBER }));
const COURSE = { path: listOf(PAIR), speed: optional(NUMBER) };
const INTERACTION = byKind({ hold: {}, step_back: { distance: NUMBER }, lead: COURSE, transport: COURSE, brush: { speed: optional(NUMBER), secs: optional(NUMBER) }, park: {} });
const STATE = fields(
  { id: TEXT },
  { label: TEXT, note: TEXT, enabled: listOf(TEXT), priors: mapOf(PRIOR), interactions: mapOf(INTERACTION), entry: ACTS, transitions: listOf(WAY), final: YES_NO },
);
const SCENE_SHAPE = fields(
  { schema: TEXT, name: TEXT, arena: fields({ min: PAIR, max: PAIR }), objects: listOf(fields({ id: TEXT, position: TRIPLE, shape: OBJECT_SHAPE }, { label: TEXT, yaw: NUMBER, prop: orNull(TEXT), prior: NUMBER, enabled: YES_NO })) },
  {
    description: TEXT,
    checklist: listOf(TEXT),
    column: fields({ size: PAIR }),
    props: listOf(fields({ id: TEXT, offset: PAIR }, { label: TEXT, facing: NUMBER, size: PAIR })),
    keep_outs: listOf(PLACED),
    zones: listOf(PLACED),
    scenario: orNull(fields({ initial: TEXT, states: listOf(STATE) }, { variables: listOf(fields({ id: TEXT, start: VALUE })), anywhere: listOf(WAY) })),
  },
);
