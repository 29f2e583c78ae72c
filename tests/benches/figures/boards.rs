//! How often emulated RoboClaw boards are told and looked at over a pseudo-terminal, beside what the bytes of a cycle allow.

use std::time::{Duration, Instant};

use covr_engine::safety::vetted::{Action, ArenaConfirmedClear, Vetted};
use covr_gantry::contract::{Gantry, LinkFigures};
use covr_tests::boards::Boards;

use crate::Effort;
use crate::samples::Samples;
use crate::table::Row;

/// A row a rate: cycles a second, and one for their time.
pub fn measure(effort: Effort) -> Vec<Row> {
    [115_200, 460_800].into_iter().flat_map(|baud| at(baud, effort)).collect()
}

fn at(baud: usize, effort: Effort) -> [Row; 2] {
    let mut boards = Boards::emulated(&[], baud, 0);
    drive(&mut boards, Duration::from_secs(1), &mut Samples::default());
    let before = figures(&boards);
    let began = Instant::now();
    let mut medians = Samples::default();
    drive(&mut boards, Duration::from_secs(effort.of(30, 2)), &mut medians);
    let (after, secs) = (figures(&boards), began.elapsed().as_secs_f64());
    let cycles = (after.cycles - before.cycles).max(1);
    let bytes = (after.bytes - before.bytes) as f64 / cycles as f64;
    let rate_hz = cycles as f64 / secs;
    // A byte is ten bits on the line, and a cycle is begun once a period at most.
    let (line_micros, asked_hz) = (bytes * 10.0 / baud as f64 * 1e6, 1.0 / PERIOD.as_secs_f64());
    let most_hz = asked_hz.min(1e6 / line_micros);
    let lost = after.lost - before.lost;
    let how = format!(
        "{cycles} cycles of {bytes:.0} bytes, {lost} exchanges lost, {secs:.0} s; holding, 250 orders a second"
    );
    let row = |what: &str, figure: String, beside: String, ratio: f64| Row {
        what: format!("RoboClaw at {baud} baud: {what}"),
        figure,
        beside,
        ratio: format!("{ratio:.2}"),
        limit: String::new(),
        met: None,
        how: how.clone(),
    };
    let median = medians.percentile(0.5);
    [
        row(
            "cycles a second",
            format!("{rate_hz:.0}"),
            format!("{most_hz:.0} by the bytes and the orders"),
            rate_hz / most_hz,
        ),
        row(
            "time of a cycle, median",
            format!("{:.2} ms", median / 1e3),
            format!("{:.2} ms by the bytes", line_micros / 1e3),
            median / line_micros,
        ),
    ]
}

/// Hold for so long, 250 times a second; the median time of a cycle as it is shown, each half second.
fn drive(boards: &mut Boards, length: Duration, medians: &mut Samples) {
    let (mut due, end) = (Instant::now(), Instant::now() + length);
    let mut shown = figures(boards).cycles;
    while due < end {
        let now = boards.now();
        let clear = ArenaConfirmedClear::by_a_person_who_looked();
        let (limits, travel) = (boards.machine.limits(), boards.machine.travel());
        let hold = Vetted::on_clear_course(clear, now, Action::Hold, &limits, &travel).unwrap();
        // What is lost is counted by the link.
        let _ = boards.machine.write(now, &hold);
        boards.machine.read(now);
        let link = figures(boards);
        if link.cycles != shown {
            shown = link.cycles;
            medians.add(link.cycle_p50_micros);
        }
        due += PERIOD;
        std::thread::sleep(due.saturating_duration_since(Instant::now()));
    }
}

fn figures(boards: &Boards) -> LinkFigures {
    boards.machine.health().map_or_else(LinkFigures::default, |health| health.link.clone())
}

const PERIOD: Duration = Duration::from_millis(4);
