//! The control thread and the ways to it.
//!
//! One thread (not an async task) owns engine and gantry: read, update, write at a fixed rate. Everyone else
//! sends messages; control never waits for a client, a disk, a database or a log line. When the thread ends
//! for any reason the machine is told to stop, and the process learns of it through [`Control::ended`].

mod inbox;
mod lateness;
pub mod real_time;
mod stop_lane;
#[cfg(test)]
mod tests;
mod thread;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{SyncSender, TrySendError};
use std::time::{Duration, Instant};

use covr_engine::event::Event;
use covr_engine::observation::{Observation, PersonId, PoseSample};
use covr_engine::scene::Scene;
use covr_engine::snapshot::Snapshot;
use covr_engine::{Answer, Engine, Outlook, Request};
use covr_gantry::contract::{Gantry, Health};
use covr_wire::dashboard::ControlLoop;
use covr_wire::reason::Reason;
use tokio::sync::{mpsc, oneshot, watch};

pub use stop_lane::{NotReached, StopLane, StopLaneName};

use crate::clock::Clock;
use crate::inputs::InputLines;
use crate::recorder::Record;
use inbox::{Ask, Fact};

/// What the control thread is started with.
pub struct Setup {
    /// Decides.
    pub engine: Engine,
    /// Moves.
    pub gantry: Box<dyn Gantry>,
    /// The digital inputs.
    pub inputs: InputLines,
    /// The server's clock.
    pub clock: Clock,
    /// Control period.
    pub period: Duration,
    /// Time between published snapshots.
    pub publish_every: Duration,
    /// SCHED_FIFO priority to ask for, with locked memory; none: do not ask.
    pub real_time_priority: Option<u8>,
    /// Requests that may wait.
    pub request_queue: usize,
    /// Where events go; full: the event is dropped and counted.
    pub events: mpsc::Sender<Record>,
}

/// An event with the scene that its indices mean.
#[derive(Debug, Clone)]
pub struct EngineEvent {
    /// What happened.
    pub event: Event,
    /// The scene in force.
    pub scene: Arc<Scene>,
}

/// The whole published state.
#[derive(Debug, Clone)]
pub struct Published {
    /// Grows by one with each.
    pub generation: u64,
    /// The engine's state.
    pub snapshot: Snapshot,
    /// The scene in force.
    pub scene: Arc<Scene>,
    /// What the engine decides with, for those who look ahead. Whoever does pays for it on a thread of their own.
    pub outlook: Outlook,
    /// The loop's health.
    pub control_loop: ControlLoop,
    /// The machine's boards and link; none for a machine without any.
    pub machine_health: Option<Arc<Health>>,
}

/// How the control thread ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ended {
    /// It was asked to.
    AsAsked,
    /// It panicked; the machine was told to stop.
    Panicked(String),
}

/// Why a message did not get through.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotDelivered {
    /// It was refused before the control thread was asked.
    #[error("{0}")]
    NotAsked(Box<Reason>),
    /// The queue is full.
    #[error("busy: the control loop's queue is full; try again")]
    Busy,
    /// The control thread is not running.
    #[error("the control loop is not running")]
    NotRunning,
}

impl NotDelivered {
    /// For whoever asked.
    pub fn reason(self) -> Reason {
        match self {
            Self::NotAsked(why) => *why,
            Self::Busy => Reason::Busy,
            Self::NotRunning => Reason::ControlNotRunning,
        }
    }
}

/// The ways to the control thread. Cheap to clone.
#[derive(Debug, Clone)]
pub struct Control {
    asks: SyncSender<Ask>,
    facts: SyncSender<Fact>,
    stops: Arc<[StopLane; 4]>,
    game_masters: Arc<AtomicUsize>,
    quit: Arc<AtomicBool>,
    events_dropped: Arc<AtomicU64>,
    published: watch::Receiver<Arc<Published>>,
    ended: watch::Receiver<Option<Ended>>,
}

/// Where one headset puts its newest pose. Wait-free; a newer pose replaces an unread one.
#[derive(Debug)]
pub struct PoseSlot(triple_buffer::Input<Option<PoseSample>>);

/// One game master at a dashboard (R11), until it is dropped.
#[derive(Debug)]
pub struct GameMasterThere(Arc<AtomicUsize>);

impl Control {
    /// Start the thread. The machine is read once before this returns, so that a snapshot is there.
    pub fn start(setup: Setup) -> std::io::Result<Self> {
        thread::start(setup)
    }

    /// Ask, and wait for the answer.
    pub async fn ask(&self, request: Request) -> Result<Answer, NotDelivered> {
        self.put(request)?.await.map_err(|_| NotDelivered::NotRunning)
    }

    /// Put a request into the queue; its answer comes later. Requests put one after another are answered so.
    pub fn put(&self, request: Request) -> Result<oneshot::Receiver<Answer>, NotDelivered> {
        let (reply, answer) = oneshot::channel();
        self.asks.try_send(Ask { request, reply }).map_err(not_delivered)?;
        Ok(answer)
    }

    /// Pull a stop lane, and wait until the braking command is written to the drive: the time from
    /// `received_at` to that.
    pub async fn stop(
        &self,
        lane: StopLaneName,
        reason: String,
        received_at: Instant,
    ) -> Result<Duration, NotReached> {
        self.stop_lane(lane).press(reason, received_at).await
    }

    /// Tell a fact about a person.
    pub fn tell(&self, observation: Observation) -> Result<(), NotDelivered> {
        self.facts.try_send(Fact::Seen(observation)).map_err(not_delivered)
    }

    /// A game master is at a dashboard, for as long as the answer is kept.
    pub fn seat_game_master(&self) -> GameMasterThere {
        self.game_masters.fetch_add(1, Ordering::AcqRel);
        GameMasterThere(self.game_masters.clone())
    }

    /// Connect a headset: its poses are read from the slot from now on.
    pub fn connect_headset(&self, person: PersonId) -> Result<PoseSlot, NotDelivered> {
        let (input, output) = triple_buffer::triple_buffer(&None);
        self.facts.try_send(Fact::Headset(person, output)).map_err(not_delivered)?;
        Ok(PoseSlot(input))
    }

    /// The newest published state.
    pub fn published(&self) -> Arc<Published> {
        self.published.borrow().clone()
    }

    /// To wait for newer states.
    pub fn watch_published(&self) -> watch::Receiver<Arc<Published>> {
        self.published.clone()
    }

    /// Whether the thread runs.
    pub fn is_running(&self) -> bool {
        self.ended.borrow().is_none()
    }

    /// Wait for the end of the thread.
    pub async fn ended(&self) -> Ended {
        let mut ended = self.ended.clone();
        match ended.wait_for(Option::is_some).await.map(|end| end.clone()) {
            Ok(Some(end)) => end,
            _ => Ended::Panicked("the control thread vanished".into()),
        }
    }

    /// End the thread. The machine is left held, or released if it was.
    pub fn quit(&self) {
        self.quit.store(true, Ordering::Release);
    }

    /// Events that found their queue full.
    pub fn events_dropped(&self) -> u64 {
        self.events_dropped.load(Ordering::Relaxed)
    }

    fn stop_lane(&self, name: StopLaneName) -> &StopLane {
        &self.stops[name as usize]
    }
}

impl Drop for GameMasterThere {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

impl PoseSlot {
    /// Put the newest pose.
    pub fn put(&mut self, pose: PoseSample) {
        self.0.write(Some(pose));
    }
}

fn not_delivered<T>(error: TrySendError<T>) -> NotDelivered {
    match error {
        TrySendError::Full(_) => NotDelivered::Busy,
        TrySendError::Disconnected(_) => NotDelivered::NotRunning,
    }
}
