/** What a scenario says of objects, zones, states and variables: renamed with them, and gone with them. */
import type { Condition, ScenarioDocument, StateDocument, TransitionDocument, Trigger } from "../api/types";

/** What can be spoken of by id. */
export type Named = "object" | "zone" | "state" | "variable";

/** The scenario after something was renamed. */
export function renameInScenario(scenario: ScenarioDocument, what: Named, before: string, after: string): ScenarioDocument {
  const is = (name: string): string => (name === before ? after : name);
  const condition = (part: Condition): Condition => {
    switch (part.kind) {
      case "touching":
      case "looks_at":
      case "in_place":
        return what === "object" ? { ...part, object: is(part.object) } : part;
      case "in_zone":
        return what === "zone" ? { ...part, zone: is(part.zone) } : part;
      case "variable":
        return what === "variable" ? { ...part, variable: is(part.variable) } : part;
      case "all":
      case "any":
        return { ...part, conditions: part.conditions.map(condition) };
      case "not":
        return { ...part, condition: condition(part.condition) };
      case "time_in_state":
        return part;
    }
  };
  const trigger = (on: Trigger): Trigger => {
    if (what === "object" && "object" in on) return { ...on, object: is(on.object) };
    if (what === "zone" && (on.kind === "zone_entered" || on.kind === "zone_left")) return { ...on, zone: is(on.zone) };
    return on;
  };
  const acts = <T extends { readonly variable: string }>(some: readonly T[]): T[] => some.map((act) => (what === "variable" ? { ...act, variable: is(act.variable) } : act));
  const way = (one: TransitionDocument): TransitionDocument => ({
    ...one,
    ...(one.on === undefined ? {} : { on: one.on.map(trigger) }),
    ...(one.when === null || one.when === undefined ? {} : { when: condition(one.when) }),
    ...(one.to === null || one.to === undefined ? {} : { to: what === "state" ? is(one.to) : one.to }),
    ...(one.acts === undefined ? {} : { acts: acts(one.acts) }),
  });
  const keys = <T>(byObject: Readonly<Record<string, T>>): Record<string, T> =>
    Object.fromEntries(Object.entries(byObject).map(([name, value]) => [what === "object" ? is(name) : name, value]));
  const state = (one: StateDocument): StateDocument => ({
    ...one,
    ...(what === "state" ? { id: is(one.id) } : {}),
    ...(one.enabled === undefined ? {} : { enabled: what === "object" ? one.enabled.map(is) : one.enabled }),
    ...(one.priors === undefined ? {} : { priors: keys(one.priors) }),
    ...(one.interactions === undefined ? {} : { interactions: keys(one.interactions) }),
    ...(one.entry === undefined ? {} : { entry: acts(one.entry) }),
    ...(one.transitions === undefined ? {} : { transitions: one.transitions.map(way) }),
  });
  return {
    ...scenario,
    ...(what === "state" ? { initial: is(scenario.initial) } : {}),
    ...(scenario.variables === undefined ? {} : { variables: scenario.variables.map((variable) => (what === "variable" ? { ...variable, id: is(variable.id) } : variable)) }),
    states: scenario.states.map(state),
    ...(scenario.anywhere === undefined ? {} : { anywhere: scenario.anywhere.map(way) }),
  };
}

/**
 * The scenario without an object: states enable and weigh it no more. What waits for it stays, and the check finds it: what is to
 * lead on instead is the designer's to say.
 */
export function forgetObject(scenario: ScenarioDocument, id: string): ScenarioDocument {
  const less = <T>(byObject: Readonly<Record<string, T>>): Record<string, T> => Object.fromEntries(Object.entries(byObject).filter(([name]) => name !== id));
  const states = scenario.states.map((state) => ({
    ...state,
    ...(state.enabled === undefined ? {} : { enabled: state.enabled.filter((known) => known !== id) }),
    ...(state.priors === undefined ? {} : { priors: less(state.priors) }),
    ...(state.interactions === undefined ? {} : { interactions: less(state.interactions) }),
  }));
  return { ...scenario, states };
}
