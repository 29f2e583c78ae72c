//! How fast recorded reaches are replayed: `cargo run --release -p covr-study --example replay_speed -- TRACES`, with
//! `ideal` or `simulated` before the traces on that machine alone.
//!
//! The paper's sweep is 13 values of w over 300 trials; it took its authors over 17 hours.

use std::error::Error;
use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::motion::MotionName;
use covr_study::evaluate::{MachineKind, Objects, Plan, RuleChoice, Subjects, sweep};

const VALUES: usize = 13;
const TRIALS: usize = 300;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let named = words.first().and_then(|word| MachineKind::parse(word.to_str()?).ok());
    let paths = words.split_off(usize::from(named.is_some()));
    let machines = named.map_or(vec![MachineKind::Ideal, MachineKind::Simulated], |machine| vec![machine]);
    let mut out = std::io::stdout().lock();
    let begins = Instant::now();
    let subjects = Subjects::read(&paths)?.first(TRIALS);
    writeln!(out, "reading: {:.2} s", begins.elapsed().as_secs_f64())?;
    for machine in machines {
        let begins = Instant::now();
        let plan = Plan {
            rules: vec![RuleChoice::Rule(RuleName::Paper)],
            motions: vec![MotionName::Proxy],
            objects: vec![Objects::Count(3)],
            machine,
            ..Plan::new(RuleName::Paper, MotionName::Proxy)
        };
        let mut values = vec![IntentionParameters::default(); VALUES];
        for (value, intention) in values.iter_mut().enumerate() {
            intention.paper.distance_share = value as f64 / (VALUES - 1) as f64;
        }
        let evaluations = sweep(&subjects, &plan, &values, &|_, _| ())?;
        let simulated_secs: f64 = evaluations.iter().map(|evaluation| evaluation.simulated_secs).sum();
        let wall_secs = begins.elapsed().as_secs_f64();
        let faster = simulated_secs / wall_secs;
        let name = machine.name();
        writeln!(
            out,
            "{name}: {VALUES} values over {TRIALS} trials in {wall_secs:.2} s, {faster:.0} x real time"
        )?;
    }
    Ok(())
}
