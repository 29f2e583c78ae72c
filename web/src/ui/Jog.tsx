/** Move the column by hand: buttons that work while they are held, by pointer and by keyboard. */
import { createEffect, createSignal, For, onCleanup, Show, type JSX } from "solid-js";
import type { JogAim } from "../api/types";
import { words } from "../i18n";
import { decimal } from "../lib/format";
import { JogHand, type HandState } from "../live/jog";
import type { Live } from "../live/live";
import { whyNot, wordsOf } from "./Controls";

/** The panel. */
export function Jog(props: { readonly live: Live }): JSX.Element {
  const say = () => words().machine.jog;
  const [state, setState] = createSignal<HandState>({ held: false, answer: null });
  const [speed, setSpeed] = createSignal<Speed>("creep");
  const [place, setPlace] = createSignal<readonly [string, string]>(["", ""]);
  const hand = new JogHand({ order: (to, speedMps) => props.live.jog(to, speedMps), changed: setState });
  const letGo = (): void => {
    hand.letGo();
  };
  // A page that is hidden, or a window that is left, holds nothing.
  document.addEventListener("visibilitychange", letGo);
  window.addEventListener("blur", letGo);
  onCleanup(() => {
    letGo();
    document.removeEventListener("visibilitychange", letGo);
    window.removeEventListener("blur", letGo);
  });

  const refusal = () => whyNot(props.live, "jog");
  // A button that is disabled while it is held hears nothing of its release.
  createEffect(() => {
    if (refusal() !== null) letGo();
  });
  const isUnconfirmed = () => refusal() === null && props.live.snapshot()?.rules.some(({ rule, status }) => rule === "R16" && status === "limiting") === true;
  const fastest = () => props.live.snapshot()?.column.jog_speed_mps ?? null;
  const aimOfPlace = (): JogAim | null => {
    const [x, y] = place().map((text) => (text.trim() === "" ? NaN : Number(text.replace(",", "."))));
    return x !== undefined && y !== undefined && Number.isFinite(x) && Number.isFinite(y) ? { place: [x, y] } : null;
  };
  const shown = (): string => {
    const { held, answer } = state();
    if (answer !== null && (answer.kind === "unanswered" || answer.outcome === "refused")) return wordsOf(answer);
    return held ? say().moves : say().idle;
  };
  /** What a button that is held does: down holds, everything else lets go. */
  const held = (aim: () => JogAim | null) => ({
    onPointerDown: (event: PointerEvent & { currentTarget: HTMLButtonElement }) => {
      if (event.button !== 0) return;
      event.currentTarget.setPointerCapture(event.pointerId);
      take(aim());
    },
    onPointerUp: letGo,
    onPointerCancel: letGo,
    onLostPointerCapture: letGo,
    onBlur: letGo,
    onKeyDown: (event: KeyboardEvent) => {
      // Space is the stop's, here too.
      if (event.key !== "Enter") return;
      event.preventDefault();
      if (!event.repeat) take(aim());
    },
    onKeyUp: letGo,
    onContextMenu: (event: Event) => {
      event.preventDefault();
    },
  });
  const take = (aim: JogAim | null): void => {
    if (aim !== null && refusal() === null) hand.hold(aim, SPEEDS[speed()]);
  };

  return (
    <section class="panel" aria-labelledby="jog-title">
      <h2 id="jog-title">{say().title}</h2>
      <p class="empty">{say().means}</p>
      <fieldset class="jog-speed">
        <legend>{say().speed}</legend>
        <For each={SPEED_NAMES}>
          {(name) => (
            <label>
              <input type="radio" name="jog-speed" data-testid={`jog-speed-${name}`} checked={speed() === name} onChange={() => setSpeed(name)} />
              {say().speeds[name]}
            </label>
          )}
        </For>
        <Show when={isUnconfirmed()}>
          <button type="button" data-testid="jog-clear" onClick={() => void props.live.ask("confirm_clear")}>
            {say().clear}
          </button>
          <span class="empty">{say().clearMeans}</span>
        </Show>
        <Show when={fastest()}>{(most) => <span class="empty">{say().fastest(decimal(most(), 2))}</span>}</Show>
      </fieldset>
      <div class="jog">
        <div class="jog-pad" role="group" aria-label={say().title}>
          <For each={WAYS}>
            {(way) => (
              <Show when={way} fallback={<span />}>
                {(known) => (
                  <button
                    type="button"
                    class="jog-button"
                    data-testid={`jog-${known().name}`}
                    aria-label={say().hold(say().ways[known().name])}
                    aria-describedby="jog-state"
                    disabled={refusal() !== null}
                    {...held(() => ({ along: [...known().along] }))}
                  >
                    {known().sign}
                  </button>
                )}
              </Show>
            )}
          </For>
        </div>
        <fieldset class="jog-place">
          <legend>{say().place}</legend>
          <For each={[0, 1] as const}>
            {(axis) => (
              <label>
                {axis === 0 ? say().placeX : say().placeY}
                <input
                  type="text"
                  inputmode="decimal"
                  autocomplete="off"
                  size="6"
                  data-testid={axis === 0 ? "jog-x" : "jog-y"}
                  value={place()[axis]}
                  onInput={(event) => {
                    const typed = event.currentTarget.value;
                    setPlace(([x, y]) => (axis === 0 ? [typed, y] : [x, typed]));
                  }}
                />
              </label>
            )}
          </For>
          <button
            type="button"
            class="jog-button"
            data-testid="jog-go"
            aria-describedby="jog-state"
            disabled={refusal() !== null || aimOfPlace() === null}
            {...held(aimOfPlace)}
          >
            {say().go}
          </button>
          <Show when={aimOfPlace() === null && place().some((text) => text.trim() !== "")}>
            <span class="empty" role="status">
              {say().badPlace}
            </span>
          </Show>
        </fieldset>
      </div>
      <p id="jog-state" data-testid="jog-state" aria-live="polite">
        {refusal() ?? shown()}
      </p>
    </section>
  );
}

type Speed = keyof typeof SPEEDS;
/** What can be asked for, m/s; the server may allow less. */
const SPEEDS = { creep: 0.1, reduced: 0.24 } as const;
const SPEED_NAMES = Object.keys(SPEEDS) as readonly Speed[];

type Way = { readonly name: "up_left" | "up" | "up_right" | "left" | "right" | "down_left" | "down" | "down_right"; readonly sign: string; readonly along: readonly [number, number] };
/** As the top view lies: +x to the right, +y up. Row by row, the middle empty. */
const WAYS: readonly (Way | null)[] = [
  { name: "up_left", sign: "↖", along: [-1, 1] },
  { name: "up", sign: "↑", along: [0, 1] },
  { name: "up_right", sign: "↗", along: [1, 1] },
  { name: "left", sign: "←", along: [-1, 0] },
  null,
  { name: "right", sign: "→", along: [1, 0] },
  { name: "down_left", sign: "↙", along: [-1, -1] },
  { name: "down", sign: "↓", along: [0, -1] },
  { name: "down_right", sign: "↘", along: [1, -1] },
];
