/** Paints the objects: the surer the rule, the more colour. */
import type { SceneDocument } from "../../api/types";
import type { Point } from "../../lib/plan";
import { LINE_PX, placeLabels, type Box, type Label } from "../../lib/placement";
import { words } from "../../i18n";
import { disc, FONT_LABEL, FONT_SMALL, line, pixelsAround, tracePath, widthOf, write, type Brush } from "./brush";
import { HEAD_M, type Note } from "./persons";
import { footprintKept, nameOf, type ArenaState, type DrawnObject } from "./picture";
import { decimal } from "../../lib/format";

/** Footprints with their weights, and what is predicted. */
export function drawObjects(brush: Brush, scene: SceneDocument, state: ArenaState | null): void {
  const { context, palette, plan } = brush;
  const states = statesOf(state);
  for (const document of scene.objects) {
    const object = states.get(document.id);
    const weight = object?.weight ?? 0;
    const centre = plan.toPx([document.position[0], document.position[1]]);
    const predicted = state?.column.committed === document.id;
    const colour = predicted ? palette.predicted : palette.object;
    context.fillStyle = colour;
    if (object !== undefined && document.enabled) {
      // The halo's area grows with the weight: twice as sure, twice as much colour.
      disc(context, centre, HALO_M * Math.sqrt(Math.max(0, weight)) * plan.pxPerMetre);
      context.globalAlpha = 0.1 + 0.3 * Math.min(1, weight);
      context.fill();
    }
    tracePath(brush, footprintKept(document));
    context.globalAlpha = document.enabled ? 0.25 + 0.45 * Math.min(1, weight) : 0.15;
    context.fill();
    context.globalAlpha = 1;
    context.lineWidth = 1.5;
    context.strokeStyle = colour;
    context.stroke();
    if (predicted) drawPredicted(brush, object, centre);
  }
}

/** Names and weights, over everything, and none over another: the predicted first, then in the scene's order, which stays. */
export function drawLabels(brush: Brush, scene: SceneDocument, state: ArenaState | null, notes: readonly Note[]): void {
  const { palette, plan, widthPx, heightPx } = brush;
  const states = statesOf(state);
  const committed = state?.column.committed ?? null;
  const taken: Box[] = [];
  for (const person of state?.persons ?? []) {
    if (person.head_m === null) continue;
    const [px, py] = plan.toPx([person.head_m[0], person.head_m[1]]);
    const head = HEAD_M * plan.pxPerMetre;
    const half = Math.max(widthOf(brush, person.name, FONT_LABEL, palette.person) / 2, head);
    taken.push({ left: px - half, top: py - head, right: px + half, bottom: py + head + 18 });
  }
  for (const { words: note, at, colour } of notes) {
    const half = widthOf(brush, note, FONT_SMALL, colour) / 2;
    taken.push({ left: at[0] - half, top: at[1] - LINE_PX / 2, right: at[0] + half, bottom: at[1] + LINE_PX / 2 });
  }
  const labels: Label[] = [];
  for (const [index, document] of scene.objects.entries()) {
    const about = pixelsAround(footprintKept(document), plan);
    if (about.right < 0 || about.left > widthPx || about.bottom < 0 || about.top > heightPx) continue;
    const object = states.get(document.id);
    const name = nameOf(document);
    const number = !document.enabled ? words().live.off : object === undefined ? "" : decimal(object.weight, 2);
    labels.push({
      name,
      number,
      nameWidth: widthOf(brush, name, FONT_LABEL, palette.text),
      numberWidth: number === "" ? 0 : widthOf(brush, number, FONT_SMALL, palette.muted),
      about,
      urgency: document.id === committed ? Infinity : -index,
    });
  }
  for (const { label, at } of placeLabels(labels, taken)) {
    const colour = label.urgency === Infinity ? palette.predicted : palette.text;
    write(brush, label.name, at, colour, FONT_LABEL);
    if (label.number !== "") write(brush, label.number, [at[0], at[1] + LINE_PX], palette.muted, FONT_SMALL);
  }
}

/** A ring about the object, and where the column must stand for it. */
function drawPredicted({ context, palette, plan }: Brush, object: DrawnObject | undefined, centre: Point): void {
  context.strokeStyle = palette.predicted;
  context.lineWidth = 2;
  disc(context, centre, PREDICTED_RING_M * plan.pxPerMetre);
  context.stroke();
  if (object?.column_place_m === undefined) return;
  const place = plan.toPx(object.column_place_m);
  if (Math.hypot(place[0] - centre[0], place[1] - centre[1]) < 3) return;
  context.setLineDash([2, 4]);
  line(context, centre, place, palette.predicted);
  context.setLineDash([]);
  context.strokeRect(place[0] - 4, place[1] - 4, 8, 8);
}

function statesOf(state: ArenaState | null): ReadonlyMap<string, DrawnObject> {
  return new Map(state?.objects.map((object) => [object.id, object]));
}

/** The halo of an object of weight one, m. */
const HALO_M = 0.36;
const PREDICTED_RING_M = 0.26;
