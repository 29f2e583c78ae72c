/** The help: first steps, stops, rules and words. `#/help/R3` leads to a rule, `#/help/stop/R4` to a stop. Its text is loaded when it is first opened. */
import { createEffect, createResource, For, on, Show, type JSX } from "solid-js";
import { RULES, STOPS, UNWATCHED, type HelpText, type RuleName } from "../help/shape";
import { language, words, type Language } from "../i18n";
import { said } from "../lib/reasonWords";
import type { Live } from "../live/live";
import { Said } from "../ui/Said";

/** The view. */
export function HelpView(props: {
  readonly live: Live;
  readonly at: readonly string[];
  readonly showTour: () => void;
  readonly showShortcuts: () => void;
}): JSX.Element {
  const [text] = createResource(language, read);
  const place = (): string => (props.at[0] === "stop" ? `stop-${props.at[1] ?? ""}` : (props.at[0] ?? ""));
  const isKnown = (): boolean => place() === "" || PLACES.has(place());
  createEffect(
    on([place, () => text.latest !== undefined], ([id, read]) => {
      if (!read || id === "") return;
      const target = document.getElementById(`help-${id}`);
      target?.scrollIntoView({ block: "start" });
      target?.focus({ preventScroll: true });
    }),
  );
  return (
    <div class="sheet help" data-testid="help">
      <Show when={text.error !== undefined}>
        <p class="answer refused" role="alert">
          {words().settings.help.notRead}
        </p>
      </Show>
      <Show when={text.error === undefined && text.latest} fallback={<h1>{words().shell.pages.help}</h1>}>
        {(help) => (
          <>
            <h1>{help().title}</h1>
            <Show when={!isKnown()}>
              <p class="answer refused" role="alert" data-testid="help-unknown">
                {help().labels.unknown(props.at.join("/"))}
              </p>
            </Show>
            <div class="help-tools">
              <button type="button" data-testid="start-tour" onClick={() => { props.showTour(); }}>
                {help().labels.tour}
              </button>
              <button type="button" onClick={() => { props.showShortcuts(); }}>
                {help().labels.shortcuts}
              </button>
            </div>
            <Contents help={help()} />
            <Section id="first" title={help().first.title}>
              <ol class="steps">
                <For each={help().first.steps}>{(step) => <li>{step}</li>}</For>
              </ol>
            </Section>
            <Section id="software-stop" title={help().softwareStop.title}>
              <For each={help().softwareStop.paragraphs}>{(paragraph) => <p>{paragraph}</p>}</For>
            </Section>
            <Section id="kinds" title={help().kinds.title}>
              <Words rows={help().kinds.rows} />
            </Section>
            <Section id="stops" title={help().stopsTitle}>
              <For each={STOPS}>
                {(stop) => (
                  <article id={`help-stop-${stop}`} class="entry" tabindex="-1" aria-labelledby={`help-stop-${stop}-title`} data-testid={`help-stop-${stop}`}>
                    <h3 id={`help-stop-${stop}-title`}>
                      <Show when={/^R\d/.test(stop)}>{stop} · </Show>
                      {help().stops[stop].title}
                    </h3>
                    <p>{help().stops[stop].happened}</p>
                    <ol class="steps">
                      <For each={help().stops[stop].steps}>{(step) => <li>{step}</li>}</For>
                    </ol>
                  </article>
                )}
              </For>
            </Section>
            <Section id="rules" title={help().rulesTitle}>
              <For each={RULES}>{(rule) => <Rule rule={rule} help={help()} live={props.live} />}</For>
            </Section>
            <Section id="words" title={help().glossary.title}>
              <Words rows={help().glossary.rows} />
            </Section>
          </>
        )}
      </Show>
    </div>
  );
}

function Rule(props: { readonly rule: RuleName; readonly help: HelpText; readonly live: Live }): JSX.Element {
  const say = () => props.help.labels;
  const entry = () => props.help.rules[props.rule];
  const now = () => props.live.snapshot()?.rules.find((rule) => rule.rule === props.rule);
  return (
    <article id={`help-${props.rule}`} class="entry" tabindex="-1" aria-labelledby={`help-${props.rule}-title`} data-testid={`help-${props.rule}`}>
      <h3 id={`help-${props.rule}-title`}>
        {props.rule} · {words().shell.rules.titles[props.rule]}
        <Show when={UNWATCHED.has(props.rule)}>
          <span class="tag">{say().notWatched}</span>
        </Show>
      </h3>
      <Show when={!UNWATCHED.has(props.rule) && now()}>
        {(rule) => (
          <p class="empty fades">
            {say().now} {words().shell.rules.status[rule().status]}, <Said of={said(rule().why, rule().reason)} />
          </p>
        )}
      </Show>
      <dl class="answers">
        <dt>{say().watches}</dt>
        <dd>{entry().watches}</dd>
        <dt>{say().happens}</dt>
        <dd>{entry().happens}</dd>
        <dt>{say().you}</dt>
        <dd>{entry().you}</dd>
        <dt>{say().clears}</dt>
        <dd>
          {entry().clears}
          <Show when={PLACES.has(`stop-${props.rule}`)}>
            {" "}
            <a href={`#/help/stop/${props.rule}`}>{say().itsStop}</a>
          </Show>
        </dd>
      </dl>
    </article>
  );
}

function Contents(props: { readonly help: HelpText }): JSX.Element {
  return (
    <nav class="contents" aria-label={props.help.contents}>
      <a href="#/help/first">{props.help.first.title}</a>
      <a href="#/help/software-stop">{props.help.softwareStop.title}</a>
      <a href="#/help/kinds">{props.help.kinds.title}</a>
      <a href="#/help/stops">{props.help.stopsTitle}</a>
      <a href="#/help/rules">{props.help.rulesTitle}</a>
      <a href="#/help/words">{props.help.glossary.title}</a>
    </nav>
  );
}

function Section(props: { readonly id: string; readonly title: string; readonly children: JSX.Element }): JSX.Element {
  return (
    <section class="panel" id={`help-${props.id}`} tabindex="-1" aria-labelledby={`help-${props.id}-title`}>
      <h2 id={`help-${props.id}-title`}>{props.title}</h2>
      {props.children}
    </section>
  );
}

function Words(props: { readonly rows: HelpText["glossary"]["rows"] }): JSX.Element {
  return (
    <dl class="answers">
      <For each={props.rows}>
        {([word, meaning]) => (
          <>
            <dt>{word}</dt>
            <dd>{meaning}</dd>
          </>
        )}
      </For>
    </dl>
  );
}

async function read(wanted: Language): Promise<HelpText> {
  const { help } = wanted === "fr" ? await import("../help/fr") : await import("../help/en");
  return help;
}

const SECTIONS = ["first", "software-stop", "kinds", "stops", "rules", "words"];
const PLACES: ReadonlySet<string> = new Set([...SECTIONS, ...RULES, ...STOPS.map((stop) => `stop-${stop}`)]);
