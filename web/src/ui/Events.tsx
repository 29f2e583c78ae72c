/** What happened, newest first. */
import { For, Show, type JSX } from "solid-js";
import type { Live } from "../live/live";
import { dayAndTime, timeOfDay } from "../lib/format";

/** The live list. */
export function Events(props: { readonly live: Live }): JSX.Element {
  return (
    <section class="panel grows" aria-labelledby="events-title">
      <h2 id="events-title">Events</h2>
      <Show when={props.live.events().length > 0} fallback={<p class="empty">Nothing has happened yet.</p>}>
        <ol class="events scrolls" role="log" aria-live="off" tabindex="0" aria-label="Events, newest first" data-testid="events">
          <For each={props.live.events()}>
            {(event) => (
              <li data-kind={event.kind}>
                <time datetime={event.at} title={dayAndTime(event.at)}>
                  {timeOfDay(event.at)}
                </time>
                <span class="event-kind">{event.kind.replaceAll("_", " ")}</span>
                <span class="event-summary">{event.summary}</span>
              </li>
            )}
          </For>
        </ol>
      </Show>
    </section>
  );
}
