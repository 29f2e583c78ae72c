/** The arena from above: live, replayed, or a scene alone. */
import type { JSX } from "solid-js";
import { language } from "../i18n";
import { ArenaPainter } from "./drawing/arena";
import { ALL_LAYERS, boundsOf, type ArenaPicture, type Layers } from "./drawing/picture";
import { PlanCanvas } from "./PlanCanvas";

export type { ArenaPicture, ArenaState, Ghost, Layers } from "./drawing/picture";

/** A picture that pans and zooms; it fills the element that it is in. */
export function Arena(props: {
  readonly picture: () => ArenaPicture;
  /** Names the picture for those who do not see it. */
  readonly label: () => string;
  /** What is shown; everything without it. */
  readonly layers?: () => Layers;
  readonly describedBy?: string;
  readonly testId?: string;
  readonly listsKeys?: boolean;
  readonly children?: JSX.Element;
}): JSX.Element {
  const painter = new ArenaPainter();
  return (
    <PlanCanvas
      bounds={() => {
        const { scene, shape } = props.picture();
        return boundsOf(scene, shape);
      }}
      marginPx={MARGIN_PX}
      painting={() => {
        const picture = props.picture();
        const layers = props.layers?.() ?? ALL_LAYERS;
        language();
        return (brush) => {
          painter.paint(brush, picture, layers);
        };
      }}
      label={props.label}
      describedBy={props.describedBy}
      testId={props.testId}
      listsKeys={props.listsKeys === true}
    >
      {props.children}
    </PlanCanvas>
  );
}

const MARGIN_PX = 34;
