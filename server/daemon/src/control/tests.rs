//! The control thread against a machine made for it: what happens when it panics, stalls, or is flooded.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc as std_mpsc;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use covr_engine::frames::{Floor, Planar};
use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::machine::{Drive, Homing, Limits, MachineReport, Travel};
use covr_engine::mode::{Mode, RequestKind};
use covr_engine::motion::MotionName;
use covr_engine::safety::separation::KeptFrom;
use covr_engine::safety::vetted::{Action, Vetted};
use covr_engine::time::{Span, Time};
use covr_engine::{Engine, EngineConfig, Request};
use covr_gantry::contract::{Gantry, NotTaken, Reading};
use covr_wire::scene::parse_scene;
use tokio::sync::mpsc;

use super::{Control, Ended, NotDelivered, Setup, StopLaneName};
use crate::clock::Clock;
use crate::inputs::InputLines;

/// What the machine is to do at its next reading.
enum Whim {
    Panic,
    /// Say that it waits, and wait.
    Wait(std_mpsc::Sender<()>, std_mpsc::Receiver<()>),
}

/// A homed machine at rest that remembers what it was told.
struct Puppet {
    whims: std_mpsc::Receiver<Whim>,
    told: Arc<Mutex<Vec<Action>>>,
    /// It takes no command.
    deaf: Arc<AtomicBool>,
    taken: Time,
}

impl Gantry for Puppet {
    fn read(&mut self, now: Time) -> Reading {
        match self.whims.try_recv() {
            Ok(Whim::Panic) => panic!("the puppet was told to"),
            Ok(Whim::Wait(waits, go_on)) => {
                waits.send(()).unwrap();
                go_on.recv().unwrap();
            }
            Err(_) => {}
        }
        let report = MachineReport {
            answered_at: now,
            position: Floor::new(2.0, 2.0),
            velocity: Planar::ZERO,
            current_amps: [0.0; 2],
            drive: Drive::On,
            homing: Homing::Homed,
            home_repeatability_m: None,
            trouble: None,
        };
        Reading { report, link: Ok(()) }
    }

    fn write(&mut self, _: Time, command: &Vetted) -> Result<(), NotTaken> {
        if self.deaf.load(Ordering::Acquire) {
            return Err(NotTaken::NotHomed);
        }
        self.told.lock().unwrap().push(command.action());
        self.taken = command.at();
        Ok(())
    }

    fn taken(&self) -> Time {
        self.taken
    }

    fn name(&self) -> &str {
        "puppet"
    }

    fn travel(&self) -> Travel {
        Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) }
    }

    fn limits(&self) -> Limits {
        Limits::PAPER
    }
}

struct Stage {
    control: Control,
    whims: std_mpsc::Sender<Whim>,
    told: Arc<Mutex<Vec<Action>>>,
    deaf: Arc<AtomicBool>,
    _events: mpsc::Receiver<crate::recorder::Record>,
}

fn start() -> Stage {
    let (whims, whims_out) = std_mpsc::channel();
    let told = Arc::new(Mutex::new(Vec::new()));
    let deaf = Arc::new(AtomicBool::new(false));
    let puppet = Puppet { whims: whims_out, told: told.clone(), deaf: deaf.clone(), taken: Time::ZERO };
    let (_, scene) = parse_scene(include_bytes!("../../../../deploy/scenes/demo.json")).unwrap();
    let period = Duration::from_millis(4);
    let config = EngineConfig {
        limits: puppet.limits(),
        travel: puppet.travel(),
        period: Span::from_millis(4),
        intention_rule: RuleName::Paper,
        intention: IntentionParameters::default(),
        motion: MotionName::Proxy,
        standing: None,
        kept_from: KeptFrom::Everybody,
        v_h_mps: 1.6,
        needs_game_master: false,
        latched_because: None,
    };
    let (events, events_out) = mpsc::channel(1_024);
    let control = Control::start(Setup {
        engine: Engine::new(config, Arc::new(scene)),
        gantry: Box::new(puppet),
        inputs: InputLines::default(),
        clock: Clock::started_now(),
        period,
        publish_every: Duration::from_millis(33),
        real_time_priority: None,
        request_queue: 2,
        events,
    })
    .unwrap();
    Stage { control, whims, told, deaf, _events: events_out }
}

impl Stage {
    /// Hold the thread in its reading until the sender says go on.
    fn hold(&self) -> std_mpsc::Sender<()> {
        let ((waits, waiting), (go_on, going_on)) = (std_mpsc::channel(), std_mpsc::channel());
        self.whims.send(Whim::Wait(waits, going_on)).unwrap();
        waiting.recv_timeout(Duration::from_secs(10)).unwrap();
        go_on
    }
}

async fn within<T>(what: &str, future: impl Future<Output = T>) -> T {
    tokio::time::timeout(Duration::from_secs(10), future)
        .await
        .unwrap_or_else(|_| panic!("{what}: not in time"))
}

#[tokio::test]
async fn a_panic_stops_the_machine_and_is_told() {
    let stage = start();
    within("homed", stage.control.ask(Request::Machine(RequestKind::Home, None))).await.unwrap();
    let mut published = stage.control.watch_published();
    within("ready", published.wait_for(|p| p.snapshot.mode == Mode::Ready)).await.unwrap();
    assert!(stage.control.is_running());
    stage.whims.send(Whim::Panic).unwrap();
    let ended = within("the end", stage.control.ended()).await;
    assert_eq!(ended, Ended::Panicked("the puppet was told to".into()));
    assert_eq!(stage.told.lock().unwrap().last(), Some(&Action::Hold), "the machine brakes and holds");
    let ask = stage.control.ask(Request::Machine(RequestKind::Home, None)).await;
    assert_eq!(ask.unwrap_err(), NotDelivered::NotRunning);
}

#[tokio::test]
async fn the_last_word_to_a_released_drive_is_release() {
    let stage = start();
    let mut published = stage.control.watch_published();
    // The drive is found on, and released once the machine has been at rest for a while.
    within("a released drive", async {
        while stage.told.lock().unwrap().last() != Some(&Action::Release) {
            published.changed().await.unwrap();
        }
    })
    .await;
    stage.control.quit();
    assert_eq!(within("the end", stage.control.ended()).await, Ended::AsAsked);
    assert_eq!(stage.told.lock().unwrap().last(), Some(&Action::Release));
}

#[tokio::test]
async fn a_full_queue_says_busy_and_a_stop_gets_through_all_the_same() {
    let stage = start();
    let go_on = stage.hold();
    let home = || Request::Machine(RequestKind::Home, None);
    // The thread waits in its reading: two requests fill the queue, and the third is refused at once.
    let mut waiting = Vec::new();
    let busy = within("busy", async {
        loop {
            let control = stage.control.clone();
            let request = home();
            let mut ask = Box::pin(async move { control.ask(request).await });
            tokio::select! {
                biased;
                answer = &mut ask => if answer == Err(NotDelivered::Busy) { return answer },
                () = tokio::task::yield_now() => waiting.push(tokio::spawn(ask)),
            }
        }
    })
    .await;
    assert_eq!(busy, Err(NotDelivered::Busy));
    let control = stage.control.clone();
    let pressed = Instant::now();
    let stop =
        tokio::spawn(async move { control.stop(StopLaneName::Http, "look out".into(), pressed).await });
    go_on.send(()).unwrap();
    let to_drive = within("the stop", stop).await.unwrap().unwrap();
    assert!(to_drive <= pressed.elapsed());
    assert_eq!(stage.control.published().snapshot.mode, Mode::LatchedStop);
    for ask in waiting {
        assert!(within("an answer", ask).await.unwrap().is_ok(), "whoever was not refused is answered");
    }
}

#[tokio::test]
async fn a_stop_is_acknowledged_by_a_command_that_the_machine_took_and_by_no_other() {
    let stage = start();
    stage.deaf.store(true, Ordering::Release);
    let press = || stage.control.stop(StopLaneName::Http, "look out".into(), Instant::now());
    assert!(within("the refusal", press()).await.is_err(), "the drive took nothing");
    assert_eq!(stage.control.published().snapshot.mode, Mode::LatchedStop);
    // It hears again while a press waits: the next command that it takes acknowledges.
    let mut waits = Box::pin(press());
    tokio::select! {
        biased;
        early = &mut waits => panic!("{early:?}"),
        () = tokio::task::yield_now() => {}
    }
    let mut published = stage.control.watch_published();
    let steps = published.borrow().control_loop.steps;
    within("steps that took nothing", published.wait_for(|p| p.control_loop.steps > steps)).await.unwrap();
    stage.deaf.store(false, Ordering::Release);
    assert!(within("the stop", waits).await.is_ok());
}

#[tokio::test]
async fn a_stall_is_counted_and_its_periods_are_skipped() {
    let stage = start();
    let mut published = stage.control.watch_published();
    let before = within("a start", published.wait_for(|p| p.control_loop.steps > 5)).await.unwrap().clone();
    let go_on = stage.hold();
    // This sleep is the stall.
    std::thread::sleep(Duration::from_millis(200));
    go_on.send(()).unwrap();
    let missed = |p: &Arc<super::Published>| {
        p.control_loop.missed_deadlines > before.control_loop.missed_deadlines
            && p.control_loop.lateness_max_micros > 100_000.0
    };
    let after = within("the miss", published.wait_for(missed)).await.unwrap().clone();
    // Run after one another, the missed periods would make as many steps as time has passed.
    let passed = (after.snapshot.at - before.snapshot.at).secs();
    let stepped = (after.control_loop.steps - before.control_loop.steps) as f64 * 0.004;
    assert!(stepped < passed - 0.15, "{stepped} s of steps in {passed} s with a stall of 0.2 s");
}
