/** The sessions that the server has recorded. */
import { createEffect, createSignal, For, on, Show, type JSX } from "solid-js";
import { listSessions } from "../api/http";
import type { SessionSummary } from "../api/types";
import { dayAndTime, span } from "../lib/format";
import type { Live } from "../live/live";

/** The list, newest first. */
export function SessionsView(props: { readonly live: Live }): JSX.Element {
  const [sessions, setSessions] = createSignal<readonly SessionSummary[]>([]);
  const [trouble, setTrouble] = createSignal<string | null>(null);
  const read = async (): Promise<void> => {
    try {
      setSessions(await listSessions());
      setTrouble(null);
    } catch (error) {
      setTrouble(`The list could not be read: ${error instanceof Error ? error.message : String(error)}`);
    }
  };
  createEffect(on([() => props.live.link().phase, () => props.live.snapshot()?.session_id], () => void read()));
  return (
    <div class="sheet">
      <h1>Sessions</h1>
      <section class="panel" aria-label="Sessions">
        <Show when={trouble()}>
          <p class="answer refused" role="alert">
            {trouble()}
          </p>
        </Show>
        <Show when={sessions().length === 0 && trouble() === null}>
          <p class="empty">No session yet.</p>
        </Show>
        <table data-testid="sessions">
          <thead>
            <tr>
              <th scope="col">session</th>
              <th scope="col">began</th>
              <th scope="col">lasted</th>
              <th scope="col">ended by</th>
              <th scope="col">scene</th>
            </tr>
          </thead>
          <tbody>
            <For each={sessions()}>
              {(session) => (
                <tr data-testid={`session-${session.id}`}>
                  <th scope="row">{session.id}</th>
                  <td>{dayAndTime(session.started_at)}</td>
                  <td>
                    {session.ended_at === null
                      ? "running"
                      : span((Date.parse(session.ended_at) - Date.parse(session.started_at)) / 1000)}
                  </td>
                  <td>{session.how?.replaceAll("_", " ") ?? "–"}</td>
                  <td>{session.scene}</td>
                </tr>
              )}
            </For>
          </tbody>
        </table>
      </section>
    </div>
  );
}
