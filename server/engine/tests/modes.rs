//! The state machine, explored: every state that any order of requests and triggers leads to, and every state times
//! every event.

use std::collections::BTreeSet;

use covr_engine::mode::{Conditions, Mode, RequestKind, Response, Trigger, react, respond};
use covr_engine::reason::Reason;

/// Everything that the next mode depends on, with two facts of the way here that the engine does not keep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct State {
    mode: Mode,
    resumes: Mode,
    /// Somebody armed it, and it has not been out of `following` and its protective stop since.
    armed: bool,
    /// A latched stop or a fault that nobody has reset.
    latched: bool,
}

/// What may happen.
#[derive(Debug, Clone)]
enum Happening {
    Asked(RequestKind, Conditions),
    Triggered(Trigger),
}

impl State {
    const START: Self = Self { mode: Mode::Disarmed, resumes: Mode::Following, armed: false, latched: false };
    const START_LATCHED: Self = Self { mode: Mode::LatchedStop, latched: true, ..Self::START };

    fn after(self, happening: &Happening) -> Self {
        let to = match happening {
            Happening::Asked(request, conditions) => match respond(self.mode, *request, conditions) {
                Response::Go(to) => to,
                Response::AlreadySo(_) | Response::Refuse(_) => return self,
            },
            Happening::Triggered(trigger) => match react(self.mode, *trigger, self.resumes) {
                Some(to) => to,
                None => return self,
            },
        };
        let arms = matches!(happening, Happening::Asked(RequestKind::Arm, _));
        let resets = matches!(happening, Happening::Asked(RequestKind::Reset, _));
        let stands_armed = matches!(to, Mode::Following | Mode::ProtectiveStop);
        Self {
            mode: to,
            resumes: if to == Mode::ProtectiveStop { self.mode } else { self.resumes },
            armed: stands_armed && (self.armed || arms),
            latched: matches!(to, Mode::LatchedStop | Mode::Faulted) || (self.latched && !resets),
        }
    }
}

/// Every request under every combination of conditions, and every trigger.
fn happenings() -> Vec<Happening> {
    let mut all: Vec<_> = Trigger::ALL.map(Happening::Triggered).into();
    for request in RequestKind::ALL {
        for homed in [false, true] {
            for moves in [false, true] {
                for game_master_absent in [false, true] {
                    for cause_still_there in [None, Some(Reason::NoAnswerYet)] {
                        let conditions = Conditions { homed, moves, game_master_absent, cause_still_there };
                        all.push(Happening::Asked(request, conditions));
                    }
                }
            }
        }
    }
    all
}

/// Every state that can be reached from either start.
fn reachable() -> Vec<State> {
    let mut found = vec![State::START, State::START_LATCHED];
    let mut next = 0;
    while next < found.len() {
        for happening in happenings() {
            let after = found[next].after(&happening);
            if !found.contains(&after) {
                found.push(after);
            }
        }
        next += 1;
    }
    found
}

/// Every step that can be taken.
fn steps() -> Vec<(State, Happening, State)> {
    let from = reachable().into_iter();
    from.flat_map(|state| {
        happenings().into_iter().map(move |happening| {
            let after = state.after(&happening);
            (state, happening, after)
        })
    })
    .collect()
}

#[test]
fn every_mode_is_reached_and_the_states_are_few() {
    let states = reachable();
    let modes: BTreeSet<_> = states.iter().map(|state| state.mode.name()).collect();
    assert_eq!(modes.len(), Mode::ALL.len(), "{modes:?}");
    assert!(states.len() <= 30, "{} states: small enough to draw no more", states.len());
}

#[test]
fn only_a_reset_leaves_a_latched_stop_or_a_fault_and_it_needs_the_cause_gone() {
    for (from, happening, to) in steps() {
        if from.latched && !to.latched {
            let reset = matches!(
                &happening,
                Happening::Asked(RequestKind::Reset, Conditions { cause_still_there: None, .. })
            );
            assert!(reset, "{from:?} -- {happening:?} --> {to:?}");
        }
        let is_held = |state: State| matches!(state.mode, Mode::LatchedStop | Mode::Faulted);
        assert_eq!(is_held(to), to.latched, "{from:?} -- {happening:?} --> {to:?}");
    }
}

#[test]
fn reset_leads_to_disarmed_and_nowhere_else() {
    for (from, happening, to) in steps() {
        if matches!(happening, Happening::Asked(RequestKind::Reset, _)) && from != to {
            assert_eq!(to.mode, Mode::Disarmed, "{from:?}");
        }
    }
}

#[test]
fn nothing_follows_people_that_nobody_armed() {
    for state in reachable() {
        assert!(state.mode != Mode::Following || state.armed, "{state:?}");
        let would_follow = state.mode == Mode::ProtectiveStop && state.resumes == Mode::Following;
        assert!(!would_follow || state.armed, "{state:?}");
    }
}

#[test]
fn arm_and_home_need_rest_and_arm_a_home() {
    for (from, happening, to) in steps() {
        if let Happening::Asked(request @ (RequestKind::Arm | RequestKind::Home), conditions) = &happening
            && from != to
        {
            let may_arm = *request == RequestKind::Home || !conditions.game_master_absent;
            assert!(may_arm, "{from:?} -- {happening:?} --> {to:?}");
            assert!(!conditions.moves, "{from:?} -- {happening:?} --> {to:?}");
            let homed = conditions.homed || from.mode == Mode::Ready;
            assert!(*request == RequestKind::Home || homed, "{from:?} -- {happening:?} --> {to:?}");
            assert!(
                matches!(from.mode, Mode::Disarmed | Mode::Ready),
                "{from:?} -- {happening:?} --> {to:?}"
            );
        }
    }
}

#[test]
fn stop_and_disarm_are_never_refused() {
    for state in reachable() {
        for happening in happenings() {
            let Happening::Asked(request, conditions) = &happening else { continue };
            let response = respond(state.mode, *request, conditions);
            let refused = matches!(response, Response::Refuse(_));
            let may_refuse = !matches!(request, RequestKind::Stop | RequestKind::Disarm);
            assert!(!refused || may_refuse, "{state:?} -- {happening:?}: {response:?}");
            if *request == RequestKind::Stop {
                assert_eq!(state.after(&happening).mode, Mode::LatchedStop, "{state:?}");
            }
        }
    }
}

#[test]
fn no_trigger_but_those_of_rest_and_recovery_starts_motion() {
    let moves = |mode| matches!(mode, Mode::Homing | Mode::Following);
    for (from, happening, to) in steps() {
        if let Happening::Triggered(trigger) = happening
            && !moves(from.mode)
            && moves(to.mode)
        {
            assert_eq!(trigger, Trigger::DemandGone, "{from:?} --> {to:?}");
            assert_eq!(from.mode, Mode::ProtectiveStop, "{from:?} --> {to:?}");
        }
    }
}

#[test]
fn what_moves_heeds_every_demand() {
    for state in reachable().into_iter().filter(|s| matches!(s.mode, Mode::Homing | Mode::Following)) {
        let to = |trigger| state.after(&Happening::Triggered(trigger)).mode;
        assert_eq!(to(Trigger::ProtectiveDemand), Mode::ProtectiveStop, "{state:?}");
        assert_eq!(to(Trigger::LatchedDemand), Mode::LatchedStop, "{state:?}");
        assert_eq!(to(Trigger::Fault), Mode::Faulted, "{state:?}");
    }
}
