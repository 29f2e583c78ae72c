//! The thread itself: read, update, write.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::sync_channel;
use std::time::{Duration, Instant};

use covr_engine::event::EventKind;
use covr_engine::mode::{Mode, RequestKind};
use covr_engine::observation::Observation;
use covr_engine::safety::vetted::{Action, Vetted};
use covr_engine::time::Time;
use covr_engine::{Engine, Request};
use covr_gantry::contract::{Gantry, NotTaken};
use covr_wire::dashboard::ControlLoop;
use tokio::sync::mpsc::Sender;
use tokio::sync::watch;

use super::inbox::Inbox;
use super::lateness::Lateness;
use super::stop_lane::{LONGEST_WAIT, StopLane, StopLaneName};
use super::{Control, Ended, EngineEvent, Published, Setup, real_time};
use crate::clock::Clock;
use crate::inputs::{InputLines, InputStop};
use crate::meters;
use crate::recorder::Record;

/// Start the thread; see [`Control::start`].
pub fn start(setup: Setup) -> std::io::Result<Control> {
    let (asks, asks_out) = sync_channel(setup.request_queue);
    let (facts, facts_out) = sync_channel(FACT_QUEUE);
    let stops = Arc::new(StopLaneName::ALL.map(|_| StopLane::default()));
    let game_masters = Arc::new(AtomicUsize::new(0));
    let quit = Arc::new(AtomicBool::new(false));
    let events_dropped = Arc::new(AtomicU64::new(0));
    let ended = watch::Sender::new(None);
    let ended_out = ended.subscribe();

    let rate_hz = 1.0 / setup.period.as_secs_f64();
    let mut drive =
        Drive { gantry: setup.gantry, clock: setup.clock, last: Action::Release, refusing: false };
    let mut engine = setup.engine;
    let now = setup.clock.now();
    drive.read(&mut engine, now);
    let control_loop = ControlLoop {
        rate_hz,
        steps: 0,
        missed_deadlines: 0,
        lateness_p99_micros: 0.0,
        lateness_max_micros: 0.0,
        scheduling: "not started".into(),
        scheduling_why: Vec::new(),
    };
    let first = Published {
        generation: 0,
        snapshot: engine.snapshot(now),
        scene: engine.scene().clone(),
        outlook: engine.outlook(now),
        control_loop: control_loop.clone(),
        machine_health: drive.gantry.health(),
    };
    let published = watch::Sender::new(Arc::new(first));
    let published_out = published.subscribe();

    let mut run = Run {
        engine,
        drive,
        inputs: setup.inputs,
        clock: setup.clock,
        period: setup.period,
        publish_every: setup.publish_every,
        inbox: Inbox::new(asks_out, facts_out),
        stops: stops.clone(),
        stops_seen: [0; 4],
        stops_unacknowledged: None,
        input_stops: Vec::new(),
        game_masters: game_masters.clone(),
        quit: quit.clone(),
        events: setup.events,
        events_dropped: events_dropped.clone(),
        published,
        next_publish: Instant::now(),
        lateness: Lateness::over_ten_seconds(rate_hz),
        lateness_meter: meters::lateness(),
        control_loop,
    };
    let priority = setup.real_time_priority;
    std::thread::Builder::new().name("control".into()).spawn(move || {
        let why = real_time::ask(priority);
        run.control_loop.scheduling = why.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        run.control_loop.scheduling_why = why;
        run.drive.wait_for_an_answer(setup.period);
        tracing::info!(scheduling = %run.control_loop.scheduling, rate_hz, "control loop runs");
        let end = match catch_unwind(AssertUnwindSafe(|| run.until_quit())) {
            Ok(()) => Ended::AsAsked,
            Err(panic) => Ended::Panicked(words_of(&*panic)),
        };
        // The machine is told to stop before anybody learns of the end.
        drop(run);
        ended.send_replace(Some(end));
    })?;
    Ok(Control {
        asks,
        facts,
        stops,
        game_masters,
        quit,
        events_dropped,
        published: published_out,
        ended: ended_out,
    })
}

/// Everything that the thread owns.
struct Run {
    engine: Engine,
    drive: Drive,
    inputs: InputLines,
    clock: Clock,
    period: Duration,
    publish_every: Duration,
    inbox: Inbox,
    stops: Arc<[StopLane; 4]>,
    stops_seen: [u64; 4],
    /// The command of the first step with a stop that the machine has not confirmed yet was vetted then.
    stops_unacknowledged: Option<Time>,
    /// Stops by digital inputs whose command the machine has not confirmed yet, with the time when it was vetted. Few:
    /// one a second of each line at most.
    input_stops: Vec<(InputStop, Time)>,
    game_masters: Arc<AtomicUsize>,
    quit: Arc<AtomicBool>,
    events: Sender<Record>,
    events_dropped: Arc<AtomicU64>,
    published: watch::Sender<Arc<Published>>,
    next_publish: Instant,
    lateness: Lateness,
    lateness_meter: metrics::Histogram,
    control_loop: ControlLoop,
}

/// The machine, which is told to stop when this is dropped, whatever the reason.
struct Drive {
    gantry: Box<dyn Gantry>,
    clock: Clock,
    last: Action,
    refusing: bool,
}

impl Run {
    fn until_quit(&mut self) {
        let mut deadline = Instant::now() + self.period;
        while !self.quit.load(Ordering::Acquire) {
            std::thread::sleep(deadline.saturating_duration_since(Instant::now()));
            let late = Instant::now().saturating_duration_since(deadline);
            self.count(late);
            self.tick();
            deadline += self.period;
            // After a stall the missed periods are skipped, never run after one another.
            if late > self.period {
                deadline += self.period * (late.as_nanos() / self.period.as_nanos()) as u32;
            }
        }
    }

    fn count(&mut self, late: Duration) {
        self.lateness.add(late.as_micros() as i64);
        self.lateness_meter.record(late.as_secs_f64());
        let now = self.clock.now();
        if late > self.period {
            self.control_loop.missed_deadlines += 1;
            self.engine.observe(now, Observation::DeadlineMissed);
        } else {
            self.engine.observe(now, Observation::DeadlineMet);
        }
    }

    fn tick(&mut self) {
        let now = self.clock.now();
        self.drive.read(&mut self.engine, now);
        let (latched, mut input_stops) = (self.engine.mode() == Mode::LatchedStop, Vec::new());
        let inputs = self.inputs.look(now, latched, &mut input_stops);
        self.engine.observe(now, Observation::Inputs(inputs));
        let present = self.game_masters.load(Ordering::Acquire) > 0;
        self.engine.observe(now, Observation::GameMaster(present));
        self.inbox.tell(&mut self.engine, now);
        let mut answers = Vec::new();
        self.inbox.ask(&mut self.engine, now, &mut answers);
        // Stops come last, so that no request of the same tick undoes one.
        let pressed = self.take_stops(now);
        let command = self.engine.step(now);
        if pressed {
            self.stops_unacknowledged.get_or_insert(command.at());
        }
        self.input_stops.extend(input_stops.into_iter().map(|stop| (stop, command.at())));
        self.drive.write(&command, now);
        let written = Instant::now();
        self.control_loop.steps += 1;

        let scene = self.engine.scene().clone();
        let mut mode_changed = false;
        for event in self.engine.drain_events() {
            mode_changed |= matches!(event.kind, EventKind::ModeChanged { .. });
            if self.events.try_send(Record::Engine(EngineEvent { event, scene: scene.clone() })).is_err() {
                self.events_dropped.fetch_add(1, Ordering::Relaxed);
            }
        }
        if written >= self.next_publish || mode_changed || pressed || !answers.is_empty() {
            self.publish(written);
        }
        for (reply, answer) in answers {
            // Whoever asked may have gone; the answer is then nobody's.
            let _ = reply.send(answer);
        }
        self.record_input_stops(written);
        // Only a command that the machine took acknowledges a stop; until one is, the presser is told so.
        if self.stops_unacknowledged.is_some_and(|since| self.drive.gantry.taken() >= since) {
            self.stops_unacknowledged = None;
            for (lane, presses) in self.stops.iter().zip(self.stops_seen) {
                lane.acknowledge(presses, written);
            }
        }
    }

    /// Tell of stops by inputs whose command the machine confirmed, or did not in time.
    fn record_input_stops(&mut self, written: Instant) {
        let confirmed = self.drive.gantry.taken();
        let (clock, events, dropped) = (self.clock, &self.events, &self.events_dropped);
        self.input_stops.retain(|(stop, vetted)| {
            let passed = written.saturating_duration_since(clock.instant_of(stop.since));
            let taken = confirmed >= *vetted;
            if !taken && passed < LONGEST_WAIT {
                return true;
            }
            let record = Record::InputStop(stop.clone(), taken.then_some(passed));
            if events.try_send(record).is_err() {
                dropped.fetch_add(1, Ordering::Relaxed);
            }
            false
        });
    }

    /// Put every new press to the engine; whether there was one.
    fn take_stops(&mut self, now: Time) -> bool {
        let mut pressed = false;
        for (lane, seen) in self.stops.iter().zip(&mut self.stops_seen) {
            let so_far = lane.presses();
            if so_far != *seen {
                *seen = so_far;
                pressed = true;
                self.engine.request(now, Request::Machine(RequestKind::Stop, Some(lane.reason())));
            }
        }
        pressed
    }

    fn publish(&mut self, at: Instant) {
        self.next_publish = at + self.publish_every;
        let (p99, max) = self.lateness.p99_and_max_micros();
        self.control_loop.lateness_p99_micros = p99;
        self.control_loop.lateness_max_micros = max;
        let generation = self.published.borrow().generation + 1;
        let now = self.clock.time_of(at);
        self.published.send_replace(Arc::new(Published {
            generation,
            snapshot: self.engine.snapshot(now),
            scene: self.engine.scene().clone(),
            outlook: self.engine.outlook(now),
            control_loop: self.control_loop.clone(),
            machine_health: self.drive.gantry.health(),
        }));
    }
}

impl Drive {
    /// Locking memory holds up every thread of the process, a machine's link too: its first answer since then comes before the first step,
    /// or the first step would find a machine that is silent. One that stays silent is R8's.
    fn wait_for_an_answer(&mut self, period: Duration) {
        let since = self.clock.now();
        let give_up = Instant::now() + LONGEST_FIRST_ANSWER;
        while self.gantry.read(self.clock.now()).report.answered_at < since && Instant::now() < give_up {
            std::thread::sleep(period);
        }
    }

    fn read(&mut self, engine: &mut Engine, now: Time) {
        let reading = self.gantry.read(now);
        engine.observe(now, Observation::Machine(reading.report));
    }

    /// A refused command is R8's to act on; here it is said once until one is taken again.
    fn write(&mut self, command: &Vetted, now: Time) {
        self.last = command.action();
        let taken = self.gantry.write(now, command);
        if let Err(why) = &taken
            && !self.refusing
        {
            self.say_refused(why);
        }
        self.refusing = taken.is_err();
    }

    fn say_refused(&self, why: &NotTaken) {
        tracing::warn!(machine = self.gantry.name(), %why, "the machine did not take a command");
    }
}

impl Drop for Drive {
    fn drop(&mut self) {
        let now = self.clock.now();
        let last_word = if self.last == Action::Release { Vetted::release(now) } else { Vetted::hold(now) };
        if let Err(why) = self.gantry.write(now, &last_word) {
            tracing::error!(%why, "the machine did not take the last command; its own timeout stops it");
        }
    }
}

fn words_of(panic: &(dyn std::any::Any + Send)) -> String {
    panic
        .downcast_ref::<&str>()
        .map(|words| (*words).to_owned())
        .or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "a panic without words".into())
}

/// The longest wait for a machine's first answer.
const LONGEST_FIRST_ANSWER: Duration = Duration::from_millis(500);
/// Facts come with each person's coming and going, never with poses.
const FACT_QUEUE: usize = 1_024;
