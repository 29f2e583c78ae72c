/** What a picture of the arena is made of: live, replayed or imagined, it is the same. */
import type { Activity, KeepOutDocument, MachineShape, ObjectDocument, SceneDocument, SeparationTerms } from "../../api/types";
import { boundsAround, footprintOf, type Bounds, type Footprint, type Point } from "../../lib/plan";
import type { Trails } from "../../lib/trails";

/** All that can be painted. */
export interface ArenaPicture {
  readonly state: ArenaState | null;
  readonly scene: SceneDocument | null;
  readonly shape: MachineShape | null;
  readonly trails?: Trails;
  /** Where the column would go, were something else asked. */
  readonly ghost?: Ghost | null;
}

/** The part of a snapshot, or of a recorded frame, that is drawn. */
export interface ArenaState {
  readonly column: DrawnColumn;
  readonly persons: readonly DrawnPerson[];
  readonly objects: readonly DrawnObject[];
}

/** The column, room frame, m and m/s. */
export interface DrawnColumn {
  readonly position_m: Point;
  readonly velocity_mps: Point;
  readonly commanded_m: Point;
  readonly proxy_m: Point;
  readonly target_m: Point | null;
  readonly serves: number | null;
  readonly committed: string | null;
  readonly activity: Activity;
  readonly homed: boolean;
  readonly planned_path_m?: readonly Point[];
}

/** A person, room frame, m and rad. */
export interface DrawnPerson {
  readonly id: number;
  readonly name: string;
  readonly head_m: readonly [number, number, number] | null;
  readonly yaw_rad: number;
  readonly pitch_rad: number;
  readonly tracked: boolean;
  readonly separation_radius_m: number;
  readonly distance_m: number;
  readonly required_m: number;
  readonly awaits_confirmation?: boolean;
  readonly separation?: SeparationTerms | null;
  readonly limits_column?: boolean;
}

/** What a rule makes of an object. */
export interface DrawnObject {
  readonly id: string;
  readonly weight: number;
  readonly column_place_m?: Point;
}

/** A column that is not there. */
export interface Ghost {
  readonly target_m: Point | null;
  readonly path_m: readonly Point[];
}

/** What can be left out of the picture. */
export interface Layers {
  readonly trails: boolean;
  readonly zones: boolean;
  readonly path: boolean;
  readonly labels: boolean;
}

/** Everything. */
export const ALL_LAYERS: Layers = { trails: true, zones: true, path: true, labels: true };

/** The rectangle of the room that a picture is about; null while nothing is known. */
export function boundsOf(scene: SceneDocument | null, shape: MachineShape | null): Bounds | null {
  const arena: Bounds | null = scene === null ? null : { min: scene.arena.min, max: scene.arena.max };
  if (shape === null) return arena;
  const [minX, minY, maxX, maxY] = shape.travel_m;
  const travel: Bounds = { min: [minX, minY], max: [maxX, maxY] };
  return arena === null ? travel : boundsAround(arena, travel);
}

/** An object's footprint; worked out once for each document, for a mesh of thousands of corners costs its time. */
export function footprintKept(object: ObjectDocument): Footprint {
  let footprint = FOOTPRINTS.get(object);
  if (footprint === undefined) FOOTPRINTS.set(object, (footprint = footprintOf(object)));
  return footprint;
}

/** A keep-out's footprint. */
export function footprintOfKeepOut({ shape }: KeepOutDocument): Footprint {
  return shape.kind === "circle"
    ? { kind: "disc", centre: shape.centre, radius: shape.radius }
    : { kind: "polygon", corners: shape.corners };
}

/** What a designer called a thing, else its id. */
export function nameOf(thing: { readonly id: string; readonly label?: string }): string {
  return thing.label !== undefined && thing.label !== "" ? thing.label : thing.id;
}

const FOOTPRINTS = new WeakMap<ObjectDocument, Footprint>();
