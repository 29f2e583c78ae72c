/** The game master's cockpit: where the scenario is, what leads on, cues, and skipping or going back with a reason. */
import { createMemo, createSignal, For, Show, type JSX } from "solid-js";
import type { MachineRequest, ObjectState, Scenario, SceneDocument, StateDocument, TransitionDocument } from "../api/types";
import { words } from "../i18n";
import { decimal, span } from "../lib/format";
import { labelOf } from "../lib/labels";
import { cuesOf, stateLabel, valueWords, waitsFor } from "../lib/scenarioWords";
import type { Live } from "../live/live";
import type { Answer } from "../live/requests";
import { wordsOf } from "../ui/Controls";
import { ContactPanel } from "../ui/scenario/ContactPanel";
import { ChecklistPanel } from "../ui/scenario/ChecklistPanel";
import { NotesPanel } from "../ui/scenario/NotesPanel";
import { PriorsPanel } from "../ui/scenario/PriorsPanel";
import { SkipPanel, type Leap } from "../ui/scenario/SkipPanel";
import { StateGraphPanel } from "../ui/scenario/StateGraphPanel";

/** The view. */
export function ScenarioView(props: { readonly live: Live; readonly author: string }): JSX.Element {
  const say = () => words().scenario;
  const scene = (): SceneDocument | null => props.live.scene()?.scene ?? null;
  const now = (): Scenario | null => props.live.snapshot()?.scenario ?? null;
  const [leap, setLeap] = createSignal<Leap | null>(null);
  const [answer, setAnswer] = createSignal<{ readonly what: string; readonly answer: Answer } | null>(null);
  const [asking, setAsking] = createSignal(false);
  const live = (): boolean => props.live.freshness().kind === "live";

  const ask = async (request: MachineRequest, what: string, reason?: string): Promise<void> => {
    setAsking(true);
    setAnswer(null);
    const result = await props.live.ask(request, reason);
    setAsking(false);
    setAnswer({ what, answer: result });
    setLeap(null);
  };
  const told = (): string | null => {
    const last = answer();
    return last === null ? null : say().said(last.what, wordsOf(last.answer));
  };
  const isRefused = (): boolean => {
    const last = answer()?.answer;
    return last?.kind === "unanswered" || last?.outcome === "refused";
  };
  const may = (request: string): boolean => live() && !asking() && props.live.identity.may(`dashboard ${request}`);

  return (
    <div class="sheet scenario-view">
      <h1>{say().title}</h1>
      <Show when={scene()} fallback={<p>{say().noState}</p>}>
        {(document) => (
          <Show when={now()} fallback={<p data-testid="no-scenario">{say().none}</p>}>
            {(scenario) => (
              <>
                <StateGraphPanel scene={document()} now={scenario()} choose={(to) => { setLeap({ kind: "skip", to }); }} />
                <div class="scenario-panels">
                  <NowPanel scene={document()} now={scenario()} objects={props.live.snapshot()?.objects ?? []} />
                  <NextPanel scene={document()} now={scenario()} />
                  <Show when={props.live.snapshot()}>
                    {(snapshot) => <ContactPanel scene={document()} snapshot={snapshot()} may={may("arm_contact")} ask={(request, what) => void ask(request, what)} />}
                  </Show>
                  <PriorsPanel scene={document()} now={scenario()} objects={props.live.snapshot()?.objects ?? []} />
                  <CuePanel scene={document()} now={scenario()} may={may("cue") && scenario().runs} give={(name) => void ask({ cue: name }, name)} />
                  <SkipPanel
                    scene={document()}
                    now={scenario()}
                    leap={leap()}
                    choose={setLeap}
                    may={may("skip_to")}
                    go={(chosen, reason, what) => void ask(chosen.kind === "skip" ? { skip_to: chosen.to } : "rewind", what, reason)}
                  />
                </div>
                <p class="answer" role="status" data-testid="scenario-answer" classList={{ refused: isRefused() }}>
                  {told() ?? (props.live.identity.may("dashboard cue") ? "" : say().notForRole)}
                </p>
              </>
            )}
          </Show>
        )}
      </Show>
      <div class="scenario-panels">
        <ChecklistPanel live={props.live} author={props.author} />
        <NotesPanel live={props.live} author={props.author} />
      </div>
    </div>
  );
}

interface Part {
  readonly scene: SceneDocument;
  readonly now: Scenario;
}

function NowPanel(props: Part & { readonly objects: readonly ObjectState[] }): JSX.Element {
  const say = () => words().scenario;
  const state = (): StateDocument | undefined => stateOf(props.scene, props.now.state);
  /** With the prior in force: the state's, unless a game master set one. */
  const enabled = (): string => {
    const names = props.objects.filter((object) => object.enabled).map(({ id, prior }) => say().withPrior(labelOf(props.scene, id), decimal(prior, 2)));
    return names.length === 0 ? say().enabledNothing : names.join("; ");
  };
  return (
    <section class="panel" aria-labelledby="scenario-now">
      <h2 id="scenario-now">{say().now}</h2>
      <p class="scenario-state" data-testid="scenario-state">{stateLabel(props.scene, props.now.state)}</p>
      <p data-testid="scenario-time">{say().inState(span(props.now.in_state_secs))}</p>
      <Show when={state()?.note}>{(note) => <p class="scenario-note">{note()}</p>}</Show>
      <p data-testid="scenario-runs" classList={{ warn: !props.now.runs || props.now.is_cut }}>
        {props.now.is_cut ? say().cut : props.now.runs ? (state()?.final === true ? say().ended : say().runs) : say().stands}
      </p>
      <Show when={props.now.left_in}>{(left) => <p data-testid="scenario-left-in">{say().lastEnded(stateLabel(props.scene, left()))}</p>}</Show>
      <dl class="facts">
        <div>
          <dt>{say().enabled}</dt>
          <dd data-testid="scenario-enabled">{enabled()}</dd>
        </div>
        <For each={Object.entries(props.now.variables)}>
          {([name, value]) => (
            <div>
              <dt>{name}</dt>
              <dd data-testid={`variable-${name}`}>{valueWords(value)}</dd>
            </div>
          )}
        </For>
      </dl>
    </section>
  );
}

function NextPanel(props: Part): JSX.Element {
  const say = () => words().scenario;
  const way = (index: number, isFromAnywhere: boolean): TransitionDocument | undefined =>
    isFromAnywhere ? props.scene.scenario?.anywhere?.[index] : stateOf(props.scene, props.now.state)?.transitions?.[index];
  const due = (secs: number | null): string => (secs === null ? "" : secs > 0 ? say().due(span(secs)) : "");
  return (
    <section class="panel" aria-labelledby="scenario-next">
      <h2 id="scenario-next">{say().nextTitle}</h2>
      <Show when={props.now.next.length > 0} fallback={<p>{say().nextNothing}</p>}>
        <ul class="scenario-ways" data-testid="scenario-next-list">
          <For each={props.now.next}>
            {(next) => (
              <li>
                <strong>{next.to === null ? say().stays : say().to(stateLabel(props.scene, next.to))}</strong>
                <span>{describe(way(next.index, next.is_from_anywhere), props.scene)}</span>
                <span class="scenario-due">
                  {next.is_from_anywhere ? say().anywhere : ""} {due(next.due_secs)}
                </span>
              </li>
            )}
          </For>
        </ul>
      </Show>
    </section>
  );
}

function CuePanel(props: Part & { readonly may: boolean; readonly give: (name: string) => void }): JSX.Element {
  const say = () => words().scenario;
  const awaited = createMemo((): ReadonlySet<string> => {
    const ways = props.now.next.map(({ index, is_from_anywhere }) =>
      is_from_anywhere ? props.scene.scenario?.anywhere?.[index] : stateOf(props.scene, props.now.state)?.transitions?.[index],
    );
    return new Set(ways.flatMap((way) => (way?.on ?? []).flatMap((on) => (on.kind === "cue" ? [on.name] : []))));
  });
  const cues = createMemo(() => cuesOf(props.scene));
  return (
    <section class="panel" aria-labelledby="scenario-cues">
      <h2 id="scenario-cues">{say().cues}</h2>
      <Show when={cues().length > 0} fallback={<p>{say().cuesNone}</p>}>
        <ul class="scenario-cues">
          <For each={cues()}>
            {(name, index) => (
              <li>
                <button
                  type="button"
                  data-testid={`cue-${name}`}
                  classList={{ primary: awaited().has(name) }}
                  disabled={!props.may || !awaited().has(name)}
                  aria-describedby={`cue-why-${String(index())}`}
                  onClick={() => { props.give(name); }}
                >
                  {name}
                </button>
                <span class="why-not" id={`cue-why-${String(index())}`}>
                  {awaited().has(name) ? (props.now.runs ? say().cueAwaited : say().stands) : say().cueNotAwaited}
                </span>
              </li>
            )}
          </For>
        </ul>
      </Show>
    </section>
  );
}

function describe(way: TransitionDocument | undefined, scene: SceneDocument): string {
  if (way === undefined) return "";
  const waits = waitsFor(way, scene);
  return way.label === undefined || way.label === "" ? waits : `${way.label}${words().shell.colon}${waits}`;
}

function stateOf(scene: SceneDocument, id: string): StateDocument | undefined {
  return scene.scenario?.states.find((state) => state.id === id);
}
