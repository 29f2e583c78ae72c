/** What everybody must see at once: no connection, old values, and why the machine is stopped. */
import { createMemo, Show, type JSX } from "solid-js";
import type { StopCause } from "../api/types";
import { words } from "../i18n";
import type { Live } from "../live/live";
import { modeWords, span } from "../lib/format";
import { said } from "../lib/reasonWords";
import { Said } from "./Said";

/** The bars under the header. A stop since the very start is one that the last run left latched. */
export function Banners(props: { readonly live: Live }): JSX.Element {
  const age = createMemo(() => {
    const freshness = props.live.freshness();
    return freshness.kind === "stale" ? freshness.ageMillis : null;
  });
  // Whoever is asked for a token is told so by the form.
  const waiting = createMemo(() => props.live.freshness().kind === "none" && !props.live.identity.mustSignIn());
  const stopped = createMemo(() => props.live.snapshot()?.stop ?? null);

  return (
    <>
      <Show when={age() !== null}>
        <div class="bar bar-stale" role="alert" data-testid="stale-banner">
          <b>{words().shell.banners.stale}</b>
          <span aria-hidden="true">
            {words().shell.banners.staleFor} <span data-testid="stale-age">{span((age() ?? 0) / 1000)}</span>{" "}
            {words().shell.banners.old}{" "}
            {linkWords(props.live)}
          </span>
          <button type="button" class="quiet bar-end" onClick={() => { props.live.connectNow(); }}>
            {words().shell.banners.connectNow}
          </button>
        </div>
      </Show>
      <Show when={waiting()}>
        <div class="bar bar-stale" role="status" data-testid="no-state-banner">
          <b>{words().shell.banners.noState}</b>
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
            <Said testId="stop-reason" of={said(stop().why, stop().reason)} />
            <span class="clears">
              {words().shell.banners.clearsWhen}{" "}
              <Said testId="stop-clears-when" of={clearsWhen(stop())} />{" "}
              <a href={`#/help/stop/${stop().since_micros === 0 ? "restart" : stop().rule}`} data-testid="stop-help">
                {words().shell.banners.whatToDo}
              </a>
            </span>
          </div>
        )}
      </Show>
    </>
  );
}

function clearsWhen({ rule, clears_when }: StopCause): ReturnType<typeof said> {
  const known: Readonly<Record<string, string>> = words().shell.banners.clears;
  const text = known[rule];
  return text === undefined ? { text: clears_when, lang: "en" } : { text };
}

function linkWords(live: Live): string {
  const link = live.link();
  const say = words().shell.banners;
  switch (link.phase) {
    case "open":
      return say.openButSilent;
    case "connecting":
      return link.attempt === 0 ? say.connecting : say.connectingAgain(link.attempt);
    case "waiting":
      return say.waiting(link.attempt, span(Math.max(0, link.retryAtMillis - live.nowMillis()) / 1000));
  }
}
