/** Recorded sessions to look at: a minute or two of the mock machine, with a stretch that was not recorded. */
import type { RecordedFrame, Session, SessionDetail, WireEvent } from "../src/api/types";
import { MockMachine } from "./machine.ts";
import { MACHINE_SHAPE, MOCK_SCENE } from "./scene.ts";

/** How long the recorded session lasted, s. */
export const SESSION_SECS = 90;

/** A frame of the recorded session. */
export function recordedFrame(secs: number): RecordedFrame {
  RECORDED ??= record();
  const frame = RECORDED[Math.max(0, Math.min(RECORDED.length - 1, Math.round(secs * RATE_HZ)))];
  if (frame === undefined) throw new Error("the session has frames");
  return { ...frame, at_micros: Math.round(secs * 1e6) };
}

/** Frames of a stretch, oldest first; none from 40 s to 43 s. */
export function recordedFrames(fromSecs: number, toSecs: number, everySecs: number): readonly RecordedFrame[] {
  const step = Math.max(1 / RATE_HZ, everySecs);
  const frames: RecordedFrame[] = [];
  for (let index = Math.ceil(fromSecs / step - 1e-9); index * step < Math.min(toSecs, SESSION_SECS); index += 1) {
    const secs = index * step;
    if (secs <= 40 || secs >= 43) frames.push(recordedFrame(secs));
  }
  return frames;
}

/** The sessions, newest first: one that runs, one recorded, one that is older than recordings. */
export function sessions(startedAt: string): readonly Session[] {
  const started = Date.parse(startedAt);
  const at = (secs: number): string => new Date(started + secs * 1000).toISOString();
  const row = { scene_id: 1, scene_version: 1, scene: MOCK_SCENE.name, dropped_frames: 0, recording_removed_at: null };
  const recorded = { reaches: 9, reaches_served: 8, stops: 1, recorded_frames: SESSION_SECS * RATE_HZ, recording_bytes: 412_000 };
  const none = { reaches: 0, reaches_served: 0, stops: 0, recorded_frames: 0, recording_bytes: 0 };
  return [
    { ...row, ...none, id: 3, started_at: startedAt, ended_at: null, how: null, length_secs: (Date.now() - started) / 1000 },
    { ...row, ...recorded, id: 2, started_at: at(-3600), ended_at: at(-3600 + SESSION_SECS), how: "latched_stop", length_secs: SESSION_SECS },
    { ...row, ...none, id: 1, started_at: at(-90_000), ended_at: at(-86_000), how: "disarmed", length_secs: 4000 },
  ];
}

/** One of them in full; null if there is none. */
export function sessionDetail(id: number, startedAt: string): SessionDetail | null {
  const session = sessions(startedAt).find((row) => row.id === id);
  if (session === undefined) return null;
  return {
    ...session,
    persons: session.id === 2 ? ["Ada"] : [],
    scenes: [{ id: 1, version: 1, from_secs: 0 }],
    first_micros: session.id === 1 ? null : 0,
    last_micros: session.id === 1 ? null : Math.round((session.length_secs ?? 0) * 1e6),
    machine_shape: session.id === 1 ? null : MACHINE_SHAPE,
  };
}

/** Its events, oldest first. */
export function sessionEvents(id: number): readonly WireEvent[] {
  if (id !== 2) return [];
  const event = (secs: number, kind: string, summary: string, detail: unknown = null): WireEvent => ({ at_micros: secs * 1e6, at: new Date(secs * 1000).toISOString(), kind, summary, detail });
  return [
    event(0.1, "mode_changed", "following", { from: "ready", to: "following" }),
    event(8, "served", "the column stands at bulb", { object: "bulb" }),
    event(9.5, "touch_began", "Ada touches bulb", { object: "bulb" }),
    event(31, "served", "the column stands at lever", { object: "lever" }),
    event(32.2, "touch_began", "Ada touches lever", { object: "lever" }),
    event(70, "mode_changed", "protective stop", { from: "following", to: "protective_stop" }),
    event(72, "mode_changed", "following", { from: "protective_stop", to: "following" }),
    event(SESSION_SECS - 1, "stop_pressed", "software stop pressed by Ada", { reason: "end" }),
  ];
}

function record(): readonly RecordedFrame[] {
  const machine = new MockMachine(MOCK_SCENE, { latchedBy: null, mode: "following" }, () => undefined);
  return Array.from({ length: SESSION_SECS * RATE_HZ }, () => {
    machine.step(1 / RATE_HZ);
    const { at_micros, mode, column, persons, objects } = machine.snapshot();
    const { position_m, velocity_mps, commanded_m, proxy_m, target_m, serves, committed, activity, homed } = column;
    return {
      at_micros,
      mode,
      column: { position_m, velocity_mps, commanded_m, proxy_m, target_m, serves, committed, activity, homed },
      persons: persons.map(({ id, name, head_m, yaw_rad, pitch_rad, tracked, separation_radius_m, distance_m, required_m }) => ({ id, name, head_m, yaw_rad, pitch_rad, tracked, separation_radius_m, distance_m, required_m })),
      objects: objects.map(({ id, weight, probability, prior, enabled }) => ({ id, weight, probability, prior, enabled })),
      scenario: null,
    };
  });
}

const RATE_HZ = 10;
let RECORDED: readonly RecordedFrame[] | null = null;
