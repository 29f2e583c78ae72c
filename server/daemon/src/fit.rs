//! `covr fit`: the parameters of an intention rule that suit recorded people, judged on people left out.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::motion::MotionName;
use covr_study::evaluate::{
    Draw, EvaluationProblem, MachineKind, Objects, Plan, Prior, RuleChoice, Subjects, evaluate_by_person,
    json, motion, terminal,
};
use covr_study::fit::{
    BeliefLoss, FailureLoss, Fit as Found, Fitted, FittedOn, Objective, PARAMETERS, Parameter, ParameterFile,
    Start, Tally, fit, of_rule, sweep,
};
use covr_study::trace::{Recording, Recordings, trace_files};
use indicatif::{ProgressBar, ProgressStyle};

use crate::clock;
use crate::config::Config;
use crate::evaluate::bar as trials;

/// Fit the parameters of an intention rule to recorded people, and judge them on people left out.
#[derive(Debug, Clone, Args)]
pub struct Fit {
    /// Recordings (.jsonl, .jsonl.gz), or folders of them.
    #[arg(required = true)]
    pub paths: Vec<PathBuf>,
    /// The rule.
    #[arg(long, value_parser = rule)]
    pub rule: RuleName,
    /// What is made better: the log loss of the goal (log-loss; poses and rule alone, quick), or the share of reaches that the
    /// column is in place for (success; the whole loop, slow).
    #[arg(long, value_enum, default_value_t = Aim::LogLoss)]
    pub objective: Aim,
    /// The motion, for the objective success; the server's default when not given.
    #[arg(long, value_parser = motion)]
    pub motion: Option<MotionName>,
    /// The machine, for the objective success: simulated, ideal.
    #[arg(long, default_value = "simulated", value_parser = MachineKind::parse)]
    pub machine: MachineKind,
    /// Numbers of objects shown: 1, 2, ..., all.
    #[arg(long, value_delimiter = ',', default_value = "1,2,3,4,5,all", value_parser = Objects::parse)]
    pub objects: Vec<Objects>,
    /// Tasks by name, such as fixed; every one when not given.
    #[arg(long, value_delimiter = ',')]
    pub task: Vec<String>,
    /// People by name; every one when not given.
    #[arg(long, value_delimiter = ',')]
    pub people: Vec<String>,
    /// Scenario priors, for the objective success and --served: none, right, wrong.
    #[arg(long, value_delimiter = ',', default_value = "none", value_parser = Prior::parse)]
    pub prior: Vec<Prior>,
    /// How distractors are drawn, for the same: hash, same-wall.
    #[arg(long, value_delimiter = ',', default_value = "hash", value_parser = Draw::parse)]
    pub draw: Vec<Draw>,
    /// Where the search begins: the rule's default, which may have been found on the same people, or the middle of every range.
    #[arg(long, value_enum, default_value_t = StartFrom::Default)]
    pub start: StartFrom,
    /// Groups of people that are left out in turn; 0 for none.
    #[arg(long, default_value_t = 5)]
    pub folds: usize,
    /// Instead of a search, so many values of one parameter from end to end, such as paper.distance_share=13.
    #[arg(long, value_parser = swept)]
    pub sweep: Option<(&'static Parameter, usize)>,
    /// Then replay every reach through the whole loop with parameters that were not fitted to its person, and say how many were
    /// served; beside it those by default, and those that were fitted to everybody.
    #[arg(long, conflicts_with = "sweep")]
    pub served: bool,
    /// Write the table of the people left out as JSON to this file, as `covr evaluate` does.
    #[arg(long, requires = "served")]
    pub json: Option<PathBuf>,
    /// Write the parameters to this file.
    #[arg(long, conflicts_with = "sweep")]
    pub out: Option<PathBuf>,
    /// Threads; 0 for as many as there are cores. The result does not depend on it.
    #[arg(long, default_value_t = 0)]
    pub threads: usize,
}

/// What is made better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Aim {
    /// The log loss of the goal.
    LogLoss,
    /// The share of reaches served.
    Success,
}

/// Where a search begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum StartFrom {
    /// At the rule's default.
    Default,
    /// In the middle of every range.
    Middle,
}

/// The report: what goes to standard output. The file is written on the way.
pub fn run(options: &Fit) -> anyhow::Result<String> {
    let (recordings, files) = read(options)?;
    let bar = bar();
    match options.objective {
        Aim::LogLoss => {
            let loss = BeliefLoss::new(&recordings, options.rule, &options.objects, options.threads)?;
            report_of(options, &loss, &recordings, files, &bar)
        }
        Aim::Success => {
            let subjects = Subjects::read(&options.paths)?;
            let plan = plan(options);
            let progress =
                |done: usize, count: usize| bar.set_message(format!("{done} of {count} replays of the next"));
            let loss = FailureLoss::new(&subjects, &plan, &progress);
            report_of(options, &loss, &recordings, files, &bar)
        }
    }
}

fn plan(options: &Fit) -> Plan {
    let people = Config::default().people;
    Plan {
        rules: vec![RuleChoice::Rule(options.rule)],
        motions: vec![options.motion.unwrap_or(people.motion)],
        objects: options.objects.clone(),
        priors: options.prior.clone(),
        draws: options.draw.clone(),
        tasks: options.task.clone(),
        people: options.people.clone(),
        machine: options.machine,
        threads: options.threads,
        ..Plan::new(people.intention_rule, people.motion)
    }
}

fn report_of(
    options: &Fit,
    objective: &dyn Objective,
    recordings: &[Recording],
    files: Vec<FittedOn>,
    bar: &ProgressBar,
) -> anyhow::Result<String> {
    let told = || bar.inc(1);
    if let Some((parameter, values)) = options.sweep {
        let swept = sweep(objective, &IntentionParameters::default(), parameter, values)?;
        bar.finish_and_clear();
        let mut text = format!("{:>12}  {}\n", parameter.name, objective.figure());
        for (value, loss) in swept {
            let total = loss.values().fold(Tally::default(), |sum, one| sum.with(*one));
            let _ = writeln!(text, "{value:>12.4}  {:.4}", total.mean());
        }
        return Ok(text);
    }
    if of_rule(options.rule).next().is_none() {
        let fittable: Vec<&str> = RuleName::ALL
            .into_iter()
            .filter(|rule| of_rule(*rule).next().is_some())
            .map(RuleName::name)
            .collect();
        bail!(
            "--rule: found `{}`, which has no parameters, expected one of {}",
            options.rule.name(),
            fittable.join(", ")
        );
    }
    if options.served && options.folds < 2 {
        bail!("--folds: found {}, expected at least 2 groups of people for --served", options.folds);
    }
    let start = match options.start {
        StartFrom::Default => Start::Default,
        StartFrom::Middle => Start::Middle,
    };
    let found = fit(objective, options.rule, options.folds, start, &told)?;
    bar.finish_and_clear();
    if let Some(out) = &options.out {
        let fitted = Some(fitted(&found, objective, recordings, files));
        let file = ParameterFile { rule: options.rule, parameters: found.parameters.clone(), fitted };
        std::fs::write(out, file.text()?).with_context(|| out.display().to_string())?;
    }
    let mut text = report(options.rule, objective, &found);
    if options.served {
        text += &served(options, &found)?;
    }
    Ok(text)
}

/// Everybody replayed through the whole loop: with what was fitted without them, with the default, with what was fitted to all.
fn served(options: &Fit, found: &Found) -> anyhow::Result<String> {
    let subjects = Subjects::read(&options.paths)?;
    let plan = plan(options);
    let left_out = found.left_out_by_person();
    if left_out.is_empty() {
        bail!("--served: found one person, expected at least two, to be judged by what was fitted to others");
    }
    let bar = trials("trials");
    let progress = |done: usize, count: usize| {
        bar.set_length(count as u64);
        bar.set_position(done as u64);
    };
    let timed = |plan: &Plan, own: &BTreeMap<String, IntentionParameters>| {
        let started = Instant::now();
        let mut evaluation = evaluate_by_person(&subjects, plan, own, &progress)?;
        evaluation.wall_secs = started.elapsed().as_secs_f64();
        Ok::<_, EvaluationProblem>(evaluation)
    };
    let judged = timed(&plan, &left_out)?;
    let by_default = timed(&plan, &BTreeMap::new())?;
    let fitted = Plan { intention: found.parameters.clone(), ..plan.clone() };
    let to_everybody = timed(&fitted, &BTreeMap::new())?;
    bar.finish_and_clear();
    if let Some(file) = &options.json {
        std::fs::write(file, json(&judged)?).with_context(|| file.display().to_string())?;
    }
    let mut text = String::new();
    for (who, evaluation) in
        [("people left out", &judged), ("by default", &by_default), ("fitted to everybody", &to_everybody)]
    {
        let _ = writeln!(text, "\nserved, {who}:\n{}", terminal(evaluation).trim_end());
    }
    Ok(text)
}

fn read(options: &Fit) -> anyhow::Result<(Vec<Recording>, Vec<FittedOn>)> {
    let asked = |list: &[String], word: &str| list.is_empty() || list.iter().any(|one| one == word);
    let (mut recordings, mut files) = (Vec::new(), Vec::new());
    for path in &options.paths {
        for file in trace_files(path)? {
            let before = recordings.len();
            for recording in Recordings::open(&file)? {
                let recording = recording?;
                let has_reach = recording.goal.is_some() && recording.events.reach.is_some();
                let task = recording.mode.as_deref().unwrap_or("none");
                if has_reach && asked(&options.task, task) && asked(&options.people, &recording.user) {
                    recordings.push(recording);
                }
            }
            if recordings.len() > before {
                files.push(FittedOn::of(&file).with_context(|| file.display().to_string())?);
            }
        }
    }
    if recordings.is_empty() {
        bail!("found no recording with a goal and a reach among those that were asked for");
    }
    Ok((recordings, files))
}

fn fitted(
    found: &Found,
    objective: &dyn Objective,
    recordings: &[Recording],
    files: Vec<FittedOn>,
) -> Fitted {
    let mut people: Vec<String> = recordings.iter().map(|recording| recording.user.clone()).collect();
    people.sort();
    people.dedup();
    Fitted {
        at: clock::wall_now(),
        version: env!("CARGO_PKG_VERSION").into(),
        command: command(),
        objective: objective.name().into(),
        before: found.before,
        in_sample: found.in_sample,
        left_out: found.left_out,
        folds: found.folds.len(),
        people,
        files,
    }
}

/// As it was given, but for the folder that the program lies in.
fn command() -> String {
    let words = std::env::args().skip(1);
    std::iter::once("covr".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

fn report(rule: RuleName, objective: &dyn Objective, found: &Found) -> String {
    let mut text = format!("{}, {}: by default {:.4}\n", rule.name(), objective.figure(), found.before);
    let _ = writeln!(text, "fitted to everybody         {:.4}", found.in_sample);
    match found.left_out {
        Some(left_out) => _ = writeln!(text, "on people left out          {left_out:.4}"),
        None => text += "on people left out          nobody was left out\n",
    }
    for fold in &found.folds {
        let who = fold.left_out.join(", ");
        let _ = writeln!(
            text,
            "  without {who}: in sample {:.4}, left out {:.4}",
            fold.in_sample, fold.on_left_out
        );
    }
    for parameter in of_rule(rule) {
        let (value, default) = (parameter.get(&found.parameters), parameter.default());
        let of_folds = found.folds.iter().map(|fold| parameter.get(&fold.parameters));
        let [least, most] =
            of_folds.fold([value, value], |[least, most], of_fold| [least.min(of_fold), most.max(of_fold)]);
        let (name, unit) = (parameter.name, parameter.unit);
        let _ = writeln!(
            text,
            "{name:<28} {value:.4} {unit} (default {default:.4}; folds {least:.4} to {most:.4})"
        );
    }
    text
}

fn bar() -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{spinner} {pos} sets of parameters, {elapsed} {msg}");
    ProgressBar::new_spinner().with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()))
}

fn rule(text: &str) -> Result<RuleName, String> {
    let names = RuleName::ALL.map(RuleName::name).join(", ");
    RuleName::parse(text).ok_or_else(|| format!("expected one of {names}"))
}

pub(crate) fn swept(text: &str) -> Result<(&'static Parameter, usize), String> {
    let names: Vec<&str> = PARAMETERS.iter().map(|parameter| parameter.name).collect();
    let expected = || format!("expected NAME=VALUES with 2 to 1000 values and one of {}", names.join(", "));
    let (name, values) = text.split_once('=').ok_or_else(expected)?;
    let values = values.parse().ok().filter(|values| (2..=1000).contains(values)).ok_or_else(expected)?;
    Ok((Parameter::named(name).ok_or_else(expected)?, values))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(folder: &std::path::Path, rule: RuleName) -> Fit {
        let line = |user: &str| {
            let frames: Vec<String> =
                (0..=60).map(|i| format!("[{},{},2000,1600,1571,0]", i * 1000 / 30, 1000 + i * 30)).collect();
            format!(
                r#"{{"dataset":"made","trial":"{user}","user":"{user}","arena":{{"x":[0,4],"y":[0,4]}},"goal":"B","targets":[{{"id":"A","x":1,"y":3.5,"z":1.6,"r":0.1}},{{"id":"B","x":3.4,"y":2,"z":1.6,"r":0.1}}],"events":{{"reach":2.0}},"cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],"frames":[{}]}}"#,
                frames.join(",")
            )
        };
        let file = folder.join("made_reach.jsonl");
        std::fs::write(&file, [line("u"), line("v")].join("\n")).unwrap();
        Fit {
            paths: vec![file],
            rule,
            objective: Aim::LogLoss,
            motion: None,
            machine: MachineKind::Ideal,
            objects: vec![Objects::Count(2)],
            task: Vec::new(),
            people: Vec::new(),
            prior: vec![Prior::None],
            draw: vec![Draw::Hash],
            start: StartFrom::Default,
            folds: 2,
            served: false,
            json: None,
            sweep: None,
            out: Some(folder.join("out.toml")),
            threads: 1,
        }
    }

    #[test]
    fn what_is_written_is_what_a_server_reads_and_says_where_it_comes_from() {
        let folder = tempfile::tempdir().unwrap();
        let report = run(&options(folder.path(), RuleName::Paper)).unwrap();
        assert!(report.contains("on people left out") && report.contains("paper.distance_share"), "{report}");
        let text = std::fs::read_to_string(folder.path().join("out.toml")).unwrap();
        let file = ParameterFile::read(&text, "out.toml").unwrap();
        let fitted = file.fitted.unwrap();
        assert_eq!((fitted.people, fitted.folds), (vec!["u".to_owned(), "v".to_owned()], 2));
        assert_eq!((fitted.files[0].name.as_str(), fitted.files[0].sha256.len()), ("made_reach.jsonl", 64));
        assert!(file.parameters.paper.distance_share > 0.5 && fitted.in_sample < fitted.before);
    }

    #[test]
    fn success_is_fitted_through_the_whole_loop_and_both_figures_are_said() {
        let folder = tempfile::tempdir().unwrap();
        let options = Fit {
            objective: Aim::Success,
            motion: Some(MotionName::Proxy),
            ..options(folder.path(), RuleName::PaperBest)
        };
        let report = run(&options).unwrap();
        for said in ["share of reaches not served: by default", "fitted to everybody", "on people left out"] {
            assert!(report.contains(said), "{said:?} is not in {report}");
        }
        let text = std::fs::read_to_string(folder.path().join("out.toml")).unwrap();
        let fitted = ParameterFile::read(&text, "out.toml").unwrap().fitted.unwrap();
        assert_eq!(fitted.objective, "success");
        assert!(fitted.command.starts_with("covr ") && fitted.left_out.is_some(), "{fitted:?}");
        let sweep = Some((Parameter::named("paper.distance_share").unwrap(), 3));
        let swept = run(&Fit { sweep, out: None, ..options }).unwrap();
        assert_eq!(swept.lines().count(), 4, "{swept}");
    }

    #[test]
    fn people_left_out_are_replayed_with_what_was_fitted_without_them() {
        let folder = tempfile::tempdir().unwrap();
        let options = Fit {
            served: true,
            start: StartFrom::Middle,
            json: Some(folder.path().join("left_out.json")),
            ..options(folder.path(), RuleName::PaperBest)
        };
        let report = run(&options).unwrap();
        for said in ["served, people left out:", "served, by default:", "served, fitted to everybody:"] {
            assert!(report.contains(said), "{said:?} is not in {report}");
        }
        let written = std::fs::read_to_string(folder.path().join("left_out.json")).unwrap();
        let table: serde_json::Value = serde_json::from_str(&written).unwrap();
        assert_eq!(table["rows"][0]["trials"], 2, "{table}");
        let nobody = run(&Fit { folds: 0, ..options }).unwrap_err().to_string();
        assert!(nobody.contains("--folds: found 0"), "{nobody}");
    }

    #[test]
    fn a_rule_without_parameters_and_a_sweep_of_nothing_are_refused_with_the_names() {
        let folder = tempfile::tempdir().unwrap();
        let refused = run(&options(folder.path(), RuleName::Nearest)).unwrap_err().to_string();
        assert!(refused.contains("`nearest`") && refused.contains("paper-best"), "{refused}");
        assert!(swept("paper.w=13").unwrap_err().contains("paper.distance_share"));
        assert!(swept("paper.distance_share=1").is_err() && swept("paper.distance_share=13").is_ok());
        let nobody = Fit { people: vec!["x".into()], ..options(folder.path(), RuleName::Paper) };
        assert!(run(&nobody).unwrap_err().to_string().contains("no recording"));
    }
}
