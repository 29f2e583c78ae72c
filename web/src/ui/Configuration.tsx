/** The configuration in force: every key with its meaning, its default, what it accepts and who set it. */
import { createMemo, createResource, createSignal, For, Show, untrack, type JSX } from "solid-js";
import { readConfig } from "../api/http";
import type { ConfigKey } from "../api/types";
import { words } from "../i18n";
import { acceptsOf, meaningOf } from "./configWords";
import { Said } from "./Said";
import { troubleOf } from "../lib/trouble";

/** The panel; read when it is opened, and again on request. `search` is what is looked for at first. */
export function Configuration(props: { readonly search?: string }): JSX.Element {
  const [config, { refetch }] = createResource(readConfig);
  const [wanted, setWanted] = createSignal(untrack(() => props.search ?? ""));
  const [onlyChanged, setOnlyChanged] = createSignal(false);
  const say = () => words().settings.config;
  const read = () => (config.error === undefined ? config.latest : undefined);
  const all = (): readonly ConfigKey[] => read()?.keys ?? [];
  const shown = createMemo(() => all().filter((key) => fits(key, wanted()) && (!onlyChanged() || differs(key))));
  return (
    <section class="panel config" aria-labelledby="config-title">
      <h2 id="config-title">{say().title}</h2>
      <p>{say().intro}</p>
      <Show when={config.error !== undefined}>
        <p class="answer refused" role="alert" data-testid="config-trouble">
          {say().notRead} {troubleOf(config.error)}
        </p>
        <button type="button" onClick={() => void refetch()}>
          {say().again}
        </button>
      </Show>
      <Show when={read()}>
        {(found) => (
          <>
            <p class="empty">
              <Show when={found().file} fallback={say().noFile}>
                {(file) => (
                  <>
                    {say().file} <code>{file()}</code>
                  </>
                )}
              </Show>{" "}
              · {words().settings.versions.built}{" "}
              <code>
                {found().built.profile}, {found().built.target}, {found().built.rustc}
                {found().built.commit === null ? "" : `, ${found().built.commit ?? ""}`}
              </code>
            </p>
            <div class="config-tools">
              <input
                type="search"
                aria-label={say().search}
                placeholder={say().search}
                data-testid="config-search"
                value={wanted()}
                onInput={(event) => setWanted(event.currentTarget.value)}
              />
              <label class="check">
                <input
                  type="checkbox"
                  data-testid="config-changed"
                  checked={onlyChanged()}
                  onChange={(event) => setOnlyChanged(event.currentTarget.checked)}
                />
                {say().onlyChanged}
              </label>
              <span class="empty" role="status" data-testid="config-count">
                {say().count(shown().length, all().length)}
              </span>
            </div>
            <Show when={shown().length > 0} fallback={<p class="empty">{say().none}</p>}>
              <table data-testid="config">
                <thead>
                  <tr>
                    <th scope="col">{say().key}</th>
                    <th scope="col">{say().value}</th>
                    <th scope="col">{say().default}</th>
                    <th scope="col">{say().from}</th>
                  </tr>
                </thead>
                <tbody>
                  <For each={shown()}>{(key) => <Row key={key} />}</For>
                </tbody>
              </table>
            </Show>
          </>
        )}
      </Show>
    </section>
  );
}

function Row(props: { readonly key: ConfigKey }): JSX.Element {
  const say = () => words().settings.config;
  return (
    <tr classList={{ differs: differs(props.key) }} data-testid={`config-${props.key.name}`}>
      <th scope="row">
        <code>{props.key.name}</code>
        <Said class="meaning" of={meaningOf(props.key)} />
        <small>
          {say().accepts} {acceptsOf(props.key.takes)} · {say().variable} <code>{variableOf(props.key.name)}</code>
        </small>
      </th>
      <td>
        <code>{textOf(props.key.value)}</code>
        <Show when={differs(props.key)}>
          <span class="unseen">, {say().differs}</span>
        </Show>
      </td>
      <td>{textOf(props.key.default)}</td>
      <td>{say().origin[props.key.from]}</td>
    </tr>
  );
}

/** Every word of the search in the name, the meaning or the value. */
function fits(key: ConfigKey, wanted: string): boolean {
  const text = `${key.name} ${meaningOf(key).text} ${textOf(key.value)}`.toLowerCase();
  return wanted.toLowerCase().split(/\s+/).every((word) => text.includes(word));
}

function differs(key: ConfigKey): boolean {
  return textOf(key.value) !== textOf(key.default);
}

/** `section.key` is overridden by `COVR_SECTION__KEY`. */
function variableOf(name: string): string {
  return `COVR_${name.toUpperCase().replaceAll(".", "__")}`;
}

function textOf(value: unknown): string {
  return typeof value === "string" ? (value === "" ? '""' : value) : JSON.stringify(value).replaceAll(",", ", ");
}
