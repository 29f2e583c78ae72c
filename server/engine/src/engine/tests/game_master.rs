//! R11: a game master's dashboard must be connected to arm.

use super::*;
use crate::safety::supervisor::demand;
use crate::snapshot::RuleStatus;

impl Room {
    /// Homed, of a machine that needs a game master; nobody is at a dashboard.
    fn that_needs_a_game_master() -> Self {
        let mut room = Self::new(None);
        let config = EngineConfig { needs_game_master: true, ..room.engine.config().clone() };
        room.engine = Engine::new(config, room.engine.scene().clone());
        room.ask(RequestKind::Home);
        room.run(0.5);
        assert_eq!(room.engine.mode(), Mode::Ready, "homing needs none");
        room
    }

    fn game_master(&mut self, present: bool) {
        self.engine.observe(self.now, Observation::GameMaster(present));
    }

    fn rule_11(&self) -> (RuleStatus, Reason) {
        let rule = &self.engine.snapshot(self.now).rules[10];
        (rule.status, rule.reason.clone())
    }
}

#[test]
fn without_a_game_master_arming_is_refused_and_one_who_goes_is_told_of_and_stops_nothing() {
    let mut room = Room::that_needs_a_game_master();
    assert_eq!(room.rule_11(), (RuleStatus::Limiting, Reason::GameMasterAbsent));
    let answer = room.ask(RequestKind::Arm);
    assert_eq!(answer, Answer { outcome: Outcome::Refused, reason: Reason::GameMasterAbsent });
    room.game_master(true);
    room.step();
    assert_eq!(room.rule_11(), (RuleStatus::Clear, Reason::GameMasterPresent));
    assert_eq!(room.ask(RequestKind::Arm).outcome, Outcome::Accepted);
    room.enter(2.0, 3.5, 0.0);
    room.run(1.0);
    drop(room.engine.drain_events());

    room.game_master(false);
    room.run(1.0);
    assert_eq!(room.rule_11(), (RuleStatus::Breached, Reason::GameMasterAbsent));
    assert_eq!(room.engine.mode(), Mode::Following, "no interaction needs one yet");
    let kinds: Vec<_> = room.engine.drain_events().map(|event| event.kind).collect();
    let breached = EventKind::RuleBreached { rule: RuleId(11), reason: Reason::GameMasterAbsent };
    assert_eq!(kinds.iter().filter(|kind| **kind == breached).count(), 1, "{kinds:?}");
    room.game_master(true);
    room.run(0.1);
    assert!(room.engine.drain_events().any(|e| e.kind == EventKind::RuleCleared { rule: RuleId(11) }));
    assert_eq!(demand(RuleId(11)), None);
}

#[test]
fn a_machine_that_needs_none_is_armed_without() {
    let room = Room::armed();
    assert_eq!(room.rule_11(), (RuleStatus::Idle, Reason::GameMasterNotNeeded));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whoever comes and goes and whatever is asked: nobody begins to follow people without a game master, and nothing
    /// but arming is refused for want of one.
    #[test]
    fn nobody_arms_without_the_game_master_who_is_needed(
        acts in proptest::collection::vec((0usize..8, 0.004..0.4f64), 1..40),
    ) {
        let mut room = Room::that_needs_a_game_master();
        let mut present = false;
        for (act, secs) in acts {
            match act {
                6 | 7 => {
                    present = act == 6;
                    room.game_master(present);
                }
                kind => {
                    let (kind, before) = (RequestKind::ALL[kind], room.engine.mode());
                    let answer = room.ask(kind);
                    let arms = before != Mode::Following && room.engine.mode() == Mode::Following;
                    prop_assert!(!arms || present, "{kind:?} in {before:?}");
                    let wants_one = answer.reason == Reason::GameMasterAbsent;
                    prop_assert!(!wants_one || (kind == RequestKind::Arm && !present), "{kind:?} in {before:?}");
                }
            }
            room.run(secs);
            prop_assert!(room.rule_11().0 != RuleStatus::Clear || present);
        }
    }
}
