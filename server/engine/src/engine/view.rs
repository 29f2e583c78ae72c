//! The snapshot: what may be seen of the engine, made on demand.

use super::Engine;
use crate::frames::{Floor, Planar};
use crate::machine::{Homing, Limits};
use crate::mode::{self, RequestKind, Response};
use crate::motion::travel_secs;
use crate::person::Person;
use crate::safety::path::State;
use crate::safety::separation::Separation;
use crate::snapshot::{ColumnState, ObjectState, PersonState, Snapshot};
use crate::time::Time;

impl Engine {
    /// The whole state at `now`.
    pub fn snapshot(&self, now: Time) -> Snapshot {
        let conditions = self.conditions();
        let refusal = |kind| match mode::respond(self.mode, kind, &conditions) {
            Response::Go(_) => (kind, None),
            Response::AlreadySo(why) => (kind, Some(why.to_owned()).filter(|_| kind != RequestKind::Stop)),
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
            intention_rule: self.following.rule().name(),
        }
    }

    fn column(&self) -> ColumnState {
        let position = self.report.map_or(Floor::new(0.0, 0.0), |r| r.position);
        let velocity = self.report.map_or(Planar::ZERO, |r| r.velocity);
        let commanded = self.governor.map_or_else(|| State::moving(position, velocity), |g| *g.commanded());
        let wish = self.following.wish();
        ColumnState {
            position,
            velocity,
            commanded: commanded.position(),
            commanded_velocity: commanded.velocity(),
            proxy: self.following.proxy().position(),
            target: wish.map(|w| w.target),
            serves: wish.map(|w| w.visitor),
            committed: wish.and_then(|w| w.committed),
            current_amps: self.report.map_or([0.0; 2], |r| r.current_amps),
            homed: self.report.is_some_and(|r| r.homing == Homing::Homed),
        }
    }

    fn person_state(&self, person: &Person, now: Time) -> PersonState {
        let column = self.column();
        let state = State::moving(column.position, column.velocity);
        let separation = Separation {
            scene: &self.scene,
            limits: &self.config.limits,
            travel: &self.config.travel,
            threats: &[],
            parameters: &self.parameters,
        };
        // The measured velocity of a resting machine is noise; the zone shown is that of a meant motion.
        let state = if state.velocity().norm() < super::AT_REST_MPS {
            State::at_rest(column.position)
        } else {
            state
        };
        let threat = person.threat(now);
        PersonState {
            person: person.id(),
            pose: person.newest().map(|s| s.pose),
            pose_age_secs: person.pose_age(now).map_or(0.0, |age| age.secs()),
            tracked: person.lost(now, &self.parameters).is_none(),
            awaits_confirmation: person.awaits_confirmation(),
            separation_radius_m: threat
                .map_or(self.parameters.radius_m, |t| separation.radius_m(&t, state.velocity().norm())),
            distance_m: threat.map_or(0.0, |t| self.scene.footprint().distance_m(column.position, t.head)),
            required_m: threat.map_or(self.parameters.radius_m, |t| separation.required_m(&state, &t)),
        }
    }

    fn objects(&self) -> Vec<ObjectState> {
        let from = self.report.map_or(Floor::new(0.0, 0.0), |r| r.position);
        let belief = self.following.belief();
        let total: f64 = belief.map_or(0.0, |b| b.weights.iter().sum());
        let visitor = self.following.serves().and_then(|id| self.person(id));
        let objects = self.scene.objects().iter().zip(&self.scene.spec().objects).enumerate();
        objects
            .map(|(i, (object, spec))| {
                let weight = belief.and_then(|b| b.weights.get(i)).copied().unwrap_or(0.0);
                let touch_secs = visitor.and_then(|v| {
                    let head = v.newest()?.pose.position;
                    let left_m = (object.distance_m(&head) - ARM_M).max(0.0);
                    Some(left_m / v.velocity().norm().max(BRISK_MPS))
                });
                ObjectState {
                    id: spec.id.clone(),
                    weight,
                    probability: if total > 0.0 { weight / total } else { 0.0 },
                    prior: self.priors[i],
                    column_place: object.column_place(),
                    arrival_secs: arrival_secs(from, object.column_place(), &self.config.limits),
                    touch_secs,
                }
            })
            .collect()
    }
}

/// From now until the column could stand there; at once where it stands already.
fn arrival_secs(from: Floor, place: Floor, limits: &Limits) -> f64 {
    if from.distance_m(place) < IN_PLACE_M { 0.0 } else { travel_secs(from, place, limits) }
}

/// Nearer than this the column is there: the following error of a healthy machine, m.
const IN_PLACE_M: f64 = 0.01;
/// The head is this far from a surface when the hand is at it (recorded people: 0.6 m to the object's centre), m.
const ARM_M: f64 = 0.5;
/// Somebody who stands may walk off at once: the 95th percentile of recorded people's speed, m/s.
const BRISK_MPS: f64 = 0.87;
