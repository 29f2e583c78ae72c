/** The views other than the live one: fetched after it, so that it comes first, and before anybody asks for them. */
import { lazy, type Component } from "solid-js";

/** Until it is here: a server that restarts is back in a moment. */
async function fetched<T>(fetch: () => Promise<T>): Promise<T> {
  for (;;) {
    try {
      return await fetch();
    } catch {
      await new Promise((resolve) => setTimeout(resolve, AGAIN_MILLIS));
    }
  }
}

function view<P extends object>(fetch: () => Promise<Component<P>>): Component<P> & { preload: () => Promise<unknown> } {
  return lazy(async () => ({ default: await fetched(fetch) }));
}

export const ScenarioView = view(async () => (await import("./ScenarioView")).ScenarioView);
export const ScenesView = view(async () => (await import("./ScenesView")).ScenesView);
export const EditorView = view(async () => (await import("./EditorView")).EditorView);
export const SessionsView = view(async () => (await import("./SessionsView")).SessionsView);
export const MachineView = view(async () => (await import("./MachineView")).MachineView);
export const SettingsView = view(async () => (await import("./SettingsView")).SettingsView);
export const HelpView = view(async () => (await import("./HelpView")).HelpView);

/** Fetches all of them, once. */
export function fetchLater(): void {
  for (const one of [ScenarioView, ScenesView, EditorView, SessionsView, MachineView, SettingsView, HelpView]) void one.preload();
}

const AGAIN_MILLIS = 1000;
