/** The editor's words in the page's language. */
import { language } from "../i18n";
import { editor as en } from "../i18n/en/editor";
import { editor as fr } from "../i18n/fr/editor";

/** Read it where it is shown, so that it follows a change. */
export function say(): typeof fr {
  return language() === "fr" ? fr : en;
}
