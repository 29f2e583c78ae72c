/**
 * What each user of the page likes: theme, language, layout. Kept by the browser under the user's name; a value that
 * cannot be read is left out, never an error.
 */
import { createSignal, type Accessor } from "solid-js";

/** What is kept. Each part belongs to the area that reads it. */
export interface Preferences {
  readonly theme?: "dark" | "light";
  readonly language?: "en" | "fr";
  /** Layout of the live desk, by the desk's own keys. */
  readonly layout?: Readonly<Record<string, string | number | boolean>>;
  readonly tourDone?: boolean;
}

/** The preferences of one user, and the way to change them. */
export interface PreferenceStore {
  readonly preferences: Accessor<Preferences>;
  readonly change: (change: Partial<Preferences>) => void;
  /** Another user sits down. */
  readonly switchTo: (user: string) => void;
}

/** Reads a user's preferences and keeps each change. */
export function createPreferences(user: string): PreferenceStore {
  let key = keyOf(user);
  const [preferences, set] = createSignal(read(key));
  return {
    preferences,
    change: (change) => {
      const next = { ...preferences(), ...change };
      set(next);
      try {
        localStorage.setItem(key, JSON.stringify(next));
      } catch {
        // A browser that keeps nothing: it holds until the page goes.
      }
    },
    switchTo: (next) => {
      key = keyOf(next);
      set(read(key));
    },
  };
}

function read(key: string): Preferences {
  try {
    const found: unknown = JSON.parse(localStorage.getItem(key) ?? "{}");
    return typeof found === "object" && found !== null && !Array.isArray(found) ? found : {};
  } catch {
    return {};
  }
}

function keyOf(user: string): string {
  return `covr.preferences.${user}`;
}
