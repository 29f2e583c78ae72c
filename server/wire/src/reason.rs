//! Why something is so: an id and its values, for a page that makes the sentence in its reader's language; and the English
//! sentence, for everybody else.

mod column;
mod convert;
mod decision;
mod examples;
mod latched;
mod trouble;
mod words;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

pub use decision::decision;
pub use latched::{last_run, latch_record};
pub use trouble::MachineTrouble;
pub(crate) use words::in_words;

use crate::calibration::{CalibrationRefusal, HardwarePart};
use crate::commissioning::{CommissioningStep, RailAxis};
use crate::dashboard::Mode;

/// A reason. Persons are named, objects and keep-out shapes have their ids; SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(tag = "id", rename_all = "snake_case")]
pub enum Reason {
    /// The rule has nothing to watch now.
    NothingToWatch,
    /// R1: inside the travel.
    InsideTravel,
    /// R1: the column is past its travel.
    PastTravel {
        /// By how much, m.
        past_m: f64,
    },
    /// R1: slowed at the end of the travel.
    TravelEndInTheWay,
    /// R2, R10, R15: kept.
    HeadsetsTracked,
    /// Nobody is in the arena.
    ArenaEmpty,
    /// R2: somebody entered and has sent no pose yet.
    NoPoseYet {
        /// Name.
        person: String,
        /// Since they entered, s.
        entered_secs: f64,
    },
    /// R2: the newest pose is too old.
    PoseTooOld {
        /// Name.
        person: String,
        /// Its age, s.
        age_secs: f64,
    },
    /// R2: a headset does not know its place.
    HeadsetUntracked {
        /// Name.
        person: String,
    },
    /// R2: a pose jumped.
    PoseJumped {
        /// Name.
        person: String,
    },
    /// R10: a VR client is gone.
    ClientGone {
        /// Name.
        person: String,
    },
    /// R15: a headset was taken off.
    HeadsetOff {
        /// Name.
        person: String,
    },
    /// R15: a tracking origin changed.
    OriginUnconfirmed {
        /// Name.
        person: String,
    },
    /// R3: kept.
    NobodyInTheWay,
    /// R3: slowed or turned for somebody.
    PersonInTheWay {
        /// Name.
        person: String,
        /// The distance that there would be, m.
        distance_m: f64,
        /// The distance that the rule asks, m.
        required_m: f64,
    },
    /// R13: kept.
    NoKeepOutInTheWay,
    /// R13: slowed or turned for a keep-out shape.
    KeepOutInTheWay {
        /// Its id, or its number in the scene.
        keep_out: String,
        /// The distance that there would be, m.
        distance_m: f64,
        /// The distance that the rule asks, m.
        required_m: f64,
    },
    /// R4: kept.
    StopNotPressed,
    /// R4: the software stop.
    SoftwareStop {
        /// In the presser's words.
        said: Option<String>,
    },
    /// R4: the last run ended in a latched stop.
    LastRunLatched {
        /// Its rule, where the record tells.
        rule: Option<String>,
        /// Why, where the record tells.
        because: Option<Box<Reason>>,
    },
    /// R4: a digital input that stops is active.
    StopInput {
        /// Its name.
        input: String,
    },
    /// R4, R12: a digital input gives no good word, which counts as active.
    InputSilent {
        /// Its name.
        input: String,
    },
    /// R5: the greatest motor current.
    MotorCurrent {
        /// It, A.
        amps: f64,
        /// Its limit, A.
        limit_amps: f64,
    },
    /// R6: the following error.
    BehindCommand {
        /// It, m.
        behind_m: f64,
    },
    /// R6: not where it was commanded to be.
    Astray,
    /// R6: the same, again and again.
    AstrayAgain {
        /// How many times in a row.
        times: u32,
    },
    /// R7: kept.
    MovesAsCommanded,
    /// R7: the measured velocity is another.
    MovesOtherwise {
        /// By how much, m/s.
        difference_mps: f64,
    },
    /// R7: commanded, and stands.
    DoesNotMove,
    /// R7: homing failed.
    NoSwitchFound,
    /// R7: the machine does not know its place any more.
    HomeLost,
    /// R8: nothing heard of the machine so far.
    NoAnswerYet,
    /// R8: the controller is silent.
    NoGoodAnswer {
        /// For how long, ms.
        #[ts(type = "number")]
        silent_millis: i64,
    },
    /// R8: the machine cannot be driven.
    MachineTrouble {
        /// What it says.
        trouble: MachineTrouble,
    },
    /// R8: kept.
    ControllerAnswers,
    /// R9: kept.
    StepsInTime,
    /// R9: control steps began late.
    StepsLate {
        /// How many in a row.
        steps: u32,
    },
    /// R11: this machine may be armed without a game master's dashboard.
    GameMasterNotNeeded,
    /// R11: kept.
    GameMasterPresent,
    /// R11, arm: no game master's dashboard is connected, and one is needed.
    GameMasterAbsent,
    /// R12: no input that notices intruders is set up.
    NoIntruderInput,
    /// R12: kept.
    NoIntruder,
    /// R12: an input notices somebody whom nobody tracks.
    Intruder {
        /// Its name.
        input: String,
    },
    /// R16: kept.
    ArenaAccountedFor,
    /// R16: it is not known whether somebody is inside.
    ArenaUnconfirmed,
    /// Arm: a client's calibration is older than the hardware.
    CalibrationOutdated {
        /// The client.
        client: String,
        /// The version of its calibration in force.
        #[ts(type = "number")]
        version: i64,
        /// What is another now.
        part: HardwarePart,
        /// What it was when the calibration was made.
        was: String,
        /// What it is now.
        is: String,
    },
    /// Points that make no calibration.
    BadCalibration {
        /// Why.
        refusal: CalibrationRefusal,
    },
    /// Calibrate: not while the machine is armed, finds its switches or is moved by hand.
    NotWhileItMoves,
    /// A scene waits until an interaction is over.
    InteractionGoesOn {
        /// Its name in scenes: `hold`, `lead`, ...
        interaction: String,
        /// The scene's id of the object.
        object: String,
    },
    /// A scene waits until nobody touches anything.
    TouchGoesOn {
        /// Name.
        person: String,
        /// The scene's id of the object.
        object: String,
    },
    /// Calibrate: none is in the making.
    NoCalibrationDraft,
    /// Calibrate: the one in the making has no such point.
    NoCalibrationPoint {
        /// As it was asked for.
        point: String,
    },
    /// Calibrate: another point is being taken.
    PointBeingTaken,
    /// Calibrate: the client is not connected, several are of that name, or it speaks for several people.
    ClientNotThere {
        /// Its name.
        client: String,
    },
    /// Calibrate: the client sends no such hand.
    NoPointer {
        /// Its name.
        client: String,
    },
    /// Calibrate: the client has no calibration in force, which touching a prop needs.
    ClientNotCalibrated {
        /// Its name.
        client: String,
    },
    /// Calibrate: the active scene has no such prop.
    NoProp {
        /// As it was named.
        prop: String,
    },
    /// There is no calibration of this number.
    NoCalibration {
        /// As it was asked for.
        calibration: String,
    },
    /// Somebody asked for it.
    Asked {
        /// `home`, `arm`, `disarm`, `stop` or `reset`.
        request: String,
    },
    /// Somebody asked for a reset.
    ResetAsked {
        /// In their words.
        said: String,
    },
    /// The switches were found.
    HomingDone,
    /// The cause of a protective stop is gone.
    ProtectiveStopOver,
    /// The machine changed its mode.
    NowIn {
        /// The mode.
        mode: Mode,
    },
    /// The stop is at the drive.
    Stopped,
    /// Stop: already so.
    StoppedAlready,
    /// Home: already so.
    HomingAlready,
    /// Home: not while armed.
    DisarmFirst,
    /// Home, arm: not in a stop.
    ResetFirst,
    /// Arm: not homed.
    HomeFirst,
    /// Not while homing.
    WaitForHoming,
    /// Home, arm: not while the column still moves.
    WaitForRest,
    /// Arm: already so.
    ArmedAlready,
    /// Arm: already so, in a protective stop.
    ArmedInProtectiveStop,
    /// Disarm: already so.
    DisarmedAlready,
    /// Disarm: a stop has released the drive.
    ReleasedAlready,
    /// Reset: not before the cause is gone.
    CauseStillThere {
        /// The rule that is breached.
        rule: String,
        /// Why it is.
        because: Box<Reason>,
    },
    /// Reset: not in a protective stop.
    ClearsByItself,
    /// Reset: already so.
    NothingToReset,
    /// Reset: not without a reason.
    ResetNeedsReason,
    /// Home: the way to the corner comes too near to a keep-out shape.
    HomingNearKeepOut {
        /// Its id.
        keep_out: String,
        /// Distance needed, m.
        required_m: f64,
    },
    /// There is nobody of this name or number in the arena.
    PersonNotInside {
        /// As asked.
        person: String,
    },
    /// The person's origin: already so.
    OriginConfirmedAlready {
        /// Name.
        person: String,
    },
    /// The person stands on the floor mark.
    OriginConfirmed {
        /// Name.
        person: String,
    },
    /// A person with a tracked headset has not left.
    PersonStillTracked {
        /// Name.
        person: String,
    },
    /// The person has left.
    PersonLeft {
        /// Name.
        person: String,
    },
    /// The scene has changed under the request.
    NoSuchObject {
        /// Index of the object as asked.
        #[ts(type = "number")]
        index: usize,
        /// Objects that there are.
        #[ts(type = "number")]
        objects: usize,
    },
    /// A prior must be from 0 to 1.
    PriorOutOfRange {
        /// Index of the object.
        #[ts(type = "number")]
        index: usize,
        /// As asked.
        prior: f64,
    },
    /// Priors are in force.
    PriorsSet {
        /// How many.
        #[ts(type = "number")]
        count: usize,
    },
    /// Scene: the column stands too near to one of its keep-out shapes.
    ColumnInKeepOut {
        /// Its id.
        keep_out: String,
        /// Distance needed, m.
        required_m: f64,
    },
    /// The scene is in force.
    SceneActivated,
    /// Scenario: the active scene has none.
    NoScenario,
    /// Scenario: it stands, for the machine does not follow people.
    ScenarioStands,
    /// Scenario: no transition waits for such a cue.
    NoSuchCue {
        /// As asked.
        cue: String,
        /// Those that there are.
        known: Vec<String>,
    },
    /// Scenario: no transition from this state waits for it now.
    NotAwaited {
        /// The cue or the client event.
        name: String,
        /// The state's id.
        state: String,
    },
    /// Scenario: there is no such state.
    NoSuchState {
        /// As asked.
        state: String,
    },
    /// Scenario: this is the first state of the run.
    NothingBefore,
    /// Scenario: it is in a state.
    NowInState {
        /// The state's id.
        state: String,
    },
    /// Column: an interaction is under way.
    Interacts {
        /// Its name.
        interaction: String,
        /// What it is about.
        phase: String,
        /// Id of its object.
        object: String,
        /// Name of whom it is with.
        person: Option<String>,
    },
    /// R14: no contact is armed.
    ContactNotArmed,
    /// R14: a contact is armed for this visitor.
    ContactArmed {
        /// Name.
        person: String,
    },
    /// R14: a contact is under way.
    InContact {
        /// Name.
        person: String,
        /// `lead`, `transport` or `brush`.
        interaction: String,
    },
    /// R14: the active scene has no interaction in which a moving column touches somebody.
    NoContactInteraction,
    /// R14: a contact is armed for this many seconds.
    ContactSecs {
        /// At least, s.
        least: f64,
        /// At most, s.
        most: f64,
    },
    /// R14: the contact was armed for another visitor.
    ContactForAnother {
        /// Name.
        person: String,
    },
    /// R14: the contact was taken back.
    ContactTakenBack,
    /// R14: the time for which the contact was armed is over.
    ContactTimeOver,
    /// R14: the visitor's headset is not tracked.
    PersonNotTracked {
        /// Name.
        person: String,
    },
    /// Interaction: the visitor let go.
    InteractionLetGo,
    /// Interaction: the visitor is not on the seat any more.
    SteppedOff,
    /// Interaction: the visitor means another object.
    AnotherIsMeant,
    /// Interaction: the scenario's state was left.
    StateLeft,
    /// Interaction: the machine is in another mode.
    InteractionStopped {
        /// Which.
        mode: Mode,
    },
    /// Interaction: nobody leans on the column or rides it.
    NobodyLeans,
    /// Scenario: skipping and going back need a reason.
    SkipNeedsReason,
    /// The control loop's queue is full.
    Busy,
    /// The control loop has ended.
    ControlNotRunning,
    /// A stop was not acknowledged.
    DriveSilent {
        /// In this time, ms.
        #[ts(type = "number")]
        within_millis: u64,
    },
    /// The database did not answer.
    DatabaseSilent,
    /// A preview was given up.
    PreviewUnfinished,
    /// There is no such scene.
    NoScene {
        /// As asked.
        scene: String,
    },
    /// There is no such version of the scene.
    NoSceneVersion {
        /// As asked.
        scene: String,
        /// As asked.
        #[ts(type = "number")]
        version: i64,
    },
    /// There is no such session.
    NoSession {
        /// As asked.
        session: String,
    },
    /// The column: its drive is released.
    DriveReleased,
    /// The column: homing.
    LooksForSwitches,
    /// The column: homed, not armed.
    HoldsUnarmed,
    /// The column: in a stop.
    StoppedBy {
        /// Its rule.
        rule: String,
    },
    /// The column: somebody has entered, and nobody knows where they are.
    WaitsForPose {
        /// Name.
        person: String,
    },
    /// The column: nobody can be served.
    NoHeadsetTracked,
    /// The column: nothing can be served.
    EveryPriorZero,
    /// The column: whom and what for.
    Serves {
        /// Name.
        person: Option<String>,
        /// Id.
        object: String,
        /// W of the rule.
        weight: f64,
        /// Share, 0 to 1.
        probability: f64,
    },
    /// The column: the next object.
    NextInLine {
        /// Id.
        object: String,
        /// W of the rule.
        weight: f64,
        /// Share, 0 to 1.
        probability: f64,
    },
    /// The column: between two objects.
    Undecided {
        /// Name.
        person: Option<String>,
        /// Id of the first.
        object: String,
        /// Its W.
        weight: f64,
        /// Id of the second.
        other: String,
        /// Its W.
        other_weight: f64,
    },
    /// Arm: this machine was not commissioned.
    NotCommissioned,
    /// Arm: the machine was commissioned as another.
    CommissioningOutdated {
        /// What changed.
        part: HardwarePart,
        /// What it was.
        was: String,
        /// What it is.
        is: String,
    },
    /// Commissioning: steps of the checklist are missing.
    CommissioningUnfinished {
        /// The first of them.
        step: CommissioningStep,
    },
    /// Commissioning: no stop from speed was measured this way.
    NoBrakeRun {
        /// The axis.
        axis: RailAxis,
        /// Away from the home corner, else towards it.
        positive: bool,
        /// The speed that it needs, m/s.
        needed_mps: f64,
    },
    /// Commissioning, arm: the brake does less than the limits say.
    BrakesWorse {
        /// The axis.
        axis: RailAxis,
        /// As measured, m/s2.
        measured_mps2: f64,
        /// As the limits say, m/s2.
        needed_mps2: f64,
    },
    /// Commissioning: a stop took a longer way than separation allows for.
    BrakesLonger {
        /// The axis.
        axis: RailAxis,
        /// As measured, m.
        distance_m: f64,
        /// As allowed for, m.
        allowed_m: f64,
    },
    /// Confirm clear: somebody is in the arena.
    PersonInside {
        /// Name.
        person: String,
    },
    /// Somebody looked: nobody is in the arena.
    ArenaConfirmedClear,
    /// Jog: the column is moved for as long as the order is given anew.
    JogsWhileHeld,
    /// Jog: a way without length, or a speed that this machine does not have.
    NoJogOrder {
        /// The machine's greatest speed, m/s.
        fastest_mps: f64,
    },
    /// Jog: the place is outside the travel.
    JogOutsideTravel,
    /// Jog: let go.
    JogLetGo,
    /// Jog: the order was not given anew.
    JogSilent,
    /// Jog: a rule asked for a stop a moment ago, or the machine has only just become ready.
    JogNotYet,
    /// Jog: the machine is in another mode.
    JogOver {
        /// Which.
        mode: Mode,
    },
    /// Jog: somebody else moves the column.
    JogHeldBy {
        /// Who, in their own words.
        author: String,
    },
    /// The column: the scene is empty.
    NoObject,
    /// The column: on its way.
    ToGo {
        /// Still to go, m.
        left_m: f64,
        /// Speed, m/s.
        speed_mps: f64,
    },
    /// The column: held on its way.
    HeldShort {
        /// Still to go, m.
        left_m: f64,
    },
    /// The column: led around somebody.
    GoesAround,
    /// The column: in place.
    StandsThere,
    /// Belief: what speaks for the first object.
    LooksAt {
        /// Name.
        person: String,
        /// Its id.
        object: String,
        /// From the view axis to it, rad.
        angle_rad: f64,
        /// From the head to its surface, m.
        distance_m: f64,
    },
    /// Belief: most likely none of them.
    NonePlain {
        /// Name.
        person: String,
        /// Share, 0 to 1.
        probability: f64,
    },
    /// Place: that of the most probable object.
    AtObject {
        /// Its id.
        object: String,
        /// Share, 0 to 1.
        probability: f64,
    },
    /// Place: that of another object, from which more can be reached in time.
    AtAnother {
        /// Its id.
        object: String,
    },
    /// Place: between two objects, from which either can be reached in time.
    Between {
        /// Id of the first.
        object: String,
        /// Id of the second.
        other: String,
    },
    /// Place: the mean of the objects' places, weighted by the belief.
    AtMean,
    /// Place: among several objects, from which most can be reached in time.
    AmongObjects,
    /// Route: straight.
    StraightOn,
    /// Arrival: as soon as its limits allow.
    AtItsLimits,
    /// Arrival: people in the way and slower beginnings cost time.
    PeopleCost {
        /// How much, s.
        secs: f64,
    },
    /// Arrival: not as far ahead as the planner looks.
    NotForeseen,
    /// Scheduling: real time was not asked for.
    RealTimeNotAsked,
    /// Scheduling: real time.
    RealTime {
        /// SCHED_FIFO priority.
        priority: u8,
    },
    /// Scheduling: real time was not permitted.
    RealTimeRefused {
        /// By the system.
        said: String,
    },
    /// Memory: locked.
    MemoryLocked,
    /// Memory: locked as far as it is there now.
    MemoryLockedForNow,
    /// Memory: not locked.
    MemoryNotLocked {
        /// By the system.
        said: String,
    },
}
