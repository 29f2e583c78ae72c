/** What the server found and expected somewhere, in the page's language; its own English where the page has no words. */
import type { Phrase, SceneError } from "../api/types";
import { language } from "../i18n";
import { phrases as french } from "../i18n/fr/phrases";
import type { Said } from "./reasonWords";

/** A phrase in words. A text without one is a value as it stands, and reads the same in every language. */
export function phraseWords(phrase: Phrase | undefined, english: string): Said {
  if (language() === "en") return { text: english };
  const said = phrase === undefined ? undefined : french[phrase.id];
  if (phrase === undefined || said === undefined) return isValue(english) ? { text: english } : { text: english, lang: "en" };
  return { text: said.replace(/\{(\w+)\}/g, (hole, name: string) => phrase.values[name] ?? hole) };
}

/** What was found and what was expected. */
export function errorWords(error: SceneError): { readonly found: Said; readonly expected: Said } {
  return { found: phraseWords(error.found_as, error.found), expected: phraseWords(error.expected_as, error.expected) };
}

/** A number, something in quotation marks, a list. */
function isValue(text: string): boolean {
  return /^(".*"|`.*`|\[.*\]|true|false|null)$/s.test(text) || (text.trim() !== "" && !Number.isNaN(Number(text)));
}
