/** Folds a panel to its title, whatever the panel is. It stays alive: what it shows goes on counting. */
import type { JSX } from "solid-js";
import { words } from "../i18n";

/** The panel with its fold. */
export function Foldable(props: {
  readonly name: string;
  readonly title: string;
  readonly folded: boolean;
  readonly fold: (folded: boolean) => void;
  /** Takes its share of the height that is left. */
  readonly grows?: boolean;
  readonly children: JSX.Element;
}): JSX.Element {
  const id = (): string => `foldable-${props.name}`;
  return (
    <div class="foldable" classList={{ folded: props.folded, growing: props.grows === true && !props.folded }} data-testid={`panel-${props.name}`}>
      <button
        type="button"
        class="fold-button"
        data-testid={`fold-${props.name}`}
        aria-expanded={!props.folded}
        aria-controls={id()}
        aria-label={props.folded ? words().live.unfold(props.title) : words().live.fold(props.title)}
        title={props.folded ? words().live.unfold(props.title) : words().live.fold(props.title)}
        onClick={() => { props.fold(!props.folded); }}
      >
        <span class="fold-title" aria-hidden="true">{props.title}</span>
        <svg viewBox="0 0 12 12" aria-hidden="true">
          <path d="M2.5 4.5 6 8l3.5-3.5" />
        </svg>
      </button>
      <div class="folded-part" id={id()} hidden={props.folded}>
        {props.children}
      </div>
    </div>
  );
}
