/** The properties of what is chosen in the room: the scene itself, an object, a prop, a keep-out, a zone. */
import { Match, Show, Switch, type JSX } from "solid-js";
import type { KeepOutDocument, ObjectDocument, PropDocument } from "../../api/types";
import { nameOf } from "../../ui/drawing/picture";
import type { Editor } from "../editor";
import { thingsOf, withId, without, withThing, type ThingChange } from "../scene";
import { pathOf, SCENE, type ThingList } from "../selection";
import { say } from "../words";
import { ChoiceField, LongField, NumberField, Row, TextField, TickField } from "./fields";
import { FloorShape, ObjectShape } from "./ShapeFields";

/** The scene as a whole. */
export function SceneForm(props: { readonly editor: Editor }): JSX.Element {
  const scene = () => props.editor.scene();
  const corner = (which: "min" | "max", axis: 0 | 1) => (value: number): void => {
    props.editor.change((now) => ({ ...now, arena: { ...now.arena, [which]: now.arena[which].map((old, at) => (at === axis ? value : old)) as [number, number] } }));
  };
  return (
    <div class="edit-form" data-testid="form-scene">
      <h2>{say().list.scene}</h2>
      <TextField editor={props.editor} label={say().form.name} testId="scene-name" most={80} path="$.name" value={scene().name} set={(name) => { props.editor.change((now) => ({ ...now, name })); }} />
      <LongField
        editor={props.editor}
        label={say().form.description}
        testId="scene-description"
        path="$.description"
        value={scene().description ?? ""}
        set={(description) => { props.editor.change(({ description: _, ...now }) => (description === "" ? now : { ...now, description })); }}
      />
      <LongField
        editor={props.editor}
        label={say().form.checklist}
        testId="scene-checklist"
        path="$.checklist"
        value={(scene().checklist ?? []).join("\n")}
        set={(text) => {
          const checklist = text.split("\n").map((line) => line.trim()).filter((line) => line !== "");
          props.editor.change(({ checklist: _, ...now }) => (checklist.length === 0 ? now : { ...now, checklist }));
        }}
      />
      <Row label={say().form.arenaMin}>
        <NumberField editor={props.editor} label="x" unit="m" testId="arena-min-x" path="$.arena.min" value={scene().arena.min[0]} set={corner("min", 0)} />
        <NumberField editor={props.editor} label="y" unit="m" testId="arena-min-y" value={scene().arena.min[1]} set={corner("min", 1)} />
      </Row>
      <Row label={say().form.arenaMax}>
        <NumberField editor={props.editor} label="x" unit="m" testId="arena-max-x" path="$.arena.max" value={scene().arena.max[0]} set={corner("max", 0)} />
        <NumberField editor={props.editor} label="y" unit="m" testId="arena-max-y" value={scene().arena.max[1]} set={corner("max", 1)} />
      </Row>
      <Row label={say().form.column}>
        <NumberField editor={props.editor} label="x" unit="m" testId="column-x" path="$.column" value={scene().column.size[0]} set={(x) => { props.editor.change((now) => ({ ...now, column: { size: [x, now.column.size[1]] } })); }} />
        <NumberField editor={props.editor} label="y" unit="m" testId="column-y" value={scene().column.size[1]} set={(y) => { props.editor.change((now) => ({ ...now, column: { size: [now.column.size[0], y] } })); }} />
      </Row>
    </div>
  );
}

/** A thing of a list. */
export function ThingForm(props: { readonly editor: Editor; readonly list: ThingList; readonly index: number }): JSX.Element {
  const path = (): string => pathOf({ kind: "thing", list: props.list, index: props.index });
  const thing = () => thingsOf(props.editor.scene(), props.list)[props.index];
  const set = (change: ThingChange): void => {
    props.editor.change((scene) => withThing(scene, props.list, props.index, change));
  };
  return (
    <Show when={thing()}>
      {(shown) => (
        <div class="edit-form" data-testid={`form-${props.list}`}>
          <h2>
            {say().plan.thing[props.list]} {nameOf(shown())}
          </h2>
          <TextField editor={props.editor} label={say().form.id} testId="thing-id" path={`${path()}.id`} value={shown().id} set={(id) => { if (id.trim() !== "") props.editor.change((scene) => withId(scene, props.list, props.index, id.trim())); }} />
          <TextField editor={props.editor} label={say().form.label} testId="thing-label" most={80} hint={say().form.labelHint} path={`${path()}.label`} value={shown().label ?? ""} set={(label) => { set({ label }); }} />
          <Switch>
            <Match when={props.list === "objects"}>
              <ObjectFields editor={props.editor} object={shown() as ObjectDocument} path={path()} set={set} />
            </Match>
            <Match when={props.list === "props"}>
              <PropFields editor={props.editor} prop={shown() as PropDocument} path={path()} set={set} />
            </Match>
            <Match when={true}>
              <FloorShape editor={props.editor} shape={(shown() as KeepOutDocument).shape} path={`${path()}.shape`} set={(shape) => { set({ shape }); }} />
            </Match>
          </Switch>
          <button
            type="button"
            class="quiet"
            data-testid="thing-remove"
            onClick={() => {
              props.editor.change((scene) => without(scene, props.list, props.index));
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

function ObjectFields(props: { readonly editor: Editor; readonly object: ObjectDocument; readonly path: string; readonly set: (change: ThingChange) => void }): JSX.Element {
  const at = (axis: 0 | 1 | 2) => (value: number): void => {
    props.set({ position: props.object.position.map((old, place) => (place === axis ? value : old)) as [number, number, number] });
  };
  const hung = () => props.editor.scene().props ?? [];
  return (
    <>
      <Row label={say().form.position}>
        <NumberField editor={props.editor} label="x" unit="m" testId="position-x" path={`${props.path}.position`} value={props.object.position[0]} set={at(0)} />
        <NumberField editor={props.editor} label="y" unit="m" testId="position-y" value={props.object.position[1]} set={at(1)} />
        <NumberField editor={props.editor} label={say().form.height} unit="m" testId="position-z" value={props.object.position[2]} set={at(2)} />
      </Row>
      <ChoiceField
        editor={props.editor}
        label={say().form.prop}
        testId="object-prop"
        path={`${props.path}.prop`}
        value={props.object.prop ?? ""}
        options={[{ value: "", word: say().form.noProp }, ...hung().map((prop) => ({ value: prop.id, word: nameOf(prop) }))]}
        set={(prop) => { props.set({ prop: prop === "" ? null : prop }); }}
      />
      <NumberField editor={props.editor} label={say().form.prior} testId="object-prior" path={`${props.path}.prior`} value={props.object.prior} set={(prior) => { props.set({ prior }); }} />
      <TickField editor={props.editor} label={say().form.enabled} testId="object-enabled" value={props.object.enabled} set={(enabled) => { props.set({ enabled }); }} />
      <NumberField editor={props.editor} label={say().form.yaw} unit="rad" testId="object-yaw" path={`${props.path}.yaw`} value={props.object.yaw} set={(yaw) => { props.set({ yaw }); }} />
      <ObjectShape editor={props.editor} shape={props.object.shape} path={`${props.path}.shape`} set={(shape) => { props.set({ shape }); }} />
    </>
  );
}

function PropFields(props: { readonly editor: Editor; readonly prop: PropDocument; readonly path: string; readonly set: (change: ThingChange) => void }): JSX.Element {
  return (
    <>
      <Row label={say().form.offset}>
        <NumberField editor={props.editor} label="x" unit="m" testId="offset-x" path={`${props.path}.offset`} value={props.prop.offset[0]} set={(x) => { props.set({ offset: [x, props.prop.offset[1]] }); }} />
        <NumberField editor={props.editor} label="y" unit="m" testId="offset-y" value={props.prop.offset[1]} set={(y) => { props.set({ offset: [props.prop.offset[0], y] }); }} />
      </Row>
      <NumberField editor={props.editor} label={say().form.facing} unit="rad" testId="prop-facing" path={`${props.path}.facing`} value={props.prop.facing} set={(facing) => { props.set({ facing }); }} />
      <Row label={say().form.takes}>
        <NumberField editor={props.editor} label="x" unit="m" testId="takes-x" path={`${props.path}.size`} value={props.prop.size[0]} set={(x) => { props.set({ size: [x, props.prop.size[1]] }); }} />
        <NumberField editor={props.editor} label="y" unit="m" testId="takes-y" value={props.prop.size[1]} set={(y) => { props.set({ size: [props.prop.size[0], y] }); }} />
      </Row>
    </>
  );
}
