// @vitest-environment happy-dom
import { afterEach, expect, it } from "vitest";
import type { WireEvent } from "../api/types";
import { useLanguage } from "../i18n";
import { eventWords, particularsOf } from "./eventWords";

afterEach(() => {
  useLanguage("en");
});

const label = (id: string): string => ({ lamp: "Bedside lamp" })[id] ?? id;

function event(kind: string, detail: unknown, summary = "in the server's words"): WireEvent {
  return { at_micros: 1, at: "2026-01-01T10:00:00Z", kind, summary, detail };
}

it("says what happened in the page's language, with the objects' labels", () => {
  const prior = event("prior_changed", { author: "Grace", object: "lamp", from: 0.5, to: 1 });
  expect(eventWords(prior, label)).toEqual({ text: "Grace: prior of Bedside lamp 0.50 → 1.00", server: null });
  useLanguage("fr");
  expect(eventWords(prior, label).text).toBe("Grace : a priori de Bedside lamp 0,50 → 1,00");
  expect(eventWords(event("served", { person: 1, name: "Ada", object: "lamp" }), label).text).toBe("la colonne est à Bedside lamp pour Ada");
});

it("keeps what the server adds beside it", () => {
  const changed = event("mode_changed", { from: "following", to: "latched_stop", because: "software stop: drill" });
  expect(eventWords(changed, label)).toEqual({ text: "Following → Latched stop", server: { text: "software stop: drill", lang: "en" } });
  const stop = event("stop_pressed", { author: "Bo", by: "http", reason: null, to_drive_micros: 1840 });
  expect(eventWords(stop, label)).toEqual({ text: "Bo pressed stop; at the drive after 1.8 ms", server: null });
});

it("tells a stop by an input from one that somebody pressed", () => {
  const why = { id: "stop_input", input: "button" };
  const stop = event("stop_pressed", { author: "button", by: "input", reason: "the stop input button is active", why, to_drive_micros: 1840 });
  expect(eventWords(stop, label)).toEqual({ text: "stop by the input button; at the drive after 1.8 ms", server: { text: "the stop input button is active" } });
  useLanguage("fr");
  expect(eventWords(stop, label).server).toEqual({ text: "l’entrée d’arrêt button est active" });
});

it("says why in the page's language, where the server says which reason it is", () => {
  const why = { id: "pose_too_old", person: "Ada", age_secs: 0.6 };
  const breached = event("rule_breached", { rule: "R2", title: "tracking", reason: "the newest pose of Ada is 0.60 s old", why });
  expect(eventWords(breached, label).server).toEqual({ text: "the newest pose of Ada is 0.60 s old" });
  useLanguage("fr");
  expect(eventWords(breached, label)).toEqual({ text: "R2 enfreinte", server: { text: "Ada : la dernière pose date de 0,60 s" } });
  const changed = event("mode_changed", { from: "following", to: "protective_stop", rule: "R2", because: "R2: the newest pose …", why });
  expect(eventWords(changed, label).server).toEqual({ text: "R2 : Ada : la dernière pose date de 0,60 s" });
  const unknown = event("rule_breached", { rule: "R2", reason: "a new one", why: { id: "made_up" } });
  expect(eventWords(unknown, label).server).toEqual({ text: "a new one", lang: "en" });
});

it("falls back to the server's sentence for what it does not know", () => {
  for (const odd of [event("made_up", { a: 1 }), event("served", { object: null, name: "Ada" }), event("mode_changed", { from: "asleep", to: "ready" }), event("prior_changed", null)]) {
    expect(eventWords(odd, label)).toEqual({ text: null, server: { text: "in the server's words", lang: "en" } });
  }
});

it("lists particulars with names, units and unknown fields as they are", () => {
  const stop = event("stop_pressed", { author: "Bo", reason: null, to_drive_micros: 1840, colour: ["red"] });
  expect(particularsOf(stop, label).map(({ name, value }) => [name, value])).toEqual([["Who", "Bo"], ["Reason", "–"], ["To the drive", "1.8 ms"], ["colour", '["red"]']]);
  expect(particularsOf(event("x", "text"), label)).toEqual([]);
});

it("says by which token and role somebody acted", () => {
  const actor = { token: "front desk", token_id: "3f9a01bc", role: "game_master" };
  const stop = event("stop_pressed", { author: "Bo", by: "http", reason: null, to_drive_micros: 1840, actor });
  expect(eventWords(stop, label).text).toBe("Bo (front desk, game master) pressed stop; at the drive after 1.8 ms");
  expect(eventWords(event("stop_pressed", { author: "front desk", by: "http", reason: null, to_drive_micros: null, actor }), label).text).toContain("front desk (game master) pressed");
  expect(particularsOf(stop, label).at(-1)).toEqual({ name: "By token", value: "front desk, game master", foreign: false });
});
