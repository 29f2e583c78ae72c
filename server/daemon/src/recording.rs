//! Recording: while a session runs, every published state becomes a frame of it.
//!
//! Two tasks. The sampler takes each published state as it comes and gathers a second of frames; it waits for nobody.
//! The writer compresses and stores them; between the two stands a short queue. A writer that cannot keep up costs
//! frames, which are counted and shown, and never memory, a control step or an event.
//!
//! Which session a frame belongs to is the recorder's word: it knows when each began and ended, in server time.

pub mod chunk;
mod past;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, SystemTime};

use covr_engine::mode::Mode;
use covr_engine::time::Span;
use covr_wire::dashboard::{Snapshot, Surroundings};
use covr_wire::records::RecordedFrame;
use tokio::sync::{mpsc, watch};
use tokio::task::JoinHandle;
use tokio::time::Instant;

pub use past::{AtTouch, Past};

use crate::config;
use crate::control::Published;
use crate::persons::Persons;
use crate::recorder::{Recorder, SessionSpan};
use crate::store::{Keep, NewChunk, Store};

/// What recording works with.
pub struct Booth {
    /// Where it writes.
    pub store: Store,
    /// Who knows the sessions.
    pub recorder: Recorder,
    /// Names of people.
    pub persons: Arc<Persons>,
    /// What is recorded.
    pub published: watch::Receiver<Arc<Published>>,
    /// Whether, and how much is kept.
    pub settings: config::Recording,
}

/// The way to what is being recorded.
#[derive(Debug)]
pub struct Recording {
    past: Arc<Past>,
    dropped: Arc<AtomicU64>,
    writer: tokio::sync::Mutex<Option<JoinHandle<()>>>,
}

impl Recording {
    /// Start both tasks. They end when nothing is published any more.
    pub fn start(booth: Booth) -> Self {
        let (chunks, chunks_out) = mpsc::channel(QUEUE);
        let past = Arc::new(Past::default());
        let dropped = Arc::new(AtomicU64::new(0));
        let sampler = Sampler {
            persons: booth.persons,
            past: past.clone(),
            enabled: booth.settings.enabled,
            chunks,
            dropped: dropped.clone(),
            gathered: Vec::new(),
            lost: 0,
            last_generation: None,
            tail_until: None,
        };
        tokio::spawn(sampler.run(booth.published));
        let writer = Writer {
            store: booth.store,
            recorder: booth.recorder,
            dropped: dropped.clone(),
            settings: booth.settings,
            make_room_at: Instant::now(),
        };
        let writer = tokio::spawn(writer.run(chunks_out));
        Self { past, dropped, writer: tokio::sync::Mutex::new(Some(writer)) }
    }

    /// Where the column stood in the last seconds.
    pub fn past(&self) -> &Past {
        &self.past
    }

    /// Frames of sessions that were not recorded.
    pub fn dropped(&self) -> u64 {
        self.dropped.load(Ordering::Relaxed)
    }

    /// Wait until everything is stored, once nothing is published any more.
    pub async fn finish(&self) {
        let Some(writer) = self.writer.lock().await.take() else { return };
        if tokio::time::timeout(LONGEST_FINISH, writer).await.is_err() {
            tracing::error!("the last of the recording could not be stored in time");
        }
    }
}

/// Frames on their way to the writer.
#[derive(Debug, Default)]
struct Chunk {
    frames: Vec<RecordedFrame>,
    /// Frames lost before these.
    lost: u64,
}

struct Sampler {
    persons: Arc<Persons>,
    past: Arc<Past>,
    enabled: bool,
    chunks: mpsc::Sender<Chunk>,
    dropped: Arc<AtomicU64>,
    gathered: Vec<RecordedFrame>,
    /// Frames lost since the last chunk that was taken.
    lost: u64,
    last_generation: Option<u64>,
    /// The session is over, and its column still brakes: recorded until then at most, server time in microseconds.
    tail_until: Option<i64>,
}

impl Sampler {
    async fn run(mut self, mut published: watch::Receiver<Arc<Published>>) {
        while published.changed().await.is_ok() {
            let now = published.borrow_and_update().clone();
            self.past.remember(&now);
            if self.enabled {
                self.take(&now);
            }
        }
        self.hand_over();
    }

    fn take(&mut self, now: &Published) {
        let at_micros = now.snapshot.at.micros();
        let runs = matches!(now.snapshot.mode, Mode::Following | Mode::ProtectiveStop);
        let ends_now = !runs && self.tail_until.is_none() && self.last_generation.is_some();
        if runs {
            self.tail_until = None;
        } else if ends_now {
            self.tail_until = Some(at_micros + TAIL.micros());
        }
        let brakes = now.snapshot.column.velocity.norm() > AT_REST_MPS
            && self.tail_until.is_some_and(|until| at_micros < until);
        if !(runs || ends_now || brakes) {
            if self.last_generation.take().is_some() {
                self.hand_over();
            }
            self.tail_until = None;
            return;
        }
        // Generations have no gaps, so what is missing was never seen here.
        let missed = self.last_generation.map_or(0, |last| (now.generation - last).saturating_sub(1));
        self.lose(missed);
        self.last_generation = Some(now.generation);
        let frame = self.frame(now);
        let is_full = self.gathered.first().is_some_and(|first| {
            frame.at_micros - first.at_micros >= CHUNK.micros()
                || self.gathered.len() == MOST_FRAMES
                || !chunk::fit_together(first, &frame)
        });
        if is_full {
            self.hand_over();
        }
        self.gathered.push(frame);
    }

    fn frame(&self, now: &Published) -> RecordedFrame {
        let around = Surroundings {
            generation: now.generation,
            names: &self.persons.names(),
            control_loop: now.control_loop.clone(),
            machine_health: None,
            clients: Vec::new(),
            scene_id: None,
            session_id: None,
        };
        Snapshot::new(&now.snapshot, around).into()
    }

    fn hand_over(&mut self) {
        if self.gathered.is_empty() {
            return;
        }
        let chunk =
            Chunk { frames: std::mem::take(&mut self.gathered), lost: std::mem::take(&mut self.lost) };
        if let Err(mpsc::error::TrySendError::Full(chunk) | mpsc::error::TrySendError::Closed(chunk)) =
            self.chunks.try_send(chunk)
        {
            self.lost += chunk.lost;
            self.lose(chunk.frames.len() as u64);
        }
    }

    fn lose(&mut self, frames: u64) {
        self.lost += frames;
        self.dropped.fetch_add(frames, Ordering::Relaxed);
    }
}

struct Writer {
    store: Store,
    recorder: Recorder,
    dropped: Arc<AtomicU64>,
    settings: config::Recording,
    make_room_at: Instant,
}

impl Writer {
    async fn run(mut self, mut chunks: mpsc::Receiver<Chunk>) {
        self.make_room().await;
        while let Some(chunk) = chunks.recv().await {
            self.store(chunk).await;
            if Instant::now() >= self.make_room_at {
                self.make_room().await;
            }
        }
    }

    async fn store(&self, chunk: Chunk) {
        let spans = self.recorder.session_spans().await;
        let mut lost = chunk.lost;
        let mut frames = chunk.frames.into_iter().peekable();
        while let Some(first) = frames.next() {
            let session = session_of(&spans, first.at_micros);
            let mut of_one = vec![first];
            while let Some(next) = frames.next_if(|next| session_of(&spans, next.at_micros) == session) {
                of_one.push(next);
            }
            // Between two sessions, as when one could not be stored.
            let Some(session) = session else { continue };
            let count = of_one.len() as u64;
            if let Err(why) = self.add(session, of_one, std::mem::take(&mut lost)).await {
                self.dropped.fetch_add(count, Ordering::Relaxed);
                metrics::counter!("covr_store_errors_total").increment(1);
                tracing::error!(session, %why, "cannot store a second of the recording");
            }
        }
    }

    async fn add(&self, session: i64, frames: Vec<RecordedFrame>, dropped: u64) -> anyhow::Result<()> {
        let (Some(first), Some(last)) = (frames.first(), frames.last()) else { return Ok(()) };
        let (first_micros, last_micros) = (first.at_micros, last.at_micros);
        let count = u32::try_from(frames.len())?;
        let document = tokio::task::spawn_blocking(move || chunk::encode(&frames)).await??;
        let chunk =
            NewChunk { session_id: session, first_micros, last_micros, frames: count, dropped, document };
        Ok(self.store.add_chunk(&chunk).await?)
    }

    async fn make_room(&mut self) {
        self.make_room_at = Instant::now() + MAKE_ROOM_EVERY;
        let keep = self.settings.keep(SystemTime::now());
        match self.store.make_room(keep, self.recorder.session_id()).await {
            Ok(0) => {}
            Ok(removed) => tracing::info!(removed, "old recordings were deleted, in seconds"),
            Err(why) => tracing::error!(%why, "cannot delete old recordings"),
        }
    }
}

impl config::Recording {
    /// What is to be kept at this moment.
    fn keep(&self, now: SystemTime) -> Keep {
        let days = u64::try_from(self.keep_days).unwrap_or(u64::MAX);
        let bytes = u64::try_from(self.keep_megabytes).unwrap_or(u64::MAX).saturating_mul(1_000_000);
        Keep {
            since: (days > 0)
                .then(|| now.checked_sub(Duration::from_secs(days.saturating_mul(86_400))))
                .flatten(),
            bytes: (bytes > 0).then_some(bytes),
        }
    }
}

/// The session that runs at a moment, or has just ended.
fn session_of(spans: &[SessionSpan], at_micros: i64) -> Option<i64> {
    let begun = spans.iter().rev().find(|span| span.from_micros <= at_micros)?;
    let longest = TAIL.micros() + CHUNK.micros();
    begun.to_micros.is_none_or(|to| at_micros <= to + longest).then_some(begun.id)
}

/// Frames of so much time share a document: what kill -9 can cost.
const CHUNK: Span = Span::from_millis(1_000);
/// So long after a session's end the braking column is still recorded.
const TAIL: Span = Span::from_millis(2_000);
/// More frames than this never share a document, however fast they are published.
const MOST_FRAMES: usize = 256;
/// Chunks that may wait for the writer.
const QUEUE: usize = 8;
const AT_REST_MPS: f64 = 0.005;
const LONGEST_FINISH: Duration = Duration::from_secs(5);
const MAKE_ROOM_EVERY: Duration = Duration::from_secs(60);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_belongs_to_the_session_that_runs_or_has_just_ended() {
        let spans = [
            SessionSpan { id: 1, from_micros: 1_000_000, to_micros: Some(5_000_000) },
            SessionSpan { id: 2, from_micros: 20_000_000, to_micros: None },
        ];
        let of = |at| session_of(&spans, at);
        assert_eq!(of(999_999), None);
        assert_eq!(of(1_000_000), Some(1));
        assert_eq!(of(5_000_000 + TAIL.micros()), Some(1), "it still brakes");
        assert_eq!(of(19_999_999), None);
        assert_eq!(of(20_000_000), Some(2));
        assert_eq!(of(i64::MAX / 2), Some(2));
    }

    #[test]
    fn nothing_is_kept_for_ever_unless_told_so() {
        let now = SystemTime::UNIX_EPOCH + Duration::from_secs(86_400 * 1_000);
        let keep = |keep_days, keep_megabytes| {
            config::Recording { enabled: true, keep_days, keep_megabytes }.keep(now)
        };
        assert_eq!(keep(0, 0), Keep { since: None, bytes: None });
        let since = SystemTime::UNIX_EPOCH + Duration::from_secs(86_400 * 990);
        assert_eq!(keep(10, 5), Keep { since: Some(since), bytes: Some(5_000_000) });
    }
}
