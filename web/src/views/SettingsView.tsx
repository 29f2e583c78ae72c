/** Settings: what each user likes, kept by the browser; versions and documents; the configuration in force. */
import { For, Show, type JSX } from "solid-js";
import { LANGUAGES, words } from "../i18n";
import type { PreferenceStore } from "../lib/preferences";
import type { Live } from "../live/live";
import { Configuration } from "../ui/Configuration";
import { version as pageVersion } from "../../package.json";

/** The view. */
export function SettingsView(props: {
  readonly live: Live;
  readonly author: string;
  readonly setAuthor: (name: string) => void;
  readonly preferences: PreferenceStore;
  readonly showShortcuts: () => void;
}): JSX.Element {
  return (
    <div class="sheet">
      <h1>{words().settings.title}</h1>
      <Yours {...props} />
      <Configuration />
      <Versions live={props.live} />
    </div>
  );
}

function Yours(props: Parameters<typeof SettingsView>[0]): JSX.Element {
  const liked = () => props.preferences.preferences();
  const say = () => words().settings.yours;
  return (
    <section class="panel settings" aria-labelledby="yours-title">
      <h2 id="yours-title">{say().title}</h2>
      <p class="empty">{say().kept(props.author)}</p>
      <div class="setting">
        <label for="setting-name">{words().shell.author.title}</label>
        <div>
          <input
            id="setting-name"
            type="text"
            maxlength="40"
            autocomplete="off"
            data-testid="setting-name"
            value={props.author}
            onChange={(event) => {
              props.setAuthor(event.currentTarget.value);
            }}
          />
          <small>{words().shell.author.means}</small>
        </div>
      </div>
      <Choice
        name="theme"
        label={words().shell.theme.label}
        chosen={liked().theme ?? "system"}
        options={[
          ["system", words().shell.theme.system],
          ["dark", words().shell.theme.dark],
          ["light", words().shell.theme.light],
        ]}
        choose={(theme) => {
          props.preferences.change({ theme: theme === "dark" || theme === "light" ? theme : undefined });
        }}
      />
      <Choice
        name="language"
        label={words().shell.language.label}
        chosen={liked().language ?? "system"}
        options={[["system", words().shell.theme.system], ...LANGUAGES.map((entry): [string, string] => [entry.language, entry.word])]}
        choose={(language) => {
          props.preferences.change({ language: language === "en" || language === "fr" ? language : undefined });
        }}
      />
      <div class="setting">
        <span>{say().shortcuts}</span>
        <div>
          <label class="check">
            <input
              type="checkbox"
              data-testid="setting-shortcuts"
              checked={liked().shortcuts !== false}
              onChange={(event) => {
                props.preferences.change({ shortcuts: event.currentTarget.checked });
              }}
            />
            {words().shell.shortcuts.turnOff}
          </label>
          <button
            type="button"
            onClick={() => {
              props.showShortcuts();
            }}
          >
            {say().showShortcuts}
          </button>
          <small>{say().shortcutsMeans}</small>
        </div>
      </div>
      <div class="setting">
        <span>{say().layout}</span>
        <div>
          <button
            type="button"
            data-testid="reset-layout"
            disabled={liked().layout === undefined}
            onClick={() => {
              props.preferences.change({ layout: undefined });
            }}
          >
            {say().resetLayout}
          </button>
          <Show when={liked().layout === undefined}>
            <small>{say().layoutIsDefault}</small>
          </Show>
        </div>
      </div>
    </section>
  );
}

function Choice(props: {
  readonly name: string;
  readonly label: string;
  readonly chosen: string;
  readonly options: readonly (readonly [value: string, word: string])[];
  readonly choose: (value: string) => void;
}): JSX.Element {
  return (
    <fieldset class="setting">
      <legend>{props.label}</legend>
      <div>
        <For each={props.options}>
          {([value, word]) => (
            <label class="check">
              <input
                type="radio"
                name={props.name}
                value={value}
                data-testid={`${props.name}-${value}`}
                checked={props.chosen === value}
                onChange={() => {
                  props.choose(value);
                }}
              />
              {word}
            </label>
          )}
        </For>
      </div>
    </fieldset>
  );
}

function Versions(props: { readonly live: Live }): JSX.Element {
  const say = () => words().settings.versions;
  return (
    <section class="panel" aria-labelledby="versions-title">
      <h2 id="versions-title">{say().title}</h2>
      <dl class="facts" data-testid="versions">
        <div>
          <dt>{say().server}</dt>
          <dd data-testid="server-version">{props.live.server()?.version ?? say().unknown}</dd>
        </div>
        <div>
          <dt>{say().machine}</dt>
          <dd>{props.live.server()?.machine ?? say().unknown}</dd>
        </div>
        <div>
          <dt>{say().protocol}</dt>
          <dd>covr.v1</dd>
        </div>
        <div>
          <dt>{say().page}</dt>
          <dd>{pageVersion}</dd>
        </div>
      </dl>
      <h3>{say().documents}</h3>
      <ul class="documents">
        <For each={DOCUMENTS}>
          {(document) => (
            <li>
              <a href={document.href} target="_blank" rel="noopener">
                {say()[document.word]}
              </a>{" "}
              <code>{document.href}</code>
            </li>
          )}
        </For>
      </ul>
    </section>
  );
}

const DOCUMENTS = [
  { href: "/api/docs", word: "api" },
  { href: "/api/v1/openapi.json", word: "openapi" },
  { href: "/api/v1/asyncapi.json", word: "asyncapi" },
  { href: "/api/v1/scene.schema.json", word: "sceneSchema" },
  { href: "/metrics", word: "metrics" },
] as const;
