/** The scene that the mock starts with. */
import type { LinkThresholds, MachineShape, SceneDocument } from "../src/api/types";

/** Column and travel of the mock's machine. */
export const MACHINE_SHAPE: MachineShape = {
  travel_m: [0.1, 0.1, 3.9, 3.9],
  speed_mps: [1.1, 1.1],
  acceleration_mps2: [1.25, 1.25],
  braking_mps2: [2.5, 2.5],
};

/** A room with a panel, a lamp, doors and a table in the way. */
export const MOCK_SCENE: SceneDocument = {
  schema: "covr.scene.v2",
  name: "Dark room",
  description: "For development of the dashboard.",
  arena: { min: [0, 0], max: [4, 4] },
  column: { size: [0.15, 0.15] },
  props: [
    { id: "panel", label: "cardboard wall", offset: [0, 0.14], facing: Math.PI / 2, size: [0.5, 0.04] },
    { id: "handle", label: "handle", offset: [-0.13, 0], facing: Math.PI, size: [0.06, 0.06] },
  ],
  objects: [
    { id: "bulb", label: "Light bulb", position: [0.9, 3.1, 1.7], yaw: 0, shape: { kind: "sphere", radius: 0.06 }, prop: null, prior: 1, enabled: true },
    { id: "north-door", label: "North door", position: [2.4, 3.5, 1.1], yaw: 0, shape: { kind: "box", size: [0.8, 0.05, 2] }, prop: "panel", prior: 1, enabled: true },
    { id: "lever", label: "Lever", position: [3.4, 2.1, 1.2], yaw: 0.5, shape: { kind: "cylinder", radius: 0.05, height: 0.3 }, prop: "handle", prior: 0.6, enabled: true },
    { id: "rock", label: "Rock", position: [2.9, 0.7, 0.5], yaw: 0, shape: { kind: "convex_mesh", points: [[-0.2, -0.15, 0], [0.22, -0.1, 0], [0.1, 0.2, 0.1], [-0.15, 0.12, 0], [0, 0, 0.4]] }, prop: null, prior: 1, enabled: true },
    { id: "chest", label: "Chest", position: [0.7, 1.2, 0.4], yaw: 0.3, shape: { kind: "box", size: [0.4, 0.3, 0.3] }, prop: null, prior: 1, enabled: true },
    { id: "curtain", label: "Curtain", position: [1.5, 0.4, 1.2], yaw: 0, shape: { kind: "cylinder", radius: 0.15, height: 2 }, prop: null, prior: 1, enabled: false },
  ],
  keep_outs: [
    { id: "table", label: "Table", shape: { kind: "polygon", corners: [[3.3, 0.1], [3.9, 0.1], [3.9, 0.5], [3.3, 0.5]] } },
    { id: "chair", label: "Bystander", shape: { kind: "circle", centre: [0.4, 3.7], radius: 0.25 } },
  ],
};

/** As the server's. */
export const LINK_THRESHOLDS: LinkThresholds = {
  pose_age_millis: { weak: 50, bad: 150 },
  jitter_millis: { weak: 8, bad: 25 },
  loss_percent: { weak: 1, bad: 5 },
  rtt_millis: { weak: 20, bad: 60 },
  lateness_micros: { weak: 1000, bad: 4000 },
};
