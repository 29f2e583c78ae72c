/** The scene editor: what there is on the left, the room or the states in the middle, the properties of what is chosen on the right. */
import { createEffect, createSignal, For, Match, on, onCleanup, onMount, Show, Switch, type JSX } from "solid-js";
import { readScene as fetchScene } from "../api/http";
import { editorOf, type Editor } from "../editor/editor";
import { readScene } from "../editor/readScene";
import { inOrder } from "../editor/order";
import { emptyScene } from "../editor/scene";
import type { Selection } from "../editor/selection";
import { AnywhereForm, VariablesForm } from "../editor/ui/ActsFields";
import { CheckLine, Findings } from "../editor/ui/Findings";
import { GoLive, type Outcome } from "../editor/ui/GoLive";
import { GraphEditor } from "../editor/ui/GraphEditor";
import { PlanEditor } from "../editor/ui/PlanEditor";
import { StateForm } from "../editor/ui/StateForm";
import { SceneForm, ThingForm } from "../editor/ui/ThingForm";
import { ThingList } from "../editor/ui/ThingList";
import { say } from "../editor/words";
import { wholeNumber } from "../lib/address";
import { fileNameOf } from "../lib/sceneText";
import { writes } from "../lib/shortcuts";
import { troubleOf } from "../lib/trouble";
import type { Live } from "../live/live";
import { Comparison } from "../ui/scenes/Comparison";
import "../style/editor.css";
import type { Upload } from "./upload";

type Tab = "room" | "states" | "changes";

/** The view; `at` is what follows `#/scenes/edit`: a scene's number and version to begin with. */
export function EditorView(props: { readonly live: Live; readonly upload: Upload; readonly author: string; readonly at: readonly string[] }): JSX.Element {
  const editor = (): Editor => editorOf(props.author, props.live.server()?.shape.travel_m ?? null, say().newName);
  const [tab, setTab] = createSignal<Tab>("room");
  const [going, setGoing] = createSignal(false);
  const [outcome, setOutcome] = createSignal<Outcome | null>(null);
  const [broken, setBroken] = createSignal<{ readonly file: string; readonly text: string } | null>(null);
  let chooser!: HTMLInputElement;
  let form!: HTMLDivElement;

  const chose = (selection: Selection): void => {
    editor().select(selection);
    if (selection.kind === "thing") setTab("room");
    else if (selection.kind !== "scene") setTab("states");
    form.scrollTop = 0;
  };
  const told = (good: boolean, text: () => string): void => { setOutcome({ good, text }); };
  /** A version of the store, asked for by the address. */
  createEffect(
    on(
      () => props.at.join("/"),
      () => {
        const [id, version] = [wholeNumber(props.at[0]), wholeNumber(props.at[1])];
        if (id === null || version === null) return;
        void fetchScene(id, version)
          .then((scene) => {
            editor().load(scene, { id, version });
            told(true, () => say().loaded(scene.name, version));
          })
          .catch((error: unknown) => { told(false, () => say().failed(troubleOf(error))); })
          .finally(() => { history.replaceState(null, "", "#/scenes/edit"); });
      },
    ),
  );
  const importFile = async (file: File): Promise<void> => {
    setBroken(null);
    try {
      const text = await file.text();
      const read = readScene(text);
      if (read.kind === "scene") {
        editor().load(read.scene, null);
        told(true, () => say().imported(file.name));
      } else {
        told(false, () => read.kind === "no_json" ? say().noJson(file.name) : say().broken(file.name, read.path));
        setBroken({ file: file.name, text });
      }
    } catch (error) {
      told(false, () => say().failed(troubleOf(error)));
    }
  };
  const exportFile = (): void => {
    const { name } = editor().scene();
    const address = URL.createObjectURL(new Blob([editor().text()], { type: "application/json" }));
    Object.assign(document.createElement("a"), { href: address, download: fileNameOf(name, (editor().of()?.version ?? 0) + 1) }).click();
    // The browser reads the address after the click.
    setTimeout(() => { URL.revokeObjectURL(address); }, 10_000);
  };
  /** Where somebody types, undo is the field's own. */
  const keys = (event: KeyboardEvent): void => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey || writes(event.target)) return;
    const key = event.key.toLowerCase();
    if (key === "z" && !event.shiftKey) editor().undo();
    else if (key === "y" || (key === "z" && event.shiftKey)) editor().redo();
    else return;
    event.preventDefault();
  };
  onMount(() => { window.addEventListener("keydown", keys); });
  onCleanup(() => { window.removeEventListener("keydown", keys); });
  const active = () => props.live.scene();

  return (
    <div class="editor" data-testid="editor">
      <h1 class="unseen">{say().title}</h1>
      <div class="panel edit-bar">
        <div class="edit-buttons" role="group" aria-label={say().tabs}>
          <For each={["room", "states", "changes"] as const}>
            {(name) => (
              <button type="button" class="toggle" data-testid={`tab-${name}`} aria-pressed={tab() === name} onClick={() => setTab(name)}>
                {say()[name]}
              </button>
            )}
          </For>
        </div>
        <div class="edit-buttons">
          <button type="button" data-testid="editor-undo" disabled={!editor().canUndo()} aria-keyshortcuts="Control+Z" onClick={() => { editor().undo(); }}>↶ {say().undo}</button>
          <button type="button" data-testid="editor-redo" disabled={!editor().canRedo()} aria-keyshortcuts="Control+Y" onClick={() => { editor().redo(); }}>↷ {say().redo}</button>
        </div>
        <div class="edit-buttons">
          <button type="button" data-testid="editor-new" onClick={() => { editor().load(emptyScene(say().newName, props.live.server()?.shape.travel_m ?? null), null); }}>{say().newScene}</button>
          <input
            ref={chooser}
            type="file"
            accept=".json,application/json"
            class="unseen"
            tabindex="-1"
            aria-hidden="true"
            data-testid="editor-file"
            onChange={(event) => {
              const file = event.currentTarget.files?.[0];
              if (file !== undefined) void importFile(file);
              event.currentTarget.value = "";
            }}
          />
          <button type="button" data-testid="editor-import" onClick={() => { chooser.click(); }}>{say().importFile}</button>
          <button type="button" data-testid="editor-export" onClick={exportFile}>{say().exportFile}</button>
          <a href="#/scenes">{say().back}</a>
        </div>
        <small class="edit-kept" data-testid="editor-kept">
          {editor().isKept() ? say().kept : say().notKept} {originWords(editor())}
        </small>
        <CheckLine editor={editor()} />
        <button type="button" class="primary" data-testid="editor-go" aria-expanded={going()} onClick={() => { setOutcome(null); setGoing(true); }}>
          {say().go.open}
        </button>
      </div>
      <Show when={outcome()}>
        {(last) => (
          <p class="answer" classList={{ refused: !last().good, good: last().good }} role={last().good ? "status" : "alert"} data-testid="editor-outcome">
            {last().text()}{" "}
            <Show when={broken()}>
              {(file) => (
                <button
                  type="button"
                  class="quiet"
                  onClick={() => {
                    props.upload.open(file().file, file().text, null);
                    location.hash = "#/scenes";
                  }}
                >
                  {say().asText}
                </button>
              )}
            </Show>
          </p>
        )}
      </Show>
      <Show when={going()}>
        <GoLive
          live={props.live}
          editor={editor()}
          author={props.author}
          leave={() => setGoing(false)}
          done={(result) => {
            setGoing(false);
            setOutcome(result);
          }}
        />
      </Show>
      <div class="edit-body">
        <ThingList editor={editor()} chose={chose} />
        <div class="edit-middle">
          <Switch>
            <Match when={tab() === "room"}>
              <PlanEditor editor={editor()} shape={props.live.server()?.shape ?? null} chose={chose} />
            </Match>
            <Match when={tab() === "states"}>
              <GraphEditor editor={editor()} chose={chose} />
            </Match>
            <Match when={tab() === "changes"}>
              <section class="panel edit-changes scrolls" aria-labelledby="edit-changes-title" data-testid="editor-changes" tabindex="0">
                <h2 id="edit-changes-title">{say().changed.title}</h2>
                <Show when={active()} fallback={<p class="empty">{say().changed.none}</p>}>
                  {(live) => (
                    <>
                      <p class="empty">{say().changed.live(live().scene.name, live().id, live().version)}</p>
                      <Comparison before={inOrder(live().scene)} after={editor().scene()} />
                    </>
                  )}
                </Show>
              </section>
            </Match>
          </Switch>
          <Show when={editor().findings().length > 0}>
            <Findings editor={editor()} chose={chose} />
          </Show>
        </div>
        <div class="edit-right scrolls" ref={form} tabindex="0" role="group" aria-label={say().properties}>
          <div class="panel">
            <Properties editor={editor()} />
          </div>
        </div>
      </div>
    </div>
  );
}

/** The form of what is chosen. */
function Properties(props: { readonly editor: Editor }): JSX.Element {
  const thing = () => {
    const selection = props.editor.selection();
    return selection.kind === "thing" ? selection : null;
  };
  const state = () => {
    const selection = props.editor.selection();
    return selection.kind === "state" ? selection : null;
  };
  return (
    <Switch fallback={<SceneForm editor={props.editor} />}>
      <Match when={thing()}>{(chosen) => <ThingForm editor={props.editor} list={chosen().list} index={chosen().index} />}</Match>
      <Match when={state()}>{(chosen) => <StateForm editor={props.editor} index={chosen().index} />}</Match>
      <Match when={props.editor.selection().kind === "variables"}><VariablesForm editor={props.editor} /></Match>
      <Match when={props.editor.selection().kind === "anywhere"}><AnywhereForm editor={props.editor} /></Match>
    </Switch>
  );
}

function originWords(editor: Editor): string {
  const of = editor.of();
  return of === null ? say().beganEmpty : say().beganAs(of.id, of.version);
}
