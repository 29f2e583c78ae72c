/**
 * The game master's word on how likely each object is: edited, looked at in a preview, then applied; set back; and who
 * changed what. Two game masters may be at it: what another applies shows at once, one's own edits stay and are marked.
 */
import { createEffect, createMemo, createSignal, For, on, onCleanup, Show, type JSX } from "solid-js";
import { changePriors, listPriorChanges, previewPriors } from "../api/http";
import type { ObjectState, PriorChange, PriorPreview, SceneDocument } from "../api/types";
import { words } from "../i18n";
import { decimal } from "../lib/format";
import { labelOf } from "../lib/labels";
import { drop, edit, editsTo, lastChangeOf, overtaken, overwritten, setBacksOf, settle, undoable, wanted, type Drafts, type PriorsNow, type SetBack } from "../lib/priorDrafts";
import type { Live } from "../live/live";
import { Previewer, type PreviewState } from "../live/preview";
import { PriorChanges } from "./PriorChanges";
import { PriorPreviewWords } from "./PriorPreviewWords";
import { PriorRow } from "./PriorRow";
import { troubleOf } from "../lib/trouble";

/** Where the column would go, for the picture. */
export interface PriorGhost {
  readonly target_m: readonly [number, number] | null;
  readonly path_m: readonly (readonly [number, number])[];
}

/** What is asked before somebody else's change is overwritten. */
interface Question {
  readonly words: string;
  readonly yes: () => Promise<void>;
}

type Text = ReturnType<typeof words>["desk"]["priors"];

/** Sliders, preview, apply, undo and the list of changes. */
export function Priors(props: {
  readonly live: Live;
  readonly author: string;
  /** Told what the edits would lead to; null when there is nothing to show. */
  readonly onGhost?: ((ghost: PriorGhost | null) => void) | undefined;
}): JSX.Element {
  const [drafts, setDrafts] = createSignal<Drafts>({});
  /** What has been applied, until a snapshot shows it. */
  const [landing, setLanding] = createSignal<PriorsNow>({});
  const [preview, setPreview] = createSignal<PreviewState>({ kind: "none" });
  const [changes, setChanges] = createSignal<readonly PriorChange[]>([]);
  /** When the newest change of before the last activation was made. */
  const [settledAt, setSettledAt] = createSignal("");
  const [said, say] = createSignal<{ readonly words: string; readonly server?: string; readonly bad: boolean } | null>(null);
  const [question, setQuestion] = createSignal<Question | null>(null);
  const [busy, setBusy] = createSignal(false);
  const [search, setSearch] = createSignal("");
  const text = (): Text => words().desk.priors;
  const scene = (): SceneDocument | null => props.live.scene()?.scene ?? null;
  const objects = (): readonly ObjectState[] => props.live.snapshot()?.objects ?? [];
  const label = (id: string): string => labelOf(scene(), id);
  const inForce = createMemo((): PriorsNow => ({ ...Object.fromEntries(objects().map(({ id, prior }) => [id, prior])), ...landing() }));
  const frozen = (): string | null => {
    const { kind } = props.live.freshness();
    return kind === "live" ? null : kind === "stale" ? text().stale : text().noState;
  };
  const shown = createMemo((): readonly ObjectState[] => {
    const sought = search().trim().toLowerCase();
    return objects().filter(({ id }) => sought === "" || id.toLowerCase().includes(sought) || label(id).toLowerCase().includes(sought));
  });
  const applies = createMemo(() => undoable(changes().filter(({ at }) => at > settledAt()), props.author, inForce()));
  const taken = createMemo(() => overtaken(drafts(), inForce()));
  const pending = (): number => Object.keys(drafts()).length;
  const weightThen = createMemo((): ReadonlyMap<string, number> => new Map(previewed(preview())?.objects.map(({ id, weight }) => [id, weight]) ?? []));

  const isLive = createMemo(() => frozen() === null);
  const previewer = new Previewer(previewPriors, setPreview);
  createEffect(
    on([drafts, isLive], ([now, live]) => {
      previewer.edited(live ? wanted(now) : {});
    }),
  );
  createEffect(() => {
    const found = previewed(preview());
    props.onGhost?.(found === null ? null : { target_m: found.target_m, path_m: found.planned_path_m });
  });
  onCleanup(() => {
    previewer.end();
    props.onGhost?.(null);
  });

  // What others set comes in with the snapshots.
  createEffect(() => {
    const now = inForce();
    if (Object.keys(now).length > 0) setDrafts((before) => settle(before, now));
  });
  createEffect(() => {
    const still = Object.entries(landing()).filter(([id, prior]) => objects().find((object) => object.id === id)?.prior !== prior);
    if (still.length < Object.keys(landing()).length) setLanding(Object.fromEntries(still));
  });
  let landed: ReturnType<typeof setTimeout> | undefined;
  onCleanup(() => {
    clearTimeout(landed);
  });
  // Another scene, or the same anew: its priors are its own, and what was before cannot be set back.
  const activation = createMemo(() =>
    [props.live.scene()?.id, props.live.scene()?.version, props.live.events().find(({ kind }) => kind === "scene_activated")?.at].join(),
  );
  createEffect(
    on(
      activation,
      () => {
        setSettledAt(changes()[0]?.at ?? "");
        setQuestion(null);
      },
      { defer: true },
    ),
  );

  const readChanges = async (): Promise<void> => {
    try {
      setChanges(await listPriorChanges());
    } catch (error) {
      say({ words: text().changesUnread, server: troubleOf(error), bad: true });
    }
  };
  // Anybody's change arrives as an event: the list is read again.
  const isOpen = createMemo(() => props.live.link().phase === "open");
  const lastChangeAt = createMemo(() => props.live.events().find((event) => event.kind === "prior_changed")?.at);
  createEffect(
    on([isOpen, lastChangeAt], ([open]) => {
      if (open) void readChanges();
    }),
  );

  const changeWords = (list: readonly SetBack[]): string => {
    const [first, ...others] = list;
    if (first === undefined) return "";
    const one = text().change(label(first.object), decimal(first.from, 2), decimal(first.to, 2));
    return others.length === 0 ? one : `${one} ${text().more(others.length)}`;
  };
  const send = async (priors: PriorsNow, done: string): Promise<boolean> => {
    if (busy() || frozen() !== null) return false;
    setBusy(true);
    setQuestion(null);
    try {
      await changePriors(priors, props.author);
      setLanding((before) => ({ ...before, ...priors }));
      clearTimeout(landed);
      landed = setTimeout(() => setLanding({}), SHOWN_WITHIN_MILLIS);
      say({ words: done, bad: false });
      void readChanges();
      return true;
    } catch (error) {
      say({ words: text().notApplied, server: troubleOf(error), bad: true });
      return false;
    } finally {
      setBusy(false);
    }
  };
  const applyNow = async (): Promise<void> => {
    const applied = drafts();
    const backs = setBacksOf(applied, inForce());
    if (backs.length === 0 || !(await send(wanted(applied), text().applied(changeWords(backs))))) return;
    setDrafts((before) => Object.keys(applied).reduce((left, id) => (before[id] === applied[id] ? drop(left, id) : left), before));
  };
  const apply = async (): Promise<void> => {
    const others = taken();
    if (others.length === 0) return applyNow();
    const what = others.map((id) => `${label(id)} ${priorText(inForce()[id])}`).join(", ");
    setQuestion({ words: text().conflictApply(what), yes: applyNow });
  };
  /** Sets changes back, and asks first when something else has changed them since. */
  const setBack = async (list: readonly SetBack[]): Promise<void> => {
    const back = async (): Promise<void> => {
      const now = inForce();
      const known = list.filter(({ object }) => now[object] !== undefined);
      const done = known.map(({ object, from }) => ({ object, from: now[object] ?? from, to: from }));
      await send(Object.fromEntries(known.map(({ object, from }) => [object, from])), text().setBackDone(changeWords(done)));
    };
    const lost = overwritten(list, inForce());
    if (lost.length === 0) return back();
    const what = lost.map(({ object }) => {
      const last = lastChangeOf(changes(), object);
      const value = priorText(inForce()[object]);
      return last === null ? `${label(object)} ${value}` : `${label(object)} ${value} (${last.author || text().somebody})`;
    });
    setQuestion({ words: text().conflictUndo(what.join(", ")), yes: back });
  };
  const undo = async (): Promise<void> => {
    const last = applies().at(-1);
    if (last !== undefined) await setBack(last);
  };
  const undoes = (): string => changeWords((applies().at(-1) ?? []).map(({ object, from, to }) => ({ object, from: to, to: from })));
  const discard = (): void => {
    setDrafts({});
    setQuestion(null);
    say(null);
  };
  const move = (id: string, value: number): void => {
    setDrafts((before) => edit(before, id, value, inForce()[id] ?? value));
    setQuestion(null);
    say(null);
  };
  const preset = (target: PriorsNow): void => {
    setDrafts((before) => editsTo(before, target, inForce()));
    say(null);
  };
  const pressed = (event: KeyboardEvent): void => {
    const typing = event.target instanceof HTMLInputElement && event.target.type !== "range";
    if ((event.ctrlKey || event.metaKey) && !event.shiftKey && event.key.toLowerCase() === "z" && !typing) {
      event.preventDefault();
      void undo();
    }
    // A field that was typed in takes its value in before: its own handler runs first.
    if (event.key === "Enter" && event.target instanceof HTMLInputElement && event.target.type !== "search" && !event.defaultPrevented) {
      event.preventDefault();
      void apply();
    }
  };

  return (
    <section class="panel grows priors" aria-labelledby="priors-title" onKeyDown={pressed}>
      <h2 id="priors-title">{text().title}</h2>
      <div class="filters">
        <input type="search" data-testid="priors-search" aria-label={text().search} placeholder={text().search} value={search()} onInput={(event) => setSearch(event.currentTarget.value)} />
        <div class="presets" role="group" aria-label={text().presets}>
          <button type="button" class="chip" data-testid="preset-equal" disabled={frozen() !== null} onClick={() => { preset(Object.fromEntries(objects().map(({ id }) => [id, 1]))); }}>
            {text().allEqual}
          </button>
          <button type="button" class="chip" data-testid="preset-scene" disabled={frozen() !== null || scene() === null} onClick={() => { preset(Object.fromEntries(scene()?.objects.map(({ id, prior }) => [id, prior]) ?? [])); }}>
            {text().ofScene}
          </button>
        </div>
      </div>
      <ul class="prior-rows scrolls fades" tabindex="0" aria-label={text().list}>
        <For each={shown()}>
          {(object) => (
            <PriorRow
              object={object}
              label={label(object.id)}
              inForce={inForce()[object.id] ?? object.prior}
              draft={drafts()[object.id] ?? null}
              overtakenBy={taken().includes(object.id) ? (lastChangeOf(changes(), object.id)?.author ?? "") : null}
              weightThen={pending() > 0 ? (weightThen().get(object.id) ?? null) : null}
              frozen={!isLive()}
              move={(value) => { move(object.id, value); }}
            />
          )}
        </For>
      </ul>
      <PriorPreviewWords state={preview()} column={props.live.snapshot()?.column ?? null} persons={props.live.snapshot()?.persons ?? []} label={label} />
      <Show when={question()}>
        {(asked) => (
          <div class="prior-question" role="alertdialog" aria-labelledby="prior-question" data-testid="prior-question">
            <p id="prior-question">{asked().words}</p>
            <button type="button" data-testid="prior-question-yes" disabled={frozen() !== null} onClick={() => void asked().yes()}>
              {text().allTheSame}
            </button>
            <button type="button" data-testid="prior-question-no" onClick={() => setQuestion(null)}>
              {text().no}
            </button>
          </div>
        )}
      </Show>
      <p class="answer" classList={{ refused: said()?.bad === true || frozen() !== null }} role="status" data-testid="prior-status">
        {frozen() ?? said()?.words ?? (pending() > 0 ? text().pending(pending()) : text().hint)} <span>{frozen() === null ? said()?.server : ""}</span>
      </p>
      <div class="prior-acts">
        <button type="button" class="primary" data-testid="prior-apply" disabled={pending() === 0 || busy() || frozen() !== null} onClick={() => void apply()}>
          {busy() ? text().applying : text().apply}
        </button>
        <button type="button" data-testid="prior-discard" disabled={pending() === 0} onClick={discard}>
          {text().discard}
        </button>
        <button
          type="button"
          data-testid="prior-undo"
          aria-keyshortcuts="Control+Z"
          aria-label={applies().length === 0 ? text().undo : text().undoWhat(undoes())}
          title={applies().length === 0 ? text().undoNothing : text().undoWhat(undoes())}
          disabled={applies().length === 0 || busy() || frozen() !== null}
          onClick={() => void undo()}
        >
          {text().undo}
          <Show when={applies().length > 0}>
            <span class="undoes">{undoes()}</span>
          </Show>
        </button>
      </div>
      <PriorChanges
        changes={changes()}
        label={label}
        inForce={inForce()}
        frozen={frozen() !== null || busy()}
        setBack={(change) => void setBack([change])}
      />
    </section>
  );
}

function previewed(state: PreviewState): PriorPreview | null {
  return state.kind === "shown" ? state.preview : state.kind === "asking" ? state.last : null;
}

function priorText(prior: number | undefined): string {
  return prior === undefined ? "–" : decimal(prior, 2);
}

/** The server publishes about 30 times a second: by then its word counts, whatever it is, ms. */
const SHOWN_WITHIN_MILLIS = 1500;
