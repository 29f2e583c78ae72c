//! The recorder: takes events from a bounded queue, shows them to dashboards at once, and stores them in order.
//! It alone writes sessions and the latch, so that they follow the order of events.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use covr_engine::event::EventKind;
use covr_engine::mode::Mode;
use covr_engine::time::Time;
use covr_wire::dashboard::{Event, MachineShape};
use covr_wire::reason::{Reason, latch_record};
use serde_json::Value;
use tokio::sync::{broadcast, mpsc, oneshot, watch};

use crate::clock::Clock;
use crate::control::EngineEvent;
use crate::inputs::{self, InputStop};
use crate::meters;
use crate::persons::Persons;
use crate::stage::Stage;
use crate::store::{NewEvent, NewSession, SessionEnd, Store, StoreError};

/// Something for the record.
#[derive(Debug)]
pub enum Record {
    /// From the engine.
    Engine(EngineEvent),
    /// From whoever carried a request, a change or a message.
    Act(Event),
    /// A digital input stopped the machine; the time until the braking command was at the drive, if one was taken.
    InputStop(InputStop, Option<Duration>),
    /// Say when everything before this is stored.
    Settle(oneshot::Sender<Settled>),
    /// Say which sessions ran, by the events before this.
    Spans(oneshot::Sender<Vec<SessionSpan>>),
    /// The server ends: close the session.
    End(oneshot::Sender<Settled>),
}

/// When a session ran, server time in microseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SessionSpan {
    /// The store's number of the session.
    pub id: i64,
    /// Its first moment.
    pub from_micros: i64,
    /// Its last moment; none while it runs.
    pub to_micros: Option<i64>,
}

/// Whether everything before was stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Settled {
    /// It survives kill -9.
    Stored,
    /// Something could not be stored; the log says what.
    Lost,
}

/// The way to the recorder. Cheap to clone.
#[derive(Debug, Clone)]
pub struct Recorder {
    records: mpsc::Sender<Record>,
    live: broadcast::Sender<Arc<Event>>,
    session: watch::Receiver<Option<i64>>,
    dropped: Arc<AtomicU64>,
    clock: Clock,
}

/// What the recorder works with.
pub struct Desk {
    /// Where it writes.
    pub store: Store,
    /// The server's clock.
    pub clock: Clock,
    /// Names of people.
    pub persons: Arc<Persons>,
    /// The active scene.
    pub stage: Arc<Stage>,
    /// Column and travel.
    pub machine_shape: MachineShape,
}

impl Recorder {
    /// Start the recorder's task. The sender is for the control thread.
    pub fn start(desk: Desk, live_queue: usize) -> (Self, mpsc::Sender<Record>) {
        let (records, records_out) = mpsc::channel(QUEUE);
        let (live, _) = broadcast::channel(live_queue);
        let session = watch::Sender::new(None);
        let recorder = Self {
            records: records.clone(),
            live: live.clone(),
            session: session.subscribe(),
            dropped: Arc::default(),
            clock: desk.clock,
        };
        tokio::spawn(
            Task { desk, live, session, spans: VecDeque::new(), pending: Vec::new(), lost: false }
                .run(records_out),
        );
        (recorder, records)
    }

    /// Record an act; with the queue full it is dropped and counted.
    pub fn record(&self, kind: &str, summary: impl Into<String>, detail: Value) {
        let event = event(self.clock, kind, summary.into(), detail);
        if self.records.try_send(Record::Act(event)).is_err() {
            self.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Wait until everything recorded so far is stored.
    pub async fn settled(&self) -> Settled {
        self.wait_for(Record::Settle).await
    }

    /// Close the session, at the end of the server.
    pub async fn end(&self) -> Settled {
        self.wait_for(Record::End).await
    }

    /// The newest sessions of this run, oldest first. Every state that was published before the call has its session in it.
    pub async fn session_spans(&self) -> Vec<SessionSpan> {
        let (told, spans) = oneshot::channel();
        if self.records.send(Record::Spans(told)).await.is_err() {
            return Vec::new();
        }
        spans.await.unwrap_or_default()
    }

    /// Events as they happen.
    pub fn live(&self) -> broadcast::Receiver<Arc<Event>> {
        self.live.subscribe()
    }

    /// The running session.
    pub fn session_id(&self) -> Option<i64> {
        *self.session.borrow()
    }

    /// Acts that found the queue full.
    pub fn dropped(&self) -> u64 {
        self.dropped.load(Ordering::Relaxed)
    }

    async fn wait_for(&self, record: impl FnOnce(oneshot::Sender<Settled>) -> Record) -> Settled {
        let (done, settled) = oneshot::channel();
        if self.records.send(record(done)).await.is_err() {
            return Settled::Lost;
        }
        settled.await.unwrap_or(Settled::Lost)
    }
}

/// The task's own.
struct Task {
    desk: Desk,
    live: broadcast::Sender<Arc<Event>>,
    session: watch::Sender<Option<i64>>,
    spans: VecDeque<SessionSpan>,
    pending: Vec<NewEvent>,
    lost: bool,
}

impl Task {
    async fn run(mut self, mut records: mpsc::Receiver<Record>) {
        let mut batch = Vec::with_capacity(BATCH);
        while records.recv_many(&mut batch, BATCH).await > 0 {
            for record in batch.drain(..) {
                self.take(record).await;
            }
            self.flush().await;
        }
    }

    async fn take(&mut self, record: Record) {
        match record {
            Record::Act(event) => self.add(event),
            Record::InputStop(stop, to_drive) => {
                meters::stop_pressed(inputs::LANE, to_drive);
                let (summary, detail) = (stop.summary(to_drive), stop.detail(to_drive));
                self.add(event(self.desk.clock, "stop_pressed", summary, detail));
            }
            Record::Engine(EngineEvent { event, scene }) => {
                let at = self.desk.clock.wall_text(event.at);
                let objects: Vec<String> =
                    scene.spec().objects.iter().map(|object| object.id.clone()).collect();
                let names = self.desk.persons.names();
                let shown = Event::new(&event, at.clone(), &names, &objects);
                // The session's first event belongs to it, and so does its last.
                let change = if let EventKind::ModeChanged { from, to, rule, because } = &event.kind {
                    Some((*from, *to, latch_record(*rule, because, Reason::new(because, &names))))
                } else {
                    None
                };
                if let EventKind::RuleBreached { rule, .. } = event.kind {
                    meters::rule_breached(rule);
                }
                if let Some((_, Mode::Following, _)) = change {
                    self.begin_session(&at, event.at).await;
                }
                self.add(shown);
                if let Some((from, to, record)) = change {
                    self.mode_changed(&at, event.at, from, to, &record).await;
                }
            }
            Record::Settle(done) => {
                self.flush().await;
                let _ = done.send(self.settled());
            }
            Record::Spans(told) => {
                // Whoever asked may have gone.
                let _ = told.send(self.spans.iter().copied().collect());
            }
            Record::End(done) => {
                self.flush().await;
                let now = self.desk.clock.now();
                self.end_session(&self.desk.clock.wall_text(now), now, SessionEnd::Shutdown).await;
                let _ = done.send(self.settled());
            }
        }
    }

    fn add(&mut self, event: Event) {
        // No dashboard listens: nobody needs to be told.
        let _ = self.live.send(Arc::new(event.clone()));
        self.pending.push(NewEvent { session_id: *self.session.borrow(), event });
    }

    async fn flush(&mut self) {
        if self.pending.is_empty() {
            return;
        }
        let pending = std::mem::take(&mut self.pending);
        let done = self.desk.store.add_events(&pending).await;
        self.check(done, "events");
    }

    async fn mode_changed(&mut self, at: &str, time: Time, from: Mode, to: Mode, record: &str) {
        if to == Mode::LatchedStop {
            let done = self.desk.store.set_latched(Some(record)).await;
            self.check(done, "the latched stop");
        } else if from == Mode::LatchedStop {
            let done = self.desk.store.set_latched(None).await;
            self.check(done, "the reset");
        }
        let end = match to {
            Mode::Following | Mode::ProtectiveStop => return,
            Mode::LatchedStop => SessionEnd::LatchedStop,
            Mode::Faulted => SessionEnd::Faulted,
            Mode::Disarmed | Mode::Homing | Mode::Ready => SessionEnd::Disarmed,
        };
        self.flush().await;
        self.end_session(at, time, end).await;
    }

    async fn begin_session(&mut self, at: &str, time: Time) {
        if self.session.borrow().is_some() {
            return;
        }
        self.flush().await;
        let session = NewSession {
            started: at.into(),
            started_micros: time.micros(),
            scene: self.desk.stage.active().key(),
            machine_shape: Some(self.desk.machine_shape.clone()),
            persons: self.desk.persons.inside(),
        };
        let done = self.desk.store.begin_session(&session).await;
        if let Some(id) = self.check(done, "the session") {
            if self.spans.len() == MOST_SPANS {
                self.spans.pop_front();
            }
            self.spans.push_back(SessionSpan { id, from_micros: time.micros(), to_micros: None });
            self.session.send_replace(Some(id));
        }
    }

    async fn end_session(&mut self, at: &str, time: Time, how: SessionEnd) {
        let Some(id) = self.session.send_replace(None) else { return };
        meters::session_ended(how);
        if let Some(span) = self.spans.back_mut() {
            span.to_micros = Some(time.micros());
        }
        let done = self.desk.store.end_session(id, at, Some(time.micros()), how).await;
        self.check(done, "the end of the session");
    }

    fn check<T>(&mut self, done: Result<T, StoreError>, what: &str) -> Option<T> {
        done.inspect_err(|error| {
            self.lost = true;
            metrics::counter!("covr_store_errors_total").increment(1);
            tracing::error!(%error, "cannot store {what}");
        })
        .ok()
    }

    fn settled(&mut self) -> Settled {
        if std::mem::take(&mut self.lost) { Settled::Lost } else { Settled::Stored }
    }
}

/// An event of now.
fn event(clock: Clock, kind: &str, summary: String, detail: Value) -> Event {
    let at = clock.now();
    Event { at_micros: at.micros(), at: clock.wall_text(at), kind: kind.into(), summary, detail }
}

const QUEUE: usize = 4_096;
const BATCH: usize = 256;
/// Sessions of this run that frames may still belong to.
const MOST_SPANS: usize = 64;
