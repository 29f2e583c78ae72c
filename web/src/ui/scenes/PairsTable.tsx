/** Whether the column is in time from each object to each other: what it needs beside what a person needs at a usual walk. */
import { For, Show, type JSX } from "solid-js";
import type { SceneDocument, ScenePairs } from "../../api/types";
import { words } from "../../i18n";
import { decimal } from "../../lib/format";
import { labelOf } from "../../lib/labels";

/** The table. */
export function PairsTable(props: { readonly scene: SceneDocument; readonly pairs: ScenePairs }): JSX.Element {
  const say = () => words().records.pairs;
  const serve = (from: number, to: number): number => props.pairs.serve_secs[from]?.[to] ?? 0;
  const walk = (from: number, to: number): number => props.pairs.walk_secs[from]?.[to] ?? 0;
  const isLate = (from: number, to: number): boolean => from !== to && serve(from, to) > walk(from, to);
  const indices = (): readonly number[] => props.pairs.objects.map((_, index) => index);
  const name = (index: number): string => labelOf(props.scene, props.pairs.objects[index] ?? "");
  const late = (): number => indices().reduce((sum, from) => sum + indices().filter((to) => isLate(from, to)).length, 0);
  return (
    <>
      <h3 id="pairs-title">{say().title}</h3>
      <p class="empty">{say().means}</p>
      <p data-testid="pairs-late" classList={{ bad: late() > 0 }}>{late() > 0 ? say().late(late()) : say().inTime}</p>
      <div class="wide scrolls" tabindex="0" role="region" aria-labelledby="pairs-title">
        <table class="pairs" data-testid="pairs">
          <thead>
            <tr>
              <th scope="col">{say().fromTo}</th>
              <For each={indices()}>{(to) => <th scope="col">{name(to)}</th>}</For>
            </tr>
          </thead>
          <tbody>
            <For each={indices()}>
              {(from) => (
                <tr>
                  <th scope="row">{name(from)}</th>
                  <For each={indices()}>
                    {(to) => (
                      <td classList={{ late: isLate(from, to) }} data-testid={`pair-${props.pairs.objects[from] ?? ""}-${props.pairs.objects[to] ?? ""}`}>
                        <Show when={from !== to} fallback="–">
                          {decimal(serve(from, to), 1)} <small>/ {decimal(walk(from, to), 1)} s</small>
                          <Show when={isLate(from, to)}>
                            <b> {say().lateMark}</b>
                          </Show>
                        </Show>
                      </td>
                    )}
                  </For>
                </tr>
              )}
            </For>
          </tbody>
        </table>
      </div>
    </>
  );
}
