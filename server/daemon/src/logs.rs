//! Structured logs on standard error, written by a thread of their own: a log line never holds anybody up.

use std::io::IsTerminal;

use tracing_appender::non_blocking::WorkerGuard;
use tracing_subscriber::EnvFilter;

use crate::config::{Log, LogFormat};

/// Start logging; lines are written out until the guard is dropped.
pub fn start(log: &Log) -> anyhow::Result<WorkerGuard> {
    let filter = EnvFilter::try_new(&log.level).map_err(|why| {
        anyhow::anyhow!("log.level: found {:?}, expected a level or directives ({why})", log.level)
    })?;
    let (writer, guard) = tracing_appender::non_blocking(std::io::stderr());
    let builder = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_ansi(std::io::stderr().is_terminal())
        .with_writer(writer);
    let done = match log.format {
        LogFormat::Text => builder.with_target(false).try_init(),
        LogFormat::Json => builder.json().flatten_event(true).with_current_span(true).try_init(),
    };
    done.map_err(|why| anyhow::anyhow!("logs: {why}"))?;
    Ok(guard)
}
