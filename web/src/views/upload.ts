/** The upload of a scene file: reads it, sends it as it was written, keeps what the server said. */
import { createSignal, type Accessor } from "solid-js";
import { Problem, uploadScene } from "../api/http";
import type { SceneError } from "../api/types";

/** How the last upload stands. */
export type UploadState =
  | { readonly kind: "none" }
  | { readonly kind: "sending"; readonly file: string }
  | { readonly kind: "accepted"; readonly file: string; readonly id: number; readonly version: number }
  | {
      readonly kind: "refused";
      readonly file: string;
      readonly detail: string;
      readonly errors: readonly SceneError[];
    };

/** The last upload, and the way to make one. */
export interface Upload {
  readonly state: Accessor<UploadState>;
  readonly send: (file: File) => Promise<void>;
}

/** Nothing uploaded yet. */
export function createUpload(author: Accessor<string>): Upload {
  const [state, setState] = createSignal<UploadState>({ kind: "none" });
  let latest = 0;
  return {
    state,
    send: async (file) => {
      latest += 1;
      const mine = latest;
      const settle = (next: UploadState): void => {
        if (mine === latest) setState(next);
      };
      settle({ kind: "sending", file: file.name });
      try {
        const { id, version } = await uploadScene(await file.text(), author());
        settle({ kind: "accepted", file: file.name, id, version });
      } catch (error) {
        settle({
          kind: "refused",
          file: file.name,
          detail: error instanceof Error ? error.message : String(error),
          errors: error instanceof Problem ? error.errors : [],
        });
      }
    },
  };
}
