//! A lane for the software stop that shares nothing with any other: a counter of presses, which the control
//! thread reads each tick, and the newest reason beside it. It cannot be full.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use arc_swap::ArcSwap;
use covr_wire::reason::Reason;
use tokio::sync::watch;

/// Where a stop came from. Each has a lane of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopLaneName {
    /// `POST /api/v1/stop`.
    Http,
    /// A dashboard's WebSocket.
    Dashboard,
    /// SIGUSR1.
    Signal,
    /// The server itself.
    Server,
}

/// The stop did not reach the drive in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("no acknowledgement from the drive within {} ms; use the wired stop", .0.as_millis())]
pub struct NotReached(Duration);

impl NotReached {
    /// For whoever pressed.
    pub fn reason(self) -> Reason {
        Reason::DriveSilent { within_millis: self.0.as_millis() as u64 }
    }
}

/// One lane.
#[derive(Debug)]
pub struct StopLane {
    presses: AtomicU64,
    reason: ArcSwap<String>,
    written: watch::Sender<Option<Written>>,
}

/// The braking command for all presses up to `presses` was written at `at`.
#[derive(Debug, Clone, Copy)]
struct Written {
    presses: u64,
    at: Instant,
}

impl StopLaneName {
    /// Every lane.
    pub const ALL: [Self; 4] = [Self::Http, Self::Dashboard, Self::Signal, Self::Server];

    /// The name on every surface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Http => "http",
            Self::Dashboard => "dashboard",
            Self::Signal => "signal",
            Self::Server => "server",
        }
    }
}

impl Default for StopLane {
    /// A lane that nobody has pressed.
    fn default() -> Self {
        Self {
            presses: AtomicU64::new(0),
            reason: ArcSwap::from_pointee(String::new()),
            written: watch::Sender::new(None),
        }
    }
}

impl StopLane {
    /// Press, and wait for the drive.
    pub async fn press(&self, reason: String, received_at: Instant) -> Result<Duration, NotReached> {
        self.reason.store(reason.into());
        let press = self.presses.fetch_add(1, Ordering::AcqRel) + 1;
        let mut written = self.written.subscribe();
        let reached = written.wait_for(|w| w.is_some_and(|w| w.presses >= press));
        match tokio::time::timeout(LONGEST_WAIT, reached).await {
            Ok(Ok(written)) => {
                Ok(written.map_or(Duration::ZERO, |w| w.at.saturating_duration_since(received_at)))
            }
            _ => Err(NotReached(LONGEST_WAIT)),
        }
    }

    /// For the control thread: presses so far.
    pub fn presses(&self) -> u64 {
        self.presses.load(Ordering::Acquire)
    }

    /// For the control thread: the newest reason.
    pub fn reason(&self) -> String {
        self.reason.load().to_string()
    }

    /// For the control thread: the braking command for these presses was written.
    pub fn acknowledge(&self, presses: u64, at: Instant) {
        self.written.send_replace(Some(Written { presses, at }));
    }
}

/// A second is two hundred and fifty control periods.
pub(super) const LONGEST_WAIT: Duration = Duration::from_secs(1);

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_press_is_acknowledged_by_the_write_that_covers_it() {
        let lane = std::sync::Arc::new(StopLane::default());
        let received_at = Instant::now();
        let press = tokio::spawn({
            let lane = lane.clone();
            async move { lane.press("hand in the way".into(), received_at).await }
        });
        while lane.presses() == 0 {
            tokio::task::yield_now().await;
        }
        assert_eq!(lane.reason(), "hand in the way");
        lane.acknowledge(0, received_at);
        tokio::task::yield_now().await;
        assert!(!press.is_finished(), "an older write must not acknowledge a newer press");
        lane.acknowledge(1, received_at + Duration::from_micros(700));
        assert_eq!(press.await.unwrap(), Ok(Duration::from_micros(700)));
    }

    #[tokio::test]
    async fn a_drive_that_does_not_answer_is_said() {
        let lane = StopLane::default();
        assert!(lane.press(String::new(), Instant::now()).await.is_err());
    }
}
