//! What is evaluated: rules, numbers of objects, priors, people.

use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::machine::{AxisLimits, Limits};
use covr_engine::motion::MotionName;
use covr_engine::safety::separation::{KeptFrom, WhollySimulated};
use covr_engine::time::Span;

use super::draw::Draw;
use crate::replay::{LinkProfile, TrackingNoise};

/// A rule of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RuleChoice {
    /// One of the engine's.
    Rule(RuleName),
    /// The goal is known from the first pose: the ceiling of route and timing.
    Told,
    /// Goal and walk are known from the first pose, and no engine decides: the physical limit ([`crate::bound`]). A
    /// search a reach, so slow; for those who ask for it by name.
    Bound,
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

/// Whether the separation rule is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SeparationChoice {
    /// As the server always keeps it.
    On,
    /// From nobody: to see what it costs.
    Off,
}

/// What makes a laboratory's day harder than the recording was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    /// Added to the way of every pose.
    pub latency: Span,
    /// Share of poses that never arrive.
    pub loss: f64,
    /// What tracking gets wrong.
    pub noise: TrackingNoise,
    /// The machine's accelerations, braking included, as a share of the paper's.
    pub acceleration_share: f64,
    /// Hands are not sent where the recording has them.
    pub without_hands: bool,
}

/// Everything that is evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The rules.
    pub rules: Vec<RuleChoice>,
    /// The motions; empty: the default one, and every one for the paper's rules.
    pub motions: Vec<MotionName>,
    /// With the separation rule, without it.
    pub separations: Vec<SeparationChoice>,
    /// The numbers of objects.
    pub objects: Vec<Objects>,
    /// The priors.
    pub priors: Vec<Prior>,
    /// Tasks by name; empty: every one.
    pub tasks: Vec<String>,
    /// People by name; empty: every one.
    pub people: Vec<String>,
    /// How distractors are drawn.
    pub draws: Vec<Draw>,
    /// v_h of the separation rule, m/s.
    pub v_h_mps: f64,
    /// The machine.
    pub machine: MachineKind,
    /// What is harder than it was.
    pub conditions: Conditions,
    /// The numbers of the intention rules.
    pub intention: IntentionParameters,
    /// The rule that the server uses when nothing is configured.
    pub default_rule: RuleName,
    /// And the motion.
    pub default_motion: MotionName,
    /// Find the cause of every failed trial.
    pub blames: bool,
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

impl Plan {
    /// Every rule with the numbers of objects 1 to 5 and all, no prior, the rule on, on the simulated machine.
    pub fn new(default_rule: RuleName, default_motion: MotionName) -> Self {
        Self {
            rules: RuleChoice::all(),
            motions: Vec::new(),
            separations: vec![SeparationChoice::On],
            objects: (1..=5).map(Objects::Count).chain([Objects::All]).collect(),
            priors: vec![Prior::None],
            tasks: Vec::new(),
            people: Vec::new(),
            draws: vec![Draw::Hash],
            v_h_mps: 1.6,
            machine: MachineKind::Simulated,
            conditions: Conditions::AS_RECORDED,
            intention: IntentionParameters::default(),
            default_rule,
            default_motion,
            blames: false,
            threads: 0,
        }
    }

    /// The motions that a rule is tried with.
    pub(super) fn motions_of(&self, rule: RuleChoice) -> Vec<MotionName> {
        if rule == RuleChoice::Bound {
            // It is over all motions.
            vec![self.default_motion]
        } else if !self.motions.is_empty() {
            self.motions.clone()
        } else if rule.is_of_the_paper() {
            MotionName::ALL.to_vec()
        } else {
            vec![self.default_motion]
        }
    }
}

impl Conditions {
    /// Nothing is harder.
    pub const AS_RECORDED: Self = Self {
        latency: Span::ZERO,
        loss: 0.0,
        noise: TrackingNoise { position_m: 0.0, rotation_rad: 0.0 },
        acceleration_share: 1.0,
        without_hands: false,
    };

    /// How poses travel.
    pub const fn link(&self) -> LinkProfile {
        LinkProfile { delay: self.latency, jitter: Span::ZERO, loss: self.loss }
    }

    /// The machine's limits.
    pub fn limits(&self) -> Limits {
        let axis = |own: AxisLimits| AxisLimits {
            acceleration_mps2: own.acceleration_mps2 * self.acceleration_share,
            braking_mps2: own.braking_mps2 * self.acceleration_share,
            ..own
        };
        Limits { x: axis(Limits::PAPER.x), y: axis(Limits::PAPER.y) }
    }
}

impl SeparationChoice {
    /// Its name on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::On => "on",
            Self::Off => "off",
        }
    }

    /// The choice of this name.
    pub fn parse(name: &str) -> Result<Self, PlanProblem> {
        named("separation", name, &[Self::On, Self::Off], Self::name)
    }

    /// In the engine's words: nothing real moves in a replay.
    pub const fn kept_from(self) -> KeptFrom {
        match self {
            Self::On => KeptFrom::Everybody,
            Self::Off => KeptFrom::Nobody(WhollySimulated::by_a_replay_on_virtual_time()),
        }
    }
}

impl RuleChoice {
    /// Every rule that an engine runs: what is evaluated when nobody says.
    pub fn all() -> Vec<Self> {
        RuleName::ALL.into_iter().map(Self::Rule).chain([Self::Told]).collect()
    }

    /// Every rule that has a name.
    fn named() -> Vec<Self> {
        Self::all().into_iter().chain([Self::Bound]).collect()
    }

    /// Its name on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rule(rule) => rule.name(),
            Self::Told => "told",
            Self::Bound => "bound",
        }
    }

    /// The rule of this name.
    pub fn parse(name: &str) -> Result<Self, PlanProblem> {
        named("rule", name, &Self::named(), Self::name)
    }

    /// One of the paper's readings: run with every motion, so that prediction and motion can be told apart.
    fn is_of_the_paper(self) -> bool {
        self.name().starts_with("paper")
    }

    /// The goal is known, so a prior says nothing.
    pub(super) const fn knows_the_goal(self) -> bool {
        matches!(self, Self::Told | Self::Bound)
    }

    /// The engine's rule. Where the goal is known every other prior is nothing, so that any rule has but one choice.
    pub const fn engine_rule(self) -> RuleName {
        match self {
            Self::Rule(rule) => rule,
            Self::Told | Self::Bound => RuleName::PaperBest,
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

/// The motion of this name.
pub fn motion(name: &str) -> Result<MotionName, PlanProblem> {
    named("motion", name, &MotionName::ALL, MotionName::name)
}

impl MachineKind {
    /// The period of the loop that drives it. The ideal machine needs no loop faster than the poses; its period is
    /// rounded up, so that each pose has arrived when its step comes.
    pub const fn period(self) -> Span {
        match self {
            Self::Simulated => Span::from_millis(4),
            Self::Ideal => Span::from_micros(13_334),
        }
    }

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
        for rule in RuleChoice::named() {
            assert_eq!(RuleChoice::parse(rule.name()), Ok(rule));
        }
        assert!(!RuleChoice::all().contains(&RuleChoice::Bound));
        let refused = RuleChoice::parse("papper").unwrap_err().to_string();
        assert!(refused.starts_with("rule: found `papper`") && refused.contains("told"), "{refused}");
        assert_eq!(Objects::parse("all"), Ok(Objects::All));
        assert!(Objects::parse("0").is_err() && Objects::parse("x").is_err());
    }
}
