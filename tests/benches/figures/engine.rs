//! One step of the engine: a usual scene, the greatest that is promised, and how it grows with objects.

use std::time::Instant;

use covr_study::workload::{Deciding, Load, Workload};

use crate::Effort;
use crate::samples::Samples;
use crate::table::Row;

/// The rows of the engine.
pub fn measure(effort: Effort) -> Vec<Row> {
    let steps = effort.of(20_000, 200);
    const GREATEST: &str = "5 persons, 200 objects, 20 of them meshes of 5,000 triangles";
    let ours = |load| Load { deciding: Deciding::Ours, ..load };
    let paper = "engine step, the paper's rule and proxy";
    let full = "full engine step, bayes + planner + standing";
    let mut rows = vec![
        row(&format!("{paper}, 1 person, 10 objects"), &Load::USUAL, steps, (20.0, None)),
        row(&format!("{paper}, {GREATEST}"), &Load::GREATEST, steps / 4, (500.0, None)),
        row(&format!("{full}, 1 person, 10 objects"), &ours(Load::USUAL), steps, (50.0, Some(200.0))),
        row(&format!("{full}, {GREATEST}"), &ours(Load::GREATEST), steps / 4, (500.0, None)),
    ];
    rows.push(growth(effort));
    rows
}

/// The limits are those of the median and, where there is one, of the 99th percentile, us.
fn row(what: &str, load: &Load, steps: u32, (limit_micros, p99_micros): (f64, Option<f64>)) -> Row {
    let mut workload = Workload::following(load).unwrap();
    workload.run(WARM_UP_STEPS);
    let took = times(&mut workload, steps);
    let (median, p99) = (took.median(), took.percentile(0.99));
    let p99_limit =
        p99_micros.map_or_else(String::new, |limit| format!(", 99th percentile under {limit} us"));
    Row {
        what: what.into(),
        figure: format!("median {median:.1} us"),
        beside: format!("99th percentile {p99:.1} us"),
        ratio: format!("{:.2}", median / limit_micros),
        limit: format!("median under {limit_micros} us{p99_limit}"),
        met: Some(median < limit_micros && p99_micros.is_none_or(|limit| p99 < limit)),
        how: format!("{steps} steps after {WARM_UP_STEPS} to warm up; people walk and reach, ideal machine"),
    }
}

/// All sizes turn and turn about, so that a change of the processor's clock meets them alike.
fn growth(effort: Effort) -> Row {
    let (rounds, steps) = effort.of((10, 1_000), (1, 50));
    let mut sizes: Vec<(u32, Workload, Samples)> = SIZES
        .iter()
        .map(|objects| {
            let mut workload = Workload::following(&Load { objects: *objects, ..Load::USUAL }).unwrap();
            workload.run(WARM_UP_STEPS);
            (*objects, workload, Samples::default())
        })
        .collect();
    for _ in 0..rounds {
        for (_, workload, took) in &mut sizes {
            times(workload, steps).iter().for_each(|micros| took.add(micros));
        }
    }
    let medians: Vec<(f64, f64)> =
        sizes.iter().map(|(objects, _, took)| (f64::from(*objects), took.median())).collect();
    // Linear would be 1: so many times the objects, so many times the time.
    let steepest =
        medians.windows(2).map(|pair| (pair[1].1 / pair[0].1) / (pair[1].0 / pair[0].0)).fold(0.0, f64::max);
    let shown = |of: &dyn Fn(&(f64, f64)) -> String| medians.iter().map(of).collect::<Vec<_>>().join(", ");
    Row {
        what: "growth of the step with objects".into(),
        figure: shown(&|(objects, micros)| format!("{objects}: {micros:.1} us")),
        beside: shown(&|(objects, micros)| format!("{objects}: {:.2} us an object", micros / objects)),
        ratio: format!("steepest {steepest:.2}"),
        limit: "at most linear: 1".into(),
        met: Some(steepest <= 1.0),
        how: format!(
            "1 person, no meshes; medians of {} steps a size, {rounds} rounds turn about",
            rounds * steps
        ),
    }
}

fn times(workload: &mut Workload, steps: u32) -> Samples {
    (0..steps)
        .map(|_| {
            workload.observe();
            let began = Instant::now();
            let command = workload.step();
            let took = began.elapsed();
            std::hint::black_box(command);
            workload.forget_events();
            took.as_secs_f64() * 1e6
        })
        .collect()
}

const WARM_UP_STEPS: u32 = 500;
const SIZES: &[u32] = &[10, 20, 50, 100, 200];
