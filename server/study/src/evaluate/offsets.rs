//! What the offered redirection offsets (`offset_m`) would have been worth to a client that follows them.

use std::collections::BTreeMap;

use crate::replay::{FORETOLD_BEFORE_REACH_SECS, TrialOutcome, WithOffset};

/// By seconds before the reach.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Offsets {
    /// Share of the trials in which one was offered.
    pub offered: BTreeMap<String, f64>,
    /// Share served.
    pub success: BTreeMap<String, f64>,
    /// Failed without, served with it.
    pub saved: BTreeMap<String, usize>,
    /// Mean distance at the reach where one was offered and served with it, m: without it.
    pub distance_without_m: BTreeMap<String, f64>,
    /// And with it.
    pub distance_with_m: BTreeMap<String, f64>,
}

impl Offsets {
    /// A moment at which nothing was foretold in any trial has no key.
    pub fn of(outcomes: &[&TrialOutcome]) -> Self {
        let mut found = Self::default();
        for (look, before_secs) in FORETOLD_BEFORE_REACH_SECS.iter().enumerate() {
            let seen = || outcomes.iter().filter_map(|outcome| Some((outcome, outcome.with_offset[look]?)));
            let trials = seen().count();
            if trials == 0 {
                continue;
            }
            let count = |is: &dyn Fn(&TrialOutcome, &WithOffset) -> bool| {
                seen().filter(|(outcome, with)| is(outcome, with)).count()
            };
            let share = |count: usize| count as f64 / trials as f64;
            let name = || format!("{before_secs:.1}");
            found.offered.insert(name(), share(count(&|_, with| with.offered)));
            found.success.insert(name(), share(count(&|_, with| with.success)));
            found.saved.insert(name(), count(&|outcome, with| with.success && !outcome.success));
            let nearer = || seen().filter(|(_, with)| with.offered && with.success);
            let reached = nearer().count();
            if reached > 0 {
                let without: f64 = nearer().map(|(outcome, _)| outcome.distance_at_reach_m).sum();
                let with: f64 = nearer().map(|(_, with)| with.distance_at_reach_m).sum();
                found.distance_without_m.insert(name(), without / reached as f64);
                found.distance_with_m.insert(name(), with / reached as f64);
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(distance_at_reach_m: f64, offset_m: f64) -> TrialOutcome {
        let left_m = distance_at_reach_m - offset_m;
        let with =
            WithOffset { offered: offset_m > 0.0, success: left_m <= 0.1, distance_at_reach_m: left_m };
        TrialOutcome {
            success: distance_at_reach_m <= 0.1,
            with_offset: [Some(with), None, None],
            ..TrialOutcome::nowhere(distance_at_reach_m, 1.0)
        }
    }

    #[test]
    fn what_is_saved_and_what_comes_nearer_is_counted_where_something_was_foretold() {
        let all = [outcome(0.12, 0.025), outcome(0.05, 0.025), outcome(0.0, 0.0), outcome(0.3, 0.0)];
        let found = Offsets::of(&all.each_ref());
        assert_eq!(found.offered.iter().collect::<Vec<_>>(), [(&"0.5".to_owned(), &0.5)]);
        assert_eq!((found.success["0.5"], found.saved["0.5"]), (0.75, 1));
        let (without, with) = (found.distance_without_m["0.5"], found.distance_with_m["0.5"]);
        assert!((without - 0.085).abs() < 1e-12 && (with - 0.06).abs() < 1e-12);
    }
}
