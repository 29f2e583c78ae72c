// @vitest-environment happy-dom
import { afterEach, describe, expect, it } from "vitest";
import SENTENCES from "../api/generated/sentences.json";
import type { CalibrationRefusal, Reason } from "../api/types";
import { useLanguage } from "../i18n";
import * as en from "../i18n/en";
import * as fr from "../i18n/fr";
import { clauses, reasonWords, said } from "./reasonWords";

/** One of each reason that the server may send, with the server's own sentence; the server's tests write it. */
const ALL = SENTENCES.reasons as readonly { readonly reason: Reason; readonly text: string }[];

afterEach(() => {
  useLanguage("en");
});

describe("the catalogues of reasons", () => {
  it("have a sentence for every reason, and for no other", () => {
    const ids = ALL.map(({ reason }) => reason.id).sort();
    expect(new Set(ids).size).toBe(ids.length);
    expect(Object.keys(en.reasons).sort()).toEqual(ids);
    expect(Object.keys(fr.reasons).sort()).toEqual(ids);
  });

  it.each(ALL)("say $reason.id in English as the server does", ({ reason, text }) => {
    useLanguage("en");
    expect(reasonWords(reason)).toBe(text);
  });

  it.each(ALL)("say $reason.id in French, with every value", ({ reason, text }) => {
    useLanguage("fr");
    const sentence = reasonWords(reason) ?? "";
    expect(sentence).not.toBe("");
    expect(sentence).not.toBe(text);
    // Numbers have a decimal comma; names and ids are as they came.
    const numbers = text.match(/\d+(?:\.\d+)?/g) ?? [];
    for (const number of numbers) expect(sentence.replaceAll(",", ".")).toContain(number);
    expect(sentence).not.toMatch(/undefined|NaN|\[object/);
  });
});

describe("the catalogues of refused calibrations", () => {
  const REFUSED = SENTENCES.calibration_refusals as readonly { readonly refusal: CalibrationRefusal; readonly text: string }[];

  it.each(REFUSED)("say $refusal.id in English as the server does, and in French with every value", ({ refusal, text }) => {
    useLanguage("en");
    expect(reasonWords({ id: "bad_calibration", refusal })).toBe(text);
    useLanguage("fr");
    const sentence = reasonWords({ id: "bad_calibration", refusal }) ?? "";
    expect(sentence).not.toBe(text);
    for (const number of text.match(/\d+(?:\.\d+)?/g) ?? []) expect(sentence.replaceAll(",", ".")).toContain(number);
    expect(sentence).not.toMatch(/undefined|NaN|\[object/);
  });
});

describe("the catalogues of events", () => {
  it.each([["en", en], ["fr", fr]] as const)("have every kind, every request and every client's error in %s", (_, { desk, records }) => {
    for (const kind of SENTENCES.event_kinds) {
      expect(desk.events, kind).toHaveProperty(kind);
      expect(records.replay.kinds, kind).toHaveProperty(kind);
    }
    expect(Object.keys(desk.clientErrors).sort()).toEqual([...SENTENCES.client_errors].sort());
  });
});

describe("a sentence of the server", () => {
  it("is shown as it came, and marked as English, when the page does not know the reason", () => {
    expect(said({ id: "made_up" } as never, "something new")).toEqual({ text: "something new", lang: "en" });
    expect(said(null, "old")).toEqual({ text: "old", lang: "en" });
    expect(clauses([{ id: "stands_there" }, { id: "made_up" } as never], "stands there; new")).toEqual({ text: "stands there; new", lang: "en" });
  });

  it("joins its clauses, with objects by their labels", () => {
    useLanguage("fr");
    const why: readonly Reason[] = [{ id: "serves", person: "Ada", object: "lamp", weight: 0.5, probability: 0.5 }, { id: "stands_there" }];
    expect(clauses(why, "english", () => "Lampe").text).toBe("pour Ada, Lampe : poids 0,50 ; en place");
  });
});
