//! `covr explain`: one recorded reach in words, and drawn.

use std::path::PathBuf;

use anyhow::Context;
use clap::Args;
use covr_engine::motion::MotionName;
use covr_study::evaluate::{
    Draw, MachineKind, Objects, Plan, Prior, RuleChoice, SeparationChoice, Subjects, explain, motion,
};

use crate::config::Config;
use crate::evaluate::walking_speed;

/// Say what happened in one trial: what the rule believed, where the column was, and why it was late if it was.
#[derive(Debug, Clone, Args)]
pub struct Explain {
    /// The trial, by the name that its recording has.
    pub trial: String,
    /// Recordings (.jsonl, .jsonl.gz), or folders of them. The column begins at the goal before, so give the whole file.
    #[arg(required = true)]
    pub paths: Vec<PathBuf>,
    /// The rule by name; the server's default when not given.
    #[arg(long, value_parser = RuleChoice::parse)]
    pub rule: Option<RuleChoice>,
    /// The motion by name; the server's default when not given.
    #[arg(long, value_parser = motion)]
    pub motion: Option<MotionName>,
    /// With the separation rule (on), without it (off).
    #[arg(long, default_value = "on", value_parser = SeparationChoice::parse)]
    pub separation: SeparationChoice,
    /// Number of objects shown: 1, 2, ..., all.
    #[arg(long, default_value = "3", value_parser = Objects::parse)]
    pub objects: Objects,
    /// What the scenario says: none, right (0.75 on the goal), wrong (0.75 on a distractor).
    #[arg(long, default_value = "none", value_parser = Prior::parse)]
    pub prior: Prior,
    /// How distractors are drawn: hash, same-wall.
    #[arg(long, default_value = "hash", value_parser = Draw::parse)]
    pub draw: Draw,
    /// v_h of the separation rule, m/s.
    #[arg(long, default_value_t = 1.6, value_parser = walking_speed)]
    pub v_h: f64,
    /// The machine: simulated, ideal.
    #[arg(long, default_value = "simulated", value_parser = MachineKind::parse)]
    pub machine: MachineKind,
    /// Draw it to this file.
    #[arg(long)]
    pub svg: Option<PathBuf>,
}

/// The words; the picture is written on the way.
pub fn run(options: &Explain) -> anyhow::Result<String> {
    let subjects = Subjects::read(&options.paths)?;
    let people = Config::default().people;
    let plan = Plan {
        rules: vec![options.rule.unwrap_or(RuleChoice::Rule(people.intention_rule))],
        motions: vec![options.motion.unwrap_or(people.motion)],
        separations: vec![options.separation],
        objects: vec![options.objects],
        priors: vec![options.prior],
        draws: vec![options.draw],
        v_h_mps: options.v_h,
        machine: options.machine,
        ..Plan::new(people.intention_rule, people.motion)
    };
    let explanation = explain(&subjects, &plan, &options.trial)?;
    if let Some(file) = &options.svg {
        std::fs::write(file, &explanation.svg).with_context(|| file.display().to_string())?;
    }
    Ok(explanation.words)
}
