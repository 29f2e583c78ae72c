/** Every key that works now, from the registry that the keys themselves are looked up in. */
import { For, Show, type JSX } from "solid-js";
import { words } from "../i18n";
import { shortcuts, type ShortcutGroup } from "../lib/shortcuts";
import { Dialog } from "./Dialog";

/** The list under `?`. */
export function ShortcutsDialog(props: {
  readonly enabled: boolean;
  readonly enable: (enabled: boolean) => void;
  readonly close: () => void;
}): JSX.Element {
  const inGroup = (group: ShortcutGroup) => shortcuts().filter((shortcut) => shortcut.group === group);
  return (
    <Dialog title={words().shell.shortcuts.title} testId="shortcuts" close={props.close}>
      <p>{words().shell.shortcuts.closeKeys}</p>
      <Show when={!props.enabled}>
        <p class="answer refused">{words().shell.shortcuts.off}</p>
      </Show>
      <label class="check">
        <input
          type="checkbox"
          data-testid="shortcuts-enabled"
          checked={props.enabled}
          onChange={(event) => {
            props.enable(event.currentTarget.checked);
          }}
        />
        {words().shell.shortcuts.turnOff}
      </label>
      <div class="shortcut-groups">
        <section>
          <h3>{words().shell.shortcuts.groups.stop}</h3>
          <dl>
            <Row keys={words().shell.stop.escape} does={words().shell.shortcuts.escStops} />
            <Row keys={words().shell.stop.space} does={words().shell.shortcuts.spaceStops} />
            <Row keys={words().shell.stop.enter} does={words().shell.shortcuts.enterPresses} />
            <Row keys="Tab" does={words().shell.shortcuts.tabMoves} />
          </dl>
        </section>
        <For each={GROUPS}>
          {(group) => (
            <Show when={inGroup(group).length > 0}>
              <section>
                <h3>{words().shell.shortcuts.groups[group]}</h3>
                <dl>
                  <For each={inGroup(group)}>{(shortcut) => <Row keys={KEY_WORDS[shortcut.key] ?? shortcut.key} does={shortcut.does()} />}</For>
                </dl>
              </section>
            </Show>
          )}
        </For>
      </div>
    </Dialog>
  );
}

function Row(props: { readonly keys: string; readonly does: string }): JSX.Element {
  return (
    <div class="shortcut">
      <dt>
        <kbd>{props.keys}</kbd>
      </dt>
      <dd>{props.does}</dd>
    </div>
  );
}

const GROUPS: readonly ShortcutGroup[] = ["views", "machine", "picture", "page"];
const KEY_WORDS: Readonly<Record<string, string>> = { ArrowLeft: "←", ArrowRight: "→", ArrowUp: "↑", ArrowDown: "↓" };
