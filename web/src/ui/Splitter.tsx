/** A bar between two panels that changes the size of one of them: by pointer, touch or keyboard. */
import type { JSX } from "solid-js";
import type { Limits } from "../lib/layout";

/** The bar; the panel that it sizes lies to the given side of it. */
export function Splitter(props: {
  readonly sizes: "left" | "right" | "below";
  readonly label: string;
  readonly value: number;
  readonly limits: Limits;
  readonly change: (px: number) => void;
  readonly testId: string;
}): JSX.Element {
  let from: { readonly at: number; readonly value: number } | null = null;
  const upright = (): boolean => props.sizes !== "below";
  const placeOf = (event: PointerEvent): number => (upright() ? event.clientX : event.clientY);
  const grow = (by: number): void => {
    resize(props.value + by);
  };
  const resize = (px: number): void => {
    props.change(Math.round(Math.min(props.limits.greatest, Math.max(props.limits.least, px))));
  };
  /** Towards the panel makes it smaller. */
  const sign = (): number => (props.sizes === "left" ? 1 : -1);
  const pressed = (event: KeyboardEvent): void => {
    const [less, more] = upright() ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
    if (event.key === more) grow(sign() * STEP_PX);
    else if (event.key === less) grow(-sign() * STEP_PX);
    else if (event.key === "Home") resize(props.limits.least);
    else if (event.key === "End") resize(props.limits.greatest);
    else if (event.key === "Enter") resize(props.limits.standard);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return (
    <div
      class={`splitter splits-${props.sizes}`}
      role="separator"
      tabindex="0"
      aria-orientation={upright() ? "vertical" : "horizontal"}
      aria-label={props.label}
      aria-valuenow={props.value}
      aria-valuemin={props.limits.least}
      aria-valuemax={props.limits.greatest}
      aria-valuetext={`${props.value} px`}
      data-testid={props.testId}
      onKeyDown={pressed}
      onPointerDown={(event) => {
        if (event.button !== 0) return;
        event.currentTarget.setPointerCapture(event.pointerId);
        from = { at: placeOf(event), value: props.value };
      }}
      onPointerMove={(event) => {
        if (from !== null) resize(from.value + sign() * (placeOf(event) - from.at));
      }}
      onPointerUp={() => (from = null)}
      onPointerCancel={() => (from = null)}
      onDblClick={() => { resize(props.limits.standard); }}
    />
  );
}

const STEP_PX = 16;
