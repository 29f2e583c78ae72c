//! `bayes`: a recursive Bayesian filter over the objects and "none of them".
//!
//! A hidden Markov model: the visitor means one object, or none, and changes their mind now and then. Each pose is
//! evidence by where the head looks (and is turning to), where it walks, and how near it is:
//!
//! ```text
//! p_i(t) ~ [ e^(-dt/tau) p_i(t-dt) + (1 - e^(-dt/tau)) P_i ] * exp(dt * l_i)
//! l_i = - g(speed) min(gaze_i, c_g)  -  m(speed) [ w min(way_i, c_w) + n d_i ]
//! belief_i ~ p_i * exp(z_i + q_i)
//! z_i(t) = e^(-dt/tau_z) z_i(t-dt)  -  dt * m(speed) [ h min(heading_i, c_g) + v min(elevation_i, c_v) + u min(way_i, c_w) ]
//! ```
//!
//! The second part is what is seen just now of somebody who walks: the look settles on what is meant only in the last second
//! or so, and weighs more there than anything before. On people left out of the fit it told the goal of five objects 2 to 3
//! points more often from 1.5 s before the touch on than the first part alone. q is what a hand that goes out says of where it
//! goes to ([`hands`]); it is nothing where no hand is tracked.
//!
//! P is the scenario prior and nothing else; a prior that changes reweighs the belief at once. Evidence is counted a
//! second, not a pose, as poses that follow one another say the same. It falls with the angle itself: on recorded reaches
//! that told neighbours apart earlier than bells about the angle did. It is capped (c): people glance away.

mod hands;

use nalgebra::{UnitVector3, Vector3};

use self::hands::HandsWatch;
use super::{Belief, Rule, Sight, View};
use crate::frames::Planar;
use crate::time::Time;

/// The numbers of the filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BayesParameters {
    /// g of somebody who stands, 1/(s rad).
    pub gaze_rate_standing: f64,
    /// g of somebody who walks, 1/(s rad).
    pub gaze_rate_walking: f64,
    /// c_g: a look farther off says no more, rad.
    pub gaze_cap_rad: f64,
    /// The head is taken to where it turns in this time, s.
    pub gaze_lead_secs: f64,
    /// w of somebody who walks, 1/(s rad).
    pub way_rate: f64,
    /// c_w: a way farther off says no more, rad.
    pub way_cap_rad: f64,
    /// n of somebody who walks, 1/(s m).
    pub nearness_rate: f64,
    /// tau_z: for so long what was seen counts as just now, s.
    pub now_secs: f64,
    /// h: how far off the heading is, just now, 1/(s rad).
    pub now_heading_rate: f64,
    /// v: how far off the elevation is, just now, 1/(s rad).
    pub now_elevation_rate: f64,
    /// u: how far off the way is, just now, 1/(s rad).
    pub now_way_rate: f64,
    /// k: how much the way of a hand tells that goes out and comes no nearer to an object, 1/m.
    pub hand_rate: f64,
    /// tau_q: for so long what a hand did counts, s.
    pub hand_secs: f64,
    /// Farther than this from the head axis, over the floor, a hand is held out, m.
    pub hand_out_m: f64,
    /// From this speed on somebody walks in full, m/s.
    pub walking_mps: f64,
    /// tau: for so long a mind is made up, s.
    pub mind_secs: f64,
    /// The prior of "none of them", against 1 for all objects together.
    pub none_prior: f64,
    /// "None of them" looks and walks this far off its goal, rad.
    pub none_angle_rad: f64,
}

/// As `deploy/parameters/bayes.toml` has them, with where they come from.
impl Default for BayesParameters {
    fn default() -> Self {
        Self {
            gaze_rate_standing: 0.46,
            gaze_rate_walking: 8.5,
            gaze_cap_rad: 2.5,
            gaze_lead_secs: 0.2,
            way_rate: 8.0,
            way_cap_rad: 1.45,
            nearness_rate: 0.05,
            now_secs: 0.25,
            now_heading_rate: 43.0,
            now_elevation_rate: 8.0,
            now_way_rate: 10.0,
            hand_rate: 40.0,
            hand_secs: 0.5,
            hand_out_m: 0.35,
            walking_mps: 0.8,
            mind_secs: 42.0,
            none_prior: 0.02,
            none_angle_rad: 0.9,
        }
    }
}

/// The filter of one visitor.
#[derive(Debug, Clone)]
pub struct Bayes {
    parameters: BayesParameters,
    /// Of each object, and of none at the end; sums to 1.
    probabilities: Vec<f64>,
    /// z: what is seen of each just now, and of none at the end.
    now: Vec<f64>,
    /// q: what the hands say of each, and of none at the end; 0 where none was ever tracked.
    reached_for: Vec<f64>,
    hands: HandsWatch,
    /// What they are priors of.
    priors: Vec<f64>,
    seen: Option<Seen>,
}

/// The last pose.
#[derive(Debug, Clone, Copy)]
struct Seen {
    at: Time,
    view: Vector3<f64>,
    /// How the view axis turns, smoothed, 1/s.
    turning: Vector3<f64>,
}

impl Bayes {
    /// Nothing seen yet.
    pub const fn new(parameters: BayesParameters) -> Self {
        Self {
            parameters,
            probabilities: Vec::new(),
            now: Vec::new(),
            reached_for: Vec::new(),
            hands: HandsWatch::NOTHING_SEEN,
            priors: Vec::new(),
            seen: None,
        }
    }

    /// Bring the priors in: as they are at first, by reweighing later.
    fn take_priors(&mut self, sights: &[Sight]) {
        let own = |s: &Sight| if s.enabled { s.prior } else { 0.0 };
        let total: f64 = sights.iter().map(own).sum();
        let scale = if total > 0.0 { 1.0 / (total * (1.0 + self.parameters.none_prior)) } else { 0.0 };
        let none = 1.0 - total * scale;
        let priors = sights.iter().map(|s| own(s) * scale).chain([none]);
        if self.probabilities.len() != sights.len() + 1 {
            self.priors.clear();
            self.priors.extend(priors);
            self.probabilities.clone_from(&self.priors);
            self.now.clear();
            self.now.resize(self.priors.len(), 0.0);
            self.reached_for.clear();
            self.reached_for.resize(self.priors.len(), 0.0);
            self.hands = HandsWatch::NOTHING_SEEN;
            self.seen = None;
            return;
        }
        let mut changed = false;
        for ((probability, before), now) in self.probabilities.iter_mut().zip(&mut self.priors).zip(priors) {
            if *before != now {
                // What could not be meant before has no evidence of its own yet.
                *probability = if *before > 0.0 { *probability * now / *before } else { now };
                *before = now;
                changed = true;
            }
        }
        if changed {
            normalise(&mut self.probabilities, &self.priors);
        }
    }

    /// Where the head looks, and will look in a moment.
    fn look(&self, view: &View<'_>) -> (Seen, f64, UnitVector3<f64>) {
        let now = view.head.view();
        let Some(before) = self.seen else {
            let seen = Seen { at: view.taken_at, view: now, turning: Vector3::zeros() };
            return (seen, 0.0, UnitVector3::new_normalize(now));
        };
        let dt = (view.taken_at - before.at).secs().clamp(0.0, LONGEST_SECS);
        let mut turning = before.turning;
        if dt > 0.0 {
            let blend = 1.0 - (-dt / TURNING_SMOOTHING_SECS).exp();
            turning += ((now - before.view) / dt - turning) * blend;
        }
        let ahead = UnitVector3::new_normalize(now + turning * self.parameters.gaze_lead_secs);
        (Seen { at: view.taken_at, view: now, turning }, dt, ahead)
    }
}

impl Bayes {
    /// What the hands say of each object, `dt` after the pose before.
    fn watch_hands(&mut self, view: &View<'_>, dt: f64) {
        let p = self.parameters;
        let out = self.hands.watch(view, p.hand_out_m);
        let fades = (-dt / p.hand_secs).exp();
        for (i, reached_for) in self.reached_for.iter_mut().enumerate() {
            *reached_for *= fades;
            for hand in out.iter().flatten() {
                let astray_m = match view.sights.get(i) {
                    Some(sight) => hand.astray_m(sight),
                    None => hand.astray_by_m(p.none_angle_rad),
                };
                *reached_for -= p.hand_rate * astray_m;
            }
        }
    }
}

impl Rule for Bayes {
    fn boxed(&self) -> Box<dyn Rule> {
        Box::new(self.clone())
    }

    fn weigh(&mut self, view: &View<'_>, belief: &mut Belief) {
        self.take_priors(view.sights);
        let (seen, dt, ahead) = self.look(view);
        if dt > 0.0 {
            let p = self.parameters;
            let speed = view.velocity.norm();
            let walks = (speed / p.walking_mps).min(1.0);
            let gaze_rate = p.gaze_rate_standing + (p.gaze_rate_walking - p.gaze_rate_standing) * walks;
            let stay = (-dt / p.mind_secs).exp();
            let fades = (-dt / p.now_secs).exp();
            let looks = elevation_and_level(&ahead);
            for (i, probability) in self.probabilities.iter_mut().enumerate() {
                let (off, distance_m) = match view.sights.get(i) {
                    Some(sight) => (Off::of(sight, &ahead, looks, view.velocity), sight.distance_m),
                    None => (Off::NONE_OF_THEM * p.none_angle_rad, 0.0),
                };
                let way = off.way.min(p.way_cap_rad);
                let evidence = -gaze_rate * off.gaze.min(p.gaze_cap_rad)
                    - walks * (p.way_rate * way + p.nearness_rate * distance_m);
                let stayed = stay * *probability + (1.0 - stay) * self.priors[i];
                *probability = stayed * (dt * evidence).exp();
                let just_now = p.now_heading_rate * off.heading.min(p.gaze_cap_rad)
                    + p.now_elevation_rate * off.elevation.min(ELEVATION_CAP_RAD)
                    + p.now_way_rate * way;
                self.now[i] = fades * self.now[i] - dt * walks * just_now;
            }
            normalise(&mut self.probabilities, &self.priors);
        }
        self.seen = Some(seen);
        self.watch_hands(view, dt);
        let count = view.sights.len();
        let seen = || self.now.iter().zip(&self.reached_for).map(|(now, reached_for)| now + reached_for);
        let most = seen().fold(f64::NEG_INFINITY, f64::max);
        belief.weights.clear();
        belief.weights.extend(self.probabilities.iter().zip(seen()).map(|(p, seen)| p * (seen - most).exp()));
        normalise(&mut belief.weights, &self.probabilities);
        belief.none = belief.weights.pop().unwrap_or(1.0);
        belief.committed = belief.best().filter(|i| belief.weights[*i] > COMMITTED_FROM);
        let weights = std::mem::take(&mut belief.weights);
        belief.share_by(count, |i| weights[i]);
        belief.weights = weights;
    }
}

/// How far off an object is from where somebody looks and walks, rad.
#[derive(Debug, Clone, Copy)]
struct Off {
    gaze: f64,
    heading: f64,
    elevation: f64,
    way: f64,
}

impl Off {
    /// In shares of the angle that "none of them" is off: to no side more than to another, up or down little.
    const NONE_OF_THEM: Self = Self { gaze: 1.0, heading: 1.0, elevation: 0.25, way: 1.0 };

    fn of(sight: &Sight, ahead: &UnitVector3<f64>, looks: (f64, f64), velocity: Planar) -> Self {
        let towards = Vector3::new(sight.offset.x, sight.offset.y, sight.rise_m);
        let away_m = sight.offset.norm();
        let view = Planar::new(ahead.x, ahead.y);
        let (elevation, level) = looks;
        Self {
            gaze: angle(towards.dot(ahead), towards.norm()),
            heading: angle(view.dot(sight.offset), level * away_m),
            elevation: (sight.rise_m.atan2(away_m) - elevation).abs(),
            way: angle(velocity.dot(sight.offset), velocity.norm() * away_m),
        }
    }
}

impl std::ops::Mul<f64> for Off {
    type Output = Self;

    fn mul(self, rad: f64) -> Self {
        Self {
            gaze: self.gaze * rad,
            heading: self.heading * rad,
            elevation: self.elevation * rad,
            way: self.way * rad,
        }
    }
}

/// The elevation of a direction, rad, and how much of it is level.
fn elevation_and_level(direction: &UnitVector3<f64>) -> (f64, f64) {
    let level = direction.x.hypot(direction.y);
    (direction.z.atan2(level), level)
}

/// The angle of a scalar product, rad; 0 where there is no direction: what is here is looked at.
fn angle(product: f64, lengths: f64) -> f64 {
    if lengths > 1e-9 { (product / lengths).clamp(-1.0, 1.0).acos() } else { 0.0 }
}

/// Scale to a sum of 1; back to the priors when nothing is left.
fn normalise(probabilities: &mut [f64], priors: &[f64]) {
    let total: f64 = probabilities.iter().sum();
    if total > f64::MIN_POSITIVE && total.is_finite() {
        probabilities.iter_mut().for_each(|p| *p /= total);
    } else {
        probabilities.copy_from_slice(priors);
    }
}

/// The visitor is taken to mean what is more probable than all else together.
const COMMITTED_FROM: f64 = 0.5;
/// An elevation farther off says no more, rad.
const ELEVATION_CAP_RAD: f64 = 1.0;
/// One pose is evidence of no longer than this, s.
const LONGEST_SECS: f64 = 0.1;
/// A turn of the head shows after about this long, s.
const TURNING_SMOOTHING_SECS: f64 = 0.08;

#[cfg(test)]
mod tests {
    use super::super::tests::{sight, view};
    use super::*;
    use crate::frames::Planar;

    fn rule() -> Bayes {
        Bayes::new(BayesParameters::default())
    }

    /// A second of poses of somebody who stands or walks along the view axis.
    fn watched(rule: &mut Bayes, from_millis: i64, sights: &[Sight], speed_mps: f64) -> Belief {
        let mut belief = Belief::default();
        for k in 0..=75 {
            let velocity = Planar::new(speed_mps, 0.0);
            rule.weigh(&View { velocity, ..view(from_millis + k * 1000 / 75, sights) }, &mut belief);
        }
        belief
    }

    #[test]
    fn it_is_a_distribution_over_the_objects_and_none() {
        let off = Sight { enabled: false, ..sight(0.5, 0.0, 1.0) };
        let belief = watched(&mut rule(), 0, &[sight(1.5, 0.0, 1.0), sight(1.5, 40.0, 0.5), off], 0.7);
        assert!((belief.total() - 1.0).abs() < 1e-9 && belief.none > 0.0, "{belief:?}");
        assert_eq!(belief.weights[2], 0.0, "what is not enabled is not meant");
    }

    #[test]
    fn looks_and_steps_tell_neighbours_apart_and_steps_the_sooner() {
        let neighbours = [sight(1.5, 0.0, 1.0), sight(1.5, 15.0, 1.0)];
        let stands = watched(&mut rule(), 0, &neighbours, 0.0);
        let walks = watched(&mut rule(), 0, &neighbours, 0.8);
        assert!(stands.weights[0] > 0.52 && walks.weights[0] > 0.98, "{stands:?} {walks:?}");
        assert_eq!(walks.committed, Some(0));
    }

    #[test]
    fn people_change_their_minds() {
        let mut rule = rule();
        watched(&mut rule, 0, &[sight(1.5, 0.0, 1.0), sight(1.5, 90.0, 1.0)], 0.8);
        let turned = watched(&mut rule, 1_013, &[sight(1.5, 90.0, 1.0), sight(1.5, 0.0, 1.0)], 0.8);
        assert!(turned.weights[1] > 0.9, "{turned:?}");
    }

    #[test]
    fn a_prior_that_changes_reweighs_the_belief_at_once_and_comes_back() {
        let mut rule = rule();
        let with = |a: f64, b: f64| [sight(1.5, 20.0, a), sight(1.5, 20.0, b)];
        watched(&mut rule, 0, &with(1.0, 1.0), 0.0);
        let mut belief = Belief::default();
        rule.weigh(&view(1000, &with(1.0, 0.25)), &mut belief);
        assert!((belief.weights[0] / belief.weights[1] - 4.0).abs() < 0.05, "{belief:?}");
        rule.weigh(&view(1000, &with(1.0, 1.0)), &mut belief);
        assert!((belief.weights[0] / belief.weights[1] - 1.0).abs() < 0.05, "{belief:?}");
        rule.weigh(&view(1000, &with(0.0, 1.0)), &mut belief);
        assert_eq!((belief.weights[0], belief.committed), (0.0, Some(1)), "{belief:?}");
    }

    #[test]
    fn somebody_who_walks_away_from_everything_means_none() {
        let behind = [sight(1.5, 150.0, 1.0), sight(1.5, 170.0, 1.0)];
        let belief = watched(&mut rule(), 0, &behind, 0.8);
        assert!(belief.none > 0.9 && belief.committed.is_none(), "{belief:?}");
    }

    #[test]
    fn without_any_prior_there_is_nothing_to_mean() {
        let belief = watched(&mut rule(), 0, &[sight(1.5, 0.0, 0.0)], 0.5);
        assert_eq!((belief.weights[0], belief.none), (0.0, 1.0));
        assert_eq!(belief.shares, [0.0]);
    }
}
