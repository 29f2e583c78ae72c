/**
 * The keyboard, as one registry: what is listed under `?` is what works. A shortcut never fires while somebody types,
 * never with Ctrl, Alt or Meta, and never takes a key of the stop.
 */
import { createSignal, onCleanup, untrack, type Accessor } from "solid-js";

/** Where a shortcut is listed. */
export type ShortcutGroup = "views" | "machine" | "page" | "picture";

/** One key and what it does. */
export interface Shortcut {
  /** As `KeyboardEvent.key` has it, letters in lower case; a digit also counts where it needs Shift. */
  readonly key: string;
  readonly group: ShortcutGroup;
  /** What it does, in the page's language. */
  readonly does: () => string;
  readonly run: () => void;
  /** Works only while the focus is in there, such as the keys of a picture; without it, everywhere. */
  readonly within?: () => Element | null | undefined;
}

const [registered, setRegistered] = createSignal<readonly (readonly Shortcut[])[]>([]);

/** Every shortcut that works now, in the order of registration. */
export const shortcuts: Accessor<readonly Shortcut[]> = () => registered().flat();

/** Registers shortcuts for as long as the component stands that calls it. A key that is taken is a bug, and is said. */
export function useShortcuts(mine: readonly Shortcut[]): void {
  const everywhere = (some: readonly Shortcut[]): string[] => some.filter(({ within }) => within === undefined).map(({ key }) => key);
  const taken = new Set(untrack(() => everywhere(shortcuts())));
  for (const key of everywhere(mine)) {
    if (taken.has(key)) throw new Error(`the key ${key} is taken`);
    taken.add(key);
  }
  for (const { key } of mine) if (RESERVED.has(key)) throw new Error(`the key ${key} belongs to the stop or to the browser`);
  setRegistered((all) => [...all, mine]);
  onCleanup(() => setRegistered((all) => all.filter((some) => some !== mine)));
}

/** Listens for the shortcuts; `enabled` is the user's word, `only` the keys that work while a dialog is open. */
export function listenForShortcuts(enabled: Accessor<boolean>, only: Accessor<ReadonlySet<string> | null>): void {
  const down = (event: KeyboardEvent): void => {
    if (event.defaultPrevented || event.repeat || event.isComposing || !enabled()) return;
    if (event.ctrlKey || event.altKey || event.metaKey || writes(event.target)) return;
    const key = keyOf(event);
    const here = (shortcut: Shortcut): boolean => shortcut.within?.()?.contains(event.target as Node) === true;
    const all = shortcuts().filter((shortcut) => shortcut.key === key);
    const shortcut = all.find(here) ?? all.find(({ within }) => within === undefined);
    if (shortcut === undefined || only()?.has(key) === false) return;
    event.preventDefault();
    shortcut.run();
  };
  window.addEventListener("keydown", down);
  onCleanup(() => {
    window.removeEventListener("keydown", down);
  });
}

/** Whether keys write, or choose by their letter, where the focus is. */
export function writes(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.isContentEditable || target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement) return true;
  return target instanceof HTMLInputElement && !WRITE_NOTHING.has(target.type);
}

/** French keyboards have the digits above Shift: there the place of the key counts. */
function keyOf(event: KeyboardEvent): string {
  const digit = /^Digit([0-9])$/.exec(event.code)?.[1];
  return digit !== undefined && !event.shiftKey && event.key.length === 1 ? digit : event.key.length === 1 ? event.key.toLowerCase() : event.key;
}

/** Stop, and what moves and presses in every browser. */
const RESERVED: ReadonlySet<string> = new Set(["Escape", " ", "Enter", "Tab"]);
const WRITE_NOTHING: ReadonlySet<string> = new Set(["button", "checkbox", "radio", "range", "file", "submit", "reset", "color"]);
