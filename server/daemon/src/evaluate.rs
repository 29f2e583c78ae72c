//! `covr evaluate`: recorded people through the whole loop, as a table.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Context;
use clap::Args;
use covr_engine::intention::RuleName;
use covr_study::evaluate::{
    Draw, Evaluation, MachineKind, Objects, Plan, PlanProblem, Prior, RuleChoice, Subjects, csv, evaluate,
    json, terminal,
};
use covr_study::report::html;
use indicatif::{ProgressBar, ProgressStyle};

use crate::config::Config;

/// Replay recorded reaches through engine and machine on virtual time, and say how often the column was there.
#[derive(Debug, Clone, Args)]
pub struct Evaluate {
    /// Recordings (.jsonl, .jsonl.gz), or folders of them.
    #[arg(required = true)]
    pub paths: Vec<PathBuf>,
    /// Rules by name; every rule when not given.
    #[arg(long, value_delimiter = ',', value_parser = RuleChoice::parse)]
    pub rules: Vec<RuleChoice>,
    /// Numbers of objects shown: 1, 2, ..., all.
    #[arg(long, value_delimiter = ',', default_value = "1,2,3,4,5,all", value_parser = Objects::parse)]
    pub objects: Vec<Objects>,
    /// What the scenario says: none, right (0.75 on the goal), wrong (0.75 on a distractor).
    #[arg(long, value_delimiter = ',', default_value = "none", value_parser = Prior::parse)]
    pub prior: Vec<Prior>,
    /// Tasks by name, such as fixed; every one when not given.
    #[arg(long, value_delimiter = ',')]
    pub task: Vec<String>,
    /// People by name; every one when not given.
    #[arg(long, value_delimiter = ',')]
    pub people: Vec<String>,
    /// How distractors are drawn: hash, same-wall.
    #[arg(long, default_value = "hash", value_parser = Draw::parse)]
    pub draw: Draw,
    /// v_h of the separation rule, m/s.
    #[arg(long, default_value_t = 1.6, value_parser = walking_speed)]
    pub v_h: f64,
    /// The machine: simulated, ideal.
    #[arg(long, default_value = "simulated", value_parser = MachineKind::parse)]
    pub machine: MachineKind,
    /// Threads; 0 for as many as there are cores. The result does not depend on it.
    #[arg(long, default_value_t = 0)]
    pub threads: usize,
    /// Write the table as JSON to this file; - for standard output, with nothing else on it.
    #[arg(long)]
    pub json: Option<PathBuf>,
    /// Write the table as CSV to this file; - for standard output.
    #[arg(long)]
    pub csv: Option<PathBuf>,
    /// Write the table with its plots as one HTML page to this file; - for standard output.
    #[arg(long)]
    pub html: Option<PathBuf>,
}

/// The table: what goes to standard output. Files are written on the way.
pub fn run(options: &Evaluate) -> anyhow::Result<String> {
    let subjects = Subjects::read(&options.paths)?;
    let plan = plan(options);
    let bar = bar();
    let started = Instant::now();
    let mut evaluation: Evaluation = evaluate(&subjects, &plan, &|done, count| {
        bar.set_length(count as u64);
        bar.set_position(done as u64);
    })?;
    bar.finish_and_clear();
    evaluation.wall_secs = started.elapsed().as_secs_f64();
    let mut out = String::new();
    let written = [
        (&options.json, json(&evaluation)?),
        (&options.csv, csv(&evaluation)?),
        (&options.html, html(&evaluation)),
    ];
    for (file, text) in written {
        match file.as_deref() {
            Some(file) if file == Path::new("-") => out += &(text + "\n"),
            Some(file) => std::fs::write(file, text).with_context(|| file.display().to_string())?,
            None => {}
        }
    }
    Ok(if out.is_empty() { terminal(&evaluation) } else { out })
}

fn plan(options: &Evaluate) -> Plan {
    let default_rule: RuleName = Config::default().people.intention_rule;
    Plan {
        rules: if options.rules.is_empty() { RuleChoice::all() } else { options.rules.clone() },
        objects: options.objects.clone(),
        priors: options.prior.clone(),
        tasks: options.task.clone(),
        people: options.people.clone(),
        draw: options.draw,
        v_h_mps: options.v_h,
        machine: options.machine,
        default_rule,
        threads: options.threads,
    }
}

fn bar() -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} trials, {eta} left");
    ProgressBar::new(0).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

fn walking_speed(text: &str) -> Result<f64, PlanProblem> {
    let problem = || PlanProblem { what: "v_h", found: text.into(), expected: "m/s from 1.6 to 3".into() };
    text.parse().ok().filter(|v_h| (1.6..=3.0).contains(v_h)).ok_or_else(problem)
}
