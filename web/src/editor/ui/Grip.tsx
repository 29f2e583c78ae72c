/** A point of the picture that is pulled, or moved by the arrow keys; what is pulled is one step of undo. */
import { createSignal, type JSX } from "solid-js";
import type { Plan, Point } from "../../lib/plan";

/** The grip. */
export function Grip(props: {
  readonly plan: Plan;
  readonly at: Point;
  readonly label: string;
  readonly testId: string;
  readonly placeOf: (event: MouseEvent) => Point;
  /** It goes there; changes of one kind that follow closely are one. */
  readonly put: (to: Point, kind: string) => void;
  /** While it is pulled. */
  readonly pulled?: (to: Point | null) => void;
  readonly remove?: () => void;
}): JSX.Element {
  const [held, setHeld] = createSignal<Point | null>(null);
  const at = (): Point => held() ?? props.at;
  const pull = (to: Point | null): void => {
    setHeld(to);
    props.pulled?.(to);
  };
  return (
    <circle
      class="plan-handle"
      cx={props.plan.toPx(at())[0]}
      cy={props.plan.toPx(at())[1]}
      r="7"
      tabindex="0"
      role="button"
      aria-label={props.label}
      data-testid={props.testId}
      onPointerDown={(event) => {
        if (event.button !== 0) return;
        event.stopPropagation();
        event.currentTarget.setPointerCapture(event.pointerId);
        pull(props.at);
      }}
      onPointerMove={(event) => {
        if (held() === null) return;
        event.stopPropagation();
        const [x, y] = props.plan.toRoom(props.placeOf(event));
        pull([Math.round(x * 100) / 100, Math.round(y * 100) / 100]);
      }}
      onPointerUp={(event) => {
        const last = held();
        if (last === null) return;
        event.stopPropagation();
        pull(null);
        props.put(last, `${props.testId} ${event.timeStamp}`);
      }}
      onPointerCancel={() => { pull(null); }}
      onKeyDown={(event) => {
        if (event.ctrlKey || event.altKey || event.metaKey) return;
        const way = ARROWS[event.key];
        if (way !== undefined) {
          const by = event.shiftKey ? FINE_M : COARSE_M;
          props.put([props.at[0] + way[0] * by, props.at[1] + way[1] * by], props.testId);
        } else if (event.key === "Delete" && props.remove !== undefined) props.remove();
        else return;
        event.preventDefault();
        event.stopPropagation();
      }}
    />
  );
}

/** One press on an arrow, in the room. */
export const ARROWS: Readonly<Record<string, Point | undefined>> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
/** A press goes so far, m; with Shift the finer. */
export const COARSE_M = 0.05;
export const FINE_M = 0.01;
