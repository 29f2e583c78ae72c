//! Why something is so, as data: which of the known reasons, with its values. The sentence is made by whoever shows it, in
//! the language of its reader.

use std::sync::Arc;

use crate::machine::Trouble;
use crate::mode::{Mode, RequestKind};
use crate::observation::PersonId;
use crate::snapshot::RuleId;

/// Why a rule stands as it does, a mode was entered, or a request was answered as it was.
#[derive(Debug, Clone, PartialEq)]
pub enum Reason {
    /// The rule has nothing to watch now.
    NothingToWatch,
    /// R1: inside the travel.
    InsideTravel,
    /// R1: the column is past its travel by so much, m.
    PastTravel(f64),
    /// R1: slowed at the end of the travel.
    TravelEndInTheWay,
    /// R2, R10, R15: everybody's headset is tracked.
    HeadsetsTracked,
    /// Nobody is in the arena.
    ArenaEmpty,
    /// R2: a person entered so long ago and has sent no pose yet, s.
    NoPoseYet(PersonId, f64),
    /// R2: the newest pose of a person is so old, s.
    PoseTooOld(PersonId, f64),
    /// R2: the headset of a person does not know its place.
    HeadsetUntracked(PersonId),
    /// R2: the pose of a person jumped faster than a head can move.
    PoseJumped(PersonId),
    /// R10: the VR client of a person is gone.
    ClientGone(PersonId),
    /// R15: a person took the headset off.
    HeadsetOff(PersonId),
    /// R15: the tracking origin changed, and nobody has confirmed the person on the floor mark.
    OriginUnconfirmed(PersonId),
    /// R3: nobody is in the way.
    NobodyInTheWay,
    /// R3: slowed or turned for a person.
    PersonInTheWay {
        /// Whom.
        person: PersonId,
        /// The distance that there would be, m.
        distance_m: f64,
        /// The distance that the rule asks, m.
        required_m: f64,
    },
    /// R13: no keep-out shape is in the way.
    NoKeepOutInTheWay,
    /// R13: slowed or turned for a keep-out shape.
    KeepOutInTheWay {
        /// Index of the shape in the scene.
        keep_out: usize,
        /// The distance that there would be, m.
        distance_m: f64,
        /// The distance that the rule asks, m.
        required_m: f64,
    },
    /// R4: not pressed.
    StopNotPressed,
    /// R4: the software stop, with the presser's words; empty when none were given.
    SoftwareStop(String),
    /// R4: the last run ended in a latched stop; the record that it left, as it was given to the engine.
    LastRunLatched(String),
    /// R4: this digital input, which stops, is active.
    StopInput(Arc<str>),
    /// R4, R12: this digital input gives no good word, which counts as active.
    InputSilent(Arc<str>),
    /// R5: the greatest motor current, and its limit, A.
    MotorCurrent {
        /// Greatest of the axes, A.
        amps: f64,
        /// Limit, A.
        limit_amps: f64,
    },
    /// R6: the measured place is so far from the commanded one, m.
    BehindCommand(f64),
    /// R6: not where it was commanded to be: held until it rests.
    Astray,
    /// R6: not where it was commanded to be, so many times in a row.
    AstrayAgain(u32),
    /// R7: moves as commanded.
    MovesAsCommanded,
    /// R7: the measured velocity differs from the commanded one by so much, m/s.
    MovesOtherwise(f64),
    /// R7: commanded, and does not move.
    DoesNotMove,
    /// R7: homing found no switch.
    NoSwitchFound,
    /// R7: the machine has lost its home.
    HomeLost,
    /// R8: the machine has not answered yet.
    NoAnswerYet,
    /// R8: no good answer for so long, ms.
    NoGoodAnswer(i64),
    /// R8: the machine cannot be driven, for a reason of its own.
    MachineTrouble(Trouble),
    /// R8: the controller answers.
    ControllerAnswers,
    /// R9: control steps begin in time.
    StepsInTime,
    /// R9: so many steps in a row began late.
    StepsLate(u32),
    /// R11: this machine may be armed without a game master's dashboard.
    GameMasterNotNeeded,
    /// R11: a game master's dashboard is connected.
    GameMasterPresent,
    /// R11, arm: no game master's dashboard is connected, and one is needed.
    GameMasterAbsent,
    /// R12: no input that notices intruders is set up.
    NoIntruderInput,
    /// R12: every input that notices intruders is inactive.
    NoIntruder,
    /// R12: this input notices somebody whom nobody tracks.
    Intruder(Arc<str>),
    /// R16: people are tracked, or the arena was confirmed clear.
    ArenaAccountedFor,
    /// R16: nobody is tracked and nobody has confirmed that the arena is clear.
    ArenaUnconfirmed,

    /// Somebody asked for it.
    Asked(RequestKind),
    /// The reset, with the reason that was given for it.
    ResetAsked(String),
    /// The switches were found.
    HomingDone,
    /// The cause of the protective stop is gone.
    ProtectiveStopOver,
    /// The machine is now in this mode.
    NowIn(Mode),

    /// Stop: the machine is stopped already, and the stop is latched.
    StoppedAlready,
    /// Home: homing already.
    HomingAlready,
    /// Home: the machine is armed.
    DisarmFirst,
    /// Home, arm: the machine is stopped.
    ResetFirst,
    /// Arm: not homed.
    HomeFirst,
    /// Not while homing.
    WaitForHoming,
    /// Home, arm: the column still moves.
    WaitForRest,
    /// Arm: armed already.
    ArmedAlready,
    /// Arm: armed already, in a protective stop.
    ArmedInProtectiveStop,
    /// Disarm: disarmed already.
    DisarmedAlready,
    /// Disarm: the drive is released already, by a stop.
    ReleasedAlready,
    /// Reset: the cause is still there.
    CauseStillThere {
        /// The rule that is breached.
        rule: RuleId,
        /// Its reason.
        because: Box<Reason>,
    },
    /// Reset: a protective stop clears by itself.
    ClearsByItself,
    /// Reset: there is nothing to reset.
    NothingToReset,
    /// Home: the way to the corner comes nearer to a keep-out shape than this, m.
    HomingNearKeepOut {
        /// The shape's id in the scene.
        keep_out: String,
        /// Distance needed, m.
        required_m: f64,
    },
    /// The person is not in the arena.
    PersonNotInside(PersonId),
    /// The person's origin is confirmed already.
    OriginConfirmedAlready(PersonId),
    /// The person stands on the floor mark.
    OriginConfirmed(PersonId),
    /// The headset is tracked, so the person is in the arena.
    PersonStillTracked(PersonId),
    /// The person has left.
    PersonLeft(PersonId),
    /// Confirm clear: this person is in the arena.
    PersonInside(PersonId),
    /// Somebody looked: nobody is in the arena.
    ArenaConfirmedClear,
    /// There is no object of this index.
    NoSuchObject {
        /// As asked.
        index: usize,
        /// Objects that there are.
        objects: usize,
    },
    /// The prior of an object is not from 0 to 1.
    PriorOutOfRange {
        /// The object's index.
        index: usize,
        /// As asked.
        prior: f64,
    },
    /// So many priors were set.
    PriorsSet(usize),
    /// Scene: the column stands nearer than this to one of its keep-out shapes, m.
    ColumnInKeepOut {
        /// The shape's id in the scene.
        keep_out: String,
        /// Distance needed, m.
        required_m: f64,
    },
    /// The scene is in force.
    SceneActivated,
    /// Jog: the column is moved for as long as the order is given anew.
    JogsWhileHeld,
    /// Jog: its way is none, or its speed is not above 0 and up to this, the machine's, m/s.
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
    JogOver(Mode),
    /// Scenario: the active scene has none.
    NoScenario,
    /// Scenario: it runs while the machine follows people, and stands now.
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
    /// Scenario: there is no state of this id.
    NoSuchState(String),
    /// Scenario: this is the first state of the run.
    NothingBefore,
    /// Scenario: it is in the state of this id.
    NowInState(String),
    /// R14: no contact is armed.
    ContactNotArmed,
    /// R14: a contact is armed for this visitor.
    ContactArmed(PersonId),
    /// R14: a contact is under way.
    InContact {
        /// With whom.
        person: PersonId,
        /// The interaction's name.
        interaction: String,
    },
    /// R14: the active scene has no interaction in which a moving column touches somebody.
    NoContactInteraction,
    /// R14: a contact is armed for this many seconds at least and at most.
    ContactSecs {
        /// s.
        least: f64,
        /// s.
        most: f64,
    },
    /// R14: a contact was armed for another visitor.
    ContactForAnother(PersonId),
    /// R14: the contact was taken back.
    ContactTakenBack,
    /// R14: the time for which the contact was armed is over.
    ContactTimeOver,
    /// R14: the visitor's headset is not tracked.
    PersonNotTracked(PersonId),
    /// Interaction: the visitor let go.
    InteractionLetGo,
    /// Interaction: the visitor is not on the seat any more.
    SteppedOff,
    /// Interaction: the visitor means another object.
    AnotherIsMeant,
    /// Interaction: the scenario's state was left.
    StateLeft,
    /// Interaction: the machine is in another mode.
    InteractionStopped(Mode),
    /// Interaction: nobody leans on the column or rides it.
    NobodyLeans,
}
