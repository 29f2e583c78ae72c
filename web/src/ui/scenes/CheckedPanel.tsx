/** What the server's check says of a stored version, on today's machine: what is worth a second look, and its pairs. */
import { createEffect, createSignal, For, on, onCleanup, Show, type JSX } from "solid-js";
import { checkScene, type SceneChecked } from "../../api/http";
import type { SceneDocument } from "../../api/types";
import { words } from "../../i18n";
import { phraseWords } from "../../lib/phraseWords";
import { writeJson } from "../../lib/sceneText";
import { troubleOf } from "../../lib/trouble";
import { PairsTable } from "./PairsTable";

/** The panel. */
export function CheckedPanel(props: { readonly scene: SceneDocument; readonly author: string; readonly may: boolean }): JSX.Element {
  const [checked, setChecked] = createSignal<SceneChecked | null>(null);
  const [trouble, setTrouble] = createSignal<string | null>(null);
  let newest = 0;
  onCleanup(() => { newest = -1; });
  createEffect(
    on(
      () => props.scene,
      (scene) => {
        if (!props.may) return;
        newest += 1;
        const mine = newest;
        setChecked(null);
        setTrouble(null);
        checkScene(writeJson(scene), props.author)
          .then((found) => { if (mine === newest) setChecked(found); })
          .catch((error: unknown) => { if (mine === newest) setTrouble(troubleOf(error)); });
      },
    ),
  );
  return (
    <>
      <Show when={trouble()}>{(why) => <p class="answer refused" role="alert" data-testid="scene-check-trouble">{words().records.draft.failed(why())}</p>}</Show>
      <Show when={checked()}>
        {(found) => (
          <>
            <Show when={found().warnings.length > 0}>
              <h3 id="scene-findings">{words().records.draft.warnings}</h3>
              <ul class="draft-warnings" aria-labelledby="scene-findings" data-testid="scene-findings">
                <For each={found().warnings}>
                  {(warning) => {
                    const told = () => phraseWords(warning.found_as, warning.found);
                    return <li><code>{warning.path}</code> <span lang={told().lang}>{told().text}</span></li>;
                  }}
                </For>
              </ul>
            </Show>
            <Show when={found().pairs}>{(pairs) => <PairsTable scene={props.scene} pairs={pairs()} />}</Show>
          </>
        )}
      </Show>
    </>
  );
}
