/** Paints people: the zone that the separation rule gives each, term by term, and where they look. */
import { words } from "../../i18n";
import type { Point } from "../../lib/plan";
import { bindingMetres, nearnessOf, ringsOf } from "../../lib/separation";
import { metres } from "../../lib/format";
import { disc, FONT_LABEL, FONT_SMALL, line, write, type Brush } from "./brush";
import type { ArenaState, DrawnPerson } from "./picture";

/** The zone: r solid, what is required dashed, each term between them a ring, the binding one stronger and named. */
export function drawZone(brush: Brush, person: DrawnPerson): void {
  if (person.head_m === null) return;
  const { context, palette, plan } = brush;
  const centre = plan.toPx([person.head_m[0], person.head_m[1]]);
  const nearness = nearnessOf(person);
  const colour = nearness === "breached" ? palette.danger : nearness === "near" ? palette.near : palette.person;
  const terms = person.separation ?? null;
  let inner = person.separation_radius_m;
  for (const ring of terms === null ? [] : ringsOf(terms)) {
    if (ring.term === "radius") {
      inner = ring.outer;
      continue;
    }
    context.beginPath();
    context.arc(centre[0], centre[1], ring.outer * plan.pxPerMetre, 0, 2 * Math.PI);
    context.arc(centre[0], centre[1], inner * plan.pxPerMetre, 0, 2 * Math.PI, true);
    context.globalAlpha = ring.binds ? 0.34 : 0.16;
    context.fillStyle = palette.terms[ring.term];
    context.fill();
    inner = ring.outer;
  }
  disc(context, centre, person.separation_radius_m * plan.pxPerMetre);
  context.globalAlpha = 0.14;
  context.fillStyle = colour;
  context.fill();
  context.globalAlpha = 0.9;
  context.lineWidth = person.limits_column === true ? 2.5 : 1.5;
  context.strokeStyle = colour;
  context.stroke();
  disc(context, centre, person.required_m * plan.pxPerMetre);
  context.setLineDash([4, 4]);
  context.lineWidth = 1.25;
  context.stroke();
  context.setLineDash([]);
  context.globalAlpha = 1;
}

/** Words about a person, and where they stand. */
export interface Note {
  readonly words: string;
  readonly at: Point;
  readonly colour: string;
}

/** Names the term that binds, over the zone's upper edge. */
export function bindingNote(brush: Brush, person: DrawnPerson): Note | null {
  const terms = person.separation ?? null;
  if (person.head_m === null || terms === null || brush.plan.pxPerMetre < LEAST_PX_FOR_TERMS) return null;
  const [px, py] = brush.plan.toPx([person.head_m[0], person.head_m[1]]);
  const top = py - person.required_m * brush.plan.pxPerMetre - 10;
  // A zone that reaches beyond the picture is named at its lower edge, else inside the picture.
  const y = top < 10 ? Math.min(py + person.required_m * brush.plan.pxPerMetre + 10, brush.heightPx - 10) : top;
  const term = terms.binding;
  return { words: `${words().live.terms[term]} ${metres(bindingMetres(terms))} m`, at: [px, y], colour: brush.palette.terms[term] };
}

/** A tie from who limits the column to it. */
export function drawLimit(brush: Brush, person: DrawnPerson, column: ArenaState["column"]): void {
  if (person.limits_column !== true || person.head_m === null || !column.homed) return;
  const { context, palette, plan } = brush;
  const colour = nearnessOf(person) === "breached" ? palette.danger : palette.near;
  const from = plan.toPx([person.head_m[0], person.head_m[1]]);
  const to = plan.toPx(column.position_m);
  context.lineWidth = 2;
  context.setLineDash([1, 5]);
  context.lineCap = "round";
  line(context, from, to, colour);
  context.lineCap = "butt";
  context.setLineDash([]);
  // The head's and the column's own marks fill a shorter tie.
  if (Math.hypot(to[0] - from[0], to[1] - from[1]) < LEAST_TIE_PX) return;
  const middle: Point = [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2];
  write(brush, `${words().live.limits} ${metres(person.distance_m)} m`, middle, colour, FONT_SMALL);
}

/** The head, its view, and its name. */
export function drawPerson(brush: Brush, person: DrawnPerson, served: boolean): void {
  if (person.head_m === null) return;
  const { context, palette, plan } = brush;
  const [px, py] = plan.toPx([person.head_m[0], person.head_m[1]]);
  const colour = person.tracked ? palette.person : palette.danger;
  const reach = VIEW_M * Math.max(0.25, Math.cos(person.pitch_rad)) * plan.pxPerMetre;
  // The canvas's y points down, so headings turn the other way.
  const heading = -person.yaw_rad;
  const fade = context.createRadialGradient(px, py, 0, px, py, reach);
  fade.addColorStop(0, colour);
  // Towards the same colour (#rrggbb) unseen: plain `transparent` is black, and greys the fading.
  fade.addColorStop(1, `${colour}00`);
  context.globalAlpha = 0.45;
  context.fillStyle = fade;
  context.beginPath();
  context.moveTo(px, py);
  context.arc(px, py, reach, heading - VIEW_HALF_RAD, heading + VIEW_HALF_RAD);
  context.closePath();
  context.fill();
  context.globalAlpha = 1;
  context.lineWidth = 2.5;
  const head = HEAD_M * plan.pxPerMetre;
  line(context, [px, py], [px + 2 * head * Math.cos(heading), py + 2 * head * Math.sin(heading)], colour);
  disc(context, [px, py], head);
  context.fillStyle = palette.ground;
  context.fill();
  context.strokeStyle = colour;
  context.stroke();
  if (served) {
    disc(context, [px, py], head * 0.45);
    context.fillStyle = colour;
    context.fill();
  }
  const note = !person.tracked ? ` (${words().live.notTracked})` : person.awaits_confirmation === true ? ` (${words().live.floorMark})` : "";
  write(brush, person.name + note, [px, py + head + 10], colour, FONT_LABEL);
}

/** A head seen from above, m. */
export const HEAD_M = 0.1;
const VIEW_M = 1.1;
/** Half the angle within which the paper counts an object as looked at: about 20 degrees. */
const VIEW_HALF_RAD = (20 * Math.PI) / 180;
/** In a smaller picture the zone's words would cover it. */
const LEAST_PX_FOR_TERMS = 60;
const LEAST_TIE_PX = 90;
