//! One replay: which walk, what is shown, and how it is driven.

use covr_engine::frames::Floor;
use covr_engine::intention::IntentionParameters;
use covr_engine::machine::{Limits, Travel};
use covr_engine::time::Time;
use covr_gantry::contract::Simulated;
use covr_gantry::ideal::IdealMachine;
use covr_gantry::sim::SimulatedMachine;
use covr_gantry::sim::parameters::MachineParameters;
use sha2::{Digest, Sha256};

use super::plan::{Conditions, MachineKind, Plan, Prior, RuleChoice};
use super::run::{Cell, EvaluationProblem};
use super::subjects::{Reach, travel};
use crate::replay::{Conduct, Glimpse, Pace, ReachTrial, TrialOutcome, Walk};
use crate::trace::Recording;

/// One replay: a walk, what is shown, and how it is driven.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course<'a> {
    pub plan: &'a Plan,
    pub cell: Cell,
    pub reach: &'a Reach,
    pub walk: &'a Walk<'a>,
    pub intention: &'a IntentionParameters,
    pub told_from: Option<Time>,
    pub limits: Limits,
    pub machine: MachineKind,
    pub conditions: Conditions,
}

impl<'a> Course<'a> {
    /// The replay that a cell of the plan asks for.
    pub fn of(plan: &'a Plan, cell: Cell, reach: &'a Reach, walk: &'a Walk<'a>) -> Self {
        let told_from = (cell.rule == RuleChoice::Told).then_some(walk.begins());
        let Plan { conditions, machine, ref intention, .. } = *plan;
        let limits = conditions.limits();
        Self { plan, cell, reach, walk, intention, told_from, limits, machine, conditions }
    }

    /// What comes of it.
    pub fn replayed(&self) -> Result<TrialOutcome, EvaluationProblem> {
        self.replayed_before(&mut |_| ())
    }

    /// The same, with every step shown to `watcher`.
    pub fn replayed_before(
        &self,
        watcher: &mut dyn FnMut(Glimpse<'_>),
    ) -> Result<TrialOutcome, EvaluationProblem> {
        let priors = self.priors();
        let targets = self.targets();
        let trial = ReachTrial {
            walk: self.walk,
            targets: &targets,
            priors: Some(&priors),
            conduct: conduct(self.plan, &self.cell, self.intention),
            told_from: self.told_from,
            link: self.conditions.link(),
            seed: seed(&self.reach.recording, "link"),
        };
        let (travel, place) = (travel(&self.reach.recording), self.reach.column);
        let machine = machine(self.machine, self.limits, travel, place)?;
        Ok(trial.run_watched(machine, watcher)?)
    }

    /// The same with poses as they were recorded; none where they are.
    pub fn as_recorded(&self) -> Result<Option<TrialOutcome>, EvaluationProblem> {
        let Conditions { acceleration_share, .. } = self.conditions;
        let conditions = Conditions { acceleration_share, ..Conditions::AS_RECORDED };
        if conditions == self.conditions {
            return Ok(None);
        }
        let walk =
            Walk::of_reach(&self.reach.recording, &pace(self.plan, &conditions, &self.reach.recording))?;
        let course = Course { walk: &walk, conditions, ..*self };
        course.replayed().map(Some)
    }

    /// The targets shown, as indices into the recording's.
    pub fn targets(&self) -> Vec<usize> {
        let recording = &self.reach.recording;
        let objects = self.cell.objects.of(recording.targets.len());
        self.cell.draw.targets(recording, &recording.trial, self.reach.goal, objects)
    }

    fn priors(&self) -> Vec<f64> {
        let favoured = match self.cell.prior {
            Prior::None => None,
            Prior::Right => Some(self.reach.goal),
            Prior::Wrong => self.first_distractor(),
        };
        let targets = self.targets();
        targets.iter().map(|&index| prior_of(index, favoured, targets.len())).collect()
    }

    /// The distractor that a wrong prior names.
    pub fn first_distractor(&self) -> Option<usize> {
        let recording = &self.reach.recording;
        let objects = self.cell.objects.of(recording.targets.len());
        self.cell.draw.first_distractor(recording, &recording.trial, self.reach.goal, objects)
    }
}

/// How the engine decides in a cell.
pub(super) fn conduct<'a>(plan: &Plan, cell: &Cell, intention: &'a IntentionParameters) -> Conduct<'a> {
    Conduct {
        rule: cell.rule.engine_rule(),
        intention,
        motion: cell.motion,
        kept_from: cell.separation.kept_from(),
        v_h_mps: plan.v_h_mps,
    }
}

/// The prior of a target among so many shown.
pub(super) fn prior_of(index: usize, favoured: Option<usize>, shown: usize) -> f64 {
    let others = shown.saturating_sub(1).max(1) as f64;
    match favoured {
        None => 1.0,
        Some(favoured) if index == favoured => FAVOURED,
        Some(_) => (1.0 - FAVOURED) / others,
    }
}

/// A machine that is homed and stands at `place`.
pub(super) fn machine(
    kind: MachineKind,
    limits: Limits,
    travel: Travel,
    place: Floor,
) -> Result<Box<dyn Simulated>, EvaluationProblem> {
    Ok(match kind {
        MachineKind::Ideal => Box::new(IdealMachine::standing(limits, travel, place)),
        MachineKind::Simulated => Box::new(SimulatedMachine::standing(MachineParameters {
            limits,
            start: place,
            ..MachineParameters::paper(travel)
        })?),
    })
}

pub(super) fn pace(plan: &Plan, conditions: &Conditions, recording: &Recording) -> Pace {
    let seed = seed(recording, "noise");
    Pace {
        period: plan.machine.period(),
        pose_hz: POSE_HZ,
        noise: conditions.noise,
        seed,
        hands: !conditions.without_hands,
    }
}

/// Every trial has losses and noise of its own, the same for each rule, number of objects and number of threads.
pub(super) fn seed(recording: &Recording, of: &str) -> u64 {
    let hash: [u8; 32] = Sha256::digest(format!("{}/{of}", recording.trial)).into();
    hash.iter().take(8).fold(0, |seed, byte| seed << 8 | u64::from(*byte))
}

/// The paper's head tracking, Hz.
pub(super) const POSE_HZ: f64 = 75.0;
/// The paper's prior on the goal.
const FAVOURED: f64 = 0.75;
