//! Somebody at the dashboard who presses whatever there is, and always gets the machine going again.

use std::sync::Arc;

use covr_engine::engine::Request;
use covr_engine::frames::{Floor, Planar};
use covr_engine::mode::{Mode, RequestKind};
use covr_engine::motion::jog::{Aim, JogOrder};
use covr_engine::observation::{Observation, PersonId};
use covr_engine::scene::Scene;
use covr_engine::time::{Span, Time};

use crate::random::Random;
use crate::replay::{ClosedLoop, TrueHead};

/// The operator.
pub struct Operator {
    random: Random,
    scenes: Vec<Arc<Scene>>,
    /// The column is moved by hand until then, by this order.
    jog: Option<(Time, JogOrder)>,
    next_act: Time,
    next_care: Time,
    meddles: bool,
}

impl Operator {
    /// At the desk from `now` on, with these scenes to choose from; without meddling they only get it going again.
    pub fn new(random: Random, scenes: Vec<Arc<Scene>>, now: Time, meddles: bool) -> Self {
        Self { random, scenes, jog: None, next_act: now, next_care: now, meddles }
    }

    /// Do what it is time for.
    pub fn act(&mut self, control: &mut ClosedLoop, heads: &[TrueHead]) {
        let now = control.now();
        if now >= self.next_care {
            self.next_care = now + Span::from_millis(250);
            self.jog = self.jog.filter(|(until, _)| now < *until);
            care(control, heads, self.jog.is_some());
            // Now and then a word stays away, and the column comes to rest for want of it.
            if let Some((_, order)) = self.jog.filter(|_| self.random.chance(0.9)) {
                control.request(Request::Jog(order));
            }
        }
        if self.meddles && now >= self.next_act {
            self.next_act = now + Span::from_secs(self.random.between(0.1, 3.0));
            self.meddle(control, heads);
        }
    }

    fn meddle(&mut self, control: &mut ClosedLoop, heads: &[TrueHead]) {
        let anybody = heads.get(self.random.below(heads.len())).map_or(PersonId(0), |head| head.person);
        let chosen = self.random.below(self.scenes.len());
        match self.random.below(40) {
            0 => drop(control.request(Request::Machine(RequestKind::Stop, Some("a whim".into())))),
            1 => drop(control.request(Request::Machine(RequestKind::Disarm, None))),
            2..=4 => drop(control.request(Request::ActivateScene(Arc::clone(&self.scenes[chosen])))),
            5 => control.observe(Observation::OriginChanged(anybody)),
            6 => control.observe(Observation::ClientGone(anybody)),
            7 => drop(control.request(Request::Machine(RequestKind::Home, None))),
            8 => drop(control.request(Request::Machine(RequestKind::Reset, None))),
            9..=12 => self.take_into_hand(control),
            _ => {
                let count = control.engine().scene().spec().objects.len();
                let priors = (0..count).map(|object| (object, self.random.unit())).collect();
                control.request(Request::SetPriors(priors));
            }
        }
    }

    /// Move the column by hand for a while, along some way or to some place.
    fn take_into_hand(&mut self, control: &mut ClosedLoop) {
        control.request(Request::Machine(RequestKind::Disarm, None));
        let aim = if self.random.chance(0.5) {
            Aim::Along(Planar::new(1.0, 0.0).turned(self.random.between(-3.2, 3.2)))
        } else {
            Aim::To(Floor::new(self.random.between(0.0, 6.0), self.random.between(0.0, 6.0)))
        };
        let order = JogOrder { aim, speed_mps: self.random.between(0.02, 0.5) };
        self.jog = Some((control.now() + Span::from_secs(self.random.between(1.0, 6.0)), order));
    }
}

/// Get it going again; while it is moved by hand nobody arms it.
fn care(control: &mut ClosedLoop, heads: &[TrueHead], jogs: bool) {
    for head in heads {
        control.observe(Observation::ClientBack(head.person));
        control.request(Request::ConfirmOrigin(head.person));
    }
    match control.engine().mode() {
        Mode::LatchedStop | Mode::Faulted => {
            control.request(Request::Machine(RequestKind::Reset, Some("looked".into())));
        }
        Mode::Disarmed | Mode::Ready if !jogs => {
            let armed = control.arm();
            if armed.is_err() {
                control.request(Request::Machine(RequestKind::Home, None));
            }
        }
        _ => {}
    }
}
