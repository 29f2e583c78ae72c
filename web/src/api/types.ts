/**
 * The wire's types under one roof. They are generated from the server's sources; nothing here is written by hand
 * except the names of rows that only HTTP answers carry.
 */
export type {
  Activity,
  Client,
  Column,
  ConfigInForce,
  ConfigKey,
  ControlLoop,
  Event as WireEvent,
  FromDashboard,
  KeepOutDocument,
  LinkThresholds,
  MachineRequest,
  MachineShape,
  Mode,
  Object as ObjectState,
  ObjectDocument,
  Outcome,
  Person,
  PropDocument,
  RecordedFrame,
  RequestState,
  RuleState,
  RuleStatus,
  SceneDocument,
  SceneInForce,
  SeparationTerm,
  SeparationTerms,
  Session,
  SessionDetail,
  ShapeDocument,
  Snapshot,
  StopCause,
  Threshold,
  ToDashboard,
} from "./generated";

/** A row of `GET /api/v1/scenes`. */
export interface SceneSummary {
  readonly id: number;
  readonly name: string;
  readonly version: number;
  readonly author: string;
  readonly changed_at: string;
  readonly active: boolean;
}

/** A row of `GET /api/v1/priors/changes`, newest first. */
export interface PriorChange {
  readonly at: string;
  readonly author: string;
  readonly object: string;
  readonly from: number;
  readonly to: number;
}

/** A row of `GET /api/v1/scenes/{id}/versions`, newest first. */
export interface SceneVersionSummary {
  readonly version: number;
  readonly author: string;
  readonly created_at: string;
  readonly active: boolean;
  /** How many objects it has. */
  readonly objects: number;
}

/** One finding of a refused scene. */
export interface SceneError {
  readonly path: string;
  readonly line: number | null;
  readonly column: number | null;
  readonly found: string;
  readonly expected: string;
}
