//! `constant-velocity`: the object nearest to where the head will be if it goes on as it does. The baseline that any
//! prediction of walking people has to beat (Schöller et al., "What the Constant Velocity Model Can Teach Us About
//! Pedestrian Motion Prediction", 2020).

use super::{Belief, Rule, Sight, View};

/// The nearest to the extrapolated head alone.
#[derive(Debug, Clone, Copy)]
pub struct ConstantVelocity;

impl Rule for ConstantVelocity {
    fn boxed(&self) -> Box<dyn Rule> {
        Box::new(*self)
    }

    fn weigh(&mut self, view: &View<'_>, belief: &mut Belief) {
        let ahead = view.velocity * HORIZON_SECS;
        belief.weights.clear();
        let weight = |s: &Sight| if s.enabled { s.prior / (1.0 + (s.offset - ahead).norm()) } else { 0.0 };
        belief.weights.extend(view.sights.iter().map(weight));
        belief.commit_to_best();
    }
}

/// As far ahead as a recorded reach has its second half, s.
const HORIZON_SECS: f64 = 1.0;

#[cfg(test)]
mod tests {
    use super::super::tests::{sight, view};
    use super::*;

    #[test]
    fn where_the_head_is_going_wins_over_what_is_near() {
        let mut belief = Belief::default();
        ConstantVelocity.weigh(&view(0, &[sight(0.5, 180.0, 1.0), sight(1.2, 0.0, 1.0)]), &mut belief);
        assert_eq!(belief.committed, Some(1));
    }
}
