/** A condition, with the conditions that it is made of. */
import { For, Match, Show, Switch, type JSX } from "solid-js";
import type { Condition, SceneDocument } from "../../api/types";
import { nameOf } from "../../ui/drawing/picture";
import type { Editor } from "../editor";
import { likeValue, newCondition } from "../scenario";
import { say } from "../words";
import { ChoiceField, FindingText, NumberField } from "./fields";

type Of<Kind extends Condition["kind"]> = Extract<Condition, { readonly kind: Kind }>;

/** The form. */
export function ConditionForm(props: { readonly editor: Editor; readonly condition: Condition; readonly testId: string; readonly path: string; readonly set: (condition: Condition) => void; readonly remove: () => void }): JSX.Element {
  const scene = (): SceneDocument => props.editor.scene();
  const is = <Kind extends Condition["kind"]>(...kinds: readonly Kind[]): Of<Kind> | null => ((kinds as readonly string[]).includes(props.condition.kind) ? (props.condition as Of<Kind>) : null);
  const own = () => props.editor.findings().filter(({ path }) => path === props.path);
  const objects = () => scene().objects.map((thing) => ({ value: thing.id, word: nameOf(thing) }));
  return (
    <div class="edit-part" data-testid={props.testId}>
      <For each={own()}>{(finding) => <p class="edit-found"><FindingText finding={finding} /></p>}</For>
      <ChoiceField
        editor={props.editor}
        label={say().state.kind}
        testId={`${props.testId}-kind`}
        value={props.condition.kind}
        options={KINDS.map((kind) => ({ value: kind, word: say().state.conditions[kind] }))}
        set={(kind) => { if (kind !== props.condition.kind) props.set(turned(props.condition, kind as Condition["kind"], scene())); }}
      />
      <Switch>
        <Match when={is("touching", "looks_at")}>
          {(now) => (
            <>
              <ChoiceField editor={props.editor} label={say().state.object} testId={`${props.testId}-object`} path={`${props.path}.object`} value={now().object} options={objects()} set={(object) => { props.set({ ...now(), object }); }} />
              <NumberField editor={props.editor} label={say().state.secs} testId={`${props.testId}-secs`} step={0.5} path={`${props.path}.secs`} value={now().secs} set={(secs) => { props.set({ ...now(), secs }); }} />
            </>
          )}
        </Match>
        <Match when={is("in_place")}>
          {(now) => <ChoiceField editor={props.editor} label={say().state.object} testId={`${props.testId}-object`} path={`${props.path}.object`} value={now().object} options={objects()} set={(object) => { props.set({ ...now(), object }); }} />}
        </Match>
        <Match when={is("in_zone")}>
          {(now) => <ChoiceField editor={props.editor} label={say().state.zone} testId={`${props.testId}-zone`} path={`${props.path}.zone`} value={now().zone} options={(scene().zones ?? []).map((thing) => ({ value: thing.id, word: nameOf(thing) }))} set={(zone) => { props.set({ ...now(), zone }); }} />}
        </Match>
        <Match when={is("time_in_state")}>
          {(now) => <NumberField editor={props.editor} label={say().state.secs} testId={`${props.testId}-secs`} step={0.5} path={`${props.path}.secs`} value={now().secs} set={(secs) => { props.set({ ...now(), secs }); }} />}
        </Match>
        <Match when={is("variable")}>
          {(now) => <Compares editor={props.editor} condition={now()} testId={props.testId} path={props.path} set={props.set} />}
        </Match>
        <Match when={is("all", "any")}>
          {(now) => (
            <>
              <For each={now().conditions.map((_, index) => index)}>
                {(at) => (
                  <Show when={now().conditions[at]}>
                    {(part) => (
                      <ConditionForm
                        editor={props.editor}
                        condition={part()}
                        testId={`${props.testId}-${at}`}
                        path={`${props.path}.conditions[${at}]`}
                        set={(next) => { props.set({ ...now(), conditions: now().conditions.map((old, place) => (place === at ? next : old)) }); }}
                        remove={() => { props.set({ ...now(), conditions: now().conditions.filter((_, place) => place !== at) }); }}
                      />
                    )}
                  </Show>
                )}
              </For>
              <button type="button" class="quiet" data-testid={`${props.testId}-add`} onClick={() => { props.set({ ...now(), conditions: [...now().conditions, newCondition("touching", scene(), null)] }); }}>
                + {say().state.addCondition}
              </button>
            </>
          )}
        </Match>
        <Match when={is("not")}>
          {(now) => <ConditionForm editor={props.editor} condition={now().condition} testId={`${props.testId}-not`} path={`${props.path}.condition`} set={(condition) => { props.set({ ...now(), condition }); }} remove={() => { props.remove(); }} />}
        </Match>
      </Switch>
      <button type="button" class="quiet" data-testid={`${props.testId}-remove`} aria-label={say().state.removeCondition} onClick={() => { props.remove(); }}>✕</button>
    </div>
  );
}

function Compares(props: { readonly editor: Editor; readonly condition: Of<"variable">; readonly testId: string; readonly path: string; readonly set: (condition: Condition) => void }): JSX.Element {
  const variables = () => props.editor.scene().scenario?.variables ?? [];
  const start = () => variables().find(({ id }) => id === props.condition.variable)?.start ?? props.condition.value;
  const signs = (): readonly string[] => (typeof start() === "boolean" ? ["==", "!="] : ["==", "!=", "<", "<=", ">", ">="]);
  return (
    <>
      <ChoiceField
        editor={props.editor}
        label={say().state.variable}
        testId={`${props.testId}-variable`}
        path={`${props.path}.variable`}
        value={props.condition.variable}
        options={variables().map(({ id }) => ({ value: id, word: id }))}
        set={(variable) => { props.set({ ...props.condition, variable, is: "==", value: variables().find(({ id }) => id === variable)?.start ?? props.condition.value }); }}
      />
      <ChoiceField editor={props.editor} label={say().state.is} testId={`${props.testId}-is`} path={`${props.path}.is`} value={props.condition.is} options={signs().map((sign) => ({ value: sign, word: sign }))} set={(is) => { props.set({ ...props.condition, is: is as Of<"variable">["is"] }); }} />
      <Show
        when={typeof start() === "boolean"}
        fallback={<NumberField editor={props.editor} label={say().state.amount} testId={`${props.testId}-value`} step={1} path={`${props.path}.value`} value={Number(props.condition.value)} set={(value) => { props.set({ ...props.condition, value: Math.round(value) }); }} />}
      >
        <ChoiceField editor={props.editor} label={say().state.amount} testId={`${props.testId}-value`} path={`${props.path}.value`} value={String(props.condition.value)} options={[{ value: "true", word: say().state.yes }, { value: "false", word: say().state.no }]} set={(value) => { props.set({ ...props.condition, value: likeValue(true, value) }); }} />
      </Show>
    </>
  );
}

/** Another kind of condition about the same, as far as both are about one. */
function turned(before: Condition, kind: Condition["kind"], scene: SceneDocument): Condition {
  const next = newCondition(kind, scene, before);
  if ("object" in before && "object" in next) Object.assign(next, { object: before.object });
  if ("secs" in before && "secs" in next) Object.assign(next, { secs: before.secs });
  return next;
}

const KINDS = ["touching", "in_zone", "looks_at", "in_place", "time_in_state", "variable", "all", "any", "not"] as const;
