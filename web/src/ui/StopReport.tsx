/** What became of the last press of the stop; never says stopped before the server did. */
import { createSignal, Match, Show, Switch, type JSX } from "solid-js";
import type { StopState } from "../live/stop";
import { millis, span } from "../lib/format";

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
              <b>NOT ACKNOWLEDGED, retrying.</b>
              <span aria-hidden="true">
                {span(Math.max(0, props.nowMillis - state().pressedAtMillis) / 1000)} since the press, sent{" "}
                {state().sent} times{state().trouble === null ? "" : `; ${state().trouble ?? ""}`}
              </span>
              <b class="bar-end">If it moves: use the wired stop.</b>
            </div>
          )}
        </Match>
        <Match when={acknowledged()}>
          {(state) => (
            <div class="bar bar-acknowledged" data-testid="stop-acknowledged" data-lane={state().lane}>
              <b>stopped: acknowledged in {millis(state().acknowledgedMillis)},</b>
              <span>
                {reached(state().toDriveMicros)}, by {state().lane === "websocket" ? "WebSocket" : "HTTP"}
              </span>
              <Show when={state().sent > 1}>
                <span>(sent {state().sent} times)</span>
              </Show>
              <button type="button" class="quiet bar-end" onClick={() => setPutAway(state().pressedAtMillis)}>
                Put away
              </button>
            </div>
          )}
        </Match>
      </Switch>
    </div>
  );
}

function reached(toDriveMicros: number | null): string {
  return toDriveMicros === null ? "the drive was stopped already" : `reached the drive in ${millis(toDriveMicros / 1000)}`;
}
