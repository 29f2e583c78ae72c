/** What was accepted before: by whom, when, how good, on which hardware, and which of it is in force. */
import { createSignal, For, Show, type JSX } from "solid-js";
import { chooseCalibration, writeCalibrationIntoScene } from "../../api/http";
import type { CalibrationSummary } from "../../api/types";
import { words } from "../../i18n";
import { dayAndTime } from "../../lib/format";
import type { Act } from "./Calibration";
import { resultWords } from "./resultWords";

/** The list, newest first. */
export function Versions(props: {
  readonly all: readonly CalibrationSummary[];
  readonly author: string;
  readonly busy: boolean;
  readonly locked: boolean;
  readonly act: Act;
  readonly again: () => Promise<void>;
}): JSX.Element {
  const text = () => words().machine.calibration;
  const [asking, setAsking] = createSignal<number | null>(null);
  const choose = (one: CalibrationSummary, inForce: boolean): void => {
    setAsking(null);
    void props.act(async () => {
      await chooseCalibration(one.id, inForce, props.author);
      await props.again();
      return () => (inForce ? text().nowInForce(one.subject, one.version) : text().nowRetired(one.subject, one.version));
    });
  };
  const write = (one: CalibrationSummary): void => {
    void props.act(async () => {
      const stored = await writeCalibrationIntoScene(one.id, props.author);
      return () => text().written(stored.id, stored.version);
    });
  };
  return (
    <>
      <h3 id="calibration-versions">{text().versions}</h3>
      <Show when={props.all.length > 0} fallback={<p class="empty">{text().noVersions}</p>}>
        <ul class="versions" aria-labelledby="calibration-versions" data-testid="calibration-versions">
          <For each={props.all}>
            {(one) => (
              <li data-testid="calibration-version">
                <b>
                  {text().version(text().kinds[one.kind], one.subject, one.version)}
                  <Show when={one.in_force}>
                    <span class="tag">{text().inForce}</span>
                  </Show>
                </b>
                <div class="empty">
                  {text().by(one.author, dayAndTime(one.created_at))} · {text().pointsUsed(one.points_used, one.points_left_out)}
                </div>
                <div>{resultWords(one.result)}</div>
                <For each={one.changed}>
                  {(change) => (
                    <div class="answer refused">{text().changed(words().hardwareParts[change.part], change.was, change.is)}</div>
                  )}
                </For>
                <Show when={!props.locked}>
                  <Show
                    when={asking() === one.id}
                    fallback={
                      <button type="button" data-testid={one.in_force ? "calibration-retire" : "calibration-activate"} disabled={props.busy} onClick={() => setAsking(one.id)}>
                        {one.in_force ? text().retire : text().activate}
                      </button>
                    }
                  >
                    <span role="group" aria-label={text().sure}>
                      {one.in_force ? text().retireSure : text().activateSure}{" "}
                      <button type="button" data-testid="calibration-sure" onClick={() => { choose(one, !one.in_force); }}>
                        {text().sure}
                      </button>{" "}
                      <button type="button" class="quiet" onClick={() => setAsking(null)}>
                        {text().keep}
                      </button>
                    </span>
                  </Show>{" "}
                  <Show when={one.kind === "prop"}>
                    <button type="button" class="quiet" disabled={props.busy} onClick={() => { write(one); }}>
                      {text().intoScene}
                    </button>
                  </Show>
                </Show>
              </li>
            )}
          </For>
        </ul>
      </Show>
    </>
  );
}
