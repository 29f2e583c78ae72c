/** What the catalogues of reasons must have: a sentence for each id that the server may send. */
import type { CalibrationRefusal, Mode, Reason } from "../api/types";

/** How the values of a reason read in the page's language. */
export interface Sayings {
  /** A number with so many digits after the decimal sign. */
  readonly number: (value: number, digits: number) => string;
  /** An object's label, by its id. */
  readonly object: (id: string) => string;
  readonly mode: (mode: Mode) => string;
  /** A request: `home`, `arm`, ... */
  readonly request: (name: string) => string;
  /** A reason inside a reason. */
  readonly reason: (reason: Reason) => string;
}

/** One sentence for each reason; a missing one does not compile. */
export type ReasonSentences = {
  readonly [Id in Reason["id"]]: (given: Extract<Reason, { readonly id: Id }>, say: Sayings) => string;
};

/** One sentence for each refusal of a calibration; a missing one does not compile. */
export type RefusalSentences = {
  readonly [Id in CalibrationRefusal["id"]]: (given: Extract<CalibrationRefusal, { readonly id: Id }>, number: Sayings["number"]) => string;
};

/** The sentence of a refusal. */
export function refusalSentence(sentences: RefusalSentences, refusal: CalibrationRefusal, number: Sayings["number"]): string {
  // The id picks the sentence that takes this very refusal; the compiler cannot tell.
  return (sentences[refusal.id] as (given: CalibrationRefusal, number: Sayings["number"]) => string)(refusal, number);
}

/** Scales that a wrong unit gives: from a half to twice the ratio of the two. */
export const CENTIMETRES_FOR_METRES = [0.005, 0.02] as const;
export const METRES_FOR_CENTIMETRES = [50, 200] as const;

/** Half a degree, which reads as 0°: somebody looks at what is nearer than this to their view axis, rad. */
export const AT_RAD = Math.PI / 360;
