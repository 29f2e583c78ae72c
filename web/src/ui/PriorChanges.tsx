/** Who changed which prior when, from what to what; each change can be set back. */
import { For, Show, type JSX } from "solid-js";
import type { PriorChange } from "../api/types";
import { words } from "../i18n";
import { dayAndTime, decimal, timeOfDay } from "../lib/format";
import { samePrior, type PriorsNow, type SetBack } from "../lib/priorDrafts";

/** The last change in a line; the others in a table under it. */
export function PriorChanges(props: {
  readonly changes: readonly PriorChange[];
  readonly label: (object: string) => string;
  readonly inForce: PriorsNow;
  readonly frozen: boolean;
  readonly setBack: (change: SetBack) => void;
}): JSX.Element {
  const text = (): ReturnType<typeof words>["desk"]["priors"] => words().desk.priors;
  const what = ({ object, from, to }: PriorChange): string => text().change(props.label(object), decimal(from, 2), decimal(to, 2));
  const who = (change: PriorChange): string => (change.author === "" ? text().somebody : change.author);
  return (
    <Show when={props.changes[0]} fallback={<p class="empty">{text().noChanges}</p>}>
      {(last) => (
        <details class="prior-changes">
          <summary data-testid="prior-last-change">
            {text().lastChange} {who(last())}{words().shell.colon}{what(last())}
          </summary>
          <div class="scrolls" tabindex="0" role="region" aria-label={text().changes}>
            <table data-testid="prior-changes">
              <caption class="unseen">{text().changes}</caption>
              <thead>
                <tr>
                  <th scope="col">{text().when}</th>
                  <th scope="col">{text().who}</th>
                  <th scope="col">{text().object}</th>
                  <th scope="col">{text().from}</th>
                  <th scope="col">{text().to}</th>
                  <th scope="col"><span class="unseen">{text().setBack}</span></th>
                </tr>
              </thead>
              <tbody>
                <For each={props.changes}>
                  {(change) => (
                    <tr>
                      <td><time datetime={change.at} title={dayAndTime(change.at)}>{timeOfDay(change.at)}</time></td>
                      <td class="wraps">{who(change)}</td>
                      <td class="wraps">{props.label(change.object)}</td>
                      <td>{decimal(change.from, 2)}</td>
                      <td>{decimal(change.to, 2)}</td>
                      <td>
                        <Show when={props.inForce[change.object] !== undefined}>
                          <Show when={!samePrior(props.inForce[change.object] ?? NaN, change.from)} fallback={<small>{text().setBackIsSo}</small>}>
                            <button
                              type="button"
                              class="chip"
                              disabled={props.frozen}
                              aria-label={text().setBackWhat(text().change(props.label(change.object), decimal(change.to, 2), decimal(change.from, 2)))}
                              onClick={() => { props.setBack(change); }}
                            >
                              {text().setBack}
                            </button>
                          </Show>
                        </Show>
                      </td>
                    </tr>
                  )}
                </For>
              </tbody>
            </table>
          </div>
        </details>
      )}
    </Show>
  );
}
