/** The health of everything behind the page: connection, control loop, VR clients. */
import { For, Show, type JSX } from "solid-js";
import type { Live } from "../live/live";
import { millis } from "../lib/format";

/** The strip at the foot. */
export function Strip(props: { readonly live: Live }): JSX.Element {
  const loop = (): NonNullable<ReturnType<Live["snapshot"]>>["control_loop"] | null =>
    props.live.snapshot()?.control_loop ?? null;
  const clients = (): NonNullable<ReturnType<Live["snapshot"]>>["clients"] => props.live.snapshot()?.clients ?? [];
  return (
    <footer class="strip" aria-label="Health">
      <span class="link" data-phase={props.live.freshness().kind === "live" ? "live" : props.live.link().phase} data-testid="link">
        {linkWord(props.live)}
      </span>
      <Show when={props.live.server()}>
        {(server) => (
          <span>
            covr {server().version}, {server().machine} machine
          </span>
        )}
      </Show>
      <span class="fades" data-testid="clients">
        <Show when={clients().length > 0} fallback="no VR client">
          <For each={clients()}>
            {(client) => (
              <span class="client">
                {client.name} ({client.convention}) {client.pose_rate_hz.toFixed(0)} Hz
                {client.rtt_millis === null ? "" : `, ${millis(client.rtt_millis)}`}
                {client.errors > 0 ? `, ${client.errors} refused` : ""}
              </span>
            )}
          </For>
        </Show>
      </span>
      <Show when={loop()}>
        {(state) => (
          <span class="fades loop" title={state().scheduling} classList={{ bad: state().missed_deadlines > 0 && state().lateness_max_micros > 1e6 / state().rate_hz }}>
            loop {state().rate_hz.toFixed(0)} Hz, late p99 {millis(state().lateness_p99_micros / 1000)}, greatest{" "}
            {millis(state().lateness_max_micros / 1000)}, {state().missed_deadlines} missed of {state().steps};{" "}
            {state().scheduling}
          </span>
        )}
      </Show>
      <Show when={props.live.trouble()}>
        {(trouble) => (
          <span class="bad">
            not understood: {trouble().last} ({trouble().count})
          </span>
        )}
      </Show>
    </footer>
  );
}

function linkWord(live: Live): string {
  const freshness = live.freshness();
  if (freshness.kind === "live") return "live";
  if (freshness.kind === "stale") return "stale";
  return live.link().phase === "open" ? "no state yet" : "connecting";
}
