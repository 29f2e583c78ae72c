/** What became of the last press of the stop; never says stopped before the server did. */
import { createSignal, Match, Show, Switch, type JSX } from "solid-js";
import { words } from "../i18n";
import type { StopState, StopTrouble } from "../live/stop";
import { millis, span } from "../lib/format";
import { said, type Said as Sentence } from "../lib/reasonWords";
import { troubleOf } from "../lib/trouble";
import { Said } from "./Said";

/** One line across the page, until it is put away or another press follows. */
export function StopReport(props: { readonly stop: StopState; readonly nowMillis: number }): JSX.Element {
  const [putAway, setPutAway] = createSignal<number | null>(null);
  const pending = (): Extract<StopState, { kind: "pending" }> | null =>
    props.stop.kind === "pending" ? props.stop : null;
  const acknowledged = (): Extract<StopState, { kind: "acknowledged" }> | null =>
    props.stop.kind === "acknowledged" && props.stop.pressedAtMillis !== putAway() ? props.stop : null;

  return (
    <div role="alert" data-testid="stop-report">
      <Switch>
        <Match when={pending()}>
          {(state) => (
            <div class="bar bar-pending" data-testid="stop-pending">
              <b>{words().shell.stop.notAcknowledged}</b>
              <span aria-hidden="true">
                {words().shell.stop.sincePress(span(Math.max(0, props.nowMillis - state().pressedAtMillis) / 1000), state().sent)}
                <Show when={state().trouble}>{(trouble) => <>; <Said of={troubleWords(trouble())} /></>}</Show>
              </span>
              <b class="bar-end">{words().shell.stop.wired}</b>
            </div>
          )}
        </Match>
        <Match when={acknowledged()}>
          {(state) => (
            <div class="bar bar-acknowledged" data-testid="stop-acknowledged" data-lane={state().lane}>
              <b>{words().shell.stop.acknowledged(millis(state().acknowledgedMillis))}</b>
              <span>
                {reached(state().toDriveMicros)}, {words().shell.stop.by(state().lane === "websocket" ? "WebSocket" : "HTTP")}
              </span>
              <Show when={state().sent > 1}>
                <span>{words().shell.stop.sentTimes(state().sent)}</span>
              </Show>
              <button type="button" class="quiet bar-end" onClick={() => setPutAway(state().pressedAtMillis)}>
                {words().shell.stop.putAway}
              </button>
            </div>
          )}
        </Match>
      </Switch>
    </div>
  );
}

function troubleWords(trouble: StopTrouble): Sentence {
  const say = words().shell.stop.trouble;
  switch (trouble.kind) {
    case "refused":
      return said(trouble.why, trouble.detail);
    case "no_socket":
      return { text: say.noSocket };
    case "not_acknowledged":
      return { text: say.notAcknowledged };
    case "failed":
      return { text: troubleOf(trouble.error) };
  }
}

function reached(toDriveMicros: number | null): string {
  return toDriveMicros === null ? words().shell.stop.stoppedAlready : words().shell.stop.reachedDrive(millis(toDriveMicros / 1000));
}
