/**
 * The page's words. Each area of the page has one catalogue per language; French has the same keys as English, or it
 * does not compile. What the server says comes as an id with values and is said here; what the page does not
 * know by its id is shown in the server's English, and marked so.
 */
import { createSignal } from "solid-js";
import * as en from "./en";
import * as fr from "./fr";

/** A language of the page. */
export type Language = "en" | "fr";

/** Every word of the page, by area. */
export type Messages = Widened<typeof en>;

/** The languages, each in its own words. */
export const LANGUAGES: readonly { readonly language: Language; readonly word: string }[] = [
  { language: "en", word: "English" },
  { language: "fr", word: "Français" },
];

const [language, setLanguage] = createSignal<Language>("en");
const CATALOGUES: Readonly<Record<Language, Messages>> = { en, fr };

export { language };

/** The words in the language of the page; read it where it is shown, so that it follows a change. */
export function words(): Messages {
  return CATALOGUES[language()];
}

/** Changes the language of the page, and says so to screen readers. */
export function useLanguage(next: Language): void {
  setLanguage(next);
  document.documentElement.lang = next;
}

/** The language that the browser asks for, as far as the page speaks it. */
export function preferredLanguage(asked: readonly string[]): Language {
  for (const tag of asked) {
    const found = LANGUAGES.find((entry) => tag.toLowerCase().startsWith(entry.language));
    if (found !== undefined) return found.language;
  }
  return "en";
}

/** The same keys and functions, any words. */
export type Widened<T> = T extends string
  ? string
  : T extends (...given: infer Given) => string
    ? (...given: Given) => string
    : { readonly [Key in keyof T]: Widened<T[Key]> };
