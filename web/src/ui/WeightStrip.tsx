/** The bars of one object's weight over the last minute. Drawn only while it is in sight. */
import { createEffect, createMemo, createSignal, onCleanup, onMount, type JSX } from "solid-js";
import { words } from "../i18n";
import type { Bar } from "../live/weights";
import { decimal } from "../lib/format";

/** One strip. Colours come from the page's own. */
export function WeightStrip(props: {
  readonly bars: () => readonly (Bar | null)[];
  readonly served: () => readonly number[];
}): JSX.Element {
  let canvas!: HTMLCanvasElement;
  const [inSight, setInSight] = createSignal(typeof IntersectionObserver === "undefined");
  const [size, setSize] = createSignal<readonly [number, number]>([0, 0]);
  onMount(() => {
    const resized = new ResizeObserver(() => setSize([canvas.clientWidth, canvas.clientHeight]));
    resized.observe(canvas);
    onCleanup(() => {
      resized.disconnect();
    });
    if (typeof IntersectionObserver === "undefined") return;
    const seen = new IntersectionObserver((entries) => setInSight(entries.at(-1)?.isIntersecting === true));
    seen.observe(canvas);
    onCleanup(() => {
      seen.disconnect();
    });
  });
  const bars = createMemo(() => (inSight() ? props.bars() : []));
  createEffect(() => {
    if (inSight()) paint(canvas, size(), bars(), props.served());
  });
  return (
    <canvas
      ref={canvas}
      class="weight-strip"
      role="img"
      aria-label={inSight() ? stripWords(bars(), props.served()) : words().desk.weights.lastMinute}
    />
  );
}

/** What a strip shows, in words. */
export function stripWords(bars: readonly (Bar | null)[], served: readonly number[]): string {
  const text = words().desk.weights;
  const known = bars.filter((bar) => bar !== null);
  if (known.length === 0) return text.stripUnknown;
  const weights = known.map(({ weight }) => weight);
  const secs = (count: number): number => Math.round((count * 60) / bars.length);
  const said = text.strip(
    decimal(Math.min(...weights), 2),
    decimal(Math.max(...weights), 2),
    secs(known.filter(({ committed }) => committed).length),
    secs(bars.length - known.length),
  );
  return served.length === 0 ? said : `${said}; ${text.servedTimes(served.length)}`;
}

function paint(canvas: HTMLCanvasElement, [width, height]: readonly [number, number], bars: readonly (Bar | null)[], served: readonly number[]): void {
  const brush = canvas.getContext("2d");
  if (brush === null || width === 0) return;
  const density = window.devicePixelRatio;
  canvas.width = Math.round(width * density);
  canvas.height = Math.round(height * density);
  brush.scale(density, density);
  const style = getComputedStyle(canvas);
  const colour = (name: string): string => style.getPropertyValue(`--${name}`).trim();
  const [plain, committed, gap, mark] = [colour("column"), colour("predicted"), colour("line"), colour("good")];
  const step = width / bars.length;
  // Marks of service and of commitment have a line of their own, so that colour alone says nothing.
  const [top, floor] = [6, height - 3];
  for (const [index, bar] of bars.entries()) {
    const x = index * step;
    if (bar === null) {
      brush.fillStyle = gap;
      brush.fillRect(x, floor - 1, step, 1);
      continue;
    }
    const tall = Math.max(1, Math.min(1, bar.weight) * (floor - top));
    brush.fillStyle = bar.committed ? committed : plain;
    brush.fillRect(x, floor - tall, Math.max(1, step - 0.5), tall);
    if (bar.committed) brush.fillRect(x, floor + 1, step, 2);
  }
  brush.fillStyle = mark;
  for (const place of served) {
    const x = (place + 0.5) * step;
    brush.beginPath();
    brush.moveTo(x - 4, 0);
    brush.lineTo(x + 4, 0);
    brush.lineTo(x, 6);
    brush.fill();
  }
}
