/** How a user has arranged the desk: read from the preferences, where anything may stand; what does not fit is the standard. */
import type { PreferenceStore } from "./preferences";

/** The arrangement, by the desk's own keys. */
export interface Layout {
  /** A size within its limits. */
  readonly size: (key: string, limits: Limits) => number;
  /** Something that is on or off. */
  readonly flag: (key: string, standard: boolean) => boolean;
  /** One of several; the first is the standard. */
  readonly choice: <Choice extends string>(key: string, choices: readonly [Choice, ...Choice[]]) => Choice;
  readonly keep: (key: string, value: string | number | boolean) => void;
  /** Everything as it was at first. */
  readonly reset: () => void;
}

/** What a size can be, px. */
export interface Limits {
  readonly least: number;
  readonly greatest: number;
  readonly standard: number;
}

/** The layout of whoever the preferences belong to now. */
export function createLayout(store: PreferenceStore): Layout {
  const kept = (key: string): unknown => store.preferences().layout?.[key];
  return {
    size: (key, { least, greatest, standard }) => {
      const value = kept(key);
      return typeof value === "number" && Number.isFinite(value) ? Math.min(greatest, Math.max(least, value)) : standard;
    },
    flag: (key, standard) => {
      const value = kept(key);
      return typeof value === "boolean" ? value : standard;
    },
    choice: (key, choices) => {
      const value = kept(key);
      return choices.find((choice) => choice === value) ?? choices[0];
    },
    keep: (key, value) => {
      store.change({ layout: { ...store.preferences().layout, [key]: value } });
    },
    reset: () => {
      store.change({ layout: {} });
    },
  };
}
