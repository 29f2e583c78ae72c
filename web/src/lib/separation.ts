/** The separation rule in rings and bars: its terms in the order in which they add up. */
import type { SeparationTerm, SeparationTerms } from "../api/types";

/** One term's share of what is required. */
export interface Ring {
  readonly term: SeparationTerm | "radius";
  /** How much it adds, m. */
  readonly metres: number;
  /** What is required with it and all before it, m. */
  readonly outer: number;
  /** The greatest of those beyond the radius. */
  readonly binds: boolean;
}

/** How near a person is: under what is required, close to it, or clear of it. */
export type Nearness = "breached" | "near" | "clear";

/** The rings about a person, innermost first; a term of nothing has none. */
export function ringsOf(terms: SeparationTerms): readonly Ring[] {
  const rings: Ring[] = [];
  let outer = 0;
  for (const [term, metres] of [
    ["radius", terms.radius_m],
    ["reaction", terms.reaction_m],
    ["braking", terms.braking_m],
    ["walking", terms.walking_m],
    ["age", terms.age_m],
  ] as const) {
    if (!(metres > 0)) continue;
    outer += metres;
    rings.push({ term, metres, outer, binds: term === terms.binding });
  }
  return rings;
}

/** How much the binding term adds, m. */
export function bindingMetres(terms: SeparationTerms): number {
  return { reaction: terms.reaction_m, braking: terms.braking_m, walking: terms.walking_m, age: terms.age_m }[terms.binding];
}

/** How near a person is. */
export function nearnessOf(person: { readonly distance_m: number; readonly required_m: number }): Nearness {
  if (person.distance_m < person.required_m) return "breached";
  return person.distance_m < person.required_m + NEAR_M ? "near" : "clear";
}

/** Within this of the required distance somebody is near, m. */
const NEAR_M = 0.1;
