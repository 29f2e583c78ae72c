/** Everything that the scene has, with what is found at it; and what can be added. */
import { For, Show, type JSX } from "solid-js";
import { nameOf } from "../../ui/drawing/picture";
import type { Editor } from "../editor";
import { withNewState } from "../scenario";
import { thingsOf, withNew } from "../scene";
import { isSame, pathOf, SCENE, THING_LISTS, type Selection, type ThingList as List } from "../selection";
import { say } from "../words";

/** The list; `chose` is told so that the right picture is shown. */
export function ThingList(props: { readonly editor: Editor; readonly chose: (selection: Selection) => void }): JSX.Element {
  const add = (list: List): void => {
    const { min, max } = props.editor.scene().arena;
    const index = thingsOf(props.editor.scene(), list).length;
    // Beside one another, not one upon another.
    const at = [(min[0] + max[0]) / 2 + 0.3 * (index % 3), (min[1] + max[1]) / 2 + 0.3 * (Math.floor(index / 3) % 3)] as const;
    props.editor.change((scene) => withNew(scene, list, at));
    props.chose({ kind: "thing", list, index });
  };
  const scenario = () => props.editor.scene().scenario ?? null;
  return (
    <nav class="panel edit-list scrolls" aria-label={say().list.title} tabindex="0">
      <Entry editor={props.editor} selection={SCENE} word={say().list.scene} testId="choose-scene" chose={props.chose} shallow />
      <For each={THING_LISTS}>
        {(list) => (
          <>
            <h3>{say().list[list]}</h3>
            <ul>
              <For each={thingsOf(props.editor.scene(), list)}>
                {(thing, index) => (
                  <li>
                    <Entry editor={props.editor} selection={{ kind: "thing", list, index: index() }} word={nameOf(thing)} testId={`choose-${list}-${thing.id}`} chose={props.chose} />
                  </li>
                )}
              </For>
            </ul>
            <button type="button" class="quiet" data-testid={`add-${list}`} onClick={() => { add(list); }}>
              + {say().list.add[list]}
            </button>
          </>
        )}
      </For>
      <h3>{say().states}</h3>
      <ul>
        <For each={scenario()?.states ?? []}>
          {(state, index) => (
            <li>
              <Entry editor={props.editor} selection={{ kind: "state", index: index() }} word={nameOf(state)} testId={`choose-state-${state.id}`} chose={props.chose} />
            </li>
          )}
        </For>
      </ul>
      <button
        type="button"
        class="quiet"
        data-testid="add-state"
        onClick={() => {
          const index = scenario()?.states.length ?? 0;
          props.editor.change(withNewState);
          props.chose({ kind: "state", index });
        }}
      >
        + {scenario() === null ? say().list.firstState : say().list.addState}
      </button>
      <Show when={scenario() !== null}>
        <Entry editor={props.editor} selection={{ kind: "anywhere" }} word={say().list.anywhere} testId="choose-anywhere" chose={props.chose} />
        <Entry editor={props.editor} selection={{ kind: "variables" }} word={say().list.variables} testId="choose-variables" chose={props.chose} />
      </Show>
    </nav>
  );
}

function Entry(props: { readonly editor: Editor; readonly selection: Selection; readonly word: string; readonly testId: string; readonly chose: (selection: Selection) => void; readonly shallow?: boolean }): JSX.Element {
  const found = () => {
    const path = pathOf(props.selection);
    return props.shallow === true ? props.editor.findings().filter((finding) => SHALLOW.test(finding.path)) : props.editor.at(path);
  };
  const errors = (): number => found().filter(({ grade }) => grade === "error").length;
  const isChosen = (): boolean => isSame(props.editor.selection(), props.selection);
  return (
    <button type="button" class="edit-entry" data-testid={props.testId} aria-current={isChosen() ? "true" : undefined} onClick={() => { props.chose(props.selection); }}>
      <span>{props.word}</span>
      <Show when={found().length > 0}>
        <span class="edit-mark" data-grade={errors() > 0 ? "error" : "warning"}>
          <span aria-hidden="true">{errors() > 0 ? "✕" : "!"} {found().length}</span>
          <span class="unseen">{say().check.marks(errors(), found().length - errors())}</span>
        </span>
      </Show>
    </button>
  );
}

/** What is about the scene itself, and not about one of its things. */
const SHALLOW = /^\$(\.(schema|name|description|arena|column)|\.objects$|\.scenario$|\.scenario\.(initial|states)$|$)/;
