//! `nearest`: the object whose surface is nearest to the head, with the prior as a factor on closeness.

use super::{Belief, Rule, Sight};

/// The nearest surface alone.
#[derive(Debug, Clone, Copy)]
pub struct Nearest;

impl Rule for Nearest {
    fn boxed(&self) -> Box<dyn Rule> {
        Box::new(*self)
    }

    fn weigh(&mut self, sights: &[Sight], belief: &mut Belief) {
        belief.weights.clear();
        let weight = |s: &Sight| if s.enabled { s.prior / (1.0 + s.distance_m) } else { 0.0 };
        belief.weights.extend(sights.iter().map(weight));
        let best = (0..sights.len()).rev().max_by(|a, b| belief.weights[*a].total_cmp(&belief.weights[*b]));
        belief.committed = best.filter(|i| belief.weights[*i] > 0.0);
        let committed = belief.committed;
        belief.share_by(sights.len(), |i| if committed == Some(i) { 1.0 } else { 0.0 });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_enabled_object_with_a_prior_wins() {
        let sight = |distance_m, prior, enabled| Sight { distance_m, angle_rad: 0.0, prior, enabled };
        let mut belief = Belief::default();
        Nearest.weigh(&[sight(0.2, 0.0, true), sight(0.1, 1.0, false), sight(1.0, 1.0, true)], &mut belief);
        assert_eq!(belief.committed, Some(2));
        assert_eq!(belief.shares, [0.0, 0.0, 1.0]);
    }
}
