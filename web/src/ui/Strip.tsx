/** The health of everything behind the page: connection, control loop, VR clients. */
import { For, Show, type JSX } from "solid-js";
import { words } from "../i18n";
import { clauses } from "../lib/reasonWords";
import type { Live } from "../live/live";
import { millis } from "../lib/format";

/** The strip at the foot. */
export function Strip(props: { readonly live: Live }): JSX.Element {
  const loop = (): NonNullable<ReturnType<Live["snapshot"]>>["control_loop"] | null =>
    props.live.snapshot()?.control_loop ?? null;
  const clients = (): NonNullable<ReturnType<Live["snapshot"]>>["clients"] => props.live.snapshot()?.clients ?? [];
  return (
    <footer class="strip" aria-label={words().shell.strip.label}>
      <span class="link" data-phase={props.live.freshness().kind === "live" ? "live" : props.live.link().phase} data-testid="link">
        {linkWord(props.live)}
      </span>
      <Show when={props.live.server()}>
        {(server) => (
          <span>{words().shell.strip.server(server().version, server().machine)}</span>
        )}
      </Show>
      <span class="fades" data-testid="clients">
        <Show when={clients().length > 0} fallback={words().shell.strip.noClient}>
          <For each={clients()}>
            {(client) => (
              <span class="client">
                {client.name} ({client.convention}) {client.pose_rate_hz.toFixed(0)} Hz
                {client.rtt_millis === null ? "" : `, ${millis(client.rtt_millis)}`}
                {client.errors > 0 ? `, ${words().shell.strip.refused(client.errors)}` : ""}
              </span>
            )}
          </For>
        </Show>
      </span>
      <Show when={loop()}>
        {(state) => (
          <span class="fades loop" title={clauses(state().scheduling_why, state().scheduling).text} classList={{ bad: state().missed_deadlines > 0 && state().lateness_max_micros > 1e6 / state().rate_hz }}>
            {words().shell.strip.loop(
              state().rate_hz.toFixed(0),
              millis(state().lateness_p99_micros / 1000),
              millis(state().lateness_max_micros / 1000),
              state().missed_deadlines,
              state().steps,
            )}
          </span>
        )}
      </Show>
      <Show when={props.live.trouble()}>
        {(trouble) => (
          <span class="bad">
            {words().shell.strip.notUnderstood(trouble().last, trouble().count)}
          </span>
        )}
      </Show>
    </footer>
  );
}

function linkWord(live: Live): string {
  const freshness = live.freshness();
  const say = words().shell.strip;
  if (freshness.kind === "live") return say.live;
  if (freshness.kind === "stale") return say.stale;
  return live.link().phase === "open" ? say.noState : say.connecting;
}
