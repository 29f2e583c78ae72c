//! The whole loop on virtual time against people at their worst: what `covr prove` does, in four parts for two cores.
//!
//! A failure names the least command that shows it.

mod played;
mod served;

use covr_study::prove::{Campaign, Case, Part, prove, run};

/// A quarter of the million steps.
fn quarter(seed: u64) {
    let campaign = Campaign { steps: 252_000, seed, v_h_mps: None, without: Vec::new(), threads: 1 };
    let findings = prove(&campaign, &|_| ()).expect("every world can be brought up");
    eprintln!("{findings}");
    assert_eq!(findings.violations, 0, "{findings}");
    let share = findings.moving_ticks as f64 / findings.steps as f64;
    assert!(share > 0.1, "the column moved in {share:.3} of the ticks: this proves nothing");
    assert!(findings.excused + findings.retreating > 0, "nobody ever came near");
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

/// Found by campaigns, as they were shrunk: each ended with a violation once.
#[test]
fn what_campaigns_found_stays_mended() {
    // Somebody appears beside a column that speeds up in the moment in which the link to it dies.
    let link_dies = Case { seed: 70_205, steps: 8_363, v_h_mps: None, without: vec![Part::Person(0)] };
    let proof = run(&link_dies, u64::MAX).unwrap();
    assert_eq!(proof.violations(), 0, "{link_dies}: {:?}", proof.truth.first);
}

#[test]
fn the_same_seed_gives_the_same_commands_snapshots_and_events_bit_for_bit() {
    for seed in 100..104 {
        let case = |seed| Case { seed, steps: 4_000, v_h_mps: None, without: Vec::new() };
        let first = run(&case(seed), 1).unwrap();
        assert_eq!(first, run(&case(seed), 1).unwrap(), "seed {seed}");
        assert_ne!(first.digest, run(&case(seed + 1000), 1).unwrap().digest);
    }
}
