/** What went wrong with a call to the server, in the page's language. */
import { Problem, Unanswered, Unreachable } from "../api/http";
import { words } from "../i18n";
import { errorWords, phraseWords } from "./phraseWords";
import { reasonWords, type Said } from "./reasonWords";

/** An error in words; the error's own where nothing better is known. */
export function troubleOf(error: unknown): string {
  return troubleSaid(error).text;
}

/** The same, and its language where it is not the page's. */
export function troubleSaid(error: unknown): Said {
  const say = words().shell.trouble;
  if (error instanceof Unreachable) return { text: say.unreachable };
  if (error instanceof Unanswered) return { text: say.unanswered(error.secs) };
  if (error instanceof Problem) return problemWords(error);
  return { text: error instanceof Error ? error.message : String(error), lang: "en" };
}

/** By its reason, its phrase, its first error, its kind; else the server's English. */
function problemWords(problem: Problem): Said {
  const why = problem.why === null ? null : reasonWords(problem.why);
  if (why !== null) return { text: why };
  if (problem.detailAs !== null) return phraseWords(problem.detailAs, problem.message);
  const [first] = problem.errors;
  if (first !== undefined) {
    const { found, expected } = errorWords(first);
    const say = words().shell.trouble;
    return { text: say.item(first.path, found.text, expected.text) + (problem.errors.length > 1 ? say.more(problem.errors.length - 1) : "") };
  }
  const kinds: Readonly<Record<string, string>> = words().shell.trouble.kinds;
  const kind = kinds[problem.kind];
  return kind === undefined ? { text: problem.message, lang: "en" } : { text: kind };
}
