/** What the column does with somebody, who may be touched while it moves (R14), and who leans on it or rides it. */
import { createSignal, For, Show, type JSX } from "solid-js";
import type { MachineRequest, SceneDocument, Snapshot } from "../../api/types";
import { words } from "../../i18n";
import { span } from "../../lib/format";
import { labelOf } from "../../lib/labels";

/** For how long a contact is armed when nothing else is chosen, s. */
const USUAL_SECS = 60;
const LENGTHS_SECS = [30, USUAL_SECS, 120, 300] as const;

/** The panel; nothing where the scene has no interactions and nobody leans. */
export function ContactPanel(props: {
  readonly scene: SceneDocument;
  readonly snapshot: Snapshot;
  readonly may: boolean;
  readonly ask: (request: MachineRequest, what: string) => void;
}): JSX.Element {
  const say = () => words().scenario.contact;
  const [secs, setSecs] = createSignal<number>(USUAL_SECS);
  const interactions = () => (props.scene.scenario?.states ?? []).flatMap((state) => Object.values(state.interactions ?? {}));
  const hasContact = (): boolean => interactions().some(({ kind }) => kind === "lead" || kind === "transport" || kind === "brush");
  const nameOf = (id: number): string => props.snapshot.persons.find((person) => person.id === id)?.name ?? say().person(id);
  const armable = (): boolean => props.may && props.snapshot.mode === "following";
  return (
    <Show when={interactions().length > 0 || props.snapshot.bears !== null}>
      <section class="panel" aria-labelledby="scenario-contact">
        <h2 id="scenario-contact">{say().title}</h2>
        <p data-testid="interaction">
          <Show when={props.snapshot.interaction} fallback={say().none}>
            {(now) => (
              <>
                <strong>{say().now(now().interaction, labelOf(props.scene, now().object))}</strong> {say().phases[now().phase as keyof ReturnType<typeof say>["phases"]]}
                {now().person === null ? "" : `, ${nameOf(now().person ?? 0)}`}
              </>
            )}
          </Show>
        </p>
        <Show when={props.snapshot.bears}>
          {(person) => (
            <div class="warn" data-testid="bears">
              <p>{say().bears(nameOf(person()))}</p>
              <button type="button" data-testid="confirm-free" disabled={!props.may} onClick={() => { props.ask("confirm_free", say().free); }}>
                {say().free}
              </button>
            </div>
          )}
        </Show>
        <Show when={hasContact()}>
          <p data-testid="contact" classList={{ warn: props.snapshot.contact !== null }}>
            {props.snapshot.contact === null ? say().notArmed : say().armed(nameOf(props.snapshot.contact.person), span(props.snapshot.contact.left_secs))}
          </p>
          <label class="contact-length">
            {say().length}
            <select data-testid="contact-secs" value={secs()} onChange={(event) => { setSecs(Number(event.currentTarget.value)); }}>
              <For each={LENGTHS_SECS}>{(length) => <option value={length}>{span(length)}</option>}</For>
            </select>
          </label>
          <ul class="scenario-cues">
            <For each={props.snapshot.persons} fallback={<li>{say().nobody}</li>}>
              {(person) => (
                <li>
                  <button
                    type="button"
                    data-testid={`arm-contact-${String(person.id)}`}
                    disabled={!armable() || !person.tracked}
                    onClick={() => { props.ask({ arm_contact: { person: person.id, secs: secs() } }, say().arm(person.name)); }}
                  >
                    {say().arm(person.name)}
                  </button>
                </li>
              )}
            </For>
            <li>
              <button type="button" data-testid="disarm-contact" disabled={!props.may || props.snapshot.contact === null} onClick={() => { props.ask("disarm_contact", say().takeBack); }}>
                {say().takeBack}
              </button>
            </li>
          </ul>
          <p class="hint">{say().means}</p>
        </Show>
      </section>
    </Show>
  );
}
