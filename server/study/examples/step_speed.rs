//! How long one engine step takes, and what others see of the engine, by load: `cargo run --release -p covr-study --example step_speed`.

use std::collections::BTreeMap;
use std::error::Error;
use std::io::Write;
use std::time::Instant;

use covr_study::workload::{Deciding, Load, Workload};
use covr_wire::dashboard::{ControlLoop, Snapshot, Surroundings};

/// Two minutes of people.
const STEPS: usize = 30_000;
/// A minute of a dashboard.
const LOOKS: u64 = 2_000;

fn main() -> Result<(), Box<dyn Error>> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "persons objects meshes |     median       p99       max   inputs p50  us")?;
    let few_meshes = |objects| Load { objects, ..Load::USUAL };
    let growth = [50, 100, 200, 400].map(few_meshes);
    let ours = |load| Load { deciding: Deciding::Ours, ..load };
    for load in
        [Load::USUAL, ours(Load::USUAL), Load::GREATEST, ours(Load::GREATEST)].into_iter().chain(growth)
    {
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
        let Load { persons, objects, meshes, deciding, .. } = load;
        let (median, p99, max) = (steps[STEPS / 2], steps[STEPS * 99 / 100], steps[STEPS - 1]);
        let inputs = inputs[STEPS / 2];
        writeln!(
            out,
            "{persons:7} {objects:7} {meshes:6} {deciding:?} | {median:10.2} {p99:9.2} {max:9.2} {inputs:10.2}"
        )?;
    }
    let looks = "snapshot JSON bytes |   snapshot   wire+JSON     outlook        path   preview  us, median; path p90";
    writeln!(out, "persons objects meshes {looks}")?;
    for load in [Load::USUAL, ours(Load::USUAL), Load::GREATEST, ours(Load::GREATEST)] {
        look(&load, &mut out)?;
    }
    Ok(())
}

/// What others see of the engine, thirty times a second.
fn look(load: &Load, out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let mut workload = Workload::following(load)?;
    let (names, mut bytes) = (BTreeMap::new(), 0);
    let mut times: [Vec<f64>; 5] = Default::default();
    for generation in 0..LOOKS {
        workload.run(8);
        let control_loop = ControlLoop {
            rate_hz: 250.0,
            steps: generation,
            missed_deadlines: 0,
            lateness_p99_micros: 80.0,
            lateness_max_micros: 120.0,
            scheduling: "normal".into(),
            scheduling_why: Vec::new(),
        };
        let clients = Vec::new();
        let around = Surroundings {
            generation,
            names: &names,
            control_loop,
            machine_health: None,
            clients,
            scene_id: Some(1),
            session_id: None,
        };
        let begins = Instant::now();
        let state = workload.engine().snapshot(workload.now());
        let snapshot = Instant::now();
        bytes = serde_json::to_string(&Snapshot::new(&state, around))?.len();
        let written = Instant::now();
        let outlook = workload.engine().outlook(workload.now());
        let copied = Instant::now();
        std::hint::black_box(outlook.path());
        let planned = Instant::now();
        std::hint::black_box(outlook.with_priors(&vec![0.5; load.objects as usize]));
        let ends = [snapshot, written, copied, planned, Instant::now()];
        let micros = |from: Instant, to: Instant| (to - from).as_nanos() as f64 * 1e-3;
        let starts = [begins, snapshot, written, copied, planned];
        for ((times, from), to) in times.iter_mut().zip(starts).zip(ends) {
            times.push(micros(from, to));
        }
    }
    times.iter_mut().for_each(|times| times.sort_by(f64::total_cmp));
    let path_p90 = times[3][LOOKS as usize * 9 / 10];
    let [snapshot, written, outlook, path, preview] = times.map(|times| times[LOOKS as usize / 2]);
    let Load { persons, objects, meshes, deciding, .. } = load;
    writeln!(
        out,
        "{persons:7} {objects:7} {meshes:6} {deciding:?} {bytes:13} | {snapshot:10.2} {written:11.2} {outlook:11.2} {path:11.2} \
         {preview:9.2}  {path_p90:10.2}"
    )?;
    Ok(())
}
