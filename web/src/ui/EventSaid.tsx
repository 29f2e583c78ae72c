/** What an event says, on one line. */
import { Show, type JSX } from "solid-js";
import type { WireEvent } from "../api/types";
import { words } from "../i18n";
import { eventWords } from "./eventWords";

/** What happened, and why. */
export function EventSaid(props: { readonly event: WireEvent; readonly label: (id: string) => string }): JSX.Element {
  const said = (): ReturnType<typeof eventWords> => eventWords(props.event, props.label);
  return (
    <span class="event-summary">
      {said().text}
      <Show when={said().server}>
        {(server) => <span class="event-server" lang={server().lang}>{said().text === null ? "" : words().desk.timeline.colon}{server().text}</span>}
      </Show>
    </span>
  );
}
