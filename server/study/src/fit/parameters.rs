//! Every parameter of the intention rules, in one table: fitting, files and documents come from it.

use std::ops::RangeInclusive;

use covr_engine::intention::{IntentionParameters, RuleName};

/// One parameter.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// `group.name`, as in a parameter file.
    pub name: &'static str,
    /// Its unit; empty for a plain number.
    pub unit: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// The least that makes sense.
    pub least: f64,
    /// The most that makes sense.
    pub most: f64,
    /// How it is searched.
    pub scale: Scale,
    /// The rules that use it.
    pub rules: &'static [RuleName],
    place: fn(&mut IntentionParameters) -> &mut f64,
}

/// How a range is walked through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// By equal differences.
    Linear,
    /// By equal ratios; the range is above 0.
    Ratio,
}

/// The table.
pub const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "paper.distance_share",
        unit: "",
        meaning: "w: the share of distance in a weight, the rest being that of direction.",
        least: 0.0,
        most: 1.0,
        scale: Scale::Linear,
        rules: PAPER,
        place: |p| &mut p.paper.distance_share,
    },
    Parameter {
        name: "paper.threshold",
        unit: "",
        meaning: "A weight above this is a commitment.",
        least: 0.5,
        most: 1.0,
        scale: Scale::Linear,
        rules: PAPER,
        place: |p| &mut p.paper.threshold,
    },
    Parameter {
        name: "bayes.gaze_rate_standing",
        unit: "1/(s rad)",
        meaning: "How much a second of looking tells, of somebody who stands.",
        least: 0.05,
        most: 50.0,
        scale: Scale::Ratio,
        rules: BAYES,
        place: |p| &mut p.bayes.gaze_rate_standing,
    },
    Parameter {
        name: "bayes.gaze_rate_walking",
        unit: "1/(s rad)",
        meaning: "How much a second of looking tells, of somebody who walks.",
        least: 0.05,
        most: 100.0,
        scale: Scale::Ratio,
        rules: BAYES,
        place: |p| &mut p.bayes.gaze_rate_walking,
    },
    Parameter {
        name: "bayes.gaze_cap_rad",
        unit: "rad",
        meaning: "A look farther off says no more.",
        least: 0.2,
        most: 3.2,
        scale: Scale::Ratio,
        rules: BAYES,
        place: |p| &mut p.bayes.gaze_cap_rad,
    },
    Parameter {
        name: "bayes.gaze_lead_secs",
        unit: "s",
        meaning: "The head is taken to where it turns in this time.",
        least: 0.0,
        most: 0.5,
        scale: Scale::Linear,
        rules: BAYES,
        place: |p| &mut p.bayes.gaze_lead_secs,
    },
    Parameter {
        name: "bayes.way_rate",
        unit: "1/(s rad)",
        meaning: "How much a second of walking tells.",
        least: 0.05,
        most: 100.0,
        scale: Scale::Ratio,
        rules: BAYES,
        place: |p| &mut p.bayes.way_rate,
    },
    Parameter {
        name: "bayes.way_cap_rad",
        unit: "rad",
        meaning: "A way farther off says no more.",
        least: 0.2,
        most: 3.2,
        scale: Scale::Ratio,
        rules: BAYES,
        place: |p| &mut p.bayes.way_cap_rad,
    },
    Parameter {
        name: "bayes.nearness_rate",
        unit: "1/(s m)",
        meaning: "How much a second of being near tells.",
        least: 0.0,
        most: 5.0,
        scale: Scale::Linear,
        rules: BAYES,
        place: |p| &mut p.bayes.nearness_rate,
    },
    Parameter {
        name: "bayes.now_secs",
        unit: "s",
        meaning: "For so long what was seen counts as just now.",
        least: 0.05,
        most: 2.0,
        scale: Scale::Ratio,
        rules: BAYES,
        place: |p| &mut p.bayes.now_secs,
    },
    Parameter {
        name: "bayes.now_heading_rate",
        unit: "1/(s rad)",
        meaning: "How much the heading of somebody who walks tells just now.",
        least: 0.0,
        most: 200.0,
        scale: Scale::Linear,
        rules: BAYES,
        place: |p| &mut p.bayes.now_heading_rate,
    },
    Parameter {
        name: "bayes.now_elevation_rate",
        unit: "1/(s rad)",
        meaning: "How much the elevation of their look tells just now.",
        least: 0.0,
        most: 200.0,
        scale: Scale::Linear,
        rules: BAYES,
        place: |p| &mut p.bayes.now_elevation_rate,
    },
    Parameter {
        name: "bayes.now_way_rate",
        unit: "1/(s rad)",
        meaning: "How much their way tells just now.",
        least: 0.0,
        most: 200.0,
        scale: Scale::Linear,
        rules: BAYES,
        place: |p| &mut p.bayes.now_way_rate,
    },
    Parameter {
        name: "bayes.hand_rate",
        unit: "1/m",
        meaning: "How much the way of a hand tells that goes out and comes no nearer.",
        least: 0.0,
        most: 200.0,
        scale: Scale::Linear,
        rules: BAYES,
        place: |p| &mut p.bayes.hand_rate,
    },
    Parameter {
        name: "bayes.hand_secs",
        unit: "s",
        meaning: "For so long what a hand did counts.",
        least: 0.05,
        most: 5.0,
        scale: Scale::Ratio,
        rules: BAYES,
        place: |p| &mut p.bayes.hand_secs,
    },
    Parameter {
        name: "bayes.hand_out_m",
        unit: "m",
        meaning: "Farther than this from the head axis a hand is held out.",
        least: 0.1,
        most: 0.6,
        scale: Scale::Linear,
        rules: BAYES,
        place: |p| &mut p.bayes.hand_out_m,
    },
    Parameter {
        name: "bayes.walking_mps",
        unit: "m/s",
        meaning: "From this speed on somebody walks in full.",
        least: 0.1,
        most: 1.5,
        scale: Scale::Ratio,
        rules: BAYES,
        place: |p| &mut p.bayes.walking_mps,
    },
    Parameter {
        name: "bayes.mind_secs",
        unit: "s",
        meaning: "For so long a mind is made up.",
        least: 0.5,
        most: 500.0,
        scale: Scale::Ratio,
        rules: BAYES,
        place: |p| &mut p.bayes.mind_secs,
    },
    Parameter {
        name: "bayes.none_prior",
        unit: "",
        meaning: "The prior of none of them, against 1 for all objects together.",
        least: 0.001,
        most: 1.0,
        scale: Scale::Ratio,
        rules: BAYES,
        place: |p| &mut p.bayes.none_prior,
    },
    Parameter {
        name: "bayes.none_angle_rad",
        unit: "rad",
        meaning: "None of them looks and walks this far off its goal.",
        least: 0.2,
        most: 3.0,
        scale: Scale::Ratio,
        rules: BAYES,
        place: |p| &mut p.bayes.none_angle_rad,
    },
];

/// The paper's rule in all its readings.
const PAPER: &[RuleName] =
    &[RuleName::Paper, RuleName::PaperLiteral, RuleName::PaperBest, RuleName::PaperHeld];

/// The Bayesian filter.
const BAYES: &[RuleName] = &[RuleName::Bayes];

/// The parameters that a rule uses.
pub fn of_rule(rule: RuleName) -> impl Iterator<Item = &'static Parameter> {
    PARAMETERS.iter().filter(move |parameter| parameter.rules.contains(&rule))
}

impl Parameter {
    /// The parameter of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.name == name)
    }

    /// Its value.
    pub fn get(&self, parameters: &IntentionParameters) -> f64 {
        *(self.place)(&mut parameters.clone())
    }

    /// Give it a value.
    pub fn set(&self, parameters: &mut IntentionParameters, value: f64) {
        *(self.place)(parameters) = value;
    }

    /// Its value by default.
    pub fn default(&self) -> f64 {
        self.get(&IntentionParameters::default())
    }

    /// What it may be.
    pub fn range(&self) -> RangeInclusive<f64> {
        self.least..=self.most
    }

    /// The value at a share of its range, 0 to 1.
    pub fn at_share(&self, share: f64) -> f64 {
        let value = match self.scale {
            Scale::Linear => self.least + (self.most - self.least) * share,
            Scale::Ratio => self.least * (self.most / self.least).powf(share),
        };
        value.clamp(self.least, self.most)
    }

    /// So many values from end to end, each with all parameters, the others as in `base`.
    pub fn swept(&self, base: &IntentionParameters, values: usize) -> Vec<(f64, IntentionParameters)> {
        let last = values.saturating_sub(1).max(1) as f64;
        let at = |index: usize| {
            let mut parameters = base.clone();
            let value = self.at_share(index as f64 / last);
            self.set(&mut parameters, value);
            (value, parameters)
        };
        (0..values).map(at).collect()
    }

    /// Where in its range a value lies, 0 to 1.
    pub fn share_of(&self, value: f64) -> f64 {
        let share = match self.scale {
            Scale::Linear => (value - self.least) / (self.most - self.least),
            Scale::Ratio => (value / self.least).ln() / (self.most / self.least).ln(),
        };
        share.clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_parameter_has_a_name_a_range_about_its_default_and_a_place_of_its_own() {
        let names: BTreeSet<_> = PARAMETERS.iter().map(|parameter| parameter.name).collect();
        assert_eq!(names.len(), PARAMETERS.len());
        for parameter in PARAMETERS {
            assert!(parameter.range().contains(&parameter.default()), "{}", parameter.name);
            assert!(parameter.scale == Scale::Linear || parameter.least > 0.0, "{}", parameter.name);
            let mut changed = IntentionParameters::default();
            let value = parameter.at_share(0.37);
            parameter.set(&mut changed, value);
            for other in PARAMETERS {
                let expected = if other.name == parameter.name { value } else { other.default() };
                assert_eq!(other.get(&changed), expected, "{} and {}", parameter.name, other.name);
            }
        }
    }

    #[test]
    fn shares_are_read_back_on_both_scales() {
        let linear = PARAMETERS[0];
        let ratio = Parameter { least: 0.01, most: 100.0, scale: Scale::Ratio, ..linear };
        assert!((ratio.at_share(0.5) - 1.0).abs() < 1e-12);
        for parameter in [linear, ratio] {
            for share in [0.0, 0.2, 0.5, 1.0] {
                assert!((parameter.share_of(parameter.at_share(share)) - share).abs() < 1e-12);
            }
        }
    }
}
