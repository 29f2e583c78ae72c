//! Whether a belief means what it says: of all moments at which the rule gave its most probable object a probability of
//! so much, in how many was that the goal?

use serde::Serialize;

use crate::replay::TrialOutcome;

/// The moments at which the greatest probability lay between two bounds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bin {
    /// From this probability on.
    pub from: f64,
    /// To below this one; the last bin includes it.
    pub to: f64,
    /// How many moments.
    pub cases: usize,
    /// Mean probability of the most probable object.
    pub probability: f64,
    /// Share in which it was the goal.
    pub share: f64,
}

/// Over every moment that the belief was looked at; bins without any are left out.
pub(super) fn reliability(outcomes: &[&TrialOutcome]) -> Vec<Bin> {
    let mut sums = [(0usize, 0.0, 0usize); BINS];
    for then in outcomes.iter().flat_map(|outcome| outcome.belief.at.iter().flatten()) {
        let bin = ((then.best_probability * BINS as f64) as usize).min(BINS - 1);
        let (cases, probability, right) = &mut sums[bin];
        *cases += 1;
        *probability += then.best_probability;
        *right += usize::from(then.goal_is_best);
    }
    let bin = |(number, (cases, probability, right)): (usize, (usize, f64, usize))| Bin {
        from: number as f64 / BINS as f64,
        to: (number + 1) as f64 / BINS as f64,
        cases,
        probability: probability / cases as f64,
        share: right as f64 / cases as f64,
    };
    sums.into_iter().enumerate().filter(|(_, (cases, ..))| *cases > 0).map(bin).collect()
}

/// The mean distance between probability and share, weighed by cases (expected calibration error, Naeini, Cooper and
/// Hauskrecht 2015); none without cases.
pub fn calibration_error(bins: &[Bin]) -> Option<f64> {
    let cases: usize = bins.iter().map(|bin| bin.cases).sum();
    let off = bins.iter().map(|bin| bin.cases as f64 * (bin.probability - bin.share).abs()).sum::<f64>();
    (cases > 0).then(|| off / cases as f64)
}

/// Tenths.
const BINS: usize = 10;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::replay::BeliefThen;

    fn outcome(looks: &[(f64, bool)]) -> TrialOutcome {
        let mut outcome = TrialOutcome::nowhere(1.0, 4.0);
        for (seen, (best_probability, goal_is_best)) in outcome.belief.at.iter_mut().zip(looks) {
            let goal_probability = if *goal_is_best { *best_probability } else { 0.0 };
            let (best_probability, goal_is_best) = (*best_probability, *goal_is_best);
            *seen = Some(BeliefThen {
                goal_probability,
                best_probability,
                goal_is_best,
                goal_is_best_of_wall: None,
            });
        }
        outcome
    }

    #[test]
    fn moments_are_counted_where_their_probability_says() {
        let (a, b) =
            (outcome(&[(0.92, true), (0.98, false), (1.0, true)]), outcome(&[(0.52, true), (0.96, true)]));
        let bins = reliability(&[&a, &b]);
        let seen: Vec<_> = bins.iter().map(|bin| (bin.from, bin.cases, bin.share)).collect();
        assert_eq!(seen, [(0.5, 1, 1.0), (0.9, 4, 0.75)]);
        assert!((bins[1].probability - 0.965).abs() < 1e-12);
        // One case 0.48 off, four 0.215 off.
        assert!((calibration_error(&bins).unwrap() - (0.48 + 4.0 * 0.215) / 5.0).abs() < 1e-12);
        assert_eq!(calibration_error(&reliability(&[])), None);
    }
}
