/** Transitions in their order: where each leads, what sets it off, what must hold, what is done on the way. */
import { For, Show, type JSX } from "solid-js";
import type { Condition, SceneDocument, TransitionDocument, Trigger } from "../../api/types";
import { nameOf } from "../../ui/drawing/picture";
import type { Editor } from "../editor";
import { newCondition, newTrigger, waysFrom, withWays, type From } from "../scenario";
import { say } from "../words";
import { ActsFields } from "./ActsFields";
import { ConditionForm } from "./ConditionForm";
import { ChoiceField, FindingText, TextField } from "./fields";

/** The transitions from a state, or from anywhere. */
export function WaysForm(props: { readonly editor: Editor; readonly from: From; readonly path: string }): JSX.Element {
  const ways = (): readonly TransitionDocument[] => waysFrom(props.editor.scene().scenario, props.from);
  const change = (make: (ways: readonly TransitionDocument[]) => readonly TransitionDocument[]): void => {
    props.editor.change((scene) => withWays(scene, props.from, make));
  };
  const states = () => props.editor.scene().scenario?.states ?? [];
  const add = (): void => {
    const to = states().find((_, index) => index !== props.from)?.id;
    change((now) => [...now, { on: [{ kind: "cue", name: "next" }], ...(to === undefined ? {} : { to }) }]);
  };
  return (
    <section class="edit-ways" aria-label={say().state.transitions}>
      <h3>{say().state.transitions}</h3>
      <For each={ways().map((_, index) => index)}>
        {(index) => (
          <Show when={ways()[index]}>
            {(way) => (
              <Way
                editor={props.editor}
                way={way()}
                index={index}
                path={`${props.path}[${index}]`}
                set={(next) => { change((now) => now.map((old, at) => (at === index ? { ...old, ...next } : old))); }}
                earlier={() => { change((now) => swapped(now, index)); }}
                remove={() => { change((now) => now.filter((_, at) => at !== index)); }}
              />
            )}
          </Show>
        )}
      </For>
      <button type="button" data-testid="add-transition" onClick={add}>
        + {say().state.addTransition}
      </button>
    </section>
  );
}

function Way(props: {
  readonly editor: Editor;
  readonly way: TransitionDocument;
  readonly index: number;
  readonly path: string;
  readonly set: (change: Partial<TransitionDocument>) => void;
  readonly earlier: () => void;
  readonly remove: () => void;
}): JSX.Element {
  const number = (): number => props.index + 1;
  const scene = (): SceneDocument => props.editor.scene();
  const own = () => props.editor.findings().filter(({ path }) => path === props.path);
  const setOn = (on: readonly Trigger[]): void => { props.set({ on: [...on] }); };
  return (
    <fieldset class="edit-way" data-testid={`transition-${props.index}`}>
      <legend>{say().state.transition(number())}</legend>
      <For each={own()}>{(finding) => <p class="edit-found"><FindingText finding={finding} /></p>}</For>
      <ChoiceField
        editor={props.editor}
        label={say().state.to}
        testId={`to-${props.index}`}
        path={`${props.path}.to`}
        value={props.way.to ?? ""}
        options={[...(scene().scenario?.states ?? []).map((state) => ({ value: state.id, word: nameOf(state) })), { value: "", word: say().state.stays }]}
        set={(to) => { props.set({ to: to === "" ? null : to }); }}
      />
      <h4>{say().state.on}</h4>
      <Show when={(props.way.on ?? []).length > 0} fallback={<p class="empty">{say().state.onNone}</p>}>
        <For each={(props.way.on ?? []).map((_, index) => index)}>
          {(at) => (
            <Show when={props.way.on?.[at]}>
              {(trigger) => (
                <TriggerForm
                  editor={props.editor}
                  trigger={trigger()}
                  testId={`on-${props.index}-${at}`}
                  path={`${props.path}.on[${at}]`}
                  set={(next) => { setOn((props.way.on ?? []).map((old, place) => (place === at ? next : old))); }}
                  remove={() => { setOn((props.way.on ?? []).filter((_, place) => place !== at)); }}
                />
              )}
            </Show>
          )}
        </For>
      </Show>
      <button type="button" class="quiet" data-testid={`add-on-${props.index}`} onClick={() => { setOn([...(props.way.on ?? []), newTrigger("touch_began", scene())]); }}>
        + {say().state.addOn}
      </button>
      <h4>{say().state.when}</h4>
      <Show
        when={props.way.when}
        fallback={
          <>
            <p class="empty">{say().state.whenNone}</p>
            <button type="button" class="quiet" data-testid={`add-when-${props.index}`} onClick={() => { props.set({ when: newCondition("touching", scene(), null) }); }}>
              + {say().state.addCondition}
            </button>
          </>
        }
      >
        {(when: () => Condition) => (
          <ConditionForm editor={props.editor} condition={when()} testId={`when-${props.index}`} path={`${props.path}.when`} set={(next) => { props.set({ when: next }); }} remove={() => { props.set({ when: null }); }} />
        )}
      </Show>
      <ActsFields editor={props.editor} title={say().state.acts} acts={props.way.acts ?? []} path={`${props.path}.acts`} testId={`acts-${props.index}`} set={(acts) => { props.set({ acts: [...acts] }); }} />
      <TextField editor={props.editor} label={say().form.label} testId={`way-label-${props.index}`} most={80} path={`${props.path}.label`} value={props.way.label ?? ""} set={(label) => { props.set({ label }); }} />
      <div class="edit-buttons">
        <button type="button" class="quiet" disabled={props.index === 0} aria-label={say().state.earlier(number())} onClick={() => { props.earlier(); }}>↑</button>
        <button type="button" class="quiet" data-testid={`remove-transition-${props.index}`} aria-label={say().state.removeTransition(number())} onClick={() => { props.remove(); }}>✕</button>
      </div>
    </fieldset>
  );
}

function TriggerForm(props: { readonly editor: Editor; readonly trigger: Trigger; readonly testId: string; readonly path: string; readonly set: (trigger: Trigger) => void; readonly remove: () => void }): JSX.Element {
  const scene = (): SceneDocument => props.editor.scene();
  const object = () => ("object" in props.trigger ? props.trigger : null);
  const zone = () => ("zone" in props.trigger ? props.trigger : null);
  const name = () => ("name" in props.trigger ? props.trigger : null);
  return (
    <div class="edit-part">
      <ChoiceField
        editor={props.editor}
        label={say().state.kind}
        testId={`${props.testId}-kind`}
        value={props.trigger.kind}
        options={TRIGGERS.map((kind) => ({ value: kind, word: say().state.triggers[kind] }))}
        set={(kind) => { props.set(kept(props.trigger, newTrigger(kind as Trigger["kind"], scene()))); }}
      />
      <Show when={object()}>
        {(now) => <ChoiceField editor={props.editor} label={say().state.object} testId={`${props.testId}-object`} path={`${props.path}.object`} value={now().object} options={scene().objects.map((thing) => ({ value: thing.id, word: nameOf(thing) }))} set={(id) => { props.set({ ...now(), object: id }); }} />}
      </Show>
      <Show when={zone()}>
        {(now) => <ChoiceField editor={props.editor} label={say().state.zone} testId={`${props.testId}-zone`} path={`${props.path}.zone`} value={now().zone} options={(scene().zones ?? []).map((thing) => ({ value: thing.id, word: nameOf(thing) }))} set={(id) => { props.set({ ...now(), zone: id }); }} />}
      </Show>
      <Show when={name()}>
        {(now) => <TextField editor={props.editor} label={say().state.cueName} testId={`${props.testId}-name`} path={`${props.path}.name`} value={now().name} set={(next) => { props.set({ ...now(), name: next }); }} />}
      </Show>
      <button type="button" class="quiet" data-testid={`${props.testId}-remove`} aria-label={say().state.removeOn} onClick={() => { props.remove(); }}>✕</button>
    </div>
  );
}

/** What both kinds are about stays. */
function kept(before: Trigger, next: Trigger): Trigger {
  const about = { ...("object" in before && "object" in next ? { object: before.object } : {}), ...("zone" in before && "zone" in next ? { zone: before.zone } : {}), ...("name" in before && "name" in next ? { name: before.name } : {}) };
  return Object.assign(next, about);
}

function swapped(ways: readonly TransitionDocument[], index: number): readonly TransitionDocument[] {
  return ways.map((way, at) => (at === index - 1 ? (ways[index] ?? way) : at === index ? (ways[index - 1] ?? way) : way));
}

const TRIGGERS = ["touch_began", "touch_ended", "interaction_done", "zone_entered", "zone_left", "client_event", "cue"] as const;
