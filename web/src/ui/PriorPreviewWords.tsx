/** What the edited priors would lead to, in words: whom and what the column serves now, and would serve then. */
import { Match, Show, Switch, type JSX } from "solid-js";
import type { Column, Person } from "../api/types";
import { words } from "../i18n";
import type { PreviewState } from "../live/preview";

/** Now and then. */
export function PriorPreviewWords(props: {
  readonly state: PreviewState;
  readonly column: Column | null;
  readonly persons: readonly Person[];
  readonly label: (object: string) => string;
}): JSX.Element {
  const text = (): ReturnType<typeof words>["desk"]["priors"] => words().desk.priors;
  const serving = (found: Pick<Column, "committed" | "serves"> | null): string => {
    if (found === null || found.committed === null || found.serves === null) return text().servingNobody;
    const person = props.persons.find(({ id }) => id === found.serves);
    return text().serving(props.label(found.committed), person?.name ?? text().person(found.serves));
  };
  const then = (): Pick<Column, "committed" | "serves"> | null => {
    const { state } = props;
    return state.kind === "shown" ? state.preview : state.kind === "asking" ? state.last : null;
  };
  return (
    <Show when={props.state.kind !== "none"}>
      <div class="prior-preview" role="status" aria-label={text().preview} data-testid="prior-preview" data-state={props.state.kind}>
        <Switch>
          <Match when={props.state.kind === "failed" ? props.state : null}>
            {(failed) => (
              <p class="bad" data-testid="prior-preview-failed">
                {text().previewFailed} {failed().why}
              </p>
            )}
          </Match>
          <Match when={then() === null}>
            <p>{text().previewAsked}</p>
          </Match>
          <Match when={then()}>
            {(found) => (
              <dl>
                <div>
                  <dt>{text().servesNow}</dt>
                  <dd>{serving(props.column)}</dd>
                </div>
                <div>
                  <dt>{text().wouldServe}</dt>
                  <dd class="then" data-testid="prior-would-serve">{serving(found())}</dd>
                </div>
              </dl>
            )}
          </Match>
        </Switch>
      </div>
    </Show>
  );
}
