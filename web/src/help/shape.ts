/** What the help consists of. Each language fills all of it, or it does not compile. */

/** Every safety rule. */
export const RULES = ["R1", "R2", "R3", "R4", "R5", "R6", "R7", "R8", "R9", "R10", "R11", "R12", "R13", "R14", "R15", "R16"] as const;
/** A safety rule by its id. */
export type RuleName = (typeof RULES)[number];

/** Every stop: each rule's own, and those that have a cause beside the rules. */
export const STOPS = ["R4", "R1", "R2", "R5", "R6", "R7", "R8", "R9", "R10", "R12", "R15", "homing", "restart"] as const;
/** A stop by the rule that demands it, or by its own name. */
export type StopName = (typeof STOPS)[number];

/** Rules that this version shows and does not watch yet. */
export const UNWATCHED: ReadonlySet<RuleName> = new Set(["R14"]);

/** What the help says of a rule. */
export interface RuleHelp {
  readonly watches: string;
  readonly happens: string;
  readonly you: string;
  readonly clears: string;
}

/** What the help says of a stop: one thing to do after the other. */
export interface StopHelp {
  readonly title: string;
  readonly happened: string;
  readonly steps: readonly string[];
}

/** The whole help in one language. */
export interface HelpText {
  readonly title: string;
  readonly contents: string;
  readonly first: { readonly title: string; readonly steps: readonly string[] };
  readonly softwareStop: { readonly title: string; readonly paragraphs: readonly string[] };
  readonly kinds: { readonly title: string; readonly rows: readonly (readonly [word: string, meaning: string])[] };
  readonly stopsTitle: string;
  readonly stops: Readonly<Record<StopName, StopHelp>>;
  readonly rulesTitle: string;
  readonly rules: Readonly<Record<RuleName, RuleHelp>>;
  readonly labels: {
    readonly watches: string;
    readonly happens: string;
    readonly you: string;
    readonly clears: string;
    readonly happened: string;
    readonly notWatched: string;
    readonly itsStop: string;
    readonly now: string;
    readonly tour: string;
    readonly shortcuts: string;
    readonly unknown: (what: string) => string;
  };
  readonly glossary: { readonly title: string; readonly rows: readonly (readonly [word: string, meaning: string])[] };
}
