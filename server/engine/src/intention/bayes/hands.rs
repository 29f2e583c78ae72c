//! What a hand that goes out says of where it goes to.
//!
//! A hand goes nearly straight to what it reaches for (Morasso 1981; Flash and Hogan 1985). So the way of the hand that brings it
//! no nearer to an object speaks against it, by the metre:
//!
//! ```text
//! q_i(t) = e^(-dt/tau_q) q_i(t-dt)  -  k * m (1 - cos(angle between the hand's way and the way to object i))
//! ```
//!
//! with m the way in dt, m; what is summed up is the length of the way less how much nearer it came (Dragan, Lee and Srinivasa,
//! Legibility and Predictability of Robot Motion, HRI 2013, with the length as the cost of a path). The way is that relative to the
//! head: what the body covers is evidence already. It counts where the hand is held out farther than one that swings or rests, and
//! in full where it goes outwards; a hand drawn back says nothing of what lies behind it.
//!
//! No recording has hands, so the numbers are not fitted. k takes the direction of a reaching hand to be off its goal by 15 degrees (a
//! standard deviation) over each 0.4 m, half an arm: for small angles k (1 - cos) 0.4 m = angle^2 / (2 * 0.26^2) gives 37/m. An arm that
//! swings at the hip, or holds a controller before the belly, keeps its hand within 0.35 m of the head axis.
//!
//! Weighed: *the angle itself, a second* (a hand that goes slowly would say as much as one that goes fast), *the end of a
//! minimum-jerk motion through what was seen* (needs its beginning, and is far off until the peak of speed), *the way by the
//! metre* (chosen: one number, and noise of a hand that rests says the same of every object).

use nalgebra::{UnitVector3, Vector3};

use super::super::{Sight, View};
use crate::frames::{Planar, Pose, Room};
use crate::observation::Hands;
use crate::time::Time;

/// Both hands, from pose to pose.
#[derive(Debug, Clone, Copy)]
pub(super) struct HandsWatch([Option<Seen>; 2]);

/// A hand at the last pose.
#[derive(Debug, Clone, Copy)]
struct Seen {
    at: Time,
    /// From the head, m.
    off: Vector3<f64>,
    /// Relative to the head, smoothed, m/s.
    velocity: Vector3<f64>,
}

/// A hand that went out since the pose before.
#[derive(Debug, Clone, Copy)]
pub(super) struct GoesOut {
    off: Vector3<f64>,
    way: UnitVector3<f64>,
    /// As far as it counts, m.
    went_m: f64,
}

impl HandsWatch {
    /// No hand was ever seen.
    pub(super) const NOTHING_SEEN: Self = Self([None; 2]);

    /// Take the hands of a pose; which of them went out. The same pose again is nothing new. A hand counts as out from `out_m` off the
    /// head axis on.
    pub(super) fn watch(&mut self, view: &View<'_>, out_m: f64) -> [Option<GoesOut>; 2] {
        let offs = offs(&view.head, &view.hands);
        let mut out = [None; 2];
        for ((before, off), out) in self.0.iter_mut().zip(offs).zip(&mut out) {
            let Some(off) = off else {
                *before = None;
                continue;
            };
            let (seen, secs) = Seen::after(*before, view.taken_at, off);
            *before = Some(seen);
            *out = GoesOut::of(&seen, secs, out_m);
        }
        out
    }
}

/// From the head to each hand that can be believed, m.
fn offs(head: &Pose<Room>, hands: &Hands) -> [Option<Vector3<f64>>; 2] {
    // NaN is no distance either.
    hands
        .both()
        .map(|hand| Some(hand?.vector() - head.position.vector()).filter(|off| off.norm() <= FARTHEST_M))
}

impl Seen {
    /// The hand now, and for how long it was followed since the pose before, s: 0 where it is seen for the first time, or anew.
    fn after(before: Option<Self>, at: Time, off: Vector3<f64>) -> (Self, f64) {
        let anew = (Self { at, off, velocity: Vector3::zeros() }, 0.0);
        let Some(before) = before else { return anew };
        let secs = (at - before.at).secs();
        if secs <= 0.0 {
            return (before, 0.0);
        }
        let velocity = (off - before.off) / secs;
        if secs > LONGEST_SECS || velocity.norm() > FASTEST_MPS {
            return anew;
        }
        let blend = 1.0 - (-secs / SMOOTHING_SECS).exp();
        (Self { at, off, velocity: before.velocity + (velocity - before.velocity) * blend }, secs)
    }
}

impl GoesOut {
    fn of(seen: &Seen, secs: f64, out_m: f64) -> Option<Self> {
        let speed = seen.velocity.norm();
        if secs <= 0.0 || speed <= STILL_MPS {
            return None;
        }
        let aside = Planar::new(seen.off.x, seen.off.y);
        let is_out = ((aside.norm() - out_m) / OUT_IN_FULL_M).clamp(0.0, 1.0);
        let outwards = aside.unit().map_or(0.0, |out| Planar::new(seen.velocity.x, seen.velocity.y).dot(out));
        let went_m = is_out * 0.5 * (1.0 + outwards / speed) * (speed - STILL_MPS) * secs;
        let way = UnitVector3::new_unchecked(seen.velocity / speed);
        (went_m > 0.0).then_some(Self { off: seen.off, way, went_m })
    }

    /// The way that brought it no nearer to an object, m: 0 straight to it, twice the way straight from it.
    pub(super) fn astray_m(&self, sight: &Sight) -> f64 {
        let left = Vector3::new(sight.offset.x, sight.offset.y, sight.rise_m) - self.off;
        let left_m = left.norm();
        // At an object there is no way to it left.
        let share = (left_m / AT_IT_M).min(1.0);
        if share > 0.0 { share * self.went_m * (1.0 - left.dot(&self.way) / left_m).max(0.0) } else { 0.0 }
    }

    /// The same for a goal that is so far off the way, rad.
    pub(super) fn astray_by_m(&self, angle_rad: f64) -> f64 {
        self.went_m * (1.0 - angle_rad.cos())
    }
}

/// No hand is farther from its head, m: the arm of a tall person (0.8 m) from a shoulder (0.3 m).
const FARTHEST_M: f64 = 1.1;
/// No hand goes faster relative to the head, m/s: it is one that tracking found elsewhere.
const FASTEST_MPS: f64 = 6.0;
/// Over a longer time than this without a pose nobody knows which way it took, s.
const LONGEST_SECS: f64 = 0.1;
/// A hand that is slower rests, or is noise, m/s.
const STILL_MPS: f64 = 0.15;
/// A motion of the hand shows after about this long, s.
const SMOOTHING_SECS: f64 = 0.04;
/// So much farther than where it begins to be out it is so in full, m.
const OUT_IN_FULL_M: f64 = 0.15;
/// So near to an object's place a hand is at it, m.
const AT_IT_M: f64 = 0.1;

#[cfg(test)]
mod tests;
