/** Calibration, step by step: choose, take points, look at how well they agree, accept; and what was accepted before. */
import { createResource, createSignal, Show, type JSX } from "solid-js";
import { acceptCalibration, discardCalibration, listCalibrations, readCalibrationDraft } from "../../api/http";
import type { CalibrationDraft } from "../../api/types";
import { words } from "../../i18n";
import { troubleOf } from "../../lib/trouble";
import type { Live } from "../../live/live";
import { Begin } from "./Begin";
import { Making } from "./Making";
import { Versions } from "./Versions";

/** What an act came to, in whatever language the page is read. */
interface Outcome {
  readonly text: () => string;
  readonly refused: boolean;
}

/** Does something with the server and says what came of it; null: nothing to say. */
export type Act = (does: () => Promise<(() => string) | null>) => Promise<void>;

/** The panel. Nothing of it is sent before somebody presses a button. */
export function Calibration(props: { readonly live: Live; readonly author: string }): JSX.Element {
  const [draft, { mutate: show, refetch: readDraft }] = createResource(readCalibrationDraft);
  const [all, { refetch: readAll }] = createResource(listCalibrations);
  const [said, say] = createSignal<Outcome | null>(null);
  const [busy, setBusy] = createSignal(false);
  const text = () => words().machine.calibration;
  const now = (): CalibrationDraft | null => (draft.error === undefined ? (draft.latest ?? null) : null);
  const mayNot = (): string | null => (props.live.identity.may("POST /api/v1/calibrations") ? null : text().notForRole);

  const act: Act = async (does) => {
    setBusy(true);
    say(null);
    try {
      const done = await does();
      if (done !== null) say({ text: done, refused: false });
    } catch (error) {
      say({ text: () => troubleOf(error), refused: true });
    } finally {
      setBusy(false);
    }
  };
  const accept = (): Promise<void> =>
    act(async () => {
      const stored = await acceptCalibration(props.author);
      show(null);
      await readAll();
      return () => text().accepted(stored.subject, stored.version);
    });
  const discard = (): Promise<void> =>
    act(async () => {
      await discardCalibration(props.author);
      show(null);
      return () => text().discarded;
    });

  return (
    <section class="panel calibration" aria-labelledby="calibration-title" data-testid="calibration">
      <h2 id="calibration-title">{text().title}</h2>
      <p class="empty">{text().means}</p>
      <Show when={mayNot()}>{(why) => <p class="empty" data-testid="calibration-may-not">{why()}</p>}</Show>
      <Show when={draft.error !== undefined || all.error !== undefined}>
        <p class="answer refused" role="alert">
          {text().notRead} {troubleOf(draft.error ?? all.error)}
        </p>
        <button type="button" onClick={() => { void readDraft(); void readAll(); }}>
          {text().again}
        </button>
      </Show>
      <Show when={mayNot() === null || now() !== null}>
        <Show
          when={now()}
          fallback={<Begin live={props.live} author={props.author} busy={busy()} act={act} show={show} />}
        >
          {(made) => (
            <Making
              live={props.live}
              author={props.author}
              draft={made()}
              busy={busy()}
              locked={mayNot() !== null}
              act={act}
              show={show}
              accept={() => void accept()}
              discard={() => void discard()}
            />
          )}
        </Show>
      </Show>
      <p class="answer" classList={{ refused: said()?.refused === true }} role="status" data-testid="calibration-said">
        {busy() ? text().busy : (said()?.text() ?? "")}
      </p>
      <Versions
        all={(all.error === undefined ? all.latest : undefined) ?? []}
        author={props.author}
        busy={busy()}
        locked={mayNot() !== null}
        act={act}
        again={async () => { await readAll(); }}
      />
    </section>
  );
}
