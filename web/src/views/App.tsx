/** The page: stop, mode and banners on every view; which view by the address's hash. */
import { createEffect, createSignal, Match, Show, Suspense, Switch, type JSX } from "solid-js";
import { words } from "../i18n";
import { createAppearance } from "../lib/appearance";
import { readAuthor, writeAuthor } from "../lib/author";
import { createFileDrop } from "../lib/drop";
import { createPreferences } from "../lib/preferences";
import { listenForShortcuts } from "../lib/shortcuts";
import { createLive } from "../live/live";
import { Banners } from "../ui/Banners";
import { Header } from "../ui/Header";
import { KEYS_OF_THE_LIST, useShellShortcuts } from "../ui/keys";
import { ShortcutsDialog } from "../ui/ShortcutsDialog";
import { StopReport } from "../ui/StopReport";
import { SignIn } from "../ui/SignIn";
import { Strip } from "../ui/Strip";
import { Tour } from "../ui/Tour";
import { LiveView } from "./LiveView";
import { EditorView, fetchLater, HelpView, MachineView, ScenarioView, ScenesView, SessionsView, SettingsView } from "./later";
import { createRoute } from "./route";
import { createUpload } from "./upload";

/** The whole dashboard. */
export function App(): JSX.Element {
  const live = createLive();
  const route = createRoute();
  const [author, setAuthor] = createSignal(readAuthor());
  const store = createPreferences(author());
  const appearance = createAppearance(store);
  const upload = createUpload(author);
  const [listed, setListed] = createSignal(false);
  // At the first visit of a user, and when the help is asked for it.
  const [touring, setTouring] = createSignal(store.preferences().tourDone !== true);
  const [said, say] = createSignal("");
  const dragging = createFileDrop((file) => {
    location.hash = "#/scenes";
    void upload.send(file);
  });

  const keepAuthor = (name: string): void => {
    setAuthor(writeAuthor(name));
    store.switchTo(author());
  };
  useShellShortcuts({
    live,
    appearance,
    toggleHelp: () => setListed((open) => !open),
    closeHelp: () => setListed(false),
    say,
  });
  const showTour = (): void => {
    location.hash = "#/live";
    setTouring(true);
  };
  const usesShortcuts = (): boolean => store.preferences().shortcuts !== false;
  listenForShortcuts(usesShortcuts, () => (listed() ? KEYS_OF_THE_LIST : null));
  // The other views come when the live one is there: then they are here when the server is not.
  createEffect(() => {
    if (live.freshness().kind === "live") fetchLater();
  });
  createEffect(() => {
    document.title = `${words().shell.pages[route().view]} · CoVR`;
  });

  return (
    <div class="page" classList={{ stale: live.freshness().kind !== "live" }}>
      <Header
        live={live}
        view={route().view}
        author={author()}
        setAuthor={keepAuthor}
        appearance={appearance}
        help={() => setListed(true)}
        behind={listed()}
      />
      <div class="bars">
        <StopReport stop={live.stop()} nowMillis={live.nowMillis()} />
        <SignIn identity={live.identity} />
        <Banners live={live} />
        <p class="unseen" role="status" data-testid="said">
          {said()}
        </p>
      </div>
      <main inert={listed()}>
        <Suspense fallback={<p class="empty">{words().shell.viewComes}</p>}>
          <Switch>
            <Match when={route().view === "live"}>
              <LiveView live={live} author={author()} preferences={store} />
            </Match>
            <Match when={route().view === "scenario"}>
              <ScenarioView live={live} author={author()} />
            </Match>
            <Match when={route().view === "scenes" && route().rest[0] === "edit"}>
              <EditorView live={live} upload={upload} author={author()} at={route().rest.slice(1)} />
            </Match>
            <Match when={route().view === "scenes"}>
              <ScenesView live={live} upload={upload} author={author()} />
            </Match>
            <Match when={route().view === "sessions"}>
              <SessionsView live={live} />
            </Match>
            <Match when={route().view === "machine"}>
              <MachineView live={live} author={author()} />
            </Match>
            <Match when={route().view === "settings"}>
              <SettingsView
                live={live}
                author={author()}
                setAuthor={keepAuthor}
                preferences={store}
                showShortcuts={() => setListed(true)}
              />
            </Match>
            <Match when={route().view === "help"}>
              <HelpView live={live} at={route().rest} showTour={showTour} showShortcuts={() => setListed(true)} />
            </Match>
          </Switch>
        </Suspense>
      </main>
      <Strip live={live} />
      <Show when={listed()}>
        <ShortcutsDialog
          enabled={usesShortcuts()}
          enable={(shortcuts) => { store.change({ shortcuts }); }}
          close={() => setListed(false)}
        />
      </Show>
      <Show when={touring() && route().view === "live" && !listed() && !live.identity.mustSignIn()}>
        <Tour
          close={() => {
            setTouring(false);
            store.change({ tourDone: true });
          }}
        />
      </Show>
      <Show when={dragging()}>
        <div class="drop-hint">{words().shell.dropHint}</div>
      </Show>
    </div>
  );
}
