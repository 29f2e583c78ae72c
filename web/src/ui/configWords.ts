/** What the configuration's keys mean and accept, in the page's language. */
import type { Accepts, ConfigKey } from "../api/types";
import { language, words } from "../i18n";
import { config as french } from "../i18n/fr/config";
import type { Said } from "../lib/reasonWords";

/** What a key means: in English as the server says it. */
export function meaningOf(key: ConfigKey): Said {
  if (language() === "en") return { text: key.meaning };
  const text = french[key.name];
  return text === undefined ? { text: key.meaning, lang: "en" } : { text };
}

/** What a key accepts. */
export function acceptsOf(takes: Accepts): string {
  const say = words().settings.accepts;
  switch (takes.kind) {
    case "number":
      return say.number(takes.least, takes.most);
    case "whole":
      return say.whole(takes.least, takes.most);
    case "one_of":
      return say.oneOf(takes.names.map((name) => `"${name}"`).join(", "), takes.names.length);
    default:
      return say[takes.kind];
  }
}
