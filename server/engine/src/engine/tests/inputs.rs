//! Digital inputs: the stop (R4) and the intruder (R12).

use super::*;
use crate::observation::{InputLevel, Inputs};

impl Room {
    fn intruder(&mut self, level: InputLevel) {
        let inputs = Inputs { intruder: level, ..Inputs::default() };
        self.engine.observe(self.now, Observation::Inputs(inputs));
    }

    fn stop_input(&mut self, level: InputLevel) {
        let inputs = Inputs { stop: level, ..Inputs::default() };
        self.engine.observe(self.now, Observation::Inputs(inputs));
    }
}

fn active() -> InputLevel {
    InputLevel::Active("curtain".into())
}

fn silent() -> InputLevel {
    InputLevel::Silent("curtain".into())
}

#[test]
fn an_intruder_is_a_protective_stop_that_clears_only_with_the_input_inactive() {
    for level in [active(), silent()] {
        let mut room = Room::armed();
        room.enter(2.0, 3.5, 0.0);
        room.run(1.0);
        room.intruder(level);
        room.run(10.0);
        assert_eq!(room.engine.mode(), Mode::ProtectiveStop);
        assert_eq!(room.engine.snapshot(room.now).stop.unwrap().rule, RuleId(12));
        assert_eq!(room.ask(RequestKind::Reset).outcome, Outcome::Refused);
        assert_eq!(room.report.velocity, Planar::ZERO);
        room.intruder(InputLevel::Inactive);
        room.run(0.9);
        assert_eq!(room.engine.mode(), Mode::ProtectiveStop, "not before 1 s");
        room.run(0.2);
        assert_eq!(room.engine.mode(), Mode::Following);
    }
}

#[test]
fn nothing_that_is_asked_moves_the_column_while_an_intruder_is_noticed() {
    let mut room = Room::new(None);
    room.enter(3.0, 3.0, 0.0);
    room.intruder(active());
    room.run(0.1);
    room.ask(RequestKind::Home);
    assert_eq!(room.step().action(), Action::Hold);
    assert_eq!(room.engine.mode(), Mode::ProtectiveStop);
    room.intruder(InputLevel::Inactive);
    room.run(2.0);
    assert_eq!(room.engine.mode(), Mode::Ready);
    room.intruder(active());
    room.ask(RequestKind::Arm);
    let place = room.column();
    room.run(2.0);
    assert_eq!((room.engine.mode(), room.column()), (Mode::ProtectiveStop, place));
}

#[test]
fn a_stop_input_latches_in_every_mode_and_no_reset_leaves_it_while_it_is_active() {
    for level in [active(), silent()] {
        let mut room = Room::armed();
        room.enter(2.0, 3.5, 0.0);
        room.run(1.0);
        room.stop_input(level);
        assert_eq!(room.step().action(), Action::Hold, "the first command after it brakes");
        assert_eq!(room.engine.snapshot(room.now).stop.unwrap().rule, RuleId(4));
        room.run(1.0);
        assert_eq!(room.step().action(), Action::Release);
        let answer = room.ask(RequestKind::Reset);
        assert!(
            matches!(&answer.reason, Reason::CauseStillThere { rule: RuleId(4), .. }),
            "refused with its cause: {answer:?}"
        );
        assert_eq!(room.engine.mode(), Mode::LatchedStop);
        room.stop_input(InputLevel::Inactive);
        room.run(1.0);
        assert_eq!(room.engine.mode(), Mode::LatchedStop, "it stays when the input is let go");
        assert_eq!(room.ask(RequestKind::Reset).outcome, Outcome::Accepted);
        room.run(0.1);
        assert_eq!(room.engine.mode(), Mode::Disarmed);
        room.stop_input(active());
        room.step();
        assert_eq!(room.engine.mode(), Mode::LatchedStop, "from disarmed too");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Whatever the visitor does and whatever is asked, after the braking nothing moves until the input is inactive.
    #[test]
    fn with_an_intruder_nothing_moves_after_the_braking(
        x in 0.2..3.8f64, y in 0.2..3.8f64, yaw in -3.1..3.1f64, walk in (-1.6..1.6f64, -1.6..1.6f64),
        wait in 0.0..3.0f64, asks in proptest::collection::vec((0usize..3, 0.05..0.5f64), 0..8), is_silent: bool,
    ) {
        let mut room = Room::armed_with(OURS);
        prop_assume!(room.column().distance_m(Floor::new(x, y)) > 1.0);
        room.enter(x, y, yaw);
        room.run(wait);
        room.intruder(if is_silent { silent() } else { active() });
        room.walk_mps = walk;
        room.run(1.0);
        room.walk_mps = (0.0, 0.0);
        let place = room.column();
        for (ask, secs) in asks {
            room.ask([RequestKind::Arm, RequestKind::Home, RequestKind::Disarm][ask]);
            room.run(secs);
            prop_assert!(room.column() == place && room.report.velocity == Planar::ZERO);
        }
        room.run(0.5);
        prop_assert_eq!(room.column(), place);
    }
}
