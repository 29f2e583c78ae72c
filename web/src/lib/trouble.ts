/** What went wrong with a call to the server, in the page's language. */
import { Problem, Unanswered, Unreachable } from "../api/http";
import { words } from "../i18n";
import { reasonWords } from "./reasonWords";

/** An error in words; the error's own where nothing better is known. */
export function troubleOf(error: unknown): string {
  const say = words().shell.trouble;
  if (error instanceof Unreachable) return say.unreachable;
  if (error instanceof Unanswered) return say.unanswered(error.secs);
  if (error instanceof Problem) return problemWords(error);
  return error instanceof Error ? error.message : String(error);
}

function problemWords(problem: Problem): string {
  const why = problem.why === null ? null : reasonWords(problem.why);
  if (why !== null) return why;
  const kinds: Readonly<Record<string, string>> = words().shell.trouble.kinds;
  return kinds[problem.kind] ?? problem.message;
}
