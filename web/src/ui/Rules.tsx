/** Every safety rule: how it stands and why. */
import { createMemo, For, type JSX } from "solid-js";
import type { RuleStatus } from "../api/types";
import type { Live } from "../live/live";

/** The list, in the rules' own order, so that each stays in its place. */
export function Rules(props: { readonly live: Live }): JSX.Element {
  const rules = (): NonNullable<ReturnType<Live["snapshot"]>>["rules"] => props.live.snapshot()?.rules ?? [];
  const summary = createMemo(() => {
    const count = (status: RuleStatus): number => rules().filter((rule) => rule.status === status).length;
    const [breached, limiting] = [count("breached"), count("limiting")];
    if (rules().length === 0) return "unknown";
    if (breached === 0 && limiting === 0) return "all clear";
    return [breached > 0 ? `${breached} breached` : "", limiting > 0 ? `${limiting} limiting` : ""]
      .filter((part) => part !== "")
      .join(", ");
  });
  return (
    <section class="panel grows" aria-labelledby="rules-title">
      <h2 id="rules-title">
        Safety rules <small class="fades">{summary()}</small>
      </h2>
      <p class="rule-overview fades" aria-hidden="true">
        <For each={rules()}>{(rule) => <span data-status={rule.status}>{rule.rule}</span>}</For>
      </p>
      <ol class="rules fades scrolls" tabindex="0" aria-label="Safety rules">
        <For each={rules()}>
          {(rule) => (
            <li data-testid={`rule-${rule.rule}`} data-status={rule.status}>
              <span class="rule-id">{rule.rule}</span>
              <span class="rule-title">{rule.title}</span>
              <span class="rule-status">{rule.status}</span>
              <span class="rule-reason">{rule.reason}</span>
            </li>
          )}
        </For>
      </ol>
    </section>
  );
}
