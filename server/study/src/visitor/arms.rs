//! The made-up visitor's hands: they hang and swing, and one of them goes out to the object and comes back.
//!
//! Nobody recorded these. A reach is a minimum-jerk motion (Flash and Hogan 1985) along a path that bows a little to one side,
//! begun while the last step is made; arms swing at half the rate of the steps. They have chance of their own, so that
//! heads walk and look as they would without.

use std::f64::consts::{PI, TAU};

use covr_engine::frames::{Planar, Point, Pose, Room};
use covr_engine::observation::Hands;
use covr_engine::time::{Span, Time};
use nalgebra::Vector3;

use crate::random::Random;

/// Both arms.
#[derive(Debug, Clone)]
pub(super) struct Arms {
    random: Random,
    /// Heading of the trunk; it follows the head.
    trunk_rad: f64,
    last_at: Option<Time>,
    last_head: Option<Planar>,
    /// How fast the head walks, smoothed, m/s.
    walks_mps: f64,
    reach: Option<Reach>,
}

/// A hand on its way to an object, at it, or on its way back.
#[derive(Debug, Clone, Copy)]
struct Reach {
    is_left: bool,
    to: Vector3<f64>,
    bow_m: f64,
    starts: Time,
    arrives: Time,
    /// When it is drawn back, once that is known.
    leaves: Option<Time>,
}

impl Arms {
    pub fn new(seed: u64, heading_rad: f64) -> Self {
        Self {
            random: Random::seeded(seed),
            trunk_rad: heading_rad,
            last_at: None,
            last_head: None,
            walks_mps: 0.0,
            reach: None,
        }
    }

    /// A hand will be at this place then, the head having come at `head_arrives`. Which, and how it goes, is chance.
    pub fn reach_for(&mut self, place: Point<Room>, head_arrives: Time, arrives: Time) {
        let starts =
            head_arrives - Span::from_secs(self.random.between(STARTS_BEFORE_SECS[0], STARTS_BEFORE_SECS[1]));
        let bow_m = BOW_M * self.random.normal().clamp(-2.0, 2.0);
        let is_left = self.random.unit() < LEFT_SHARE;
        self.reach = Some(Reach { is_left, to: place.vector(), bow_m, starts, arrives, leaves: None });
    }

    /// The hand goes back to where it hangs.
    pub fn draw_back(&mut self, at: Time) {
        if let Some(reach) = &mut self.reach {
            reach.leaves = Some(at);
        }
    }

    /// Where the hands are; moments come in order.
    pub fn hands(&mut self, head: &Pose<Room>, at: Time) -> Hands {
        self.follow(head, at);
        let [left, right] = [true, false].map(|is_left| {
            let hangs = self.hangs(head, is_left, at);
            let reach = self.reach.filter(|reach| reach.is_left == is_left);
            Some(Point::from_vector(reach.map_or(hangs, |reach| reach.hand(hangs, head, at))))
        });
        Hands { left, right }
    }

    fn follow(&mut self, head: &Pose<Room>, at: Time) {
        let place = Planar::new(head.position.x(), head.position.y());
        let view = head.view();
        if let (Some(last_at), Some(last)) = (self.last_at, self.last_head) {
            let secs = (at - last_at).secs();
            if secs > 0.0 {
                let off = (view.y.atan2(view.x) - self.trunk_rad + PI).rem_euclid(TAU) - PI;
                self.trunk_rad += off * (1.0 - (-secs / TRUNK_FOLLOWS_SECS).exp());
                let mps = (place - last).norm() / secs;
                self.walks_mps += (mps - self.walks_mps) * (1.0 - (-secs / 0.3).exp());
            }
        } else {
            self.trunk_rad = view.y.atan2(view.x);
        }
        (self.last_at, self.last_head) = (Some(at), Some(place));
    }

    /// Where a hand is that nobody needs: at the side, swinging with the steps, the two in turn.
    fn hangs(&self, head: &Pose<Room>, is_left: bool, at: Time) -> Vector3<f64> {
        let side = if is_left { 1.0 } else { -1.0 };
        let swing_m =
            SWING_M * (self.walks_mps / SWINGS_IN_FULL_MPS).min(1.0) * (TAU * SWING_HZ * at.secs()).sin();
        let off = Planar::new(HANGS_AHEAD_M + side * swing_m, side * HANGS_ASIDE_M).turned(self.trunk_rad);
        head.position.vector() + Vector3::new(off.x, off.y, -HANGS_BELOW_M)
    }
}

impl Reach {
    fn hand(&self, hangs: Vector3<f64>, head: &Pose<Room>, at: Time) -> Vector3<f64> {
        let covered = |from: Time, to: Time| {
            let share = ((at - from).secs() / (to - from).secs()).clamp(0.0, 1.0);
            share.powi(3) * (10.0 + share * (6.0 * share - 15.0))
        };
        let out = covered(self.starts, self.arrives);
        let back =
            self.leaves.map_or(0.0, |leaves| covered(leaves, leaves + Span::from_secs(DRAWN_BACK_SECS)));
        // An arm is only so long: what is farther off is pointed at.
        let shoulder = head.position.vector() - Vector3::z() * SHOULDER_BELOW_M;
        let to = shoulder + (self.to - shoulder).cap_magnitude(ARM_M);
        let aside = (to - hangs).cross(&Vector3::z()).try_normalize(1e-6).unwrap_or_else(Vector3::zeros);
        let bow = 16.0 * (out * (1.0 - out)).powi(2);
        let going = hangs + (to - hangs) * out + aside * (self.bow_m * bow);
        going + (hangs - going) * back
    }
}

/// A hand sets out so long before the head has arrived, s.
const STARTS_BEFORE_SECS: [f64; 2] = [0.2, 0.5];
/// Deviation of the greatest bow of its path, m: a twentieth of its length.
const BOW_M: f64 = 0.02;
/// Who reaches with the left hand.
const LEFT_SHARE: f64 = 0.2;
/// The way back takes so long, s.
const DRAWN_BACK_SECS: f64 = 0.6;
/// An arm, shoulder to grip, m.
const ARM_M: f64 = 0.7;
/// The shoulders are so far below the eyes, m.
const SHOULDER_BELOW_M: f64 = 0.25;
/// Where a hand hangs that holds a controller, from the eyes, m.
const HANGS_BELOW_M: f64 = 0.65;
const HANGS_ASIDE_M: f64 = 0.22;
const HANGS_AHEAD_M: f64 = 0.12;
/// Amplitude of an arm's swing, m, from this speed on.
const SWING_M: f64 = 0.12;
const SWINGS_IN_FULL_MPS: f64 = 0.8;
/// Half the rate of the steps, Hz.
const SWING_HZ: f64 = 0.9;
/// The trunk follows the head within about this, s.
const TRUNK_FOLLOWS_SECS: f64 = 0.5;
