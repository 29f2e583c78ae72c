//! The whole loop on virtual time against people at their worst.
//!
//! A failure names its seed; `COVR_SEED=<seed>` runs that one alone.

mod adversary;
mod proof;
mod served;
mod world;

use proof::{Proof, run};

/// Worlds of a quarter, and steps in each: 4 * 12 * 21 000 is a little over a million.
const WORLDS: u64 = 12;
const STEPS: u64 = 21_000;

/// Run a quarter of the million and judge it.
fn quarter(first_seed: u64) {
    let seeds: Vec<u64> = match std::env::var("COVR_SEED") {
        Ok(seed) => vec![seed.parse().expect("COVR_SEED is a whole number")],
        Err(_) => (first_seed..first_seed + WORLDS).collect(),
    };
    let proofs: Vec<Proof> = seeds.iter().map(|&seed| run(seed, STEPS, 50)).collect();
    let mut failed = Vec::new();
    for proof in &proofs {
        let (truth, commanded) = (&proof.truth, &proof.commanded);
        let told = format!(
            "seed {}: following {:.0} %, moving {:.0} %, retreating {}, excused {}, overtaken {}, least {:.2?} m; {}",
            proof.seed,
            100.0 * proof.following as f64 / STEPS as f64,
            100.0 * truth.moving_ticks as f64 / truth.ticks as f64,
            truth.retreating,
            truth.excused_growth,
            truth.apart_overtaken_retreat,
            truth.least_separation_moving_m,
            proof.told
        );
        eprintln!("{told}");
        if truth.violations() + commanded.violations() > 0 {
            failed.push(proof.seed);
            for (track, verdict) in [("true", truth), ("commanded", commanded)] {
                eprintln!(
                    "  {track}: separation {}, travel {} and {} outside, speed {}, acceleration {}, jerk {}",
                    verdict.separation,
                    verdict.travel_margin,
                    verdict.travel_outside,
                    verdict.speed,
                    verdict.acceleration,
                    verdict.jerk
                );
                verdict.first.iter().for_each(|violation| eprintln!("    {violation}"));
            }
        }
    }
    assert!(failed.is_empty(), "violations with the seeds {failed:?}; replay one with COVR_SEED=<seed>");
    let total = |of: fn(&Proof) -> u64| proofs.iter().map(of).sum::<u64>();
    let share = total(|proof| proof.truth.moving_ticks) as f64 / total(|proof| proof.truth.ticks) as f64;
    assert!(share > 0.1, "the column moved in {share:.3} of the ticks: this proves nothing");
    assert!(total(|proof| proof.truth.excused_growth + proof.truth.retreating) > 0, "nobody ever came near");
}

#[test]
fn no_violation_in_a_million_steps_first_quarter() {
    quarter(1_000);
}

#[test]
fn no_violation_in_a_million_steps_second_quarter() {
    quarter(2_000);
}

#[test]
fn no_violation_in_a_million_steps_third_quarter() {
    quarter(3_000);
}

#[test]
fn no_violation_in_a_million_steps_fourth_quarter() {
    quarter(4_000);
}

#[test]
fn the_same_seed_gives_the_same_commands_snapshots_and_events_bit_for_bit() {
    for seed in 100..104 {
        let first = run(seed, 4_000, 1);
        assert_eq!(first, run(seed, 4_000, 1), "seed {seed}");
        assert_ne!(first.digest, run(seed + 1000, 4_000, 1).digest);
    }
}
