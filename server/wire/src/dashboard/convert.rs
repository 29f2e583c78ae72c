//! From the engine's state and answers to the dashboard's messages, and from its requests to the engine's.

use std::collections::BTreeMap;

use covr_engine::frames::{Floor, Planar, Point, Room};
use covr_engine::machine::{Limits, Travel};
use covr_engine::mode::{Mode as EngineMode, RequestKind};
use covr_engine::observation::PersonId;
use covr_engine::safety::separation::{Term, Terms};
use covr_engine::snapshot::{self as engine, RuleId};
use covr_engine::time::Span;
use covr_engine::{Outcome as EngineOutcome, Request};

use super::event::rule_title;
use super::{
    Activity, Client, Column, Contact, ControlLoop, Interaction, MachineHealth, MachineRequest, MachineShape,
    Mode, NextState, Object, Outcome, Person, RequestState, RuleState, RuleStatus, Scenario, SeparationTerm,
    SeparationTerms, Snapshot, StopCause, ToDashboard,
};
use crate::reason::{self, Reason};

/// What a snapshot holds that the engine does not know.
#[derive(Debug, Clone)]
pub struct Surroundings<'a> {
    /// Grows by one with each published snapshot.
    pub generation: u64,
    /// What the clients call the persons.
    pub names: &'a BTreeMap<PersonId, String>,
    /// The control loop's health.
    pub control_loop: ControlLoop,
    /// The machine's boards and link.
    pub machine_health: Option<MachineHealth>,
    /// Connected VR clients.
    pub clients: Vec<Client>,
    /// Store id of the active scene.
    pub scene_id: Option<i64>,
    /// Store id of the running session.
    pub session_id: Option<i64>,
}

impl Snapshot {
    /// The engine's state with what surrounds it.
    pub fn new(state: &engine::Snapshot, around: Surroundings<'_>) -> Self {
        Self {
            generation: around.generation,
            at_micros: state.at.micros(),
            mode: state.mode.into(),
            mode_since_micros: state.mode_since.micros(),
            stop: state.stop.as_ref().map(|stop| stop_cause(stop, around.names)),
            requests: state
                .refusals
                .iter()
                .map(|(kind, why)| {
                    let why = why.as_ref().map(|why| Reason::new(why, around.names));
                    let refused_because = why.as_ref().map(Reason::to_string);
                    RequestState { request: request_name(*kind).into(), refused_because, why }
                })
                .collect(),
            rules: state.rules.iter().map(|rule| rule_state(rule, around.names)).collect(),
            column: column(state, around.names),
            persons: state.persons.iter().map(|person| self::person(person, around.names)).collect(),
            objects: state.objects.iter().map(Into::into).collect(),
            scenario: state.scenario.as_ref().map(Into::into),
            interaction: state.interaction.as_ref().map(|interaction| Interaction {
                object: state.objects.get(interaction.object).map_or_else(String::new, |o| o.id.clone()),
                interaction: interaction.interaction.into(),
                phase: interaction.phase.into(),
                person: interaction.person.map(|person| person.0),
                lasted_secs: interaction.lasted_secs,
            }),
            contact: state
                .contact
                .map(|contact| Contact { person: contact.person.0, left_secs: contact.left_secs }),
            bears: state.bears.map(|person| person.0),
            intention_rule: state.intention_rule.into(),
            standing: state.standing.into(),
            motion: state.motion.into(),
            none_probability: state.none_probability,
            control_loop: around.control_loop,
            machine_health: around.machine_health,
            clients: around.clients,
            scene_id: around.scene_id,
            session_id: around.session_id,
        }
    }
}

impl MachineRequest {
    /// The engine's request.
    pub fn to_engine(&self, reason: Option<String>) -> Request {
        match self {
            Self::Home => Request::Machine(RequestKind::Home, reason),
            Self::Arm => Request::Machine(RequestKind::Arm, reason),
            Self::Disarm => Request::Machine(RequestKind::Disarm, reason),
            Self::Reset => Request::Machine(RequestKind::Reset, reason),
            Self::ConfirmOrigin(person) => Request::ConfirmOrigin(PersonId(*person)),
            Self::ConfirmLeft(person) => Request::ConfirmLeft(PersonId(*person)),
            Self::ConfirmClear => Request::ConfirmClear,
            Self::Cue(name) => Request::Cue(name.clone()),
            Self::SkipTo(state) => Request::SkipTo(state.clone(), reason.unwrap_or_default()),
            Self::Rewind => Request::Rewind(reason.unwrap_or_default()),
            Self::ArmContact { person, secs } => {
                Request::ArmContact(PersonId(*person), Span::from_secs(*secs))
            }
            Self::DisarmContact => Request::DisarmContact,
            Self::ConfirmFree => Request::ConfirmFree,
        }
    }
}

impl ToDashboard {
    /// The answer to the request of this id; `to_drive_micros` for a stop.
    pub fn answer(request_id: u32, outcome: Outcome, why: Reason, to_drive_micros: Option<u64>) -> Self {
        Self::Answer { request_id, outcome, detail: why.to_string(), why: Some(why), to_drive_micros }
    }
}

impl MachineShape {
    /// The engine's numbers.
    pub fn new(travel: &Travel, limits: &Limits) -> Self {
        Self {
            travel_m: [travel.min.x, travel.min.y, travel.max.x, travel.max.y],
            speed_mps: [limits.x.speed_mps, limits.y.speed_mps],
            acceleration_mps2: [limits.x.acceleration_mps2, limits.y.acceleration_mps2],
            braking_mps2: [limits.x.braking_mps2, limits.y.braking_mps2],
        }
    }
}

impl From<EngineMode> for Mode {
    fn from(mode: EngineMode) -> Self {
        match mode {
            EngineMode::Disarmed => Self::Disarmed,
            EngineMode::Homing => Self::Homing,
            EngineMode::Ready => Self::Ready,
            EngineMode::Following => Self::Following,
            EngineMode::ProtectiveStop => Self::ProtectiveStop,
            EngineMode::LatchedStop => Self::LatchedStop,
            EngineMode::Faulted => Self::Faulted,
        }
    }
}

impl From<EngineOutcome> for Outcome {
    fn from(outcome: EngineOutcome) -> Self {
        match outcome {
            EngineOutcome::Accepted => Self::Accepted,
            EngineOutcome::AlreadySo => Self::AlreadySo,
            EngineOutcome::Refused => Self::Refused,
        }
    }
}

impl From<engine::RuleStatus> for RuleStatus {
    fn from(status: engine::RuleStatus) -> Self {
        match status {
            engine::RuleStatus::Clear => Self::Clear,
            engine::RuleStatus::Limiting => Self::Limiting,
            engine::RuleStatus::Breached => Self::Breached,
            engine::RuleStatus::Idle => Self::Idle,
        }
    }
}

impl From<&engine::ObjectState> for Object {
    fn from(object: &engine::ObjectState) -> Self {
        Self {
            id: object.id.clone(),
            weight: object.weight,
            probability: object.probability,
            prior: object.prior,
            enabled: object.enabled,
            column_place_m: floor(object.column_place),
            arrival_secs: object.arrival_secs,
            touch_secs: object.touch_secs,
            late_by_s: object.late_by_secs,
            in_time_probability: object.in_time_probability,
            angle_rad: object.angle_rad,
            distance_m: object.distance_m,
        }
    }
}

impl From<&engine::ScenarioState> for Scenario {
    fn from(scenario: &engine::ScenarioState) -> Self {
        let next = scenario.next.iter().map(|next| NextState {
            is_from_anywhere: next.is_from_anywhere,
            index: next.index,
            to: next.to.clone(),
            due_secs: next.due_secs,
        });
        Self {
            state: scenario.state.clone(),
            in_state_secs: scenario.in_state_secs,
            runs: scenario.runs,
            entered: scenario.entered,
            variables: scenario.variables.iter().map(|(id, value)| (id.clone(), (*value).into())).collect(),
            next: next.collect(),
            before: scenario.before.clone(),
            left_in: scenario.left_in.clone(),
            is_cut: scenario.is_cut,
        }
    }
}

/// The name of a request on every surface.
pub const fn request_name(kind: RequestKind) -> &'static str {
    match kind {
        RequestKind::Home => "home",
        RequestKind::Arm => "arm",
        RequestKind::Disarm => "disarm",
        RequestKind::Stop => "stop",
        RequestKind::Reset => "reset",
        RequestKind::Jog => "jog",
    }
}

/// What clears a stop by this rule.
pub(crate) fn clears_when(rule: RuleId) -> &'static str {
    match rule.0 {
        2 => "clears by itself 1 s after every headset is tracked again",
        9 => "clears by itself 1 s after the control loop keeps its deadlines again",
        10 => {
            "clears 1 s after the VR client is back, or after somebody confirms that the person has left the arena"
        }
        15 => "clears 1 s after the game master confirms the person on the floor mark",
        8 => "reset, with a reason, once the controller answers again; then home and arm",
        1 => "move the column back by hand, then reset with a reason; then arm",
        _ => "reset, with a reason, once the cause is gone; then arm",
    }
}

/// Clauses as one sentence.
fn sentence(clauses: &[Reason]) -> String {
    clauses.iter().map(Reason::to_string).collect::<Vec<_>>().join("; ")
}

fn stop_cause(cause: &engine::StopCause, names: &BTreeMap<PersonId, String>) -> StopCause {
    let why = Reason::new(&cause.reason, names);
    StopCause {
        rule: cause.rule.name(),
        reason: why.to_string(),
        why,
        clears_when: clears_when(cause.rule).into(),
        since_micros: cause.since.micros(),
    }
}

fn rule_state(rule: &engine::RuleState, names: &BTreeMap<PersonId, String>) -> RuleState {
    let why = Reason::new(&rule.reason, names);
    RuleState {
        rule: rule.rule.name(),
        title: rule_title(rule.rule).into(),
        status: rule.status.into(),
        reason: why.to_string(),
        why,
        since_micros: rule.since.micros(),
    }
}

fn column(state: &engine::Snapshot, names: &BTreeMap<PersonId, String>) -> Column {
    let column = &state.column;
    let why = Reason::of_column(state, names);
    Column {
        position_m: floor(column.position),
        velocity_mps: planar(column.velocity),
        commanded_m: floor(column.commanded),
        proxy_m: floor(column.proxy),
        target_m: column.target.map(floor),
        serves: column.serves.map(|person| person.0),
        committed: column.committed.and_then(|i| state.objects.get(i)).map(|object| object.id.clone()),
        activity: column.activity.into(),
        reason: sentence(&why),
        why,
        decision: reason::decision(state, names),
        arrival_secs: column.arrival_secs,
        planned_path_m: Vec::new(),
        jog_speed_mps: column.jog_speed_mps,
        current_amps: column.current_amps,
        home_repeatability_m: column.home_repeatability_m,
        homed: column.homed,
    }
}

impl From<engine::Activity> for Activity {
    fn from(activity: engine::Activity) -> Self {
        match activity {
            engine::Activity::Released => Self::Released,
            engine::Activity::Homing => Self::Homing,
            engine::Activity::Ready => Self::Ready,
            engine::Activity::Jogged => Self::Jogged,
            engine::Activity::Waiting => Self::Waiting,
            engine::Activity::Approaching => Self::Approaching,
            engine::Activity::Yielding => Self::Yielding,
            engine::Activity::Blocked => Self::Blocked,
            engine::Activity::InPlace => Self::InPlace,
            engine::Activity::Interacting => Self::Interacting,
            engine::Activity::Stopped => Self::Stopped,
        }
    }
}

impl From<Terms> for SeparationTerms {
    fn from(terms: Terms) -> Self {
        Self {
            radius_m: terms.radius_m,
            reaction_m: terms.reaction_m,
            braking_m: terms.braking_m,
            walking_m: terms.walking_m,
            age_m: terms.age_m,
            binding: match terms.binding() {
                Term::Reaction => SeparationTerm::Reaction,
                Term::Braking => SeparationTerm::Braking,
                Term::Walking => SeparationTerm::Walking,
                Term::Age => SeparationTerm::Age,
            },
        }
    }
}

fn person(person: &engine::PersonState, names: &BTreeMap<PersonId, String>) -> Person {
    let view = person.pose.map(|pose| pose.view());
    Person {
        id: person.person.0,
        name: name_of(person.person, names),
        head_m: person.pose.map(|pose| point(&pose.position)),
        yaw_rad: view.map_or(0.0, |view| view.y.atan2(view.x)),
        pitch_rad: view.map_or(0.0, |view| view.z.atan2(view.x.hypot(view.y))),
        pose_age_secs: person.pose_age_secs,
        tracked: person.tracked,
        awaits_confirmation: person.awaits_confirmation,
        separation_radius_m: person.separation_radius_m,
        distance_m: person.distance_m,
        required_m: person.required_m,
        separation: person.separation.map(Into::into),
        limits_column: person.limits_column,
    }
}

pub(crate) fn name_of(person: PersonId, names: &BTreeMap<PersonId, String>) -> String {
    names.get(&person).cloned().unwrap_or_else(|| format!("person {}", person.0))
}

fn point(point: &Point<Room>) -> [f64; 3] {
    point.vector().into()
}

const fn floor(at: Floor) -> [f64; 2] {
    [at.x, at.y]
}

const fn planar(vector: Planar) -> [f64; 2] {
    [vector.x, vector.y]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    fn names() -> BTreeMap<PersonId, String> {
        BTreeMap::from([(PersonId(3), "Ada".to_owned())])
    }

    #[test]
    fn a_snapshot_carries_the_engines_state_under_its_names() {
        let names = names();
        let around = Surroundings {
            generation: 9,
            names: &names,
            control_loop: sample::control_loop(),
            machine_health: None,
            clients: Vec::new(),
            scene_id: Some(4),
            session_id: None,
        };
        let snapshot = Snapshot::new(&sample::snapshot(), around);
        assert_eq!(snapshot.generation, 9);
        assert_eq!(snapshot.column.committed.as_deref(), Some("kettle"));
        assert_eq!(snapshot.stop.as_ref().map(|stop| stop.rule.as_str()), Some("R2"));
        assert_eq!(
            (snapshot.persons[0].name.as_str(), snapshot.persons[1].name.as_str()),
            ("Ada", "person 8")
        );
        assert!((snapshot.persons[0].yaw_rad - 0.5).abs() < 1e-12);
        assert!((snapshot.persons[0].pitch_rad - 0.25).abs() < 1e-12);
        assert_eq!(snapshot.persons[1].head_m, None);
        let separation = snapshot.persons[0].separation.unwrap();
        assert_eq!(separation.binding, SeparationTerm::Walking);
        assert_eq!((snapshot.persons[0].limits_column, snapshot.persons[1].limits_column), (true, false));
        assert_eq!(snapshot.persons[1].separation, None);
        assert_eq!(snapshot.rules[0].title, "travel");
        assert_eq!(snapshot.requests[0].request, "reset");
        let json = serde_json::to_value(ToDashboard::Snapshot(Box::new(snapshot))).unwrap();
        assert_eq!(json["type"], "snapshot");
        assert_eq!(json["mode"], "protective_stop");
    }

    #[test]
    fn every_mode_has_one_name_on_every_surface() {
        for mode in EngineMode::ALL {
            assert_eq!(serde_json::to_value(Mode::from(mode)).unwrap(), mode.name());
        }
    }

    #[test]
    fn a_request_reaches_the_engine_with_its_reason() {
        let Request::Machine(RequestKind::Reset, Some(reason)) =
            MachineRequest::Reset.to_engine(Some("looked".into()))
        else {
            panic!("another request");
        };
        assert_eq!(reason, "looked");
        assert!(matches!(
            MachineRequest::ConfirmOrigin(3).to_engine(None),
            Request::ConfirmOrigin(PersonId(3))
        ));
    }
}
