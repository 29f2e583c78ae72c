//! One of each.

use super::{MachineTrouble, Reason};
use crate::calibration::{CalibrationRefusal, HardwarePart};
use crate::commissioning::{CommissioningStep, RailAxis};
use crate::dashboard::Mode;

impl Reason {
    /// One of each, for the published contract and for the catalogues that must have them all.
    pub fn examples() -> Vec<Self> {
        vec![
            Self::NothingToWatch,
            Self::InsideTravel,
            Self::PastTravel { past_m: 0.012 },
            Self::TravelEndInTheWay,
            Self::HeadsetsTracked,
            Self::ArenaEmpty,
            Self::NoPoseYet { person: "Ada".into(), entered_secs: 0.834 },
            Self::PoseTooOld { person: "Ada".into(), age_secs: 0.834 },
            Self::HeadsetUntracked { person: "Ada".into() },
            Self::PoseJumped { person: "Ada".into() },
            Self::ClientGone { person: "Ada".into() },
            Self::HeadsetOff { person: "Ada".into() },
            Self::OriginUnconfirmed { person: "Ada".into() },
            Self::NobodyInTheWay,
            Self::PersonInTheWay { person: "Ada".into(), distance_m: 0.834, required_m: 0.834 },
            Self::NoKeepOutInTheWay,
            Self::KeepOutInTheWay { keep_out: "sofa".into(), distance_m: 0.834, required_m: 0.834 },
            Self::StopNotPressed,
            Self::SoftwareStop { said: Some("looked at the rail".into()) },
            Self::LastRunLatched {
                rule: Some("R8".into()),
                because: Some(Box::new(Self::SoftwareStop { said: Some("hand near the rail".into()) })),
            },
            Self::StopInput { input: "door".into() },
            Self::InputSilent { input: "door".into() },
            Self::MotorCurrent { amps: 31.24, limit_amps: 30.0 },
            Self::BehindCommand { behind_m: 0.083 },
            Self::Astray,
            Self::AstrayAgain { times: 3 },
            Self::MovesAsCommanded,
            Self::MovesOtherwise { difference_mps: 0.834 },
            Self::DoesNotMove,
            Self::NoSwitchFound,
            Self::HomeLost,
            Self::NoAnswerYet,
            Self::NoGoodAnswer { silent_millis: 120 },
            Self::MachineTrouble { trouble: MachineTrouble::EmergencyStop },
            Self::ControllerAnswers,
            Self::StepsInTime,
            Self::StepsLate { steps: 4 },
            Self::GameMasterNotNeeded,
            Self::GameMasterPresent,
            Self::GameMasterAbsent,
            Self::NoIntruderInput,
            Self::NoIntruder,
            Self::Intruder { input: "light curtain".into() },
            Self::ArenaAccountedFor,
            Self::ArenaUnconfirmed,
            Self::CalibrationOutdated {
                client: "headset 1".into(),
                version: 3,
                part: HardwarePart::Controller,
                was: "/dev/roboclaw-00A1".into(),
                is: "/dev/roboclaw-00B2".into(),
            },
            Self::BadCalibration { refusal: CalibrationRefusal::TooFewPoints { found: 4, fewest: 6 } },
            Self::NotWhileItMoves,
            Self::InteractionGoesOn { interaction: "hold".into(), object: "wall".into() },
            Self::TouchGoesOn { person: "Ada".into(), object: "wall".into() },
            Self::NoCalibrationDraft,
            Self::NoCalibrationPoint { point: "7".into() },
            Self::PointBeingTaken,
            Self::ClientNotThere { client: "headset 1".into() },
            Self::NoPointer { client: "headset 1".into() },
            Self::ClientNotCalibrated { client: "headset 1".into() },
            Self::NoProp { prop: "handle".into() },
            Self::NoCalibration { calibration: "12".into() },
            Self::Asked { request: "arm".into() },
            Self::ResetAsked { said: "looked at the rail".into() },
            Self::HomingDone,
            Self::ProtectiveStopOver,
            Self::NowIn { mode: Mode::Following },
            Self::Stopped,
            Self::StoppedAlready,
            Self::HomingAlready,
            Self::DisarmFirst,
            Self::ResetFirst,
            Self::HomeFirst,
            Self::WaitForHoming,
            Self::WaitForRest,
            Self::ArmedAlready,
            Self::ArmedInProtectiveStop,
            Self::DisarmedAlready,
            Self::ReleasedAlready,
            Self::CauseStillThere {
                rule: "R8".into(),
                because: Box::new(Self::NoGoodAnswer { silent_millis: 120 }),
            },
            Self::ClearsByItself,
            Self::NothingToReset,
            Self::ResetNeedsReason,
            Self::HomingNearKeepOut { keep_out: "sofa".into(), required_m: 0.834 },
            Self::PersonNotInside { person: "Ada".into() },
            Self::OriginConfirmedAlready { person: "Ada".into() },
            Self::OriginConfirmed { person: "Ada".into() },
            Self::PersonStillTracked { person: "Ada".into() },
            Self::PersonLeft { person: "Ada".into() },
            Self::NoSuchObject { index: 7, objects: 5 },
            Self::PriorOutOfRange { index: 7, prior: 1.4 },
            Self::PriorsSet { count: 4 },
            Self::ColumnInKeepOut { keep_out: "sofa".into(), required_m: 0.834 },
            Self::SceneActivated,
            Self::NoScenario,
            Self::ScenarioStands,
            Self::NoSuchCue { cue: "thunder".into(), known: vec!["lights".into(), "walls".into()] },
            Self::NotAwaited { name: "lights".into(), state: "walls".into() },
            Self::NoSuchState { state: "attic".into() },
            Self::NothingBefore,
            Self::NowInState { state: "walls".into() },
            Self::Interacts {
                interaction: "lead".into(),
                phase: "leading".into(),
                object: "broom".into(),
                person: Some("Ada".into()),
            },
            Self::ContactNotArmed,
            Self::ContactArmed { person: "Ada".into() },
            Self::InContact { person: "Ada".into(), interaction: "lead".into() },
            Self::NoContactInteraction,
            Self::ContactSecs { least: 1.0, most: 300.0 },
            Self::ContactForAnother { person: "Grace".into() },
            Self::ContactTakenBack,
            Self::ContactTimeOver,
            Self::PersonNotTracked { person: "Ada".into() },
            Self::InteractionLetGo,
            Self::SteppedOff,
            Self::AnotherIsMeant,
            Self::StateLeft,
            Self::InteractionStopped { mode: Mode::ProtectiveStop },
            Self::NobodyLeans,
            Self::SkipNeedsReason,
            Self::Busy,
            Self::ControlNotRunning,
            Self::DriveSilent { within_millis: 1000 },
            Self::DatabaseSilent,
            Self::PreviewUnfinished,
            Self::NoScene { scene: "12".into() },
            Self::NoSceneVersion { scene: "12".into(), version: 3 },
            Self::NoSession { session: "12".into() },
            Self::DriveReleased,
            Self::LooksForSwitches,
            Self::HoldsUnarmed,
            Self::StoppedBy { rule: "R8".into() },
            Self::WaitsForPose { person: "Ada".into() },
            Self::NoHeadsetTracked,
            Self::EveryPriorZero,
            Self::Serves {
                person: Some("Ada".into()),
                object: "kettle".into(),
                weight: 0.834,
                probability: 0.834,
            },
            Self::NextInLine { object: "kettle".into(), weight: 0.834, probability: 0.834 },
            Self::Undecided {
                person: Some("Ada".into()),
                object: "kettle".into(),
                weight: 0.834,
                other: "lamp".into(),
                other_weight: 0.834,
            },
            Self::NotCommissioned,
            Self::CommissioningOutdated {
                part: HardwarePart::Firmware,
                was: "USB Roboclaw 2x15a v4.2.8".into(),
                is: "USB Roboclaw 2x15a v4.3.6".into(),
            },
            Self::CommissioningUnfinished { step: CommissioningStep::WiredStop },
            Self::NoBrakeRun { axis: RailAxis::X, positive: true, needed_mps: 0.99 },
            Self::BrakesWorse { axis: RailAxis::Y, measured_mps2: 1.834, needed_mps2: 2.5 },
            Self::BrakesLonger { axis: RailAxis::X, distance_m: 0.4834, allowed_m: 0.3834 },
            Self::PersonInside { person: "Ada".into() },
            Self::ArenaConfirmedClear,
            Self::JogsWhileHeld,
            Self::NoJogOrder { fastest_mps: 1.1 },
            Self::JogOutsideTravel,
            Self::JogLetGo,
            Self::JogSilent,
            Self::JogNotYet,
            Self::JogOver { mode: Mode::LatchedStop },
            Self::JogHeldBy { author: "Ada".into() },
            Self::NoObject,
            Self::ToGo { left_m: 0.834, speed_mps: 0.834 },
            Self::HeldShort { left_m: 0.834 },
            Self::GoesAround,
            Self::StandsThere,
            Self::LooksAt {
                person: "Ada".into(),
                object: "kettle".into(),
                angle_rad: 0.0698,
                distance_m: 1.234,
            },
            Self::NonePlain { person: "Ada".into(), probability: 0.62 },
            Self::AtObject { object: "kettle".into(), probability: 0.62 },
            Self::AtAnother { object: "lamp".into() },
            Self::Between { object: "kettle".into(), other: "lamp".into() },
            Self::AtMean,
            Self::AmongObjects,
            Self::StraightOn,
            Self::AtItsLimits,
            Self::PeopleCost { secs: 0.42 },
            Self::NotForeseen,
            Self::RealTimeNotAsked,
            Self::RealTime { priority: 60 },
            Self::RealTimeRefused { said: "EPERM".into() },
            Self::MemoryLocked,
            Self::MemoryLockedForNow,
            Self::MemoryNotLocked { said: "EPERM".into() },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn there_is_an_example_of_each() {
        let schema = schemars::schema_for!(Reason).to_value();
        let variants = schema["oneOf"].as_array().unwrap();
        let known: BTreeSet<_> = variants
            .iter()
            .map(|one| one["properties"]["id"]["const"].as_str().unwrap().to_owned())
            .collect();
        let examples = Reason::examples();
        let shown: BTreeSet<_> = examples
            .iter()
            .map(|reason| serde_json::to_value(reason).unwrap()["id"].as_str().unwrap().to_owned())
            .collect();
        assert_eq!(shown, known);
        assert_eq!(examples.len(), known.len());
    }

    #[test]
    fn a_reason_comes_back_from_its_text_on_the_wire() {
        for reason in Reason::examples() {
            let text = serde_json::to_string(&reason).unwrap();
            assert_eq!(serde_json::from_str::<Reason>(&text).unwrap(), reason);
        }
    }
}
