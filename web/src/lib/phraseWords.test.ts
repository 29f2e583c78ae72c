// @vitest-environment happy-dom
import { afterEach, expect, it } from "vitest";
import SENTENCES from "../api/generated/sentences.json";
import { useLanguage } from "../i18n";
import { phrases as french } from "../i18n/fr/phrases";
import { phraseWords } from "./phraseWords";

/** Every phrase that the server may say, by id, with its English; the server's tests write it. */
const ALL = Object.entries(SENTENCES.phrases);
/** Those that read the same in both languages. */
const SAME = new Set(["final_transitions", "json_or_csv", "size_found"]);

afterEach(() => {
  useLanguage("en");
});

it("has French for every phrase of the server, and for no other", () => {
  expect(Object.keys(french).sort()).toEqual(ALL.map(([id]) => id).sort());
});

it.each(ALL)("says %s in French with its values", (id, english) => {
  useLanguage("fr");
  const holes = [...english.matchAll(/\{(\w+)\}/g)].map(([, name]) => name ?? "");
  const values = Object.fromEntries(holes.map((name, index) => [name, `\u00ab${String(index)}\u00bb`]));
  const asked = english.replace(/\{(\w+)\}/g, (_, name: string) => values[name] ?? "");
  const { text, lang } = phraseWords({ id, values }, asked);
  expect(lang).toBeUndefined();
  expect(text).not.toMatch(/[{}](?!`)/);
  if (!SAME.has(id)) expect(text).not.toBe(asked);
  // The role is said by the refusal itself.
  for (const [name, value] of Object.entries(values)) if (id !== "role_may_not" || name !== "role") expect(text).toContain(value);
});

it("leaves values as they stand, and marks what it has no words for", () => {
  useLanguage("fr");
  expect(phraseWords(undefined, "\"lamp\"")).toEqual({ text: "\"lamp\"" });
  expect(phraseWords(undefined, "-1.5")).toEqual({ text: "-1.5" });
  expect(phraseWords({ id: "made_up", values: {} }, "something new")).toEqual({ text: "something new", lang: "en" });
  useLanguage("en");
  expect(phraseWords({ id: "nothing", values: {} }, "nothing")).toEqual({ text: "nothing" });
});
