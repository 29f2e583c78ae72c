/** Home, arm, disarm and reset: offered when the server would accept them, else with the server's reason. */
import { createSignal, For, Show, type JSX } from "solid-js";
import type { MachineRequest } from "../api/types";
import type { Live } from "../live/live";
import type { Answer } from "../live/requests";

/** The machine's buttons. */
export function Controls(props: { readonly live: Live }): JSX.Element {
  const [answer, setAnswer] = createSignal<{ readonly request: string; readonly answer: Answer } | null>(null);
  const [asking, setAsking] = createSignal<string | null>(null);
  const [resetting, setResetting] = createSignal(false);
  const [reason, setReason] = createSignal("");
  let reasonField: HTMLInputElement | undefined;

  const ask = async (request: MachineRequest, name: string, why?: string): Promise<void> => {
    setAsking(name);
    setAnswer(null);
    const result = await props.live.ask(request, why);
    setAsking(null);
    setAnswer({ request: name, answer: result });
    if (name === "reset" && result.kind === "answered" && result.outcome !== "refused") {
      setResetting(false);
      setReason("");
    }
  };
  const refusal = (request: string): string | null => whyNot(props.live, request);

  return (
    <section class="panel" aria-labelledby="machine-title">
      <h2 id="machine-title">Machine</h2>
      <ul class="controls">
        <For each={REQUESTS}>
          {(entry) => (
            <li>
              <button
                type="button"
                data-testid={entry.request}
                disabled={refusal(entry.request) !== null || asking() === entry.request}
                aria-describedby={`why-not-${entry.request}`}
                aria-expanded={entry.request === "reset" ? resetting() : undefined}
                onClick={() => {
                  if (entry.request === "reset") {
                    setResetting((open) => !open);
                    queueMicrotask(() => reasonField?.focus());
                  } else {
                    void ask(entry.request, entry.request);
                  }
                }}
              >
                {entry.word}
              </button>
              <span class="why-not" id={`why-not-${entry.request}`} data-testid={`why-not-${entry.request}`}>
                {refusal(entry.request) ?? entry.does}
              </span>
            </li>
          )}
        </For>
      </ul>
      <Show when={resetting() && refusal("reset") === null}>
        <form
          class="inline-form"
          onSubmit={(event) => {
            event.preventDefault();
            if (reason().trim() !== "") void ask("reset", "reset", reason().trim());
          }}
        >
          <label for="reset-reason">Why is it safe to reset?</label>
          <input
            id="reset-reason"
            data-testid="reset-reason"
            ref={reasonField}
            type="text"
            autocomplete="off"
            maxlength="200"
            value={reason()}
            onInput={(event) => setReason(event.currentTarget.value)}
          />
          <button type="submit" data-testid="reset-confirm" disabled={reason().trim() === "" || asking() === "reset"}>
            Reset, start nothing
          </button>
        </form>
      </Show>
      <Show when={answer()}>
        {(last) => (
          <p
            class="answer"
            role="status"
            data-testid="answer"
            classList={{ refused: last().answer.kind === "unanswered" || outcomeOf(last().answer) === "refused" }}
          >
            {last().request}: {wordsOf(last().answer)}
          </p>
        )}
      </Show>
    </section>
  );
}

/** Why a request cannot be made now; null if it can. */
export function whyNot(live: Live, request: string): string | null {
  const freshness = live.freshness();
  if (freshness.kind === "none") return "no state from the server yet";
  if (freshness.kind === "stale") return "the state shown is stale";
  const state = live.snapshot()?.requests.find((entry) => entry.request === request);
  return state === undefined ? "the server does not offer it" : state.refused_because;
}

function outcomeOf(answer: Answer): string | null {
  return answer.kind === "answered" ? answer.outcome : null;
}

/** An answer in words. */
export function wordsOf(answer: Answer): string {
  if (answer.kind === "unanswered") return `unanswered, ${answer.detail}`;
  const word = { accepted: "accepted", already_so: "already so", refused: "refused" }[answer.outcome];
  return answer.detail === "" ? word : `${word}, ${answer.detail}`;
}

const REQUESTS = [
  { request: "home", word: "Home", does: "finds the switches; the arena must be clear" },
  { request: "arm", word: "Arm", does: "follows the visitor" },
  { request: "disarm", word: "Disarm", does: "brakes and releases the drive" },
  { request: "reset", word: "Reset…", does: "leaves the stop; starts nothing" },
] as const;
