/** The sessions that the server has recorded: the list, or the one that the address names, at its time. */
import { createEffect, createMemo, createSignal, Match, on, Show, Switch, type JSX } from "solid-js";
import { Problem, readSession } from "../api/http";
import type { SessionDetail } from "../api/types";
import { words } from "../i18n";
import { createAddress, secondsOf, wholeNumber } from "../lib/address";
import type { Live } from "../live/live";
import { lengthOf, Replay } from "../ui/sessions/Replay";
import { SessionList } from "../ui/sessions/SessionList";
import { troubleOf } from "../lib/trouble";

/** `#/sessions` and `#/sessions/12?t=34.5`. */
export function SessionsView(props: { readonly live: Live }): JSX.Element {
  const address = createAddress();
  const part = createMemo(() => address().parts[0]);
  const [session, setSession] = createSignal<SessionDetail | null>(null);
  const [trouble, setTrouble] = createSignal<{ readonly missing: boolean; readonly detail: string } | null>(null);
  const asked = (): string | undefined => address().query.get("t");
  const seekTo = (): number | null => secondsOf(asked());

  const open = async (): Promise<void> => {
    const wanted = part();
    const id = wholeNumber(wanted);
    setSession(null);
    setTrouble(wanted !== undefined && id === null ? { missing: true, detail: "" } : null);
    if (id === null) return;
    try {
      const found = await readSession(id);
      if (part() === wanted) setSession(found);
    } catch (error) {
      if (part() !== wanted) return;
      setTrouble({ missing: error instanceof Problem && error.status === 404, detail: troubleOf(error) });
    }
  };
  createEffect(on(part, () => void open()));
  /** What is odd about the time in the address, when the session opens. */
  const note = createMemo(on(session, (opened) => {
    const text = asked();
    if (opened === null || text === undefined) return null;
    const secs = secondsOf(text);
    if (secs === null) return { wrong: text };
    return secs > lengthOf(opened) && opened.ended_at !== null ? { wrong: null } : null;
  }));

  return (
    <Switch>
      <Match when={part() === undefined}>
        <SessionList live={props.live} />
      </Match>
      <Match when={trouble()}>
        {(why) => (
          <div class="sheet">
            <h1>{words().records.sessions.title}</h1>
            <section class="panel" aria-label={words().records.sessions.title}>
              <p class="answer refused" role="alert" data-testid="no-such-session">
                {why().missing ? words().records.replay.wrongAddress(part() ?? "") : words().records.replay.missing(why().detail)}
              </p>
              <p>
                <Show when={!why().missing}>
                  <button type="button" onClick={() => void open()}>{words().records.replay.again}</button>{" "}
                </Show>
                <a href="#/sessions">{words().records.replay.back}</a>
              </p>
            </section>
          </div>
        )}
      </Match>
      <Match when={session()} keyed>
        {(opened) => (
          <div class="replay-page">
            <h1 class="unseen">{words().records.replay.banner(opened.id)}</h1>
            <Show when={note()}>
              {(odd) => {
                const { wrong } = odd();
                return <p class="answer refused" role="status" data-testid="wrong-time">{wrong === null ? words().records.replay.beyond : words().records.replay.wrongTime(wrong)}</p>;
              }}
            </Show>
            <Replay session={opened} startSecs={seekTo() ?? 0} seekTo={seekTo} />
          </div>
        )}
      </Match>
      <Match when={true}>
        <p class="empty" role="status">{words().records.sessions.loading}</p>
      </Match>
    </Switch>
  );
}
