/**
 * A scene's text on its way into the store: read from a file or from a stored version, checked by the server at every
 * change, stored when the author says so. It outlives the view: what was typed is not lost by looking elsewhere.
 */
import { createEffect, createSignal, onCleanup, type Accessor } from "solid-js";
import { checkScene, Problem, replaceScene, uploadScene } from "../api/http";
import type { SceneError, SceneWarning } from "../api/types";
import { moveErrors } from "../lib/sceneText";
import { troubleOf } from "../lib/trouble";

/** What the server says of a text. */
export type Check =
  | { readonly kind: "checking"; readonly errors: readonly SceneError[] }
  | { readonly kind: "passed"; readonly name: string; readonly objects: number; readonly warnings: readonly SceneWarning[]; readonly errors: readonly [] }
  | { readonly kind: "refused"; readonly detail: string; readonly errors: readonly SceneError[] }
  | { readonly kind: "failed"; readonly detail: string; readonly errors: readonly SceneError[] };

/** A text that is not stored. */
export interface Draft {
  /** What people call where it came from. */
  readonly file: string;
  readonly text: string;
  /** Somebody typed in it. */
  readonly edited: boolean;
  /** The scene that it is a version of, as far as is known. */
  readonly of: number | null;
  readonly check: Check;
  readonly storing: boolean;
  /** Why it was not stored. */
  readonly trouble: string | null;
}

/** The draft, and what can be done with it. */
export interface Upload {
  readonly draft: Accessor<Draft | null>;
  /** An edited draft that a new file has replaced. */
  readonly former: Accessor<Draft | null>;
  /** The last that was stored. */
  readonly stored: Accessor<{ readonly file: string; readonly id: number; readonly version: number } | null>;
  /** A file that could not be read. */
  readonly unreadable: Accessor<{ readonly file: string; readonly detail: string } | null>;
  /** Reads a file and checks it. */
  readonly send: (file: File) => Promise<void>;
  /** Takes a text to be edited. */
  readonly open: (file: string, text: string, of: number | null) => void;
  readonly edit: (text: string) => void;
  readonly check: () => Promise<void>;
  /** Stores it: as a version of a scene, else as a new one. */
  readonly store: (as: number | null) => Promise<void>;
  readonly discard: () => void;
  readonly bringBack: () => void;
}

/** Nothing uploaded yet. */
export function createUpload(author: Accessor<string>): Upload {
  const [draft, setDraft] = createSignal<Draft | null>(null);
  const [former, setFormer] = createSignal<Draft | null>(null);
  const [stored, setStored] = createSignal<ReturnType<Upload["stored"]>>(null);
  const [unreadable, setUnreadable] = createSignal<ReturnType<Upload["unreadable"]>>(null);
  let timer: ReturnType<typeof setTimeout> | undefined;
  let latest = 0;

  const check = async (): Promise<void> => {
    clearTimeout(timer);
    const asked = draft();
    if (asked === null) return;
    latest += 1;
    const mine = latest;
    setDraft({ ...asked, check: { kind: "checking", errors: asked.check.errors } });
    const result = await checked(asked.text, author());
    setDraft((now) => (now === null || mine !== latest || now.text !== asked.text ? now : { ...now, check: result }));
  };
  const open = (file: string, text: string, of: number | null): void => {
    const before = draft();
    if (before?.edited === true) setFormer(before);
    setStored(null);
    setUnreadable(null);
    setDraft({ file, text, edited: false, of, check: { kind: "checking", errors: [] }, storing: false, trouble: null });
    void check();
  };

  // A tab that is closed takes its text with it: the browser asks first.
  const warn = (event: BeforeUnloadEvent): void => {
    if (draft()?.edited === true) event.preventDefault();
  };
  createEffect(() => {
    window.addEventListener("beforeunload", warn);
    onCleanup(() => {
      window.removeEventListener("beforeunload", warn);
      clearTimeout(timer);
    });
  });

  return {
    draft,
    former,
    stored,
    unreadable,
    open,
    check,
    send: async (file) => {
      try {
        open(file.name, await file.text(), null);
      } catch (error) {
        setUnreadable({ file: file.name, detail: troubleOf(error) });
      }
    },
    edit: (text) => {
      setDraft((before) => {
        if (before === null || before.text === text) return before;
        return { ...before, text, edited: true, trouble: null, check: { kind: "checking", errors: moveErrors(before.check.errors, before.text, text) } };
      });
      clearTimeout(timer);
      timer = setTimeout(() => void check(), CHECK_AFTER_MILLIS);
    },
    store: async (as) => {
      const sent = draft();
      if (sent === null || sent.storing) return;
      setDraft({ ...sent, storing: true, trouble: null });
      try {
        const { id, version } = await (as === null ? uploadScene(sent.text, author()) : replaceScene(as, sent.text, author()));
        setStored({ file: sent.file, id, version });
        // What was typed since is a draft still.
        setDraft((now) => (now === null || now.text === sent.text ? null : { ...now, storing: false, of: id }));
      } catch (error) {
        setDraft((now) => (now === null ? null : { ...now, storing: false, trouble: troubleOf(error), ...(error instanceof Problem && error.errors.length > 0 && now.text === sent.text ? { check: { kind: "refused", detail: error.message, errors: error.errors } } : {}) }));
      }
    },
    discard: () => {
      clearTimeout(timer);
      setDraft(null);
    },
    bringBack: () => {
      const [back, now] = [former(), draft()];
      if (back === null) return;
      setFormer(now?.edited === true ? now : null);
      setDraft(back);
      void check();
    },
  };
}

async function checked(text: string, author: string): Promise<Check> {
  try {
    const { name, objects, warnings } = await checkScene(text, author);
    return { kind: "passed", name, objects, warnings, errors: [] };
  } catch (error) {
    if (error instanceof Problem && (error.status === 400 || error.status === 422)) {
      return { kind: "refused", detail: error.message, errors: error.errors };
    }
    return { kind: "failed", detail: troubleOf(error), errors: [] };
  }
}

/** A pause in typing, ms. */
const CHECK_AFTER_MILLIS = 500;
