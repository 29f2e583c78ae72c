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
  /** False turns the single-key shortcuts off: who dictates speaks letters. */
  readonly shortcuts?: boolean;
}

/** The preferences of one user, and the way to change them. */
export interface PreferenceStore {
  readonly preferences: Accessor<Preferences>;
  /** What is given as undefined goes back to its default. */
  readonly change: (change: { readonly [Key in keyof Preferences]: Preferences[Key] | undefined }) => void;
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
      const next = Object.fromEntries(Object.entries({ ...preferences(), ...change }).filter(([, value]) => value !== undefined));
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
    if (typeof found !== "object" || found === null) return {};
    return Object.fromEntries(Object.entries(found).filter(([name, value]) => isReadable(name, value)));
  } catch {
    return {};
  }
}

function isReadable(name: string, value: unknown): boolean {
  switch (name) {
    case "theme":
      return value === "dark" || value === "light";
    case "language":
      return value === "en" || value === "fr";
    case "tourDone":
    case "shortcuts":
      return typeof value === "boolean";
    case "layout":
      return typeof value === "object" && value !== null && !Array.isArray(value);
    default:
      return false;
  }
}

function keyOf(user: string): string {
  return `covr.preferences.${user}`;
}
