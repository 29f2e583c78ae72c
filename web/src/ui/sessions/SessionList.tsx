/** The sessions that the server knows, newest first, with search and older ones on demand. */
import { createEffect, createSignal, For, Match, on, onCleanup, Show, Switch, type JSX } from "solid-js";
import { listSessions } from "../../api/http";
import type { Session } from "../../api/types";
import { words } from "../../i18n";
import { dayAndTime, decimal, span } from "../../lib/format";
import type { Live } from "../../live/live";
import { troubleOf } from "../../lib/trouble";

/** The list. */
export function SessionList(props: { readonly live: Live }): JSX.Element {
  const [sessions, setSessions] = createSignal<readonly Session[] | null>(null);
  const [more, setMore] = createSignal(false);
  const [trouble, setTrouble] = createSignal<string | null>(null);
  const [search, setSearch] = createSignal("");
  /** What the shown list was searched for. */
  const [searched, setSearched] = createSignal("");
  let latest = 0;
  let timer: ReturnType<typeof setTimeout> | undefined;
  onCleanup(() => { clearTimeout(timer); });

  const read = async (before: number | null): Promise<void> => {
    clearTimeout(timer);
    latest += 1;
    const mine = latest;
    const asked = search().trim();
    try {
      const found = await listSessions({ search: asked, before, limit: PAGE });
      if (mine !== latest) return;
      setSessions((known) => (before === null ? found : [...(known ?? []), ...found]));
      setMore(found.length === PAGE);
      setSearched(asked);
      setTrouble(null);
    } catch (error) {
      if (mine === latest) setTrouble(troubleOf(error));
    }
  };
  createEffect(on([() => props.live.link().phase, () => props.live.snapshot()?.session_id], () => void read(null)));

  return (
    <div class="sheet sessions-sheet">
      <h1>{words().records.sessions.title}</h1>
      <section class="panel" aria-label={words().records.sessions.title}>
        <label class="search-line">
          {words().records.sessions.search}
          <input
            type="search"
            data-testid="session-search"
            placeholder={words().records.sessions.searchHint}
            maxlength="200"
            value={search()}
            onInput={(event) => {
              setSearch(event.currentTarget.value);
              clearTimeout(timer);
              timer = setTimeout(() => void read(null), SEARCH_AFTER_MILLIS);
            }}
          />
        </label>
        <Show when={trouble()}>
          {(why) => (
            <p class="answer refused" role="alert">
              {words().records.sessions.listFailed(why())}{" "}
              <button type="button" onClick={() => void read(null)}>{words().records.replay.again}</button>
            </p>
          )}
        </Show>
        <Switch>
          <Match when={sessions() === null}>
            <Show when={trouble() === null}><p class="empty">{words().records.sessions.loading}</p></Show>
          </Match>
          <Match when={sessions()?.length === 0}>
            <p class="empty" role="status" data-testid="sessions-empty">{searched() === "" ? words().records.sessions.none : words().records.sessions.noneFound(searched())}</p>
          </Match>
          <Match when={true}>
            <div class="wide scrolls">
              <table data-testid="sessions">
                <thead>
                  <tr>
                    <th scope="col">{words().records.sessions.session}</th>
                    <th scope="col">{words().records.sessions.began}</th>
                    <th scope="col" class="number">{words().records.sessions.lasted}</th>
                    <th scope="col" class="number">{words().records.sessions.served}</th>
                    <th scope="col" class="number">{words().records.sessions.stops}</th>
                    <th scope="col">{words().records.sessions.ended}</th>
                    <th scope="col">{words().records.sessions.scene}</th>
                    <th scope="col" class="number">{words().records.sessions.size}</th>
                  </tr>
                </thead>
                <tbody>
                  <For each={sessions() ?? []}>
                    {(session) => (
                      <tr data-testid={`session-${session.id}`}>
                        <th scope="row">
                          <a href={`#/sessions/${session.id}`} aria-label={words().records.sessions.open(session.id)} data-testid={`session-open-${session.id}`}>{session.id}</a>
                        </th>
                        <td>{dayAndTime(session.started_at)}</td>
                        <td class="number">{session.length_secs === null ? words().records.replay.nothing : span(session.length_secs)}</td>
                        <td class="number">{words().records.sessions.servedOf(session.reaches_served, session.reaches)}</td>
                        <td class="number">{session.stops}</td>
                        <td>{session.ended_at === null ? <b class="is-active">{words().records.sessions.running}</b> : howEnded(session.how)}</td>
                        <td class="scene-name">{session.scene}</td>
                        <td class="number">{sizeOf(session)}</td>
                      </tr>
                    )}
                  </For>
                </tbody>
              </table>
            </div>
            <Show when={more()}>
              <button type="button" data-testid="sessions-older" onClick={() => void read(sessions()?.at(-1)?.id ?? null)}>
                {words().records.sessions.older}
              </button>
            </Show>
          </Match>
        </Switch>
      </section>
    </div>
  );
}

/** How a session ended, in words. */
export function howEnded(how: string | null): string {
  const known: Readonly<Record<string, string | undefined>> = words().records.sessions.how;
  return how === null ? words().records.replay.nothing : (known[how] ?? how);
}

/** How large its recording is, in words. */
export function sizeOf(session: Session): string {
  const say = words().records.sessions;
  if (session.recording_removed_at !== null) return say.removed;
  if (session.recorded_frames === 0) return say.noRecording;
  return session.recording_bytes < 1e6 ? say.kilobytes(decimal(session.recording_bytes / 1e3, 0)) : say.megabytes(decimal(session.recording_bytes / 1e6, 1));
}

const PAGE = 50;
/** A pause in typing, ms. */
const SEARCH_AFTER_MILLIS = 250;
