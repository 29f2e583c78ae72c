/** A calibration in the making: where to bring the headset next, what was taken, and how well it agrees. */
import { createSignal, For, Show, type JSX } from "solid-js";
import { removeCalibrationPoint, takeCalibrationPoint } from "../../api/http";
import type { CalibrationDraft, CalibrationPoint, PointOn } from "../../api/types";
import { words } from "../../i18n";
import { decimal } from "../../lib/format";
import { said } from "../../lib/reasonWords";
import type { Live } from "../../live/live";
import { Said } from "../Said";
import type { Act } from "./Calibration";
import { numbersOf } from "./numbers";
import { resultWords } from "./resultWords";

/** The steps after the first. */
export function Making(props: {
  readonly live: Live;
  readonly author: string;
  readonly draft: CalibrationDraft;
  readonly busy: boolean;
  /** This role may look on only. */
  readonly locked: boolean;
  readonly act: Act;
  readonly show: (draft: CalibrationDraft) => void;
  readonly accept: () => void;
  readonly discard: () => void;
}): JSX.Element {
  const text = () => words().machine.calibration;
  const kinds = (): readonly PointOn[] => (props.draft.task.kind === "prop" ? ["prop_point", "prop_face"] : ["place", "column"]);
  const [chosen, setChosen] = createSignal<PointOn | null>(null);
  const [place, setPlace] = createSignal<readonly [string, string, string]>(["", "", "0"]);
  const [discarding, setDiscarding] = createSignal(false);
  const on = (): PointOn => kinds().find((entry) => entry === chosen()) ?? kinds()[0] ?? "place";
  const numbers = () => numbersOf(place());
  const isWhere = (): boolean => on() !== "place" || Array.isArray(numbers());
  /** The corners of the arena are marked in every lab, and its middle is easily measured. */
  const known = (): readonly (readonly [number, number])[] => {
    const arena = props.live.scene()?.scene.arena;
    if (arena === undefined) return [];
    const [[x0, y0], [x1, y1]] = [arena.min, arena.max];
    return [[x0, y0], [x1, y0], [x1, y1], [x0, y1], [(x0 + x1) / 2, (y0 + y1) / 2]];
  };
  const take = (): void => {
    const at = numbers();
    if (!isWhere()) return;
    void props.act(async () => {
      const place_m = on() === "place" && Array.isArray(at) ? at : null;
      props.show(await takeCalibrationPoint({ on: on(), place_m }, props.author));
      return () => text().taken;
    });
  };
  const remove = (number: number): void => {
    void props.act(async () => {
      props.show(await removeCalibrationPoint(number, props.author));
      return null;
    });
  };
  return (
    <div data-testid="calibration-making">
      <h3>{text().making(text().kinds[props.draft.task.kind], props.draft.task.prop ?? props.draft.task.client, props.draft.author)}</h3>
      <p>{text().steps[props.draft.task.kind]}</p>
      <Show when={!props.locked}>
        <form
          onSubmit={(event) => {
            event.preventDefault();
            take();
          }}
        >
          <div class="setting">
            <label for="calibration-on">{text().on}</label>
            <div>
              <select id="calibration-on" data-testid="calibration-on" value={on()} onChange={(event) => setChosen(event.currentTarget.value as PointOn)}>
                <For each={kinds()}>{(entry) => <option value={entry}>{text().ons[entry]}</option>}</For>
              </select>
              <small>{text().onMeans[on()]}</small>
            </div>
          </div>
          <Show when={on() === "place"}>
            <fieldset class="setting">
              <legend>{text().place}</legend>
              <div>
                <For each={[0, 1, 2] as const}>
                  {(axis) => (
                    <label class="axis">
                      {AXES[axis]}
                      <input
                        type="text"
                        inputmode="decimal"
                        size="6"
                        autocomplete="off"
                        data-testid={`calibration-${AXES[axis]}`}
                        value={place()[axis]}
                        onInput={(event) => {
                          const next: [string, string, string] = [...place()];
                          next[axis] = event.currentTarget.value;
                          setPlace(next);
                        }}
                      />
                    </label>
                  )}
                </For>
                <For each={known()}>
                  {([x, y]) => (
                    <button type="button" class="quiet" onClick={() => setPlace([String(x), String(y), place()[2]])}>
                      {text().knownPlace(decimal(x, 2), decimal(y, 2))}
                    </button>
                  )}
                </For>
              </div>
            </fieldset>
          </Show>
          <button type="submit" data-testid="calibration-take" aria-describedby="calibration-where" disabled={props.busy || !isWhere()}>
            {text().take}
          </button>{" "}
          <span class="empty" id="calibration-where">
            {isWhere() ? text().takeMeans : text().badNumbers}
          </span>
        </form>
      </Show>
      <Points points={props.draft.points} locked={props.locked || props.busy} remove={remove} />
      <Show
        when={props.draft.result}
        fallback={
          <p class="answer refused" role="status" data-testid="calibration-refused">
            <Show when={props.draft.why}>
              {(why) => <Said of={said({ id: "bad_calibration", refusal: why() }, props.draft.refused_because ?? "")} />}
            </Show>
          </p>
        }
      >
        {(result) => (
          <p role="status" data-testid="calibration-result">
            {resultWords(result())}
          </p>
        )}
      </Show>
      <Show when={!props.locked}>
        <button type="button" data-testid="calibration-accept" disabled={props.busy || props.draft.result === null} onClick={() => { props.accept(); }}>
          {text().accept}
        </button>{" "}
        <Show
          when={discarding()}
          fallback={
            <button type="button" class="quiet" data-testid="calibration-discard" disabled={props.busy} onClick={() => setDiscarding(true)}>
              {text().discard}
            </button>
          }
        >
          <span role="group" aria-label={text().discardSure}>
            {text().discardSure}{" "}
            <button type="button" data-testid="calibration-discard-sure" onClick={() => { props.discard(); }}>
              {text().discard}
            </button>{" "}
            <button type="button" class="quiet" onClick={() => setDiscarding(false)}>
              {text().keep}
            </button>
          </span>
        </Show>
      </Show>
    </div>
  );
}

function Points(props: { readonly points: readonly CalibrationPoint[]; readonly locked: boolean; readonly remove: (number: number) => void }): JSX.Element {
  const text = () => words().machine.calibration;
  const agrees = (point: CalibrationPoint): string => (point.used === null ? "–" : point.used ? text().used : text().leftOut);
  return (
    <Show when={props.points.length > 0} fallback={<p class="empty">{text().noPoints}</p>}>
      <div class="scrolls" role="region" tabindex="0" aria-label={text().points}>
        <table data-testid="calibration-points">
          <caption class="unseen">{text().points}</caption>
          <thead>
            <tr>
              <For each={[text().number, text().pointOn, text().place, text().poses, text().jitter, text().residual, text().agrees]}>
                {(title) => <th scope="col">{title}</th>}
              </For>
              <th scope="col">
                <span class="unseen">{text().remove}</span>
              </th>
            </tr>
          </thead>
          <tbody>
            <For each={props.points}>
              {(point) => (
                <tr classList={{ "left-out": point.used === false }} data-testid="calibration-point">
                  <th scope="row">{point.number}</th>
                  <td>{text().ons[point.on]}</td>
                  <td>{point.room_m.map((value) => decimal(value, 3)).join(" · ")}</td>
                  <td>{point.poses}</td>
                  <td>{decimal(point.jitter_m * 1e3, 1)}</td>
                  <td>{point.residual_m === null ? "–" : decimal(point.residual_m * 1e3, 1)}</td>
                  <td>{agrees(point)}</td>
                  <td>
                    <button type="button" class="quiet" aria-label={text().removePoint(point.number)} disabled={props.locked} onClick={() => { props.remove(point.number); }}>
                      {text().remove}
                    </button>
                  </td>
                </tr>
              )}
            </For>
          </tbody>
        </table>
      </div>
    </Show>
  );
}

const AXES = ["x", "y", "z"] as const;
