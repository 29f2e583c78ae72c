//! `gaze`: the object at the smallest angle from the view axis, with the prior as a factor on the paper's `O(theta)`.

use super::{Belief, Rule, Sight, View};

/// The smallest angle alone.
#[derive(Debug, Clone, Copy)]
pub struct Gaze;

impl Rule for Gaze {
    fn boxed(&self) -> Box<dyn Rule> {
        Box::new(*self)
    }

    fn weigh(&mut self, view: &View<'_>, belief: &mut Belief) {
        belief.weights.clear();
        let weight = |s: &Sight| if s.enabled { s.prior * (s.angle_rad.cos() - 1.0).exp() } else { 0.0 };
        belief.weights.extend(view.sights.iter().map(weight));
        belief.commit_to_best();
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{sight, view};
    use super::*;

    #[test]
    fn what_is_looked_at_wins_over_what_is_near() {
        let mut belief = Belief::default();
        Gaze.weigh(&view(0, &[sight(0.2, 40.0, 1.0), sight(3.0, 5.0, 1.0)]), &mut belief);
        assert_eq!(belief.committed, Some(1));
    }
}
