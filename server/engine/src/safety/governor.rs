//! The governor: turns wanted velocities into the next commanded state, or into braking.
//!
//! It takes the first proposal whose next state separation certifies. When none is, it brakes each axis at its limit:
//! the path that was certified one step before, so the brake needs nobody's leave. A person who has moved since has
//! moved within what the certificate allowed for.

use crate::frames::{Floor, Planar};
use crate::machine::{AxisLimits, Limits};
use crate::safety::contact::Contact;
use crate::safety::path::{AxisPath, AxisState, BrakePath, State};
use crate::safety::separation::{Conflict, Separation};
use crate::safety::vetted::{Action, Setpoint, Vetted};
use crate::time::{Span, Time};

/// The state last commanded to the machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Governor {
    commanded: State,
}

/// What became of the proposals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// The proposal taken; none: it brakes.
    pub taken: Option<usize>,
    /// Why the first proposal was not.
    pub conflict: Option<Conflict>,
}

impl Governor {
    /// Take a machine that rests over where it is measured. One that moves is told to hold first: what it could do from
    /// its motion was certified by nobody.
    pub fn taking_over(place: Floor) -> Self {
        Self { commanded: State::moving(place, Planar::ZERO) }
    }

    /// For so long nothing was commanded: the machine went on at the acceleration that it was told last, no faster than
    /// it may and not past rest. That is within what was certified, as long as it is no longer than one reaction.
    pub fn carry_on(&mut self, unwatched: Span, limits: &Limits) {
        let (State { x, y }, secs) = (self.commanded, unwatched.secs());
        self.commanded = State { x: x.carried_on(secs, &limits.x), y: y.carried_on(secs, &limits.y) };
    }

    /// Move on by one period with the first allowed of `proposals` (velocities, best first), else brake.
    pub fn govern(
        &mut self,
        proposals: &[Planar],
        measured: &State,
        separation: &Separation<'_>,
        period: Span,
    ) -> Choice {
        if let Err(conflict) = separation.certify_measured(measured) {
            self.brake(separation.limits, period);
            return Choice { taken: None, conflict: Some(conflict) };
        }
        let mut first_conflict = None;
        // In one period the jerk lets the axes get to few different states: most proposals lead to one that was refused.
        let mut refused: Vec<State> = Vec::new();
        for (index, velocity) in proposals.iter().enumerate() {
            let next = self.towards(*velocity, separation.limits, period);
            if refused.contains(&next) {
                continue;
            }
            match separation.certify(&next) {
                Ok(()) => {
                    self.commanded = next;
                    return Choice { taken: Some(index), conflict: first_conflict };
                }
                Err(conflict) => {
                    first_conflict = first_conflict.or(Some(conflict));
                    refused.push(next);
                }
            }
        }
        self.brake(separation.limits, period);
        Choice { taken: None, conflict: first_conflict }
    }

    /// Move on by one period in a contact interaction (R14): the wanted velocity or less of it, no faster than the contact
    /// may be and as gently as it must; else brake.
    pub fn govern_contact(
        &mut self,
        wanted: Planar,
        contact: &Contact,
        measured: &State,
        separation: &Separation<'_>,
        period: Span,
    ) -> Choice {
        let mut first_conflict = separation.certify_measured(measured).err();
        let fastest = contact.speed_mps(separation.parameters);
        let gentle = contact.limits(separation.limits, separation.parameters);
        let too_fast = self.commanded.velocity().norm() > fastest + ROUNDING_MPS;
        if first_conflict.is_none() && !too_fast && !self.would_turn_about(&gentle) {
            // Its axes each within the limit may be faster together than one of them: what is wanted leaves room for that.
            let wanted = wanted.capped(CORNERING * fastest);
            for (index, share) in CONTACT_SHARES.into_iter().enumerate() {
                let next = self.towards(wanted * share, &gentle, period);
                if next.velocity().norm() > fastest {
                    continue;
                }
                match separation.certify(&next) {
                    Ok(()) => {
                        self.commanded = next;
                        return Choice { taken: Some(index), conflict: first_conflict };
                    }
                    Err(conflict) => first_conflict = first_conflict.or(Some(conflict)),
                }
            }
        }
        self.brake(separation.limits, period);
        Choice { taken: None, conflict: first_conflict }
    }

    /// Brake along the path where that is certified, else at the limit of each axis.
    pub fn protective_brake(&mut self, separation: &Separation<'_>, period: Span) {
        let State { x, y } = self.commanded;
        let fastest = x.v.abs().max(y.v.abs()).max(f64::MIN_POSITIVE);
        let share = |v: f64| (v.abs() / fastest).max(LEAST_SHARE);
        let along = State {
            x: AxisPath::brake_with_share(x, &separation.limits.x, share(x.v)).at(period.secs()),
            y: AxisPath::brake_with_share(y, &separation.limits.y, share(y.v)).at(period.secs()),
        };
        match separation.certify(&along) {
            Ok(()) => self.commanded = along,
            Err(_) => self.brake(separation.limits, period),
        }
    }

    /// Brake each axis at its limit.
    pub fn brake(&mut self, limits: &Limits, period: Span) {
        self.commanded = BrakePath::now(&self.commanded, limits).at(period.secs());
    }

    /// The state last commanded.
    pub fn commanded(&self) -> &State {
        &self.commanded
    }

    /// It is told to stand.
    pub fn rests(&self) -> bool {
        self.commanded.velocity().norm() < RESTS_MPS
    }

    /// The command for it, valid for `valid_for`.
    pub fn command(&self, now: Time, valid_for: Span) -> Vetted {
        Vetted::new(
            now,
            Action::Track(Setpoint {
                position: self.commanded.position(),
                velocity: self.commanded.velocity(),
                acceleration: self.commanded.acceleration(),
                valid_for,
            }),
        )
    }

    /// A brake harder than this is under way, and eased off as gently as this it would end in motion the other way.
    fn would_turn_about(&self, gentle: &Limits) -> bool {
        let turns = |axis: AxisState, own: &AxisLimits| {
            axis.v * axis.a < 0.0 && axis.a * axis.a > 2.0 * own.jerk_mps3 * axis.v.abs()
        };
        turns(self.commanded.x, &gentle.x) || turns(self.commanded.y, &gentle.y)
    }

    fn towards(&self, velocity: Planar, limits: &Limits, period: Span) -> State {
        let cap = |v: f64, most: f64| v.clamp(-most, most);
        let State { x, y } = self.commanded;
        let next = |axis: AxisState, wanted: f64, own: &AxisLimits| {
            AxisPath::towards_velocity(axis, cap(wanted, own.speed_mps), own, period.secs())
        };
        State { x: next(x, velocity.x, &limits.x), y: next(y, velocity.y, &limits.y) }
    }
}

/// Of what is wanted in a contact, the shares that are tried.
const CONTACT_SHARES: [f64; 3] = [1.0, 0.5, 0.0];
/// Of the greatest speed of a contact, what is wanted at most.
const CORNERING: f64 = 0.95;
/// Slower than this it is told to stand, m/s.
const RESTS_MPS: f64 = 1e-3;
/// Floating point, m/s.
const ROUNDING_MPS: f64 = 1e-9;
/// The slower axis keeps at least this share of its braking, so that both come to rest.
const LEAST_SHARE: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Point;
    use crate::machine::Travel;
    use crate::observation::PersonId;
    use crate::safety::parameters::Parameters;
    use crate::safety::separation::Threat;
    use crate::scene::{ObjectSpec, Scene, SceneSpec, Shape};
    use proptest::prelude::*;

    const TRAVEL: Travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
    const PERIOD: Span = Span::from_millis(4);

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

    fn velocity() -> impl Strategy<Value = Planar> {
        (-1.5..1.5f64, -1.5..1.5f64).prop_map(|(x, y)| Planar::new(x, y))
    }

    proptest! {
        /// Whatever is proposed: limits are kept from step to step, and what was taken is certified.
        #[test]
        fn whatever_is_proposed_limits_are_kept_and_what_is_taken_is_certified(
            wishes in prop::collection::vec(prop::collection::vec(velocity(), 1..4), 1..40),
            (hx, hy) in (0.0..4.0f64, 0.0..4.0f64),
        ) {
            let (scene, parameters) = (scene(), Parameters::new(1.6));
            let threats = [Threat {
                person: PersonId(1),
                head: Floor::new(hx, hy),
                velocity: Planar::ZERO,
                age_secs: 0.03,
                near_object: false,
                low: false,
            }];
            let separation = Separation {
                scene: &scene,
                limits: &Limits::PAPER,
                travel: &TRAVEL,
                threats: &threats,
                parameters: &parameters,
                contact: None,
            };
            let mut governor = Governor::taking_over(Floor::new(2.0, 2.0));
            for proposals in wishes.iter().flat_map(|wish| std::iter::repeat_n(wish, 8)) {
                let before = *governor.commanded();
                let choice = governor.govern(proposals, &before, &separation, PERIOD);
                let now = governor.commanded();
                if choice.taken.is_some() {
                    prop_assert_eq!(separation.certify(now), Ok(()));
                }
                for (now, before, limits) in [(now.x, before.x, Limits::PAPER.x), (now.y, before.y, Limits::PAPER.y)] {
                    prop_assert!(now.v.abs() <= limits.speed_mps + 1e-9, "{} m/s", now.v);
                    prop_assert!(now.a.abs() <= limits.braking_mps2 + 1e-9, "{} m/s2", now.a);
                    prop_assert!((now.a - before.a).abs() <= limits.jerk_mps3 * PERIOD.secs() + 1e-9);
                    prop_assert!((now.p - before.p).abs() <= limits.speed_mps * PERIOD.secs() + 1e-9);
                }
            }
        }

        /// What is refused unasked would have been refused: the choice is that of asking for each.
        #[test]
        fn a_proposal_that_leads_where_another_was_refused_is_refused_alike(
            wishes in prop::collection::vec(prop::collection::vec(velocity(), 1..30), 1..12),
            (hx, hy) in (1.0..3.0f64, 1.0..3.0f64),
            period in prop::sample::select(vec![PERIOD, Span::from_micros(13_334)]),
        ) {
            let (scene, parameters) = (scene(), Parameters::new(1.6));
            let threats = [Threat {
                person: PersonId(1),
                head: Floor::new(hx, hy),
                velocity: Planar::ZERO,
                age_secs: 0.03,
                near_object: false,
                low: false,
            }];
            let separation = Separation {
                scene: &scene,
                limits: &Limits::PAPER,
                travel: &TRAVEL,
                threats: &threats,
                parameters: &parameters,
                contact: None,
            };
            let mut governor = Governor::taking_over(Floor::new(2.0, 2.0));
            for proposals in wishes.iter().flat_map(|wish| std::iter::repeat_n(wish, 5)) {
                let before = governor;
                let choice = governor.govern(proposals, before.commanded(), &separation, period);
                let verdict = |wanted: &Planar| separation.certify(&before.towards(*wanted, &Limits::PAPER, period));
                if before.commanded().velocity().norm() < 0.02 || separation.certify_measured(before.commanded()).is_ok() {
                    prop_assert_eq!(choice.taken, proposals.iter().position(|wanted| verdict(wanted).is_ok()));
                    let first = proposals.first().and_then(|wanted| verdict(wanted).err());
                    prop_assert_eq!(choice.conflict, first);
                }
            }
        }

        /// What went on unwatched for a reaction at most ends where the certificate allowed for.
        #[test]
        fn what_goes_on_unwatched_stays_inside_the_certified_brake(
            v in velocity(),
            wish in velocity(),
            unwatched_millis in 1..50i64,
        ) {
            let cap = |v: f64| v.clamp(-1.1, 1.1);
            let mut governor = Governor {
                commanded: State::moving(Floor::new(2.0, 2.0), Planar::new(cap(v.x), cap(v.y))),
            };
            for _ in 0..5 {
                governor.commanded = governor.towards(wish, &Limits::PAPER, PERIOD);
            }
            let certified = BrakePath::worst(governor.commanded(), &Limits::PAPER, 0.05).extent();
            governor.carry_on(Span::from_millis(unwatched_millis), &Limits::PAPER);
            let after = BrakePath::now(governor.commanded(), &Limits::PAPER).extent();
            // The worst brake bounds each axis in the direction in which it goes, but for the millimetres by which an
            // axis near its top speed is there sooner: the allowance for following has room for that.
            for (of, v) in [((certified.0.x, certified.1.x, after.0.x, after.1.x), governor.commanded.x.v),
                            ((certified.0.y, certified.1.y, after.0.y, after.1.y), governor.commanded.y.v)] {
                let (least, most, least_after, most_after) = of;
                if v > 0.0 {
                    prop_assert!(most_after <= most + 3e-3, "{} past {}", most_after, most);
                } else {
                    prop_assert!(least_after >= least - 3e-3, "{} past {}", least_after, least);
                }
            }
        }

        /// Braking comes to rest, on either kind of brake, and stays there.
        #[test]
        fn both_brakes_come_to_rest(v in velocity()) {
            let (scene, parameters) = (scene(), Parameters::new(1.6));
            let separation = Separation {
                scene: &scene,
                limits: &Limits::PAPER,
                travel: &TRAVEL,
                threats: &[],
                parameters: &parameters,
                contact: None,
            };
            let v = Planar::new(v.x.clamp(-1.1, 1.1), v.y.clamp(-1.1, 1.1));
            let mut along = Governor { commanded: State::moving(Floor::new(2.0, 2.0), v) };
            let mut hardest = along;
            for _ in 0..200 {
                along.protective_brake(&separation, PERIOD);
                hardest.brake(&Limits::PAPER, PERIOD);
            }
            for governor in [along, hardest] {
                let rest = governor.commanded();
                prop_assert!(rest.velocity().norm() < 1e-6 && rest.acceleration().norm() < 1e-3, "{:?}", rest);
                prop_assert!(rest.position().distance_m(Floor::new(2.0, 2.0)) < 0.6);
            }
        }
    }
}
