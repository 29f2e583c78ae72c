/** Everything that the check finds; each leads to the thing that it is about. */
import { For, type JSX } from "solid-js";
import { selectionOf, type Editor } from "../editor";
import type { Selection } from "../selection";
import { say } from "../words";
import { FindingText } from "./fields";

/** The list. */
export function Findings(props: { readonly editor: Editor; readonly chose: (selection: Selection) => void }): JSX.Element {
  return (
    <section class="panel edit-findings scrolls" tabindex="0" aria-labelledby="edit-findings-title">
      <h2 id="edit-findings-title">{say().check.title}</h2>
        <ul>
          <For each={props.editor.findings()}>
            {(finding) => (
              <li>
                <button type="button" class="edit-entry" data-grade={finding.grade} data-testid={`finding-${finding.grade}`} onClick={() => { props.chose(selectionOf(finding)); }}>
                  <span>
                    <code>{finding.path}</code> <FindingText finding={finding} />
                  </span>
                </button>
              </li>
            )}
          </For>
        </ul>
    </section>
  );
}

/** What the check says in one line. */
export function CheckLine(props: { readonly editor: Editor }): JSX.Element {
  const text = (): string => {
    const check = props.editor.check();
    const words = say().check;
    switch (check.kind) {
      case "checking":
        return words.checking;
      case "passed":
        return `${words.passed(props.editor.scene().objects.length)}${check.warnings.length > 0 ? ` ${words.warnings(check.warnings.length)}` : ""}`;
      case "refused":
        return words.refused(check.errors.length);
      case "failed":
        return words.failed(check.detail);
    }
  };
  return (
    <p role="status" class="edit-check" data-kind={props.editor.check().kind} data-testid="editor-check">
      {text()}
    </p>
  );
}
