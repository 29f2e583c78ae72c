/**
 * A dialog that leaves the stop in reach: it covers the view, never the header. What lies behind is inert, so the focus
 * stays in the dialog and on the stop. Esc does not close it: Esc stops the machine, everywhere.
 */
import { onCleanup, onMount, type JSX } from "solid-js";
import { words } from "../i18n";

/** A title, the content, and a button that closes it; the focus goes back to where it was. */
export function Dialog(props: {
  readonly title: string;
  readonly testId: string;
  readonly close: () => void;
  readonly children: JSX.Element;
}): JSX.Element {
  let heading!: HTMLHeadingElement;
  const before = document.activeElement;
  onMount(() => {
    heading.focus();
  });
  onCleanup(() => {
    // What is behind is inert until the dialog is gone.
    queueMicrotask(() => {
      if (before instanceof HTMLElement && before.isConnected) before.focus();
    });
  });
  return (
    <div class="dialog-ground">
      <div class="dialog" role="dialog" aria-labelledby="dialog-title" data-testid={props.testId}>
        <div class="dialog-head">
          <h2 id="dialog-title" tabindex="-1" ref={heading}>
            {props.title}
          </h2>
          <button
            type="button"
            data-testid={`${props.testId}-close`}
            onClick={() => {
              props.close();
            }}
          >
            {words().shell.shortcuts.close}
          </button>
        </div>
        <div class="dialog-body scrolls" tabindex="0" role="region" aria-labelledby="dialog-title">
          {props.children}
        </div>
      </div>
    </div>
  );
}
