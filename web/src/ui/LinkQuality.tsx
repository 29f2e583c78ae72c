/** How the links stand: every VR client, the control loop, and this page's own. A state is a word and a shape, not a colour alone. */
import { createMemo, For, Show, type JSX } from "solid-js";
import type { Client, ControlLoop, LinkThresholds, Threshold } from "../api/types";
import { words } from "../i18n";
import { decimal, millis } from "../lib/format";
import { clauses } from "../lib/reasonWords";
import { gradeOf, growth, keyed, NO_LINKS, takeLinks, trace, worst, type ClientMeasure, type Grade, type LinksSeen } from "../live/links";
import type { Live } from "../live/live";
import { createRing, nowMicros } from "../live/ring";
import { STALE_AFTER_MILLIS } from "../live/state";
import { Said } from "./Said";
import { Sparkline } from "./Sparkline";

/** One line of a table. */
interface Measure {
  readonly name: string;
  readonly value: string;
  readonly grade: Grade | null;
  readonly threshold: string | null;
  readonly trace: readonly (number | null)[];
  readonly format: (value: number) => string;
  readonly testId: string;
}

type Text = ReturnType<typeof words>["desk"]["links"];

/** A table for each link. */
export function LinkQuality(props: { readonly live: Live }): JSX.Element {
  const history = createRing(props.live, NO_LINKS, takeLinks, 0);
  const until = createMemo(() => nowMicros(props.live, 1e6));
  const text = (): Text => words().desk.links;
  const clients = createMemo(() => keyed(props.live.snapshot()?.clients ?? []));
  const keys = createMemo(() => clients().map(({ key }) => key).join("\n"));
  const thresholds = (): LinkThresholds | null => props.live.server()?.thresholds ?? null;
  const nameOf = (id: number): string => props.live.snapshot()?.persons.find((person) => person.id === id)?.name ?? words().desk.priors.person(id);
  const seen = (pick: (seen: LinksSeen) => number | null | undefined): readonly (number | null)[] => trace(history(), until(), pick);

  const graded = (testId: string, name: string, value: number | null, threshold: Threshold | null, format: (value: number) => string, pick: (seen: LinksSeen) => number | null | undefined): Measure => ({
    name,
    testId,
    format,
    value: value === null ? words().desk.details.nothing : format(value),
    grade: gradeOf(value, threshold),
    threshold: threshold === null ? null : text().thresholds(format(threshold.weak), format(threshold.bad)),
    trace: seen(pick),
  });
  const ofClient = (key: string, client: Client): readonly Measure[] => {
    const pick = (measure: ClientMeasure) => (entry: LinksSeen) => entry.clients.get(key)?.[measure];
    const of = (measure: ClientMeasure, name: string, format: (value: number) => string, threshold: Threshold | null): Measure =>
      graded(`link-${key}-${measure}`, name, client[measure], threshold, format, pick(measure));
    const rate: Measure = { ...of("pose_rate_hz", text().rate, (value) => text().perSecond(decimal(value, 0)), null), grade: null };
    const errors = seen(pick("errors"));
    const fresh = growth(errors);
    return [
      rate,
      of("pose_age_millis", text().age, millis, thresholds()?.pose_age_millis ?? null),
      of("jitter_millis", text().jitter, millis, thresholds()?.jitter_millis ?? null),
      of("loss_percent", text().loss, percents, thresholds()?.loss_percent ?? null),
      of("rtt_millis", text().roundTrip, millis, thresholds()?.rtt_millis ?? null),
      {
        name: text().refused,
        testId: `link-${key}-errors`,
        format: String,
        value: fresh > 0 ? `${client.errors}, ${text().inMinute(fresh)}` : String(client.errors),
        grade: fresh > 0 ? "weak" : "good",
        threshold: null,
        trace: errors,
      },
    ];
  };
  const ofLoop = (loop: ControlLoop): readonly Measure[] => {
    const micros = (value: number): string => millis(value / 1000);
    const missed = seen((entry) => entry.loop.missed_deadlines);
    const fresh = growth(missed);
    return [
      graded("link-loop-p99", text().lateP99, loop.lateness_p99_micros, thresholds()?.lateness_micros ?? null, micros, (entry) => entry.loop.lateness_p99_micros),
      { ...graded("link-loop-max", text().lateMax, loop.lateness_max_micros, null, micros, (entry) => entry.loop.lateness_max_micros), grade: null },
      {
        name: text().missed,
        testId: "link-loop-missed",
        format: String,
        value: `${text().missedOf(loop.missed_deadlines, loop.steps)}${fresh > 0 ? `, ${text().inMinute(fresh)}` : ""}`,
        grade: fresh > 0 ? "weak" : "good",
        threshold: null,
        trace: missed,
      },
    ];
  };
  const ofPage = (): readonly Measure[] => {
    const freshness = props.live.freshness();
    const age = freshness.kind === "none" ? null : freshness.ageMillis;
    const rates = seen((entry) => entry.snapshots);
    return [
      { ...graded("link-page-age", text().snapshotAge, age, PAGE_AGE, millis, () => null), trace: [] },
      {
        name: text().snapshotRate,
        testId: "link-page-rate",
        format: (value) => text().perSecond(decimal(value, 0)),
        // The second that is going on is not over.
        value: text().perSecond(String(rates.at(-2) ?? 0)),
        grade: null,
        threshold: null,
        trace: rates.slice(0, -1),
      },
    ];
  };

  return (
    <section class="panel grows links" aria-labelledby="links-title">
      <h2 id="links-title">{text().title}</h2>
      <div class="scrolls" tabindex="0" role="region" aria-labelledby="links-title" data-testid="links">
        <h3>{text().clients}</h3>
        <Show when={clients().length > 0} fallback={<HowToConnect />}>
          <For each={keys().split("\n")}>
            {(key) => (
              <Show when={clients().find((entry) => entry.key === key)?.client}>
                {(client) => (
                  <Link
                    title={key}
                    more={`${client().convention}, ${client().persons.length === 0 ? text().noPersons : text().persons(client().persons.map(nameOf).join(", "))}`}
                    measures={ofClient(key, client())}
                    testId={`link-${key}`}
                  />
                )}
              </Show>
            )}
          </For>
        </Show>
        <Show when={props.live.snapshot()?.control_loop}>
          {(loop) => (
            <>
              <Link title={text().loop} more={`${decimal(loop().rate_hz, 0)} Hz`} measures={ofLoop(loop())} testId="link-loop" />
              <p class="scheduling">
                {text().scheduling} <Said of={clauses(loop().scheduling_why, loop().scheduling)} />
              </p>
            </>
          )}
        </Show>
        <Link title={text().page} more="" measures={ofPage()} testId="link-page" />
      </div>
    </section>
  );
}

function Link(props: { readonly title: string; readonly more: string; readonly measures: readonly Measure[]; readonly testId: string }): JSX.Element {
  const text = (): Text => words().desk.links;
  // Every cell reads them: they are worked out once for all.
  const measures = createMemo(() => props.measures);
  const state = createMemo((): Grade => worst(measures().flatMap(({ grade }) => (grade === null ? [] : [grade]))));
  return (
    <table class="link-table fades" data-testid={props.testId} data-grade={state()}>
      <caption>
        <b>{props.title}</b> <small>{props.more}</small> <GradeWord grade={state()} />
      </caption>
      <thead class="unseen">
        <tr>
          <th scope="col">{text().measure}</th>
          <th scope="col">{text().value}</th>
          <th scope="col">{text().state}</th>
          <th scope="col">{text().minute}</th>
        </tr>
      </thead>
      <tbody>
        <For each={measures().map(({ testId }) => testId)}>
          {(testId, index) => {
            const measure = (): Measure | undefined => measures()[index()];
            return (
              <tr data-testid={testId}>
                <th scope="row">{measure()?.name}</th>
                <td>{measure()?.value}</td>
                <td title={measure()?.threshold ?? undefined}>
                  <Show when={measure()?.grade}>{(grade) => <GradeWord grade={grade()} />}</Show>
                </td>
                <td class="spark-cell">
                  <Show when={(measure()?.trace.length ?? 0) > 0}>
                    <Sparkline values={measure()?.trace ?? []} label={sparkWords(measure())} />
                  </Show>
                </td>
              </tr>
            );
          }}
        </For>
      </tbody>
    </table>
  );
}

function GradeWord(props: { readonly grade: Grade }): JSX.Element {
  return (
    <span class="grade" data-grade={props.grade}>
      <span aria-hidden="true">{SHAPES[props.grade]}</span> {words().desk.links.grades[props.grade]}
    </span>
  );
}

function HowToConnect(): JSX.Element {
  const text = (): Text => words().desk.links;
  return (
    <p class="empty" data-testid="links-empty">
      {text().none} {text().howTo} <code>{`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws/v1/client`}</code> {text().howToMore}{" "}
      <code>web/examples</code>.
    </p>
  );
}

function sparkWords(measure: Measure | undefined): string {
  if (measure === undefined) return "";
  const known = measure.trace.filter((value) => value !== null);
  const text = words().desk.links;
  return known.length === 0 ? text.sparkUnknown(measure.name) : text.spark(measure.name, measure.format(Math.min(...known)), measure.format(Math.max(...known)));
}

function percents(value: number): string {
  return `${decimal(value, 1)} %`;
}

const SHAPES: Readonly<Record<Grade, string>> = { good: "●", weak: "▲", bad: "■", unknown: "○" };
/** States come some 30 times a second; from half a second on the page calls them stale. */
const PAGE_AGE: Threshold = { weak: STALE_AFTER_MILLIS / 2, bad: STALE_AFTER_MILLIS };
