/** Theme and language of the present user, put on the page and kept with every change. */
import { createRenderEffect, createSignal, onCleanup } from "solid-js";
import { language, preferredLanguage, useLanguage } from "../i18n";
import type { PreferenceStore } from "./preferences";
import { theme, useTheme, type Theme } from "./theme";

/** What the shell's switches and keys do. */
export interface Appearance {
  readonly switchTheme: () => void;
  readonly switchLanguage: () => void;
}

/** Follows the user's preferences; where there is none, the system and the browser. */
export function createAppearance(store: PreferenceStore): Appearance {
  const light = matchMedia("(prefers-color-scheme: light)");
  const system = (): Theme => (light.matches ? "light" : "dark");
  const [asked, setAsked] = createSignal(system());
  const changed = (): void => {
    setAsked(system());
  };
  light.addEventListener("change", changed);
  onCleanup(() => {
    light.removeEventListener("change", changed);
  });
  // Before anything is drawn, so that nothing is drawn twice.
  createRenderEffect(() => {
    useTheme(store.preferences().theme, asked());
  });
  createRenderEffect(() => {
    useLanguage(store.preferences().language ?? preferredLanguage(navigator.languages));
  });
  return {
    switchTheme: () => {
      store.change({ theme: theme() === "dark" ? "light" : "dark" });
    },
    switchLanguage: () => {
      store.change({ language: language() === "en" ? "fr" : "en" });
    },
  };
}
