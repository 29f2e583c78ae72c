//! What is evaluated: rules, numbers of objects, priors, people.

use covr_engine::intention::RuleName;

use super::draw::Draw;

/// A rule of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RuleChoice {
    /// One of the engine's.
    Rule(RuleName),
    /// The goal is known from the first pose: the ceiling of route and timing.
    Told,
}

/// How many objects are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Objects {
    /// The goal and so many less one.
    Count(usize),
    /// Every target of the recording.
    All,
}

/// What the scenario says beforehand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Prior {
    /// Nothing: all alike.
    None,
    /// 0.75 on the goal, the rest sharing 0.25, as in the paper.
    Right,
    /// 0.75 on the first distractor.
    Wrong,
}

/// The machine that is driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MachineKind {
    /// The simulated machine that the server runs.
    Simulated,
    /// One that follows at its limits without error: quick.
    Ideal,
}

/// Everything that is evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The rules.
    pub rules: Vec<RuleChoice>,
    /// The numbers of objects.
    pub objects: Vec<Objects>,
    /// The priors.
    pub priors: Vec<Prior>,
    /// Tasks by name; empty: every one.
    pub tasks: Vec<String>,
    /// People by name; empty: every one.
    pub people: Vec<String>,
    /// How distractors are drawn.
    pub draw: Draw,
    /// v_h of the separation rule, m/s.
    pub v_h_mps: f64,
    /// The machine.
    pub machine: MachineKind,
    /// The rule that the server uses when nothing is configured.
    pub default_rule: RuleName,
    /// Threads; 0: as many as there are cores.
    pub threads: usize,
}

/// A word of the plan that means nothing.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what}: found `{found}`, expected one of {expected}")]
pub struct PlanProblem {
    /// Of what.
    pub what: &'static str,
    /// What was said.
    pub found: String,
    /// What could have been.
    pub expected: String,
}

impl RuleChoice {
    /// Every rule.
    pub fn all() -> Vec<Self> {
        RuleName::ALL.into_iter().map(Self::Rule).chain([Self::Told]).collect()
    }

    /// Its name on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rule(rule) => rule.name(),
            Self::Told => "told",
        }
    }

    /// The rule of this name.
    pub fn parse(name: &str) -> Result<Self, PlanProblem> {
        named("rule", name, &Self::all(), Self::name)
    }

    /// The engine's rule. Told, every other prior is nothing, so that any rule has but one choice.
    pub const fn engine_rule(self) -> RuleName {
        match self {
            Self::Rule(rule) => rule,
            Self::Told => RuleName::PaperBest,
        }
    }
}

impl Objects {
    /// Its name on the command line.
    pub fn parse(text: &str) -> Result<Self, PlanProblem> {
        let problem = || PlanProblem {
            what: "objects",
            found: text.into(),
            expected: "a number from 1 to 1000, or `all`".into(),
        };
        if text == "all" {
            return Ok(Self::All);
        }
        text.parse().ok().filter(|count| (1..=1000).contains(count)).map(Self::Count).ok_or_else(problem)
    }

    /// Of so many targets.
    pub fn of(self, targets: usize) -> usize {
        match self {
            Self::Count(count) => count,
            Self::All => targets,
        }
    }
}

impl Prior {
    /// Every kind.
    pub const ALL: [Self; 3] = [Self::None, Self::Right, Self::Wrong];

    /// Its name on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Right => "right",
            Self::Wrong => "wrong",
        }
    }

    /// The kind of this name.
    pub fn parse(name: &str) -> Result<Self, PlanProblem> {
        named("prior", name, &Self::ALL, Self::name)
    }
}

impl Draw {
    /// The draw of this name.
    pub fn parse(name: &str) -> Result<Self, PlanProblem> {
        named("draw", name, &[Self::Hash, Self::SameWall], Self::name)
    }
}

impl MachineKind {
    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Simulated => "simulated",
            Self::Ideal => "ideal",
        }
    }

    /// The machine of this name.
    pub fn parse(name: &str) -> Result<Self, PlanProblem> {
        named("machine", name, &[Self::Simulated, Self::Ideal], Self::name)
    }
}

fn named<T: Copy>(
    what: &'static str,
    found: &str,
    all: &[T],
    name: impl Fn(T) -> &'static str,
) -> Result<T, PlanProblem> {
    all.iter().copied().find(|one| name(*one) == found).ok_or_else(|| PlanProblem {
        what,
        found: found.into(),
        expected: all.iter().map(|one| name(*one)).collect::<Vec<_>>().join(", "),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_read_back_and_others_are_refused_with_the_names() {
        for rule in RuleChoice::all() {
            assert_eq!(RuleChoice::parse(rule.name()), Ok(rule));
        }
        let refused = RuleChoice::parse("papper").unwrap_err().to_string();
        assert!(refused.starts_with("rule: found `papper`") && refused.contains("told"), "{refused}");
        assert_eq!(Objects::parse("all"), Ok(Objects::All));
        assert!(Objects::parse("0").is_err() && Objects::parse("x").is_err());
    }
}
