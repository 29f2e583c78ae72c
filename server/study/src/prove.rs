//! Proof at scale: random worlds with people at their worst, an operator who meddles and things that break, on virtual
//! time, every step of it before the independent checker. A violation is shrunk to the least that still shows it.

mod adversary;
mod faults;
mod inputs;
mod operator;
mod playmate;
mod proof;
mod world;

use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::parallel;
pub use proof::{Case, Part, Proof, run};

/// How much is to be run.
#[derive(Debug, Clone, PartialEq)]
pub struct Campaign {
    /// Control periods in all.
    pub steps: u64,
    /// Of the first world; the others count on from it.
    pub seed: u64,
    /// v_h, m/s; drawn for each world when none.
    pub v_h_mps: Option<f64>,
    /// Left out of every world.
    pub without: Vec<Part>,
    /// Threads; 0 for as many as there are cores.
    pub threads: usize,
}

/// What a campaign found.
#[derive(Debug, Clone, PartialEq)]
pub struct Findings {
    /// Control periods run.
    pub steps: u64,
    /// Worlds.
    pub worlds: u64,
    /// Violations of the true and of the commanded motion, and ticks of motion against an input.
    pub violations: u64,
    /// Ticks in which the column moved.
    pub moving_ticks: u64,
    /// Steps in the mode `following`.
    pub following: u64,
    /// Steps in which the column moved in contact with somebody (R14).
    pub in_contact: u64,
    /// Moving ticks legal only as a retreat.
    pub retreating: u64,
    /// Moving ticks excused because r grew or a person appeared, or a retreat was overtaken.
    pub excused: u64,
    /// Least distance of any head from the moving column, m.
    pub least_separation_moving_m: Option<f64>,
    /// One violation of each world that had any, as small as it could be made.
    pub shrunk: Vec<Proof>,
}

impl Campaign {
    /// The worlds: all of a length, but for the last.
    fn cases(&self) -> Vec<Case> {
        let count = self.steps.div_ceil(STEPS_A_WORLD);
        let case = |k: u64| Case {
            seed: self.seed.wrapping_add(k),
            steps: STEPS_A_WORLD.min(self.steps - k * STEPS_A_WORLD),
            v_h_mps: self.v_h_mps,
            without: self.without.clone(),
        };
        (0..count).map(case).collect()
    }
}

/// Run a campaign, telling the steps done. In words what could not even begin.
pub fn prove(campaign: &Campaign, progress: &(dyn Fn(u64) + Sync)) -> Result<Findings, String> {
    let cases = campaign.cases();
    let done = AtomicU64::new(0);
    let proofs = parallel::each(cases.len(), campaign.threads, |k| {
        let proof = run(&cases[k], u64::MAX);
        progress(done.fetch_add(cases[k].steps, Ordering::Relaxed) + cases[k].steps);
        proof
    });
    let proofs = proofs.into_iter().collect::<Result<Vec<Proof>, String>>()?;
    let total = |of: fn(&Proof) -> u64| proofs.iter().map(of).sum::<u64>();
    let guilty: Vec<&Proof> = proofs.iter().filter(|proof| proof.violations() > 0).collect();
    let shrunk = parallel::each(guilty.len(), campaign.threads, |k| shrink(guilty[k]));
    Ok(Findings {
        steps: campaign.steps,
        worlds: cases.len() as u64,
        violations: total(Proof::violations),
        moving_ticks: total(|proof| proof.truth.moving_ticks),
        following: total(|proof| proof.following),
        in_contact: total(|proof| proof.in_contact),
        retreating: total(|proof| proof.truth.retreating),
        excused: total(|proof| proof.truth.excused_growth + proof.truth.apart_overtaken_retreat),
        least_separation_moving_m: proofs
            .iter()
            .filter_map(|proof| proof.truth.least_separation_moving_m)
            .min_by(f64::total_cmp),
        shrunk,
    })
}

/// The least of a case that still violates: not a step longer than to its first violation, and without every part that
/// it does not need.
pub fn shrink(proof: &Proof) -> Proof {
    let mut least = proof.clone();
    let parts = [Part::Scenario, Part::Faults, Part::Operator, Part::Inputs]
        .into_iter()
        .chain((0..proof.people).map(Part::Person));
    for part in parts.filter(|part| !proof.case.without.contains(part)) {
        let mut case = least.case.clone();
        case.without.push(part);
        case.steps = proof.case.steps;
        if let Ok(found) = run(&case, u64::MAX)
            && found.violations() > 0
        {
            least = found;
        }
    }
    if let Some(step) = least.violated_at {
        let case = Case { steps: step + 1, ..least.case.clone() };
        if let Ok(found) = run(&case, u64::MAX) {
            least = found;
        }
    }
    least
}

impl Part {
    /// The part of this name: operator, faults, inputs, person-0, person-1, ...
    pub fn parse(name: &str) -> Result<Self, String> {
        match name {
            "operator" => Ok(Self::Operator),
            "faults" => Ok(Self::Faults),
            "inputs" => Ok(Self::Inputs),
            "scenario" => Ok(Self::Scenario),
            other => other
                .strip_prefix("person-")
                .and_then(|number| number.parse().ok())
                .map(Self::Person)
                .ok_or_else(|| {
                    format!("\"{other}\": expected operator, faults, inputs, scenario, person-0, person-1 or person-2")
                }),
        }
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Operator => f.write_str("operator"),
            Self::Faults => f.write_str("faults"),
            Self::Inputs => f.write_str("inputs"),
            Self::Scenario => f.write_str("scenario"),
            Self::Person(number) => write!(f, "person-{number}"),
        }
    }
}

impl fmt::Display for Case {
    /// The command that replays it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "covr prove --steps {} --seed {}", self.steps, self.seed)?;
        if let Some(v_h_mps) = self.v_h_mps {
            write!(f, " --v-h {v_h_mps}")?;
        }
        for (k, part) in self.without.iter().enumerate() {
            write!(f, "{}{part}", if k == 0 { " --without " } else { "," })?;
        }
        Ok(())
    }
}

impl fmt::Display for Findings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for proof in &self.shrunk {
            writeln!(f, "{}\n  {}", proof.case, proof.told)?;
            if proof.moved_while_input > 0 {
                writeln!(
                    f,
                    "  {} ticks of motion long after an input became active",
                    proof.moved_while_input
                )?;
            }
            for violation in proof.truth.first.iter().chain(&proof.commanded.first).take(SHOWN_A_WORLD) {
                writeln!(f, "  {violation}")?;
            }
        }
        let share = |part: u64| 100.0 * part as f64 / self.steps.max(1) as f64;
        writeln!(
            f,
            "worlds {}, following {:.0} %, moving {:.0} %, in contact {:.1} %",
            self.worlds,
            share(self.following),
            share(self.moving_ticks),
            share(self.in_contact)
        )?;
        let least = self.least_separation_moving_m.map_or_else(|| "none".to_owned(), |m| format!("{m:.2} m"));
        writeln!(
            f,
            "retreating {} ticks, excused {}, least distance of a head while moving {least}",
            self.retreating, self.excused
        )?;
        writeln!(f, "steps: {} violations: {}", self.steps, self.violations)
    }
}

/// 84 s at 250 Hz.
const STEPS_A_WORLD: u64 = 21_000;
/// Violations told of one world.
const SHOWN_A_WORLD: usize = 4;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_names_the_command_that_replays_it() {
        let without = vec![Part::Faults, Part::Person(1)];
        let case = Case { seed: 7, steps: 100, v_h_mps: Some(1.6), without };
        assert_eq!(case.to_string(), "covr prove --steps 100 --seed 7 --v-h 1.6 --without faults,person-1");
        for part in [Part::Faults, Part::Operator, Part::Inputs, Part::Scenario, Part::Person(2)] {
            assert_eq!(Part::parse(&part.to_string()), Ok(part));
        }
        assert!(Part::parse("person-x").unwrap_err().contains("expected operator"));
    }

    #[test]
    fn steps_are_shared_among_worlds_to_the_last_one() {
        let campaign = Campaign { steps: 50_000, seed: 3, v_h_mps: None, without: Vec::new(), threads: 0 };
        let cases: Vec<_> = campaign.cases().iter().map(|case| (case.seed, case.steps)).collect();
        assert_eq!(cases, [(3, 21_000), (4, 21_000), (5, 8_000)]);
    }
}
