/**
 * Dark or light. The page wears its theme as `data-theme` on the root element; `public/theme.js` puts the last one on
 * before the first paint. The canvas's colours are read from the page's own, so that both change together.
 */
import { createSignal } from "solid-js";
import type { SeparationTerm } from "../api/types";

/** What the page looks like. */
export type Theme = "dark" | "light";

const [theme, setTheme] = createSignal<Theme>("dark");

/** The theme that the page wears; whoever has read the palette reads it again when this changes. */
export { theme };

/** Puts a theme on. Without a choice of the user's it is the system's, and follows it. */
export function useTheme(choice: Theme | undefined, system: Theme): void {
  const next = choice ?? system;
  document.documentElement.dataset["theme"] = next;
  try {
    if (choice === undefined) localStorage.removeItem(KEY);
    else localStorage.setItem(KEY, choice);
  } catch {
    // A browser that keeps nothing starts with the system's theme.
  }
  setTheme(next);
}

/** Colours by what they mean, each as #rrggbb. */
export interface Palette {
  readonly ground: string;
  readonly grid: string;
  readonly gridWhole: string;
  readonly text: string;
  readonly muted: string;
  readonly arena: string;
  readonly travel: string;
  readonly column: string;
  readonly prop: string;
  readonly object: string;
  readonly predicted: string;
  readonly person: string;
  readonly danger: string;
  readonly near: string;
  readonly keepOut: string;
  /** The terms of the separation rule. */
  readonly terms: Readonly<Record<SeparationTerm, string>>;
}

/** Reads the palette as it is now. */
export function readPalette(element: Element): Palette {
  const style = getComputedStyle(element);
  const colour = (name: string): string => style.getPropertyValue(`--${name}`).trim();
  return {
    ground: colour("ground"),
    grid: colour("grid"),
    gridWhole: colour("grid-whole"),
    text: colour("text"),
    muted: colour("muted"),
    arena: colour("arena"),
    travel: colour("travel"),
    column: colour("column"),
    prop: colour("prop"),
    object: colour("object"),
    predicted: colour("predicted"),
    person: colour("person"),
    danger: colour("danger"),
    near: colour("warn"),
    keepOut: colour("keep-out"),
    terms: {
      reaction: colour("term-reaction"),
      braking: colour("term-braking"),
      walking: colour("term-walking"),
      age: colour("term-age"),
    },
  };
}

/** `public/theme.js` reads it too. */
const KEY = "covr.theme";
