/** What the transitions of a scenario wait for, in the page's language. */
import type { Condition, SceneDocument, TransitionDocument, Trigger, VariableValue } from "../api/types";
import { words } from "../i18n";
import { decimal } from "./format";
import { labelOf } from "./labels";

/** What a transition waits for. */
export function waitsFor(way: TransitionDocument, scene: SceneDocument): string {
  const say = words().scenario.conditions;
  const on = (way.on ?? []).map((trigger) => triggerWords(trigger, scene)).join(say.or);
  const when = way.when === null || way.when === undefined ? "" : conditionWords(way.when, scene);
  if (on === "") return when === "" ? say.always : when;
  return when === "" ? on : say.onIf(on, when);
}

/** What a state is called. */
export function stateLabel(scene: SceneDocument | null, id: string): string {
  const label = scene?.scenario?.states.find((state) => state.id === id)?.label;
  return label === undefined || label === "" ? id : label;
}

/** Every cue of a scenario, in its order. */
export function cuesOf(scene: SceneDocument): readonly string[] {
  const scenario = scene.scenario;
  if (scenario === null || scenario === undefined) return [];
  const ways = [...scenario.states.flatMap((state) => state.transitions ?? []), ...(scenario.anywhere ?? [])];
  return [...new Set(ways.flatMap((way) => (way.on ?? []).flatMap((on) => (on.kind === "cue" ? [on.name] : []))))];
}

/** A variable's value. */
export function valueWords(value: VariableValue): string {
  const say = words().scenario;
  return typeof value === "boolean" ? (value ? say.yes : say.no) : String(value);
}

function triggerWords(trigger: Trigger, scene: SceneDocument): string {
  const say = words().scenario.conditions;
  switch (trigger.kind) {
    case "touch_began":
    case "touch_ended":
    case "interaction_done":
      return say[trigger.kind](labelOf(scene, trigger.object));
    case "zone_entered":
    case "zone_left":
      return say[trigger.kind](zoneLabel(scene, trigger.zone));
    case "client_event":
    case "cue":
      return say[trigger.kind](trigger.name);
  }
}

function conditionWords(condition: Condition, scene: SceneDocument): string {
  const say = words().scenario.conditions;
  const inner = (part: Condition): string => {
    const text = conditionWords(part, scene);
    return part.kind === "all" || part.kind === "any" ? say.group(text) : text;
  };
  switch (condition.kind) {
    case "touching":
      return condition.secs > 0
        ? say.touchingFor(labelOf(scene, condition.object), seconds(condition.secs))
        : say.touching(labelOf(scene, condition.object));
    case "looks_at":
      return condition.secs > 0
        ? say.looksFor(labelOf(scene, condition.object), seconds(condition.secs))
        : say.looks_at(labelOf(scene, condition.object));
    case "in_zone":
      return say.in_zone(zoneLabel(scene, condition.zone));
    case "in_place":
      return say.in_place(labelOf(scene, condition.object));
    case "time_in_state":
      return say.time_in_state(seconds(condition.secs));
    case "variable":
      return say.variable(condition.variable, condition.is === "==" ? "=" : condition.is, valueWords(condition.value));
    case "all":
      return condition.conditions.map(inner).join(say.and);
    case "any":
      return condition.conditions.map(inner).join(say.or);
    case "not":
      return say.not(conditionWords(condition.condition, scene));
  }
}

function seconds(secs: number): string {
  return `${decimal(secs, Number.isInteger(secs) ? 0 : 1)} s`;
}

function zoneLabel(scene: SceneDocument, id: string): string {
  const label = scene.zones?.find((zone) => zone.id === id)?.label;
  return label === undefined || label === "" ? id : label;
}
