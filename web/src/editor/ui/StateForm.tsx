/** A state: what can be served in it and how likely, what the column does at it, what is done at entry, what leads on. */
import { For, Show, type JSX } from "solid-js";
import type { ObjectDocument, StateDocument } from "../../api/types";
import { nameOf } from "../../ui/drawing/picture";
import type { Editor } from "../editor";
import { withEnabled, withoutState, withState, withStateId } from "../scenario";
import { withScenario } from "../scene";
import { pathOf, SCENE } from "../selection";
import { say } from "../words";
import { ActsFields } from "./ActsFields";
import { LongField, NumberField, Row, TextField, TickField } from "./fields";
import { InteractionFields } from "./InteractionFields";
import { WaysForm } from "./WaysForm";

type PriorDocument = NonNullable<StateDocument["priors"]>[string];
type ChangingPrior = Exclude<PriorDocument, number>;

/** The form of a state. */
export function StateForm(props: { readonly editor: Editor; readonly index: number }): JSX.Element {
  const path = (): string => pathOf({ kind: "state", index: props.index });
  const state = () => props.editor.scene().scenario?.states[props.index];
  const set = (change: Partial<StateDocument>): void => {
    props.editor.change((scene) => withState(scene, props.index, change));
  };
  return (
    <Show when={state()}>
      {(shown) => (
        <div class="edit-form" data-testid="form-state">
          <h2>{say().graph.state(nameOf(shown()))}</h2>
          <TextField editor={props.editor} label={say().form.id} testId="state-id" path={`${path()}.id`} value={shown().id} set={(id) => { if (id.trim() !== "") props.editor.change((scene) => withStateId(scene, props.index, id.trim())); }} />
          <TextField editor={props.editor} label={say().form.label} testId="state-label" most={80} hint={say().form.labelHint} path={`${path()}.label`} value={shown().label ?? ""} set={(label) => { set({ label }); }} />
          <LongField editor={props.editor} label={say().state.note} testId="state-note" path={`${path()}.note`} value={shown().note ?? ""} set={(note) => { set({ note }); }} />
          <TickField
            editor={props.editor}
            label={say().state.initial}
            testId="state-initial"
            path="$.scenario.initial"
            value={props.editor.scene().scenario?.initial === shown().id}
            set={(isInitial) => { if (isInitial) props.editor.change((scene) => withScenario(scene, (scenario) => ({ ...scenario, initial: shown().id }))); }}
          />
          <TickField editor={props.editor} label={say().state.final} testId="state-final" value={shown().final ?? false} set={(final) => { set({ final }); }} />
          <Row label={say().state.objects}>
            <Show when={props.editor.scene().objects.length > 0} fallback={<p class="empty">{say().state.noObjects}</p>}>
              <ul class="edit-objects">
                <For each={props.editor.scene().objects.map((_, index) => index)}>
                  {(index) => <Show when={props.editor.scene().objects[index]}>{(object) => <ObjectOf editor={props.editor} state={shown()} index={props.index} object={object()} path={path()} set={set} />}</Show>}
                </For>
              </ul>
            </Show>
          </Row>
          <ActsFields editor={props.editor} title={say().state.entry} acts={shown().entry ?? []} path={`${path()}.entry`} testId="entry" set={(entry) => { set({ entry: [...entry] }); }} />
          <WaysForm editor={props.editor} from={props.index} path={`${path()}.transitions`} />
          <button
            type="button"
            class="quiet"
            data-testid="state-remove"
            onClick={() => {
              props.editor.change((scene) => withoutState(scene, props.index));
              props.editor.select(SCENE);
            }}
          >
            {say().form.remove}
          </button>
        </div>
      )}
    </Show>
  );
}

function ObjectOf(props: { readonly editor: Editor; readonly state: StateDocument; readonly index: number; readonly object: ObjectDocument; readonly path: string; readonly set: (change: Partial<StateDocument>) => void }): JSX.Element {
  const id = (): string => props.object.id;
  const isEnabled = (): boolean => props.state.enabled?.includes(id()) ?? false;
  const prior = (): PriorDocument | undefined => props.state.priors?.[id()];
  const changing = (): ChangingPrior | null => {
    const found = prior();
    return typeof found === "object" ? found : null;
  };
  const value = (): number => changing()?.value ?? (prior() as number | undefined) ?? props.object.prior;
  const setPrior = (next: PriorDocument): void => {
    props.set({ priors: { ...props.state.priors, [id()]: next } });
  };
  return (
    <li>
      <TickField editor={props.editor} label={nameOf(props.object)} testId={`enable-${id()}`} value={isEnabled()} set={(on) => { props.editor.change((scene) => withEnabled(scene, props.index, id(), on)); }} />
      <Show when={isEnabled()}>
        <div class="edit-sub">
          <NumberField
            editor={props.editor}
            label={say().state.priorOf(nameOf(props.object))}
            testId={`prior-${id()}`}
            path={`${props.path}.priors.${id()}`}
            value={value()}
            set={(next) => {
              const now = changing();
              setPrior(now === null ? next : { ...now, value: next });
            }}
          />
          <InteractionFields editor={props.editor} state={props.index} object={props.object} path={props.path} />
          <TickField
            editor={props.editor}
            label={say().state.changing}
            testId={`changing-${id()}`}
            value={changing() !== null}
            set={(on) => { setPrior(on ? { value: value(), per_s: 0, per_touch: 0.1, least: 0, most: 1 } : value()); }}
          />
          <Show when={changing()}>
            {(now) => (
              <Row label={say().state.changing}>
                <For each={["per_s", "per_touch", "least", "most"] as const}>
                  {(field) => <NumberField editor={props.editor} label={say().state[field]} testId={`${field}-${id()}`} value={now()[field]} set={(next) => { setPrior({ ...now(), [field]: next }); }} />}
                </For>
              </Row>
            )}
          </Show>
        </div>
      </Show>
    </li>
  );
}
