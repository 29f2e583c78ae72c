/** The last minutes as a bar with a mark for each event, a line for each group. Arrow keys go from mark to mark. */
import { createMemo, createSignal, For, type JSX } from "solid-js";
import type { WireEvent } from "../api/types";
import { words } from "../i18n";
import { timeOfDay } from "../lib/format";
import { GROUP_NAMES, keyOf, marksOf, type Mark } from "../lib/timeline";

/** One bar. */
export function TimeBar(props: {
  readonly events: readonly WireEvent[];
  /** The wall clock, ms. */
  readonly nowMillis: number;
  readonly selected: string | null;
  readonly wordsOf: (event: WireEvent) => string;
  readonly select: (event: WireEvent) => void;
}): JSX.Element {
  let bar!: HTMLDivElement;
  const [focused, setFocused] = createSignal<string | null>(null);
  const text = (): ReturnType<typeof words>["desk"]["timeline"] => words().desk.timeline;
  const marks = createMemo((): readonly Mark[] => marksOf(props.events, props.nowMillis, MINUTES * 60_000));
  const byKey = createMemo(() => new Map(marks().map((mark) => [keyOf(mark.event), mark])));
  /** The one mark that the Tab key reaches: where one was last, else the newest. */
  const reached = (): string | null => {
    const key = focused();
    const newest = marks().at(-1);
    return key !== null && byKey().has(key) ? key : newest === undefined ? null : keyOf(newest.event);
  };
  const go = (event: KeyboardEvent): void => {
    const step = { ArrowLeft: -1, ArrowUp: -1, ArrowRight: 1, ArrowDown: 1, Home: -Infinity, End: Infinity }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const all = marks();
    const at = all.findIndex((mark) => keyOf(mark.event) === reached());
    const next = all[Math.max(0, Math.min(all.length - 1, at + step))];
    if (next === undefined) return;
    const key = keyOf(next.event);
    setFocused(key);
    [...bar.querySelectorAll<HTMLButtonElement>("button")].find((button) => button.dataset["key"] === key)?.focus();
  };
  return (
    <div class="time-bar" ref={bar} role="toolbar" aria-label={text().bar(MINUTES)} data-testid="time-bar" onKeyDown={go}>
      <For each={GROUP_NAMES}>
        {(group, line) => (
          <span class="time-line" style={{ "--line": String(line()) }} data-group={group} aria-hidden="true">
            {text().groups[group]}
          </span>
        )}
      </For>
      <div class="time-marks">
        <For each={[...byKey().keys()]}>
          {(key) => {
            const mark = (): Mark | undefined => byKey().get(key);
            return (
              <button
                type="button"
                class="time-mark"
                data-key={key}
                data-group={mark()?.group}
                data-kind={mark()?.event.kind}
                tabindex={reached() === key ? 0 : -1}
                aria-pressed={props.selected === key}
                aria-label={describe(mark(), props.wordsOf)}
                title={describe(mark(), props.wordsOf)}
                style={{ "--place": String(mark()?.place ?? 0), "--line": String(GROUP_NAMES.indexOf(mark()?.group ?? "mode")) }}
                onFocus={() => setFocused(key)}
                onClick={() => {
                  const event = mark()?.event;
                  if (event !== undefined) props.select(event);
                }}
              />
            );
          }}
        </For>
      </div>
      <div class="time-scale" aria-hidden="true">
        <span>{text().minutesAgo(MINUTES)}</span>
        <span>{text().minutesAgo(MINUTES / 2)}</span>
        <span>{text().now}</span>
      </div>
    </div>
  );
}

function describe(mark: Mark | undefined, wordsOf: (event: WireEvent) => string): string {
  return mark === undefined ? "" : `${timeOfDay(mark.event.at)} ${wordsOf(mark.event)}`;
}

const MINUTES = 10;
