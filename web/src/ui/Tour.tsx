/**
 * The first-run tour: one card after the other beside what it speaks of. It is no dialog that holds anybody: the page
 * works on behind it, and the card never lies on the stop.
 */
import { createEffect, createMemo, createSignal, on, onCleanup, onMount, Show, type JSX } from "solid-js";
import { words } from "../i18n";

/** The tour over the live view, from the first thing that stands there to the last. */
export function Tour(props: { readonly close: () => void }): JSX.Element {
  let card!: HTMLDivElement;
  let heading: HTMLHeadingElement | undefined;
  const before = document.activeElement;
  const [at, setAt] = createSignal(0);
  const [box, setBox] = createSignal<DOMRect | null>(null);
  const [place, setPlace] = createSignal({ left: 0, top: 0 });
  const [steps, setSteps] = createSignal<readonly (typeof STEPS)[number][]>([]);
  const step = createMemo(() => steps()[at()]);
  const text = () => {
    const name = step()?.name;
    return name === undefined ? null : words().settings.tour.steps[name];
  };

  const settle = (): void => {
    const target = find(step()?.selector ?? "");
    const rect = target?.getBoundingClientRect() ?? null;
    setBox(rect);
    if (rect !== null) setPlace(placeBeside(rect, card.offsetWidth, card.offsetHeight));
  };
  onMount(() => {
    // What a layout has put away is passed over.
    setSteps(STEPS.filter((each) => find(each.selector) !== null));
    createEffect(
      on([step, words], () => {
        find(step()?.selector ?? "")?.scrollIntoView({ block: "nearest" });
        settle();
      }),
    );
    createEffect(
      on(step, () => {
        heading?.focus({ preventScroll: true });
      }),
    );
    // The page moves under the card: banners come, lists grow, windows change.
    const timer = setInterval(settle, SETTLE_EVERY_MILLIS);
    window.addEventListener("resize", settle);
    onCleanup(() => {
      clearInterval(timer);
      window.removeEventListener("resize", settle);
      queueMicrotask(() => {
        if (before instanceof HTMLElement && before.isConnected) before.focus();
      });
    });
  });
  const isLast = (): boolean => at() >= steps().length - 1;

  return (
    <>
      <Show when={box()}>
        {(rect) => (
          <div
            class="tour-ring"
            aria-hidden="true"
            style={{
              left: `${rect().left - RING_PX}px`,
              top: `${rect().top - RING_PX}px`,
              width: `${rect().width + 2 * RING_PX}px`,
              height: `${rect().height + 2 * RING_PX}px`,
            }}
          />
        )}
      </Show>
      <div
        class="tour"
        ref={card}
        role="dialog"
        aria-labelledby="tour-title"
        aria-describedby="tour-text"
        data-testid="tour"
        data-step={step()?.name}
        style={{ left: `${place().left}px`, top: `${place().top}px` }}
      >
        <p class="empty">
          {words().settings.tour.title}, {words().settings.tour.step(at() + 1, steps().length)}
        </p>
        <h2 id="tour-title" tabindex="-1" ref={heading}>
          {text()?.[0]}
        </h2>
        <p id="tour-text">{text()?.[1]}</p>
        <Show when={isLast()}>
          <p class="empty">{words().settings.tour.again}</p>
        </Show>
        <div class="tour-buttons">
          <Show when={!isLast()}>
            <button type="button" class="quiet" data-testid="tour-skip" onClick={() => { props.close(); }}>
              {words().settings.tour.skip}
            </button>
          </Show>
          <button type="button" data-testid="tour-back" disabled={at() === 0} onClick={() => setAt(at() - 1)}>
            {words().settings.tour.back}
          </button>
          <button
            type="button"
            data-testid="tour-next"
            onClick={() => {
              if (isLast()) props.close();
              else setAt(at() + 1);
            }}
          >
            {isLast() ? words().settings.tour.done : words().settings.tour.next}
          </button>
        </div>
      </div>
    </>
  );
}

/** Where the card fits beside its target: below, above, right, left, else inside; never on the stop. */
function placeBeside(target: DOMRect, width: number, height: number): { left: number; top: number } {
  const stop = document.querySelector('[data-testid="stop"]')?.getBoundingClientRect();
  const [right, bottom] = [window.innerWidth - GAP_PX, window.innerHeight - GAP_PX];
  const clamp = (value: number, most: number): number => Math.max(GAP_PX, Math.min(value, most));
  const candidates = [
    { left: target.left, top: target.bottom + GAP_PX },
    { left: target.left, top: target.top - height - GAP_PX },
    { left: target.right + GAP_PX, top: target.top },
    { left: target.left - width - GAP_PX, top: target.top },
    { left: target.left + GAP_PX, top: target.bottom - height - GAP_PX },
    { left: GAP_PX, top: bottom - height },
  ].map(({ left, top }) => ({ left: clamp(left, right - width), top: clamp(top, bottom - height) }));
  const clear = (at: { left: number; top: number }, rect: DOMRect | undefined): boolean =>
    rect === undefined || at.left >= rect.right || rect.left >= at.left + width || at.top >= rect.bottom || rect.top >= at.top + height;
  const offTheStop = candidates.filter((at) => clear(at, stop));
  return offTheStop.find((at) => clear(at, target)) ?? offTheStop[0] ?? { left: GAP_PX, top: bottom - height };
}

function find(selector: string): HTMLElement | null {
  const found = selector === "" ? null : document.querySelector<HTMLElement>(selector);
  return found !== null && found.getClientRects().length > 0 ? found : null;
}

const STEPS = [
  { name: "mode", selector: ".mode" },
  { name: "stop", selector: '[data-testid="stop"]' },
  { name: "picture", selector: '[data-testid="top-view"]' },
  { name: "rules", selector: 'section[aria-labelledby="rules-title"]' },
  { name: "priors", selector: '[data-testid="panel-priors"]' },
  { name: "timeline", selector: 'section[aria-labelledby="timeline-title"], section[aria-labelledby="events-title"]' },
  { name: "pages", selector: ".ways" },
] as const;
const GAP_PX = 12;
const RING_PX = 4;
const SETTLE_EVERY_MILLIS = 250;
