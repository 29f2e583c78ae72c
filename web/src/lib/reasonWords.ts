/** What the server says, in the page's language: the sentence of a reason by its id, else the server's own English. */
import type { Reason } from "../api/types";
import { words } from "../i18n";
import type { Sayings } from "../i18n/reasons";
import { decimal, modeWords } from "./format";

/** A sentence, and its language where it is not the page's. */
export interface Said {
  readonly text: string;
  readonly lang?: "en";
}

/** A reason in words; null for one that this page does not know. */
export function reasonWords(reason: Reason, label: (object: string) => string = (id) => id): string | null {
  const sentences: Readonly<Record<string, ((given: never, say: Sayings) => string) | undefined>> = words().reasons;
  const sentence = sentences[reason.id];
  if (sentence === undefined) return null;
  return sentence(reason as never, {
    number: decimal,
    object: label,
    mode: (mode) => modeWords(mode).toLowerCase(),
    request: requestWords,
    reason: (inner) => reasonWords(inner, label) ?? inner.id,
  });
}

/** The same for what came with the server's English. */
export function said(reason: Reason | null | undefined, english: string, label?: (object: string) => string): Said {
  const text = reason === null || reason === undefined ? null : reasonWords(reason, label);
  return text === null ? { text: english, lang: "en" } : { text };
}

/** Clauses as one sentence, as the server joins them. */
export function clauses(reasons: readonly Reason[], english: string, label?: (object: string) => string): Said {
  const texts = reasons.map((reason) => reasonWords(reason, label));
  const known = texts.filter((text) => text !== null);
  return texts.length === 0 || known.length < texts.length ? { text: english, lang: "en" } : { text: known.join(words().live.betweenClauses) };
}

/** A request by its name on the wire; the name itself for one that the page does not know. */
export function requestWords(name: string): string {
  const requests: Readonly<Record<string, string>> = words().desk.events.requests;
  return requests[name] ?? name;
}
