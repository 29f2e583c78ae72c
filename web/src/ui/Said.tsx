/** A sentence with its language, where it is not the page's. */
import type { JSX } from "solid-js";
import type { Said as Sentence } from "../lib/reasonWords";

/** One span. */
export function Said(props: { readonly of: Sentence; readonly class?: string; readonly testId?: string }): JSX.Element {
  return (
    <span class={props.class} lang={props.of.lang} data-testid={props.testId}>
      {props.of.text}
    </span>
  );
}
