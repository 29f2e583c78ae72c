//! The snapshot: what may be seen of the engine, made on demand.

use super::Engine;
use super::following::{IN_PLACE_M, IN_PLACE_MPS};
use crate::frames::{Floor, Planar};
use crate::intention::Belief;
use crate::machine::{Homing, Limits};
use crate::mode::{self, Mode, RequestKind, Response};
use crate::motion::{MotionName, travel_secs};
use crate::person::Person;
use crate::safety::path::State;
use crate::safety::separation::{Conflict, Obstacle, Separation};
use crate::snapshot::{Activity, ColumnState, HeldBy, Holder, ObjectState, PersonState, Snapshot};
use crate::time::Time;

impl Engine {
    /// What the intention rule makes of the visitor served; none when nobody is.
    pub fn belief(&self) -> Option<&Belief> {
        self.following.belief()
    }

    /// Where the proxy is.
    pub fn proxy(&self) -> Floor {
        self.following.proxy().position()
    }

    /// The whole state at `now`.
    pub fn snapshot(&self, now: Time) -> Snapshot {
        let conditions = self.conditions(now);
        let refusal = |kind| match mode::respond(self.mode, kind, &conditions) {
            Response::Go(_) => (kind, None),
            Response::AlreadySo(why) => (kind, Some(why).filter(|_| kind != RequestKind::Stop)),
            Response::Refuse(why) => (kind, Some(why)),
        };
        Snapshot {
            at: now,
            mode: self.mode,
            mode_since: self.mode_since,
            stop: self.stop.clone(),
            refusals: RequestKind::ALL.into_iter().map(refusal).collect(),
            rules: self.supervisor.rules().to_vec(),
            column: self.column(),
            persons: self.persons.iter().map(|p| self.person_state(p, now)).collect(),
            objects: self.objects(),
            scenario: self.scenario_state(),
            interaction: self.interaction_state(now),
            contact: self.contact_state(now),
            bears: self.bears(),
            intention_rule: self.following.rule().name(),
            standing: self.following.standing().name(),
            motion: self.following.motion().name(),
            none_probability: self.following.belief().map_or(0.0, |belief| {
                let total = belief.total();
                if total > 0.0 { belief.none / total } else { 0.0 }
            }),
        }
    }

    fn column(&self) -> ColumnState {
        let position = self.report.map_or(Floor::new(0.0, 0.0), |r| r.position);
        let velocity = self.report.map_or(Planar::ZERO, |r| r.velocity);
        let commanded = self.governor.map_or_else(|| State::moving(position, velocity), |g| *g.commanded());
        let wish = self.following.wish();
        let least_arrival_secs = wish.map(|w| arrival_secs(position, w.target, &self.config.limits));
        ColumnState {
            position,
            velocity,
            commanded: commanded.position(),
            commanded_velocity: commanded.velocity(),
            proxy: self.following.proxy().position(),
            target: wish.map(|w| w.target),
            serves: wish.map(|w| w.visitor),
            committed: wish.and_then(|w| w.committed),
            activity: self.activity(position, commanded.velocity().norm()),
            held_by: self.following.held_by().map(|conflict| self.held_by(&conflict)),
            goes_around: self.following.goes_around(),
            arrival_secs: match (self.mode, self.following.motion()) {
                (Mode::Following, MotionName::Planner) => {
                    let there = least_arrival_secs.filter(|secs| *secs == 0.0);
                    there.or(self.following.arrives_in_secs().filter(|_| wish.is_some()))
                }
                (Mode::Following, MotionName::Proxy) => least_arrival_secs,
                _ => None,
            },
            least_arrival_secs,
            jog_speed_mps: self.jog_speed_mps(),
            current_amps: self.report.map_or([0.0; 2], |r| r.current_amps),
            home_repeatability_m: self.report.and_then(|r| r.home_repeatability_m),
            homed: self.report.is_some_and(|r| r.homing == Homing::Homed),
        }
    }

    fn activity(&self, position: Floor, commanded_mps: f64) -> Activity {
        match self.mode {
            Mode::Disarmed => return Activity::Released,
            Mode::Homing => return Activity::Homing,
            Mode::Ready if self.jog.is_some() => return Activity::Jogged,
            Mode::Ready => return Activity::Ready,
            Mode::ProtectiveStop | Mode::LatchedStop | Mode::Faulted => return Activity::Stopped,
            Mode::Following => {}
        }
        if self.interactions.is_under_way() {
            return Activity::Interacting;
        }
        let Some(wish) = self.following.wish().filter(|_| !self.persons.iter().any(Person::is_unseen)) else {
            return Activity::Waiting;
        };
        let held = self.following.held_by().is_some();
        let moves = commanded_mps >= IN_PLACE_MPS;
        match (held, moves) {
            (true, false) => Activity::Blocked,
            (true, true) => Activity::Yielding,
            (false, _) if self.following.goes_around() => Activity::Yielding,
            (false, false) if position.distance_m(wish.target) < IN_PLACE_M => Activity::InPlace,
            (false, _) => Activity::Approaching,
        }
    }

    fn held_by(&self, conflict: &Conflict) -> HeldBy {
        let holder = match conflict.with {
            Obstacle::Person(person) => Holder::Person(person),
            Obstacle::KeepOut(index) => {
                let keep_outs = &self.scene.spec().keep_outs;
                Holder::KeepOut(keep_outs.get(index).map_or_else(String::new, |k| k.id.clone()))
            }
            Obstacle::Travel => Holder::Travel,
        };
        HeldBy { holder, distance_m: conflict.distance_m, required_m: conflict.required_m }
    }

    fn person_state(&self, person: &Person, now: Time) -> PersonState {
        let position = self.report.map_or(Floor::new(0.0, 0.0), |r| r.position);
        let velocity = self.report.map_or(Planar::ZERO, |r| r.velocity);
        let state = State::moving(position, velocity);
        let separation = Separation {
            scene: &self.scene,
            limits: &self.config.limits,
            travel: &self.config.travel,
            threats: &[],
            parameters: &self.parameters,
            contact: None,
        };
        // The measured velocity of a resting machine is noise; the zone shown is that of a meant motion.
        let state =
            if state.velocity().norm() < super::AT_REST_MPS { State::at_rest(position) } else { state };
        let threat = person.threat(now);
        let terms = threat.map(|t| separation.terms(&state, &t));
        PersonState {
            person: person.id(),
            pose: person.newest().map(|s| s.pose),
            pose_age_secs: person.pose_age(now).map_or(0.0, |age| age.secs()),
            tracked: person.lost(now, &self.parameters).is_none(),
            awaits_confirmation: person.awaits_confirmation(),
            separation_radius_m: terms.map_or(self.parameters.radius_m, |terms| terms.radius_m),
            distance_m: threat.map_or(0.0, |t| self.scene.footprint().distance_m(position, t.head)),
            required_m: terms.map_or(self.parameters.radius_m, |terms| terms.required_m()),
            separation: terms,
            limits_column: self.following.held_by().is_some_and(|c| c.with == Obstacle::Person(person.id())),
        }
    }

    fn objects(&self) -> Vec<ObjectState> {
        let belief = self.following.belief();
        let total = belief.map_or(0.0, Belief::total);
        let sights = self.following.sights();
        let objects = self.scene.objects().iter().zip(&self.scene.spec().objects).enumerate();
        objects
            .filter_map(|(i, (object, spec))| {
                let weight = belief.and_then(|b| b.weights.get(i)).copied().unwrap_or(0.0);
                let sight = sights.and_then(|sights| sights.get(i));
                let foretold = self.foretell(i)?;
                Some(ObjectState {
                    id: spec.id.clone(),
                    weight,
                    probability: if total > 0.0 { weight / total } else { 0.0 },
                    prior: self.priors[i],
                    enabled: self.enabled[i],
                    column_place: object.column_place(),
                    arrival_secs: foretold.arrival_secs,
                    touch_secs: foretold.touch_secs,
                    late_by_secs: foretold.late_by_secs(),
                    in_time_probability: foretold.in_time_probability(),
                    offset: foretold.offset,
                    angle_rad: sight.map(|sight| sight.angle_rad),
                    distance_m: sight.map(|sight| sight.distance_m),
                })
            })
            .collect()
    }
}

/// From now until the column could stand there; at once where it stands already.
fn arrival_secs(from: Floor, place: Floor, limits: &Limits) -> f64 {
    if from.distance_m(place) < THERE_M { 0.0 } else { travel_secs(from, place, limits) }
}

/// Nearer than this the column is there: the following error of a healthy machine, m.
const THERE_M: f64 = 0.01;
