/** The software stop: on every view, always enabled, by pointer, touch and keyboard. */
import { onCleanup, onMount, type JSX } from "solid-js";
import { words } from "../i18n";

/** The button, with what it is and what it is not. */
export function StopButton(props: { readonly press: () => void }): JSX.Element {
  onMount(() => {
    const down = (event: KeyboardEvent): void => {
      if (!stopsByKey(event)) return;
      event.preventDefault();
      event.stopPropagation();
      if (!event.repeat) props.press();
    };
    // A focused button would click when the key comes up again.
    const up = (event: KeyboardEvent): void => {
      if (stopsByKey(event)) event.preventDefault();
    };
    window.addEventListener("keydown", down, { capture: true });
    window.addEventListener("keyup", up, { capture: true });
    onCleanup(() => {
      window.removeEventListener("keydown", down, { capture: true });
      window.removeEventListener("keyup", up, { capture: true });
    });
  });

  return (
    <div class="stop-corner">
      <p class="stop-note" id="stop-note">
        <b>{words().shell.stop.keys}</b> <kbd>{words().shell.stop.escape}</kbd> {words().shell.stop.always} <kbd>{words().shell.stop.space}</kbd>{" "}
        {words().shell.stop.unlessTyping} <br />
        {words().shell.stop.notTheEmergencyStop}
      </p>
      <button
        type="button"
        class="stop"
        data-testid="stop"
        aria-describedby="stop-note"
        aria-keyshortcuts="Escape Space"
        on:pointerdown={(event) => {
          if (event.button === 0) props.press();
        }}
        onClick={(event) => {
          // The pointer has pressed already, when it went down; Enter and assistive technology only click.
          if (event.detail === 0) props.press();
        }}
      >
        <span class="stop-word">{words().shell.stop.word}</span>
        <span class="stop-kind">{words().shell.stop.kind}</span>
      </button>
    </div>
  );
}

/** Escape always; Space unless it writes a character where the focus is. */
export function stopsByKey(event: KeyboardEvent): boolean {
  if (event.key === "Escape") return true;
  return event.code === "Space" && !event.ctrlKey && !event.altKey && !event.metaKey && !takesText(event.target);
}

function takesText(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.isContentEditable || target instanceof HTMLTextAreaElement) return true;
  return target instanceof HTMLInputElement && TEXT_INPUTS.has(target.type);
}

const TEXT_INPUTS: ReadonlySet<string> = new Set(["text", "search", "email", "url", "tel", "password", "number"]);
