/** What is looked at before the machine is armed: the same list for everybody at a dashboard, with who ticked what. */
import { createEffect, createMemo, createSignal, For, on, onCleanup, Show, type JSX } from "solid-js";
import { readChecklist, tickItem } from "../../api/http";
import type { ChecklistNow } from "../../api/types";
import { words } from "../../i18n";
import { timeOfDay } from "../../lib/format";
import { troubleOf } from "../../lib/trouble";
import type { Live } from "../../live/live";

/** The panel. */
export function ChecklistPanel(props: { readonly live: Live; readonly author: string }): JSX.Element {
  const say = () => words().scenario.checklist;
  const [list, setList] = createSignal<ChecklistNow | null>(null);
  const [trouble, setTrouble] = createSignal<string | null>(null);
  const [busy, setBusy] = createSignal(false);
  let newest = 0;
  onCleanup(() => { newest = -1; });
  const take = async (from: () => Promise<ChecklistNow>): Promise<void> => {
    if (newest < 0) return;
    newest += 1;
    const mine = newest;
    try {
      const found = await from();
      if (mine !== newest) return;
      setList(found);
      setTrouble(null);
    } catch (error) {
      if (mine === newest) setTrouble(troubleOf(error));
    }
  };
  let latest: Promise<void> = Promise.resolve();
  const ask = (from: () => Promise<ChecklistNow>): Promise<void> => (latest = take(from));
  // Somebody ticked, a session ended, another scene is played: the server says so by an event.
  const changed = createMemo(() => props.live.events().find(({ kind }) => CHANGES.has(kind)));
  createEffect(on([changed, () => props.live.link().phase], () => void ask(readChecklist)));
  /** Until the newest word of the server is here: an event may have it asked once more meanwhile, and then that answer counts. */
  const tick = async (item: number, ticked: boolean): Promise<void> => {
    setBusy(true);
    let awaited = ask(() => tickItem(item, ticked, props.author));
    await awaited;
    while (awaited !== latest) {
      awaited = latest;
      await awaited;
    }
    setBusy(false);
  };
  const done = (): number => list()?.items.filter(({ ticked_by }) => ticked_by !== null).length ?? 0;
  const may = (): boolean => props.live.identity.may("PUT /api/v1/checklist/{item}");
  const textOf = (id: string | null, text: string): { readonly text: string; readonly lang?: string } => {
    const usual: Readonly<Record<string, string>> = say().usual;
    const known = id === null ? undefined : usual[id];
    return { text: known ?? text };
  };
  return (
    <section class="panel" aria-labelledby="scenario-checklist">
      <h2 id="scenario-checklist">{say().title}</h2>
      <Show when={trouble()}>{(why) => <p class="answer refused" role="alert">{say().failed(why())}</p>}</Show>
      <Show when={list()}>
        {(now) => (
          <>
            <p role="status" data-testid="checklist-done" classList={{ warn: done() < now().items.length }}>{say().done(done(), now().items.length)}</p>
            <ul class="checklist" data-testid="checklist">
              <For each={now().items.map((_, index) => index)}>
                {(index) => (
                  <Show when={now().items[index]}>
                    {(item) => (
                      <li>
                        <label>
                          <input
                            type="checkbox"
                            data-testid={`check-${index}`}
                            checked={item().ticked_by !== null}
                            disabled={!may() || busy()}
                            onChange={(event) => {
                              const box = event.currentTarget;
                              void tick(index, box.checked).then(() => {
                                // The server's word counts, not the browser's.
                                box.checked = list()?.items[index]?.ticked_by != null;
                              });
                            }}
                          />{" "}
                          {textOf(item().id, item().text).text}
                        </label>
                        <Show when={item().ticked_by}>{(by) => <small>{say().by(by(), timeOfDay(item().ticked_at ?? ""))}</small>}</Show>
                      </li>
                    )}
                  </Show>
                )}
              </For>
            </ul>
            <small>{now().of_scene ? say().ofScene : say().usualList} {say().until}</small>
          </>
        )}
      </Show>
    </section>
  );
}

const CHANGES: ReadonlySet<string> = new Set(["checklist_ticked", "scene_activated", "mode_changed"]);
