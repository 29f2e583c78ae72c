/** The wire's types under one roof. They are generated from the server's sources; nothing here is written by hand
 * but the answer of the priors' preview. */
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
  PriorChange,
  PropDocument,
  RecordedFrame,
  RequestState,
  RuleState,
  RuleStatus,
  SceneDocument,
  SceneError,
  SceneInForce,
  SceneSummary,
  SceneVersionSummary,
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

/** The answer of `POST /api/v1/priors/preview`, room frame, m. */
export interface PriorPreview {
  /** Where the column would be wanted; null when nobody would be served. */
  readonly target_m: readonly [number, number] | null;
  /** Id of the person who would be served. */
  readonly serves: number | null;
  /** Id of the object that the rule would be committed to. */
  readonly committed: string | null;
  readonly planned_path_m: readonly (readonly [number, number])[];
  readonly objects: readonly { readonly id: string; readonly weight: number; readonly probability: number; readonly prior: number }[];
}
