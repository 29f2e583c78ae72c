//! Jog: the column moved by hand, for as long as somebody holds the button (hold-to-run).
//!
//! An order is good for [`Parameters::hold_to_run`](crate::safety::parameters::Parameters) alone: who wants the column to go on gives it again, and a
//! page that hangs, a cable that is cut and a hand that lets go end it alike.

use crate::frames::{Floor, Planar};
use crate::machine::Travel;
use crate::motion::along_the_walls;

/// What is ordered, for a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JogOrder {
    /// Where to.
    pub aim: Aim,
    /// No faster than this, m/s; the engine may allow less.
    pub speed_mps: f64,
}

/// Where a jog leads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aim {
    /// On and on this way; its length says nothing.
    Along(Planar),
    /// To this place of the column's centre, and no farther.
    To(Floor),
}

impl JogOrder {
    /// The velocity wanted at `here`, no faster than `cap_mps`, m/s.
    pub fn velocity(&self, here: Floor, inside: &Travel, cap_mps: f64) -> Planar {
        let cap_mps = cap_mps.min(self.speed_mps);
        match self.aim {
            Aim::Along(way) => {
                let along = way.unit().map_or(Planar::ZERO, |unit| unit * cap_mps);
                along_the_walls(along, here, inside)
            }
            Aim::To(place) => ((place - here) * NEARING_PER_SEC).capped(cap_mps),
        }
    }
}

/// A metre from its place leaves this much speed towards it, 1/s.
const NEARING_PER_SEC: f64 = 2.5;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const INSIDE: Travel = Travel { min: Floor::new(0.02, 0.02), max: Floor::new(3.98, 2.98) };

    proptest! {
        /// Never faster than ordered or allowed, and at a place without motion.
        #[test]
        fn a_jog_is_no_faster_than_ordered_and_allowed(
            (ax, ay) in (-9.0..9.0f64, -9.0..9.0f64),
            (x, y) in (0.02..3.98f64, 0.02..2.98f64),
            (ordered, cap) in (0.01..2.0f64, 0.01..2.0f64),
            to_a_place in any::<bool>(),
        ) {
            let aim = if to_a_place { Aim::To(INSIDE.clamped(Floor::new(ax, ay))) } else { Aim::Along(Planar::new(ax, ay)) };
            let order = JogOrder { aim, speed_mps: ordered };
            let here = Floor::new(x, y);
            let velocity = order.velocity(here, &INSIDE, cap);
            prop_assert!(velocity.norm() <= ordered.min(cap) + 1e-12);
            if let Aim::To(place) = aim {
                prop_assert_eq!(order.velocity(place, &INSIDE, cap), Planar::ZERO);
                prop_assert!(velocity.dot(place - here) >= 0.0);
            }
        }
    }

    #[test]
    fn a_way_without_length_is_none() {
        let order = JogOrder { aim: Aim::Along(Planar::ZERO), speed_mps: 0.2 };
        assert_eq!(order.velocity(Floor::new(1.0, 1.0), &INSIDE, 1.0), Planar::ZERO);
    }
}
