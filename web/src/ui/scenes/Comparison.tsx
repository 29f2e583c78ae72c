/** Two versions of a scene side by side in one list: what changed in the room, and line by line. */
import { createEffect, createMemo, createSignal, For, on, Show, type JSX } from "solid-js";
import { words } from "../../i18n";
import type { SceneDocument } from "../../api/types";
import { changesBetween, diffScenes, foldDiff, type DiffLine } from "../../lib/sceneDiff";
import { changeWords } from "./changeWords";

/** Summary and lines; what is the same far and wide unfolds on demand. */
export function Comparison(props: { readonly before: SceneDocument; readonly after: SceneDocument }): JSX.Element {
  const changes = createMemo(() => changesBetween(props.before, props.after));
  const parts = createMemo(() => foldDiff(diffScenes(props.before, props.after), AROUND));
  const [unfolded, setUnfolded] = createSignal<ReadonlySet<number>>(new Set());
  createEffect(on(parts, () => setUnfolded(new Set<number>()), { defer: true }));
  return (
    <Show when={parts().some(({ kind }) => kind === "lines")} fallback={<p class="empty" data-testid="diff-same">{words().records.diff.same}</p>}>
      <h3>{words().records.diff.summary}</h3>
      <ul class="diff-summary" data-testid="diff-summary">
        <For each={changes()}>{(change) => <li>{changeWords(change)}</li>}</For>
      </ul>
      <h3 id="diff-lines">{words().records.diff.lines}</h3>
      <div class="diff scrolls" role="region" tabindex="0" aria-labelledby="diff-lines" data-testid="diff">
        <For each={parts()}>
          {(part, index) => (
            <Show
              when={part.kind === "lines" || unfolded().has(index())}
              fallback={
                <button type="button" class="quiet diff-skipped" onClick={() => setUnfolded((open) => new Set([...open, index()]))}>
                  {words().records.diff.skipped(part.lines.length)}
                </button>
              }
            >
              <For each={part.lines}>{(line) => <Line line={line} />}</For>
            </Show>
          )}
        </For>
      </div>
    </Show>
  );
}

function Line(props: { readonly line: DiffLine }): JSX.Element {
  const sign = { same: " ", added: "+", removed: "−" } as const;
  const word = (): string => (props.line.kind === "same" ? "" : `${words().records.diff[props.line.kind]}: `);
  return (
    <div class="diff-line" data-kind={props.line.kind}>
      <span class="diff-number" aria-hidden="true">{props.line.from ?? ""}</span>
      <span class="diff-number" aria-hidden="true">{props.line.to ?? ""}</span>
      <span class="diff-sign" aria-hidden="true">{sign[props.line.kind]}</span>
      <code>
        <span class="unseen">{word()}</span>
        {props.line.text}
      </code>
    </div>
  );
}

/** Unchanged lines that are shown about a change. */
const AROUND = 3;
