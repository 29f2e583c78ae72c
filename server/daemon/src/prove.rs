//! `covr prove`: random worlds on virtual time, and nobody may be met.

use clap::Args;
use covr_study::prove::{Campaign, Findings, Part, prove};

use crate::evaluate::{bar, walking_speed};

/// Try to have the machine break the separation rule: people at their worst, meddling operators, faults.
#[derive(Debug, Clone, Args)]
pub struct Prove {
    /// Control periods in all, shared among worlds of 21,000.
    #[arg(long, default_value_t = 1_000_000)]
    pub steps: u64,
    /// Seed of the first world; the others count on from it.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// v_h, m/s; drawn for each world when not given: mostly 1.6, sometimes 2.0.
    #[arg(long, value_parser = walking_speed)]
    pub v_h: Option<f64>,
    /// Leave these out: operator, faults, person-0, person-1, person-2.
    #[arg(long, value_delimiter = ',', value_parser = Part::parse)]
    pub without: Vec<Part>,
    /// Threads; 0 for as many as there are cores. The result does not depend on it.
    #[arg(long, default_value_t = 0)]
    pub threads: usize,
}

/// What was found; its last line reads `steps: N violations: V`.
pub fn run(options: &Prove) -> anyhow::Result<Findings> {
    let campaign = Campaign {
        steps: options.steps,
        seed: options.seed,
        v_h_mps: options.v_h,
        without: options.without.clone(),
        threads: options.threads,
    };
    let bar = bar("steps");
    bar.set_length(options.steps);
    let findings = prove(&campaign, &|done| bar.set_position(done)).map_err(anyhow::Error::msg)?;
    bar.finish_and_clear();
    Ok(findings)
}
