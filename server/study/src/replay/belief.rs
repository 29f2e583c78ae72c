//! What the intention rule believed in the course of a reach, held against the goal that was really reached.

use covr_engine::intention::Belief;
use covr_engine::time::{Span, Time};

/// How long before the reach the belief is looked at, s.
pub const LOOKS_BEFORE_REACH_SECS: [f64; 5] = [0.0, 0.5, 1.0, 2.0, 3.0];

/// The belief at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeliefThen {
    /// The probability given to the goal.
    pub goal_probability: f64,
    /// The greatest probability given to any object; 0 without a belief.
    pub best_probability: f64,
    /// The goal has the greatest.
    pub goal_is_best: bool,
    /// The goal has the greatest among the targets of its own wall; none where there are no walls.
    pub goal_is_best_of_wall: Option<bool>,
}

/// What the rule believed before a reach.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BeliefTold {
    /// From when the goal became the most probable object, and stayed so, to the reach, s; none if it was not then.
    pub detected_before_reach_secs: Option<f64>,
    /// At [`LOOKS_BEFORE_REACH_SECS`]; none before the beginning.
    pub at: [Option<BeliefThen>; LOOKS_BEFORE_REACH_SECS.len()],
}

/// Watches a belief until the reach.
#[derive(Debug)]
pub(super) struct BeliefWatch {
    goal: usize,
    same_wall: Option<Vec<bool>>,
    reach: Time,
    best_since: Option<Time>,
    told: BeliefTold,
}

impl BeliefWatch {
    /// `goal` and `same_wall` count as the engine's objects do.
    pub fn new(goal: usize, same_wall: Option<Vec<bool>>, reach: Time) -> Self {
        Self { goal, same_wall, reach, best_since: None, told: BeliefTold::default() }
    }

    /// The belief at a moment of the recording; moments come in order.
    pub fn look(&mut self, at: Time, belief: Option<&Belief>) {
        let weights = belief.map_or(&[][..], |belief| &belief.weights);
        let then = self.then(weights);
        self.best_since = if then.goal_is_best { self.best_since.or(Some(at)) } else { None };
        for (seen, before_secs) in self.told.at.iter_mut().zip(LOOKS_BEFORE_REACH_SECS) {
            if at <= self.reach - Span::from_secs(before_secs) {
                *seen = Some(then);
            }
        }
    }

    /// What was seen.
    pub fn told(mut self) -> BeliefTold {
        self.told.detected_before_reach_secs = self.best_since.map(|since| (self.reach - since).secs());
        self.told
    }

    fn then(&self, weights: &[f64]) -> BeliefThen {
        let total: f64 = weights.iter().sum();
        let of_goal = weights.get(self.goal).copied().unwrap_or(0.0);
        let greatest = weights.iter().copied().fold(0.0, f64::max);
        let leads = |among: &dyn Fn(usize) -> bool| {
            of_goal > 0.0
                && weights.iter().enumerate().all(|(i, w)| i == self.goal || !among(i) || *w < of_goal)
        };
        BeliefThen {
            goal_probability: if total > 0.0 { of_goal / total } else { 0.0 },
            best_probability: if total > 0.0 { greatest / total } else { 0.0 },
            goal_is_best: leads(&|_| true),
            goal_is_best_of_wall: self.same_wall.as_ref().map(|same_wall| leads(&|i| same_wall[i])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn belief(weights: &[f64]) -> Belief {
        Belief { weights: weights.to_vec(), ..Belief::default() }
    }

    #[test]
    fn detection_counts_from_the_last_change_to_the_goal() {
        let at = |secs: f64| Time::ZERO + Span::from_secs(secs);
        let mut watch = BeliefWatch::new(1, Some(vec![false, true, true]), at(4.0));
        watch.look(at(0.5), Some(&belief(&[0.1, 0.5, 0.2])));
        watch.look(at(2.0), Some(&belief(&[0.6, 0.3, 0.1])));
        watch.look(at(3.2), Some(&belief(&[0.1, 0.8, 0.1])));
        watch.look(at(4.0), Some(&belief(&[0.1, 0.9, 0.0])));
        let told = watch.told();
        assert!((told.detected_before_reach_secs.unwrap() - 0.8).abs() < 1e-9);
        assert_eq!(told.at[0].unwrap().goal_probability, 0.9);
        let two_before = told.at[3].unwrap();
        assert!(!two_before.goal_is_best && two_before.goal_is_best_of_wall == Some(true));
        let three_before = told.at[4].unwrap();
        assert_eq!((three_before.goal_probability, three_before.best_probability), (0.625, 0.625));
        assert_eq!(two_before.best_probability, 0.6 / (0.6 + 0.3 + 0.1));
    }

    #[test]
    fn without_a_belief_nothing_is_detected() {
        let mut watch = BeliefWatch::new(0, None, Time::ZERO);
        watch.look(Time::ZERO, None);
        watch.look(Time::ZERO, Some(&belief(&[0.0, 0.0])));
        let told = watch.told();
        assert_eq!(told.detected_before_reach_secs, None);
        assert_eq!(told.at[0].unwrap().goal_probability, 0.0);
    }
}
