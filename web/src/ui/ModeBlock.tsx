/** The mode in big words. */
import { createMemo, Show, type JSX } from "solid-js";
import { words } from "../i18n";
import type { Live } from "../live/live";
import { labelOf } from "../lib/labels";
import { modeWords, span } from "../lib/format";

/** Mode, since when, whom it serves and what it expects. */
export function ModeBlock(props: { readonly live: Live }): JSX.Element {
  const snapshot = createMemo(() => props.live.snapshot());
  /** In any other mode the column serves nobody, whatever the rule makes of the person. */
  const follows = (): boolean => ["following", "protective_stop"].includes(snapshot()?.mode ?? "");
  const serves = createMemo(() => {
    const state = snapshot();
    if (state === null || state.column.serves === null || !follows()) return null;
    const id = state.column.serves;
    return state.persons.find((person) => person.id === id)?.name ?? words().shell.mode.person(id);
  });
  const committed = createMemo(() => {
    const id = snapshot()?.column.committed ?? null;
    return id === null || !follows() ? null : labelOf(props.live.scene()?.scene ?? null, id);
  });
  return (
    <div class="mode fades" data-mode={snapshot()?.mode ?? "unknown"}>
      <Show when={snapshot()} fallback={<p class="mode-word" data-testid="mode">{words().shell.mode.unknown}</p>}>
        {(state) => (
          <>
            <p class="mode-word" role="status" aria-live="assertive" data-testid="mode" data-mode={state().mode}>
              {modeWords(state().mode)}
            </p>
            <p class="mode-more">
              {words().shell.mode.since(span((state().at_micros - state().mode_since_micros) / 1e6))}
              <Show when={serves()}>{(name) => <> · {words().shell.mode.serves(name())}</>}</Show>
              <Show when={committed()}>
                {(label) => (
                  <>
                    {" "}
                    · {words().shell.mode.predicts} <b class="predicted-word" data-testid="predicted">{label()}</b>
                  </>
                )}
              </Show>
            </p>
          </>
        )}
      </Show>
    </div>
  );
}
