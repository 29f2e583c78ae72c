/**
 * Everything about the running machine on one screen. On a laptop panels stand left and right of the picture; on a
 * tablet they are tabs beside or under it. Each user's arrangement is kept.
 */
import { createEffect, createMemo, createSignal, For, onCleanup, onMount, Show, type JSX } from "solid-js";
import { words } from "../i18n";
import { createLayout, type Limits } from "../lib/layout";
import type { PreferenceStore } from "../lib/preferences";
import type { Live } from "../live/live";
import { Controls } from "../ui/Controls";
import { Decisions } from "../ui/Decisions";
import { Foldable } from "../ui/Foldable";
import { LinkQuality } from "../ui/LinkQuality";
import { Persons } from "../ui/Persons";
import { Priors } from "../ui/Priors";
import { Rules } from "../ui/Rules";
import { SideView } from "../ui/SideView";
import { Splitter } from "../ui/Splitter";
import { Timeline } from "../ui/Timeline";
import { livePicture, TopView } from "../ui/TopView";
import { Weights } from "../ui/Weights";
import type { Ghost } from "../ui/Arena";

/** Machine, persons and rules; the pictures; weights, priors, events and links. */
export function LiveView(props: {
  readonly live: Live;
  readonly author: string;
  /** What the present user likes. */
  readonly preferences: PreferenceStore;
}): JSX.Element {
  const layout = createLayout(props.preferences);
  const narrow = createMediaQuery(NARROW);
  const tab = (): Tab => layout.choice("tab", TABS);
  const [ghost, setGhost] = createSignal<Ghost | null>(null);
  const picture = livePicture(props.live, ghost);
  const side = (): boolean => layout.flag("side_view", false);
  const left = createMemo(() => layout.size("left", LEFT));
  const right = createMemo(() => layout.size("right", RIGHT));
  const below = createMemo(() => layout.size("below", BELOW));
  const rows = createAfterFirstState(props.live);
  const NoState = (panel: { readonly name: PanelName }): JSX.Element => (
    <section class="panel grows">
      <h2>{words().live.panel[panel.name]}</h2>
      <p class="empty">{words().desk.links.noState}</p>
    </section>
  );
  /** A tab shows its panels alone; a laptop shows all. */
  const Group = (group: { readonly tab: Tab; readonly children: JSX.Element }): JSX.Element => (
    <div
      class="group"
      id={`tab-panel-${group.tab}`}
      role={narrow() ? "tabpanel" : undefined}
      aria-labelledby={narrow() ? `tab-${group.tab}` : undefined}
      hidden={narrow() && tab() !== group.tab}
    >
      {group.children}
    </div>
  );
  const Panel = (panel: { readonly name: PanelName; readonly grows?: boolean; readonly foldedAtFirst?: boolean; readonly children: JSX.Element }): JSX.Element => (
    <Foldable
      name={panel.name}
      title={words().live.panel[panel.name]}
      grows={panel.grows === true}
      folded={layout.flag(`fold_${panel.name}`, panel.foldedAtFirst === true)}
      fold={(folded) => { layout.keep(`fold_${panel.name}`, folded); }}
    >
      {panel.children}
    </Foldable>
  );
  return (
    <div class="desk" style={{ "--left": `${left()}px`, "--right": `${right()}px`, "--below": `${below()}px` }} data-testid="desk">
      <h1 class="unseen">{words().live.title}</h1>
      <Show when={narrow()}>
        <TabList chosen={tab()} choose={(next) => { layout.keep("tab", next); }} />
      </Show>
      <div class="desk-side desk-left" hidden={narrow() && !LEFT_TABS.has(tab())}>
        <Group tab="machine">
          <Panel name="machine"><Controls live={props.live} /></Panel>
          <Panel name="persons"><Persons live={props.live} /></Panel>
        </Group>
        <Group tab="rules">
          <Panel name="rules" grows><Rules live={props.live} /></Panel>
        </Group>
      </div>
      <Splitter sizes="left" label={words().live.resizeLeft} value={left()} limits={LEFT} change={(px) => { layout.keep("left", px); }} testId="split-left" />
      <div class="desk-middle">
        <TopView live={props.live} picture={picture} layout={layout} />
        <Show when={side()}>
          <Splitter sizes="below" label={words().live.resizeSide} value={below()} limits={BELOW} change={(px) => { layout.keep("below", px); }} testId="split-below" />
          <SideView
            picture={picture}
            axis={layout.choice("axis", ["x", "y"])}
            setAxis={(axis) => { layout.keep("axis", axis); }}
            names={layout.flag("layer_labels", true)}
          />
        </Show>
      </div>
      <Splitter sizes="right" label={words().live.resizeRight} value={right()} limits={RIGHT} change={(px) => { layout.keep("right", px); }} testId="split-right" />
      <div class="desk-side desk-right" hidden={narrow() && LEFT_TABS.has(tab())}>
        <Group tab="objects">
          <Panel name="decisions"><Decisions live={props.live} /></Panel>
          <Panel name="weights" grows>
            <Show when={rows()} fallback={<NoState name="weights" />}><Weights live={props.live} /></Show>
          </Panel>
          <Panel name="priors" grows>
            <Show when={rows()} fallback={<NoState name="priors" />}><Priors live={props.live} author={props.author} onGhost={setGhost} /></Show>
          </Panel>
        </Group>
        <Group tab="events">
          <Panel name="timeline" grows><Timeline live={props.live} /></Panel>
          <Panel name="links" grows foldedAtFirst={!narrow()}><LinkQuality live={props.live} /></Panel>
        </Group>
      </div>
    </div>
  );
}

/** True once the first state has been painted: two rows for each of hundreds of objects wait for what matters most. */
function createAfterFirstState(live: Live): () => boolean {
  const [painted, setPainted] = createSignal(false);
  createEffect(() => {
    if (painted() || live.snapshot() === null) return;
    // A task of its own after the frame: the frame is shown by then.
    requestAnimationFrame(() => setTimeout(() => setPainted(true)));
  });
  return painted;
}

/** The tablet's tabs: arrows go from one to the next. */
function TabList(props: { readonly chosen: Tab; readonly choose: (tab: Tab) => void }): JSX.Element {
  let list!: HTMLDivElement;
  const pressed = (event: KeyboardEvent): void => {
    const at = TABS.indexOf(props.chosen);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: TABS.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    const next = TABS[(to + TABS.length) % TABS.length] ?? TABS[0];
    props.choose(next);
    list.querySelector<HTMLElement>(`#tab-${next}`)?.focus();
  };
  return (
    <div class="tabs" role="tablist" aria-label={words().live.tabs} ref={list} onKeyDown={pressed}>
      <For each={TABS}>
        {(tab) => (
          <button
            type="button"
            role="tab"
            id={`tab-${tab}`}
            data-testid={`tab-${tab}`}
            aria-selected={props.chosen === tab}
            aria-controls={`tab-panel-${tab}`}
            tabindex={props.chosen === tab ? 0 : -1}
            onClick={() => { props.choose(tab); }}
          >
            {words().live.tab[tab]}
          </button>
        )}
      </For>
    </div>
  );
}

function createMediaQuery(query: string): () => boolean {
  const list = matchMedia(query);
  const [matches, setMatches] = createSignal(list.matches);
  onMount(() => {
    const changed = (): void => { setMatches(list.matches); };
    list.addEventListener("change", changed);
    onCleanup(() => { list.removeEventListener("change", changed); });
  });
  return matches;
}

const TABS = ["machine", "rules", "objects", "events"] as const;
type Tab = (typeof TABS)[number];
type PanelName = keyof ReturnType<typeof words>["live"]["panel"];
const LEFT_TABS: ReadonlySet<Tab> = new Set(["machine", "rules"]);
/** As in live.css. */
const NARROW = "(max-width: 1180px)";
const LEFT: Limits = { least: 220, greatest: 420, standard: 280 };
const RIGHT: Limits = { least: 320, greatest: 680, standard: 470 };
const BELOW: Limits = { least: 120, greatest: 480, standard: 210 };
