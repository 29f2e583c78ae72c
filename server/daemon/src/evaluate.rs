//! `covr evaluate`: recorded people through the whole loop, as a table.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, bail};
use clap::Args;
use covr_engine::intention::IntentionParameters;
use covr_engine::motion::MotionName;
use covr_engine::time::Span;
use covr_study::evaluate::{
    Conditions, Draw, Evaluation, MachineKind, Objects, Plan, PlanProblem, Prior, Progress, RuleChoice,
    SeparationChoice, Subjects, csv, evaluate, json, motion, sweep, terminal,
};
use covr_study::fit::{Parameter, ParameterFile};
use covr_study::replay::TrackingNoise;
use covr_study::report::html;
use indicatif::{ProgressBar, ProgressStyle};

use crate::config::Config;
use crate::fit::swept;

/// Replay recorded reaches through engine and machine on virtual time, and say how often the column was there.
#[derive(Debug, Clone, Args)]
pub struct Evaluate {
    /// Recordings (.jsonl, .jsonl.gz), or folders of them.
    #[arg(required_unless_present = "synthetic")]
    pub paths: Vec<PathBuf>,
    /// So many reaches of the made-up visitor instead, where there are no recordings. They are no evidence about people.
    #[arg(long, conflicts_with = "paths", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub synthetic: Option<u32>,
    /// Rules by name; when not given, every one but `bound`, the physical limit, which is searched for a second or more a reach.
    #[arg(long, value_delimiter = ',', value_parser = RuleChoice::parse)]
    pub rules: Vec<RuleChoice>,
    /// Motions by name; when not given, the default one, and every one for the paper's rules.
    #[arg(long, value_delimiter = ',', value_parser = motion)]
    pub motion: Vec<MotionName>,
    /// With the separation rule (on), without it (off).
    #[arg(long, value_delimiter = ',', default_value = "on", value_parser = SeparationChoice::parse)]
    pub separation: Vec<SeparationChoice>,
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
    #[arg(long, value_delimiter = ',', default_value = "hash", value_parser = Draw::parse)]
    pub draw: Vec<Draw>,
    /// v_h of the separation rule, m/s.
    #[arg(long, default_value_t = 1.6, value_parser = walking_speed)]
    pub v_h: f64,
    /// The machine: simulated, ideal.
    #[arg(long, default_value = "simulated", value_parser = MachineKind::parse)]
    pub machine: MachineKind,
    /// The rules' numbers from this file of parameters, as `covr fit` writes it; those of the server's default when not given.
    #[arg(long)]
    pub parameters: Option<PathBuf>,
    /// So many values of one parameter from end to end, such as paper.distance_share=13, each as rows of its own. The rules
    /// have to use it; when none are given, all that do.
    #[arg(long, value_parser = swept)]
    pub sweep: Option<(&'static Parameter, usize)>,
    /// Find out why each failed trial failed, by replaying it with one thing made right at a time.
    #[arg(long)]
    pub blame: bool,
    /// Added to the way of every pose, ms.
    #[arg(long, default_value_t = 0.0, value_parser = |text: &str| within("latency-ms", text, 0.0, 1_000.0))]
    pub latency_ms: f64,
    /// Share of poses that never arrive, 0 to 1.
    #[arg(long, default_value_t = 0.0, value_parser = |text: &str| within("loss", text, 0.0, 1.0))]
    pub loss: f64,
    /// Standard deviation of each coordinate of each pose, cm.
    #[arg(long, default_value_t = 0.0, value_parser = |text: &str| within("noise-cm", text, 0.0, 100.0))]
    pub noise_cm: f64,
    /// Standard deviation of heading, elevation and roll of each pose, degrees.
    #[arg(long, default_value_t = 0.0, value_parser = |text: &str| within("noise-deg", text, 0.0, 90.0))]
    pub noise_deg: f64,
    /// The machine's accelerations, braking included, as a share of the paper's.
    #[arg(long, default_value_t = 1.0, value_parser = |text: &str| within("acceleration-share", text, 0.05, 10.0))]
    pub acceleration_share: f64,
    /// The client sends no hands, where the recording has them.
    #[arg(long)]
    pub without_hands: bool,
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
    let subjects = match options.synthetic {
        Some(reaches) => Subjects::synthetic(reaches as usize),
        None => Subjects::read(&options.paths).context(
            "expected recordings (.jsonl, .jsonl.gz) or a folder of them; --synthetic 100 needs none",
        )?,
    };
    let plan = plan(options)?;
    let bar = bar("trials");
    let started = Instant::now();
    let progress = |done: usize, count: usize| {
        bar.set_length(count as u64);
        bar.set_position(done as u64);
    };
    let mut evaluation = match options.sweep {
        Some((parameter, values)) => over(&subjects, &plan, parameter, values, &progress)?,
        None => evaluate(&subjects, &plan, &progress)?,
    };
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

/// The plan with each value of the parameter.
fn over(
    subjects: &Subjects,
    plan: &Plan,
    parameter: &'static Parameter,
    values: usize,
    progress: Progress<'_>,
) -> anyhow::Result<Evaluation> {
    let base = &plan.intention;
    let (values, intentions): (Vec<f64>, Vec<_>) = parameter.swept(base, values).into_iter().unzip();
    let evaluations = sweep(subjects, plan, &intentions, progress)?;
    let of_values = values.into_iter().zip(evaluations).collect();
    Evaluation::of_sweep(parameter.name, of_values).context("--sweep: found no value, expected two or more")
}

fn plan(options: &Evaluate) -> anyhow::Result<Plan> {
    let people = Config::default().people;
    let intention = match &options.parameters {
        None => IntentionParameters::default(),
        Some(path) => {
            let text = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
            ParameterFile::read(&text, &path.display().to_string())?.parameters
        }
    };
    let rules = match (&options.sweep, options.rules.is_empty()) {
        (None, true) => RuleChoice::all(),
        (Some((parameter, _)), true) => parameter.rules.iter().copied().map(RuleChoice::Rule).collect(),
        (_, false) => options.rules.clone(),
    };
    if let Some((parameter, _)) = options.sweep {
        let uses =
            |rule: &RuleChoice| matches!(rule, RuleChoice::Rule(rule) if parameter.rules.contains(rule));
        if let Some(other) = rules.iter().find(|rule| !uses(rule)) {
            let those: Vec<&str> = parameter.rules.iter().map(|rule| rule.name()).collect();
            bail!(
                "--sweep {}: found rule `{}`, which does not use it, expected {}",
                parameter.name,
                other.name(),
                those.join(", ")
            );
        }
    }
    Ok(Plan {
        rules,
        intention,
        motions: options.motion.clone(),
        separations: options.separation.clone(),
        objects: options.objects.clone(),
        priors: options.prior.clone(),
        tasks: options.task.clone(),
        people: options.people.clone(),
        draws: options.draw.clone(),
        v_h_mps: options.v_h,
        machine: options.machine,
        conditions: conditions(options),
        blames: options.blame,
        threads: options.threads,
        ..Plan::new(people.intention_rule, people.motion)
    })
}

fn conditions(options: &Evaluate) -> Conditions {
    let noise =
        TrackingNoise { position_m: 0.01 * options.noise_cm, rotation_rad: options.noise_deg.to_radians() };
    Conditions {
        latency: Span::from_secs(1e-3 * options.latency_ms),
        loss: options.loss,
        noise,
        acceleration_share: options.acceleration_share,
        without_hands: options.without_hands,
    }
}

/// Progress on the terminal, counted in these; hidden where there is none.
pub(crate) fn bar(what: &str) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template(&format!("{{bar:40}} {{pos}}/{{len}} {what}, {{eta}} left"));
    ProgressBar::new(0).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// v_h on the command line, m/s.
pub(crate) fn walking_speed(text: &str) -> Result<f64, PlanProblem> {
    within("v-h", text, 1.6, 3.0)
}

fn within(what: &'static str, text: &str, least: f64, most: f64) -> Result<f64, PlanProblem> {
    let expected = format!("a number from {least} to {most}");
    let problem = || PlanProblem { what, found: text.into(), expected };
    text.parse().ok().filter(|value| (least..=most).contains(value)).ok_or_else(problem)
}
