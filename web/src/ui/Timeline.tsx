/** What happened, newest first: filtered, paused, as far back as wanted, and on a bar of the last minutes. */
import { createMemo, createSignal, For, Show, type JSX } from "solid-js";
import type { WireEvent } from "../api/types";
import { words } from "../i18n";
import { dayAndTime, decimal, timeOfDay } from "../lib/format";
import { labelOf } from "../lib/labels";
import { GROUP_NAMES, groupOf, keyOf, personOf, type Filter, type Group } from "../lib/timeline";
import type { Live } from "../live/live";
import { createRecord } from "../live/record";
import { EventSaid } from "./EventSaid";
import { eventWords, particularsOf } from "./eventWords";
import { TimeBar } from "./TimeBar";

/** Filters, bar, list and particulars. */
export function Timeline(props: { readonly live: Live }): JSX.Element {
  const [groups, setGroups] = createSignal<readonly Group[]>([]);
  const [search, setSearch] = createSignal("");
  const [person, setPerson] = createSignal<string | null>(null);
  const [ofSession, setOfSession] = createSignal(false);
  const [paused, setPaused] = createSignal<readonly WireEvent[] | null>(null);
  const [selected, setSelected] = createSignal<WireEvent | null>(null);
  const text = (): ReturnType<typeof words>["desk"]["timeline"] => words().desk.timeline;
  const label = (id: string): string => labelOf(props.live.scene()?.scene ?? null, id);
  const session = createMemo(() => props.live.snapshot()?.session_id ?? null);
  const asked = createMemo(() => (ofSession() ? session() : null));
  const filter = createMemo((): Filter => ({ groups: groups(), search: search().trim(), person: person(), session: asked() }));
  const record = createRecord(props.live, filter);
  const shown = (): readonly WireEvent[] => paused() ?? record.events();
  const newer = (): number => {
    const newest = paused()?.[0]?.at ?? "";
    return paused() === null ? 0 : record.events().filter(({ at }) => at > newest).length;
  };
  const persons = createMemo((): readonly string[] => {
    const names = new Set(props.live.snapshot()?.persons.map(({ name }) => name) ?? []);
    for (const event of props.live.events()) {
      const name = personOf(event);
      if (name !== null) names.add(name);
    }
    const chosen = person();
    if (chosen !== null) names.add(chosen);
    return [...names].sort((one, other) => one.localeCompare(other));
  });
  /** The wall clock in whole seconds, so that the bar moves on and nothing is drawn ten times a second. */
  const now = createMemo(() => {
    props.live.nowMillis();
    return Math.ceil(Date.now() / 1000) * 1000;
  });
  /** Every filter but pausing and paging changes what is asked: a paused list of other events would mislead. */
  const change = (set: () => void): void => {
    setPaused(null);
    set();
  };
  const plainWords = (event: WireEvent): string => eventWords(event, label).text ?? event.summary;

  return (
    <section class="panel grows timeline" aria-labelledby="timeline-title">
      <h2 id="timeline-title">
        {text().title}
        <button
          type="button"
          class="chip"
          data-testid="timeline-pause"
          aria-pressed={paused() !== null}
          onClick={() => setPaused((before) => (before === null ? record.events() : null))}
        >
          {paused() === null ? text().pause : text().follow}
        </button>
        <Show when={paused() !== null}>
          <small role="status" data-testid="timeline-paused">{text().paused(newer())}</small>
        </Show>
      </h2>
      <div class="filters">
        <div class="chips" role="group" aria-label={text().groupFilter}>
          <For each={GROUP_NAMES}>
            {(group) => (
              <button
                type="button"
                class="chip"
                data-group={group}
                data-testid={`timeline-group-${group}`}
                aria-pressed={groups().includes(group)}
                onClick={() => { change(() => setGroups((before) => (before.includes(group) ? before.filter((entry) => entry !== group) : [...before, group]))); }}
              >
                {text().groups[group]}
              </button>
            )}
          </For>
        </div>
        <input
          type="search"
          maxlength="200"
          data-testid="timeline-search"
          aria-label={text().search}
          placeholder={text().search}
          value={search()}
          onInput={(event) => {
            const wanted = event.currentTarget.value;
            change(() => setSearch(wanted));
          }}
        />
        <select
          aria-label={text().person}
          data-testid="timeline-person"
          onChange={(event) => {
            const wanted = event.currentTarget.value;
            change(() => setPerson(wanted === "" ? null : wanted));
          }}
        >
          <option value="">{text().everybody}</option>
          <For each={persons()}>{(name) => <option value={name} selected={person() === name}>{name}</option>}</For>
        </select>
        <button
          type="button"
          class="chip"
          data-testid="timeline-session"
          aria-pressed={ofSession() && session() !== null}
          disabled={session() === null}
          title={session() === null ? text().noSession : undefined}
          onClick={() => { change(() => setOfSession((before) => !before)); }}
        >
          {text().session}
        </button>
      </div>
      <TimeBar events={shown()} nowMillis={now()} selected={mapped(selected())} wordsOf={plainWords} select={setSelected} />
      <Show when={record.trouble()}>
        {(why) => (
          <p class="bad" role="alert" data-testid="timeline-trouble">
            {text().failed} {why()}
          </p>
        )}
      </Show>
      <Show when={selected()}>{(event) => <Details event={event()} label={label} close={() => setSelected(null)} />}</Show>
      <Show when={shown().length > 0} fallback={<p class="empty">{record.loading() ? text().loading : isFiltered(filter()) ? text().nothingFound : text().empty}</p>}>
        <ol class="events scrolls" tabindex="0" aria-label={text().list} data-testid="events">
          <For each={shown()}>
            {(event) => (
              <li data-kind={event.kind} data-group={groupOf(event.kind)}>
                <button type="button" class="event" aria-pressed={mapped(selected()) === keyOf(event)} onClick={() => setSelected((before) => (before !== null && keyOf(before) === keyOf(event) ? null : event))}>
                  <time datetime={event.at} title={dayAndTime(event.at)}>{timeOfDay(event.at)}</time>
                  <span class="event-group">{text().groups[groupOf(event.kind)]}</span>
                  <EventSaid event={event} label={label} />
                </button>
              </li>
            )}
          </For>
          <li class="older">
            <Show when={record.hasOlder() && paused() === null} fallback={<small>{record.hasOlder() ? "" : text().noOlder}</small>}>
              <button type="button" data-testid="timeline-older" disabled={record.loading()} onClick={() => void record.loadOlder()}>
                {record.loading() ? text().loading : text().older}
              </button>
            </Show>
          </li>
        </ol>
      </Show>
    </section>
  );
}

function Details(props: { readonly event: WireEvent; readonly label: (id: string) => string; readonly close: () => void }): JSX.Element {
  const text = (): ReturnType<typeof words>["desk"]["timeline"] => words().desk.timeline;
  return (
    <div class="event-details" role="region" aria-label={text().details} data-testid="event-details">
      <div class="event-details-head">
        <b><EventSaid event={props.event} label={props.label} /></b>
        <button type="button" class="chip" data-testid="event-details-close" onClick={() => { props.close(); }}>{text().close}</button>
      </div>
      <dl>
        <div>
          <dt>{text().when}</dt>
          <dd>{dayAndTime(props.event.at)}</dd>
        </div>
        <For each={particularsOf(props.event, props.label)}>
          {({ name, value, foreign }) => (
            <div>
              <dt>{name}</dt>
              <dd lang={foreign ? "en" : undefined}>{value}</dd>
            </div>
          )}
        </For>
        <div>
          <dt>{text().said}</dt>
          <dd lang="en">{props.event.summary}</dd>
        </div>
        <div>
          <dt>{text().serverClock}</dt>
          <dd>{decimal(props.event.at_micros / 1e6, 3)} s</dd>
        </div>
      </dl>
    </div>
  );
}

function mapped(event: WireEvent | null): string | null {
  return event === null ? null : keyOf(event);
}

function isFiltered({ groups, search, person, session }: Filter): boolean {
  return groups.length > 0 || search !== "" || person !== null || session !== null;
}
