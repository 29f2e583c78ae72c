//! One row for each figure, and the table of all.

use std::fmt::Write as _;
use std::process::Command;

use crate::Effort;

/// One figure.
#[derive(Debug, Clone)]
pub struct Row {
    /// What was measured.
    pub what: String,
    /// What came out, with its unit.
    pub figure: String,
    /// What was measured beside it.
    pub beside: String,
    /// Figure over limit or over what was measured beside it.
    pub ratio: String,
    /// What must be reached.
    pub limit: String,
    /// Whether it is; none: not measured, or without a target.
    pub met: Option<bool>,
    /// Samples, and how.
    pub how: String,
}

/// The machine that all was measured on. It has no name here.
#[derive(Debug)]
pub struct Machine {
    cores: usize,
    model: String,
    kernel: String,
    rustc: String,
}

impl Row {
    /// A figure that could not be measured, and why.
    pub fn skipped(what: &str, limit: &str, why: &str) -> Self {
        Self {
            what: what.into(),
            figure: "not measured".into(),
            beside: String::new(),
            ratio: String::new(),
            limit: limit.into(),
            met: None,
            how: why.into(),
        }
    }

    /// For the terminal while it runs.
    pub fn in_a_line(&self) -> String {
        format!("{}: {} (limit {}): {}", self.what, self.figure, self.limit, self.verdict())
    }

    fn verdict(&self) -> &'static str {
        match self.met {
            Some(true) => "met",
            Some(false) => "**falls short**",
            None => "-",
        }
    }
}

impl Machine {
    /// This one.
    pub fn this() -> Self {
        let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let model = cpu.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": ")?.1.into());
        let rustc = Command::new("rustc").arg("--version").output();
        Self {
            cores: std::thread::available_parallelism().map_or(0, usize::from),
            model: model.unwrap_or("unknown").to_owned(),
            kernel: std::fs::read_to_string("/proc/sys/kernel/osrelease")
                .map_or_else(|_| "unknown".into(), |release| release.trim().to_owned()),
            rustc: rustc.map_or_else(
                |_| "unknown".into(),
                |out| String::from_utf8_lossy(&out.stdout).trim().to_owned(),
            ),
        }
    }
}

/// What a file has from the heading on under which `covr evaluate` is reported: `make bench` does not measure it, so it
/// stays.
pub fn kept(file: &str) -> &str {
    file.find(KEPT_FROM).map_or("", |at| &file[at + 1..])
}

/// At the beginning of a line.
const KEPT_FROM: &str = "\n## Recorded people";

/// The whole table as Markdown.
pub fn markdown(rows: &[Row], machine: &Machine, effort: Effort) -> String {
    let Machine { cores, model, kernel, rustc } = machine;
    let profile = if cfg!(debug_assertions) { "not optimised" } else { "release profile" };
    let mut text = format!(
        "# Benchmarks\n\nWritten by `make bench`. {cores} cores of {model}, Linux {kernel}, {rustc}, {profile}.\n"
    );
    if effort == Effort::Quick {
        text.push_str("\n**A quick run: too few samples to hold anything against.**\n");
    }
    text.push_str("\n| what | figure | measured beside it | ratio | must be | met | samples and method |\n");
    text.push_str("|---|---|---|---|---|---|---|\n");
    for row in rows {
        let Row { what, figure, beside, ratio, limit, how, .. } = row;
        let verdict = row.verdict();
        let _ = writeln!(text, "| {what} | {figure} | {beside} | {ratio} | {limit} | {verdict} | {how} |");
    }
    text
}
