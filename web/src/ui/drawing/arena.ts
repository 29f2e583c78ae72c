/**
 * Paints the arena from above. It decides what is drawn over what; it must never invent a position: whatever the state
 * does not say is not drawn.
 */
import { drawColumn, drawGhost, drawPlannedPath } from "./column";
import { FONT_SMALL, write, type Brush } from "./brush";
import { drawLabels, drawObjects } from "./objects";
import { bindingNote, drawLimit, drawPerson, drawZone } from "./persons";
import { boundsOf, type ArenaPicture, type Layers } from "./picture";
import { drawScenery } from "./scenery";
import { drawTrails } from "./trails";

/** Paints one canvas; what stays between two paintings is kept on a canvas of its own. */
export class ArenaPainter {
  readonly #scenery = document.createElement("canvas");
  #kept: readonly unknown[] = [];

  /** Everything, over what was there. */
  paint(brush: Brush, picture: ArenaPicture, layers: Layers): void {
    const { context, widthPx, heightPx } = brush;
    context.clearRect(0, 0, widthPx, heightPx);
    const { state, scene, trails, ghost } = picture;
    this.#paintScenery(brush, picture);
    if (this.#scenery.width > 0) context.drawImage(this.#scenery, 0, 0, widthPx, heightPx);
    if (layers.trails && trails !== undefined) drawTrails(brush, trails);
    if (layers.zones) for (const person of state?.persons ?? []) drawZone(brush, person);
    if (scene !== null) drawObjects(brush, scene, state);
    if (layers.path && ghost !== undefined && ghost !== null) drawGhost(brush, ghost);
    // Before homing the column's numbers are not places in the room.
    if (state?.column.homed === true) {
      if (layers.path) drawPlannedPath(brush, state);
      drawColumn(brush, state, scene);
    }
    for (const person of state?.persons ?? []) {
      if (layers.zones && state !== null) drawLimit(brush, person, state.column);
      drawPerson(brush, person, state?.column.serves === person.id);
    }
    const notes = layers.zones ? (state?.persons ?? []).flatMap((person) => bindingNote(brush, person) ?? []) : [];
    if (layers.labels && scene !== null) drawLabels(brush, scene, state, notes);
    for (const { words, at, colour } of notes) write(brush, words, at, colour, FONT_SMALL);
  }

  #paintScenery(brush: Brush, { scene, shape }: ArenaPicture): void {
    const { plan, palette, widthPx, heightPx, ratio } = brush;
    const bounds = boundsOf(scene, shape);
    const made = [scene, shape, palette, plan, widthPx, heightPx, ratio];
    if (made.length === this.#kept.length && made.every((part, index) => part === this.#kept[index])) return;
    this.#kept = made;
    this.#scenery.width = Math.round(widthPx * ratio);
    this.#scenery.height = Math.round(heightPx * ratio);
    const context = this.#scenery.getContext("2d");
    if (context === null || bounds === null) return;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    drawScenery({ ...brush, context }, bounds, scene, shape);
  }
}
