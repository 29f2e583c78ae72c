//! A person in the arena: the newest pose, how they move, and whether we may believe it.

use crate::frames::Planar;
use crate::observation::{PersonId, PoseSample};
use crate::safety::parameters::Parameters;
use crate::safety::separation::Threat;
use crate::scene::Scene;
use crate::time::{Span, Time};

/// What is known of one person.
#[derive(Debug, Clone)]
pub struct Person {
    id: PersonId,
    entered_at: Time,
    newest: Option<PoseSample>,
    velocity: Planar,
    awaits_confirmation: bool,
    client_present: bool,
    implausible_until: Option<Time>,
    nearest_object_m: f64,
    near_object: bool,
    low: bool,
}

/// Why a person cannot be relied on now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lost {
    /// Entered, and no pose yet after longer than a pose may be old, s.
    NoPoseYet(f64),
    /// The newest pose is too old (R2), s.
    TooOld(f64),
    /// The headset does not know its place (R2).
    Untracked,
    /// The headset is off the head (R15).
    NotWorn,
    /// The pose jumped faster than a head can (R7).
    Jumped,
    /// The client is gone (R10).
    ClientGone,
}

impl Person {
    /// Somebody who has just come in.
    pub fn new(id: PersonId, entered_at: Time) -> Self {
        Self {
            id,
            entered_at,
            newest: None,
            velocity: Planar::ZERO,
            awaits_confirmation: false,
            client_present: true,
            implausible_until: None,
            nearest_object_m: f64::INFINITY,
            near_object: false,
            low: false,
        }
    }

    /// Take a pose; one that is not newer than the last is dropped. `near` says which objects a head may be near to.
    pub fn take_pose(&mut self, sample: PoseSample, scene: &Scene, near: &[bool], parameters: &Parameters) {
        if let Some(before) = self.newest {
            let elapsed = (sample.taken_at - before.taken_at).secs();
            if elapsed <= 0.0 {
                return;
            }
            let moved = sample.pose.position.floor() - before.pose.position.floor();
            let jumped = sample.pose.position.distance_m(&before.pose.position);
            if jumped > JUMP_ALLOWANCE_M + parameters.head_speed_mps * elapsed {
                self.implausible_until = Some(sample.taken_at + SETTLING);
                self.velocity = Planar::ZERO;
            } else {
                let blend = 1.0 - (-elapsed / VELOCITY_SMOOTHING_SECS).exp();
                self.velocity += (moved * (1.0 / elapsed) - self.velocity) * blend;
            }
            if sample.worn && !before.worn {
                self.awaits_confirmation = true;
            }
        }
        if self.implausible_until.is_some_and(|until| sample.taken_at >= until) {
            self.implausible_until = None;
        }
        self.newest = Some(sample);
        self.place_among(scene, near);
    }

    /// Find the nearest of these objects anew: after a pose, and after a change of scene or of what is enabled.
    pub fn place_among(&mut self, scene: &Scene, near: &[bool]) {
        if let Some(sample) = self.newest {
            self.nearest_object_m = scene.nearest_object_m(&sample.pose.position, near);
        }
    }

    /// Work out the zones of the separation rule for now. The pose is old, and since then the head may have left an
    /// object at v_h or gone down in a crouch: what would make the rule stricter is taken to have happened.
    pub fn update_zones(&mut self, now: Time, parameters: &Parameters) {
        let (Some(sample), Some(age)) = (self.newest, self.pose_age(now)) else { return };
        let limit = if self.near_object { parameters.near_leave_m } else { parameters.near_enter_m };
        self.near_object = self.nearest_object_m + parameters.v_h_mps * age.secs() <= limit;
        self.low = sample.pose.position.z() - parameters.stoop_mps * age.secs() < parameters.low_head_m;
    }

    /// The tracking origin moved: nobody knows where this person is until a game master confirms.
    pub fn origin_changed(&mut self) {
        self.awaits_confirmation = true;
    }

    /// A game master saw the person on the floor mark.
    pub fn confirm_origin(&mut self) {
        self.awaits_confirmation = false;
        self.implausible_until = None;
    }

    /// The client is there, or gone.
    pub fn set_client_present(&mut self, present: bool) {
        self.client_present = present;
    }

    /// When they came in.
    pub fn entered_at(&self) -> Time {
        self.entered_at
    }

    /// Who.
    pub fn id(&self) -> PersonId {
        self.id
    }

    /// The newest pose.
    pub fn newest(&self) -> Option<&PoseSample> {
        self.newest.as_ref()
    }

    /// Velocity over the floor, m/s, smoothed over about a tenth of a second.
    pub fn velocity(&self) -> Planar {
        self.velocity
    }

    /// From the head to the nearest enabled object, m; infinite without one.
    pub fn nearest_object_m(&self) -> f64 {
        self.nearest_object_m
    }

    /// Waits for a game master's word (R15).
    pub fn awaits_confirmation(&self) -> bool {
        self.awaits_confirmation
    }

    /// Age of the newest pose.
    pub fn pose_age(&self, now: Time) -> Option<Span> {
        self.newest.map(|sample| (now - sample.taken_at).max(Span::ZERO))
    }

    /// Why this person cannot be relied on now; none when they can.
    pub fn lost(&self, now: Time, parameters: &Parameters) -> Option<Lost> {
        if !self.client_present {
            return Some(Lost::ClientGone);
        }
        let (Some(sample), Some(age)) = (self.newest, self.pose_age(now)) else {
            let waiting = now - self.entered_at;
            return (waiting > parameters.pose_age).then_some(Lost::NoPoseYet(waiting.secs()));
        };
        if age > parameters.pose_age {
            Some(Lost::TooOld(age.secs()))
        } else if !sample.worn {
            Some(Lost::NotWorn)
        } else if !sample.tracked {
            Some(Lost::Untracked)
        } else if self.implausible_until.is_some() {
            Some(Lost::Jumped)
        } else {
            None
        }
    }

    /// They are in the arena and nobody knows where: no pose has come yet.
    pub fn is_unseen(&self) -> bool {
        self.newest.is_none()
    }

    /// This person as the separation rule sees them; none before the first pose.
    pub fn threat(&self, now: Time) -> Option<Threat> {
        let sample = self.newest?;
        Some(Threat {
            person: self.id,
            head: sample.pose.position.floor(),
            velocity: self.velocity,
            age_secs: self.pose_age(now)?.secs(),
            near_object: self.near_object,
            low: self.low,
        })
    }
}

/// A head may seem to move this much at once: noise and relocalisation of a few centimetres, m.
const JUMP_ALLOWANCE_M: f64 = 0.15;
/// After a jump the poses must hold together for so long before they are believed again.
const SETTLING: Span = Span::from_millis(1000);
/// Differences of poses are noisy; a step of velocity shows after about this long, s.
const VELOCITY_SMOOTHING_SECS: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Floor, Point, Pose};
    use crate::machine::Travel;
    use crate::observation::Hands;
    use crate::scene::{ObjectSpec, SceneSpec, Shape};
    use nalgebra::UnitQuaternion;

    fn scene() -> Scene {
        let ball = ObjectSpec {
            id: "ball".into(),
            position: Point::new(1.0, 2.0, 1.6),
            yaw_rad: 0.0,
            shape: Shape::Sphere { radius_m: 0.1 },
            prop: None,
            prior: 1.0,
            enabled: true,
        };
        let arena = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        Scene::build(SceneSpec::open(arena, vec![ball])).unwrap()
    }

    fn sample(at_millis: i64, x: f64, worn: bool) -> PoseSample {
        let pose = Pose { position: Point::new(x, 2.0, 1.6), orientation: UnitQuaternion::identity() };
        PoseSample {
            taken_at: Time::from_micros(at_millis * 1000),
            pose,
            tracked: true,
            worn,
            hands: Hands::UNKNOWN,
        }
    }

    fn fed(samples: &[PoseSample]) -> Person {
        let mut person = Person::new(PersonId(1), Time::ZERO);
        for s in samples {
            person.take_pose(*s, &scene(), &[true], &Parameters::new(1.6));
        }
        person
    }

    fn lost_at(person: &Person, millis: i64) -> Option<Lost> {
        person.lost(Time::from_micros(millis * 1000), &Parameters::new(1.6))
    }

    #[test]
    fn age_counts_from_when_the_headset_was_there() {
        let person = fed(&[sample(1000, 2.0, true)]);
        assert_eq!(lost_at(&person, 1500), None);
        assert_eq!(lost_at(&person, 1501), Some(Lost::TooOld(0.501)));
    }

    #[test]
    fn an_older_pose_changes_nothing() {
        let person = fed(&[sample(1000, 2.0, true), sample(900, 3.0, true)]);
        assert_eq!(person.newest().unwrap().pose.position.x(), 2.0);
    }

    #[test]
    fn a_jump_is_lost_tracking_until_poses_hold_together() {
        let mut samples = vec![sample(0, 2.0, true), sample(11, 3.5, true)];
        assert_eq!(lost_at(&fed(&samples), 20), Some(Lost::Jumped));
        samples.extend((2..100).map(|k| sample(k * 11, 3.5, true)));
        assert_eq!(lost_at(&fed(&samples), 1090), None);
    }

    #[test]
    fn a_headset_off_and_on_waits_for_confirmation() {
        let mut person = fed(&[sample(0, 2.0, true), sample(11, 2.0, false), sample(22, 2.0, true)]);
        assert!(person.awaits_confirmation());
        person.confirm_origin();
        assert!(!person.awaits_confirmation());
    }

    #[test]
    fn near_an_object_has_hysteresis() {
        let near = |samples: &[PoseSample]| {
            let mut person = Person::new(PersonId(1), Time::ZERO);
            for s in samples {
                person.take_pose(*s, &scene(), &[true], &Parameters::new(1.6));
                person.update_zones(s.taken_at, &Parameters::new(1.6));
            }
            person.threat(Time::from_micros(100_000)).unwrap().near_object
        };
        assert!(!near(&[sample(0, 1.9, true)]), "0.8 m is not near on the way in");
        assert!(near(&[sample(0, 1.8, true), sample(50, 1.9, true)]), "but near on the way out");
        assert!(!near(&[sample(0, 1.8, true), sample(50, 1.96, true)]));
    }

    #[test]
    fn an_old_pose_may_have_left_the_object_or_crouched() {
        let parameters = Parameters::new(1.6);
        let mut person = fed(&[sample(0, 1.8, true)]);
        let mut zones = |millis: i64| {
            person.update_zones(Time::from_micros(millis * 1000), &parameters);
            let threat = person.threat(Time::from_micros(millis * 1000)).unwrap();
            (threat.near_object, threat.low)
        };
        assert_eq!(zones(20), (true, false));
        assert_eq!(zones(200), (false, false), "0.7 m and 0.32 m of walking");
        assert_eq!(zones(400), (false, true), "1.6 m less 0.72 m of crouching");
    }
}
