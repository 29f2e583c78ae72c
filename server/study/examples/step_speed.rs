//! How long one engine step takes, by load: `cargo run --release -p covr-study --example step_speed`.

use std::error::Error;
use std::io::Write;
use std::time::Instant;

use covr_study::workload::{Load, Workload};

/// Two minutes of people.
const STEPS: usize = 30_000;

fn main() -> Result<(), Box<dyn Error>> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "persons objects meshes |     median       p99       max   inputs p50  us")?;
    let few_meshes = |objects| Load { persons: 1, objects, meshes: 0, triangles: 0, seed: 1 };
    let growth = [50, 100, 200, 400].map(few_meshes);
    for load in [Load::USUAL, Load::GREATEST].into_iter().chain(growth) {
        let mut workload = Workload::following(&load)?;
        let (mut steps, mut inputs) = (Vec::with_capacity(STEPS), Vec::with_capacity(STEPS));
        for _ in 0..STEPS {
            let begins = Instant::now();
            workload.observe();
            let observed = Instant::now();
            workload.step();
            steps.push(observed.elapsed().as_nanos() as f64 * 1e-3);
            inputs.push((observed - begins).as_nanos() as f64 * 1e-3);
            workload.forget_events();
        }
        steps.sort_by(f64::total_cmp);
        inputs.sort_by(f64::total_cmp);
        let Load { persons, objects, meshes, .. } = load;
        let (median, p99, max) = (steps[STEPS / 2], steps[STEPS * 99 / 100], steps[STEPS - 1]);
        let inputs = inputs[STEPS / 2];
        writeln!(
            out,
            "{persons:7} {objects:7} {meshes:6} | {median:10.2} {p99:9.2} {max:9.2} {inputs:10.2}"
        )?;
    }
    Ok(())
}
