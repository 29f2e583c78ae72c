//! From the engine's events to the dashboard's, with the names of the rules.

use std::collections::BTreeMap;

use covr_engine::event::{Event as EngineEvent, EventKind, WhyState};
use covr_engine::observation::PersonId;
use covr_engine::snapshot::RuleId;
use serde_json::{Value, json};

use super::{Event, name_of};
use crate::reason::{Reason, in_words};

impl Event {
    /// The engine's event, with the wall clock (RFC 3339) and the names of persons and objects at that moment.
    pub fn new(
        event: &EngineEvent,
        at: String,
        names: &BTreeMap<PersonId, String>,
        objects: &[String],
    ) -> Self {
        let who = |person: &PersonId| name_of(*person, names);
        let object_name =
            |object: usize| objects.get(object).map_or_else(|| format!("object {object}"), Clone::clone);
        let (kind, summary, detail) = match &event.kind {
            EventKind::ModeChanged { from, to, rule, because } => {
                let why = Reason::new(because, names);
                let because = rule.map_or_else(|| why.to_string(), |rule| format!("{}: {why}", rule.name()));
                (
                    "mode_changed",
                    format!("{} to {}: {because}", in_words((*from).into()), in_words((*to).into())),
                    json!({"from": from.name(), "to": to.name(), "rule": rule.map(RuleId::name), "because": because, "why": why}),
                )
            }
            EventKind::RuleBreached { rule, reason } => {
                let why = Reason::new(reason, names);
                (
                    "rule_breached",
                    format!("{} {}: {why}", rule.name(), rule_title(*rule)),
                    json!({"rule": rule.name(), "title": rule_title(*rule), "reason": why.to_string(), "why": why}),
                )
            }
            EventKind::RuleCleared { rule } => (
                "rule_cleared",
                format!("{} {} is kept again", rule.name(), rule_title(*rule)),
                json!({"rule": rule.name(), "title": rule_title(*rule)}),
            ),
            EventKind::PersonEntered(person) => (
                "person_entered",
                format!("{} entered", who(person)),
                json!({"person": person.0, "name": who(person)}),
            ),
            EventKind::PersonLeft(person) => (
                "person_left",
                format!("{} left", who(person)),
                json!({"person": person.0, "name": who(person)}),
            ),
            EventKind::Served { person, object } => {
                let id = objects.get(*object);
                (
                    "served",
                    format!("the column stands at {} for {}", object_name(*object), who(person)),
                    json!({"person": person.0, "name": who(person), "object": id}),
                )
            }
            EventKind::Homed { at, repeatability_m } => {
                let found = repeatability_m.map_or_else(String::new, |[x, y]| {
                    format!(
                        "; the second approach found x {:+.2} mm and y {:+.2} mm from the first",
                        x * 1e3,
                        y * 1e3
                    )
                });
                (
                    "homed",
                    format!("homed, at ({:.3}, {:.3}) m{found}", at.x, at.y),
                    json!({"at_m": [at.x, at.y], "repeatability_m": repeatability_m}),
                )
            }
            EventKind::CameToRest { velocity, secs, distance, allowed, braking_mps2 } => (
                "came_to_rest",
                format!(
                    "the column came to rest {:.3} m and {secs:.2} s after a stop at {:.2} m/s; {:.3} m were allowed for",
                    distance.norm(),
                    velocity.norm(),
                    allowed.norm()
                ),
                json!({
                    "velocity_mps": [velocity.x, velocity.y],
                    "secs": secs,
                    "distance_m": [distance.x, distance.y],
                    "allowed_m": [allowed.x, allowed.y],
                    "braking_mps2": braking_mps2,
                }),
            ),
            EventKind::JogBegan(at) => (
                "jog_began",
                format!("the column is moved by hand from ({:.3}, {:.3}) m", at.x, at.y),
                json!({"at_m": [at.x, at.y]}),
            ),
            EventKind::JogEnded { at, because } => {
                let why = Reason::new(because, names);
                (
                    "jog_ended",
                    format!("the column is moved by hand no more, at ({:.3}, {:.3}) m: {why}", at.x, at.y),
                    json!({"at_m": [at.x, at.y], "why": why}),
                )
            }
            EventKind::InteractionBegan { object, interaction, person } => {
                let id = objects.get(*object);
                let with = person.as_ref().map(|person| format!(" with {}", who(person))).unwrap_or_default();
                (
                    "interaction_began",
                    format!("{} at {}{with}", interaction.replace('_', " "), object_name(*object)),
                    json!({"interaction": interaction, "object": id, "person": person.map(|p| p.0), "name": person.as_ref().map(who)}),
                )
            }
            EventKind::InteractionEnded { object, interaction, person, because } => {
                let why = Reason::new(because, names);
                let id = objects.get(*object);
                (
                    "interaction_ended",
                    format!("{} at {} is over: {why}", interaction.replace('_', " "), object_name(*object)),
                    json!({"interaction": interaction, "object": id, "person": person.map(|p| p.0), "name": person.as_ref().map(who), "why": why}),
                )
            }
            EventKind::ContactOver { person, because } => {
                let why = Reason::new(because, names);
                (
                    "contact_over",
                    format!("contact is armed for {} no more: {why}", who(person)),
                    json!({"person": person.0, "name": who(person), "why": why}),
                )
            }
            EventKind::StateEntered { from, to, why } => {
                let (words, mut detail) = why_state(why, &who);
                detail["state"] = (&**to).into();
                detail["from"] = from.as_deref().into();
                ("state_entered", format!("the scenario is in {to}: {words}"), detail)
            }
            EventKind::ScenarioCut { state } => (
                "scenario_cut",
                format!("the scenario went in a circle and waits in {state} for something to happen"),
                json!({"state": **state}),
            ),
        };
        Self { at_micros: event.at.micros(), at, kind: kind.into(), summary, detail }
    }
}

/// Why a state was entered, in words and as particulars: `by` says what.
fn why_state(why: &WhyState, who: &impl Fn(&PersonId) -> String) -> (String, Value) {
    let somebody = |person: &PersonId, does: &str, by: &str, key: &str, id: &String| {
        let words = format!("{} {does} {id}", who(person));
        (words, json!({"by": by, "person": person.0, "name": who(person), key: id}))
    };
    match why {
        WhyState::Began => ("the machine was armed".into(), json!({"by": "began"})),
        WhyState::ConditionHeld => ("its condition held".into(), json!({"by": "condition"})),
        WhyState::TouchBegan(person, id) => somebody(person, "touched", "touch_began", "object", id),
        WhyState::TouchEnded(person, id) => somebody(person, "let go of", "touch_ended", "object", id),
        WhyState::ZoneEntered(person, id) => somebody(person, "entered", "zone_entered", "zone", id),
        WhyState::ZoneLeft(person, id) => somebody(person, "left", "zone_left", "zone", id),
        WhyState::InteractionDone(id) => (
            format!("what the column does at {id} came to its end"),
            json!({"by": "interaction_done", "object": id}),
        ),
        WhyState::ClientEvent(name) => {
            (format!("the VR client said {name}"), json!({"by": "client_event", "event": name}))
        }
        WhyState::Cue(name) => (format!("cue {name}"), json!({"by": "cue", "cue": name})),
        WhyState::Skipped(reason) => (format!("skipped: {reason}"), json!({"by": "skip", "reason": reason})),
        WhyState::Rewound(reason) => {
            (format!("gone back: {reason}"), json!({"by": "rewind", "reason": reason}))
        }
    }
}

/// A short name of a safety rule, for people.
pub fn rule_title(rule: RuleId) -> &'static str {
    usize::from(rule.0).checked_sub(1).and_then(|i| RULE_TITLES.get(i).copied()).unwrap_or("unknown rule")
}

/// R1 first.
const RULE_TITLES: [&str; 16] = [
    "travel",
    "tracking",
    "separation",
    "software stop",
    "motor current",
    "following error",
    "plausibility",
    "controller link",
    "control loop",
    "VR client",
    "game master present",
    "intruder",
    "keep-out shapes",
    "contact interactions",
    "tracking origin",
    "arena confirmed clear",
];

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::mode::Mode;
    use covr_engine::time::Time;

    #[test]
    fn every_rule_has_a_title_and_no_other_number_has() {
        let titles: std::collections::BTreeSet<_> = (1..=16).map(|rule| rule_title(RuleId(rule))).collect();
        assert_eq!(titles.len(), 16);
        assert!([0, 17, 255].into_iter().all(|rule| rule_title(RuleId(rule)) == "unknown rule"));
    }

    #[test]
    fn events_name_persons_objects_and_rules() {
        let objects = ["kettle".to_owned()];
        let names = BTreeMap::from([(PersonId(3), "Ada".to_owned())]);
        let said = |kind| {
            let event = EngineEvent { at: Time::from_micros(5), kind };
            let event = Event::new(&event, "2026-01-01T00:00:00Z".into(), &names, &objects);
            (event.kind.clone(), event.summary)
        };
        let served = said(EventKind::Served { person: PersonId(3), object: 0 });
        assert_eq!(served, ("served".into(), "the column stands at kettle for Ada".into()));
        let breached = said(EventKind::RuleBreached {
            rule: RuleId(2),
            reason: covr_engine::reason::Reason::PoseTooOld(PersonId(3), 0.6),
        });
        let words = "R2 tracking: the newest pose of Ada is 0.60 s old";
        assert_eq!(breached, ("rule_breached".into(), words.into()));
        let changed = said(EventKind::ModeChanged {
            from: Mode::Following,
            to: Mode::LatchedStop,
            rule: Some(RuleId(4)),
            because: covr_engine::reason::Reason::SoftwareStop("hand".into()),
        });
        assert_eq!(changed.1, "following to latched stop: R4: software stop: hand");
        let entered = said(EventKind::StateEntered {
            from: Some("dark".into()),
            to: "walls".into(),
            why: WhyState::ZoneEntered(PersonId(3), "carpet".into()),
        });
        assert_eq!(entered, ("state_entered".into(), "the scenario is in walls: Ada entered carpet".into()));
    }
}
