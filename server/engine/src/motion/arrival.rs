//! In time or late: what an arrival and a touch that are foreseen are worth.

use crate::frames::{Floor, Planar};
use crate::machine::Limits;

/// The probability that the column is in place before the hand, by when both are foreseen, s from now.
///
/// The error of (arrival - touch) is taken to be logistic about [`LATER_SECS`], with a scale that grows with the time
/// until the touch. 1 where the column is in place already.
pub fn in_time_probability(arrival_secs: f64, touch_secs: f64) -> f64 {
    if arrival_secs <= 0.0 {
        return 1.0;
    }
    let scale_secs = SCALE_SECS + SCALE_GROWTH * touch_secs.max(0.0);
    1.0 / (1.0 + ((arrival_secs - touch_secs + LATER_SECS) / scale_secs).exp())
}

/// Where the column will be when the hand comes: where it comes to rest, or so far short of it as it still brakes for that
/// long. `late_by_secs` is from the touch to the column's rest.
pub fn at_touch(here: Floor, rests_at: Floor, late_by_secs: f64, limits: &Limits) -> Floor {
    let braking_mps2 = limits.x.braking_mps2.min(limits.y.braking_mps2);
    let late_secs = late_by_secs.max(0.0);
    let short_m = 0.5 * braking_mps2 * late_secs * late_secs;
    rests_at + (here - rests_at).capped(short_m)
}

/// The shift of a virtual object, m, that brings it to a prop which is so far off its place, clipped to the published
/// detection threshold; none where none is needed, and where the prop would not serve the shifted object either: one serves from so
/// near (`serves_within_m`).
pub fn redirection(off: Planar, serves_within_m: f64) -> Option<Planar> {
    (NEEDED_M..=serves_within_m + UNNOTICED_M).contains(&off.norm()).then(|| off.capped(UNNOTICED_M))
}

/// Less is within what the machine and the tracking get wrong, m.
const NEEDED_M: f64 = 0.01;
/// A virtual hand is led aside from the real one by up to this below the detection threshold, m: Zenner and Krueger, Estimating
/// Detection Thresholds for Desktop-Scale Hand Redirection in Virtual Reality (IEEE VR 2019): 4.5 degrees across and gains of
/// 0.88 to 1.07 along reaches of 0.4 m, so 3.1 cm across, and along 5.5 cm farther or 2.5 cm (6.18 %) less far. The least of
/// them, for every direction; they found it with a hand that is looked at, the strictest case.
const UNNOTICED_M: f64 = 0.025;
/// Of recorded reaches (jov2023_reach, people 10, 12, 14, 16 and 18, every task, three objects, on the simulated machine,
/// by the default rule and told the goal), at 0.5, 1 and 2 s before the reach with the column not yet in place: greatest
/// likelihood of its being in place at the reach, 778 looks. It comes so much later than foreseen: it must be at rest,
/// and the rule may not mean the object yet. s.
const LATER_SECS: f64 = 0.25;
/// The scale of the error at the touch, s, and what a second until the touch adds, s: most of it is when the hand comes.
const SCALE_SECS: f64 = 0.15;
const SCALE_GROWTH: f64 = 0.4;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn it_is_a_probability_and_falls_with_lateness(
            arrival in 0.0..20.0f64, touch in 0.0..20.0f64, later in 0.0..5.0f64,
        ) {
            let probability = in_time_probability(arrival, touch);
            prop_assert!((0.0..=1.0).contains(&probability), "{}", probability);
            prop_assert!(in_time_probability(arrival + later, touch) <= probability);
            prop_assert!(in_time_probability(arrival, touch + later) >= probability);
        }

        #[test]
        fn what_is_in_place_is_in_time(touch in 0.0..20.0f64) {
            prop_assert_eq!(in_time_probability(0.0, touch), 1.0);
        }

        #[test]
        fn an_offset_points_at_the_prop_and_keeps_to_the_threshold(x in -0.2..0.2f64, y in -0.2..0.2f64) {
            let off = Planar::new(x, y);
            if let Some(offset) = redirection(off, 0.1) {
                prop_assert!(offset.norm() <= UNNOTICED_M + 1e-12 && offset.norm() <= off.norm() + 1e-12);
                prop_assert!(offset.dot(off) > 0.0 && (off - offset).norm() < off.norm());
                prop_assert!((off - offset).norm() <= 0.1 + 1e-12, "what is shifted is served: {:?}", off);
            } else {
                prop_assert!(off.norm() < NEEDED_M || off.norm() > 0.1 + UNNOTICED_M, "{:?}", off);
            }
        }

        /// Between where it is and where it comes to rest, the farther from there the later it is.
        #[test]
        fn at_the_touch_it_is_on_its_way(
            x in 0.0..4.0f64, y in 0.0..4.0f64, late in -1.0..2.0f64, later in 0.0..1.0f64,
        ) {
            let (here, rests_at) = (Floor::new(x, y), Floor::new(2.0, 2.0));
            let then = at_touch(here, rests_at, late, &Limits::PAPER);
            let whole = here.distance_m(rests_at);
            prop_assert!((then.distance_m(here) + then.distance_m(rests_at) - whole).abs() < 1e-9);
            let of_later = at_touch(here, rests_at, late + later, &Limits::PAPER);
            prop_assert!(of_later.distance_m(rests_at) >= then.distance_m(rests_at) - 1e-12);
            if late <= 0.0 {
                prop_assert_eq!(then, rests_at);
            }
        }

        /// The farther ahead, the less is said by the same lateness.
        #[test]
        fn it_is_less_sure_farther_ahead(touch in 0.0..10.0f64, ahead in 0.1..5.0f64, late in 0.0..3.0f64) {
            let [near, far] = [touch, touch + ahead].map(|touch| in_time_probability(touch + late + 0.01, touch));
            prop_assert!(near < far && far < 0.5, "{} {}", near, far);
        }
    }

    #[test]
    fn a_second_to_spare_is_worth_more_than_a_second_too_late() {
        assert!(in_time_probability(0.5, 1.5) > 0.7);
        assert!(in_time_probability(2.5, 1.5) < 0.2);
    }
}
