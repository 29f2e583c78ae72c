/**
 * The room from above, to be edited: each thing can be chosen, dragged and moved by keys. What is dragged is one step of undo.
 * Escape and Space are the stop's, here too.
 */
import { createMemo, createSignal, For, onCleanup, onMount, Show, type JSX } from "solid-js";
import type { MachineShape, SceneDocument } from "../../api/types";
import { pannedBy, planOf, zoomedAbout, type Camera, type Frame } from "../../lib/camera";
import { decimal } from "../../lib/format";
import type { Point } from "../../lib/plan";
import { boundsOf, nameOf } from "../../ui/drawing/picture";
import type { Editor } from "../editor";
import { moved, thingsOf, without } from "../scene";
import { isSame, pathOf, SCENE, type Selection, type ThingList } from "../selection";
import { say } from "../words";
import { ColumnAt } from "./ColumnAt";
import { ARROWS, COARSE_M, FINE_M } from "./Grip";
import { Handles } from "./Handles";
import { FootprintShape, footprintOfThing } from "./PlanShapes";

/** What is dragged, and how far it is by now. */
interface Drag {
  readonly list: ThingList;
  readonly index: number;
  readonly from: Point;
  readonly by: Point;
}

/** The picture. */
export function PlanEditor(props: { readonly editor: Editor; readonly shape: MachineShape | null; readonly chose: (selection: Selection) => void }): JSX.Element {
  let surface!: HTMLDivElement;
  const [size, setSize] = createSignal({ widthPx: 0, heightPx: 0 });
  const [camera, setCamera] = createSignal<Camera | null>(null);
  const [drag, setDrag] = createSignal<Drag | null>(null);
  let pannedFrom: Point | null = null;
  onMount(() => {
    const observer = new ResizeObserver(() => setSize({ widthPx: surface.clientWidth, heightPx: surface.clientHeight }));
    observer.observe(surface);
    onCleanup(() => { observer.disconnect(); });
  });

  /** The document as it would be if the drag ended here. */
  const scene = createMemo((): SceneDocument => {
    const held = drag();
    return held === null ? props.editor.scene() : moved(props.editor.scene(), held.list, held.index, held.by);
  });
  const frame = createMemo((): Frame | null => {
    const bounds = boundsOf(props.editor.scene(), props.shape);
    const { widthPx, heightPx } = size();
    return bounds === null || widthPx === 0 || heightPx === 0 ? null : { bounds, widthPx, heightPx, marginPx: MARGIN_PX };
  });
  const plan = createMemo(() => {
    const shown = frame();
    return shown === null ? null : planOf(shown, camera());
  });
  const placeOf = (event: MouseEvent): Point => {
    const box = surface.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const zoom = (factor: number, at: Point | null): void => {
    const shown = frame();
    if (shown !== null) setCamera((from) => zoomedAbout(shown, from, factor, at ?? [shown.widthPx / 2, shown.heightPx / 2]));
  };

  const hold = (list: ThingList, index: number, event: PointerEvent): void => {
    const shown = plan();
    if (shown === null || event.button !== 0) return;
    event.stopPropagation();
    surface.setPointerCapture(event.pointerId);
    props.chose({ kind: "thing", list, index });
    setDrag({ list, index, from: shown.toRoom(placeOf(event)), by: [0, 0] });
  };
  const pointed = (event: PointerEvent): void => {
    const [held, shown, room] = [drag(), plan(), frame()];
    if (held !== null && shown !== null) {
      const [x, y] = shown.toRoom(placeOf(event));
      setDrag({ ...held, by: [toCentimetre(x - held.from[0]), toCentimetre(y - held.from[1])] });
    } else if (pannedFrom !== null && room !== null) {
      const at = placeOf(event);
      const from = pannedFrom;
      setCamera((before) => pannedBy(room, before, [at[0] - from[0], at[1] - from[1]]));
      pannedFrom = at;
    }
  };
  const letGo = (): void => {
    const held = drag();
    pannedFrom = null;
    setDrag(null);
    if (held !== null && (held.by[0] !== 0 || held.by[1] !== 0)) props.editor.change((now) => moved(now, held.list, held.index, held.by));
  };
  const key = (list: ThingList, index: number, event: KeyboardEvent): void => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const way = ARROWS[event.key];
    if (way !== undefined) {
      const by = event.shiftKey ? FINE_M : COARSE_M;
      props.chose({ kind: "thing", list, index });
      props.editor.change((now) => moved(now, list, index, [way[0] * by, way[1] * by]), `move ${list} ${index}`);
    } else if (event.key === "Enter") {
      props.chose({ kind: "thing", list, index });
    } else if (event.key === "Delete") {
      props.editor.change((now) => without(now, list, index));
      props.chose(SCENE);
      surface.focus();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  };
  const keyOnGround = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === "+" || event.key === "=") zoom(STEP, null);
    else if (event.key === "-") zoom(1 / STEP, null);
    else if (event.key === "0") setCamera(null);
    else return;
    event.preventDefault();
  };
  const said = (list: ThingList, index: number): string => {
    const thing = thingsOf(scene(), list)[index];
    if (thing === undefined) return "";
    const words = say().plan;
    if ("offset" in thing) return words.propAt(nameOf(thing), decimal(thing.offset[0], 2), decimal(thing.offset[1], 2));
    const at = footprintOfThing(scene(), list, index).middle;
    return words.at(words.thing[list], nameOf(thing), decimal(at[0], 2), decimal(at[1], 2));
  };
  const grade = (list: ThingList, index: number): "error" | "warning" | undefined => {
    const found = props.editor.at(pathOf({ kind: "thing", list, index }));
    return found.some((finding) => finding.grade === "error") ? "error" : found.length > 0 ? "warning" : undefined;
  };

  return (
    <section class="panel edit-plan" aria-labelledby="edit-plan-title">
      <h2 id="edit-plan-title">{say().plan.title}</h2>
      <p class="empty" id="edit-plan-means">{say().plan.means}</p>
      <div
        class="plan-surface"
        ref={surface}
        tabindex="0"
        role="group"
        aria-labelledby="edit-plan-title"
        aria-describedby="edit-plan-means"
        data-testid="plan-editor"
        onKeyDown={keyOnGround}
        onPointerDown={(event) => {
          if (event.button !== 0) return;
          pannedFrom = placeOf(event);
          surface.setPointerCapture(event.pointerId);
        }}
        onPointerMove={pointed}
        onPointerUp={letGo}
        onPointerCancel={() => { pannedFrom = null; setDrag(null); }}
        onWheel={(event) => {
          event.preventDefault();
          zoom(Math.exp(-event.deltaY * WHEEL_PER_PX), placeOf(event));
        }}
      >
        <Show when={plan()}>
          {(shown) => (
            <svg width={size().widthPx} height={size().heightPx} class="plan-svg">
              <Ground plan={shown()} scene={scene()} shape={props.shape} />
              <For each={DRAWN}>
                {(list) => (
                  <For each={thingsOf(scene(), list).map((_, index) => index)}>
                    {(index) => (
                      <g
                        class={`plan-thing plan-${list}`}
                        classList={{ chosen: isSame(props.editor.selection(), { kind: "thing", list, index }) }}
                        data-grade={grade(list, index)}
                        tabindex="0"
                        role="button"
                        aria-pressed={isSame(props.editor.selection(), { kind: "thing", list, index })}
                        aria-label={`${said(list, index)}${grade(list, index) === undefined ? "" : `; ${say().check[grade(list, index) === "error" ? "error" : "warning"]}`}`}
                        data-testid={`plan-${list}-${thingsOf(scene(), list)[index]?.id ?? ""}`}
                        onPointerDown={(event) => { hold(list, index, event); }}
                        onKeyDown={(event) => { key(list, index, event); }}
                      >
                        <FootprintShape plan={shown()} scene={scene()} list={list} index={index} grade={grade(list, index)} />
                      </g>
                    )}
                  </For>
                )}
              </For>
              <ColumnAt plan={shown()} scene={scene()} selection={props.editor.selection()} hold={(index, event) => { hold("props", index, event); }} key={(index, event) => { key("props", index, event); }} said={(index) => said("props", index)} />
              <Handles editor={props.editor} plan={shown()} placeOf={placeOf} />
            </svg>
          )}
        </Show>
        <div class="canvas-tools">
          <button type="button" data-testid="plan-closer" aria-label={say().plan.closer} title={say().plan.closer} onClick={() => { zoom(STEP, null); }}>+</button>
          <button type="button" data-testid="plan-wider" aria-label={say().plan.wider} title={say().plan.wider} onClick={() => { zoom(1 / STEP, null); }}>−</button>
          <button type="button" data-testid="plan-all" aria-label={say().plan.all} title={say().plan.all} disabled={camera() === null} onClick={() => setCamera(null)}>⤢</button>
        </div>
      </div>
    </section>
  );
}

/** Half-metre lines, the arena, and how far the machine reaches. */
function Ground(props: { readonly plan: ReturnType<typeof planOf>; readonly scene: SceneDocument; readonly shape: MachineShape | null }): JSX.Element {
  const lines = (axis: 0 | 1): readonly number[] => {
    const [from, to] = [Math.ceil(props.scene.arena.min[axis] * 2), Math.floor(props.scene.arena.max[axis] * 2)];
    return to - from > MOST_LINES ? [] : Array.from({ length: Math.max(0, to - from + 1) }, (_, index) => (from + index) / 2);
  };
  const box = (min: Point, max: Point) => {
    const [left, bottom] = props.plan.toPx(min);
    const [right, top] = props.plan.toPx(max);
    return { x: left, y: top, width: Math.max(0, right - left), height: Math.max(0, bottom - top) };
  };
  const arena = () => box(props.scene.arena.min, props.scene.arena.max);
  const travel = () => (props.shape === null ? null : box([props.shape.travel_m[0], props.shape.travel_m[1]], [props.shape.travel_m[2], props.shape.travel_m[3]]));
  return (
    <g aria-hidden="true">
      <For each={lines(0)}>
        {(x) => (
          <>
            <line class="plan-grid" classList={{ whole: Number.isInteger(x) }} x1={props.plan.toPx([x, 0])[0]} x2={props.plan.toPx([x, 0])[0]} y1={arena().y} y2={arena().y + arena().height} />
            <Show when={Number.isInteger(x)}><text class="plan-number" x={props.plan.toPx([x, 0])[0]} y={arena().y + arena().height + 14} text-anchor="middle">{x}</text></Show>
          </>
        )}
      </For>
      <For each={lines(1)}>
        {(y) => (
          <>
            <line class="plan-grid" classList={{ whole: Number.isInteger(y) }} y1={props.plan.toPx([0, y])[1]} y2={props.plan.toPx([0, y])[1]} x1={arena().x} x2={arena().x + arena().width} />
            <Show when={Number.isInteger(y)}><text class="plan-number" x={arena().x - 8} y={props.plan.toPx([0, y])[1] + 4} text-anchor="end">{y}</text></Show>
          </>
        )}
      </For>
      <rect class="plan-arena" {...arena()} />
      <Show when={travel()}>{(reach) => <rect class="plan-travel" {...reach()} />}</Show>
    </g>
  );
}

function toCentimetre(metres: number): number {
  return Math.round(metres * 100) / 100;
}

/** From below to above. */
const DRAWN = ["zones", "keep_outs", "objects"] as const;
const MARGIN_PX = 30;
const STEP = 1.25;
const WHEEL_PER_PX = 0.002;
const MOST_LINES = 200;
