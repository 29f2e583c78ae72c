/** The wire's types under one roof. They are generated from the server's sources; nothing here is written by hand:
 * `generated` is what the sockets and the store carry, `answers` what HTTP alone answers. */
export type {
  Accepts,
  Activity,
  Client,
  Column,
  ConfigInForce,
  ConfigKey,
  ControlLoop,
  Decision,
  Event as WireEvent,
  FromDashboard,
  JogAim,
  KeepOutDocument,
  LinkThresholds,
  MachineHealth,
  MachineRequest,
  MachineShape,
  MachineTrouble,
  Mode,
  Object as ObjectState,
  ObjectDocument,
  Outcome,
  Person,
  PriorChange,
  PropDocument,
  Reason,
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
export type { Answered } from "./answers/Answered";
export type { Me } from "./answers/Me";
export type { Role } from "./answers/Role";
export type { Problem as ProblemDocument } from "./answers/Problem";
export type { PriorsPreview as PriorPreview } from "./answers/PriorsPreview";
export type { SceneStored } from "./answers/SceneStored";
export type { StopAcknowledged } from "./answers/StopAcknowledged";
