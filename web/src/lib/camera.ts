/** Decides what part of a picture is seen: panned, zoomed about a point, within limits that never lose the arena. */
import { fitPlan, type Bounds, type Plan, type Point } from "./plan";

/** A picture's room and the canvas that shows it. */
export interface Frame {
  /** What is shown whole at zoom 1, m. */
  readonly bounds: Bounds;
  readonly widthPx: number;
  readonly heightPx: number;
  /** Left free about the bounds at zoom 1, px. */
  readonly marginPx: number;
}

/** What part is seen; null stands for all of it, whatever the canvas's size. */
export interface Camera {
  /** The room's point in the canvas's middle, m. */
  readonly centre: Point;
  /** 1 shows the bounds whole. */
  readonly zoom: number;
}

/** The plan of a frame through a camera. */
export function planOf(frame: Frame, camera: Camera | null): Plan {
  const { bounds, widthPx, heightPx, marginPx } = frame;
  const whole = fitPlan(bounds, widthPx, heightPx, marginPx);
  if (camera === null) return whole;
  const pxPerMetre = whole.pxPerMetre * camera.zoom;
  const [middleX, middleY] = camera.centre;
  return {
    pxPerMetre,
    toPx: ([x, y]) => [widthPx / 2 + (x - middleX) * pxPerMetre, heightPx / 2 - (y - middleY) * pxPerMetre],
    toRoom: ([px, py]) => [middleX + (px - widthPx / 2) / pxPerMetre, middleY - (py - heightPx / 2) / pxPerMetre],
  };
}

/** Zooms by a factor; what lies at a point of the canvas stays there. */
export function zoomedAbout(frame: Frame, camera: Camera | null, factor: number, atPx: Point): Camera {
  const from = camera ?? whole(frame);
  const zoom = clamp(from.zoom * factor, LEAST_ZOOM, GREATEST_ZOOM);
  const [x, y] = planOf(frame, from).toRoom(atPx);
  const { pxPerMetre } = planOf(frame, { ...from, zoom });
  return within(frame, {
    zoom,
    centre: [x - (atPx[0] - frame.widthPx / 2) / pxPerMetre, y + (atPx[1] - frame.heightPx / 2) / pxPerMetre],
  });
}

/** Moves the picture under the canvas by some pixels, as a hand that drags it would. */
export function pannedBy(frame: Frame, camera: Camera | null, [dx, dy]: Point): Camera {
  const from = camera ?? whole(frame);
  const { pxPerMetre } = planOf(frame, from);
  return within(frame, { ...from, centre: [from.centre[0] - dx / pxPerMetre, from.centre[1] + dy / pxPerMetre] });
}

function whole({ bounds }: Frame): Camera {
  return { centre: [(bounds.min[0] + bounds.max[0]) / 2, (bounds.min[1] + bounds.max[1]) / 2], zoom: 1 };
}

/** The canvas's middle stays inside the bounds: whatever is done, some of the arena is in view. */
function within({ bounds }: Frame, { centre, zoom }: Camera): Camera {
  return {
    zoom,
    centre: [clamp(centre[0], bounds.min[0], bounds.max[0]), clamp(centre[1], bounds.min[1], bounds.max[1])],
  };
}

function clamp(value: number, least: number, greatest: number): number {
  return Math.min(greatest, Math.max(least, value));
}

/** Half of the whole: somebody beside the arena comes into view. */
export const LEAST_ZOOM = 0.5;
/** A room of 4 m shown on 16 cm: a hand fills the picture. */
export const GREATEST_ZOOM = 24;
