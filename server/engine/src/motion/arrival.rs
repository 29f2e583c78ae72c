//! In time or late: what an arrival and a touch that are foreseen are worth.

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
