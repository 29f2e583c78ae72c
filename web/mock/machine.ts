/**
 * A machine to look at: plausible numbers for the dashboard's development and tests. It makes no claim to be safe or
 * true; the real one is the server's.
 */
import type { Decision, MachineRequest, Mode, ObjectState, Outcome, Person, PriorPreview, Reason, SceneDocument, Snapshot, StopCause, WireEvent } from "../src/api/types";

/** What the mock's owner may set up. */
export interface MockOptions {
  /** Why the last run left the machine latched; null for a clean start. */
  readonly latchedBy: string | null;
  readonly mode: Mode;
}

/** The answer to a request. */
export interface MockAnswer {
  readonly outcome: Outcome;
  readonly detail: string;
  readonly why: Reason | null;
}

/** A reason and the server's sentence for it. */
type Told = readonly [Reason, string];

/** One mock machine with its visitor. */
export class MockMachine {
  scene: SceneDocument;
  sceneId = 1;
  sceneVersion = 1;
  readonly events: WireEvent[] = [];
  readonly #told: (event: WireEvent) => void;
  readonly #priors = new Map<string, number>();
  #mode: Mode;
  #stop: StopCause | null = null;
  #modeSinceSecs = 0;
  #atSecs = 0;
  #generation = 0;
  #column: [number, number] = [2, 2];
  #velocity: [number, number] = [0, 0];
  #awaitsConfirmation = false;

  constructor(scene: SceneDocument, options: MockOptions, told: (event: WireEvent) => void) {
    this.scene = scene;
    this.#told = told;
    this.#mode = options.mode;
    this.useScene(scene);
    if (options.latchedBy !== null) this.#latch(options.latchedBy);
  }

  /** Serves another scene. */
  useScene(scene: SceneDocument): void {
    this.scene = scene;
    this.#priors.clear();
    for (const object of scene.objects) this.#priors.set(object.id, object.prior);
  }

  /** Moves on by some seconds. */
  step(secs: number): void {
    this.#atSecs += secs;
    this.#generation += 1;
    if (this.#mode === "homing" && this.#atSecs - this.#modeSinceSecs > 1) this.#enter("ready");
    const target = this.#mode === "following" ? this.#target() : null;
    for (const axis of [0, 1] as const) {
      const wanted = target === null ? 0 : Math.max(-1.1, Math.min(1.1, (target[axis] - this.#column[axis]) * 2.5));
      const change = Math.max(-2.5 * secs, Math.min(2.5 * secs, wanted - this.#velocity[axis]));
      this.#velocity[axis] += change;
      this.#column[axis] += this.#velocity[axis] * secs;
    }
  }

  /** Stops; returns the microseconds to the drive, null if it was stopped already. */
  stop(reason: string | null): { toDriveMicros: number | null } {
    const already = this.#mode === "latched_stop";
    this.event("stop_pressed", reason ?? "software stop", { author: "game master", by: "mock", reason, to_drive_micros: already ? 0 : 1840 });
    if (!already) this.#latch(reason);
    return { toDriveMicros: already ? null : 1840 };
  }

  /** Asks for something else. */
  ask(request: MachineRequest, reason: string | null): MockAnswer {
    if (typeof request === "object" && "confirm_left" in request) {
      const detail = `the headset of person ${request.confirm_left} is tracked: they are in the arena`;
      this.event("request_refused", detail);
      return { outcome: "refused", detail, why: { id: "person_still_tracked", person: "Ada" } };
    }
    if (request === "disarm_contact") return { outcome: "already_so", detail: "no contact is armed", why: { id: "contact_not_armed" } };
    if (request === "confirm_free") return { outcome: "already_so", detail: "nobody leans on the column or rides it, somebody looked", why: { id: "nobody_leans" } };
    if (request === "rewind" || (typeof request === "object" && !("confirm_origin" in request))) {
      return { outcome: "refused", detail: "the active scene has no scenario", why: { id: "no_scenario" } };
    }
    if (typeof request === "object") {
      this.#awaitsConfirmation = false;
      this.event("request_accepted", `person ${request.confirm_origin} stands on the floor mark`);
      return { outcome: "accepted", detail: "Ada is confirmed on the floor mark", why: { id: "origin_confirmed", person: "Ada" } };
    }
    if (request === "confirm_clear") return { outcome: "refused", detail: "Ada is in the arena", why: { id: "person_inside", person: "Ada" } };
    const refusal = this.#refusal(request);
    if (refusal !== null) {
      const [why, detail] = refusal;
      this.event("request_refused", `${request}: ${detail}`);
      return { outcome: "refused", detail, why };
    }
    if (request === "reset" && (reason === null || reason === "")) {
      return { outcome: "refused", detail: "a reset needs a reason", why: { id: "reset_needs_reason" } };
    }
    this.event("request_accepted", reason === null ? request : `${request}: ${reason}`);
    this.#stop = null;
    const mode = { home: "homing", arm: "following", disarm: "disarmed", reset: "disarmed" }[request] as Mode;
    this.#enter(mode);
    return { outcome: "accepted", detail: `now ${mode}`, why: { id: "now_in", mode } };
  }

  /** Takes the visitor's headset off and on. */
  changeOrigin(): void {
    this.#awaitsConfirmation = true;
    this.event("origin_changed", "Ada's tracking origin changed");
  }

  /** Sets a prior; the former one, or null for an unknown object. */
  setPrior(id: string, prior: number): number | null {
    const before = this.#priors.get(id);
    if (before === undefined) return null;
    this.#priors.set(id, prior);
    return before;
  }

  /** What other priors would lead to; the ids that are not of the scene instead. */
  preview(priors: Readonly<Record<string, number>>): PriorPreview | { readonly unknown: readonly string[] } {
    const unknown = Object.keys(priors).filter((id) => !this.#priors.has(id));
    if (unknown.length > 0) return { unknown };
    const before = new Map(this.#priors);
    for (const [id, prior] of Object.entries(priors)) this.#priors.set(id, prior);
    const objects = this.#objects();
    this.#priors.clear();
    for (const [id, prior] of before) this.#priors.set(id, prior);
    const best = this.#best(objects);
    const serves = this.#mode === "following";
    return {
      target_m: serves ? best.column_place_m : null,
      serves: serves ? this.#person().id : null,
      committed: serves ? best.id : null,
      planned_path_m: serves ? this.#pathTo(best.column_place_m) : [],
      objects: objects.map(({ id, weight, probability, prior }) => ({ id, weight, probability, prior })),
    };
  }

  /** Reports and keeps an event. */
  event(kind: string, summary: string, detail: unknown = null): void {
    const event = { at_micros: Math.round(this.#atSecs * 1e6), at: new Date().toISOString(), kind, summary, detail };
    this.events.unshift(event);
    this.#told(event);
  }

  /** All of it. */
  snapshot(): Snapshot {
    const objects = this.#objects();
    const person = this.#person();
    const best = this.#best(objects);
    const target = this.#mode === "following" ? this.#target() : null;
    const at = Math.round(this.#atSecs * 1e6);
    const speed = Math.hypot(...this.#velocity);
    const required = 0.62 + 0.3 * speed;
    const rule = (id: string, title: string, [why, reason]: Told, status: Snapshot["rules"][number]["status"] = "clear") => ({
      rule: id,
      title,
      status,
      reason,
      why,
      since_micros: 0,
    });
    const near = this.#distance() < required + 0.3;
    return {
      generation: this.#generation,
      at_micros: at,
      mode: this.#mode,
      mode_since_micros: Math.round(this.#modeSinceSecs * 1e6),
      stop: this.#stop,
      requests: (["home", "arm", "disarm", "stop", "reset", "jog"] as const).map((request) => ({
        request,
        refused_because: request === "stop" ? null : (this.#refusal(request)?.[1] ?? null),
        why: request === "stop" ? null : (this.#refusal(request)?.[0] ?? null),
      })),
      interaction: null,
      contact: null,
      bears: null,
      rules: [
        rule("R1", "travel", [{ id: "inside_travel" }, "inside the travel"]),
        rule("R2", "tracking", [{ id: "headsets_tracked" }, "everybody's headset is tracked"]),
        rule("R3", "separation", near ? this.#inTheWay(required) : [{ id: "nobody_in_the_way" }, "nobody in the way"], near ? "limiting" : "clear"),
        rule("R4", "software stop", this.#stop === null ? [{ id: "stop_not_pressed" }, "not pressed"] : [this.#stop.why, this.#stop.reason], this.#stop === null ? "clear" : "breached"),
        rule("R5", "motor current", [{ id: "motor_current", amps: 1.2, limit_amps: 5 }, "1.2 A against a limit of 5.0 A"]),
        rule("R6", "following error", [{ id: "behind_command", behind_m: 0.004 }, "0.4 cm behind the command"]),
        rule("R7", "plausibility", [{ id: "moves_as_commanded" }, "moves as commanded"]),
        rule("R8", "controller link", [{ id: "controller_answers" }, "the controller answers"]),
        rule("R9", "control loop", [{ id: "steps_in_time" }, "control steps begin in time"]),
        rule("R10", "VR client", [{ id: "headsets_tracked" }, "everybody's headset is tracked"]),
        rule("R13", "keep-out shapes", [{ id: "no_keep_out_in_the_way" }, "no keep-out shape in the way"]),
        this.#awaitsConfirmation
          ? rule("R15", "tracking origin", [{ id: "origin_unconfirmed", person: "Ada" }, "Ada must be confirmed on the floor mark: the tracking origin changed"], "breached")
          : rule("R15", "tracking origin", [{ id: "headsets_tracked" }, "everybody's headset is tracked"]),
        rule("R16", "arena confirmed clear", [{ id: "arena_accounted_for" }, "people are tracked, or the arena was confirmed clear"], "idle"),
      ],
      column: {
        position_m: [...this.#column],
        velocity_mps: [...this.#velocity],
        commanded_m: [this.#column[0] + this.#velocity[0] * 0.05, this.#column[1] + this.#velocity[1] * 0.05],
        proxy_m: [this.#column[0] + this.#velocity[0] * 0.2, this.#column[1] + this.#velocity[1] * 0.2],
        target_m: target,
        serves: this.#mode === "following" ? person.id : null,
        committed: this.#mode === "following" ? best.id : null,
        activity: this.#mode === "following" ? (speed < 0.02 ? "in_place" : "approaching") : this.#mode === "disarmed" ? "released" : this.#mode === "homing" ? "homing" : this.#mode === "ready" ? "ready" : "stopped",
        reason: this.#mode === "following" ? `for Ada, ${best.id}: weight ${best.weight.toFixed(2)}` : "the drive is released",
        decision: this.#mode === "following" ? this.#decision(best) : null,
        arrival_secs: this.#mode === "following" ? best.arrival_secs : null,
        why: this.#mode === "following" ? [{ id: "serves", person: "Ada", object: best.id, weight: best.weight, probability: best.probability }] : [{ id: "drive_released" }],
        planned_path_m: target === null ? [] : this.#pathTo(target),
        jog_speed_mps: this.#mode === "ready" ? 0.24 : null,
        current_amps: [0.8 + speed, 0.6 + speed],
        home_repeatability_m: [0.0003, -0.0001],
        homed: this.#mode !== "faulted",
      },
      persons: [
        {
          ...person,
          distance_m: this.#distance(),
          required_m: required,
          separation: { radius_m: 0.45, reaction_m: 0.05 + 0.05 * speed, braking_m: 0.1 * speed, walking_m: 0.1 + 0.15 * speed, age_m: 0.02, binding: "walking" },
          limits_column: this.#distance() < required + 0.3,
        },
      ],
      objects,
      scenario: null,
      intention_rule: "bayes",
      standing: "in-time",
      motion: "planner",
      none_probability: 0.1,
      control_loop: {
        rate_hz: 250,
        steps: Math.round(this.#atSecs * 250),
        missed_deadlines: 0,
        lateness_p99_micros: 310,
        lateness_max_micros: 1240,
        scheduling: "normal scheduling, memory not locked (control.real_time is false)",
        scheduling_why: [{ id: "real_time_not_asked" }],
      },
      machine_health: null,
      clients: [{ name: "mock visitor", convention: "openxr", poses: this.#generation * 3, pose_rate_hz: 90, rtt_millis: 0.6, persons: [1], pose_age_millis: 12, jitter_millis: 1.4, loss_percent: 0, errors: 0 }],
      scene_id: this.sceneId,
      session_id: 1,
    };
  }

  #latch(reason: string | null): void {
    this.#stop = {
      rule: "R4",
      reason: `software stop: ${reason ?? "no reason given"}`,
      why: { id: "software_stop", said: reason },
      clears_when: "reset, with a reason, once the cause is gone; then arm",
      since_micros: Math.round(this.#atSecs * 1e6),
    };
    this.#enter("latched_stop");
  }

  #enter(mode: Mode): void {
    const from = this.#mode;
    this.#mode = mode;
    this.#modeSinceSecs = this.#atSecs;
    this.event("mode_changed", `${from} to ${mode}`, { from, to: mode, because: "asked" });
  }

  #refusal(request: "home" | "arm" | "disarm" | "reset" | "jog"): Told | null {
    const latched = this.#mode === "latched_stop";
    const resetFirst: Told = [{ id: "reset_first" }, "the machine is stopped: reset first"];
    switch (request) {
      case "home":
        return this.#mode === "disarmed" ? null : latched ? resetFirst : [{ id: "disarm_first" }, "the machine is armed: disarm first"];
      case "arm":
        if (this.#mode === "ready") return null;
        return latched ? resetFirst : this.#mode === "disarmed" ? [{ id: "home_first" }, "not homed: home first"] : [{ id: "armed_already" }, "armed already"];
      case "disarm":
        if (this.#mode === "disarmed") return [{ id: "disarmed_already" }, "disarmed already"];
        return latched ? [{ id: "released_already" }, "the drive is released already; leave the stop by reset"] : null;
      case "reset":
        return latched || this.#mode === "faulted" ? null : [{ id: "nothing_to_reset" }, "nothing to reset"];
      case "jog":
        return this.#mode === "ready" ? null : latched ? resetFirst : [{ id: "disarm_first" }, "the machine is armed: disarm first"];
    }
  }

  #decision(best: ObjectState): Decision {
    return {
      belief: [{ id: "looks_at", person: "Ada", object: best.id, angle_rad: best.angle_rad ?? 0, distance_m: best.distance_m ?? 0 }],
      place: [{ id: "at_object", object: best.id, probability: best.probability }],
      route: [{ id: "straight_on" }],
      arrival: [{ id: "at_its_limits" }],
    };
  }

  #inTheWay(required: number): Told {
    const distance = this.#distance();
    const why: Reason = { id: "person_in_the_way", person: "Ada", distance_m: distance, required_m: required };
    return [why, `slowed or turned for Ada: ${distance.toFixed(2)} m on the way, ${required.toFixed(2)} m needed`];
  }

  #person(): Person {
    const at = this.#atSecs * 0.35;
    const [x, y] = [2 + 1.05 * Math.sin(at), 2 + 0.9 * Math.sin(1.7 * at + 1)];
    const yaw = Math.atan2(0.9 * 1.7 * Math.cos(1.7 * at + 1), 1.05 * Math.cos(at));
    return {
      id: 1,
      name: "Ada",
      head_m: [x, y, 1.68],
      yaw_rad: yaw,
      pitch_rad: -0.2,
      pose_age_secs: 0.012,
      tracked: true,
      awaits_confirmation: this.#awaitsConfirmation,
      separation_radius_m: 0.45,
      distance_m: 0,
      required_m: 0,
      separation: null,
      limits_column: false,
    };
  }

  #distance(): number {
    const head = this.#person().head_m ?? [0, 0, 0];
    return Math.max(0, Math.hypot(head[0] - this.#column[0], head[1] - this.#column[1]) - 0.075);
  }

  #objects(): ObjectState[] {
    const person = this.#person();
    const head = person.head_m ?? [0, 0, 0];
    const rows = this.scene.objects.map((object) => {
      const [dx, dy] = [object.position[0] - head[0], object.position[1] - head[1]];
      const away = Math.hypot(dx, dy);
      const prior = this.#priors.get(object.id) ?? object.prior;
      const looked = Math.exp(Math.cos(Math.atan2(dy, dx) - person.yaw_rad) - 1);
      const offset = this.scene.props?.find((prop) => prop.id === object.prop)?.offset ?? [0, 0];
      const place: [number, number] = [object.position[0] - offset[0], object.position[1] - offset[1]];
      const arrivalSecs = Math.hypot(place[0] - this.#column[0], place[1] - this.#column[1]) / 0.9;
      const touchSecs = Math.max(0, away - 0.6) / 0.7;
      return {
        id: object.id,
        weight: object.enabled ? prior * (0.175 / (1 + away) + 0.825 * looked) : 0,
        probability: 0,
        prior,
        enabled: object.enabled,
        column_place_m: place,
        arrival_secs: arrivalSecs,
        touch_secs: touchSecs,
        late_by_s: arrivalSecs - touchSecs,
        in_time_probability: 1 / (1 + Math.exp((arrivalSecs - touchSecs) / 0.5)),
        angle_rad: Math.abs(Math.atan2(Math.sin(Math.atan2(dy, dx) - person.yaw_rad), Math.cos(Math.atan2(dy, dx) - person.yaw_rad))),
        distance_m: away,
      };
    });
    const sum = rows.reduce((total, row) => total + row.weight, 0);
    return rows.map((row) => ({ ...row, probability: sum > 0 ? (0.9 * row.weight) / sum : 0 }));
  }

  #best(objects: readonly ObjectState[]): ObjectState {
    const [first, ...rest] = objects;
    if (first === undefined) throw new Error("a scene has at least one object");
    return rest.reduce((best, object) => (object.weight > best.weight ? object : best), first);
  }

  #pathTo(target: readonly [number, number]): [number, number][] {
    const [x, y] = this.#column;
    return Array.from({ length: 11 }, (_, step): [number, number] => [x + ((target[0] - x) * step) / 10, y + ((target[1] - y) * step) / 10]);
  }

  #target(): [number, number] {
    return this.#best(this.#objects()).column_place_m;
  }
}
