/** Reasons: why a rule stands as it does, why the column does what it does, why a request was answered so. */
import type { CommissioningStep, HardwarePart, MachineTrouble } from "../../api/types";
import { AT_RAD, CENTIMETRES_FOR_METRES, METRES_FOR_CENTIMETRES, refusalSentence, type ReasonSentences, type RefusalSentences } from "../reasons";

/** What keeps a machine from being driven. */
export const troubles: Record<MachineTrouble, string> = {
  no_port: "the port of the motor controller cannot be opened",
  no_answer: "the motor controller does not answer",
  unknown_firmware: "the motor controller has a firmware that is not known here",
  not_configured: "the motor controller does not keep a setting",
  switch_off_and_on: "settings of the motor controller come into force when its power is switched off and on",
  restarted: "the motor controller has restarted, or its counts jumped: the place is lost",
  emergency_stop: "the wired emergency stop is active",
  driver_fault: "a bridge of the motor controller is broken",
  too_hot: "the motor controller is too hot",
  bad_supply: "a supply of the motor controller is too high or too low",
};

/** What of the hardware a calibration hangs on. */
export const hardwareParts: Record<HardwarePart, string> = {
  machine: "machine",
  travel: "travel",
  controller: "motor controller",
  firmware: "controller's firmware",
  encoders: "encoders' counts a metre",
  convention: "client's convention",
};

/** Why points make no calibration; the same sentences as the server's own. */
export const refusals: RefusalSentences = {
  too_few_points: ({ found, fewest }) => `${found} points are too few: at least ${fewest} are needed`,
  too_many_points: ({ found, most }) => `${found} points are more than the ${most} that are taken`,
  points_too_close: ({ spread_m, least_m }, number) =>
    `the points are too close together: they spread ${number(spread_m, 2)} m, at least ${number(least_m, 2)} m is needed; use the whole arena`,
  points_on_a_line: ({ spread_m, least_m }, number) =>
    `the points lie nearly on one line: they spread ${number(spread_m, 2)} m across it, at least ${number(least_m, 2)} m is needed`,
  wrong_scale: ({ scale, most_off }, number) => {
    const is = `a metre of the headset is ${number(scale, 3)} m in the room; `;
    if (scale >= CENTIMETRES_FOR_METRES[0] && scale < CENTIMETRES_FOR_METRES[1]) return `${is}the client seems to send centimetres under a convention of metres`;
    if (scale >= METRES_FOR_CENTIMETRES[0] && scale < METRES_FOR_CENTIMETRES[1]) return `${is}the client seems to send metres under a convention of centimetres`;
    return `${is}it may be off 1 by ${number(most_off * 100, 0)} % at most: the client's unit, or the places that were entered, are wrong`;
  },
  mirrored: () => "the points fit only in a mirror or upside down: the client declares a convention whose axes are not its own",
  too_many_outliers: ({ outliers, points, most }) =>
    `${outliers} of ${points} points disagree with the others, at most ${most} may: were places mixed up?`,
  poor_fit: ({ rms_m, most_m }, number) =>
    `the points are ${number(rms_m * 1e3, 1)} mm off on average, at most ${number(most_m * 1e3, 1)} mm is good enough: were places mixed up, or did the tracking jump?`,
  tilted: ({ tilt_rad, most_rad }, number) =>
    `the headset's upward axis is ${number(degrees(tilt_rad), 1)} degrees off the room's, at most ${number(degrees(most_rad), 1)} is believed: are the heights right?`,
  uncertain: ({ uncertainty_m, most_m }, number) =>
    `the result would be uncertain by ${number(uncertainty_m * 1e3, 1)} mm, at most ${number(most_m * 1e3, 1)} mm is good enough: take more points, further apart`,
  moved: ({ moved_m, most_m }, number) =>
    `it moved by ${number(moved_m * 1e3, 1)} mm while it was being measured, at most ${number(most_m * 1e3, 1)} mm is still: hold it still or put it down`,
  too_few_poses: ({ found, fewest }) => `${found} poses came in that time, at least ${fewest} are needed: is the headset awake?`,
  not_tracked: () => "the headset did not know its place all the time",
  offset_unknown: ({ found, fewest }) =>
    `where the headset sits on the column is not known: enter it, or touch at least ${fewest} places with the same headset (${found} so far)`,
  column_moved: ({ moved_m, most_m }, number) =>
    `the column moved by ${number(moved_m * 1e3, 1)} mm while the point was taken, at most ${number(most_m * 1e3, 1)} mm is at rest`,
};

/** The steps of the commissioning's checklist. */
const commissioningSteps: Record<CommissioningStep, string> = {
  wired_stop: "the wired stop",
  arena_clear: "the look into the arena",
  link: "the link",
  home: "homing",
  directions: "the directions of the axes",
  stop_lanes: "the software stop",
  brake: "the brake",
};

const spaced = (name: string): string => name.replaceAll("_", " ");

/** By the id that the server sends; the same sentences as the server's own. */
export const reasons: ReasonSentences = {
  nothing_to_watch: () => "nothing to watch now",
  inside_travel: () => "inside the travel",
  past_travel: ({ past_m }, { number }) => `the column is ${number(past_m * 100, 1)} cm past its travel`,
  travel_end_in_the_way: () => "slowed at the end of the travel",
  headsets_tracked: () => "everybody's headset is tracked",
  arena_empty: () => "nobody is in the arena",
  no_pose_yet: ({ person, entered_secs }, { number }) => `${person} entered ${number(entered_secs, 2)} s ago and has sent no pose yet`,
  pose_too_old: ({ person, age_secs }, { number }) => `the newest pose of ${person} is ${number(age_secs, 2)} s old`,
  headset_untracked: ({ person }) => `the headset of ${person} does not know its place`,
  pose_jumped: ({ person }) => `the pose of ${person} jumped faster than a head can move`,
  client_gone: ({ person }) => `the VR client of ${person} is gone`,
  headset_off: ({ person }) => `${person} took the headset off`,
  origin_unconfirmed: ({ person }) => `${person} must be confirmed on the floor mark: the tracking origin changed`,
  nobody_in_the_way: () => "nobody in the way",
  person_in_the_way: ({ person, distance_m, required_m }, { number }) =>
    `slowed or turned for ${person}: ${number(distance_m, 2)} m on the way, ${number(required_m, 2)} m needed`,
  no_keep_out_in_the_way: () => "no keep-out shape in the way",
  keep_out_in_the_way: ({ keep_out, distance_m, required_m }, { number }) =>
    `slowed or turned for the keep-out shape ${keep_out}: ${number(distance_m, 2)} m on the way, ${number(required_m, 2)} m needed`,
  stop_not_pressed: () => "not pressed",
  software_stop: ({ said }) => (said === null ? "software stop, no reason given" : `software stop: ${said}`),
  last_run_latched: ({ rule, because }, { reason }) =>
    ["the last run ended in a latched stop", rule, because === null ? null : reason(because)].filter((part) => part !== null).join(": "),
  stop_input: ({ input }) => `the stop input ${input} is active`,
  input_silent: ({ input }) => `the input ${input} is silent or garbled, which counts as active`,
  motor_current: ({ amps, limit_amps }, { number }) => `${number(amps, 1)} A against a limit of ${number(limit_amps, 1)} A`,
  behind_command: ({ behind_m }, { number }) => `${number(behind_m * 100, 1)} cm behind the command`,
  astray: () => "not where it was commanded to be: held until it rests",
  astray_again: ({ times }) => `not where it was commanded to be, ${times} times in a row`,
  moves_as_commanded: () => "moves as commanded",
  moves_otherwise: ({ difference_mps }, { number }) => `moves ${number(difference_mps, 2)} m/s otherwise than commanded`,
  does_not_move: () => "commanded and does not move",
  no_switch_found: () => "homing found no switch",
  home_lost: () => "the machine has lost its home",
  no_answer_yet: () => "the machine has not answered yet",
  machine_trouble: ({ trouble }) => troubles[trouble],
  no_good_answer: ({ silent_millis }) => `no good answer for ${silent_millis} ms`,
  controller_answers: () => "the controller answers",
  steps_in_time: () => "control steps begin in time",
  steps_late: ({ steps }) => `${steps} control steps in a row began late`,
  game_master_not_needed: () => "this machine is armed without a game master's dashboard too",
  game_master_present: () => "a game master's dashboard is connected",
  game_master_absent: () => "no game master's dashboard is connected, and arming needs one",
  no_intruder_input: () => "no intruder input is set up",
  no_intruder: () => "no intruder",
  intruder: ({ input }) => `the input ${input} notices somebody whom nobody tracks`,
  arena_accounted_for: () => "people are tracked, or the arena was confirmed clear",
  arena_unconfirmed: () => "nobody is tracked and nobody has confirmed that the arena is clear: no motion by itself",
  calibration_outdated: ({ client, version, part, was, is }) =>
    `calibration ${version} of ${client} was made on other hardware: the ${hardwareParts[part]} was ${was} and is ${is}; calibrate anew`,
  bad_calibration: ({ refusal }, { number }) => refusalSentence(refusals, refusal, number),
  interaction_goes_on: ({ interaction, object }, { object: label }) => `the interaction ${interaction} at ${label(object)} is under way: no other scene until it is over, or the machine is disarmed`,
  touch_goes_on: ({ person, object }, { object: label }) => `${person} touches ${label(object)}, and the machine is armed: no other scene until the hand is gone, or the machine is disarmed`,
  not_while_it_moves: () => "not while the machine is armed, finds its switches or is moved by hand",
  no_calibration_draft: () => "no calibration is in the making: begin one first",
  no_calibration_point: ({ point }) => `the calibration in the making has no point ${point}`,
  point_being_taken: () => "another point is being taken: wait for it",
  client_not_there: ({ client }) => `no client ${client} is connected by itself with one person at most`,
  no_pointer: ({ client }) => `the client ${client} sends no position of that hand`,
  client_not_calibrated: ({ client }) => `the client ${client} has no calibration in force: calibrate its room first`,
  no_prop: ({ prop }) => `the active scene has no prop ${prop}`,
  no_calibration: ({ calibration }) => `there is no calibration ${calibration}`,
  asked: ({ request }, say) => say.request(request),
  reset_asked: ({ said }) => `reset: ${said}`,
  homing_done: () => "homed",
  protective_stop_over: () => "the cause of the protective stop is gone",
  now_in: ({ mode }, say) => `now ${say.mode(mode)}`,
  stopped: () => "stopped",
  stopped_already: () => "stopped already; the stop is latched",
  homing_already: () => "homing already",
  disarm_first: () => "the machine is armed: disarm first",
  reset_first: () => "the machine is stopped: reset first",
  home_first: () => "not homed: home first",
  wait_for_homing: () => "homing: wait until it is done",
  wait_for_rest: () => "the column still moves: wait until it rests",
  armed_already: () => "armed already",
  armed_in_protective_stop: () => "armed already; the protective stop clears by itself",
  disarmed_already: () => "disarmed already",
  released_already: () => "the drive is released already; leave the stop by reset",
  cause_still_there: ({ rule, because }, { reason }) => `the cause is still there: ${rule}: ${reason(because)}`,
  clears_by_itself: () => "a protective stop clears by itself when its cause is gone",
  nothing_to_reset: () => "nothing to reset",
  reset_needs_reason: () => "a reset needs a reason",
  homing_near_keep_out: ({ keep_out, required_m }, { number }) =>
    `homing would come within ${number(required_m, 2)} m of the keep-out shape ${keep_out}`,
  person_not_inside: ({ person }) => `${person} is not in the arena`,
  origin_confirmed_already: ({ person }) => `${person} is confirmed on the floor mark already`,
  origin_confirmed: ({ person }) => `${person} is confirmed on the floor mark`,
  person_still_tracked: ({ person }) => `the headset of ${person} is tracked: they are in the arena`,
  person_left: ({ person }) => `${person} has left`,
  no_such_object: ({ index, objects }) => `object ${index} of ${objects} objects`,
  prior_out_of_range: ({ index, prior }, { number }) => `prior ${number(prior, 2)} of object ${index}: expected 0 to 1`,
  priors_set: ({ count }) => `${count} priors set`,
  column_in_keep_out: ({ keep_out, required_m }, { number }) =>
    `the column stands within ${number(required_m, 2)} m of the keep-out shape ${keep_out}: move it away first`,
  scene_activated: () => "the scene is active",
  no_scenario: () => "the active scene has no scenario",
  scenario_stands: () => "the scenario stands: it runs while the machine follows people",
  no_such_cue: ({ cue, known }) =>
    known.length === 0 ? `there is no cue ${cue}: this scenario has none` : `there is no cue ${cue} in this scenario; it knows ${known.join(", ")}`,
  not_awaited: ({ name, state }) => `nothing waits for ${name} in the state ${state} now`,
  no_such_state: ({ state }) => `there is no state ${state} in this scenario`,
  nothing_before: () => "this is the first state of the run: there is nothing to go back to",
  now_in_state: ({ state }) => `the scenario is in the state ${state}`,
  interacts: ({ interaction, phase, object, person }, { object: label }) =>
    `${spaced(interaction)} at ${label(object)}: ${spaced(phase)}${person === null ? "" : `, ${person}`}`,
  contact_not_armed: () => "no contact is armed",
  contact_armed: ({ person }) => `armed for ${person}: a moving column may touch them, within its limits`,
  in_contact: ({ person, interaction }) => `in contact with ${person}: ${spaced(interaction)}`,
  no_contact_interaction: () => "the active scene has no interaction in which a moving column touches somebody",
  contact_secs: ({ least, most }, { number }) => `a contact is armed for ${number(least, 0)} to ${number(most, 0)} s`,
  contact_for_another: ({ person }) => `armed for ${person} instead`,
  contact_taken_back: () => "taken back",
  contact_time_over: () => "its time is over",
  person_not_tracked: ({ person }) => `the headset of ${person} is not tracked`,
  interaction_let_go: () => "let go",
  stepped_off: () => "not on the seat any more",
  another_is_meant: () => "another object is meant",
  state_left: () => "the scenario went on",
  interaction_stopped: ({ mode }, say) => `now ${say.mode(mode)}`,
  nobody_leans: () => "nobody leans on the column or rides it, somebody looked",
  skip_needs_reason: () => "to skip or to go back needs a reason",
  busy: () => "busy: the control loop's queue is full; try again",
  control_not_running: () => "the control loop is not running",
  drive_silent: ({ within_millis }) => `no acknowledgement from the drive within ${within_millis} ms; use the wired stop`,
  database_silent: () => "the database did not answer; the server's log says why",
  preview_unfinished: () => "the preview was not finished",
  no_scene: ({ scene }) => `there is no scene ${scene}`,
  no_scene_version: ({ scene, version }) => `there is no version ${version} of scene ${scene}`,
  no_session: ({ session }) => `there is no session "${session}"`,
  drive_released: () => "the drive is released",
  looks_for_switches: () => "looks for its switches at creep speed",
  holds_unarmed: () => "homed and holding; it follows nobody until it is armed",
  stopped_by: ({ rule }) => `stopped by ${rule}`,
  waits_for_pose: ({ person }) => `holds until ${person} sends a first pose`,
  no_headset_tracked: () => "nobody's headset is tracked",
  every_prior_zero: () => "no enabled object has a weight: every prior is 0",
  serves: ({ person, object, weight }, { number, object: label }) =>
    `${person === null ? "" : `for ${person}, `}${label(object)}: weight ${number(weight, 2)}`,
  next_in_line: ({ object, weight }, { number, object: label }) => `next ${label(object)} ${number(weight, 2)}`,
  undecided: ({ person, object, weight, other, other_weight }, { number, object: label }) =>
    `${person === null ? "" : `for ${person}, `}undecided between ${label(object)} ${number(weight, 2)} and ${label(other)} ${number(other_weight, 2)}`,
  not_commissioned: () => "this machine was not commissioned: run covr commission, which measures its brake",
  commissioning_outdated: ({ part, was, is }) => `this machine was commissioned as another: its ${hardwareParts[part]} was ${was} and is ${is}; run covr commission again`,
  commissioning_unfinished: ({ step }) => `the checklist is not done: ${commissioningSteps[step]} is missing`,
  no_brake_run: ({ axis, positive, needed_mps }, { number }) =>
    `no stop from ${number(needed_mps, 2)} m/s was measured ${positive ? "away from" : "towards"} the home corner along ${axis}`,
  brakes_worse: ({ axis, measured_mps2, needed_mps2 }, { number }) =>
    `along ${axis} the brake does ${number(measured_mps2, 2)} m/s2, and its limits say ${number(needed_mps2, 2)} m/s2`,
  brakes_longer: ({ axis, distance_m, allowed_m }, { number }) =>
    `along ${axis} a stop took ${number(distance_m, 3)} m, and ${number(allowed_m, 3)} m are allowed for`,
  person_inside: ({ person }) => `${person} is in the arena`,
  arena_confirmed_clear: () => "the arena is clear, somebody looked",
  jogs_while_held: () => "moves by hand while the button is held",
  no_jog_order: ({ fastest_mps }, { number }) =>
    `a jog needs a way or a place, and a speed above 0 and up to ${number(fastest_mps, 2)} m/s`,
  jog_outside_travel: () => "that place is outside the travel",
  jog_let_go: () => "let go",
  jog_silent: () => "the button's word stayed away",
  jog_not_yet: () => "not yet: a rule asked for a stop less than a second ago, or it is only just ready",
  jog_over: ({ mode }, say) => `now ${say.mode(mode)}`,
  jog_held_by: ({ author }) => `${author} moves the column now`,
  no_object: () => "no object",
  to_go: ({ left_m, speed_mps }, { number }) => `${number(left_m, 2)} m to go at ${number(speed_mps, 2)} m/s`,
  held_short: ({ left_m }, { number }) => `held ${number(left_m, 2)} m short`,
  goes_around: () => "around somebody in the way",
  stands_there: () => "stands there",
  looks_at: ({ person, object, angle_rad, distance_m }, { number, object: label }) =>
    `${person} looks ${angle_rad < AT_RAD ? "at" : `${number((angle_rad * 180) / Math.PI, 0)}° beside`} ${label(object)}, ${number(distance_m, 2)} m away`,
  none_plain: ({ person, probability }, { number }) => `most likely none of them (${number(probability * 100, 0)} %): ${person} looks around`,
  at_object: ({ object, probability }, { number, object: label }) => `at ${label(object)}, the most probable (${number(probability * 100, 0)} %)`,
  at_another: ({ object }, { object: label }) => `at ${label(object)}: from there more can be reached in time`,
  between: ({ object, other }, { object: label }) => `between ${label(object)} and ${label(other)}: from there either can be reached in time`,
  at_mean: () => "the mean of the objects' places, weighted by the belief",
  among_objects: () => "among several objects: from there most can be reached in time",
  straight_on: () => "straight, nobody in the way",
  at_its_limits: () => "as soon as its limits allow",
  people_cost: ({ secs }, { number }) => `people on the way and a soft start cost ${number(secs, 1)} s`,
  not_foreseen: () => "later than it plans ahead",
  real_time_not_asked: () => "normal scheduling, memory not locked (control.real_time is false)",
  real_time: ({ priority }) => `SCHED_FIFO priority ${priority}`,
  real_time_refused: ({ said }) => `normal scheduling (SCHED_FIFO not permitted: ${said})`,
  memory_locked: () => "memory locked",
  memory_locked_for_now: () => "present memory locked, future memory not (RLIMIT_MEMLOCK is limited)",
  memory_not_locked: ({ said }) => `memory not locked (${said})`,
};

function degrees(rad: number): number {
  return (rad * 180) / Math.PI;
}
