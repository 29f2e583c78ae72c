/** One object's prior: a slider and a number, what is in force, and what the edit would do to its weight. */
import { createSignal, Show, type JSX } from "solid-js";
import type { ObjectState } from "../api/types";
import { words } from "../i18n";
import { readPrior, type Draft } from "../lib/priorDrafts";
import { decimal } from "../lib/format";

/** A row. The number field refuses what is no prior, and says what it expects. */
export function PriorRow(props: {
  readonly object: ObjectState;
  readonly label: string;
  readonly inForce: number;
  readonly draft: Draft | null;
  /** Who changed it since the edit began; null when nobody did. */
  readonly overtakenBy: string | null;
  readonly weightThen: number | null;
  readonly frozen: boolean;
  readonly move: (value: number) => void;
}): JSX.Element {
  const [wrong, setWrong] = createSignal<string | null>(null);
  const text = (): ReturnType<typeof words>["desk"]["priors"] => words().desk.priors;
  const value = (): number => props.draft?.value ?? props.inForce;
  const typed = (field: HTMLInputElement): boolean => {
    const read = readPrior(field.value);
    if ("wrong" in read) {
      setWrong(read.wrong === "not_a_number" ? text().notANumber(field.value) : text().outOfRange(field.value));
      return false;
    }
    setWrong(null);
    // Two digits are shown: a field that was left as it stood changes nothing.
    if (field.value !== decimal(value(), 2)) props.move(read.value);
    field.value = decimal(value(), 2);
    return true;
  };
  const notes = `prior-notes-${props.object.id}`;
  return (
    <li class="prior-row" classList={{ edited: props.draft !== null, overtaken: props.overtakenBy !== null }}>
      <span class="prior-name" title={props.label}>{props.label}</span>
      <input
        type="range"
        min="0"
        max="1"
        step="0.05"
        value={value()}
        disabled={props.frozen}
        aria-label={text().sliderOf(props.label)}
        aria-valuetext={decimal(value(), 2)}
        aria-describedby={notes}
        data-testid={`prior-${props.object.id}`}
        style={{ "--in-force": String(props.inForce) }}
        onInput={(event) => {
          setWrong(null);
          props.move(event.currentTarget.valueAsNumber);
        }}
      />
      <input
        type="text"
        inputmode="decimal"
        maxlength="8"
        autocomplete="off"
        value={decimal(value(), 2)}
        disabled={props.frozen}
        aria-label={text().numberOf(props.label)}
        aria-invalid={wrong() !== null}
        aria-describedby={notes}
        data-testid={`prior-number-${props.object.id}`}
        onChange={(event) => typed(event.currentTarget)}
        onKeyDown={(event) => {
          // What is wrong is not applied.
          if (event.key === "Enter" && !typed(event.currentTarget)) event.preventDefault();
        }}
      />
      <output class="unseen" data-testid={`prior-value-${props.object.id}`}>{decimal(props.inForce, 2)}</output>
      <span class="prior-notes" id={notes}>
        <Show when={wrong()}>{(why) => <span class="bad" role="alert" data-testid={`prior-wrong-${props.object.id}`}>{why()}</span>}</Show>
        <Show when={props.draft !== null}>
          <span class="prior-edited" data-testid={`prior-edited-${props.object.id}`}>
            {text().edited} ({text().inForce(decimal(props.inForce, 2))})
          </span>
        </Show>
        <Show when={props.overtakenBy !== null}>
          <span class="prior-overtaken" data-testid={`prior-overtaken-${props.object.id}`}>
            {props.overtakenBy === "" ? text().overtaken(decimal(props.inForce, 2)) : text().overtakenBy(props.overtakenBy ?? "", decimal(props.inForce, 2))}
          </span>
        </Show>
        <Show when={props.weightThen}>
          {(then) => <span class="prior-weight">{text().weightWouldBe(decimal(props.object.weight, 2), decimal(then(), 2))}</span>}
        </Show>
      </span>
    </li>
  );
}
