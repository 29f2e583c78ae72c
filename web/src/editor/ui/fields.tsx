/** Fields of the editor's forms: each commits when it is left or Enter is pressed, and shows what the check finds at its place. */
import { createUniqueId, For, Show, type JSX } from "solid-js";
import { errorWords, phraseWords } from "../../lib/phraseWords";
import type { Editor, Finding } from "../editor";
import { say } from "../words";

interface FieldProps {
  readonly label: string;
  readonly testId: string;
  /** Where in the document; what is found there is shown beneath. */
  readonly path?: string;
  readonly editor: Editor;
}

/** A line of text. */
export function TextField(props: FieldProps & { readonly value: string; readonly set: (value: string) => void; readonly hint?: string; readonly most?: number }): JSX.Element {
  return (
    <Field {...props}>
      {(id, bad, described) => (
        <input
          id={id}
          type="text"
          data-testid={props.testId}
          autocomplete="off"
          maxlength={props.most ?? 64}
          placeholder={props.hint}
          value={props.value}
          aria-invalid={bad()}
          aria-describedby={described()}
          onChange={(event) => {
            props.set(event.currentTarget.value);
            // A value that was not taken: the field shows what holds.
            event.currentTarget.value = props.value;
          }}
        />
      )}
    </Field>
  );
}

/** Several lines. */
export function LongField(props: FieldProps & { readonly value: string; readonly set: (value: string) => void }): JSX.Element {
  return (
    <Field {...props}>
      {(id, bad, described) => (
        <textarea id={id} data-testid={props.testId} rows={3} aria-invalid={bad()} aria-describedby={described()} value={props.value} onChange={(event) => { props.set(event.currentTarget.value); }} />
      )}
    </Field>
  );
}

/** A number; what is none is put back. */
export function NumberField(props: FieldProps & { readonly value: number; readonly set: (value: number) => void; readonly step?: number; readonly unit?: string }): JSX.Element {
  return (
    <Field {...props} label={props.unit === undefined ? props.label : `${props.label}, ${props.unit}`}>
      {(id, bad, described) => (
        <input
          id={id}
          type="number"
          data-testid={props.testId}
          step={props.step ?? 0.05}
          value={props.value}
          aria-invalid={bad()}
          aria-describedby={described()}
          onChange={(event) => {
            const { valueAsNumber } = event.currentTarget;
            if (Number.isFinite(valueAsNumber)) props.set(valueAsNumber);
            event.currentTarget.value = String(props.value);
          }}
        />
      )}
    </Field>
  );
}

/** One of a few. */
export function ChoiceField(props: FieldProps & { readonly value: string; readonly options: readonly { readonly value: string; readonly word: string }[]; readonly set: (value: string) => void }): JSX.Element {
  const isMissing = (): boolean => !props.options.some(({ value }) => value === props.value);
  return (
    <Field {...props}>
      {(id, bad, described) => (
        <select id={id} data-testid={props.testId} aria-invalid={bad()} aria-describedby={described()} onChange={(event) => { props.set(event.currentTarget.value); }}>
          <Show when={isMissing()}>
            <option value={props.value} selected>{say().state.missing(props.value)}</option>
          </Show>
          <For each={props.options}>{(option) => <option value={option.value} selected={option.value === props.value}>{option.word}</option>}</For>
        </select>
      )}
    </Field>
  );
}

/** Yes or no. */
export function TickField(props: FieldProps & { readonly value: boolean; readonly set: (value: boolean) => void }): JSX.Element {
  return (
    <div class="edit-tick">
      <label>
        <input type="checkbox" data-testid={props.testId} checked={props.value} onChange={(event) => { props.set(event.currentTarget.checked); }} /> {props.label}
      </label>
      <Show when={props.path}>{(path) => <FoundHere editor={props.editor} path={path()} id={undefined} />}</Show>
    </div>
  );
}

/** Several fields in a row under one name. */
export function Row(props: { readonly label: string; readonly children: JSX.Element }): JSX.Element {
  return (
    <fieldset class="edit-row">
      <legend>{props.label}</legend>
      {props.children}
    </fieldset>
  );
}

/** What is found, in words. */
export function FindingText(props: { readonly finding: Finding }): JSX.Element {
  const told = (): { readonly text: string; readonly lang?: "en" } => {
    const { finding } = props;
    if (finding.grade === "warning") return phraseWords(finding.warning.found_as, finding.warning.found);
    const { found, expected } = errorWords(finding.error);
    const lang = found.lang ?? expected.lang;
    return { text: say().check.errorAt(found.text, expected.text), ...(lang === undefined ? {} : { lang }) };
  };
  return (
    <span class="edit-finding" data-grade={props.finding.grade}>
      <b>{props.finding.grade === "error" ? say().check.error : say().check.warning}</b> <span lang={told().lang}>{told().text}</span>
    </span>
  );
}


function Field(props: FieldProps & { readonly children: (id: string, bad: () => boolean, described: () => string | undefined) => JSX.Element }): JSX.Element {
  const id = createUniqueId();
  const found = (): readonly Finding[] => (props.path === undefined ? [] : props.editor.at(props.path));
  const bad = (): boolean => found().some(({ grade }) => grade === "error");
  return (
    <div class="edit-field">
      <label for={id}>{props.label}</label>
      {props.children(id, bad, () => (found().length > 0 ? `${id}-found` : undefined))}
      <Show when={props.path}>{(path) => <FoundHere editor={props.editor} path={path()} id={`${id}-found`} />}</Show>
    </div>
  );
}

function FoundHere(props: { readonly editor: Editor; readonly path: string; readonly id: string | undefined }): JSX.Element {
  return (
    <Show when={props.editor.at(props.path).length > 0}>
      <p class="edit-found" id={props.id}>
        <For each={props.editor.at(props.path)}>{(finding) => <FindingText finding={finding} />}</For>
      </p>
    </Show>
  );
}
