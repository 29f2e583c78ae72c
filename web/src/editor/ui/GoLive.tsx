/** The way into the store and into force: after a check, with what changes in sight, by a second act, and not under anybody's hand. */
import { createMemo, createResource, createSignal, For, Show, type JSX } from "solid-js";
import { activateScene, listScenes, replaceScene, uploadScene } from "../../api/http";
import { changesBetween } from "../../lib/sceneDiff";
import { troubleOf } from "../../lib/trouble";
import type { Live } from "../../live/live";
import { changeWords } from "../../ui/scenes/changeWords";
import type { Editor } from "../editor";
import { say } from "../words";

/** What came of it. */
export interface Outcome {
  readonly good: boolean;
  /** In the page's language, read where it is shown. */
  readonly text: () => string;
}

/** The confirmation. */
export function GoLive(props: { readonly live: Live; readonly editor: Editor; readonly author: string; readonly leave: () => void; readonly done: (outcome: Outcome) => void }): JSX.Element {
  const [scenes] = createResource(async () => {
    try {
      return await listScenes();
    } catch {
      // A new scene can be stored all the same.
      return [];
    }
  });
  const [target, setTarget] = createSignal<string | null>(null);
  const [working, setWorking] = createSignal(false);
  const chosen = (): string => target() ?? (props.editor.of() === null ? "new" : String(props.editor.of()?.id));
  const isPassed = (): boolean => props.editor.check().kind === "passed";
  const isBusy = createMemo(() => isUnderHand(props.live));
  const may = (key: string): boolean => props.live.identity.may(key);
  const mayStore = (): boolean => may(chosen() === "new" ? "POST /api/v1/scenes" : "PUT /api/v1/scenes/{id}");
  const changes = createMemo(() => {
    const active = props.live.scene()?.scene;
    return active === undefined ? [] : changesBetween(active, props.editor.scene()).map(changeWords);
  });
  let first!: HTMLHeadingElement;
  queueMicrotask(() => { first.focus(); });

  const store = async (makeLive: boolean): Promise<void> => {
    setWorking(true);
    const { name } = props.editor.scene();
    let stored: { readonly id: number; readonly version: number };
    try {
      stored = await (chosen() === "new" ? uploadScene(props.editor.text(), props.author) : replaceScene(Number(chosen()), props.editor.text(), props.author));
    } catch (error) {
      setWorking(false);
      props.done({ good: false, text: () => say().go.notStored(troubleOf(error)) });
      return;
    }
    const { id, version } = stored;
    props.editor.stored({ id, version });
    if (!makeLive) {
      setWorking(false);
      props.done({ good: true, text: () => say().go.stored(name, id, version) });
      return;
    }
    try {
      await activateScene(id, version, props.author);
      props.done({ good: true, text: () => say().go.live(name, id, version) });
    } catch (error) {
      props.done({ good: false, text: () => say().go.storedNotLive(id, version, troubleOf(error)) });
    } finally {
      setWorking(false);
    }
  };

  return (
    <div class="confirmation" role="alertdialog" aria-labelledby="go-title" aria-describedby="go-what" data-testid="go-live">
      <h3 id="go-title" tabindex="-1" ref={first}>{say().go.title}</h3>
      <div class="edit-field">
        <label for="go-as">{say().go.as}</label>
        <select id="go-as" data-testid="go-as" onChange={(event) => setTarget(event.currentTarget.value)}>
          <option value="new" selected={chosen() === "new"}>{say().go.asNew}</option>
          <For each={scenes() ?? []}>
            {(scene) => <option value={String(scene.id)} selected={chosen() === String(scene.id)}>{say().go.asVersion(scene.name, scene.id)}</option>}
          </For>
        </select>
      </div>
      <ul id="go-what">
        <li>{isPassed() ? say().go.passed : say().go.notPassed}</li>
        <Show when={props.editor.check().warnings.length > 0}><li>{say().go.secondLook(props.editor.check().warnings.length)}</li></Show>
        <li>{say().go.atOnce}</li>
        <li>{say().go.priors}</li>
        <Show when={isBusy()}><li class="bad" data-testid="go-not-now">{say().go.notNow}</li></Show>
        <Show when={!mayStore()}><li class="bad">{say().go.notForRole}</li></Show>
        <Show when={props.live.scene() !== null}>
          <li data-testid="go-changes">
            {changes().length > 0 ? say().go.changes : say().go.same}
            <ul>
              <For each={changes().slice(0, MOST_CHANGES)}>{(change) => <li>{change}</li>}</For>
              <Show when={changes().length > MOST_CHANGES}><li>… {changes().length - MOST_CHANGES}</li></Show>
            </ul>
          </li>
        </Show>
      </ul>
      <div class="edit-buttons">
        <button type="button" class="primary" data-testid="go-confirm" disabled={!isPassed() || isBusy() || working() || !mayStore() || !may("PUT /api/v1/scenes/{id}/activate")} onClick={() => void store(true)}>
          {working() ? say().go.working : say().go.confirm}
        </button>
        <button type="button" data-testid="go-store" disabled={!isPassed() || working() || !mayStore()} onClick={() => void store(false)}>
          {say().go.store}
        </button>
        <button type="button" class="quiet" data-testid="go-leave" onClick={() => { props.leave(); }}>
          {say().go.leave}
        </button>
      </div>
    </div>
  );
}

/** The machine follows people and somebody is there; or nobody knows. */
export function isUnderHand(live: Live): boolean {
  const snapshot = live.snapshot();
  if (snapshot === null || live.freshness().kind !== "live") return true;
  return ARMED.has(snapshot.mode) && snapshot.persons.length > 0;
}

const ARMED: ReadonlySet<string> = new Set(["following", "protective_stop"]);
const MOST_CHANGES = 12;
