/**
 * A scene's text with line numbers, and each finding beside its line. Only what is seen is drawn, so that a scene of some
 * megabytes opens at once. Tab leaves the field, Escape stops the machine as everywhere.
 */
import { createMemo, createSignal, For, onCleanup, onMount, type JSX } from "solid-js";
import { words } from "../../i18n";
import { errorWords } from "../../lib/phraseWords";
import { lineStarts, type PlacedError } from "../../lib/sceneText";

/** The text field; `reach` is given the way to a finding's place. */
export function SceneEditor(props: {
  readonly text: string;
  readonly errors: readonly PlacedError[];
  readonly edit: (text: string) => void;
  /** F8 was pressed: the next finding (1), or the one before (-1). */
  readonly step: (by: 1 | -1) => void;
  readonly reach: (goTo: (placed: PlacedError) => void) => void;
  readonly describedBy: string;
}): JSX.Element {
  let field!: HTMLTextAreaElement;
  const [scroll, setScroll] = createSignal({ top: 0, left: 0 });
  const [heightPx, setHeightPx] = createSignal(400);
  const starts = createMemo(() => lineStarts(props.text));
  const shown = createMemo(() => {
    const first = Math.max(0, Math.floor((scroll().top - PADDING_PX) / LINE_PX));
    const last = Math.min(starts().length - 1, first + Math.ceil(heightPx() / LINE_PX) + 1);
    return { first, last };
  });
  const numbers = (): string => {
    const { first, last } = shown();
    return Array.from({ length: last - first + 1 }, (_, index) => first + index + 1).join("\n");
  };
  const topOf = (line: number): string => `${(line - 1) * LINE_PX + PADDING_PX - scroll().top}px`;
  /** Findings by line, of the lines that are seen. */
  const marks = createMemo(() => {
    const byLine = new Map<number, PlacedError[]>();
    for (const placed of props.errors) {
      if (placed.line === null || placed.line - 1 < shown().first - 1 || placed.line - 1 > shown().last + 1) continue;
      byLine.set(placed.line, [...(byLine.get(placed.line) ?? []), placed]);
    }
    return [...byLine].map(([line, found]) => ({ line, found, columns: columnsOf(props.text, starts(), line) }));
  });

  const goTo = ({ line, offset }: PlacedError): void => {
    field.focus();
    field.setSelectionRange(offset, Math.min(props.text.length, offset + 1));
    if (line !== null) field.scrollTop = Math.max(0, (line - 1) * LINE_PX - heightPx() / 3);
    // The place itself is in sight, with what stands before it where there is room.
    const letterPx = parseFloat(getComputedStyle(field).fontSize) * LETTER_EM;
    const column = line === null ? 0 : offset - (starts()[line - 1] ?? 0);
    field.scrollLeft = Math.max(0, (column + IN_SIGHT) * letterPx - field.clientWidth);
  };
  onMount(() => {
    props.reach(goTo);
    const observer = new ResizeObserver(() => setHeightPx(field.clientHeight));
    observer.observe(field);
    onCleanup(() => {
      observer.disconnect();
    });
  });

  return (
    <div class="scene-editor" style={{ "--line-px": `${LINE_PX}px`, "--padding-px": `${PADDING_PX}px` }}>
      <div class="scene-marks" aria-hidden="true">
        <For each={marks()}>
          {(mark) => (
            <div class="scene-mark" data-testid="scene-mark" data-line={mark.line} style={{ top: topOf(mark.line) }}>
              <span style={{ left: `calc(${mark.columns + 2}ch - ${scroll().left}px)` }}>
                ◀ {mark.found.map(({ error }) => words().records.draft.mark(errorWords(error).found.text, errorWords(error).expected.text)).join("; ")}
              </span>
            </div>
          )}
        </For>
      </div>
      <div class="scene-numbers" aria-hidden="true">
        <pre style={{ top: topOf(shown().first + 1) }}>{numbers()}</pre>
        <For each={marks()}>{(mark) => <b style={{ top: topOf(mark.line) }}>{mark.line} !</b>}</For>
      </div>
      <textarea
        ref={field}
        data-testid="scene-text"
        aria-label={words().records.draft.text}
        aria-invalid={props.errors.length > 0}
        aria-describedby={props.describedBy}
        aria-keyshortcuts="F8 Shift+F8"
        wrap="off"
        spellcheck={false}
        autocomplete="off"
        autocapitalize="off"
        value={props.text}
        onInput={(event) => { props.edit(event.currentTarget.value); }}
        onScroll={(event) => setScroll({ top: event.currentTarget.scrollTop, left: event.currentTarget.scrollLeft })}
        onKeyDown={(event) => {
          if (event.key !== "F8") return;
          event.preventDefault();
          props.step(event.shiftKey ? -1 : 1);
        }}
      />
    </div>
  );
}

/** How wide a line is, in letters; tabs are as the field shows them. */
function columnsOf(text: string, starts: readonly number[], line: number): number {
  const from = starts[line - 1] ?? 0;
  let columns = 0;
  for (const character of text.slice(from, (starts[line] ?? text.length + 1) - 1)) columns += character === "\t" ? TAB - (columns % TAB) : 1;
  return columns;
}

const LINE_PX = 19;
const PADDING_PX = 8;
/** A letter of a fixed-width font is about this wide. */
const LETTER_EM = 0.61;
/** Letters that are kept in sight behind a place. */
const IN_SIGHT = 24;
/** As `tab-size` in records.css. */
const TAB = 4;
