//! The physical limit of a trial: could any motion of the column have served this reach?
//!
//! A clairvoyant knows the whole walk and the goal from the first replayed pose. It asks whether there is a motion within
//! the speed, acceleration and braking of each axis, beginning at rest at the start place, that keeps the separation rule
//! against the true head at every moment and stands within 10 cm of the goal, slower than 0.05 m/s, for the last 0.2 s.
//! Jerk is left out: it is a bound, and a real machine does a little worse.
//!
//! The answer is bracketed. A motion that was found is driven past the independent checker, tick by tick, and so is a
//! certificate: the limit is no lower. Where none is found, a search with every rounding in the column's favour
//! says whether one could exist: the limit is no higher. What lies between is [`Bound::Undecided`].
//!
//! Both search forward over all places and speeds at once ([`sweep`]): on the lattice of [`lattice`], motions of
//! constant acceleration for a step each, everything that can be reached is a set of bits, and the rule clears the bits
//! of places from which a step would break it ([`separation`]).

mod driven;
mod lattice;
mod separation;
mod sweep;
mod walk;

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{Limits, Travel};
use covr_engine::scene::Scene;
use covr_engine::time::Time;

use crate::checker::{Motion, Rules};
use crate::replay::{TrialProblem, rules_of};
use crate::trace::Recording;
pub use driven::Driven;
use lattice::AxisLattice;
use separation::{Separation, Sharpness};
use sweep::{State, Sweep};
use walk::Walk;

/// A reach whose limit is asked for.
#[derive(Debug, Clone, Copy)]
pub struct Question<'a> {
    /// The person.
    pub recording: &'a Recording,
    /// Objects, column and keep-outs in the recording's room; what is near an object decides which r applies.
    pub scene: &'a Scene,
    /// Where the column has to stand, room frame.
    pub place: Floor,
    /// Where it rests at the beginning, room frame.
    pub start: Floor,
    /// From the first replayed pose.
    pub begins: Time,
    /// To the reach.
    pub reach: Time,
    /// What each axis may do; jerk is not used.
    pub limits: Limits,
    /// Where the column can stand.
    pub travel: Travel,
    /// v_h of the separation rule, m/s.
    pub v_h_mps: f64,
}

/// Whether the reach could have been served.
#[derive(Debug, Clone, PartialEq)]
pub enum Bound {
    /// Yes: by this motion, which the checker has passed.
    Possible(Box<Driven>),
    /// None was found, and none was excluded.
    Undecided,
    /// No: not even with every rounding in the column's favour.
    Impossible,
}

/// A motion of constant accelerations, at rest before and after.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// When the first piece begins, after the first replayed pose, s.
    begins_secs: f64,
    /// How long each piece lasts, s.
    piece_secs: f64,
    /// Place and velocity between the pieces.
    knots: Vec<Motion>,
}

/// Search for a motion that serves the reach.
pub fn bound(question: &Question<'_>) -> Result<Bound, TrialProblem> {
    let walk = Walk::of(question.recording, question.scene, question.begins, question.reach)
        .ok_or_else(|| TrialProblem::NoFrames(question.recording.trial.clone()))?;
    let rules = Rules {
        v_h_mps: question.v_h_mps,
        ..rules_of(question.limits, question.travel, question.scene.spec())
    };
    for (levels, spare_m) in STRICT {
        let sweep = strict(question, &walk, &rules, levels, spare_m);
        let plan = sweep.path().map(|path| Plan::of(&sweep, &path));
        let driven = plan.map(|plan| Driven::along(plan, &walk, &rules, question.place));
        if let Some(driven) = driven.filter(Driven::serves) {
            return Ok(Bound::Possible(Box::new(driven)));
        }
    }
    let possible = lenient(question, &walk, &rules).reaches_goal();
    Ok(if possible { Bound::Undecided } else { Bound::Impossible })
}

impl Plan {
    fn of(sweep: &Sweep<'_>, path: &[State]) -> Self {
        let knot = |state: &State| {
            let place = |axis: usize| sweep.axes[axis].place_m(state.place[axis]);
            let speed = |axis: usize| sweep.axes[axis].quantum_mps() * f64::from(state.speed[axis]);
            Motion { position: Floor::new(place(0), place(1)), velocity: Planar::new(speed(0), speed(1)) }
        };
        Self {
            begins_secs: sweep.begins_secs,
            piece_secs: sweep.step_secs,
            knots: path.iter().map(knot).collect(),
        }
    }

    /// The column so many seconds after the first replayed pose.
    pub fn at(&self, secs: f64) -> Motion {
        let pieces = (secs - self.begins_secs) / self.piece_secs;
        let last = self.knots.len() - 1;
        if pieces <= 0.0 || pieces >= last as f64 {
            return self.knots[if pieces <= 0.0 { 0 } else { last }];
        }
        let (before, after) = (self.knots[pieces as usize], self.knots[pieces as usize + 1]);
        let into = (pieces - pieces.floor()) * self.piece_secs;
        let gained = (after.velocity - before.velocity) * (1.0 / self.piece_secs);
        Motion {
            position: before.position + before.velocity * into + gained * (0.5 * into * into),
            velocity: before.velocity + gained * into,
        }
    }
}

/// Steps that end so early that the column has been slow for 0.2 s at the reach: the last piece brakes at the rate of
/// speeding up at least, and passes 0.05 m/s by [`SETTLED_SECS`] before its end.
fn strict<'a>(
    question: &Question<'_>,
    walk: &'a Walk,
    rules: &'a Rules,
    levels: f64,
    spare_m: f64,
) -> Sweep<'a> {
    let step_secs = step_secs(&question.limits, levels);
    let ends_secs = walk.secs() - CALM_SECS + SETTLED_SECS;
    let steps = (ends_secs / step_secs).floor().max(0.0) as usize;
    let sharpness = Sharpness::Strict { spare_m };
    let within = question.travel.shrunk(rules.travel_margin_m);
    Sweep {
        steps,
        begins_secs: ends_secs - steps as f64 * step_secs,
        step_secs,
        within_m: WITHIN_M,
        at_rest: 0,
        ..sweep(question, walk, rules, sharpness, step_secs, 1.0, within)
    }
}

/// One step more than there is time for, more acceleration, a blurred rule and a wider goal.
fn lenient<'a>(question: &Question<'_>, walk: &'a Walk, rules: &'a Rules) -> Sweep<'a> {
    let step_secs = step_secs(&question.limits, LENIENT_LEVELS);
    let ends_secs = walk.secs() - CALM_SECS;
    let steps = (ends_secs / step_secs).ceil().max(0.0) as usize;
    let brake = |own: &covr_engine::machine::AxisLimits| {
        own.speed_mps / own.braking_mps2 + own.braking_mps2 / own.jerk_mps3
    };
    let comply_secs = rules.reaction.secs() + brake(&question.limits.x).max(brake(&question.limits.y));
    let sharpness = Sharpness::Lenient { blur_m: BLUR_M, comply_secs };
    Sweep {
        steps,
        begins_secs: ends_secs - steps as f64 * step_secs,
        step_secs,
        within_m: WITHIN_M + CREPT_M + BLUR_M,
        at_rest: 1,
        ..sweep(question, walk, rules, sharpness, step_secs, HASTE, question.travel)
    }
}

/// A step in which an axis gains one of `levels` speeds; a slow axis gets fewer of them.
fn step_secs(limits: &Limits, levels: f64) -> f64 {
    (limits.x.speed_mps / (limits.x.acceleration_mps2 * levels)).max(LEAST_STEP_SECS)
}

fn sweep<'a>(
    question: &Question<'_>,
    walk: &'a Walk,
    rules: &'a Rules,
    sharpness: Sharpness,
    step_secs: f64,
    haste: f64,
    within: Travel,
) -> Sweep<'a> {
    let within_travel_m = [[within.min.x, within.max.x], [within.min.y, within.max.y]];
    let (travel, limits, start) = (question.travel, question.limits, question.start);
    Sweep {
        axes: [
            AxisLattice::new(&limits.x, haste, step_secs, [travel.min.x, travel.max.x], start.x),
            AxisLattice::new(&limits.y, haste, step_secs, [travel.min.y, travel.max.y], start.y),
        ],
        separation: Separation { walk, footprint: &rules.footprint, v_h_mps: rules.v_h_mps, sharpness },
        step_secs,
        begins_secs: 0.0,
        steps: 0,
        goal: question.place,
        within_m: WITHIN_M,
        at_rest: 0,
        within_travel_m,
    }
}

/// How near the column's centre has to be, m.
const WITHIN_M: f64 = 0.1;
/// For how long, s.
const CALM_SECS: f64 = 0.2;
/// From 0.05 m/s to rest takes longer than this for every axis that brakes at 2.5 m/s2 or less, s.
const SETTLED_SECS: f64 = 0.016;
/// Speeds between rest and the fastest, and distance to spare: the coarse lattice finds most, quickly.
const STRICT: [(f64, f64); 3] = [(5.0, 0.01), (8.0, 0.004), (8.0, 0.02)];
/// Shorter steps make more places than are worth their time, s.
const LEAST_STEP_SECS: f64 = 0.08;
/// Of the lenient search.
const LENIENT_LEVELS: f64 = 10.0;
/// Any motion within the limits is followed this closely by one of the lenient lattice, m.
const BLUR_M: f64 = 0.03;
/// With so much more acceleration.
const HASTE: f64 = 1.1;
/// A column slower than 0.05 m/s creeps so far in 0.2 s, m.
const CREPT_M: f64 = 0.01;

#[cfg(test)]
mod tests;
