// @vitest-environment happy-dom
import { afterEach, expect, it } from "vitest";
import KEYS from "../api/answers/configKeys.json";
import type { ConfigKey } from "../api/types";
import { useLanguage } from "../i18n";
import { config as french } from "../i18n/fr/config";
import { acceptsOf, meaningOf } from "./configWords";

afterEach(() => {
  useLanguage("en");
});

const key: ConfigKey = { name: "control.rate_hz", meaning: "Rate of the control loop, Hz.", value: 250, default: 250, accepts: "", takes: { kind: "number", least: 50, most: 1000 }, from: "default" };

it("means every key of the server in French, and no other", () => {
  expect(Object.keys(french).sort()).toEqual(Object.keys(KEYS).sort());
});

it("says meaning and what is accepted in the page's language", () => {
  expect([meaningOf(key).text, acceptsOf(key.takes)]).toEqual([key.meaning, "a number from 50 to 1000"]);
  useLanguage("fr");
  expect([meaningOf(key).text, acceptsOf(key.takes)]).toEqual(["Cadence de la boucle de commande, Hz.", "un nombre de 50 à 1000"]);
  expect(acceptsOf({ kind: "one_of", names: ["a", "b"] })).toBe('l’un de "a", "b"');
  expect(meaningOf({ ...key, name: "new.key" })).toEqual({ text: key.meaning, lang: "en" });
});
