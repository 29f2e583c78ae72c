//! The paper's rule (CoVR, UIST 2020, eq. 1 to 4) in the four readings that its text leaves open.
//!
//! `W_i = w D(d) + (1 - w) O(theta)`, `D = 1 / (1 + d)`, `O = exp(cos(theta) - 1)`, then `W_i` times the prior `P_i`.
//! Its footnote rounds `W_i > 0.8` to 1. The test is made on the unmultiplied W; the prior comes afterwards.

use super::{Belief, Rule, Sight, View};

/// What happens once some W exceeds the threshold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Commitment {
    /// `paper`: the mean over those alone.
    Mean,
    /// `paper-literal`: those count 1, the others keep their weights.
    Literal,
    /// `paper-best`: the largest alone.
    Best,
    /// `paper-held`: the largest alone, until its own W falls to the threshold.
    Held,
}

/// The numbers of the paper's rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperParameters {
    /// w: the share of distance in a weight, the rest being that of direction.
    pub distance_share: f64,
    /// A weight above this is a commitment.
    pub threshold: f64,
}

impl Default for PaperParameters {
    /// The optimum that the paper reports, and its footnote's threshold.
    fn default() -> Self {
        Self { distance_share: 0.175, threshold: 0.8 }
    }
}

/// The paper's rule for one visitor.
#[derive(Debug, Clone)]
pub struct Paper {
    commitment: Commitment,
    parameters: PaperParameters,
    held: Option<usize>,
    unmultiplied: Vec<f64>,
}

impl Paper {
    /// Nothing seen yet.
    pub const fn new(commitment: Commitment, parameters: PaperParameters) -> Self {
        Self { commitment, parameters, held: None, unmultiplied: Vec::new() }
    }

    /// The object that stands alone, in the readings where one does.
    fn alone(&mut self, sights: &[Sight], belief: &Belief) -> Option<usize> {
        let threshold = self.parameters.threshold;
        let candidate = |i: &usize| self.unmultiplied[*i] > threshold && sights[*i].prior > 0.0;
        if self.commitment == Commitment::Held
            && let Some(held) = self.held.filter(|i| *i < sights.len()).filter(candidate)
        {
            return Some(held);
        }
        // Among equals the first of the scene.
        let best = (0..sights.len())
            .rev()
            .filter(candidate)
            .max_by(|a, b| belief.weights[*a].total_cmp(&belief.weights[*b]));
        self.held = best;
        best
    }
}

impl Rule for Paper {
    fn boxed(&self) -> Box<dyn Rule> {
        Box::new(self.clone())
    }

    fn weigh(&mut self, view: &View<'_>, belief: &mut Belief) {
        let sights = view.sights;
        let PaperParameters { distance_share, threshold } = self.parameters;
        let unmultiplied = |s: &Sight| {
            if s.enabled { weight(distance_share, s.distance_m, s.angle_rad) } else { 0.0 }
        };
        self.unmultiplied.clear();
        self.unmultiplied.extend(sights.iter().map(unmultiplied));
        belief.weights.clear();
        belief.weights.extend(self.unmultiplied.iter().zip(sights).map(|(w, s)| w * s.prior));
        let over = |i: usize| self.unmultiplied[i] > threshold && sights[i].prior > 0.0;
        let any_over = (0..sights.len()).any(over);
        let count = sights.len();
        match self.commitment {
            Commitment::Mean if any_over => {
                belief.share_by(count, |i| if over(i) { sights[i].prior } else { 0.0 });
                let mut candidates = (0..count).filter(|i| over(*i));
                belief.committed = candidates.next().filter(|_| candidates.next().is_none());
            }
            Commitment::Literal => {
                let mut candidates = (0..count).filter(|i| over(*i));
                belief.committed = candidates.next().filter(|_| candidates.next().is_none());
                let weights = std::mem::take(&mut belief.weights);
                belief.share_by(count, |i| if over(i) { sights[i].prior } else { weights[i] });
                belief.weights = weights;
            }
            Commitment::Best | Commitment::Held if any_over => {
                belief.committed = self.alone(sights, belief);
                let alone = belief.committed;
                belief.share_by(count, |i| if alone == Some(i) { 1.0 } else { 0.0 });
            }
            Commitment::Mean | Commitment::Best | Commitment::Held => {
                self.held = None;
                belief.committed = None;
                let weights = std::mem::take(&mut belief.weights);
                belief.share_by(count, |i| weights[i]);
                belief.weights = weights;
            }
        }
    }
}

/// Eq. 2 to 4 without the prior.
fn weight(distance_share: f64, distance_m: f64, angle_rad: f64) -> f64 {
    distance_share / (1.0 + distance_m) + (1.0 - distance_share) * (angle_rad.cos() - 1.0).exp()
}

#[cfg(test)]
mod tests {
    use super::super::tests::{sight, view};
    use super::*;

    fn weighed(commitment: Commitment, sights: &[Sight]) -> Belief {
        let mut belief = Belief::default();
        Paper::new(commitment, PaperParameters::default()).weigh(&view(0, sights), &mut belief);
        belief
    }

    #[test]
    fn the_weight_is_the_papers() {
        // Looking at it from 1 m: 0.175 / 2 + 0.825; with the back to it: 0.0875 + 0.825 e^-2.
        assert!((weight(0.175, 1.0, 0.0) - 0.9125).abs() < 1e-12);
        assert!(
            (weight(0.175, 1.0, std::f64::consts::PI) - (0.0875 + 0.825 * (-2.0_f64).exp())).abs() < 1e-12
        );
    }

    #[test]
    fn to_the_letter_the_others_always_pull() {
        let belief = weighed(Commitment::Literal, &[sight(0.3, 0.0, 1.0), sight(3.0, 180.0, 1.0)]);
        assert_eq!(belief.committed, Some(0));
        assert!(belief.shares[1] > 0.1, "the published centroid cannot sit on its target");
    }

    #[test]
    fn the_mean_is_over_the_committed_alone() {
        let sights = [sight(0.5, 0.0, 1.0), sight(0.5, 10.0, 1.0), sight(0.5, 120.0, 1.0)];
        let belief = weighed(Commitment::Mean, &sights);
        assert_eq!(belief.shares, [0.5, 0.5, 0.0]);
        assert_eq!(belief.committed, None, "between two neighbours it is committed to neither");
        assert_eq!(weighed(Commitment::Best, &sights).shares, [1.0, 0.0, 0.0]);
    }

    #[test]
    fn held_keeps_its_object_until_its_weight_falls_to_the_threshold() {
        let mut rule = Paper::new(Commitment::Held, PaperParameters::default());
        let mut belief = Belief::default();
        rule.weigh(&view(0, &[sight(0.5, 0.0, 1.0), sight(0.5, 15.0, 1.0)]), &mut belief);
        rule.weigh(&view(0, &[sight(0.5, 15.0, 1.0), sight(0.5, 0.0, 1.0)]), &mut belief);
        assert_eq!(belief.committed, Some(0));
        rule.weigh(&view(0, &[sight(0.5, 60.0, 1.0), sight(0.5, 0.0, 1.0)]), &mut belief);
        assert_eq!(belief.committed, Some(1));
    }

    #[test]
    fn the_threshold_is_on_the_unmultiplied_weight() {
        let belief = weighed(Commitment::Mean, &[sight(0.5, 0.0, 0.1), sight(0.5, 150.0, 1.0)]);
        assert_eq!(belief.committed, Some(0));
        assert!(belief.weights[0] < 0.1, "what is shown has the prior in it");
    }

    #[test]
    fn an_object_with_no_prior_takes_no_share() {
        for commitment in [Commitment::Mean, Commitment::Literal, Commitment::Best, Commitment::Held] {
            let belief = weighed(commitment, &[sight(0.1, 0.0, 0.0), sight(3.0, 150.0, 1.0)]);
            assert_eq!(belief.shares, [0.0, 1.0], "{commitment:?}");
        }
    }

    #[test]
    fn when_no_object_has_a_prior_there_is_nowhere_to_go() {
        assert_eq!(weighed(Commitment::Best, &[sight(0.1, 0.0, 0.0)]).shares, [0.0]);
    }
}
