/** Changes of a scenario, each a new document: states, what leads on, what is remembered. */
import type { Condition, SceneDocument, ScenarioDocument, StateDocument, TransitionDocument, Trigger, VariableValue } from "../api/types";
import { renameInScenario } from "./references";
import { cleaned, freeId, withScenario } from "./scene";

/** A new state; the first of a scene makes its scenario. Its index is the last. */
export function withNewState(scene: SceneDocument): SceneDocument {
  const { scenario } = scene;
  if (scenario === null || scenario === undefined) {
    return { ...scene, scenario: { initial: "state", states: [{ id: "state", enabled: scene.objects.filter(({ enabled }) => enabled).map(({ id }) => id) }] } };
  }
  const id = freeId(scenario.states.map((state) => state.id), "state");
  return { ...scene, scenario: { ...scenario, states: [...scenario.states, { id }] } };
}

/** A state with some fields changed; what is empty is left out. */
export function withState(scene: SceneDocument, index: number, change: Partial<StateDocument>): SceneDocument {
  return withScenario(scene, (scenario) => ({ ...scenario, states: scenario.states.map((state, at) => (at === index ? slim({ ...state, ...change }) : state)) }));
}

/** A state under another id; what leads to it follows. */
export function withStateId(scene: SceneDocument, index: number, id: string): SceneDocument {
  const { scenario } = scene;
  const before = scenario?.states[index]?.id;
  if (scenario === null || scenario === undefined || before === undefined || before === id) return scene;
  const isAmbiguous = scenario.states.some((state, at) => at !== index && (state.id === before || state.id === id));
  return isAmbiguous ? withState(scene, index, { id }) : { ...scene, scenario: renameInScenario(scenario, "state", before, id) };
}

/** Without a state; what led to it stays and is found by the check. The last one takes the scenario with it. */
export function withoutState(scene: SceneDocument, index: number): SceneDocument {
  const { scenario } = scene;
  if (scenario === null || scenario === undefined) return scene;
  const states = scenario.states.filter((_, at) => at !== index);
  const [first] = states;
  if (first === undefined) {
    const { scenario: _, ...others } = scene;
    return others;
  }
  const gone = scenario.states[index]?.id;
  return { ...scene, scenario: { ...scenario, states, initial: scenario.initial === gone ? first.id : scenario.initial } };
}

/** Whether an object can be served in a state; its prior and interaction go with it. */
export function withEnabled(scene: SceneDocument, index: number, object: string, isEnabled: boolean): SceneDocument {
  const state = scene.scenario?.states[index];
  if (state === undefined) return scene;
  const others = (state.enabled ?? []).filter((id) => id !== object);
  const less = <T>(byObject: Readonly<Record<string, T>> | undefined): Record<string, T> => Object.fromEntries(Object.entries(byObject ?? {}).filter(([id]) => isEnabled || id !== object));
  return withState(scene, index, { enabled: isEnabled ? [...others, object] : others, priors: less(state.priors), interactions: less(state.interactions) });
}

/** Where a way begins: in a state, or anywhere. */
export type From = number | "anywhere";

/** The ways from there. */
export function waysFrom(scenario: ScenarioDocument | null | undefined, from: From): readonly TransitionDocument[] {
  if (scenario === null || scenario === undefined) return [];
  return (from === "anywhere" ? scenario.anywhere : scenario.states[from]?.transitions) ?? [];
}

/** The ways from there, changed. */
export function withWays(scene: SceneDocument, from: From, change: (ways: readonly TransitionDocument[]) => readonly TransitionDocument[]): SceneDocument {
  const next = [...change(waysFrom(scene.scenario, from))].map(slimWay);
  if (from !== "anywhere") return withState(scene, from, { transitions: next });
  return withScenario(scene, ({ anywhere: _, ...scenario }) => (next.length === 0 ? scenario : { ...scenario, anywhere: next }));
}

/** Variables, changed. */
export function withVariables(scene: SceneDocument, change: (variables: NonNullable<ScenarioDocument["variables"]>) => NonNullable<ScenarioDocument["variables"]>): SceneDocument {
  return withScenario(scene, ({ variables, ...scenario }) => {
    const next = change(variables ?? []);
    return next.length === 0 ? scenario : { ...scenario, variables: next };
  });
}

/** A variable under another id; what reads and sets it follows. */
export function withVariableId(scene: SceneDocument, before: string, id: string): SceneDocument {
  return withScenario(scene, (scenario) => ((scenario.variables ?? []).some((variable) => variable.id === id) ? scenario : renameInScenario(scenario, "variable", before, id)));
}

/** A condition of a kind, about the first thing that it could be about. */
export function newCondition(kind: Condition["kind"], scene: SceneDocument, inside: Condition | null): Condition {
  const object = scene.objects[0]?.id ?? "";
  switch (kind) {
    case "touching":
    case "looks_at":
      return { kind, object, secs: 0 };
    case "in_place":
      return { kind, object };
    case "in_zone":
      return { kind, zone: scene.zones?.[0]?.id ?? "" };
    case "time_in_state":
      return { kind, secs: 5 };
    case "variable": {
      const variable = scene.scenario?.variables?.[0];
      return { kind, variable: variable?.id ?? "", is: "==", value: variable?.start ?? true };
    }
    case "all":
    case "any":
      return { kind, conditions: inside === null ? [{ kind: "touching", object, secs: 0 }] : inside.kind === "all" || inside.kind === "any" ? inside.conditions : [inside] };
    case "not":
      return { kind, condition: inside ?? { kind: "touching", object, secs: 0 } };
  }
}

/** A trigger of a kind, about the first thing that it could be about. */
export function newTrigger(kind: Trigger["kind"], scene: SceneDocument): Trigger {
  switch (kind) {
    case "touch_began":
    case "touch_ended":
    case "interaction_done":
      return { kind, object: scene.objects[0]?.id ?? "" };
    case "zone_entered":
    case "zone_left":
      return { kind, zone: scene.zones?.[0]?.id ?? "" };
    case "client_event":
    case "cue":
      return { kind, name: "" };
  }
}

/** A value of the same kind. */
export function likeValue(start: VariableValue, text: string): VariableValue {
  if (typeof start === "boolean") return text === "true";
  const number = Math.round(Number(text));
  return Number.isFinite(number) ? number : start;
}

function slim(state: StateDocument): StateDocument {
  const isEmpty = (value: unknown): boolean => (Array.isArray(value) && value.length === 0) || (typeof value === "object" && value !== null && Object.keys(value).length === 0) || value === false;
  return Object.fromEntries(Object.entries(cleaned(state)).filter(([name, value]) => name === "id" || !isEmpty(value))) as StateDocument;
}

function slimWay(way: TransitionDocument): TransitionDocument {
  return Object.fromEntries(Object.entries(cleaned(way)).filter(([, value]) => !(Array.isArray(value) && value.length === 0)));
}
