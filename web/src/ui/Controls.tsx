/** Home, arm, disarm and reset: offered when the server would accept them, else with the server's reason. */
import { createSignal, For, Show, type JSX } from "solid-js";
import type { MachineRequest } from "../api/types";
import { words } from "../i18n";
import { said, type Said as Sentence } from "../lib/reasonWords";
import type { Live } from "../live/live";
import type { Answer } from "../live/requests";
import { Said } from "./Said";

/** The machine's buttons. */
export function Controls(props: { readonly live: Live }): JSX.Element {
  const [answer, setAnswer] = createSignal<{ readonly request: RequestName; readonly answer: Answer } | null>(null);
  const [asking, setAsking] = createSignal<string | null>(null);
  const [resetting, setResetting] = createSignal(false);
  const [reason, setReason] = createSignal("");
  let reasonField: HTMLInputElement | undefined;

  const ask = async (request: MachineRequest, name: RequestName, why?: string): Promise<void> => {
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
  const refusal = (request: RequestName): string | null => whyNot(props.live, request);

  return (
    <section class="panel" aria-labelledby="machine-title">
      <h2 id="machine-title">{words().shell.machine.title}</h2>
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
                {words().shell.machine[entry.request]}
              </button>
              <span
                class="why-not"
                id={`why-not-${entry.request}`}
                data-testid={`why-not-${entry.request}`}
                lang={refusalOf(props.live, entry.request)?.lang}
              >
                {refusal(entry.request) ?? words().shell.machine[entry.does]}
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
          <label for="reset-reason">{words().shell.machine.resetWhy}</label>
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
            {words().shell.machine.resetConfirm}
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
            {words().shell.machine.request[last().request]}{words().shell.colon}{outcomeWords(last().answer)}
            <Show when={detailOf(last().answer)}>{(detail) => <>, <Said of={detail()} /></>}</Show>
          </p>
        )}
      </Show>
    </section>
  );
}

/** Why a request cannot be made now; null if it can. */
export function whyNot(live: Live, request: string): string | null {
  return refusalOf(live, request)?.text ?? null;
}

/** The same, with its language where it is not the page's. */
function refusalOf(live: Live, request: string): Sentence | null {
  const freshness = live.freshness();
  const say = words().shell.machine;
  if (freshness.kind === "none") return { text: say.stateNone };
  if (freshness.kind === "stale") return { text: say.stateStale };
  if (!live.identity.may(`dashboard ${request}`)) return { text: say.notForRole };
  const state = live.snapshot()?.requests.find((entry) => entry.request === request);
  if (state === undefined) return { text: say.notOffered };
  return state.refused_because === null ? null : said(state.why, state.refused_because);
}

function outcomeOf(answer: Answer): string | null {
  return answer.kind === "answered" ? answer.outcome : null;
}

/** An answer in words. */
export function wordsOf(answer: Answer): string {
  const detail = detailOf(answer);
  return detail === null ? outcomeWords(answer) : `${outcomeWords(answer)}, ${detail.text}`;
}

function detailOf(answer: Answer): Sentence | null {
  if (answer.kind === "unanswered") return { text: words().shell.machine.silence[answer.because] };
  return answer.detail === "" ? null : said(answer.why, answer.detail);
}

function outcomeWords(answer: Answer): string {
  const say = words().shell.machine;
  return answer.kind === "unanswered" ? say.unanswered : say.outcome[answer.outcome];
}

type RequestName = (typeof REQUESTS)[number]["request"];

const REQUESTS = [
  { request: "home", does: "homeDoes" },
  { request: "arm", does: "armDoes" },
  { request: "disarm", does: "disarmDoes" },
  { request: "reset", does: "resetDoes" },
] as const;
