/** What everybody must see at once: no connection, old values, and why the machine is stopped. */
import { createMemo, Show, type JSX } from "solid-js";
import type { Live } from "../live/live";
import { modeWords, span } from "../lib/format";

/** The bars under the header. */
export function Banners(props: { readonly live: Live }): JSX.Element {
  const age = createMemo(() => {
    const freshness = props.live.freshness();
    return freshness.kind === "stale" ? freshness.ageMillis : null;
  });
  const waiting = createMemo(() => props.live.freshness().kind === "none");
  const stopped = createMemo(() => props.live.snapshot()?.stop ?? null);

  return (
    <>
      <Show when={age() !== null}>
        <div class="bar bar-stale" role="alert" data-testid="stale-banner">
          <b>STALE</b>
          <span aria-hidden="true">
            Nothing here is live: the last state is <span data-testid="stale-age">{span((age() ?? 0) / 1000)}</span> old.{" "}
            {linkWords(props.live)}
          </span>
          <button type="button" class="quiet bar-end" onClick={() => { props.live.connectNow(); }}>
            Connect now
          </button>
        </div>
      </Show>
      <Show when={waiting()}>
        <div class="bar bar-stale" role="status" data-testid="no-state-banner">
          <b>NO STATE YET</b>
          <span>{linkWords(props.live)}</span>
        </div>
      </Show>
      <Show when={stopped()}>
        {(stop) => (
          <div
            class="bar bar-stop fades"
            classList={{ protective: props.live.snapshot()?.mode === "protective_stop" }}
            role="alert"
            data-testid="stop-cause"
          >
            <b>
              {modeWords(props.live.snapshot()?.mode ?? "latched_stop")}, {stop().rule}:
            </b>
            <span data-testid="stop-reason">{stop().reason}</span>
            <span class="clears">
              Clears when: <span data-testid="stop-clears-when">{stop().clears_when}</span>
            </span>
          </div>
        )}
      </Show>
    </>
  );
}

function linkWords(live: Live): string {
  const link = live.link();
  switch (link.phase) {
    case "open":
      return "The connection is open, but no new state comes.";
    case "connecting":
      return link.attempt === 0 ? "Connecting to the server." : `Connecting again, attempt ${link.attempt}.`;
    case "waiting":
      return `No connection to the server; attempt ${link.attempt} in ${span(Math.max(0, link.retryAtMillis - live.nowMillis()) / 1000)}.`;
  }
}
