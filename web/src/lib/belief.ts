/** The belief as shares: the likeliest objects each, the others together, and none of them. Pure. */
import type { ObjectState } from "../api/types";

/** One share of the belief. */
export interface Share {
  readonly of: { readonly kind: "object"; readonly id: string } | { readonly kind: "others"; readonly count: number } | { readonly kind: "none" };
  /** 0 to 1. */
  readonly probability: number;
}

/** What to show: at most some objects, the likeliest first, each of some account; nothing without a belief. */
export function sharesOf(objects: readonly ObjectState[], noneProbability: number): readonly Share[] {
  const likely = objects.filter(({ probability }) => probability > 0).sort((one, other) => other.probability - one.probability);
  const shown = likely.slice(0, MOST_OBJECTS).filter(({ probability }, index) => index === 0 || probability >= LEAST_SHOWN);
  const others = likely.slice(shown.length);
  const rest = others.reduce((sum, { probability }) => sum + probability, 0);
  return [
    ...shown.map(({ id, probability }): Share => ({ of: { kind: "object", id }, probability })),
    ...(rest >= LEAST_REST ? [{ of: { kind: "others", count: others.length }, probability: rest } as const] : []),
    ...(noneProbability >= LEAST_REST ? [{ of: { kind: "none" }, probability: noneProbability } as const] : []),
  ];
}

const MOST_OBJECTS = 3;
const LEAST_SHOWN = 0.05;
/** What reads as 1 % and more. */
const LEAST_REST = 0.005;
