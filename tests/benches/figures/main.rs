//! Every figure that the server promises, measured on this machine and put into one table: `make bench`.
//!
//! What a figure is held against (a bare echo server, a bare sleeping thread) is measured in the same run, turn and
//! turn about, in this process and on the same runtime. Nothing here is asserted: a figure that falls short says so in
//! the table, and the program ends well all the same. `-- --quick` takes few samples, to see that everything runs;
//! `-- --only engine,stop` measures some figures; `-- --out FILE` says where the table goes.

#![allow(clippy::unwrap_used, reason = "in a benchmark a panic is the report")]

mod bed;
mod boards;
mod browser;
mod echo;
mod engine;
mod ingest;
mod latency;
mod lateness;
mod process;
mod reactions;
mod samples;
mod scenario;
mod stop;
mod table;

use std::io::Write as _;

use table::{Machine, Row};

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Enough for percentiles that hold.
    Full,
    /// Enough to see that it runs.
    Quick,
}

impl Effort {
    /// The first in full, the second when quick.
    pub fn of<T>(self, full: T, quick: T) -> T {
        match self {
            Self::Full => full,
            Self::Quick => quick,
        }
    }
}

struct Options {
    effort: Effort,
    only: Option<Vec<String>>,
    out: Option<String>,
}

/// What the figures share: the lateness of the control loop is part of the limit of the stop.
#[derive(Debug, Default)]
pub struct Known {
    /// 99.9th percentile of the control loop's lateness with nobody watching, us.
    pub lateness_p999_micros: Option<f64>,
}

fn main() {
    let options = options();
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().unwrap();
    let mut known = Known::default();
    let mut rows: Vec<Row> = Vec::new();
    for name in FIGURES {
        if options.only.as_ref().is_some_and(|only| !only.iter().any(|wanted| wanted == name)) {
            continue;
        }
        say(&format!("measuring {name} ..."));
        let effort = options.effort;
        let measured = match *name {
            "engine" => engine::measure(effort),
            "scenario" => scenario::measure(effort),
            "latency" => runtime.block_on(latency::measure(effort)),
            "ingest" => runtime.block_on(ingest::measure(effort)),
            "lateness" => runtime.block_on(lateness::measure(effort, &mut known)),
            "stop" => runtime.block_on(stop::measure(effort, &known)),
            "reactions" => runtime.block_on(reactions::measure(effort)),
            "boards" => boards::measure(effort),
            "process" => runtime.block_on(process::measure(effort)),
            "browser" => runtime.block_on(browser::measure(effort)),
            other => unreachable!("{other} is in FIGURES alone"),
        };
        for row in measured {
            say(&format!("  {}", row.in_a_line()));
            rows.push(row);
        }
    }
    let text = table::markdown(&rows, &Machine::this(), options.effort);
    say(&format!("\n{text}"));
    if let Some(path) = options.out {
        let before = std::fs::read_to_string(&path).unwrap_or_default();
        let text = match table::kept(&before) {
            "" => text,
            kept => format!("{text}\n{kept}"),
        };
        std::fs::write(&path, text).unwrap_or_else(|why| panic!("cannot write {path}: {why}"));
    }
}

fn options() -> Options {
    let mut options = Options { effort: Effort::Full, only: None, out: None };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_else(|| panic!("{word} needs a value"));
        match word.as_str() {
            "--quick" => options.effort = Effort::Quick,
            "--only" => {
                let names: Vec<String> = value().split(',').map(str::to_owned).collect();
                for name in &names {
                    assert!(FIGURES.contains(&name.as_str()), "no figure {name}; expected of {FIGURES:?}");
                }
                options.only = Some(names);
            }
            "--out" => options.out = Some(value()),
            // What cargo bench itself says.
            "--bench" => {}
            other => panic!("unknown option {other}; expected --quick, --only NAMES, --out FILE"),
        }
    }
    options
}

fn say(text: &str) {
    let _ = writeln!(std::io::stdout().lock(), "{text}");
}

const FIGURES: &[&str] = &[
    "engine",
    "scenario",
    "latency",
    "ingest",
    "lateness",
    "stop",
    "reactions",
    "boards",
    "process",
    "browser",
];
