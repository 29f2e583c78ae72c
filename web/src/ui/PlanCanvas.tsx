/**
 * A canvas that pans and zooms: by pointer, touch, wheel and keyboard. Sharp at any pixel ratio; repainted when
 * something changed, at the display's pace. It binds neither Escape nor Space: those stop the machine.
 */
import { batch, createEffect, createMemo, createSignal, onCleanup, onMount, untrack, type JSX } from "solid-js";
import { words } from "../i18n";
import { pannedBy, planOf, zoomedAbout, type Camera, type Frame } from "../lib/camera";
import type { Bounds, Point } from "../lib/plan";
import { useShortcuts, type Shortcut } from "../lib/shortcuts";
import { readPalette, type Palette } from "../lib/theme";
import { Stamps, type Brush } from "./drawing/brush";

/** What is shown, and how it is painted. */
export interface PlanCanvasProps {
  /** The part that is shown whole at first, m; null while unknown. Kept while it stays equal. */
  readonly bounds: () => Bounds | null;
  readonly marginPx: number;
  /** Reads all that the picture depends on, and gives what paints it. */
  readonly painting: () => (brush: Brush) => void;
  /** Names the picture for those who do not see it. */
  readonly label: () => string;
  /** The id of a longer text about it. */
  readonly describedBy?: string | undefined;
  readonly testId?: string | undefined;
  /** Its keys stand in the list of shortcuts; one picture of a page is enough. */
  readonly listsKeys?: boolean;
  /** Laid over the picture. */
  readonly children?: JSX.Element;
}

/** Canvas and buttons. */
export function PlanCanvas(props: PlanCanvasProps): JSX.Element {
  let canvas!: HTMLCanvasElement;
  let surface!: HTMLDivElement;
  const [palette, setPalette] = createSignal<Palette | null>(null);
  const [size, setSize] = createSignal({ widthPx: 0, heightPx: 0, ratio: 1 }, { equals: (one, other) => one.widthPx === other.widthPx && one.heightPx === other.heightPx && one.ratio === other.ratio });
  const [camera, setCamera] = createSignal<Camera | null>(null);
  const bounds = createMemo(props.bounds, null, { equals: sameBounds });
  const frame = createMemo((): Frame | null => {
    const [room, { widthPx, heightPx }] = [bounds(), size()];
    return room === null || widthPx === 0 || heightPx === 0 ? null : { bounds: room, widthPx, heightPx, marginPx: props.marginPx };
  });
  const plan = createMemo(() => {
    const shown = frame();
    return shown === null ? null : planOf(shown, camera());
  });
  const stamps = new Stamps();
  let paint: ((brush: Brush) => void) | null = null;
  let requested: number | null = null;

  const repaint = (): void => {
    requested = null;
    const context = canvas.getContext("2d");
    const [shown, colours, { widthPx, heightPx, ratio }] = untrack(() => [plan(), palette(), size()] as const);
    if (context === null || colours === null || widthPx === 0 || heightPx === 0) return;
    const [wide, high] = [Math.round(widthPx * ratio), Math.round(heightPx * ratio)];
    if (canvas.width !== wide || canvas.height !== high) {
      canvas.width = wide;
      canvas.height = high;
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    if (shown === null || paint === null) context.clearRect(0, 0, widthPx, heightPx);
    else paint({ context, palette: colours, plan: shown, widthPx, heightPx, ratio, text: stamps });
  };
  createEffect(() => {
    plan();
    palette();
    size();
    paint = props.painting();
    requested ??= requestAnimationFrame(repaint);
  });

  const moveBy = (by: Point): void => {
    const shown = frame();
    if (shown !== null) setCamera((from) => pannedBy(shown, from, by));
  };
  const zoomBy = (factor: number, at: Point | null): void => {
    const shown = frame();
    if (shown !== null) setCamera((from) => zoomedAbout(shown, from, factor, at ?? [shown.widthPx / 2, shown.heightPx / 2]));
  };
  const fit = (): void => {
    setCamera(null);
  };
  const placeOf = (event: MouseEvent): Point => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };

  const perform = (act: Act): void => {
    if (act === "fit") fit();
    else if (typeof act === "number") zoomBy(act, null);
    else moveBy(act);
  };
  const pressed = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const act = KEYS[event.key];
    if (act === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    perform(act);
  };

  if (props.listsKeys === true) {
    // The picture's own handler comes first, and repeats while a key is held; here they are only listed.
    useShortcuts(
      Object.entries(KEYS).flatMap(([key, act]): Shortcut[] => {
        const does = DOES[key];
        return act === undefined || does === undefined ? [] : [{ key, group: "picture", does: () => words().live[does], run: () => { perform(act); }, within: () => surface }];
      }),
    );
  }

  /** Fingers, or the mouse, that hold the picture. */
  const held = new Map<number, Point>();
  const moved = (event: PointerEvent): void => {
    const before = held.get(event.pointerId);
    if (before === undefined) return;
    const now = placeOf(event);
    const other = [...held].find(([id]) => id !== event.pointerId)?.[1];
    held.set(event.pointerId, now);
    if (other === undefined) {
      moveBy([now[0] - before[0], now[1] - before[1]]);
      return;
    }
    // Two fingers: the picture follows their middle and their spread.
    const spread = (point: Point): number => Math.max(1, Math.hypot(point[0] - other[0], point[1] - other[1]));
    batch(() => {
      moveBy([(now[0] - before[0]) / 2, (now[1] - before[1]) / 2]);
      zoomBy(spread(now) / spread(before), [(now[0] + other[0]) / 2, (now[1] + other[1]) / 2]);
    });
  };

  onMount(() => {
    const recolour = (): void => {
      setPalette(readPalette(surface));
    };
    const resize = (): void => {
      setSize({ widthPx: surface.clientWidth, heightPx: surface.clientHeight, ratio: window.devicePixelRatio });
    };
    recolour();
    const dark = matchMedia("(prefers-color-scheme: dark)");
    dark.addEventListener("change", recolour);
    const themed = new MutationObserver(recolour);
    themed.observe(document.documentElement, { attributes: true, attributeFilter: ["data-theme", "class", "style"] });
    // It tells the first size too, when the page has been laid out: to ask for it now would lay it out for that alone.
    const observer = new ResizeObserver(resize);
    observer.observe(surface);
    // The page zoomed, or moved to another screen.
    window.addEventListener("resize", resize);
    const wheel = (event: WheelEvent): void => {
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? event.deltaY * LINE_PX : event.deltaY;
      zoomBy(Math.exp(-Math.max(-WHEEL_MOST_PX, Math.min(WHEEL_MOST_PX, lines)) * WHEEL_PER_PX), placeOf(event));
    };
    // Not passive: the page must not scroll as well.
    surface.addEventListener("wheel", wheel, { passive: false });
    onCleanup(() => {
      dark.removeEventListener("change", recolour);
      themed.disconnect();
      observer.disconnect();
      window.removeEventListener("resize", resize);
      surface.removeEventListener("wheel", wheel);
      if (requested !== null) cancelAnimationFrame(requested);
    });
  });

  return (
    <div class="plan-canvas">
      <div
        class="plan-surface"
        ref={surface}
        tabindex="0"
        role="application"
        aria-roledescription={words().live.picture}
        aria-label={`${props.label()}. ${words().live.pictureKeys}`}
        aria-describedby={props.describedBy}
        data-testid={props.testId}
        data-zoom={(camera()?.zoom ?? 1).toFixed(3)}
        data-centre={camera() === null ? "" : camera()?.centre.map((value) => value.toFixed(3)).join(" ")}
        onKeyDown={pressed}
        onPointerDown={(event) => {
          if (event.button !== 0) return;
          surface.setPointerCapture(event.pointerId);
          held.set(event.pointerId, placeOf(event));
        }}
        onPointerMove={moved}
        onPointerUp={(event) => held.delete(event.pointerId)}
        onPointerCancel={(event) => held.delete(event.pointerId)}
        onDblClick={fit}
      >
        <canvas ref={canvas} class="fades" aria-hidden="true" />
      </div>
      {props.children}
      <div class="plan-buttons" role="group" aria-label={words().live.zoomGroup}>
        <button type="button" data-testid={named(props.testId, "zoom-in")} aria-label={words().live.zoomIn} title={words().live.zoomIn} onClick={() => { zoomBy(STEP, null); }}>
          +
        </button>
        <button type="button" data-testid={named(props.testId, "zoom-out")} aria-label={words().live.zoomOut} title={words().live.zoomOut} onClick={() => { zoomBy(1 / STEP, null); }}>
          −
        </button>
        <button type="button" data-testid={named(props.testId, "fit")} aria-label={words().live.fit} title={words().live.fit} disabled={camera() === null} onClick={fit}>
          <svg viewBox="0 0 16 16" aria-hidden="true">
            <path d="M2 6V2h4M10 2h4v4M14 10v4h-4M6 14H2v-4" />
          </svg>
        </button>
      </div>
    </div>
  );
}

function named(testId: string | undefined, part: string): string | undefined {
  return testId === undefined ? undefined : `${testId}-${part}`;
}

function sameBounds(one: Bounds | null, other: Bounds | null): boolean {
  if (one === null || other === null) return one === other;
  return [0, 1].every((axis) => one.min[axis] === other.min[axis] && one.max[axis] === other.max[axis]);
}

/** Panned by some px, zoomed by a factor, or all of it shown. */
type Act = Point | number | "fit";

/** One press on a button or key. */
const STEP = 1.25;
/** One press on an arrow, px. */
const ARROW_PX = 48;
/** As an arrow moves the view, the picture moves the other way. */
const KEYS: Readonly<Record<string, Act | undefined>> = {
  ArrowLeft: [ARROW_PX, 0],
  ArrowRight: [-ARROW_PX, 0],
  ArrowUp: [0, ARROW_PX],
  ArrowDown: [0, -ARROW_PX],
  "+": STEP,
  "=": STEP,
  "-": 1 / STEP,
  "0": "fit",
};
/** What is listed of them; `=` is the unshifted plus. */
const DOES: Readonly<Record<string, "panLeft" | "panRight" | "panUp" | "panDown" | "closer" | "wider" | "all" | undefined>> = {
  ArrowLeft: "panLeft",
  ArrowRight: "panRight",
  ArrowUp: "panUp",
  ArrowDown: "panDown",
  "+": "closer",
  "-": "wider",
  "0": "all",
};
const LINE_PX = 16;
/** A wheel's click is about 100 px. */
const WHEEL_PER_PX = 0.002;
const WHEEL_MOST_PX = 200;
