/** Where the states of a scenario are drawn, and the arrows between them. Left to right by how many ways it takes to get there. */
import type { ScenarioDocument } from "../api/types";

/** A state's box, px. */
export interface StateBox {
  readonly id: string;
  readonly label: string;
  readonly isFinal: boolean;
  readonly isInitial: boolean;
  readonly x: number;
  readonly y: number;
}

/** An arrow: from a state to another, its own transitions alone. */
export interface StateArrow {
  readonly from: string;
  readonly to: string;
  /** SVG path data. */
  readonly path: string;
}

/** The whole drawing. */
export interface StateGraph {
  readonly width: number;
  readonly height: number;
  readonly boxes: readonly StateBox[];
  readonly arrows: readonly StateArrow[];
}

/** Size of a box, px. */
export const BOX = { width: 172, height: 64 } as const;
const GAP = { x: 64, y: 26 } as const;
/** Arrows back go under the boxes, px. */
const UNDER = 34;
const MARGIN = 12;

/** Lays a scenario out. States that nothing leads to come last, in a column of their own. */
export function stateGraph(scenario: ScenarioDocument): StateGraph {
  const depth = depths(scenario);
  const deepest = Math.max(0, ...[...depth.values()].map((found) => found ?? 0));
  const rows = new Map<number, number>();
  const boxes = scenario.states.map((state): StateBox => {
    const column = depth.get(state.id) ?? deepest + 1;
    const row = rows.get(column) ?? 0;
    rows.set(column, row + 1);
    return {
      id: state.id,
      label: state.label ?? "",
      isFinal: state.final ?? false,
      isInitial: state.id === scenario.initial,
      x: MARGIN + column * (BOX.width + GAP.x),
      y: MARGIN + row * (BOX.height + GAP.y),
    };
  });
  const place = new Map(boxes.map((box) => [box.id, box]));
  const arrows: StateArrow[] = [];
  for (const state of scenario.states) {
    const targets = new Set((state.transitions ?? []).flatMap(({ to }) => (to === null || to === undefined ? [] : [to])));
    for (const to of targets) {
      const [from, target] = [place.get(state.id), place.get(to)];
      if (from !== undefined && target !== undefined) arrows.push({ from: state.id, to, path: arrow(from, target) });
    }
  }
  const hasBack = arrows.some(({ from, to }) => (place.get(to)?.x ?? 0) <= (place.get(from)?.x ?? 0));
  const most = (side: (box: StateBox) => number): number => Math.max(0, ...boxes.map(side));
  return {
    width: most(({ x }) => x) + BOX.width + MARGIN,
    height: most(({ y }) => y) + BOX.height + (hasBack ? UNDER : 0) + MARGIN,
    boxes,
    arrows,
  };
}

/** How many ways it takes to each state from the beginning. */
function depths(scenario: ScenarioDocument): ReadonlyMap<string, number | undefined> {
  const found = new Map<string, number>([[scenario.initial, 0]]);
  const open = [scenario.initial];
  for (let id = open.shift(); id !== undefined; id = open.shift()) {
    const state = scenario.states.find((known) => known.id === id);
    const from = found.get(id) ?? 0;
    for (const { to } of state?.transitions ?? []) {
      if (to !== null && to !== undefined && !found.has(to)) {
        found.set(to, from + 1);
        open.push(to);
      }
    }
  }
  return found;
}

function arrow(from: StateBox, to: StateBox): string {
  const middle = from.y + BOX.height / 2;
  if (to.x > from.x) {
    const [x1, x2, y2] = [from.x + BOX.width, to.x, to.y + BOX.height / 2];
    const bend = Math.max(GAP.x / 2, (x2 - x1) / 2);
    return `M${String(x1)} ${String(middle)} C${String(x1 + bend)} ${String(middle)} ${String(x2 - bend)} ${String(y2)} ${String(x2)} ${String(y2)}`;
  }
  // Back, or to itself: out at the bottom, in at the bottom.
  const [x1, y1] = [from.x + BOX.width * 0.7, from.y + BOX.height];
  const [x2, y2] = [to.x + BOX.width * 0.3, to.y + BOX.height];
  const low = Math.max(y1, y2) + UNDER;
  return `M${String(x1)} ${String(y1)} C${String(x1)} ${String(low)} ${String(x2)} ${String(low)} ${String(x2)} ${String(y2)}`;
}
