//! The scenario in the engine: what it changes, when it stands, where it begins again.

use super::*;
use crate::event::WhyState;
use crate::scenario::{Condition, Prior, ScenarioSpec, StateSpec, Transition, Trigger};
use crate::scene::ZoneSpec;

fn state(id: &str, enabled: &[&str], transitions: Vec<Transition<String>>) -> StateSpec {
    StateSpec {
        id: id.into(),
        enabled: enabled.iter().map(|id| (*id).to_owned()).collect(),
        priors: Vec::new(),
        interactions: Vec::new(),
        entry: Vec::new(),
        transitions,
        is_final: false,
    }
}

fn way(on: Vec<Trigger<String>>, when: Option<Condition<String>>, to: &str) -> Transition<String> {
    Transition { on, when, to: Some(to.into()), acts: Vec::new() }
}

/// `left` alone, then by a cue `right` alone, then by a touch both; a second in the last ends it.
fn scene(room: &Room) -> Arc<Scene> {
    let mut spec = room.engine.scene().spec().clone();
    spec.zones = vec![ZoneSpec {
        id: "corner".into(),
        shape: KeepOutShape::Circle { centre: Floor::new(0.5, 0.5), radius_m: 0.3 },
    }];
    let mut both =
        state("both", &["left", "right"], vec![way(vec![], Some(Condition::TimeInState(1.0)), "end")]);
    both.priors = vec![("left".into(), Prior::constant(0.9)), ("right".into(), Prior::constant(0.1))];
    let mut end = state("end", &[], vec![]);
    end.is_final = true;
    let states = vec![
        state(
            "first",
            &["left"],
            vec![
                way(vec![Trigger::Cue("on".into()), Trigger::ClientEvent("done".into())], None, "second"),
                way(vec![Trigger::ZoneEntered("corner".into())], None, "both"),
            ],
        ),
        state(
            "second",
            &["right"],
            vec![
                way(vec![Trigger::TouchBegan("right".into())], None, "both"),
                way(vec![], Some(Condition::LooksAt { object: "right".into(), secs: 2.0 }), "end"),
            ],
        ),
        both,
        end,
    ];
    let anywhere = vec![way(vec![Trigger::Cue("again".into())], None, "first")];
    spec.scenario = Some(ScenarioSpec { initial: "first".into(), variables: vec![], states, anywhere });
    Arc::new(Scene::build(spec).unwrap())
}

fn playing() -> Room {
    let mut room = Room::new(None);
    room.run(0.1);
    let scene = scene(&room);
    assert_eq!(room.engine.request(room.now, Request::ActivateScene(scene)).outcome, Outcome::Accepted);
    room.ask(RequestKind::Home);
    room.run(0.5);
    room.ask(RequestKind::Arm);
    room.run(0.1);
    assert_eq!(room.engine.mode(), Mode::Following);
    room
}

fn shown(room: &Room) -> crate::snapshot::ScenarioState {
    room.engine.snapshot(room.now).scenario.unwrap()
}

fn now_in(room: &Room) -> String {
    shown(room).state
}

fn cue(room: &mut Room, name: &str) -> Answer {
    room.engine.request(room.now, Request::Cue(name.into()))
}

fn entered(room: &mut Room) -> Vec<(String, WhyState)> {
    let events = room.engine.drain_events();
    let states = events.filter_map(|event| match event.kind {
        EventKind::StateEntered { to, why, .. } => Some((to.to_string(), why)),
        _ => None,
    });
    states.collect()
}

#[test]
fn the_column_goes_to_what_the_state_enables_and_to_nothing_else() {
    let mut room = playing();
    room.enter(2.0, 0.5, 0.0);
    room.run(6.0);
    assert!(room.column().distance_m(Floor::new(3.5, 3.5)) < 0.01, "looks at right, left alone is enabled");
    assert_eq!(cue(&mut room, "on").reason, Reason::NowInState("second".into()));
    assert_eq!(room.engine.enabled(), [false, true]);
    room.run(1.5);
    assert_eq!(now_in(&room), "second");
    room.run(1.0);
    assert_eq!(now_in(&room), "end", "two seconds of looking at it");
    let states = entered(&mut room);
    assert_eq!(
        states,
        [
            ("first".into(), WhyState::Began),
            ("second".into(), WhyState::Cue("on".into())),
            ("end".into(), WhyState::ConditionHeld),
        ]
    );
}

#[test]
fn touches_zones_and_client_events_lead_on_and_say_who() {
    let mut room = playing();
    room.enter(2.0, 2.0, 2.0);
    room.run(0.5);
    let answer = room.engine.request(room.now, Request::ClientEvent("done".into()));
    assert_eq!(answer.outcome, Outcome::Accepted);
    room.engine.observe(room.now, Observation::TouchBegan(VISITOR, "right".into()));
    assert_eq!(now_in(&room), "both");
    room.run(1.1);
    assert_eq!(now_in(&room), "end");
    cue(&mut room, "again");
    room.walk_mps = (-1.0, -1.0);
    room.run(1.4);
    assert_eq!(now_in(&room), "both");
    let states = entered(&mut room);
    assert_eq!(states[2], ("both".into(), WhyState::TouchBegan(VISITOR, "right".into())));
    assert_eq!(states[5], ("both".into(), WhyState::ZoneEntered(VISITOR, "corner".into())));
}

#[test]
fn a_cue_that_nothing_waits_for_is_refused_with_what_there_is() {
    let mut room = playing();
    let known = vec!["on".to_owned(), "again".to_owned()];
    assert_eq!(cue(&mut room, "off").reason, Reason::NoSuchCue { cue: "off".into(), known });
    cue(&mut room, "on");
    let answer = cue(&mut room, "on");
    assert_eq!(
        answer,
        Answer {
            outcome: Outcome::Refused,
            reason: Reason::NotAwaited { name: "on".into(), state: "second".into() }
        }
    );
    room.ask(RequestKind::Disarm);
    assert_eq!(cue(&mut room, "on").reason, Reason::ScenarioStands);
    assert_eq!(
        Room::armed().engine.request(Time::ZERO, Request::Cue("on".into())).reason,
        Reason::NoScenario
    );
}

#[test]
fn a_game_masters_prior_counts_until_the_state_is_left() {
    let mut room = playing();
    room.engine.request(room.now, Request::SkipTo("both".into(), "test".into()));
    assert_eq!(room.engine.priors(), [0.9, 0.1]);
    room.engine.request(room.now, Request::SetPriors(vec![(1, 0.8)]));
    room.run(0.5);
    assert_eq!(room.engine.priors(), [0.9, 0.8]);
    room.run(0.6);
    assert_eq!((now_in(&room).as_str(), room.engine.priors()), ("end", &[1.0, 1.0][..]));
    room.engine.request(room.now, Request::Rewind("once more".into()));
    assert_eq!(room.engine.priors(), [0.9, 0.1]);
}

#[test]
fn in_a_protective_stop_the_scenario_stands_and_goes_on_after_it() {
    let mut room = playing();
    room.enter(2.0, 2.0, 2.0);
    room.run(0.2);
    room.engine.request(room.now, Request::SkipTo("both".into(), "test".into()));
    room.run(0.5);
    let head = room.head.take();
    room.run(3.0);
    assert_eq!(room.engine.mode(), Mode::ProtectiveStop);
    assert_eq!((now_in(&room).as_str(), shown(&room).runs), ("both", false));
    let stood_at = shown(&room).in_state_secs;
    room.head = head;
    room.run(1.2);
    assert_eq!(room.engine.mode(), Mode::Following);
    assert!(shown(&room).in_state_secs < stood_at + 0.3, "{stood_at} s before");
    room.run(0.7);
    assert_eq!(now_in(&room), "end");
}

#[test]
fn when_the_machine_is_armed_no_more_the_run_is_over_and_a_skip_says_where_the_next_begins() {
    for over in [RequestKind::Disarm, RequestKind::Stop] {
        let mut room = playing();
        cue(&mut room, "on");
        room.run(0.5);
        room.ask(over);
        assert_eq!((now_in(&room).as_str(), shown(&room).left_in.as_deref()), ("first", Some("second")));
        assert_eq!(room.engine.enabled(), [true, false]);
        room.run(2.0);
        assert_eq!(shown(&room).in_state_secs, 0.0);
        let position = room.column();
        let answer = room.engine.request(room.now, Request::SkipTo("second".into(), "where we were".into()));
        assert_eq!(answer.outcome, Outcome::Accepted);
        room.enter(2.0, 0.5, 0.0);
        room.run(2.0);
        assert_eq!(room.column(), position, "a scenario moves no machine that is not armed");
        room.ask(RequestKind::Reset);
        room.run(0.1);
        room.ask(RequestKind::Arm);
        assert_eq!(room.engine.mode(), Mode::Following);
        assert_eq!((now_in(&room).as_str(), shown(&room).left_in), ("second", None));
    }
}

#[test]
fn another_scene_begins_at_its_own_beginning() {
    let mut room = playing();
    cue(&mut room, "on");
    let again = scene(&room);
    room.engine.request(room.now, Request::ActivateScene(again));
    assert_eq!((now_in(&room).as_str(), shown(&room).left_in), ("first", None));
    entered(&mut room);
}

#[test]
fn an_object_switched_off_keeps_its_near_zone_while_the_column_moves() {
    let mut room = playing();
    // Near to `left`, far from the column, which comes.
    room.enter(3.0, 3.4, 0.0);
    room.run(1.0);
    assert!(room.report.velocity.norm() > 0.1);
    cue(&mut room, "on");
    assert_eq!(room.engine.enabled(), [false, true]);
    let near = |room: &Room| room.engine.persons[0].nearest_object_m();
    let mut steps = 0;
    while room.report.velocity.norm() > 0.01 {
        room.step();
        if room.report.velocity.norm() > 0.01 {
            assert!(near(&room) < 0.75, "{} m", near(&room));
        }
        steps += 1;
        if steps > 3000 {
            break;
        }
    }
    room.ask(RequestKind::Disarm);
    room.run(0.5);
    // The next run begins with `left` again.
    assert!(near(&room) < 0.75);
    room.engine.request(room.now, Request::SkipTo("end".into(), "test".into()));
    room.run(0.1);
    assert_eq!(near(&room), f64::INFINITY);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// Same inputs, same decisions and events, with a scenario in play.
    #[test]
    fn a_play_can_be_played_again(deeds in prop::collection::vec((0_u8..7, 1_u8..100), 1..30)) {
        let run = || {
            let mut room = playing();
            room.enter(2.0, 2.0, 0.5);
            let mut seen = Vec::new();
            for (deed, steps) in &deeds {
                match deed {
                    0 => drop(cue(&mut room, "on")),
                    1 => drop(cue(&mut room, "again")),
                    2 => room.engine.observe(room.now, Observation::TouchBegan(VISITOR, "right".into())),
                    3 => room.engine.observe(room.now, Observation::TouchEnded(VISITOR, "right".into())),
                    4 => drop(room.engine.request(room.now, Request::Rewind("test".into()))),
                    5 => room.head = Some((2.0, 2.0, f64::from(*steps) * 0.06)),
                    _ => room.walk_mps = (f64::from(*steps) * 0.01 - 0.5, 0.3),
                }
                for _ in 0..*steps {
                    seen.push(format!("{:?}", room.step()));
                }
                seen.push(format!("{:?} {:?}", room.engine.drain_events().collect::<Vec<_>>(), shown(&room)));
            }
            seen
        };
        prop_assert_eq!(run(), run());
    }
}
