/** The live top view. Sharp at any pixel ratio; repainted when something changed, at the display's pace. */
import { createEffect, createMemo, createSignal, onCleanup, onMount, Show, type JSX } from "solid-js";
import type { Live } from "../live/live";
import { metres, span } from "../lib/format";
import { readPalette, type Palette } from "../lib/theme";
import { drawTopView } from "./drawing";

/** Canvas, legend and the column's numbers. */
export function TopView(props: { readonly live: Live }): JSX.Element {
  let canvas!: HTMLCanvasElement;
  let frame!: HTMLDivElement;
  const [palette, setPalette] = createSignal<Palette | null>(null);
  const [size, setSize] = createSignal({ widthPx: 0, heightPx: 0 });
  let requested: number | null = null;

  const paint = (): void => {
    requested = null;
    const colours = palette();
    const context = canvas.getContext("2d");
    const { widthPx, heightPx } = size();
    if (colours === null || context === null || widthPx === 0 || heightPx === 0) return;
    const ratio = window.devicePixelRatio;
    const [wide, high] = [Math.round(widthPx * ratio), Math.round(heightPx * ratio)];
    if (canvas.width !== wide || canvas.height !== high) {
      canvas.width = wide;
      canvas.height = high;
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    drawTopView(
      context,
      widthPx,
      heightPx,
      {
        snapshot: props.live.newest(),
        scene: props.live.scene()?.scene ?? null,
        shape: props.live.server()?.shape ?? null,
      },
      colours,
    );
  };
  createEffect(() => {
    props.live.newest();
    props.live.scene();
    props.live.server();
    palette();
    size();
    requested ??= requestAnimationFrame(paint);
  });

  onMount(() => {
    const recolour = (): void => {
      setPalette(readPalette(canvas));
    };
    recolour();
    const dark = matchMedia("(prefers-color-scheme: dark)");
    dark.addEventListener("change", recolour);
    const observer = new ResizeObserver(() => {
      setSize({ widthPx: frame.clientWidth, heightPx: frame.clientHeight });
    });
    observer.observe(frame);
    onCleanup(() => {
      dark.removeEventListener("change", recolour);
      observer.disconnect();
      if (requested !== null) cancelAnimationFrame(requested);
    });
  });

  const column = (): ReturnType<typeof columnNumbers> => columnNumbers(props.live);
  const stale = createMemo(() => {
    const freshness = props.live.freshness();
    return freshness.kind === "stale" ? freshness : null;
  });

  return (
    <section class="panel top-view" aria-label="Top view">
      <div class="canvas-frame" ref={frame}>
        <canvas ref={canvas} class="fades" role="img" aria-label={describe(props.live)} data-testid="top-view" />
        <Show when={stale()}>
          {(freshness) => (
            <div class="stale-stamp" aria-hidden="true">
              <b>STALE</b>
              <span>{span(freshness().ageMillis / 1000)} old</span>
            </div>
          )}
        </Show>
      </div>
      <dl class="column-numbers fades">
        <div>
          <dt>Column</dt>
          <dd data-testid="column-position">{column().position}</dd>
        </div>
        <div>
          <dt>Speed</dt>
          <dd data-testid="column-speed">{column().speed}</dd>
        </div>
        <div>
          <dt>Target</dt>
          <dd data-testid="column-target">{column().target}</dd>
        </div>
        <div>
          <dt>Current</dt>
          <dd>{column().current}</dd>
        </div>
      </dl>
      <ul class="legend" aria-label="Legend">
        <li class="key-column">column</li>
        <li class="key-commanded">commanded</li>
        <li class="key-proxy">proxy</li>
        <li class="key-target">target</li>
        <li class="key-predicted">predicted</li>
        <li class="key-object">object</li>
        <li class="key-person">person</li>
        <li class="key-zone">zone r</li>
        <li class="key-required">required</li>
        <li class="key-travel">travel</li>
        <li class="key-keep-out">keep out</li>
      </ul>
    </section>
  );
}

function columnNumbers(live: Live): { position: string; speed: string; target: string; current: string } {
  const column = live.snapshot()?.column;
  if (column === undefined) return { position: "–", speed: "–", target: "–", current: "–" };
  const [x, y] = column.position_m;
  const [vx, vy] = column.velocity_mps;
  return {
    position: column.homed ? `${metres(x)}, ${metres(y)} m` : "not homed",
    speed: `${metres(Math.hypot(vx, vy))} m/s`,
    target: column.target_m === null ? "none" : `${metres(column.target_m[0])}, ${metres(column.target_m[1])} m`,
    current: `${column.current_amps[0].toFixed(1)}, ${column.current_amps[1].toFixed(1)} A`,
  };
}

function describe(live: Live): string {
  const snapshot = live.snapshot();
  if (snapshot === null) return "Top view of the arena, nothing known yet";
  const persons = snapshot.persons.length === 1 ? "1 person" : `${snapshot.persons.length} persons`;
  return `Top view of the arena: column, ${persons}, ${snapshot.objects.length} objects`;
}
