/** Whether the machine was commissioned, and what its brake did then. */
import { createResource, Show, type JSX } from "solid-js";
import { listCommissionings } from "../api/http";
import { words } from "../i18n";
import { dayAndTime, decimal } from "../lib/format";
import { said } from "../lib/reasonWords";
import { troubleOf } from "../lib/trouble";
import type { Live } from "../live/live";

/** The panel. It reads anew when a commissioning is told of. */
export function Commissioning(props: { readonly live: Live }): JSX.Element {
  const say = () => words().machine.commissioning;
  const told = () => props.live.events().filter((event) => event.kind === "machine_commissioned").length;
  const [all] = createResource(told, listCommissionings);
  /** Why it is not armed, where that is commissioning's word. */
  const missing = () => {
    const arm = props.live.snapshot()?.requests.find((entry) => entry.request === "arm");
    return arm?.why != null && arm.refused_because !== null && ITS_WORDS.has(arm.why.id) ? said(arm.why, arm.refused_because).text : null;
  };
  return (
    <section class="panel" aria-labelledby="commissioning-title">
      <h2 id="commissioning-title">{say().title}</h2>
      <Show when={missing()}>{(why) => <p class="answer refused" data-testid="commissioning-missing">{why()}</p>}</Show>
      <Show when={!all.error} fallback={<p class="empty">{say().notRead(troubleOf(all.error))}</p>}>
        <Show when={all()?.[0]} fallback={<p class="empty" data-testid="commissioning-none">{say().none}</p>}>
          {(last) => (
            <p data-testid="commissioning-last">
              {say().last(
                dayAndTime(last().created_at),
                last().author,
                decimal(last().load_kg, 1),
                decimal(last().braking_mps2[0], 2),
                decimal(last().braking_mps2[1], 2),
              )}
            </p>
          )}
        </Show>
      </Show>
      <p class="empty">{say().means}</p>
    </section>
  );
}

const ITS_WORDS: ReadonlySet<string> = new Set(["not_commissioned", "commissioning_outdated", "brakes_worse"]);
