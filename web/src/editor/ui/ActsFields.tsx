/** Acts on variables in their order, and the variables themselves. */
import { For, Show, type JSX } from "solid-js";
import type { StateDocument, VariableValue } from "../../api/types";
import type { Editor } from "../editor";
import { likeValue, withVariableId, withVariables } from "../scenario";
import { freeId } from "../scene";
import { pathOf } from "../selection";
import { say } from "../words";
import { ChoiceField, NumberField, TextField } from "./fields";
import { WaysForm } from "./WaysForm";

type Act = NonNullable<StateDocument["entry"]>[number];

/** A list of acts. */
export function ActsFields(props: { readonly editor: Editor; readonly title: string; readonly acts: readonly Act[]; readonly path: string; readonly testId: string; readonly set: (acts: readonly Act[]) => void }): JSX.Element {
  const variables = () => props.editor.scene().scenario?.variables ?? [];
  const add = (): void => {
    const [variable] = variables();
    if (variable !== undefined) props.set([...props.acts, { kind: "set", variable: variable.id, value: variable.start }]);
  };
  const replace = (at: number, act: Act): void => {
    props.set(props.acts.map((old, place) => (place === at ? act : old)));
  };
  return (
    <Show when={variables().length > 0 || props.acts.length > 0}>
      <h4>{props.title}</h4>
      <For each={props.acts.map((_, index) => index)}>
        {(at) => (
          <Show when={props.acts[at]}>
            {(act) => <ActForm editor={props.editor} act={act()} path={`${props.path}[${at}]`} testId={`${props.testId}-${at}`} set={(next) => { replace(at, next); }} remove={() => { props.set(props.acts.filter((_, place) => place !== at)); }} />}
          </Show>
        )}
      </For>
      <button type="button" class="quiet" data-testid={`${props.testId}-add`} disabled={variables().length === 0} onClick={add}>
        + {say().state.addAct}
      </button>
    </Show>
  );
}

function ActForm(props: { readonly editor: Editor; readonly act: Act; readonly path: string; readonly testId: string; readonly set: (act: Act) => void; readonly remove: () => void }): JSX.Element {
  const variables = () => props.editor.scene().scenario?.variables ?? [];
  const start = (): VariableValue => variables().find(({ id }) => id === props.act.variable)?.start ?? 0;
  const kinds = (): readonly Act["kind"][] => (typeof start() === "boolean" ? ["set"] : ["set", "add"]);
  const value = (): VariableValue => (props.act.kind === "set" ? props.act.value : props.act.amount);
  const put = (next: VariableValue): void => {
    props.set(props.act.kind === "set" ? { ...props.act, value: next } : { ...props.act, amount: Number(next) });
  };
  return (
    <div class="edit-part">
      <ChoiceField
        editor={props.editor}
        label={say().state.kind}
        testId={`${props.testId}-kind`}
        value={props.act.kind}
        options={kinds().map((kind) => ({ value: kind, word: say().state.actKinds[kind] }))}
        set={(kind) => { props.set(kind === "add" ? { kind, variable: props.act.variable, amount: 1 } : { kind: "set", variable: props.act.variable, value: start() }); }}
      />
      <ChoiceField
        editor={props.editor}
        label={say().state.variable}
        testId={`${props.testId}-variable`}
        path={`${props.path}.variable`}
        value={props.act.variable}
        options={variables().map(({ id }) => ({ value: id, word: id }))}
        set={(variable) => { props.set({ kind: "set", variable, value: variables().find(({ id }) => id === variable)?.start ?? 0 }); }}
      />
      <ValueField editor={props.editor} label={say().state.amount} testId={`${props.testId}-value`} path={`${props.path}.${props.act.kind === "set" ? "value" : "amount"}`} value={value()} set={put} />
      <button type="button" class="quiet" aria-label={say().state.removeAct} onClick={() => { props.remove(); }}>✕</button>
    </div>
  );
}

function ValueField(props: { readonly editor: Editor; readonly label: string; readonly testId: string; readonly path: string; readonly value: VariableValue; readonly set: (value: VariableValue) => void }): JSX.Element {
  return (
    <Show
      when={typeof props.value === "boolean"}
      fallback={<NumberField editor={props.editor} label={props.label} testId={props.testId} step={1} path={props.path} value={Number(props.value)} set={(value) => { props.set(Math.round(value)); }} />}
    >
      <ChoiceField editor={props.editor} label={props.label} testId={props.testId} path={props.path} value={String(props.value)} options={[{ value: "true", word: say().state.yes }, { value: "false", word: say().state.no }]} set={(value) => { props.set(likeValue(true, value)); }} />
    </Show>
  );
}

/** What the scenario remembers. */
export function VariablesForm(props: { readonly editor: Editor }): JSX.Element {
  const variables = () => props.editor.scene().scenario?.variables ?? [];
  const path = pathOf({ kind: "variables" });
  const start = (id: string, value: VariableValue): void => {
    props.editor.change((scene) => withVariables(scene, (all) => all.map((variable) => (variable.id === id ? { ...variable, start: value } : variable))));
  };
  return (
    <div class="edit-form" data-testid="form-variables">
      <h2>{say().variables.title}</h2>
      <For each={variables().map((_, index) => index)}>
        {(index) => (
          <Show when={variables()[index]}>
            {(variable) => (
              <div class="edit-part">
                <TextField editor={props.editor} label={say().form.id} testId={`variable-id-${index}`} path={`${path}[${index}]`} value={variable().id} set={(id) => { if (id.trim() !== "") props.editor.change((scene) => withVariableId(scene, variable().id, id.trim())); }} />
                <ChoiceField
                  editor={props.editor}
                  label={say().variables.kind}
                  testId={`variable-kind-${index}`}
                  value={typeof variable().start}
                  options={[{ value: "boolean", word: say().variables.yesNo }, { value: "number", word: say().variables.number }]}
                  set={(kind) => { if (kind !== typeof variable().start) start(variable().id, kind === "boolean" ? false : 0); }}
                />
                <ValueField editor={props.editor} label={say().variables.start} testId={`variable-start-${index}`} path={`${path}[${index}].start`} value={variable().start} set={(value) => { start(variable().id, value); }} />
                <button type="button" class="quiet" aria-label={say().variables.remove(variable().id)} onClick={() => { props.editor.change((scene) => withVariables(scene, (all) => all.filter(({ id }) => id !== variable().id))); }}>✕</button>
              </div>
            )}
          </Show>
        )}
      </For>
      <button type="button" data-testid="add-variable" onClick={() => { props.editor.change((scene) => withVariables(scene, (all) => [...all, { id: freeId(all.map(({ id }) => id), "variable"), start: false }])); }}>
        + {say().variables.add}
      </button>
    </div>
  );
}

/** What leads on from every state. */
export function AnywhereForm(props: { readonly editor: Editor }): JSX.Element {
  return (
    <div class="edit-form" data-testid="form-anywhere">
      <h2>{say().list.anywhere}</h2>
      <WaysForm editor={props.editor} from="anywhere" path={pathOf({ kind: "anywhere" })} />
    </div>
  );
}
