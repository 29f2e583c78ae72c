/** Every safety rule: how it stands and why. */
import { createMemo, For, type JSX } from "solid-js";
import type { RuleStatus } from "../api/types";
import { words } from "../i18n";
import { said } from "../lib/reasonWords";
import type { Live } from "../live/live";
import { Said } from "./Said";

/** The list, in the rules' own order, so that each stays in its place. */
export function Rules(props: { readonly live: Live }): JSX.Element {
  const rules = (): NonNullable<ReturnType<Live["snapshot"]>>["rules"] => props.live.snapshot()?.rules ?? [];
  const summary = createMemo(() => {
    const count = (status: RuleStatus): number => rules().filter((rule) => rule.status === status).length;
    const say = words().shell.rules;
    const [breached, limiting] = [count("breached"), count("limiting")];
    if (rules().length === 0) return say.unknown;
    if (breached === 0 && limiting === 0) return say.allClear;
    return [breached > 0 ? say.breached(breached) : "", limiting > 0 ? say.limiting(limiting) : ""]
      .filter((part) => part !== "")
      .join(", ");
  });
  return (
    <section class="panel grows" aria-labelledby="rules-title">
      <h2 id="rules-title">
        {words().shell.rules.title} <small class="fades">{summary()}</small>
      </h2>
      <p class="rule-overview fades" aria-hidden="true">
        <For each={rules()}>{(rule) => <span data-status={rule.status}>{rule.rule}</span>}</For>
      </p>
      <ol class="rules fades scrolls" tabindex="0" aria-label={words().shell.rules.title}>
        <For each={rules()}>
          {(rule) => (
            <li data-testid={`rule-${rule.rule}`} data-status={rule.status}>
              <a class="rule-id" href={`#/help/${rule.rule}`} aria-label={words().shell.rules.helpFor(rule.rule)}>
                {rule.rule}
              </a>
              <span class="rule-title">{ruleTitle(rule.rule, rule.title)}</span>
              <span class="rule-status">{words().shell.rules.status[rule.status]}</span>
              <Said class="rule-reason" of={said(rule.why, rule.reason)} />
            </li>
          )}
        </For>
      </ol>
    </section>
  );
}

/** A rule's name in the page's language; the server's own for one that the page does not know. */
export function ruleTitle(rule: string, title: string): string {
  const titles: Readonly<Record<string, string>> = words().shell.rules.titles;
  return titles[rule] ?? title;
}
