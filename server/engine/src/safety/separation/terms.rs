//! The terms of the separation rule, as they are shown. Nothing is decided here.

use super::{AT_REST_MPS, Separation, Threat};
use crate::safety::path::{BrakePath, State};

/// The terms of the rule for one person: what their sum leaves, no brake of the column in any direction takes away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Terms {
    /// r, m.
    pub radius_m: f64,
    /// By how much column and person may come nearer in the reaction time, m.
    pub reaction_m: f64,
    /// By how much the column may come nearer while it brakes after it, m.
    pub braking_m: f64,
    /// What the person may walk while it brakes, m.
    pub walking_m: f64,
    /// What the person may have walked since the pose was taken, m.
    pub age_m: f64,
}

/// A term beyond r, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Term {
    /// Reaction time.
    Reaction,
    /// The column's braking.
    Braking,
    /// The person's walking.
    Walking,
    /// The age of the pose.
    Age,
}

impl Separation<'_> {
    /// What the rule asks of the distance to one person now, term by term. To be shown: nothing is decided by it.
    ///
    /// A column that comes straight on is certified by this sum (and the allowance); one that passes or leaves needs
    /// no more of its own way than the part that brings it nearer. That part ends at the head.
    pub fn terms(&self, state: &State, threat: &Threat) -> Terms {
        let v_h_mps = self.parameters.v_h_mps;
        let radius_m = self.radius_m(threat, state.velocity().norm());
        let age_m = v_h_mps * threat.age_secs;
        if state.velocity().norm() < AT_REST_MPS {
            return Terms { radius_m, reaction_m: 0.0, braking_m: 0.0, walking_m: 0.0, age_m };
        }
        let reaction_secs = self.parameters.reaction.secs();
        let path = BrakePath::worst(state, self.limits, reaction_secs);
        let braking_secs = path.duration_secs() - reaction_secs;
        let distance = |s: f64| self.scene.footprint().distance_m(path.centre(s), threat.head);
        // The nearest of a phase: its end when the column comes on, somewhere within when it passes.
        let nearest = |from: f64, secs: f64| {
            let looks = (0..=LOOKS_A_PHASE).map(|k| from + secs * f64::from(k) / f64::from(LOOKS_A_PHASE));
            looks.map(distance).fold(f64::INFINITY, f64::min)
        };
        let approach = |from: f64, secs: f64| (distance(from) - nearest(from, secs)).max(0.0);
        Terms {
            radius_m,
            reaction_m: approach(0.0, reaction_secs) + v_h_mps * reaction_secs,
            braking_m: approach(reaction_secs, braking_secs),
            walking_m: v_h_mps * braking_secs,
            age_m,
        }
    }
}

impl Terms {
    /// What the rule asks of the distance, m.
    pub fn required_m(&self) -> f64 {
        self.radius_m + self.reaction_m + self.braking_m + self.walking_m + self.age_m
    }

    /// The greatest beyond r.
    pub fn binding(&self) -> Term {
        let terms = [
            (Term::Reaction, self.reaction_m),
            (Term::Braking, self.braking_m),
            (Term::Walking, self.walking_m),
            (Term::Age, self.age_m),
        ];
        terms.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(Term::Age, |(term, _)| term)
    }
}

/// A passing column's nearest moment is looked for so often in the reaction time and in the brake.
const LOOKS_A_PHASE: u32 = 16;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Floor, Planar, Point};
    use crate::machine::{Limits, Travel};
    use crate::observation::PersonId;
    use crate::safety::parameters::Parameters;
    use crate::scene::{ObjectSpec, Scene, SceneSpec, Shape};
    use proptest::prelude::*;

    /// So wide that its walls are in nobody's way.
    const TRAVEL: Travel = Travel { min: Floor::new(-10.0, -10.0), max: Floor::new(10.0, 10.0) };

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
        Scene::build(SceneSpec::open(TRAVEL, vec![ball])).unwrap()
    }

    fn in_the_room<T>(threats: &[Threat], look: impl FnOnce(&Separation<'_>) -> T) -> T {
        let (scene, parameters) = (scene(), Parameters::new(1.6));
        look(&Separation {
            scene: &scene,
            limits: &Limits::PAPER,
            travel: &TRAVEL,
            threats,
            parameters: &parameters,
            contact: None,
        })
    }

    fn is_certified(state: &State, threat: Threat) -> bool {
        in_the_room(&[threat], |separation| separation.certify(state).is_ok())
    }

    fn terms(state: &State, threat: &Threat) -> Terms {
        in_the_room(&[], |separation| separation.terms(state, threat))
    }

    /// Somebody with the head at this place.
    fn somebody(head: Floor, age_secs: f64) -> Threat {
        let (velocity, person) = (Planar::ZERO, PersonId(1));
        Threat { person, head, velocity, age_secs, near_object: false, low: false }
    }

    #[test]
    fn the_terms_are_those_of_the_formula() {
        let threat = somebody(Floor::new(3.5, 2.0), 0.02);
        let found = terms(&State::moving(Floor::new(2.0, 2.0), Planar::new(1.1, 0.0)), &threat);
        let brake_secs = 1.1 / 2.5 + 2.5 / 80.0;
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} against {b}");
        close(found.radius_m, 0.35);
        close(found.reaction_m, (1.1 + 1.6) * 0.05);
        close(found.braking_m, 1.1 * brake_secs / 2.0);
        close(found.walking_m, 1.6 * brake_secs);
        close(found.age_m, 1.6 * 0.02);
        assert_eq!(found.binding(), Term::Walking);
        let stands = terms(&State::at_rest(Floor::new(2.0, 2.0)), &threat);
        close(stands.required_m(), 0.35 + 1.6 * 0.02);
        assert_eq!((stands.reaction_m, stands.braking_m, stands.walking_m), (0.0, 0.0, 0.0));
        assert_eq!(stands.binding(), Term::Age);
    }

    #[test]
    fn a_column_that_leaves_needs_nothing_for_its_own_way() {
        let threat = somebody(Floor::new(3.0, 2.0), 0.02);
        let found = terms(&State::moving(Floor::new(2.0, 2.0), Planar::new(-0.8, 0.0)), &threat);
        assert_eq!(found.braking_m, 0.0);
        assert!((found.reaction_m - 1.6 * 0.05).abs() < 1e-12);
    }

    proptest! {
        /// The sum is what is certified: head on no certified state keeps less, and the edge lies at the sum.
        #[test]
        fn head_on_what_is_certified_keeps_the_sum(
            speed in 0.01..1.1f64, age in 0.0..0.3f64, gap in 0.3..1.8f64,
            low in any::<bool>(), near in any::<bool>(),
        ) {
            let state = State::moving(Floor::new(2.0, 2.0), Planar::new(speed, 0.0));
            let with_gap = |gap: f64| {
                let threat = somebody(Floor::new(2.075 + gap, 2.0), age);
                Threat { low, near_object: near, ..threat }
            };
            let threat = with_gap(gap);
            let sum_m = terms(&state, &threat).required_m();
            if is_certified(&state, threat) {
                prop_assert!(gap >= sum_m, "certified at {gap} m, {sum_m} m asked");
            }
            // Nearer than its brake is long, the column's own way counts up to the head alone.
            let sum_m = terms(&state, &with_gap(2.0)).required_m();
            // The near radius is chosen with the speed that the machine may reach; beside that speed both agree.
            prop_assume!(!near || low || (speed - 0.235).abs() > 0.02);
            let allowance_m = Parameters::new(1.6).following_allowance_m;
            prop_assert!(is_certified(&state, with_gap(sum_m + allowance_m + 1e-6)));
            prop_assert!(!is_certified(&state, with_gap(sum_m + allowance_m - 1e-3)));
        }

        /// From whatever side: a distance of the sum and the allowance is certified.
        #[test]
        fn the_sum_suffices_in_every_direction(
            vx in -1.1..1.1f64, vy in -1.1..1.1f64, round in 0.0..std::f64::consts::TAU, age in 0.0..0.3f64,
        ) {
            let state = State::moving(Floor::new(2.0, 2.0), Planar::new(vx, vy));
            let at = |away: f64| Floor::new(2.0, 2.0) + Planar::new(away, 0.0).turned(round);
            // The sum depends on the place as the way past it does: the nearest place that keeps it.
            let away = (30..400).map(|k| f64::from(k) * 0.01).find(|away| {
                let threat = somebody(at(*away), age);
                let gap_m = in_the_room(&[], |s| s.scene.footprint().distance_m(state.position(), threat.head));
                gap_m > terms(&state, &threat).required_m() + 0.015 + LOOKS_MISS_M
            });
            let threat = somebody(at(away.unwrap_or(4.0)), age);
            prop_assert!(is_certified(&state, threat), "{away:?}");
        }
    }

    /// Between two looks at a brake of half a second a passing column comes nearer by less than this, m.
    const LOOKS_MISS_M: f64 = 2e-3;
}
