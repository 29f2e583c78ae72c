/** Skipping to a state, and going back: each with a reason and a second act. */
import { createEffect, createSignal, on, Show, type JSX } from "solid-js";
import type { Scenario, SceneDocument } from "../../api/types";
import { words } from "../../i18n";
import { stateLabel } from "../../lib/scenarioWords";

/** What is chosen, and not yet done. */
export type Leap = { readonly kind: "skip"; readonly to: string } | { readonly kind: "rewind"; readonly to: string };

/** The panel. */
export function SkipPanel(props: {
  readonly scene: SceneDocument;
  readonly now: Scenario;
  readonly leap: Leap | null;
  readonly choose: (leap: Leap | null) => void;
  readonly may: boolean;
  readonly go: (leap: Leap, reason: string, what: string) => void;
}): JSX.Element {
  const say = () => words().scenario;
  const [reason, setReason] = createSignal("");
  let field: HTMLInputElement | undefined;
  const what = (leap: Leap): string => {
    const state = stateLabel(props.scene, leap.to);
    return leap.kind === "skip" ? say().skipTo(state) : say().rewindTo(state);
  };
  createEffect(
    on(
      () => props.leap,
      (leap) => {
        if (leap !== null) queueMicrotask(() => field?.focus());
      },
    ),
  );
  return (
    <section class="panel" aria-labelledby="scenario-skip">
      <h2 id="scenario-skip">{say().skip}</h2>
      <Show
        when={props.leap}
        fallback={
          <>
            <p>{say().skipChoose}</p>
            <button
              type="button"
              data-testid="rewind"
              disabled={!props.may || props.now.before === null}
              aria-describedby="rewind-why"
              onClick={() => {
                const { before } = props.now;
                if (before !== null) props.choose({ kind: "rewind", to: before });
              }}
            >
              {say().rewind}
            </button>
            <p class="why-not" id="rewind-why">
              {props.now.before === null ? say().rewindNothing : say().rewindTo(stateLabel(props.scene, props.now.before))}
            </p>
          </>
        }
      >
        {(leap) => (
          <form
            class="inline-form"
            data-testid="leap"
            onSubmit={(event) => {
              event.preventDefault();
              if (reason().trim() === "" || !props.may) return;
              props.go(leap(), reason().trim(), what(leap()));
              setReason("");
            }}
          >
            <p>{say().asks(what(leap()))}</p>
            <label for="leap-reason">{say().why}</label>
            <input
              id="leap-reason"
              data-testid="leap-reason"
              ref={field}
              type="text"
              autocomplete="off"
              maxlength="200"
              value={reason()}
              onInput={(event) => setReason(event.currentTarget.value)}
            />
            <div class="scenario-acts">
              <button type="submit" class="primary" data-testid="leap-confirm" disabled={reason().trim() === "" || !props.may}>
                {say().confirm}
              </button>
              <button type="button" data-testid="leap-cancel" onClick={() => { props.choose(null); }}>
                {say().cancel}
              </button>
            </div>
          </form>
        )}
      </Show>
    </section>
  );
}
