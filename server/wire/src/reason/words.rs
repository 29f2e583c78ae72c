//! The English sentences.

use std::fmt;

use super::Reason;
use crate::dashboard::Mode;

impl fmt::Display for Reason {
    /// The English sentence.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NothingToWatch => write!(f, "nothing to watch now"),
            Self::InsideTravel => write!(f, "inside the travel"),
            Self::PastTravel { past_m } => {
                write!(f, "the column is {:.1} cm past its travel", past_m * 100.0)
            }
            Self::TravelEndInTheWay => write!(f, "slowed at the end of the travel"),
            Self::HeadsetsTracked => write!(f, "everybody's headset is tracked"),
            Self::ArenaEmpty => write!(f, "nobody is in the arena"),
            Self::NoPoseYet { person, entered_secs } => {
                write!(f, "{person} entered {entered_secs:.2} s ago and has sent no pose yet")
            }
            Self::PoseTooOld { person, age_secs } => {
                write!(f, "the newest pose of {person} is {age_secs:.2} s old")
            }
            Self::HeadsetUntracked { person } => write!(f, "the headset of {person} does not know its place"),
            Self::PoseJumped { person } => {
                write!(f, "the pose of {person} jumped faster than a head can move")
            }
            Self::ClientGone { person } => write!(f, "the VR client of {person} is gone"),
            Self::HeadsetOff { person } => write!(f, "{person} took the headset off"),
            Self::OriginUnconfirmed { person } => {
                write!(f, "{person} must be confirmed on the floor mark: the tracking origin changed")
            }
            Self::NobodyInTheWay => write!(f, "nobody in the way"),
            Self::PersonInTheWay { person, distance_m, required_m } => write!(
                f,
                "slowed or turned for {person}: {distance_m:.2} m on the way, {required_m:.2} m needed"
            ),
            Self::NoKeepOutInTheWay => write!(f, "no keep-out shape in the way"),
            Self::KeepOutInTheWay { keep_out, distance_m, required_m } => write!(
                f,
                "slowed or turned for the keep-out shape {keep_out}: {distance_m:.2} m on the way, {required_m:.2} m needed"
            ),
            Self::StopNotPressed => write!(f, "not pressed"),
            Self::SoftwareStop { said: Some(said) } => write!(f, "software stop: {said}"),
            Self::SoftwareStop { said: None } => write!(f, "software stop, no reason given"),
            Self::LastRunLatched { rule: Some(rule), because: Some(because) } => {
                write!(f, "the last run ended in a latched stop: {rule}: {because}")
            }
            Self::LastRunLatched { rule: Some(rule), because: None } => {
                write!(f, "the last run ended in a latched stop: {rule}")
            }
            Self::LastRunLatched { .. } => write!(f, "the last run ended in a latched stop"),
            Self::StopInput { input } => write!(f, "the stop input {input} is active"),
            Self::InputSilent { input } => {
                write!(f, "the input {input} is silent or garbled, which counts as active")
            }
            Self::MotorCurrent { amps, limit_amps } => {
                write!(f, "{amps:.1} A against a limit of {limit_amps:.1} A")
            }
            Self::BehindCommand { behind_m } => write!(f, "{:.1} cm behind the command", behind_m * 100.0),
            Self::Astray => write!(f, "not where it was commanded to be: held until it rests"),
            Self::AstrayAgain { times } => {
                write!(f, "not where it was commanded to be, {times} times in a row")
            }
            Self::MovesAsCommanded => write!(f, "moves as commanded"),
            Self::MovesOtherwise { difference_mps } => {
                write!(f, "moves {difference_mps:.2} m/s otherwise than commanded")
            }
            Self::DoesNotMove => write!(f, "commanded and does not move"),
            Self::NoSwitchFound => write!(f, "homing found no switch"),
            Self::HomeLost => write!(f, "the machine has lost its home"),
            Self::NoAnswerYet => write!(f, "the machine has not answered yet"),
            Self::MachineTrouble { trouble } => write!(f, "{trouble}"),
            Self::NoGoodAnswer { silent_millis } => write!(f, "no good answer for {silent_millis} ms"),
            Self::ControllerAnswers => write!(f, "the controller answers"),
            Self::StepsInTime => write!(f, "control steps begin in time"),
            Self::StepsLate { steps } => write!(f, "{steps} control steps in a row began late"),
            Self::GameMasterNotNeeded => {
                write!(f, "this machine is armed without a game master's dashboard too")
            }
            Self::GameMasterPresent => write!(f, "a game master's dashboard is connected"),
            Self::GameMasterAbsent => {
                write!(f, "no game master's dashboard is connected, and arming needs one")
            }
            Self::NoIntruderInput => write!(f, "no intruder input is set up"),
            Self::NoIntruder => write!(f, "no intruder"),
            Self::Intruder { input } => {
                write!(f, "the input {input} notices somebody whom nobody tracks")
            }
            Self::ArenaAccountedFor => write!(f, "people are tracked, or the arena was confirmed clear"),
            Self::ArenaUnconfirmed => write!(
                f,
                "nobody is tracked and nobody has confirmed that the arena is clear: no motion by itself"
            ),
            Self::CalibrationOutdated { client, version, part, was, is } => write!(
                f,
                "calibration {version} of {client} was made on other hardware: the {} was {was} and is {is}; calibrate anew",
                part.in_words()
            ),
            Self::BadCalibration { refusal } => write!(f, "{refusal}"),
            Self::InteractionGoesOn { interaction, object } => write!(
                f,
                "the interaction {interaction} at {object} is under way: no other scene until it is over, or the machine is disarmed"
            ),
            Self::TouchGoesOn { person, object } => write!(
                f,
                "{person} touches {object}, and the machine is armed: no other scene until the hand is gone, or the machine is disarmed"
            ),
            Self::NotWhileItMoves => {
                write!(f, "not while the machine is armed, finds its switches or is moved by hand")
            }
            Self::NoCalibrationDraft => write!(f, "no calibration is in the making: begin one first"),
            Self::NoCalibrationPoint { point } => {
                write!(f, "the calibration in the making has no point {point}")
            }
            Self::PointBeingTaken => write!(f, "another point is being taken: wait for it"),
            Self::ClientNotThere { client } => {
                write!(f, "no client {client} is connected by itself with one person at most")
            }
            Self::NoPointer { client } => {
                write!(f, "the client {client} sends no position of that hand")
            }
            Self::ClientNotCalibrated { client } => {
                write!(f, "the client {client} has no calibration in force: calibrate its room first")
            }
            Self::NoProp { prop } => write!(f, "the active scene has no prop {prop}"),
            Self::NoCalibration { calibration } => write!(f, "there is no calibration {calibration}"),
            Self::Asked { request } => write!(f, "{request}"),
            Self::ResetAsked { said } => write!(f, "reset: {said}"),
            Self::HomingDone => write!(f, "homed"),
            Self::ProtectiveStopOver => write!(f, "the cause of the protective stop is gone"),
            Self::NowIn { mode } => write!(f, "now {}", in_words(*mode)),
            Self::Stopped => write!(f, "stopped"),
            Self::StoppedAlready => write!(f, "stopped already; the stop is latched"),
            Self::HomingAlready => write!(f, "homing already"),
            Self::DisarmFirst => write!(f, "the machine is armed: disarm first"),
            Self::ResetFirst => write!(f, "the machine is stopped: reset first"),
            Self::HomeFirst => write!(f, "not homed: home first"),
            Self::WaitForHoming => write!(f, "homing: wait until it is done"),
            Self::WaitForRest => write!(f, "the column still moves: wait until it rests"),
            Self::ArmedAlready => write!(f, "armed already"),
            Self::ArmedInProtectiveStop => write!(f, "armed already; the protective stop clears by itself"),
            Self::DisarmedAlready => write!(f, "disarmed already"),
            Self::ReleasedAlready => write!(f, "the drive is released already; leave the stop by reset"),
            Self::CauseStillThere { rule, because } => {
                write!(f, "the cause is still there: {rule}: {because}")
            }
            Self::ClearsByItself => write!(f, "a protective stop clears by itself when its cause is gone"),
            Self::NothingToReset => write!(f, "nothing to reset"),
            Self::ResetNeedsReason => write!(f, "a reset needs a reason"),
            Self::HomingNearKeepOut { keep_out, required_m } => {
                write!(f, "homing would come within {required_m:.2} m of the keep-out shape {keep_out}")
            }
            Self::PersonNotInside { person } => write!(f, "{person} is not in the arena"),
            Self::OriginConfirmedAlready { person } => {
                write!(f, "{person} is confirmed on the floor mark already")
            }
            Self::OriginConfirmed { person } => write!(f, "{person} is confirmed on the floor mark"),
            Self::PersonStillTracked { person } => {
                write!(f, "the headset of {person} is tracked: they are in the arena")
            }
            Self::PersonLeft { person } => write!(f, "{person} has left"),
            Self::NoSuchObject { index, objects } => write!(f, "object {index} of {objects} objects"),
            Self::PriorOutOfRange { index, prior } => {
                write!(f, "prior {prior:.2} of object {index}: expected 0 to 1")
            }
            Self::PriorsSet { count } => write!(f, "{count} priors set"),
            Self::ColumnInKeepOut { keep_out, required_m } => write!(
                f,
                "the column stands within {required_m:.2} m of the keep-out shape {keep_out}: move it away first"
            ),
            Self::SceneActivated => write!(f, "the scene is active"),
            Self::NoScenario => write!(f, "the active scene has no scenario"),
            Self::ScenarioStands => {
                write!(f, "the scenario stands: it runs while the machine follows people")
            }
            Self::NoSuchCue { cue, known } if known.is_empty() => {
                write!(f, "there is no cue {cue}: this scenario has none")
            }
            Self::NoSuchCue { cue, known } => {
                write!(f, "there is no cue {cue} in this scenario; it knows {}", known.join(", "))
            }
            Self::NotAwaited { name, state } => {
                write!(f, "nothing waits for {name} in the state {state} now")
            }
            Self::NoSuchState { state } => write!(f, "there is no state {state} in this scenario"),
            Self::NothingBefore => {
                write!(f, "this is the first state of the run: there is nothing to go back to")
            }
            Self::NowInState { state } => write!(f, "the scenario is in the state {state}"),
            Self::Interacts { interaction, phase, object, person } => {
                write!(f, "{} at {object}: {}", interaction.replace('_', " "), phase.replace('_', " "))?;
                person.as_ref().map_or(Ok(()), |person| write!(f, ", {person}"))
            }
            Self::ContactNotArmed => write!(f, "no contact is armed"),
            Self::ContactArmed { person } => {
                write!(f, "armed for {person}: a moving column may touch them, within its limits")
            }
            Self::InContact { person, interaction } => {
                write!(f, "in contact with {person}: {}", interaction.replace('_', " "))
            }
            Self::NoContactInteraction => {
                write!(f, "the active scene has no interaction in which a moving column touches somebody")
            }
            Self::ContactSecs { least, most } => {
                write!(f, "a contact is armed for {least:.0} to {most:.0} s")
            }
            Self::ContactForAnother { person } => write!(f, "armed for {person} instead"),
            Self::ContactTakenBack => write!(f, "taken back"),
            Self::ContactTimeOver => write!(f, "its time is over"),
            Self::PersonNotTracked { person } => write!(f, "the headset of {person} is not tracked"),
            Self::InteractionLetGo => write!(f, "let go"),
            Self::SteppedOff => write!(f, "not on the seat any more"),
            Self::AnotherIsMeant => write!(f, "another object is meant"),
            Self::StateLeft => write!(f, "the scenario went on"),
            Self::InteractionStopped { mode } => write!(f, "now {}", in_words(*mode)),
            Self::NobodyLeans => write!(f, "nobody leans on the column or rides it, somebody looked"),
            Self::SkipNeedsReason => write!(f, "to skip or to go back needs a reason"),
            Self::Busy => write!(f, "busy: the control loop's queue is full; try again"),
            Self::ControlNotRunning => write!(f, "the control loop is not running"),
            Self::DriveSilent { within_millis } => {
                write!(f, "no acknowledgement from the drive within {within_millis} ms; use the wired stop")
            }
            Self::DatabaseSilent => write!(f, "the database did not answer; the server's log says why"),
            Self::PreviewUnfinished => write!(f, "the preview was not finished"),
            Self::NoScene { scene } => write!(f, "there is no scene {scene}"),
            Self::NoSceneVersion { scene, version } => {
                write!(f, "there is no version {version} of scene {scene}")
            }
            Self::NoSession { session } => write!(f, "there is no session \"{session}\""),
            Self::DriveReleased => write!(f, "the drive is released"),
            Self::LooksForSwitches => write!(f, "looks for its switches at creep speed"),
            Self::HoldsUnarmed => write!(f, "homed and holding; it follows nobody until it is armed"),
            Self::StoppedBy { rule } => write!(f, "stopped by {rule}"),
            Self::WaitsForPose { person } => write!(f, "holds until {person} sends a first pose"),
            Self::NoHeadsetTracked => write!(f, "nobody's headset is tracked"),
            Self::EveryPriorZero => write!(f, "no enabled object has a weight: every prior is 0"),
            Self::Serves { person: Some(person), object, weight, .. } => {
                write!(f, "for {person}, {object}: weight {weight:.2}")
            }
            Self::Serves { person: None, object, weight, .. } => write!(f, "{object}: weight {weight:.2}"),
            Self::NextInLine { object, weight, .. } => write!(f, "next {object} {weight:.2}"),
            Self::Undecided { person, object, weight, other, other_weight } => {
                if let Some(person) = person {
                    write!(f, "for {person}, ")?;
                }
                write!(f, "undecided between {object} {weight:.2} and {other} {other_weight:.2}")
            }
            Self::NotCommissioned => {
                write!(f, "this machine was not commissioned: run covr commission, which measures its brake")
            }
            Self::CommissioningOutdated { part, was, is } => write!(
                f,
                "this machine was commissioned as another: its {} was {was} and is {is}; run covr commission again",
                part.in_words()
            ),
            Self::CommissioningUnfinished { step } => {
                write!(f, "the checklist is not done: {} is missing", step.in_words())
            }
            Self::NoBrakeRun { axis, positive, needed_mps } => write!(
                f,
                "no stop from {needed_mps:.2} m/s was measured {} the home corner along {}",
                if *positive { "away from" } else { "towards" },
                axis.name()
            ),
            Self::BrakesWorse { axis, measured_mps2, needed_mps2 } => write!(
                f,
                "along {} the brake does {measured_mps2:.2} m/s2, and its limits say {needed_mps2:.2} m/s2",
                axis.name()
            ),
            Self::BrakesLonger { axis, distance_m, allowed_m } => write!(
                f,
                "along {} a stop took {distance_m:.3} m, and {allowed_m:.3} m are allowed for",
                axis.name()
            ),
            Self::PersonInside { person } => write!(f, "{person} is in the arena"),
            Self::ArenaConfirmedClear => write!(f, "the arena is clear, somebody looked"),
            Self::JogsWhileHeld => write!(f, "moves by hand while the button is held"),
            Self::NoJogOrder { fastest_mps } => {
                write!(f, "a jog needs a way or a place, and a speed above 0 and up to {fastest_mps:.2} m/s")
            }
            Self::JogOutsideTravel => write!(f, "that place is outside the travel"),
            Self::JogLetGo => write!(f, "let go"),
            Self::JogSilent => write!(f, "the button's word stayed away"),
            Self::JogNotYet => {
                write!(f, "not yet: a rule asked for a stop less than a second ago, or it is only just ready")
            }
            Self::JogOver { mode } => write!(f, "now {}", in_words(*mode)),
            Self::JogHeldBy { author } => write!(f, "{author} moves the column now"),
            Self::NoObject => write!(f, "no object"),
            Self::ToGo { left_m, speed_mps } => write!(f, "{left_m:.2} m to go at {speed_mps:.2} m/s"),
            Self::HeldShort { left_m } => write!(f, "held {left_m:.2} m short"),
            Self::GoesAround => write!(f, "around somebody in the way"),
            Self::StandsThere => write!(f, "stands there"),
            Self::LooksAt { person, object, angle_rad, distance_m } => {
                let degrees = angle_rad.to_degrees();
                if degrees < 0.5 {
                    write!(f, "{person} looks at {object}, {distance_m:.2} m away")
                } else {
                    write!(f, "{person} looks {degrees:.0}° beside {object}, {distance_m:.2} m away")
                }
            }
            Self::NonePlain { person, probability } => {
                write!(f, "most likely none of them ({:.0} %): {person} looks around", probability * 100.0)
            }
            Self::AtObject { object, probability } => {
                write!(f, "at {object}, the most probable ({:.0} %)", probability * 100.0)
            }
            Self::AtAnother { object } => write!(f, "at {object}: from there more can be reached in time"),
            Self::Between { object, other } => {
                write!(f, "between {object} and {other}: from there either can be reached in time")
            }
            Self::AtMean => write!(f, "the mean of the objects' places, weighted by the belief"),
            Self::AmongObjects => write!(f, "among several objects: from there most can be reached in time"),
            Self::StraightOn => write!(f, "straight, nobody in the way"),
            Self::AtItsLimits => write!(f, "as soon as its limits allow"),
            Self::PeopleCost { secs } => write!(f, "people on the way and a soft start cost {secs:.1} s"),
            Self::NotForeseen => write!(f, "later than it plans ahead"),
            Self::RealTimeNotAsked => {
                write!(f, "normal scheduling, memory not locked (control.real_time is false)")
            }
            Self::RealTime { priority } => write!(f, "SCHED_FIFO priority {priority}"),
            Self::RealTimeRefused { said } => {
                write!(f, "normal scheduling (SCHED_FIFO not permitted: {said})")
            }
            Self::MemoryLocked => write!(f, "memory locked"),
            Self::MemoryLockedForNow => {
                write!(f, "present memory locked, future memory not (RLIMIT_MEMLOCK is limited)")
            }
            Self::MemoryNotLocked { said } => write!(f, "memory not locked ({said})"),
        }
    }
}

/// A mode as people say it.
pub(crate) fn in_words(mode: Mode) -> &'static str {
    match mode {
        Mode::Disarmed => "disarmed",
        Mode::Homing => "homing",
        Mode::Ready => "ready",
        Mode::Following => "following",
        Mode::ProtectiveStop => "protective stop",
        Mode::LatchedStop => "latched stop",
        Mode::Faulted => "faulted",
    }
}
