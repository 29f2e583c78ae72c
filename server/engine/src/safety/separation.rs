//! R3 and R13: speed and separation. May the column be in this state of motion, given where people can be?
//!
//! With d(c) the distance from a head axis to the footprint with its centre at c, a state is allowed when its worst
//! brake (reaction included) keeps, for every person and every s until rest,
//!
//! ```text
//!     d(c(s)) > r + v_h * (pose age + s) + allowance        (s begins before the reaction time)
//! ```
//!
//! Keep-out shapes are the same with v_h = 0; the column may also leave one slowly. At rest everything is allowed.
//! The rule would allow a slow retreat from a person too; the engine makes no use of it: somebody who turns and comes
//! after the column breaks the retreat's own condition for as long as the pose takes to arrive.
//! It must never know who is served or why: it sees heads, shapes and a path.

mod terms;

use crate::frames::{Floor, Planar};
use crate::machine::{Limits, Travel};
use crate::observation::PersonId;
use crate::safety::contact::{Contact, ContactKind};
use crate::safety::parameters::Parameters;
use crate::safety::path::{BrakePath, State};
use crate::scene::Scene;
pub use terms::{Term, Terms};

/// Whom separation keeps the column from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeptFrom {
    /// Everybody in the arena.
    Everybody,
    /// Nobody: the arena, its people and the machine are all simulated. For studies that ask what the rule costs.
    Nobody(WhollySimulated),
}

/// The word of a caller that nothing real moves. No shell of a machine has a reason to say it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WhollySimulated(());

impl WhollySimulated {
    /// Said by replays on virtual time alone; a test holds the server to never naming it.
    pub const fn by_a_replay_on_virtual_time() -> Self {
        Self(())
    }
}

/// A person as this rule sees them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Threat {
    /// Who.
    pub person: PersonId,
    /// The head axis where the newest pose has it.
    pub head: Floor,
    /// Velocity of the head as far as poses tell, m/s.
    pub velocity: Planar,
    /// Age of that pose, s.
    pub age_secs: f64,
    /// The head is near an enabled object.
    pub near_object: bool,
    /// The head is low: crawling, sitting.
    pub low: bool,
}

/// What is in the way of a state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conflict {
    /// With whom, or with which keep-out shape, or with the travel.
    pub with: Obstacle,
    /// The distance on the brake path where it fails, m.
    pub distance_m: f64,
    /// What is required there, m.
    pub required_m: f64,
}

/// What a state can be in conflict with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Obstacle {
    /// A person (R3).
    Person(PersonId),
    /// A keep-out shape of the scene, by index (R13).
    KeepOut(usize),
    /// The travel limits (R1).
    Travel,
}

/// The rule in one situation: who is where, and what the machine can do.
#[derive(Debug, Clone, Copy)]
pub struct Separation<'a> {
    /// Footprint and keep-out shapes.
    pub scene: &'a Scene,
    /// The machine's limits.
    pub limits: &'a Limits,
    /// The machine's travel.
    pub travel: &'a Travel,
    /// Everybody whose place is known.
    pub threats: &'a [Threat],
    /// The rule's numbers.
    pub parameters: &'a Parameters,
    /// The visitor whom R14 stands for instead.
    pub contact: Option<Contact>,
}

impl Separation<'_> {
    /// Allow a commanded state, with all that the engine must keep beyond the rule.
    pub fn certify(&self, state: &State) -> Result<(), Conflict> {
        let path = BrakePath::worst(state, self.limits, self.parameters.reaction.secs());
        self.certify_travel(state, &path)?;
        if rests(state) {
            return Ok(());
        }
        // A control thread that stalls leaves the column to itself for a reaction.
        let reaction_secs = self.parameters.reaction.secs();
        let speed = state.speed_before_brake_mps(self.limits, reaction_secs) + MACHINE_OVERSHOOT_MPS;
        let allowance_m = self.parameters.following_allowance_m;
        self.certify_path(state, &path, speed, allowance_m)?;
        // The brake begun at once takes another curve, as its axes come to rest at other times; and so does the one
        // that the rule is written for, which has no bound on jerk.
        self.certify_path(state, &BrakePath::now(state, self.limits), speed, allowance_m)?;
        self.certify_path(state, &BrakePath::abrupt(state, self.limits), speed, allowance_m)
    }

    /// Allow the measured state: the plain rule, braking begun now.
    pub fn certify_measured(&self, state: &State) -> Result<(), Conflict> {
        let speed = state.velocity().norm();
        if speed < MEASUREMENT_NOISE_MPS {
            return Ok(());
        }
        self.certify_path(state, &BrakePath::now(state, self.limits), speed, 0.0)
    }

    /// r for this head at this speed of the column, m.
    pub fn radius_m(&self, threat: &Threat, speed_mps: f64) -> f64 {
        let p = self.parameters;
        match (threat.low, threat.near_object && speed_mps <= p.near_speed_mps) {
            (true, _) => p.low_radius_m,
            (false, true) => p.near_radius_m,
            (false, false) => p.radius_m,
        }
    }

    fn certify_travel(&self, state: &State, path: &BrakePath) -> Result<(), Conflict> {
        let inside = self.travel.shrunk(self.parameters.travel_margin_m);
        let (low, high) = path.extent();
        let at = state.position();
        // From outside the margin (after homing into the corner) every way in is open, no way further out.
        let depth = (low.x - inside.min.x.min(at.x))
            .min(low.y - inside.min.y.min(at.y))
            .min(inside.max.x.max(at.x) - high.x)
            .min(inside.max.y.max(at.y) - high.y);
        if depth < -ROUNDING_M {
            return Err(Conflict { with: Obstacle::Travel, distance_m: depth, required_m: 0.0 });
        }
        Ok(())
    }

    /// `speed_mps` is the speed that the zones of the rule are chosen by.
    fn certify_path(
        &self,
        state: &State,
        path: &BrakePath,
        speed_mps: f64,
        allowance_m: f64,
    ) -> Result<(), Conflict> {
        if rests(state) {
            return Ok(());
        }
        for threat in self.threats {
            if let Some(contact) = self.contact.filter(|contact| contact.person == threat.person) {
                self.certify_contact(&contact, threat, state.velocity(), path, allowance_m)?;
                continue;
            }
            let r = self.radius_m(threat, speed_mps);
            let required = |s: f64| r + self.parameters.v_h_mps * (threat.age_secs + s) + allowance_m;
            let distance = |c: Floor| self.scene.footprint().distance_m(c, threat.head);
            if let Err((distance_m, required_m)) = keeps(path, self.parameters.v_h_mps, distance, required) {
                return Err(Conflict { with: Obstacle::Person(threat.person), distance_m, required_m });
            }
        }
        for (index, keep_out) in self.scene.keep_outs().iter().enumerate() {
            let distance = |c: Floor| keep_out.distance_m(self.scene.footprint(), c);
            let required = |_| self.parameters.radius_m + allowance_m;
            let leaves = || {
                let (footprint, centre) = (self.scene.footprint(), state.position());
                let outside = keep_out.distance_m(footprint, centre) > self.parameters.radius_m;
                outside
                    && keep_out
                        .away(footprint, centre)
                        .is_some_and(|away| self.is_retreat(state.velocity(), away))
            };
            if let Err((distance_m, required_m)) = keeps(path, 0.0, distance, required)
                && !leaves()
            {
                return Err(Conflict { with: Obstacle::KeepOut(index), distance_m, required_m });
            }
        }
        Ok(())
    }

    /// R14, for the visitor of a contact interaction.
    fn certify_contact(
        &self,
        contact: &Contact,
        threat: &Threat,
        velocity: Planar,
        path: &BrakePath,
        allowance_m: f64,
    ) -> Result<(), Conflict> {
        let p = self.parameters;
        let refuse = |distance_m, required_m| {
            Err(Conflict { with: Obstacle::Person(threat.person), distance_m, required_m })
        };
        let centre = path.centre(0.0);
        if threat.age_secs > p.contact_pose_age.secs() {
            return refuse(0.0, p.contact_radius_m);
        }
        if contact.kind == ContactKind::Transport {
            let off_m = (centre + contact.offset).distance_m(threat.head);
            return if contact.is_aboard(centre, threat.head, p) {
                Ok(())
            } else {
                refuse(off_m, p.aboard_m)
            };
        }
        let footprint = self.scene.footprint();
        let distance = |c: Floor| footprint.distance_but_m(c, threat.head, contact.prop);
        match keeps(path, 0.0, distance, |_| p.contact_radius_m + allowance_m) {
            Ok(()) => Ok(()),
            // A leader leaves behind whoever came too near, as long as it does not come any nearer.
            Err(_) if velocity.dot(centre - threat.head) > 0.0 && self.is_left_behind(path, &distance) => {
                Ok(())
            }
            Err((distance_m, required_m)) => refuse(distance_m, required_m),
        }
    }

    /// The distance never falls on the way to rest, and the column is not upon the head.
    fn is_left_behind(&self, path: &BrakePath, distance: &impl Fn(Floor) -> f64) -> bool {
        let end = path.duration_secs();
        let looks =
            (0..=LEAVING_LOOKS).map(|k| distance(path.centre(end * f64::from(k) / f64::from(LEAVING_LOOKS))));
        let (mut before, mut falls) = (self.parameters.near_radius_m, false);
        for now in looks {
            falls |= now < before - ROUNDING_M;
            before = now;
        }
        !falls
    }

    /// Slowly and straight away.
    fn is_retreat(&self, velocity: Planar, away: Planar) -> bool {
        let speed = velocity.norm();
        speed <= self.parameters.retreat_speed_mps
            && velocity.dot(away) >= speed * self.parameters.retreat_cone_rad.cos()
    }
}

/// At rest everything is allowed.
fn rests(state: &State) -> bool {
    state.velocity().norm() < AT_REST_MPS && state.acceleration().norm() == 0.0
}

/// The distance stays above what is required along the whole path; else where it first does not.
///
/// Conservative advancement: neither side changes faster than (column speed + v_h), so a slack of g needs no second
/// look for g / (column speed + v_h) seconds.
fn keeps(
    path: &BrakePath,
    v_h_mps: f64,
    distance: impl Fn(Floor) -> f64,
    required: impl Fn(f64) -> f64,
) -> Result<(), (f64, f64)> {
    let closing_mps = path.greatest_speed_mps() + v_h_mps;
    let end = path.duration_secs();
    let mut s = 0.0;
    loop {
        let (d, needed) = (distance(path.centre(s)), required(s));
        let slack = d - needed;
        if slack <= 0.0 {
            return Err((d, needed));
        }
        if s >= end {
            return Ok(());
        }
        s = (s + (slack / closing_mps).max(LEAST_STEP_SECS)).min(end);
    }
}

/// The true speed exceeds the commanded one by less than this, m/s.
const MACHINE_OVERSHOOT_MPS: f64 = 0.03;
/// A machine at rest measures less than this, m/s.
const MEASUREMENT_NOISE_MPS: f64 = 0.02;
/// Slower than this the column rests, m/s.
const AT_REST_MPS: f64 = 1e-6;
/// Shortest look-ahead step; at 3 m/s of closing speed less than a millimetre passes unseen.
const LEAST_STEP_SECS: f64 = 2.5e-4;
/// Looks at a way that leaves somebody behind.
const LEAVING_LOOKS: u32 = 16;
/// Floating point on a path that ends on the margin, m.
const ROUNDING_M: f64 = 1e-9;
#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Point;
    use crate::scene::{KeepOutShape, KeepOutSpec, ObjectSpec, SceneSpec, Shape};

    const TRAVEL: Travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };

    fn scene() -> Scene {
        let ball = ObjectSpec {
            id: "ball".into(),
            position: Point::new(0.5, 0.5, 1.0),
            yaw_rad: 0.0,
            shape: Shape::Sphere { radius_m: 0.1 },
            prop: None,
            prior: 1.0,
            enabled: true,
        };
        let mut spec = SceneSpec::open(TRAVEL, vec![ball]);
        let shape = KeepOutShape::Circle { centre: Floor::new(0.5, 3.5), radius_m: 0.3 };
        spec.keep_outs.push(KeepOutSpec { id: "sofa".into(), shape });
        Scene::build(spec).unwrap()
    }

    /// A column at (2, 2) with this velocity, and a head this far along +x from the footprint.
    fn verdict(velocity: Planar, gap_m: f64, alter: impl FnOnce(&mut Threat)) -> Result<(), Conflict> {
        let mut threat = Threat {
            person: PersonId(1),
            head: Floor::new(2.075 + gap_m, 2.0),
            velocity: Planar::ZERO,
            age_secs: 0.02,
            near_object: false,
            low: false,
        };
        alter(&mut threat);
        certified(&State::moving(Floor::new(2.0, 2.0), velocity), &[threat])
    }

    fn certified(state: &State, threats: &[Threat]) -> Result<(), Conflict> {
        let (scene, parameters) = (scene(), Parameters::new(1.6));
        Separation {
            scene: &scene,
            limits: &Limits::PAPER,
            travel: &TRAVEL,
            threats,
            parameters: &parameters,
            contact: None,
        }
        .certify(state)
    }

    #[test]
    fn at_rest_everything_is_allowed() {
        for gap_m in [0.0, 0.1, 0.34] {
            assert_eq!(verdict(Planar::ZERO, gap_m, |_| ()), Ok(()));
        }
    }

    #[test]
    fn towards_somebody_it_needs_what_walking_and_braking_take() {
        // From 1.1 m/s: reaction 0.05 s and a brake of 1.1 / 2.5 + 2.5 / 80 s, 20 ms of age, 1.6 m/s of walking.
        let brake_secs = 0.05 + 1.1 / 2.5 + 2.5 / 80.0;
        let braking_m = 1.1 * 0.05 + 1.1 * (1.1 / 2.5 + 2.5 / 80.0) / 2.0;
        let needed = 0.35 + 1.6 * (brake_secs + 0.02) + braking_m + 0.012;
        assert!(verdict(Planar::new(1.1, 0.0), needed + 0.01, |_| ()).is_ok());
        let conflict = verdict(Planar::new(1.1, 0.0), needed - 0.01, |_| ()).unwrap_err();
        assert_eq!(conflict.with, Obstacle::Person(PersonId(1)));
    }

    #[test]
    fn away_from_somebody_it_may_where_towards_it_may_not() {
        assert!(verdict(Planar::new(-0.8, 0.0), 1.1, |_| ()).is_ok());
        assert!(verdict(Planar::new(0.8, 0.0), 1.1, |_| ()).is_err());
    }

    #[test]
    fn an_older_pose_asks_for_more() {
        assert!(verdict(Planar::new(0.5, 0.0), 1.1, |_| ()).is_ok());
        assert!(verdict(Planar::new(0.5, 0.0), 1.1, |t| t.age_secs = 0.3).is_err());
    }

    #[test]
    fn near_an_object_it_may_creep_closer_and_at_a_low_head_it_must_stay_away() {
        let creep = Planar::new(0.0, 0.15);
        assert!(verdict(creep, 0.65, |_| ()).is_err());
        assert!(verdict(creep, 0.65, |t| t.near_object = true).is_ok());
        assert!(verdict(Planar::new(0.0, 0.3), 0.65, |t| t.near_object = true).is_err(), "but not faster");
        assert!(verdict(creep, 1.0, |_| ()).is_ok());
        assert!(verdict(creep, 1.0, |t| t.low = true).is_err());
    }

    /// A control thread that stalls lets the column go on at its acceleration for a reaction: what is slow enough for the
    /// near radius now is not then.
    #[test]
    fn near_an_object_a_column_that_would_be_too_fast_before_it_brakes_keeps_the_wide_radius() {
        let near = |v: f64, a: f64| {
            let mut state = State::moving(Floor::new(2.0, 2.0), Planar::new(0.0, v));
            state.y.a = a;
            let threat = Threat {
                person: PersonId(1),
                head: Floor::new(2.725, 2.0),
                velocity: Planar::ZERO,
                age_secs: 0.02,
                near_object: true,
                low: false,
            };
            certified(&state, &[threat])
        };
        assert!(near(0.2, 0.0).is_ok());
        assert!(near(0.2, -1.25).is_ok());
        assert!(near(0.2, 1.25).is_err(), "0.2 m/s and 50 ms of 1.25 m/s2 are 0.26 m/s");
        assert!(near(0.1, 1.25).is_ok());
    }

    #[test]
    fn the_travel_and_a_keep_out_are_kept_braking_included() {
        let at = |x, y, vx, vy| certified(&State::moving(Floor::new(x, y), Planar::new(vx, vy)), &[]);
        assert!(at(3.6, 2.0, 0.8, 0.0).is_ok());
        assert_eq!(at(3.8, 2.0, 0.8, 0.0).unwrap_err().with, Obstacle::Travel);
        assert!(at(3.99, 2.0, -0.3, 0.0).is_ok(), "from outside the margin inwards");
        assert_eq!(at(3.99, 2.0, 0.01, 0.0).unwrap_err().with, Obstacle::Travel);
        assert!(at(2.0, 3.5, -0.8, 0.0).is_ok());
        assert_eq!(at(1.35, 3.5, -0.8, 0.0).unwrap_err().with, Obstacle::KeepOut(0));
        assert!(at(1.35, 3.5, 0.0, -0.8).is_ok(), "past it");
    }
}
