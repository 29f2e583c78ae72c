//! From the engine's reasons to the wire's: persons get their names.

use std::collections::BTreeMap;

use covr_engine::observation::PersonId;
use covr_engine::reason::Reason as Engine;

use super::{Reason, latched};
use crate::dashboard::{name_of, request_name};

impl Reason {
    /// The engine's reason, with what the clients call the persons.
    pub fn new(reason: &Engine, names: &BTreeMap<PersonId, String>) -> Self {
        let name = |person: &PersonId| name_of(*person, names);
        match reason {
            Engine::NothingToWatch => Self::NothingToWatch,
            Engine::InsideTravel => Self::InsideTravel,
            Engine::PastTravel(past_m) => Self::PastTravel { past_m: *past_m },
            Engine::TravelEndInTheWay => Self::TravelEndInTheWay,
            Engine::HeadsetsTracked => Self::HeadsetsTracked,
            Engine::ArenaEmpty => Self::ArenaEmpty,
            Engine::NoPoseYet(person, secs) => Self::NoPoseYet { person: name(person), entered_secs: *secs },
            Engine::PoseTooOld(person, secs) => Self::PoseTooOld { person: name(person), age_secs: *secs },
            Engine::HeadsetUntracked(person) => Self::HeadsetUntracked { person: name(person) },
            Engine::PoseJumped(person) => Self::PoseJumped { person: name(person) },
            Engine::ClientGone(person) => Self::ClientGone { person: name(person) },
            Engine::HeadsetOff(person) => Self::HeadsetOff { person: name(person) },
            Engine::OriginUnconfirmed(person) => Self::OriginUnconfirmed { person: name(person) },
            Engine::NobodyInTheWay => Self::NobodyInTheWay,
            Engine::PersonInTheWay { person, distance_m, required_m } => Self::PersonInTheWay {
                person: name(person),
                distance_m: *distance_m,
                required_m: *required_m,
            },
            Engine::NoKeepOutInTheWay => Self::NoKeepOutInTheWay,
            Engine::KeepOutInTheWay { keep_out, distance_m, required_m } => Self::KeepOutInTheWay {
                keep_out: (keep_out + 1).to_string(),
                distance_m: *distance_m,
                required_m: *required_m,
            },
            Engine::StopNotPressed => Self::StopNotPressed,
            Engine::SoftwareStop(said) => {
                Self::SoftwareStop { said: Some(said.clone()).filter(|said| !said.is_empty()) }
            }
            Engine::LastRunLatched(record) => latched::last_run(record),
            Engine::StopInput(input) => Self::StopInput { input: input.to_string() },
            Engine::InputSilent(input) => Self::InputSilent { input: input.to_string() },
            Engine::MotorCurrent { amps, limit_amps } => {
                Self::MotorCurrent { amps: *amps, limit_amps: *limit_amps }
            }
            Engine::BehindCommand(behind_m) => Self::BehindCommand { behind_m: *behind_m },
            Engine::Astray => Self::Astray,
            Engine::AstrayAgain(times) => Self::AstrayAgain { times: *times },
            Engine::MovesAsCommanded => Self::MovesAsCommanded,
            Engine::MovesOtherwise(mps) => Self::MovesOtherwise { difference_mps: *mps },
            Engine::DoesNotMove => Self::DoesNotMove,
            Engine::NoSwitchFound => Self::NoSwitchFound,
            Engine::HomeLost => Self::HomeLost,
            Engine::NoAnswerYet => Self::NoAnswerYet,
            Engine::NoGoodAnswer(millis) => Self::NoGoodAnswer { silent_millis: *millis },
            Engine::MachineTrouble(trouble) => Self::MachineTrouble { trouble: (*trouble).into() },
            Engine::ControllerAnswers => Self::ControllerAnswers,
            Engine::StepsInTime => Self::StepsInTime,
            Engine::StepsLate(steps) => Self::StepsLate { steps: *steps },
            Engine::GameMasterNotNeeded => Self::GameMasterNotNeeded,
            Engine::GameMasterPresent => Self::GameMasterPresent,
            Engine::GameMasterAbsent => Self::GameMasterAbsent,
            Engine::NoIntruderInput => Self::NoIntruderInput,
            Engine::NoIntruder => Self::NoIntruder,
            Engine::Intruder(input) => Self::Intruder { input: input.to_string() },
            Engine::ArenaAccountedFor => Self::ArenaAccountedFor,
            Engine::ArenaUnconfirmed => Self::ArenaUnconfirmed,
            Engine::Asked(kind) => Self::Asked { request: request_name(*kind).into() },
            Engine::ResetAsked(said) => Self::ResetAsked { said: said.clone() },
            Engine::HomingDone => Self::HomingDone,
            Engine::ProtectiveStopOver => Self::ProtectiveStopOver,
            Engine::NowIn(mode) => Self::NowIn { mode: (*mode).into() },
            Engine::StoppedAlready => Self::StoppedAlready,
            Engine::HomingAlready => Self::HomingAlready,
            Engine::DisarmFirst => Self::DisarmFirst,
            Engine::ResetFirst => Self::ResetFirst,
            Engine::HomeFirst => Self::HomeFirst,
            Engine::WaitForHoming => Self::WaitForHoming,
            Engine::WaitForRest => Self::WaitForRest,
            Engine::ArmedAlready => Self::ArmedAlready,
            Engine::ArmedInProtectiveStop => Self::ArmedInProtectiveStop,
            Engine::DisarmedAlready => Self::DisarmedAlready,
            Engine::ReleasedAlready => Self::ReleasedAlready,
            Engine::CauseStillThere { rule, because } => {
                Self::CauseStillThere { rule: rule.name(), because: Box::new(Self::new(because, names)) }
            }
            Engine::ClearsByItself => Self::ClearsByItself,
            Engine::NothingToReset => Self::NothingToReset,
            Engine::HomingNearKeepOut { keep_out, required_m } => {
                Self::HomingNearKeepOut { keep_out: keep_out.clone(), required_m: *required_m }
            }
            Engine::PersonNotInside(person) => Self::PersonNotInside { person: name(person) },
            Engine::OriginConfirmedAlready(person) => Self::OriginConfirmedAlready { person: name(person) },
            Engine::OriginConfirmed(person) => Self::OriginConfirmed { person: name(person) },
            Engine::PersonStillTracked(person) => Self::PersonStillTracked { person: name(person) },
            Engine::PersonLeft(person) => Self::PersonLeft { person: name(person) },
            Engine::NoSuchObject { index, objects } => {
                Self::NoSuchObject { index: *index, objects: *objects }
            }
            Engine::PriorOutOfRange { index, prior } => {
                Self::PriorOutOfRange { index: *index, prior: *prior }
            }
            Engine::PriorsSet(count) => Self::PriorsSet { count: *count },
            Engine::ColumnInKeepOut { keep_out, required_m } => {
                Self::ColumnInKeepOut { keep_out: keep_out.clone(), required_m: *required_m }
            }
            Engine::SceneActivated => Self::SceneActivated,
            Engine::PersonInside(person) => Self::PersonInside { person: name(person) },
            Engine::ArenaConfirmedClear => Self::ArenaConfirmedClear,
            Engine::JogsWhileHeld => Self::JogsWhileHeld,
            Engine::NoJogOrder { fastest_mps } => Self::NoJogOrder { fastest_mps: *fastest_mps },
            Engine::JogOutsideTravel => Self::JogOutsideTravel,
            Engine::JogLetGo => Self::JogLetGo,
            Engine::JogSilent => Self::JogSilent,
            Engine::JogNotYet => Self::JogNotYet,
            Engine::JogOver(mode) => Self::JogOver { mode: (*mode).into() },
            Engine::NoScenario => Self::NoScenario,
            Engine::ScenarioStands => Self::ScenarioStands,
            Engine::NoSuchCue { cue, known } => Self::NoSuchCue { cue: cue.clone(), known: known.clone() },
            Engine::NotAwaited { name, state } => {
                Self::NotAwaited { name: name.clone(), state: state.clone() }
            }
            Engine::NoSuchState(state) => Self::NoSuchState { state: state.clone() },
            Engine::NothingBefore => Self::NothingBefore,
            Engine::NowInState(state) => Self::NowInState { state: state.clone() },
            Engine::ContactNotArmed => Self::ContactNotArmed,
            Engine::ContactArmed(person) => Self::ContactArmed { person: name(person) },
            Engine::InContact { person, interaction } => {
                Self::InContact { person: name(person), interaction: interaction.clone() }
            }
            Engine::NoContactInteraction => Self::NoContactInteraction,
            Engine::ContactSecs { least, most } => Self::ContactSecs { least: *least, most: *most },
            Engine::ContactForAnother(person) => Self::ContactForAnother { person: name(person) },
            Engine::ContactTakenBack => Self::ContactTakenBack,
            Engine::ContactTimeOver => Self::ContactTimeOver,
            Engine::PersonNotTracked(person) => Self::PersonNotTracked { person: name(person) },
            Engine::InteractionLetGo => Self::InteractionLetGo,
            Engine::SteppedOff => Self::SteppedOff,
            Engine::AnotherIsMeant => Self::AnotherIsMeant,
            Engine::StateLeft => Self::StateLeft,
            Engine::InteractionStopped(mode) => Self::InteractionStopped { mode: (*mode).into() },
            Engine::NobodyLeans => Self::NobodyLeans,
        }
    }
}
