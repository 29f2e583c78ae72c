/** Decides how values read: fixed digits, so that nothing jumps about while it changes. */
import type { Mode } from "../api/types";
import { language, words } from "../i18n";

/** A number with so many digits after the decimal sign of the page's language. */
export function decimal(value: number, digits: number): string {
  const plain = value.toFixed(digits);
  return language() === "fr" ? plain.replace(".", ",") : plain;
}

/** Two numbers beside one another, told apart from their decimal signs. */
export function pair([first, second]: readonly [number, number], digits: number): string {
  return `${decimal(first, digits)}${language() === "fr" ? " ; " : ", "}${decimal(second, digits)}`;
}

/** Metres with two digits, sign kept. */
export function metres(value: number): string {
  return decimal(value, 2);
}

/** A short span: `0.42 s`, `12 s`, `3 min 05 s`, `2 h 10 min`. */
export function span(secs: number): string {
  if (secs < 10) return `${decimal(Math.max(0, secs), 1)} s`;
  const whole = Math.floor(secs);
  if (whole < 60) return `${whole} s`;
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${pad(whole % 60)} s`;
  return `${Math.floor(whole / 3600)} h ${pad(Math.floor((whole % 3600) / 60))} min`;
}

/** Milliseconds, one digit below ten. */
export function millis(value: number): string {
  return `${value < 9.95 ? decimal(value, 1) : String(Math.round(value))} ms`;
}

/** A share as whole percent. */
export function percent(share: number): string {
  return `${Math.round(share * 100)} %`;
}

/** A mode in the words of the glossary. */
export function modeWords(mode: Mode): string {
  return words().shell.modes[mode];
}

/** The time of day of an RFC 3339 moment, in the reader's own zone; the text itself if it is none. */
export function timeOfDay(moment: string): string {
  const date = new Date(moment);
  if (Number.isNaN(date.getTime())) return moment;
  return `${pad(date.getHours())}:${pad(date.getMinutes())}:${pad(date.getSeconds())}`;
}

/** Day and time of an RFC 3339 moment, in the reader's own zone; the text itself if it is none. */
export function dayAndTime(moment: string): string {
  const date = new Date(moment);
  if (Number.isNaN(date.getTime())) return moment;
  return `${date.getFullYear()}-${pad(date.getMonth() + 1)}-${pad(date.getDate())} ${timeOfDay(moment)}`;
}

function pad(value: number): string {
  return String(value).padStart(2, "0");
}
