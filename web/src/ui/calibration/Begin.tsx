/** What is to be calibrated, with which headset. */
import { createSignal, For, Show, type JSX } from "solid-js";
import { beginCalibration } from "../../api/http";
import type { CalibrationDraft, CalibrationKind, Pointer } from "../../api/types";
import { words } from "../../i18n";
import type { Live } from "../../live/live";
import type { Act } from "./Calibration";
import { numbersOf } from "./numbers";

/** The first step. */
export function Begin(props: {
  readonly live: Live;
  readonly author: string;
  readonly busy: boolean;
  readonly act: Act;
  readonly show: (draft: CalibrationDraft) => void;
}): JSX.Element {
  const text = () => words().machine.calibration;
  const [kind, setKind] = createSignal<CalibrationKind>("room_from_tracking");
  const [client, setClient] = createSignal<string | null>(null);
  const [pointer, setPointer] = createSignal<Pointer>("head");
  const [offset, setOffset] = createSignal<readonly [string, string, string]>(["", "", ""]);
  const [prop, setProp] = createSignal<string | null>(null);
  // By name: the newest snapshot is another list of the same clients, and a choice must not be lost by it.
  const clients = (): readonly string[] =>
    (props.live.snapshot()?.clients ?? []).filter((entry) => entry.persons.length <= 1).map((entry) => entry.name);
  const propsOfScene = () => props.live.scene()?.scene.props ?? [];
  const chosenClient = (): string | undefined => clients().find((name) => name === client()) ?? clients()[0];
  const chosenProp = (): string | undefined => propsOfScene().find((entry) => entry.id === prop())?.id ?? propsOfScene()[0]?.id;
  const given = () => numbersOf(offset());
  const missing = (): string | null => {
    if (chosenClient() === undefined) return text().noClient;
    if (kind() === "prop" && chosenProp() === undefined) return text().noProp;
    return kind() === "room_from_tracking" && given() === "bad" ? text().badNumbers : null;
  };
  const begin = (): void => {
    const name = chosenClient();
    const offsets = given();
    if (name === undefined || missing() !== null) return;
    void props.act(async () => {
      const isProp = kind() === "prop";
      const begun = await beginCalibration(
        {
          kind: kind(),
          client: name,
          pointer: pointer(),
          offset_m: isProp || offsets === "bad" ? null : offsets,
          prop: isProp ? (chosenProp() ?? null) : null,
        },
        props.author,
      );
      props.show(begun);
      return null;
    });
  };
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        begin();
      }}
    >
      <h3>{text().begin}</h3>
      <div class="setting">
        <label for="calibration-kind">{text().what}</label>
        <div>
          <select id="calibration-kind" data-testid="calibration-kind" value={kind()} onChange={(event) => setKind(event.currentTarget.value === "prop" ? "prop" : "room_from_tracking")}>
            <For each={["room_from_tracking", "prop"] as const}>{(entry) => <option value={entry}>{text().kinds[entry]}</option>}</For>
          </select>
          <small>{text().kindMeans[kind()]}</small>
        </div>
      </div>
      <div class="setting">
        <label for="calibration-client">{text().client}</label>
        <div>
          <select id="calibration-client" data-testid="calibration-client" value={chosenClient() ?? ""} onChange={(event) => setClient(event.currentTarget.value)}>
            <For each={clients()}>{(name) => <option value={name}>{name}</option>}</For>
          </select>
          <select aria-label={text().pointer} data-testid="calibration-pointer" value={pointer()} onChange={(event) => setPointer(event.currentTarget.value as Pointer)}>
            <For each={["head", "left_hand", "right_hand"] as const}>{(entry) => <option value={entry}>{text().pointers[entry]}</option>}</For>
          </select>
        </div>
      </div>
      <Show when={kind() === "prop"}>
        <div class="setting">
          <label for="calibration-prop">{text().prop}</label>
          <div>
            <select id="calibration-prop" data-testid="calibration-prop" value={chosenProp() ?? ""} onChange={(event) => setProp(event.currentTarget.value)}>
              <For each={propsOfScene()}>{(entry) => <option value={entry.id}>{entry.label === "" ? entry.id : (entry.label ?? entry.id)}</option>}</For>
            </select>
          </div>
        </div>
      </Show>
      <Show when={kind() === "room_from_tracking"}>
        <fieldset class="setting">
          <legend>{text().offset}</legend>
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
                    data-testid={`calibration-offset-${AXES[axis]}`}
                    value={offset()[axis]}
                    onInput={(event) => {
                      const next: [string, string, string] = [...offset()];
                      next[axis] = event.currentTarget.value;
                      setOffset(next);
                    }}
                  />
                </label>
              )}
            </For>
            <small>{text().offsetMeans}</small>
          </div>
        </fieldset>
      </Show>
      <button type="submit" data-testid="calibration-begin" aria-describedby="calibration-missing" disabled={props.busy || missing() !== null}>
        {text().beginNow}
      </button>{" "}
      <span class="empty" id="calibration-missing" data-testid="calibration-missing">
        {missing() ?? ""}
      </span>
    </form>
  );
}

const AXES = ["x", "y", "z"] as const;
