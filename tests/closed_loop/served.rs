//! The point of it all: the column is at the object before the hand is.

use std::sync::Arc;

use covr_engine::EngineConfig;
use covr_engine::frames::Floor;
use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::motion::MotionName;
use covr_engine::observation::{Observation, PersonId, PoseSample};
use covr_engine::safety::separation::KeptFrom;
use covr_engine::scene::Scene;
use covr_engine::time::{Span, Time};
use covr_gantry::contract::Gantry;
use covr_gantry::sim::SimulatedMachine;
use covr_gantry::sim::parameters::MachineParameters;
use covr_study::random::Random;
use covr_study::replay::{ClosedLoop, LinkProfile, TrueHead};
use covr_study::visitor::{Phase, Visitor};

/// The scene that `make run` shows.
fn demo_scene() -> Scene {
    let document = include_bytes!("../../deploy/scenes/demo.json");
    covr_wire::scene::parse_scene(document).expect("the demo scene is right").1
}

#[test]
fn the_column_is_there_before_the_hand_in_at_least_half_of_the_reaches() {
    let scene = Arc::new(demo_scene());
    let arena = scene.spec().arena;
    let parameters = MachineParameters { start: Floor::new(0.2, 0.2), ..MachineParameters::paper(arena) };
    let machine = Box::new(SimulatedMachine::new(parameters).expect("the paper's machine is possible"));
    let config = EngineConfig {
        limits: machine.limits(),
        travel: arena,
        period: Span::from_millis(4),
        intention_rule: RuleName::PaperBest,
        intention: IntentionParameters::default(),
        motion: MotionName::Proxy,
        standing: None,
        kept_from: KeptFrom::Everybody,
        v_h_mps: 1.6,
        needs_game_master: false,
        latched_because: None,
    };
    let mut control = ClosedLoop::new(
        config,
        Arc::clone(&scene),
        machine,
        LinkProfile::WIRELESS,
        Random::seeded(1),
        Time::ZERO,
    );
    control.bring_up(Span::from_millis(60_000)).expect("it homes and arms");

    let person = PersonId(1);
    control.observe(Observation::PersonEntered(person));
    // One visitor, seen at the control rate for the truth and at every third of it by the headset: 83 Hz.
    let began = control.now();
    let (mut reaches, mut served) = (0, 0);
    let mut before = Phase::Reads;
    for (i, sample) in Visitor::of_scene(scene.spec(), 250.0, 1).enumerate() {
        let head = TrueHead { person, pose: sample.pose };
        if i % 3 == 0 {
            let taken_at = began + (sample.at - Time::ZERO);
            control.send(
                person,
                PoseSample { taken_at, pose: sample.pose, tracked: true, worn: true, hands: sample.hands },
            );
        }
        let truth = control.step(&[head]).truth;
        // The hand is at the object when reaching ends.
        if before == Phase::Reaches && sample.phase == Phase::Dwells {
            reaches += 1;
            let goal = sample.goal.expect("a reach has a goal");
            let off_m = truth.position.distance_m(scene.objects()[goal].column_place());
            served += u32::from(off_m <= 0.1 && truth.velocity.norm() < 0.05);
        }
        before = sample.phase;
        if reaches == 40 {
            break;
        }
    }
    println!("served {served} of {reaches} reaches");
    assert!(2 * served >= reaches, "served {served} of {reaches} reaches");
    let (truth, commanded) = (control.true_verdict(), control.commanded_verdict());
    assert_eq!(truth.violations() + commanded.violations(), 0, "{:?} {:?}", truth.first, commanded.first);
}
