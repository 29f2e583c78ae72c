/** The page: stop, mode and banners on every view; which view by the address's hash. */
import { createEffect, createSignal, ErrorBoundary, lazy, Match, onCleanup, onMount, Show, Suspense, Switch, type JSX } from "solid-js";
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
import { Strip } from "../ui/Strip";
import { Tour } from "../ui/Tour";
import { HelpView } from "./HelpView";
import { LiveView } from "./LiveView";
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
  onMount(() => {
    // The desk comes first. The other views follow, so that they are there when the server is not.
    const timer = setTimeout(() => {
      for (const view of LATER) void view.preload().catch(() => undefined);
    }, LATER_MILLIS);
    onCleanup(() => {
      clearTimeout(timer);
    });
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
        <Banners live={live} />
        <p class="unseen" role="status" data-testid="said">
          {said()}
        </p>
      </div>
      <main inert={listed()}>
        <ErrorBoundary fallback={<Unloaded />}>
          <Suspense fallback={<p class="empty" role="status">{words().shell.loading}</p>}>
            <Switch>
              <Match when={route().view === "live"}>
                <LiveView live={live} author={author()} preferences={store} />
              </Match>
              <Match when={route().view === "scenes"}>
                <ScenesView live={live} upload={upload} author={author()} />
              </Match>
              <Match when={route().view === "sessions"}>
                <SessionsView live={live} />
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
        </ErrorBoundary>
      </main>
      <Strip live={live} />
      <Show when={listed()}>
        <ShortcutsDialog
          enabled={usesShortcuts()}
          enable={(shortcuts) => { store.change({ shortcuts }); }}
          close={() => setListed(false)}
        />
      </Show>
      <Show when={touring() && route().view === "live" && !listed()}>
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

/** A view whose script did not come, in its place; the stop stays where it is. */
function Unloaded(): JSX.Element {
  return (
    <div class="sheet">
      <p class="answer refused" role="alert" data-testid="view-unloaded">
        {words().shell.unloaded}{" "}
        <button type="button" onClick={() => { location.reload(); }}>{words().shell.reload}</button>
      </p>
    </div>
  );
}

const ScenesView = lazy(async () => ({ default: (await import("./ScenesView")).ScenesView }));
const SessionsView = lazy(async () => ({ default: (await import("./SessionsView")).SessionsView }));
const SettingsView = lazy(async () => ({ default: (await import("./SettingsView")).SettingsView }));
const LATER = [ScenesView, SessionsView, SettingsView] as const;
/** The desk is long live by then, ms. */
const LATER_MILLIS = 3000;
