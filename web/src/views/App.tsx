/** The page: stop, mode and banners on every view; which view by the address's hash. */
import { createSignal, Match, onCleanup, onMount, Show, Switch, For, type JSX } from "solid-js";
import { createLive } from "../live/live";
import { readAuthor, writeAuthor } from "../lib/author";
import { Banners } from "../ui/Banners";
import { ModeBlock } from "../ui/ModeBlock";
import { StopButton } from "../ui/StopButton";
import { StopReport } from "../ui/StopReport";
import { Strip } from "../ui/Strip";
import { LiveView } from "./LiveView";
import { ScenesView } from "./ScenesView";
import { SessionsView } from "./SessionsView";
import { createUpload } from "./upload";

type ViewName = "live" | "scenes" | "sessions";

/** The whole dashboard. */
export function App(): JSX.Element {
  const live = createLive();
  const [view, setView] = createSignal<ViewName>(viewOf(location.hash));
  const [author, setAuthor] = createSignal(readAuthor());
  const [dragging, setDragging] = createSignal(false);
  const upload = createUpload(author);

  const keepAuthor = (name: string): void => {
    setAuthor(writeAuthor(name));
  };

  onMount(() => {
    const hashChanged = (): void => {
      setView(viewOf(location.hash));
    };
    const over = (event: DragEvent): void => {
      if (event.dataTransfer?.types.includes("Files") !== true) return;
      event.preventDefault();
      setDragging(true);
    };
    const out = (event: DragEvent): void => {
      if (event.relatedTarget === null) setDragging(false);
    };
    const drop = (event: DragEvent): void => {
      setDragging(false);
      const file = event.dataTransfer?.files[0];
      if (file === undefined) return;
      event.preventDefault();
      location.hash = "#/scenes";
      void upload.send(file);
    };
    window.addEventListener("hashchange", hashChanged);
    window.addEventListener("dragover", over);
    window.addEventListener("dragleave", out);
    window.addEventListener("drop", drop);
    onCleanup(() => {
      window.removeEventListener("hashchange", hashChanged);
      window.removeEventListener("dragover", over);
      window.removeEventListener("dragleave", out);
      window.removeEventListener("drop", drop);
    });
  });

  return (
    <div class="page" classList={{ stale: live.freshness().kind !== "live" }}>
      <header class="top">
        <ModeBlock live={live} />
        <nav aria-label="Views">
          <For each={VIEWS}>
            {(entry) => (
              <a href={`#/${entry.view}`} data-testid={`view-${entry.view}`} aria-current={view() === entry.view ? "page" : undefined}>
                {entry.word}
              </a>
            )}
          </For>
        </nav>
        <StopButton press={live.pressStop} />
      </header>
      <div class="bars">
        <StopReport stop={live.stop()} nowMillis={live.nowMillis()} />
        <Banners live={live} />
      </div>
      <main>
        <Switch>
          <Match when={view() === "live"}>
            <LiveView live={live} author={author()} setAuthor={keepAuthor} />
          </Match>
          <Match when={view() === "scenes"}>
            <ScenesView live={live} upload={upload} author={author()} />
          </Match>
          <Match when={view() === "sessions"}>
            <SessionsView live={live} />
          </Match>
        </Switch>
      </main>
      <Strip live={live} />
      <Show when={dragging()}>
        <div class="drop-hint">Drop the scene's JSON file to upload it</div>
      </Show>
    </div>
  );
}

function viewOf(hash: string): ViewName {
  return VIEWS.find((entry) => hash === `#/${entry.view}`)?.view ?? "live";
}

const VIEWS: readonly { readonly view: ViewName; readonly word: string }[] = [
  { view: "live", word: "Live" },
  { view: "scenes", word: "Scenes" },
  { view: "sessions", word: "Sessions" },
];
