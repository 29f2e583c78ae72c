//! One step of a scenario: time passes, somebody looks and touches, every condition of the present state is looked at.

use std::time::Instant;

use covr_engine::observation::PersonId;
use covr_engine::scenario::{
    Comparison, Condition, Happening, Names, Play, Prior, Scenario, ScenarioSpec, StateSpec, Transition,
    Trigger, Value, VariableSpec,
};
use covr_engine::time::Span;

use crate::Effort;
use crate::samples::Samples;
use crate::table::Row;

/// The rows of the scenario.
pub fn measure(effort: Effort) -> Vec<Row> {
    let batches = effort.of(2_000, 20);
    vec![
        row("scenario step, 100 states of 10 ways", 10, batches),
        row("scenario step, 100 states of 50 ways", 50, batches),
    ]
}

fn row(what: &str, ways: usize, batches: u32) -> Row {
    let ids: Vec<String> = (0..OBJECTS).map(|i| format!("object {i}")).collect();
    let objects: Vec<&str> = ids.iter().map(String::as_str).collect();
    let scenario = Scenario::build(&spec(ways), Names { objects: &objects, zones: &["zone"] }).unwrap();
    let mut play = Play::new(&scenario, OBJECTS);
    let cue = Trigger::Cue(scenario.cue_of("next").unwrap());
    let (mut took, mut entered) = (Samples::default(), 0_usize);
    for batch in 0..batches + WARM_UP {
        let began = Instant::now();
        for step in 0..BATCH {
            let object = (step as usize) % OBJECTS;
            let clock = play.clock();
            play.senses_mut().look(PersonId(1), object, if step % 3 == 0 { 0.05 } else { 0.5 }, clock);
            play.senses_mut().stand_column(std::iter::once(object));
            let mut changes = play.pass(&scenario, Span::from_millis(4));
            changes.extend(play.touch(&scenario, PersonId(1), object, true));
            changes.extend(play.let_go(&scenario, PersonId(1), object, true));
            if step % 50 == 0 {
                changes.extend(play.happen(&scenario, Happening { trigger: cue, person: None }, true).1);
            }
            for object in 0..OBJECTS {
                std::hint::black_box(play.prior(&scenario, object));
            }
            entered += changes.len();
        }
        if batch >= WARM_UP {
            took.add(began.elapsed().as_secs_f64() * 1e6 / f64::from(BATCH));
        }
    }
    assert!(entered > 0, "the scenario went on");
    let (median, p99) = (took.median(), took.percentile(0.99));
    Row {
        what: what.into(),
        figure: format!("median {median:.2} us"),
        beside: format!("99th percentile {p99:.2} us"),
        ratio: format!("{:.2}", median / LIMIT_MICROS),
        limit: format!("median under {LIMIT_MICROS} us"),
        met: Some(median < LIMIT_MICROS),
        how: format!(
            "{batches} times the mean of {BATCH} steps; each with a look, a touch, its end and {OBJECTS} priors, a cue every 50"
        ),
    }
}

/// A hundred states in a ring; each way but the last waits for something that does not come.
fn spec(ways: usize) -> ScenarioSpec {
    let object = |i: usize| format!("object {}", i % OBJECTS);
    let states = (0..STATES).map(|state| {
        let way = |i: usize| {
            let when = Condition::All(vec![
                Condition::Any(vec![
                    Condition::Touching { object: object(i), secs: 10.0 },
                    Condition::LooksAt { object: object(i + 1), secs: 20.0 },
                ]),
                Condition::Not(Box::new(Condition::InPlace(object(i + 2)))),
                Condition::Variable {
                    variable: "n".into(),
                    is: Comparison::AtLeast,
                    value: Value::Integer(1),
                },
            ]);
            Transition { on: Vec::new(), when: Some(when), to: Some(id(state + 1)), acts: Vec::new() }
        };
        let mut transitions: Vec<_> = (1..ways).map(way).collect();
        let on = vec![Trigger::Cue("next".to_owned())];
        transitions.push(Transition { on, when: None, to: Some(id(state + 1)), acts: Vec::new() });
        StateSpec {
            id: id(state),
            enabled: (0..OBJECTS).map(object).collect(),
            priors: (0..OBJECTS)
                .map(|i| (object(i), Prior { per_s: 0.01, ..Prior::constant(0.1) }))
                .collect(),
            interactions: Vec::new(),
            entry: Vec::new(),
            transitions,
            is_final: false,
        }
    });
    ScenarioSpec {
        initial: id(0),
        variables: vec![VariableSpec { id: "n".into(), start: Value::Integer(1) }],
        states: states.collect(),
        anywhere: Vec::new(),
    }
}

fn id(state: usize) -> String {
    format!("state {}", state % STATES)
}

const STATES: usize = 100;
const OBJECTS: usize = 10;
const BATCH: u32 = 1_000;
const WARM_UP: u32 = 5;
const LIMIT_MICROS: f64 = 5.0;
