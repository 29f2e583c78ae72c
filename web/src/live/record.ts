/** The events that pass a filter: what the server has stored, page by page, and what has just arrived. */
import { createEffect, createMemo, createSignal, on, onCleanup, type Accessor } from "solid-js";
import { readEvents, type EventPage, type EventQuery } from "../api/http";
import type { WireEvent } from "../api/types";
import { kindsOf, merged, passes, type Filter } from "../lib/timeline";
import type { Live } from "./live";
import { troubleOf } from "../lib/trouble";

/** What the timeline reads. */
export interface EventRecord {
  /** Newest first. */
  readonly events: Accessor<readonly WireEvent[]>;
  readonly loading: Accessor<boolean>;
  /** Why events could not be read. */
  readonly trouble: Accessor<string | null>;
  /** Older ones can be loaded. */
  readonly hasOlder: Accessor<boolean>;
  readonly loadOlder: () => Promise<void>;
}

/** Reads the first page whenever the filter changes, and follows what arrives. */
export function createRecord(
  live: Live,
  filter: Accessor<Filter>,
  read: (query: EventQuery | string, giveUp: AbortSignal) => Promise<EventPage> = readEvents,
): EventRecord {
  const [stored, setStored] = createSignal<readonly WireEvent[]>([]);
  const [next, setNext] = createSignal<string | null>(null);
  const [loading, setLoading] = createSignal(false);
  const [trouble, setTrouble] = createSignal<string | null>(null);
  let asking: AbortController | null = null;
  let later: ReturnType<typeof setTimeout> | undefined;

  /** Takes a page in; an answer that was overtaken has no say. */
  const page = async (from: EventQuery | string, take: (found: EventPage) => void): Promise<void> => {
    asking?.abort();
    const mine = new AbortController();
    asking = mine;
    setLoading(true);
    try {
      const found = await read(from, mine.signal);
      if (mine.signal.aborted) return;
      setTrouble(null);
      take(found);
    } catch (error) {
      if (!mine.signal.aborted) setTrouble(troubleOf(error));
    } finally {
      if (asking === mine) {
        asking = null;
        setLoading(false);
      }
    }
  };
  const queryOf = ({ session, search, person, ...rest }: Filter): EventQuery => ({ kinds: kindsOf({ session, search, person, ...rest }), session, search, person });
  const first = (): Promise<void> =>
    page(queryOf(filter()), (found) => {
      setStored(found.events);
      setNext(found.next);
    });

  // Typing waits for the hand to rest; so does a burst of events.
  const isOpen = createMemo(() => live.link().phase === "open");
  createEffect(
    on([filter, isOpen], ([, open]) => {
      clearTimeout(later);
      if (open) later = setTimeout(() => void first(), REST_MILLIS);
    }),
  );
  // Whether an event is of the session, only the server says.
  const newest = createMemo(() => live.events()[0]);
  createEffect(
    on(
      newest,
      () => {
        if (filter().session === null) return;
        clearTimeout(later);
        later = setTimeout(() => void page(queryOf(filter()), (found) => setStored((before) => merged(found.events, before))), REST_MILLIS);
      },
      { defer: true },
    ),
  );
  onCleanup(() => {
    clearTimeout(later);
    asking?.abort();
  });

  return {
    events: () => {
      const wanted = filter();
      const kept = stored();
      if (wanted.session !== null) return kept;
      return merged(live.events().filter((event) => passes(event, wanted)), kept.filter((event) => passes(event, wanted)));
    },
    loading,
    trouble,
    hasOlder: () => next() !== null,
    loadOlder: async () => {
      const from = next();
      if (from === null || loading()) return;
      await page(from, (found) => {
        setStored((before) => merged(before, found.events));
        setNext(found.next);
      });
    },
  };
}

/** Wait this long before asking, ms. */
const REST_MILLIS = 200;
