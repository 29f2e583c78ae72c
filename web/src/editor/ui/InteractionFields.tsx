/** What the column does at an object in a state: its kind, and what that kind asks for. */
import { For, Match, Show, Switch, type JSX } from "solid-js";
import type { ObjectDocument } from "../../api/types";
import { nameOf } from "../../ui/drawing/picture";
import type { Editor } from "../editor";
import { INTERACTIONS, newInteraction, onward, withInteraction, withPath, type Interaction } from "../interactions";
import { say } from "../words";
import { ChoiceField, NumberField, Row } from "./fields";

/** The fields. */
export function InteractionFields(props: { readonly editor: Editor; readonly state: number; readonly object: ObjectDocument; readonly path: string }): JSX.Element {
  const id = (): string => props.object.id;
  const now = (): Interaction | undefined => props.editor.scene().scenario?.states[props.state]?.interactions?.[id()];
  const set = (interaction: Interaction | null): void => {
    props.editor.change((scene) => withInteraction(scene, props.state, id(), interaction));
  };
  const stepBack = () => {
    const found = now();
    return found?.kind === "step_back" ? found : null;
  };
  const brush = () => {
    const found = now();
    return found?.kind === "brush" ? found : null;
  };
  const course = () => {
    const found = now();
    return found !== undefined && "path" in found ? found : null;
  };
  const place = (at: number, axis: 0 | 1, value: number): void => {
    props.editor.change((scene) => withPath(scene, { state: props.state, object: id() }, (places) => places.map((old, index) => (index === at ? (axis === 0 ? [value, old[1]] : [old[0], value]) : old))));
  };
  return (
    <>
      <ChoiceField
        editor={props.editor}
        label={say().state.interactionOf(nameOf(props.object))}
        testId={`interaction-${id()}`}
        path={`${props.path}.interactions.${id()}`}
        value={now()?.kind ?? "none"}
        options={(["none", ...INTERACTIONS] as const).map((kind) => ({ value: kind, word: say().state.interactions[kind] }))}
        set={(kind) => {
          if (kind === "none") set(null);
          else if (kind !== now()?.kind) set(newInteraction(kind as Interaction["kind"], props.editor.scene(), id(), now()));
        }}
      />
      <Switch>
        <Match when={stepBack()}>
          {(back) => <NumberField editor={props.editor} label={say().state.distance} unit="m" testId={`distance-${id()}`} value={back().distance} set={(distance) => { set({ ...back(), distance }); }} />}
        </Match>
        <Match when={brush()}>
          {(touch) => (
            <Row label={say().state.interactions.brush}>
              <NumberField editor={props.editor} label={say().state.speed} unit="m/s" testId={`speed-${id()}`} value={touch().speed} set={(speed) => { set({ ...touch(), speed }); }} />
              <NumberField editor={props.editor} label={say().state.stays_secs} unit="s" step={0.5} testId={`stays-${id()}`} value={touch().secs} set={(secs) => { set({ ...touch(), secs }); }} />
            </Row>
          )}
        </Match>
        <Match when={course()}>
          {(way) => (
            <>
              <NumberField editor={props.editor} label={say().state.speed} unit="m/s" testId={`speed-${id()}`} value={way().speed} set={(speed) => { set({ ...way(), speed }); }} />
              <p class="empty">{say().state.pathMeans}</p>
              <For each={way().path.map((_, index) => index)}>
                {(index) => (
                  <Row label={say().plan.place(index + 1)}>
                    <NumberField editor={props.editor} label="x" unit="m" testId={`path-${id()}-${index}-x`} value={way().path[index]?.[0] ?? 0} set={(value) => { place(index, 0, value); }} />
                    <NumberField editor={props.editor} label="y" unit="m" testId={`path-${id()}-${index}-y`} value={way().path[index]?.[1] ?? 0} set={(value) => { place(index, 1, value); }} />
                    <Show when={way().path.length > 1}>
                      <button type="button" class="quiet" aria-label={say().state.removePlace(index + 1)} onClick={() => { props.editor.change((scene) => withPath(scene, { state: props.state, object: id() }, (places) => places.filter((_, at) => at !== index))); }}>✕</button>
                    </Show>
                  </Row>
                )}
              </For>
              <button type="button" class="quiet" data-testid={`path-add-${id()}`} onClick={() => { props.editor.change((scene) => withPath(scene, { state: props.state, object: id() }, (places) => onward(scene, id(), places))); }}>
                + {say().state.addPlace}
              </button>
            </>
          )}
        </Match>
      </Switch>
    </>
  );
}
