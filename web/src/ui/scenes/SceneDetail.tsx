/** One stored scene: its versions, a picture of the one chosen, activation, comparison and download. */
import { createEffect, createMemo, createSignal, For, on, onCleanup, Show, untrack, type JSX } from "solid-js";
import { activateScene, listSceneVersions, readScene } from "../../api/http";
import type { SceneDocument, SceneSummary, SceneVersionSummary } from "../../api/types";
import { words } from "../../i18n";
import { dayAndTime } from "../../lib/format";
import { fileNameOf, writeJson } from "../../lib/sceneText";
import type { Live } from "../../live/live";
import { Arena } from "../Arena";
import { CheckedPanel } from "./CheckedPanel";
import { Comparison } from "./Comparison";
import { troubleOf } from "../../lib/trouble";

/** Everything about the scene of that number. */
export function SceneDetail(props: {
  readonly live: Live;
  readonly id: number;
  /** Its row in the list, as far as that is read. */
  readonly row: SceneSummary | null;
  readonly author: string;
  readonly edit: (file: string, text: string, of: number) => void;
  /** The list is to be read again. */
  readonly changed: () => void;
}): JSX.Element {
  const [versions, setVersions] = createSignal<readonly SceneVersionSummary[] | null>(null);
  const [documents, setDocuments] = createSignal<ReadonlyMap<number, SceneDocument>>(new Map());
  const [trouble, setTrouble] = createSignal<string | null>(null);
  const [shown, setShown] = createSignal<number | null>(null);
  const [against, setAgainst] = createSignal<number | null>(null);
  const [asking, setAsking] = createSignal(false);
  const [activating, setActivating] = createSignal(false);
  const [outcome, setOutcome] = createSignal<{ readonly good: boolean; readonly said: string; readonly detail: string } | null>(null);
  let gone = false;
  onCleanup(() => { gone = true; });

  const load = async (): Promise<void> => {
    try {
      const found = await listSceneVersions(props.id);
      if (gone) return;
      setVersions(found);
      setTrouble(null);
      const newest = found[0]?.version ?? null;
      if (!found.some(({ version }) => version === shown())) setShown(newest);
      if (!found.some(({ version }) => version === against())) setAgainst(found[1]?.version ?? newest);
    } catch (error) {
      if (!gone) setTrouble(troubleOf(error));
    }
  };
  const loadDocument = async (version: number): Promise<void> => {
    if (untrack(documents).has(version)) return;
    try {
      const document = await readScene(props.id, version);
      if (!gone) setDocuments((known) => new Map([...known, [version, document]]));
    } catch (error) {
      if (!gone) setTrouble(troubleOf(error));
    }
  };
  createEffect(on([() => props.row?.version, () => props.live.scene()?.id, () => props.live.scene()?.version], () => void load()));
  createEffect(() => {
    for (const version of [shown(), against()]) if (version !== null) void loadDocument(version);
  });
  const document = createMemo(() => documents().get(shown() ?? -1) ?? null);
  const other = createMemo(() => documents().get(against() ?? -1) ?? null);
  const name = (): string => document()?.name ?? props.row?.name ?? "";
  const isActive = (): boolean => {
    const active = props.live.scene();
    return active !== null && active.id === props.id && active.version === shown();
  };

  const activate = async (): Promise<void> => {
    const version = shown();
    if (version === null) return;
    setActivating(true);
    setOutcome(null);
    try {
      await activateScene(props.id, version, props.author);
      setOutcome({ good: true, said: words().records.activate.done(name(), version), detail: "" });
      props.changed();
      await load();
    } catch (error) {
      setOutcome({ good: false, said: words().records.activate.refused(name()), detail: troubleOf(error) });
    } finally {
      setActivating(false);
      setAsking(false);
    }
  };
  const download = (scene: SceneDocument, version: number): void => {
    const address = URL.createObjectURL(new Blob([`${writeJson(scene)}\n`], { type: "application/json" }));
    const link = Object.assign(window.document.createElement("a"), { href: address, download: fileNameOf(scene.name, version) });
    link.click();
    // The browser reads the address after the click.
    setTimeout(() => { URL.revokeObjectURL(address); }, 10_000);
  };

  return (
    <section class="panel scene-detail" aria-labelledby="scene-title" data-testid="scene-detail">
      <h2 id="scene-title" class="sheet-title">
        {name()} <small>{words().records.scenes.versionWord(shown() ?? 1)}</small>
        <Show when={isActive()}><span class="tag">{words().records.scenes.active}</span></Show>
      </h2>
      <Show when={trouble()}>
        {(why) => (
          <p class="answer refused" role="alert" data-testid="scene-trouble">
            {words().records.scenes.failed(why())}{" "}
            <button type="button" onClick={() => void load()}>{words().records.scenes.again}</button>
          </p>
        )}
      </Show>
      <Show when={versions()} fallback={<Show when={trouble() === null}><p class="empty">{words().records.scenes.loading}</p></Show>}>
        {(list) => (
          <>
            <Show when={document()}>
              {(scene) => (
                <>
                  <Show when={scene().description}><p class="scene-description">{scene().description}</p></Show>
                  <div class="scene-actions">
                    <button type="button" data-testid="scene-activate" disabled={isActive() || activating()} aria-expanded={asking()} onClick={() => { setOutcome(null); setAsking(true); }}>
                      {words().records.activate.button}
                    </button>
                    <a class="button" data-testid="scene-edit-plan" href={`#/scenes/edit/${props.id}/${shown() ?? 1}`}>{words().records.scenes.editPlan}</a>
                    <button type="button" data-testid="scene-edit" onClick={() => { props.edit(fileNameOf(scene().name, shown() ?? 1), `${writeJson(scene())}\n`, props.id); }}>
                      {words().records.scenes.edit}
                    </button>
                    <button type="button" data-testid="scene-download" onClick={() => { download(scene(), shown() ?? 1); }}>
                      {words().records.scenes.download}
                    </button>
                  </div>
                  <Show when={asking()}>
                    <Confirmation name={name()} version={shown() ?? 1} busy={activating()} activate={() => void activate()} leave={() => setAsking(false)} />
                  </Show>
                  <Show when={outcome()}>
                    {(result) => (
                      <p class="answer" classList={{ refused: !result().good }} role={result().good ? "status" : "alert"} data-testid="activation">
                        {result().said} {result().detail}
                      </p>
                    )}
                  </Show>
                  <div class="scene-preview" data-live={isActive() ? "" : undefined}>
                    <Arena
                      testId="scene-preview"
                      label={() => words().records.scenes.previewOf(scene().name, shown() ?? 1)}
                      picture={() => ({ state: isActive() ? props.live.newest() : null, scene: scene(), shape: props.live.server()?.shape ?? null })}
                    />
                  </div>
                  <small>{isActive() ? words().records.scenes.previewLive : words().records.scenes.previewStill}</small>
                  <CheckedPanel scene={scene()} author={props.author} may={props.live.identity.may("POST /api/v1/scenes/check")} />
                </>
              )}
            </Show>
            <h3>{words().records.scenes.versions}</h3>
            <div class="wide scrolls">
            <table data-testid="versions">
              <thead>
                <tr>
                  <th scope="col">{words().records.scenes.version}</th>
                  <th scope="col">{words().records.scenes.by}</th>
                  <th scope="col">{words().records.scenes.changed}</th>
                  <th scope="col">{words().records.scenes.objects}</th>
                  <th scope="col">{words().records.scenes.state}</th>
                  <th scope="col"><span class="unseen">{words().records.scenes.show}</span></th>
                </tr>
              </thead>
              <tbody>
                <For each={list()}>
                  {(row) => (
                    <tr data-testid={`version-${row.version}`}>
                      <th scope="row">{row.version}</th>
                      <td>{row.author || words().records.scenes.unnamed}</td>
                      <td>{dayAndTime(row.created_at)}</td>
                      <td>{row.objects}</td>
                      <td>{row.active ? words().records.scenes.active : words().records.scenes.notActive}</td>
                      <td class="activation">
                        <button
                          type="button"
                          class="quiet"
                          data-testid={`version-show-${row.version}`}
                          aria-pressed={shown() === row.version}
                          aria-label={`${shown() === row.version ? words().records.scenes.shown : words().records.scenes.show}: ${words().records.scenes.versionWord(row.version)}`}
                          onClick={() => { setAsking(false); setOutcome(null); setShown(row.version); }}
                        >
                          {shown() === row.version ? words().records.scenes.shown : words().records.scenes.show}
                        </button>
                      </td>
                    </tr>
                  )}
                </For>
              </tbody>
            </table>
            </div>
            <Show when={list().length > 1}>
              <div class="diff-choice">
                <h3>{words().records.diff.title}</h3>
                <VersionChoice label={words().records.diff.from} testId="diff-from" versions={list()} chosen={against()} choose={setAgainst} />
                <VersionChoice label={words().records.diff.to} testId="diff-to" versions={list()} chosen={shown()} choose={setShown} />
              </div>
              <Show when={document()}>
                {(after) => <Show when={other()}>{(before) => <Comparison before={before()} after={after()} />}</Show>}
              </Show>
            </Show>
          </>
        )}
      </Show>
    </section>
  );
}

function VersionChoice(props: {
  readonly label: string;
  readonly testId: string;
  readonly versions: readonly SceneVersionSummary[];
  readonly chosen: number | null;
  readonly choose: (version: number) => void;
}): JSX.Element {
  return (
    <label>
      {props.label}{" "}
      <select data-testid={props.testId} onChange={(event) => { props.choose(Number(event.currentTarget.value)); }}>
        <For each={props.versions}>
          {({ version }) => (
            <option value={version} selected={props.chosen === version}>
              {words().records.scenes.versionWord(version)}
            </option>
          )}
        </For>
      </select>
    </label>
  );
}

function Confirmation(props: {
  readonly name: string;
  readonly version: number;
  readonly busy: boolean;
  readonly activate: () => void;
  readonly leave: () => void;
}): JSX.Element {
  let confirm!: HTMLButtonElement;
  queueMicrotask(() => { confirm.focus(); });
  return (
    <div class="confirmation" role="alertdialog" aria-labelledby="activate-title" aria-describedby="activate-what" data-testid="activate-dialog">
      <h3 id="activate-title">{words().records.activate.title(props.name, props.version)}</h3>
      <ul id="activate-what">
        <li>{words().records.activate.atOnce}</li>
        <li>{words().records.activate.priors}</li>
        <li>{words().records.activate.sessions}</li>
        <li>{words().records.activate.refusal}</li>
      </ul>
      <button type="button" ref={confirm} data-testid="activate-confirm" disabled={props.busy} onClick={() => { props.activate(); }}>
        {props.busy ? words().records.activate.activating : words().records.activate.confirm}
      </button>
      <button type="button" class="quiet" data-testid="activate-leave" onClick={() => { props.leave(); }}>
        {words().records.activate.leave}
      </button>
    </div>
  );
}
