/**
 * Where a draft is kept: in this browser, by the name of who edits. A draft is mostly no scene yet, and the server's store holds
 * scenes that pass and nothing else; what is worth sharing is stored there as a version.
 */
import type { SceneDocument } from "../api/types";
import { readScene } from "./readScene";

/** A draft, and the version that it began as. */
export interface KeptDraft {
  readonly scene: SceneDocument;
  readonly of: { readonly id: number; readonly version: number } | null;
  /** As it began, for what has changed since. */
  readonly savedAt: string;
}

/** The draft of a name; null where there is none that can be read. */
export function readDraft(author: string): KeptDraft | null {
  try {
    const found: unknown = JSON.parse(localStorage.getItem(keyOf(author)) ?? "null");
    if (typeof found !== "object" || found === null || !("scene" in found)) return null;
    const read = readScene(JSON.stringify(found.scene));
    if (read.kind !== "scene") return null;
    const of: unknown = "of" in found ? found.of : null;
    const isOf = typeof of === "object" && of !== null && "id" in of && typeof of.id === "number" && "version" in of && typeof of.version === "number";
    const savedAt = "savedAt" in found && typeof found.savedAt === "string" ? found.savedAt : "";
    return { scene: read.scene, of: isOf ? { id: (of as { id: number }).id, version: (of as { version: number }).version } : null, savedAt };
  } catch {
    return null;
  }
}

/** Keeps it; false where the browser does not. */
export function keepDraft(author: string, draft: KeptDraft): boolean {
  try {
    localStorage.setItem(keyOf(author), JSON.stringify(draft));
    return true;
  } catch {
    return false;
  }
}

/** Nothing is kept any more. */
export function forgetDraft(author: string): void {
  try {
    localStorage.removeItem(keyOf(author));
  } catch {
    // A browser that keeps nothing.
  }
}

function keyOf(author: string): string {
  return `covr.scene-draft.${author}`;
}
