//! `nearest`: the object whose surface is nearest to the head, with the prior as a factor on closeness.

use super::{Belief, Rule, Sight, View};

/// The nearest surface alone.
#[derive(Debug, Clone, Copy)]
pub struct Nearest;

impl Rule for Nearest {
    fn boxed(&self) -> Box<dyn Rule> {
        Box::new(*self)
    }

    fn weigh(&mut self, view: &View<'_>, belief: &mut Belief) {
        belief.weights.clear();
        let weight = |s: &Sight| if s.enabled { s.prior / (1.0 + s.distance_m) } else { 0.0 };
        belief.weights.extend(view.sights.iter().map(weight));
        belief.commit_to_best();
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{sight, view};
    use super::*;

    #[test]
    fn the_nearest_enabled_object_with_a_prior_wins() {
        let off = Sight { enabled: false, ..sight(0.1, 0.0, 1.0) };
        let mut belief = Belief::default();
        Nearest.weigh(&view(0, &[sight(0.2, 0.0, 0.0), off, sight(1.0, 0.0, 1.0)]), &mut belief);
        assert_eq!(belief.committed, Some(2));
        assert_eq!(belief.shares, [0.0, 0.0, 1.0]);
    }
}
