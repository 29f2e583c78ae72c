/** The shell's own shortcuts. A key never moves the machine: it leads to the button, and Enter presses that. */
import { words } from "../i18n";
import type { Appearance } from "../lib/appearance";
import { useShortcuts, type Shortcut } from "../lib/shortcuts";
import type { Live } from "../live/live";
import { VIEWS } from "../views/route";
import { whyNot } from "./Controls";

/** Registers them; `say` tells what cannot be seen. */
export function useShellShortcuts(shell: {
  readonly live: Live;
  readonly appearance: Appearance;
  readonly toggleHelp: () => void;
  readonly closeHelp: () => void;
  readonly say: (text: string) => void;
}): void {
  const goTo = (request: (typeof REQUESTS)[number]["request"]): void => {
    const button = document.querySelector(`[data-testid="${request}"]`);
    const reason = whyNot(shell.live, request);
    if (button instanceof HTMLButtonElement && !button.disabled) button.focus();
    else if (button !== null && reason !== null) shell.say(words().shell.shortcuts.notNow(words().shell.machine[request], reason));
    else if (button === null) {
      // The route listens since the page began: when this runs, the live view stands.
      window.addEventListener("hashchange", () => { goTo(request); }, { once: true });
      location.hash = "#/live";
    }
  };
  useShortcuts([
    ...VIEWS.map((view, index): Shortcut => ({
      key: String(index + 1),
      group: "views",
      does: () => words().shell.shortcuts.view(words().shell.pages[view]),
      run: () => {
        location.hash = `#/${view}`;
      },
    })),
    ...REQUESTS.map(({ key, request, does }): Shortcut => ({
      key,
      group: "machine",
      does,
      run: () => {
        goTo(request);
      },
    })),
    { key: "n", group: "page", does: () => words().shell.shortcuts.nextPanel, run: () => { focusPanel(1); } },
    { key: "p", group: "page", does: () => words().shell.shortcuts.previousPanel, run: () => { focusPanel(-1); } },
    { key: "/", group: "page", does: () => words().shell.shortcuts.search, run: focusSearch },
    { key: "t", group: "page", does: () => words().shell.shortcuts.theme, run: shell.appearance.switchTheme },
    { key: "l", group: "page", does: () => words().shell.shortcuts.language, run: shell.appearance.switchLanguage },
    { key: "?", group: "page", does: () => words().shell.shortcuts.help, run: shell.toggleHelp },
    { key: "q", group: "page", does: () => words().shell.shortcuts.close, run: shell.closeHelp },
  ]);
}

/** The keys that work while the list of shortcuts is open. */
export const KEYS_OF_THE_LIST: ReadonlySet<string> = new Set(["?", "q", "t", "l"]);

/** Moves the focus to the next or former panel of the view, round and round. */
function focusPanel(step: 1 | -1): void {
  const panels = [...document.querySelectorAll<HTMLElement>("main .panel")].filter((panel) => panel.offsetParent !== null);
  if (panels.length === 0) return;
  const at = panels.findIndex((panel) => panel.contains(document.activeElement));
  const next = at < 0 ? (step > 0 ? 0 : panels.length - 1) : (at + step + panels.length) % panels.length;
  const panel = panels[next];
  if (panel === undefined) return;
  if (!panel.hasAttribute("tabindex")) panel.tabIndex = -1;
  panel.focus();
  panel.scrollIntoView({ block: "nearest" });
}

function focusSearch(): void {
  const fields = document.querySelectorAll<HTMLElement>('main input[type="search"], main [data-search]');
  [...fields].find((field) => field.offsetParent !== null)?.focus();
}

const REQUESTS = [
  { key: "h", request: "home", does: () => words().shell.shortcuts.goHome },
  { key: "a", request: "arm", does: () => words().shell.shortcuts.goArm },
  { key: "d", request: "disarm", does: () => words().shell.shortcuts.goDisarm },
  { key: "r", request: "reset", does: () => words().shell.shortcuts.goReset },
] as const;
