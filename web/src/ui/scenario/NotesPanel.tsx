/** Notes for the record, with who and when: they are events of the session. */
import { createMemo, createSignal, For, Show, type JSX } from "solid-js";
import { addNote, readEvents, type EventPage, type EventQuery } from "../../api/http";
import { words } from "../../i18n";
import { dayAndTime, timeOfDay } from "../../lib/format";
import { troubleOf } from "../../lib/trouble";
import type { Live } from "../../live/live";
import { createRecord } from "../../live/record";

/** The panel. */
export function NotesPanel(props: { readonly live: Live; readonly author: string }): JSX.Element {
  const say = () => words().scenario.notes;
  const [text, setText] = createSignal("");
  const [writing, setWriting] = createSignal(false);
  const [trouble, setTrouble] = createSignal<string | null>(null);
  const record = createRecord(props.live, () => EVERYTHING, notesOnly);
  const notes = createMemo(() => record.events().flatMap((event) => {
    const { author, text: told } = fields(event.detail);
    return event.kind === "note" && told !== null ? [{ at: event.at, author: author ?? "–", text: told }] : [];
  }));
  const may = (): boolean => props.live.identity.may("POST /api/v1/notes");
  const write = async (): Promise<void> => {
    const sent = text().trim();
    if (sent === "" || writing()) return;
    setWriting(true);
    setTrouble(null);
    try {
      await addNote(sent, props.author);
      // What was typed meanwhile is the next one.
      if (text().trim() === sent) setText("");
    } catch (error) {
      setTrouble(troubleOf(error));
    } finally {
      setWriting(false);
    }
  };
  return (
    <section class="panel" aria-labelledby="scenario-notes">
      <h2 id="scenario-notes">{say().title}</h2>
      <form
        class="note-form"
        onSubmit={(event) => {
          event.preventDefault();
          void write();
        }}
      >
        <label class="unseen" for="note">{say().label}</label>
        <input id="note" data-testid="note" type="text" autocomplete="off" maxlength="1000" placeholder={say().label} value={text()} onInput={(event) => setText(event.currentTarget.value)} />
        <button type="submit" data-testid="note-write" disabled={text().trim() === "" || writing() || !may()}>{say().write}</button>
      </form>
      <Show when={trouble()}>{(why) => <p class="answer refused" role="alert" data-testid="note-trouble">{say().notWritten(why())}</p>}</Show>
      <Show when={record.trouble()}>{(why) => <p class="answer refused" role="alert">{say().unread(why())}</p>}</Show>
      <Show when={notes().length > 0} fallback={<p class="empty">{say().none}</p>}>
        <ol class="notes scrolls" data-testid="notes" tabindex="0" aria-label={say().title}>
          <For each={notes()}>
            {(note) => (
              <li>
                <time datetime={note.at} title={dayAndTime(note.at)}>{timeOfDay(note.at)}</time> <b>{note.author}</b> {note.text}
              </li>
            )}
          </For>
        </ol>
      </Show>
    </section>
  );
}

function notesOnly(query: EventQuery | string, giveUp: AbortSignal): Promise<EventPage> {
  return readEvents(typeof query === "string" ? query : { ...query, kinds: ["note"] }, giveUp);
}

function fields(detail: unknown): { readonly author: string | null; readonly text: string | null } {
  const of = (name: string): string | null => {
    const found: unknown = typeof detail === "object" && detail !== null ? (detail as Record<string, unknown>)[name] : null;
    return typeof found === "string" ? found : null;
  };
  return { author: of("author"), text: of("text") };
}

const EVERYTHING = { groups: [], search: "", person: null, session: null } as const;
