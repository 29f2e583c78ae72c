/** The store of scenes: what there is, what is active, one of them in full, and a new one by file. */
import { createEffect, createMemo, createSignal, For, Match, on, Show, Switch, type JSX } from "solid-js";
import { listScenes } from "../api/http";
import type { SceneSummary } from "../api/types";
import { words } from "../i18n";
import { createAddress, wholeNumber } from "../lib/address";
import { dayAndTime } from "../lib/format";
import type { Live } from "../live/live";
import { DraftPanel } from "../ui/scenes/DraftPanel";
import { SceneDetail } from "../ui/scenes/SceneDetail";
import type { Upload } from "./upload";
import { troubleOf } from "../lib/trouble";

/** The list on the left; on the right a draft, or the scene that the address names. */
export function ScenesView(props: { readonly live: Live; readonly upload: Upload; readonly author: string }): JSX.Element {
  const address = createAddress();
  const [scenes, setScenes] = createSignal<readonly SceneSummary[] | null>(null);
  const [trouble, setTrouble] = createSignal<string | null>(null);
  const [search, setSearch] = createSignal("");
  let chooser!: HTMLInputElement;

  const read = async (): Promise<void> => {
    try {
      setScenes(await listScenes());
      setTrouble(null);
    } catch (error) {
      setTrouble(troubleOf(error));
    }
  };
  createEffect(on([() => props.upload.stored(), () => props.live.link().phase, () => props.live.scene()], () => void read()));
  const part = (): string | undefined => address().parts[0];
  const id = createMemo(() => wholeNumber(part()));
  const found = createMemo(() => {
    const asked = search().trim().toLowerCase();
    return (scenes() ?? []).filter((scene) => asked === "" || `${scene.name}\n${scene.author}\n${scene.id}`.toLowerCase().includes(asked));
  });
  const isMissing = (): boolean => part() !== undefined && (id() === null || (scenes() !== null && !scenes()?.some((scene) => scene.id === id())));
  const state = (scene: SceneSummary): string => {
    const active = props.live.scene();
    if (active === null || active.id !== scene.id) return words().records.scenes.notActive;
    return active.version === scene.version ? words().records.scenes.active : words().records.scenes.olderActive;
  };

  return (
    <div class="records" data-open={part() !== undefined || props.upload.draft() !== null ? "" : undefined}>
      <h1 class="unseen">{words().records.scenes.title}</h1>
      <div class="records-list">
        <section class="panel upload" aria-labelledby="upload-title">
          <h2 id="upload-title">{words().records.scenes.upload}</h2>
          <p>{words().records.scenes.howToUpload}</p>
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
              if (file !== undefined) {
                location.hash = "#/scenes";
                void props.upload.send(file);
              }
              // The same file, mended, can be chosen again.
              event.currentTarget.value = "";
            }}
          />
          <button type="button" data-testid="scene-choose" onClick={() => { chooser.click(); }}>
            {words().records.scenes.choose}
          </button>
          <p class="upload-editor"><a data-testid="open-editor" href="#/scenes/edit">{words().records.scenes.openEditor}</a></p>
          <Reports upload={props.upload} />
        </section>
        <section class="panel" aria-labelledby="stored-title">
          <h2 id="stored-title">{words().records.scenes.stored}</h2>
          <input type="search" data-testid="scene-search" aria-label={words().records.scenes.search} placeholder={words().records.scenes.search} value={search()} onInput={(event) => setSearch(event.currentTarget.value)} />
          <Show when={trouble()}>
            {(why) => (
              <p class="answer refused" role="alert" data-testid="scenes-trouble">
                {words().records.scenes.listFailed(why())}{" "}
                <button type="button" onClick={() => void read()}>{words().records.scenes.again}</button>
              </p>
            )}
          </Show>
          <Switch>
            <Match when={scenes() === null}>
              <Show when={trouble() === null}><p class="empty">{words().records.scenes.loading}</p></Show>
            </Match>
            <Match when={scenes()?.length === 0}>
              <p class="empty">{words().records.scenes.none}</p>
            </Match>
            <Match when={found().length === 0}>
              <p class="empty" data-testid="scenes-none-found">{words().records.scenes.noneFound(search())}</p>
            </Match>
            <Match when={true}>
              <div class="wide scrolls">
                <table data-testid="scenes">
                  <thead>
                    <tr>
                      <th scope="col">{words().records.scenes.scene}</th>
                      <th scope="col">{words().records.scenes.version}</th>
                      <th scope="col">{words().records.scenes.by}</th>
                      <th scope="col">{words().records.scenes.changed}</th>
                      <th scope="col">{words().records.scenes.state}</th>
                    </tr>
                  </thead>
                  <tbody>
                    <For each={found()}>
                      {(scene) => (
                        <tr data-testid={`scene-${scene.id}`} classList={{ open: scene.id === id() }}>
                          <th scope="row">
                            <a href={`#/scenes/${scene.id}`} aria-current={scene.id === id() ? "page" : undefined} data-testid={`scene-open-${scene.id}`}>{scene.name}</a>{" "}
                            <small>{scene.id}</small>
                          </th>
                          <td>{scene.version}</td>
                          <td>{scene.author || words().records.scenes.unnamed}</td>
                          <td>{dayAndTime(scene.changed_at)}</td>
                          <td classList={{ "is-active": props.live.scene()?.id === scene.id }}>{state(scene)}</td>
                        </tr>
                      )}
                    </For>
                  </tbody>
                </table>
              </div>
            </Match>
          </Switch>
        </section>
      </div>
      <div class="records-detail">
        <Show when={id() !== null && !isMissing() ? id() : null} keyed>
          {(open) => (
            <SceneDetail
              live={props.live}
              id={open}
              row={scenes()?.find((scene) => scene.id === open) ?? null}
              author={props.author}
              changed={() => void read()}
              edit={(file, text, of) => {
                props.upload.open(file, text, of);
                location.hash = "#/scenes";
              }}
            />
          )}
        </Show>
        <Show when={isMissing()}>
          <p class="panel answer refused" role="alert" data-testid="no-such-scene">{words().records.scenes.wrongAddress(part() ?? "")}</p>
        </Show>
        <Show when={part() === undefined}>
          <Show when={props.upload.draft()} fallback={<p class="empty records-pick">{words().records.scenes.pick}</p>}>
            {(draft) => <DraftPanel live={props.live} upload={props.upload} draft={draft()} scenes={scenes() ?? []} />}
          </Show>
        </Show>
      </div>
    </div>
  );
}

/** What became of the last file, and a draft that waits. */
function Reports(props: { readonly upload: Upload }): JSX.Element {
  return (
    <div role="status" data-testid="upload-report">
      <Show when={props.upload.stored()}>
        {(stored) => (
          <p class="answer good" data-testid="upload-accepted">
            {words().records.draft.stored(stored().file, stored().id, stored().version)}{" "}
            <a href={`#/scenes/${stored().id}`} data-testid="stored-open">{words().records.draft.open}</a>
          </p>
        )}
      </Show>
      <Show when={props.upload.unreadable()}>
        {(trouble) => <p class="answer refused">{words().records.draft.unreadable(trouble().file, trouble().detail)}</p>}
      </Show>
      <Show when={props.upload.former()}>
        {(former) => (
          <p class="answer">
            {words().records.draft.former(former().file)}{" "}
            <button type="button" class="quiet" data-testid="draft-back" onClick={() => { props.upload.bringBack(); }}>{words().records.draft.bringBack}</button>
          </p>
        )}
      </Show>
      <Show when={props.upload.draft()}>
        {(draft) => (
          <p class="answer">
            <a href="#/scenes" data-testid="draft-link">{words().records.draft.short(draft().file)}</a>
          </p>
        )}
      </Show>
    </div>
  );
}
