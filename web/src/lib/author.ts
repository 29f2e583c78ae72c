/** Who sits at this page, as the server's records name them. Kept by the browser. */

/** The name last given, else a plain one. */
export function readAuthor(): string {
  try {
    return localStorage.getItem(KEY) ?? UNNAMED;
  } catch {
    return UNNAMED;
  }
}

/** Keeps a name, and says what was kept. */
export function writeAuthor(name: string): string {
  const kept = name.trim() === "" ? UNNAMED : name.trim();
  try {
    localStorage.setItem(KEY, kept);
  } catch {
    // A browser that keeps nothing: the name holds until the page goes.
  }
  return kept;
}

const KEY = "covr.author";
const UNNAMED = "game master";
