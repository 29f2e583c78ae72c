/** The draft on its way: changes with undo, kept at each of them, checked by the server after a pause, with what is chosen. */
import { createMemo, createRoot, createSignal, type Accessor } from "solid-js";
import { checkScene, Problem } from "../api/http";
import type { SceneDocument, SceneError, SceneWarning } from "../api/types";
import { writeJson } from "../lib/sceneText";
import { troubleOf } from "../lib/trouble";
import { begin, changed, redone, undone } from "./history";
import { inOrder } from "./order";
import { emptyScene } from "./scene";
import { isAt, SCENE, selectionAt, within, type Selection } from "./selection";
import { keepDraft, readDraft, type KeptDraft } from "./storage";

/** What the server says of the draft. */
export type EditorCheck =
  | { readonly kind: "checking" | "passed" | "refused"; readonly errors: readonly SceneError[]; readonly warnings: readonly SceneWarning[] }
  | { readonly kind: "failed"; readonly detail: string; readonly errors: readonly SceneError[]; readonly warnings: readonly SceneWarning[] };

/** One finding, of either grade. */
export type Finding = { readonly grade: "error"; readonly path: string; readonly error: SceneError } | { readonly grade: "warning"; readonly path: string; readonly warning: SceneWarning };

/** The version that a draft began as. */
export type Origin = KeptDraft["of"];

/** The draft, and what can be done with it. */
export interface Editor {
  readonly scene: Accessor<SceneDocument>;
  readonly of: Accessor<Origin>;
  readonly selection: Accessor<Selection>;
  readonly check: Accessor<EditorCheck>;
  /** Every finding, errors first. */
  readonly findings: Accessor<readonly Finding[]>;
  /** Findings at a path or below it. */
  readonly at: (path: string) => readonly Finding[];
  /** Whether this browser keeps the draft. */
  readonly isKept: Accessor<boolean>;
  readonly canUndo: Accessor<boolean>;
  readonly canRedo: Accessor<boolean>;
  readonly select: (selection: Selection) => void;
  /** A change; those of one kind that follow closely are one step of undo. */
  readonly change: (make: (scene: SceneDocument) => SceneDocument, kind?: string) => void;
  /** Another document altogether; it can be undone. */
  readonly load: (scene: SceneDocument, of: Origin) => void;
  readonly undo: () => void;
  readonly redo: () => void;
  /** It was stored: what is edited from here is a later version of it. */
  readonly stored: (of: NonNullable<Origin>) => void;
  /** The text that is checked and stored. */
  readonly text: () => string;
}

interface Step {
  readonly scene: SceneDocument;
  readonly of: Origin;
}

let open: { readonly author: string; readonly editor: Editor } | null = null;

/** The editor of a name: the same over a change of view, so that undo goes on. */
export function editorOf(author: string, travel: readonly [number, number, number, number] | null, newName: string): Editor {
  if (open?.author !== author) open = { author, editor: createRoot(() => createEditor(author, readDraft(author) ?? { scene: emptyScene(newName, travel), of: null, savedAt: "" })) };
  return open.editor;
}

/** An editor over a draft. */
export function createEditor(author: string, draft: KeptDraft): Editor {
  const [history, setHistory] = createSignal(begin<Step>({ scene: draft.scene, of: draft.of }));
  const [chosen, setChosen] = createSignal<Selection>(SCENE);
  const [check, setCheck] = createSignal<EditorCheck>({ kind: "checking", errors: [], warnings: [] });
  const [isKept, setKept] = createSignal(true);
  const scene = createMemo(() => inOrder(history().now.scene));
  const text = (): string => `${writeJson(scene())}\n`;
  let timer: ReturnType<typeof setTimeout> | undefined;

  const look = async (): Promise<void> => {
    const asked = text();
    const result = await checked(asked, author);
    // What was changed meanwhile is looked at after its own pause.
    if (asked === text()) setCheck(result);
  };
  const follow = (afterMillis: number): void => {
    const { scene: now, of } = history().now;
    setKept(keepDraft(author, { scene: now, of, savedAt: new Date().toISOString() }));
    // Findings stay where they are until the next ones come.
    setCheck((before) => ({ kind: "checking", errors: before.errors, warnings: before.warnings }));
    clearTimeout(timer);
    timer = setTimeout(() => void look(), afterMillis);
  };
  const step = (next: (from: ReturnType<typeof history>) => ReturnType<typeof history>): void => {
    const before = history();
    setHistory(next);
    if (history() !== before) follow(CHECK_AFTER_MILLIS);
  };
  const findings = createMemo((): readonly Finding[] => [
    ...check().errors.map((error): Finding => ({ grade: "error", path: error.path, error })),
    ...check().warnings.map((warning): Finding => ({ grade: "warning", path: warning.path, warning })),
  ]);
  timer = setTimeout(() => void look(), 0);

  return {
    scene,
    of: () => history().now.of,
    selection: createMemo(() => within(scene(), chosen())),
    check,
    findings,
    at: (path) => findings().filter((finding) => isAt(finding.path, path)),
    isKept,
    canUndo: () => history().past.length > 0,
    canRedo: () => history().future.length > 0,
    select: setChosen,
    change: (make, kind) => {
      step((from) => {
        const next = make(from.now.scene);
        return next === from.now.scene ? from : changed(from, { ...from.now, scene: next }, kind ?? null, Date.now());
      });
    },
    load: (next, of) => {
      setChosen(SCENE);
      step((from) => changed(from, { scene: next, of }, null, Date.now()));
    },
    undo: () => { step(undone); },
    redo: () => { step(redone); },
    stored: (of) => {
      setHistory((from) => ({ ...from, now: { ...from.now, of } }));
      setKept(keepDraft(author, { scene: scene(), of, savedAt: new Date().toISOString() }));
    },
    text,
  };
}

/** Where a finding's thing is chosen. */
export function selectionOf(finding: Finding): Selection {
  return selectionAt(finding.path);
}

async function checked(text: string, author: string): Promise<EditorCheck> {
  try {
    const { warnings } = await checkScene(text, author);
    return { kind: "passed", errors: [], warnings };
  } catch (error) {
    if (error instanceof Problem && (error.status === 400 || error.status === 422)) return { kind: "refused", errors: error.errors, warnings: [] };
    return { kind: "failed", detail: troubleOf(error), errors: [], warnings: [] };
  }
}

/** A pause in editing, ms. */
const CHECK_AFTER_MILLIS = 300;
