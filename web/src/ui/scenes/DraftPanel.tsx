/** A scene's text before it is stored: what the server finds in it, at its place, and where it is to go. */
import { createMemo, createSignal, For, Show, type JSX } from "solid-js";
import { words } from "../../i18n";
import type { SceneSummary } from "../../api/types";
import { errorWords, phraseWords } from "../../lib/phraseWords";
import { drawable, nameIn, placeErrors, type PlacedError } from "../../lib/sceneText";
import type { Live } from "../../live/live";
import type { Check, Draft, Upload } from "../../views/upload";
import { Arena } from "../Arena";
import { SceneEditor } from "./SceneEditor";

/** Editor, findings, preview and the way into the store. */
export function DraftPanel(props: {
  readonly live: Live;
  readonly upload: Upload;
  readonly draft: Draft;
  readonly scenes: readonly SceneSummary[];
}): JSX.Element {
  const placed = createMemo(() => placeErrors(props.draft.text, props.draft.check.errors));
  const [at, setAt] = createSignal(-1);
  const [chosen, setChosen] = createSignal<string | null>(null);
  const [discarding, setDiscarding] = createSignal(false);
  let goTo: (error: PlacedError) => void = () => undefined;

  const visit = (index: number): void => {
    const found = placed()[index];
    if (found === undefined) return;
    setAt(index);
    goTo(found);
  };
  const step = (by: 1 | -1): void => {
    const count = placed().length;
    if (count > 0) visit((Math.min(at(), count - 1) + by + (at() < 0 && by < 0 ? 1 : 0) + count) % count);
  };
  /** A text that names itself as a stored scene does is most likely its next version. */
  const guess = createMemo(() => {
    const name = nameIn(props.draft.text);
    return props.draft.of ?? props.scenes.find((scene) => scene.name === name)?.id ?? null;
  });
  const target = (): string => chosen() ?? (guess() === null ? "new" : String(guess()));
  const passed = (): Extract<Check, { kind: "passed" }> | null => (props.draft.check.kind === "passed" ? props.draft.check : null);
  const preview = createMemo(() => (passed() === null ? null : drawable(props.draft.text)));

  const says = (): string => {
    const { check } = props.draft;
    const say = words().records.draft;
    switch (check.kind) {
      case "checking":
        return say.checking;
      case "passed":
        return say.passed(check.name, check.objects);
      case "refused":
        return say.refused(check.errors.length);
      case "failed":
        return say.failed(check.detail);
    }
  };
  const bad = (): boolean => props.draft.check.kind === "refused" || props.draft.check.kind === "failed";

  return (
    <section class="panel draft" aria-labelledby="draft-title" data-testid="draft">
      <h2 id="draft-title">{words().records.draft.title(props.draft.file)}</h2>
      <div class="draft-line">
        <p role="status" class="draft-says" classList={{ bad: bad(), good: passed() !== null }} data-testid={props.draft.check.kind === "refused" ? "upload-refused" : "draft-says"}>
          {says()}
        </p>
        <Show when={placed().length > 0}>
          <button type="button" data-testid="error-previous" onClick={() => { step(-1); }}>
            ↑ {words().records.draft.previous}
          </button>
          <button type="button" data-testid="error-next" onClick={() => { step(1); }}>
            ↓ {words().records.draft.next}
          </button>
        </Show>
        <button type="button" data-testid="scene-check" onClick={() => void props.upload.check()}>
          {words().records.draft.check}
        </button>
      </div>
      <div class="draft-body">
        <SceneEditor
          text={props.draft.text}
          errors={placed()}
          edit={props.upload.edit}
          step={step}
          reach={(way) => { goTo = way; }}
          describedBy="draft-keys"
        />
        <div class="draft-aside">
          <Show when={placed().length > 0}>
            <h3 id="draft-errors">{words().records.draft.errors}</h3>
            <ol class="draft-errors" aria-labelledby="draft-errors">
              <For each={placed()}>
                {(entry, index) => (
                  <li>
                    <button type="button" data-testid="scene-error" aria-current={at() === index() ? "true" : undefined} onClick={() => { visit(index()); }}>
                      <span class="error-place">
                        {entry.line === null ? words().records.draft.noPlace : words().records.draft.at(entry.line, entry.error.column ?? 1)}
                      </span>
                      <code>{entry.error.path}</code>
                      <span>
                        {words().records.draft.found} <code lang={errorWords(entry.error).found.lang}>{errorWords(entry.error).found.text}</code>,{" "}
                        {words().records.draft.expected} <b lang={errorWords(entry.error).expected.lang}>{errorWords(entry.error).expected.text}</b>
                      </span>
                    </button>
                  </li>
                )}
              </For>
            </ol>
          </Show>
          <Show when={passed()?.warnings.length}>
            <h3 id="draft-warnings">{words().records.draft.warnings}</h3>
            <ul class="draft-warnings" aria-labelledby="draft-warnings" data-testid="scene-warnings">
              <For each={passed()?.warnings ?? []}>
                {(warning) => (
                  <li>
                    <span class="error-place">
                      {warning.line === null ? words().records.draft.noPlace : words().records.draft.at(warning.line, warning.column ?? 1)}
                    </span>{" "}
                    <code>{warning.path}</code> <span lang={phraseWords(warning.found_as, warning.found).lang}>{phraseWords(warning.found_as, warning.found).text}</span>
                  </li>
                )}
              </For>
            </ul>
          </Show>
          <Show when={preview()}>
            {(scene) => (
              <div class="scene-preview">
                <Arena
                  testId="draft-preview"
                  label={() => words().records.scenes.preview}
                  picture={() => ({ state: null, scene: scene(), shape: props.live.server()?.shape ?? null })}
                />
              </div>
            )}
          </Show>
        </div>
      </div>
      <small id="draft-keys">{words().records.draft.keys}</small>
      <Show when={props.draft.trouble}>
        {(why) => (
          <p class="answer refused" role="alert" data-testid="not-stored">
            {words().records.draft.notStored(why())}
          </p>
        )}
      </Show>
      <div class="draft-line">
        <label>
          {words().records.draft.storeAs}{" "}
          <select data-testid="store-as" value={target()} onChange={(event) => setChosen(event.currentTarget.value)}>
            <option value="new">{words().records.draft.asNew}</option>
            <For each={props.scenes}>
              {(scene) => (
                <option value={String(scene.id)} selected={target() === String(scene.id)}>
                  {words().records.draft.asVersion(scene.name, scene.id)}
                </option>
              )}
            </For>
          </select>
        </label>
        <button
          type="button"
          data-testid="scene-store"
          disabled={passed() === null || props.draft.storing}
          aria-describedby="draft-keys"
          onClick={() => void props.upload.store(target() === "new" ? null : Number(target()))}
        >
          {props.draft.storing ? words().records.draft.storing : words().records.draft.store}
        </button>
        <span class="draft-end">
          <Show
            when={discarding()}
            fallback={
              <button type="button" class="quiet" data-testid="draft-discard" onClick={() => { if (props.draft.edited) setDiscarding(true); else props.upload.discard(); }}>
                {words().records.draft.discard}
              </button>
            }
          >
            <span>{words().records.draft.discardSure}</span>
            <button type="button" class="quiet" data-testid="draft-discard-sure" onClick={() => { props.upload.discard(); }}>
              {words().records.draft.discard}
            </button>
            <button type="button" class="quiet" onClick={() => setDiscarding(false)}>
              {words().records.draft.keep}
            </button>
          </Show>
        </span>
      </div>
    </section>
  );
}
