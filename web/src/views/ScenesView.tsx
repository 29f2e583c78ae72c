/** The store of scenes: what there is, what is active, and a new one by file. */
import { createEffect, createSignal, For, Match, on, Show, Switch, type JSX } from "solid-js";
import { activateScene, listScenes } from "../api/http";
import type { SceneSummary } from "../api/types";
import { dayAndTime } from "../lib/format";
import type { Live } from "../live/live";
import type { Upload } from "./upload";

/** List, upload and activation. */
export function ScenesView(props: { readonly live: Live; readonly upload: Upload; readonly author: string }): JSX.Element {
  const [scenes, setScenes] = createSignal<readonly SceneSummary[] | null>(null);
  const [trouble, setTrouble] = createSignal<string | null>(null);
  const [asked, setAsked] = createSignal<number | null>(null);
  let chooser!: HTMLInputElement;

  const read = async (): Promise<void> => {
    try {
      setScenes(await listScenes());
      setTrouble(null);
    } catch (error) {
      setTrouble(`The list could not be read: ${messageOf(error)}`);
    }
  };
  createEffect(
    on([() => props.upload.state().kind, () => props.live.link().phase, () => props.live.scene()], () => void read()),
  );
  const isActive = (scene: SceneSummary): boolean => props.live.scene()?.id === scene.id;
  const activate = async (scene: SceneSummary): Promise<void> => {
    setAsked(null);
    try {
      await activateScene(scene.id, props.author);
      await read();
    } catch (error) {
      setTrouble(`${scene.name} was not activated: ${messageOf(error)}`);
    }
  };

  return (
    <div class="sheet">
      <h1>Scenes</h1>
      <section class="panel upload" aria-labelledby="upload-title">
        <h2 id="upload-title">Upload</h2>
        <p>Drag a scene’s JSON file anywhere onto this page, or choose it.</p>
        <input
          ref={chooser}
          type="file"
          accept=".json,application/json"
          class="unseen"
          tabindex="-1"
          aria-hidden="true"
          data-testid="scene-file"
          onChange={(event) => {
            const file = event.currentTarget.files?.[0];
            if (file !== undefined) void props.upload.send(file);
            // The same file, mended, can be chosen again.
            event.currentTarget.value = "";
          }}
        />
        <button type="button" data-testid="scene-choose" onClick={() => { chooser.click(); }}>
          Choose a file…
        </button>
        <UploadReport upload={props.upload} />
      </section>
      <section class="panel" aria-labelledby="stored-title">
        <h2 id="stored-title">Stored scenes</h2>
        <Show when={trouble()}>
          <p class="answer refused" role="alert" data-testid="scenes-trouble">
            {trouble()}
          </p>
        </Show>
        <Show when={scenes()?.length === 0}>
          <p class="empty">None is stored yet.</p>
        </Show>
        <table data-testid="scenes">
          <thead>
            <tr>
              <th scope="col">scene</th>
              <th scope="col">id</th>
              <th scope="col">version</th>
              <th scope="col">by</th>
              <th scope="col">changed</th>
              <th scope="col">
                <span class="unseen">Activation</span>
              </th>
            </tr>
          </thead>
          <tbody>
            <For each={scenes() ?? []}>
              {(scene) => (
                <tr data-testid={`scene-${scene.id}`} classList={{ predicted: isActive(scene) }}>
                  <th scope="row">{scene.name}</th>
                  <td>{scene.id}</td>
                  <td>{scene.version}</td>
                  <td>{scene.author || "–"}</td>
                  <td>{dayAndTime(scene.changed_at)}</td>
                  <td class="activation">
                    <Switch>
                      <Match when={isActive(scene)}>
                        <span class="tag" data-testid={`active-${scene.id}`}>
                          active
                        </span>
                      </Match>
                      <Match when={asked() === scene.id}>
                        <span>The column will follow “{scene.name}” at once.</span>
                        <button type="button" data-testid={`activate-confirm-${scene.id}`} onClick={() => void activate(scene)}>
                          Activate
                        </button>
                        <button type="button" class="quiet" onClick={() => setAsked(null)}>
                          Leave it
                        </button>
                      </Match>
                      <Match when={true}>
                        <button type="button" data-testid={`activate-${scene.id}`} onClick={() => setAsked(scene.id)}>
                          Activate…
                        </button>
                      </Match>
                    </Switch>
                  </td>
                </tr>
              )}
            </For>
          </tbody>
        </table>
      </section>
    </div>
  );
}

function UploadReport(props: { readonly upload: Upload }): JSX.Element {
  const sending = (): string | null => {
    const state = props.upload.state();
    return state.kind === "sending" ? state.file : null;
  };
  const accepted = (): string | null => {
    const state = props.upload.state();
    return state.kind === "accepted" ? `${state.file} is stored as scene ${state.id}, version ${state.version}.` : null;
  };
  const refused = () => {
    const state = props.upload.state();
    return state.kind === "refused" ? state : null;
  };
  return (
    <div role="status" data-testid="upload-report">
      <Show when={sending()}>
        <p>Sending {sending()}…</p>
      </Show>
      <Show when={accepted()}>
        <p class="answer" data-testid="upload-accepted">
          {accepted()}
        </p>
      </Show>
      <Show when={refused()}>
        {(state) => (
          <div class="answer refused" data-testid="upload-refused">
            <p>
              <b>{state().file} was refused.</b> {state().detail}
            </p>
            <Show when={state().errors.length > 0}>
              <table class="scene-errors">
                <thead>
                  <tr>
                    <th scope="col">path</th>
                    <th scope="col">line</th>
                    <th scope="col">column</th>
                    <th scope="col">found</th>
                    <th scope="col">expected</th>
                  </tr>
                </thead>
                <tbody>
                  <For each={state().errors}>
                    {(entry) => (
                      <tr data-testid="scene-error">
                        <th scope="row">
                          <code>{entry.path === "" ? "the document" : entry.path}</code>
                        </th>
                        <td>{entry.line ?? "–"}</td>
                        <td>{entry.column ?? "–"}</td>
                        <td>
                          <code>{entry.found}</code>
                        </td>
                        <td>{entry.expected}</td>
                      </tr>
                    )}
                  </For>
                </tbody>
              </table>
            </Show>
          </div>
        )}
      </Show>
    </div>
  );
}

function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
