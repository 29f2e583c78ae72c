//! The statechart by hand and at random.

use super::*;
use crate::observation::PersonId;
use crate::time::Span;
use proptest::prelude::*;

const OBJECTS: [&str; 3] = ["bulb", "left", "right"];
const ZONES: [&str; 1] = ["carpet"];
const NAMES: Names<'static> = Names { objects: &OBJECTS, zones: &ZONES };
const ADA: PersonId = PersonId(1);
const STEP: Span = Span::from_millis(4);

fn state(id: &str, transitions: Vec<Transition<String>>) -> StateSpec {
    StateSpec {
        id: id.into(),
        enabled: Vec::new(),
        priors: Vec::new(),
        interactions: Vec::new(),
        entry: Vec::new(),
        transitions,
        is_final: false,
    }
}

fn way(on: &[Trigger<&str>], when: Option<Condition<String>>, to: &str) -> Transition<String> {
    let owned = |trigger: &Trigger<&str>| match *trigger {
        Trigger::TouchBegan(id) => Trigger::TouchBegan(id.to_owned()),
        Trigger::TouchEnded(id) => Trigger::TouchEnded(id.to_owned()),
        Trigger::ZoneEntered(id) => Trigger::ZoneEntered(id.to_owned()),
        Trigger::ZoneLeft(id) => Trigger::ZoneLeft(id.to_owned()),
        Trigger::ClientEvent(id) => Trigger::ClientEvent(id.to_owned()),
        Trigger::InteractionDone(id) => Trigger::InteractionDone(id.to_owned()),
        Trigger::Cue(id) => Trigger::Cue(id.to_owned()),
    };
    Transition { on: on.iter().map(owned).collect(), when, to: Some(to.into()), acts: Vec::new() }
}

fn scenario(states: Vec<StateSpec>) -> ScenarioSpec {
    ScenarioSpec { initial: states[0].id.clone(), variables: Vec::new(), states, anywhere: Vec::new() }
}

fn touching(object: &str, secs: f64) -> Condition<String> {
    Condition::Touching { object: object.into(), secs }
}

fn not(condition: Condition<String>) -> Condition<String> {
    Condition::Not(Box::new(condition))
}

fn compare(variable: &str, is: Comparison, value: i64) -> Condition<String> {
    Condition::Variable { variable: variable.into(), is, value: Value::Integer(value) }
}

fn problems(spec: &ScenarioSpec) -> Vec<String> {
    let built = Scenario::build(spec, NAMES).err().unwrap_or_default();
    built.iter().map(|p| format!("{}: {}", p.path, p.found)).collect()
}

/// A scenario and a run of it.
struct Stagehand {
    scenario: Scenario,
    play: Play,
}

impl Stagehand {
    fn of(spec: &ScenarioSpec) -> Self {
        let scenario = Scenario::build(spec, NAMES).unwrap();
        let play = Play::new(&scenario, OBJECTS.len());
        Self { scenario, play }
    }

    fn state(&self) -> &str {
        self.scenario.states()[self.play.state()].id()
    }

    fn wait(&mut self, secs: f64) {
        for _ in 0..(secs / STEP.secs()).round() as usize {
            self.play.pass(&self.scenario, STEP);
        }
    }

    fn cue(&mut self, name: &str) -> bool {
        let trigger = Trigger::Cue(self.scenario.cue_of(name).unwrap());
        self.play.happen(&self.scenario, Happening { trigger, person: None }, true).0
    }

    fn touch(&mut self, object: usize) {
        self.play.touch(&self.scenario, ADA, object, true);
    }

    fn let_go(&mut self, object: usize) {
        self.play.let_go(&self.scenario, ADA, object, true);
    }
}

#[test]
fn a_held_touch_counts_without_a_break() {
    let mut stage = Stagehand::of(&scenario(vec![
        state("push", vec![way(&[], Some(touching("left", 10.0)), "gone")]),
        state("gone", vec![]),
    ]));
    stage.touch(1);
    stage.wait(9.0);
    stage.let_go(1);
    stage.touch(1);
    stage.wait(9.9);
    assert_eq!(stage.state(), "push");
    assert!((stage.play.shown(&stage.scenario).next[0].due_secs - 0.1).abs() < 0.01);
    stage.wait(0.2);
    assert_eq!(stage.state(), "gone");
}

#[test]
fn the_first_in_document_order_is_taken_and_the_states_own_before_those_from_anywhere() {
    let mut spec = scenario(vec![
        state(
            "a",
            vec![
                way(&[Trigger::Cue("go")], Some(touching("bulb", 0.0)), "b"),
                way(&[Trigger::Cue("go")], None, "c"),
            ],
        ),
        state("b", vec![]),
        state("c", vec![]),
    ]);
    spec.anywhere = vec![way(&[Trigger::Cue("go"), Trigger::Cue("back")], None, "a")];
    let mut stage = Stagehand::of(&spec);
    assert!(stage.cue("go"));
    assert_eq!(stage.state(), "c");
    assert!(stage.cue("go"));
    stage.touch(0);
    assert!(stage.cue("go"));
    assert_eq!(stage.state(), "b");
    assert!(stage.cue("back"));
    assert_eq!(stage.state(), "a");
}

#[test]
fn it_runs_to_completion_with_acts_in_order() {
    let mut spec = scenario(vec![
        state("a", vec![way(&[Trigger::TouchBegan("bulb")], None, "b")]),
        state("b", vec![way(&[], Some(compare("n", Comparison::AtLeast, 3)), "c")]),
        state("c", vec![way(&[], Some(compare("n", Comparison::Equal, 30)), "d")]),
        state("d", vec![]),
    ]);
    spec.variables = vec![VariableSpec { id: "n".into(), start: Value::Integer(1) }];
    let add = |amount| Act::Add { variable: "n".to_owned(), amount };
    spec.states[0].transitions[0].acts = vec![add(1)];
    spec.states[1].entry = vec![add(1)];
    spec.states[2].entry = vec![Act::Set { variable: "n".into(), value: Value::Integer(30) }];
    let mut stage = Stagehand::of(&spec);
    let changes = stage.play.touch(&stage.scenario, ADA, 0, true);
    let to: Vec<&str> = changes
        .iter()
        .map(|change| match change {
            Change::Entered { to, .. } => &**to,
            Change::Cut(_) => "cut",
        })
        .collect();
    assert_eq!(to, ["b", "c", "d"]);
    assert_eq!(stage.play.shown(&stage.scenario).variables, [Value::Integer(30)]);
}

#[test]
fn while_it_stands_nothing_is_taken_and_hands_let_go_all_the_same() {
    let mut stage = Stagehand::of(&scenario(vec![
        state("a", vec![way(&[Trigger::TouchBegan("bulb")], None, "b")]),
        state("b", vec![]),
    ]));
    assert_eq!(stage.play.touch(&stage.scenario, ADA, 0, false), []);
    assert_eq!(stage.play.let_go(&stage.scenario, ADA, 0, false), []);
    assert_eq!(stage.state(), "a");
    stage.touch(0);
    assert_eq!(stage.state(), "b");
}

#[test]
fn a_rewind_brings_the_variables_back_and_a_skip_leaves_them() {
    let mut spec =
        scenario(vec![state("a", vec![way(&[Trigger::Cue("go")], None, "b")]), state("b", vec![])]);
    spec.variables = vec![VariableSpec { id: "n".into(), start: Value::Integer(0) }];
    spec.states[1].entry = vec![Act::Add { variable: "n".into(), amount: 1 }];
    let mut stage = Stagehand::of(&spec);
    let number = |stage: &Stagehand| stage.play.shown(&stage.scenario).variables[0];
    assert_eq!(stage.play.rewind(&stage.scenario, "nothing before".into()), None);
    stage.cue("go");
    assert_eq!(number(&stage), Value::Integer(1));
    stage.play.skip(&stage.scenario, 1, "once more".into());
    assert_eq!(number(&stage), Value::Integer(2));
    stage.play.rewind(&stage.scenario, "too far".into()).unwrap();
    assert_eq!((stage.state(), number(&stage)), ("b", Value::Integer(1)));
    stage.play.rewind(&stage.scenario, "too far".into()).unwrap();
    assert_eq!((stage.state(), number(&stage)), ("a", Value::Integer(0)));
    stage.cue("go");
    stage.play.restart(&stage.scenario);
    assert_eq!((stage.state(), number(&stage)), ("a", Value::Integer(0)));
    assert_eq!(stage.play.shown(&stage.scenario).left_in, Some(1));
}

#[test]
fn priors_change_with_time_and_touches_within_their_bounds() {
    let mut spec = scenario(vec![state("a", vec![])]);
    spec.states[0].enabled = vec!["left".into()];
    let prior = Prior { value: 0.2, per_s: 0.1, per_touch: -0.15, least: 0.1, most: 0.6 };
    spec.states[0].priors = vec![("left".into(), prior)];
    let mut stage = Stagehand::of(&spec);
    let now = |stage: &Stagehand| stage.play.prior(&stage.scenario, 1).unwrap();
    assert_eq!(now(&stage), 0.2);
    assert_eq!(stage.play.prior(&stage.scenario, 0), None);
    stage.wait(2.05);
    assert!((now(&stage) - 0.4).abs() < 1e-9);
    stage.touch(1);
    assert!((now(&stage) - 0.25).abs() < 1e-9);
    stage.wait(20.0);
    assert_eq!(now(&stage), 0.6);
}

#[test]
fn references_kinds_and_ranges_are_all_reported_at_their_place() {
    let mut spec = scenario(vec![
        state(
            "a",
            vec![way(&[Trigger::TouchBegan("nobody")], Some(Condition::InZone("nowhere".into())), "b")],
        ),
        state("a", vec![Transition { on: vec![], when: None, to: None, acts: vec![] }]),
    ]);
    spec.initial = "z".into();
    spec.variables = vec![VariableSpec { id: "yes".into(), start: Value::Boolean(true) }];
    spec.states[0].enabled = vec!["bulb".into(), "bulb".into()];
    spec.states[0].priors = vec![("left".into(), Prior::constant(1.5))];
    spec.states[0].interactions = vec![("bulb".into(), Interaction::StepBack { distance_m: 9.0 })];
    spec.states[0].entry = vec![Act::Add { variable: "yes".into(), amount: 1 }];
    spec.anywhere = vec![way(&[Trigger::Cue("x")], Some(compare("yes", Comparison::Less, 3)), "a")];
    spec.states[1].is_final = true;
    assert_eq!(
        problems(&spec),
        [
            "states[1].id: \"a\", already the id of states[0]",
            "initial: \"z\"",
            "states[0].enabled[1]: \"bulb\"",
            "states[0].priors.left.value: 1.5",
            "states[0].priors.left: 0 to 1 with a value of 1.5",
            "states[0].priors.left: a prior of an object that is not enabled here",
            "states[0].interactions.bulb.distance: 9",
            "states[0].entry[0].variable: \"yes\"",
            "states[0].transitions[0].on[0].object: \"nobody\"",
            "states[0].transitions[0].when.zone: \"nowhere\"",
            "states[0].transitions[0].to: \"b\"",
            "states[1].transitions[0]: neither `on` nor `to`",
            "states[1].transitions: 1 transitions",
            "anywhere[0].when.value: 3",
        ]
    );
}

#[test]
fn cycles_that_need_nothing_to_happen_are_refused_and_others_are_not() {
    let pair = |there: Option<Condition<String>>, back: Option<Condition<String>>| {
        let mut spec =
            scenario(vec![state("a", vec![way(&[], there, "b")]), state("b", vec![way(&[], back, "a")])]);
        spec.variables = vec![VariableSpec { id: "n".into(), start: Value::Integer(0) }];
        spec.states[0].entry = vec![Act::Add { variable: "n".into(), amount: 0 }];
        spec
    };
    let touch = || Some(touching("left", 0.0));
    for endless in [pair(None, None), pair(touch(), None), pair(touch(), Some(touching("right", 0.0)))] {
        let found = problems(&endless);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(
            found[0].contains("a cycle") && found[0].starts_with("states[1].transitions[0]"),
            "{found:?}"
        );
    }
    for ends in [
        pair(touch(), Some(not(touching("left", 0.0)))),
        pair(touch(), Some(Condition::TimeInState(0.5))),
        pair(touch(), Some(touching("right", 5.0))),
        pair(Some(touching("left", 3.0)), Some(not(touching("left", 1.0)))),
        pair(None, Some(Condition::All(vec![touching("left", 2.0), not(touching("left", 2.0))]))),
    ] {
        assert_eq!(problems(&ends), [""; 0]);
    }
    // What the cycle itself counts is not counted on.
    let counts = pair(Some(compare("n", Comparison::Less, 3)), Some(compare("n", Comparison::AtLeast, 3)));
    assert_eq!(problems(&counts).len(), 1);
}

#[test]
fn findings_name_what_is_worth_a_second_look() {
    let mut spec = scenario(vec![
        state(
            "a",
            vec![
                way(&[Trigger::TouchBegan("right")], None, "b"),
                way(&[Trigger::Cue("go")], None, "b"),
                way(&[Trigger::Cue("go")], Some(Condition::InZone("carpet".into())), "b"),
                way(
                    &[],
                    Some(Condition::All(vec![touching("left", 5.0), not(touching("left", 2.0))])),
                    "island",
                ),
            ],
        ),
        state("b", vec![]),
        state("island", vec![way(&[], None, "b")]),
    ]);
    spec.states[0].enabled = vec!["left".into(), "bulb".into()];
    spec.states[0].priors =
        vec![("left".into(), Prior::constant(0.5)), ("bulb".into(), Prior::constant(0.7))];
    spec.variables = vec![VariableSpec { id: "n".into(), start: Value::Integer(0) }];
    let scenario = Scenario::build(&spec, NAMES).unwrap();
    let stage = Stage { objects: &OBJECTS, zones: &ZONES, priors: &[1.0; 3], enabled: &[true; 3] };
    let found: Vec<String> =
        scenario.findings(stage).into_iter().map(|f| format!("{}: {}", f.path, f.words)).collect();
    assert_eq!(
        found,
        [
            "states[0].transitions[0].on[0]: waits for a touch of \"right\", which is not enabled here",
            "states[0].transitions[2]: never taken: a way before it is always taken for the same event",
            "states[0].transitions[3]: never taken: its condition can never hold",
            "states[0].priors: the priors add up to 1.20 and not to 1: only their ratios count",
            "states[1]: nothing leads on from the state \"b\", and it is not marked as final",
            "states[2]: nothing leads to the state \"island\"; the game master alone can skip to it",
            "states[2].transitions[0]: always taken at once: the state \"island\" does not last",
            "variables[0]: nothing ever changes \"n\"",
            "states: no state enables the object \"right\"",
        ]
    );
}

fn condition() -> impl Strategy<Value = Condition<String>> {
    let object = || prop::sample::select(OBJECTS.to_vec()).prop_map(str::to_owned);
    let secs = || prop::sample::select(vec![0.0, 0.01, 0.1, 1.0]);
    let leaf = prop_oneof![
        (object(), secs()).prop_map(|(object, secs)| Condition::Touching { object, secs }),
        (object(), secs()).prop_map(|(object, secs)| Condition::LooksAt { object, secs }),
        Just(Condition::InZone("carpet".to_owned())),
        object().prop_map(Condition::InPlace),
        secs().prop_map(Condition::TimeInState),
        (
            0_i64..4,
            prop::sample::select(vec![
                Comparison::Equal,
                Comparison::NotEqual,
                Comparison::Less,
                Comparison::AtLeast
            ])
        )
            .prop_map(|(value, is)| compare("n", is, value)),
    ];
    leaf.prop_recursive(2, 6, 3, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 1..3).prop_map(Condition::All),
            prop::collection::vec(inner.clone(), 1..3).prop_map(Condition::Any),
            inner.prop_map(not),
        ]
    })
}

fn transition(states: usize) -> impl Strategy<Value = Transition<String>> {
    let trigger = prop_oneof![
        prop::sample::select(OBJECTS.to_vec()).prop_map(|id| Trigger::TouchBegan(id.to_owned())),
        prop::sample::select(OBJECTS.to_vec()).prop_map(|id| Trigger::TouchEnded(id.to_owned())),
        Just(Trigger::ZoneEntered("carpet".to_owned())),
        Just(Trigger::Cue("go".to_owned())),
    ];
    let act = prop_oneof![
        (0_i64..4).prop_map(|n| Act::Set { variable: "n".to_owned(), value: Value::Integer(n) }),
        (-1_i64..2).prop_map(|amount| Act::Add { variable: "n".to_owned(), amount }),
    ];
    (
        prop::collection::vec(trigger, 0..3),
        prop::option::of(condition()),
        0..states,
        prop::collection::vec(act, 0..2),
    )
        .prop_map(|(on, when, to, acts)| Transition { on, when, to: Some(format!("s{to}")), acts })
}

fn any_scenario() -> impl Strategy<Value = ScenarioSpec> {
    (2_usize..7)
        .prop_flat_map(|states| {
            let ways = prop::collection::vec(transition(states), 0..4);
            let enabled = prop::sample::subsequence(OBJECTS.to_vec(), 0..=3);
            (prop::collection::vec((ways, enabled), states), prop::collection::vec(transition(states), 0..2))
        })
        .prop_map(|(states, anywhere)| {
            let states = states.into_iter().enumerate().map(|(i, (ways, enabled))| StateSpec {
                enabled: enabled.into_iter().map(str::to_owned).collect(),
                ..state(&format!("s{i}"), ways)
            });
            let variables = vec![VariableSpec { id: "n".into(), start: Value::Integer(0) }];
            ScenarioSpec { initial: "s0".into(), variables, states: states.collect(), anywhere }
        })
}

/// What may be done to a run.
#[derive(Debug, Clone, Copy)]
enum Deed {
    Touch(usize, bool),
    LetGo(usize, bool),
    Look(usize, f64),
    Stand(f64),
    Place(usize),
    Cue,
    Pass(i64),
    Skip(usize),
    Rewind,
    Leave,
}

fn deeds() -> impl Strategy<Value = Vec<Deed>> {
    let deed = prop_oneof![
        (0_usize..3, any::<bool>()).prop_map(|(object, runs)| Deed::Touch(object, runs)),
        (0_usize..3, any::<bool>()).prop_map(|(object, runs)| Deed::LetGo(object, runs)),
        (0_usize..3, 0.0..0.3).prop_map(|(object, angle)| Deed::Look(object, angle)),
        (0.0..0.1).prop_map(|d: f64| Deed::Stand(d - 0.05)),
        (0_usize..3).prop_map(Deed::Place),
        Just(Deed::Cue),
        (1_i64..2_000).prop_map(Deed::Pass),
        (0_usize..2).prop_map(Deed::Skip),
        Just(Deed::Rewind),
        Just(Deed::Leave),
    ];
    prop::collection::vec(deed, 1..60)
}

fn played(scenario: &Scenario, deeds: &[Deed]) -> (Play, Vec<Change>) {
    let mut play = Play::new(scenario, OBJECTS.len());
    let mut changes = vec![play.begin(scenario)];
    for deed in deeds {
        let clock = play.clock();
        match *deed {
            Deed::Touch(object, runs) => changes.extend(play.touch(scenario, ADA, object, runs)),
            Deed::LetGo(object, runs) => changes.extend(play.let_go(scenario, ADA, object, runs)),
            Deed::Look(object, angle) => play.senses_mut().look(ADA, object, angle, clock),
            Deed::Stand(distance) => {
                let trigger = play.senses_mut().stand(ADA, 0, distance.max(0.0));
                if let Some(trigger) = trigger {
                    changes.extend(play.happen(scenario, Happening { trigger, person: Some(ADA) }, true).1);
                }
            }
            Deed::Place(object) => play.senses_mut().stand_column(std::iter::once(object)),
            Deed::Cue => {
                if let Some(cue) = scenario.cue_of("go") {
                    changes.extend(
                        play.happen(scenario, Happening { trigger: Trigger::Cue(cue), person: None }, true).1,
                    );
                }
            }
            Deed::Pass(millis) => changes.extend(play.pass(scenario, Span::from_millis(millis))),
            Deed::Skip(state) => changes.push(play.skip(scenario, state, "test".into())),
            Deed::Rewind => changes.extend(play.rewind(scenario, "test".into())),
            Deed::Leave => {
                for trigger in play.senses_mut().leave(ADA) {
                    changes.extend(play.happen(scenario, Happening { trigger, person: Some(ADA) }, true).1);
                }
            }
        }
    }
    (play, changes)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    /// Same scenario, same deeds: the same to the last bit. And whatever passes the check never goes in circles.
    #[test]
    fn a_run_is_its_inputs_and_every_macrostep_ends(spec in any_scenario(), deeds in deeds()) {
        let Ok(scenario) = Scenario::build(&spec, NAMES) else { return Ok(()) };
        let (play, changes) = played(&scenario, &deeds);
        prop_assert_eq!(played(&Scenario::build(&spec, NAMES).unwrap(), &deeds), (play.clone(), changes.clone()));
        prop_assert!(!changes.iter().any(|change| matches!(change, Change::Cut(_))));
        prop_assert_eq!(play.shown(&scenario).entered.min(1), 1);
    }

    /// What cannot be checked is cut: without the check a macrostep ends all the same, and says so.
    #[test]
    fn a_cycle_that_got_past_the_check_is_cut(deeds in deeds()) {
        let mut spec = scenario(vec![state("s0", vec![]), state("s1", vec![])]);
        spec.states[0].transitions = vec![way(&[Trigger::Cue("go")], None, "s1")];
        let mut scenario = Scenario::build(&spec, NAMES).unwrap();
        for (from, to) in [(0, 1), (1, 0)] {
            let endless = Transition { on: vec![], when: None, to: Some(to), acts: vec![] };
            scenario.states[from].transitions.push(endless);
        }
        let (play, changes) = played(&scenario, &deeds);
        let steps = deeds.iter().filter(|deed| !matches!(deed, Deed::Look(..) | Deed::Place(_))).count();
        prop_assert!(changes.len() <= 1 + steps * 6);
        if matches!(deeds.last(), Some(Deed::Pass(_))) {
            prop_assert!(play.shown(&scenario).is_cut);
        }
    }

    /// A state enables only what is there, and findings and conditions never panic.
    #[test]
    fn a_built_scenario_speaks_of_what_is_there(spec in any_scenario()) {
        if let Ok(scenario) = Scenario::build(&spec, NAMES) {
            for (state, described) in scenario.states().iter().zip(&spec.states) {
                prop_assert_eq!(state.enabled().len(), OBJECTS.len());
                let enabled = state.enabled().iter().zip(OBJECTS).filter(|(on, _)| **on).map(|(_, id)| id);
                let described: std::collections::BTreeSet<_> = described.enabled.iter().map(String::as_str).collect();
                prop_assert_eq!(enabled.collect::<std::collections::BTreeSet<_>>(), described);
            }
            scenario.findings(Stage { objects: &OBJECTS, zones: &ZONES, priors: &[1.0; 3], enabled: &[true; 3] });
        }
    }
}
