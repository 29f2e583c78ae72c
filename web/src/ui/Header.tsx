/** The header: mode, ways to the views, who sits here, theme and language, and the stop. It never scrolls away. */
import { For, Show, type JSX } from "solid-js";
import { LANGUAGES, language, words } from "../i18n";
import type { Appearance } from "../lib/appearance";
import { theme } from "../lib/theme";
import type { Live } from "../live/live";
import { VIEWS, type ViewName } from "../views/route";
import { ModeBlock } from "./ModeBlock";
import { StopButton } from "./StopButton";

/** Everything above the view. */
export function Header(props: {
  readonly live: Live;
  readonly view: ViewName;
  readonly author: string;
  readonly setAuthor: (name: string) => void;
  readonly appearance: Appearance;
  readonly help: () => void;
  /** What is behind a dialog: the stop alone stays in reach. */
  readonly behind: boolean;
}): JSX.Element {
  return (
    <header class="top">
      <ModeBlock live={props.live} />
      <div class="ways" inert={props.behind}>
        <nav aria-label={words().shell.pages.label}>
          <For each={VIEWS}>
            {(view) => (
              <a href={`#/${view}`} data-testid={`view-${view}`} aria-current={props.view === view ? "page" : undefined}>
                {words().shell.pages[view]}
              </a>
            )}
          </For>
        </nav>
        <div class="tools">
          <label class="author">
            {words().shell.author.label}
            <input
              type="text"
              data-testid="author"
              maxlength="40"
              autocomplete="off"
              title={words().shell.author.means}
              value={props.author}
              onChange={(event) => {
                props.setAuthor(event.currentTarget.value);
              }}
            />
          </label>
          <Show when={props.live.identity.me()?.role}>
            {(role) => (
              <button
                type="button"
                class="tool"
                data-testid="sign-out"
                title={words().shell.access.signedInAs(props.live.identity.me()?.name ?? "", words().shell.access.roles[role()])}
                onClick={() => void props.live.identity.signOut()}
              >
                {words().shell.access.signOut(words().shell.access.roles[role()])}
              </button>
            )}
          </Show>
          <button
            type="button"
            class="tool"
            data-testid="switch-theme"
            aria-label={words().shell.theme.change}
            title={words().shell.theme.change}
            onClick={() => {
              props.appearance.switchTheme();
            }}
          >
            {theme() === "dark" ? words().shell.theme.dark : words().shell.theme.light}
          </button>
          <button
            type="button"
            class="tool"
            data-testid="switch-language"
            aria-label={words().shell.language.change}
            title={words().shell.language.change}
            onClick={() => {
              props.appearance.switchLanguage();
            }}
          >
            {LANGUAGES.find((entry) => entry.language === language())?.word}
          </button>
          <button
            type="button"
            class="tool"
            data-testid="show-shortcuts"
            aria-label={words().shell.shortcutsButton}
            title={words().shell.shortcutsButton}
            aria-keyshortcuts="?"
            onClick={() => {
              props.help();
            }}
          >
            ?
          </button>
        </div>
      </div>
      <StopButton press={props.live.pressStop} />
    </header>
  );
}
