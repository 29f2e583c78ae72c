//! A real server in this process, whose machine does what it is told at once and notes when it was told.

use std::sync::Arc;
use std::sync::mpsc;
use std::time::{Duration, Instant};

use covr_engine::Request;
use covr_engine::frames::Floor;
use covr_engine::machine::{Limits, Travel};
use covr_engine::mode::{Mode, RequestKind};
use covr_engine::safety::vetted::{Action, Vetted};
use covr_engine::time::Time;
use covr_gantry::contract::{Gantry, NotTaken, Reading};
use covr_gantry::ideal::IdealMachine;
use covr_server::app::App;
use covr_server::config::Config;
use covr_server::serve::Server;
use tempfile::TempDir;
use tokio::sync::oneshot;
use tokio::task::JoinHandle;

/// One period of the control loop, as the machine saw it.
#[derive(Debug, Clone, Copy)]
pub struct Tick {
    /// The engine's time of the step.
    pub now: Time,
    /// When the machine was read: the begin of the period.
    pub read: Instant,
    /// When the command had been written.
    pub written: Instant,
    /// The command brakes, or lets the drive go.
    pub brakes: bool,
}

/// The server under test.
pub struct Bed {
    /// `127.0.0.1:port`.
    pub host: String,
    /// What its handlers share.
    pub app: Arc<App>,
    /// Every period since the last look.
    pub ticks: mpsc::Receiver<Tick>,
    _dir: TempDir,
    end: oneshot::Sender<String>,
    runs: JoinHandle<()>,
}

/// An ideal machine that notes. Sending into an unbounded channel takes no lock that the reader holds.
struct Noting {
    machine: IdealMachine,
    read: Instant,
    ticks: mpsc::Sender<Tick>,
}

impl Bed {
    /// Start with the default configuration, changed.
    pub async fn start(change: impl FnOnce(&mut Config)) -> Self {
        let dir = TempDir::new().unwrap();
        let mut config = Config::default();
        config.server.bind = ([127, 0, 0, 1], 0).into();
        config.server.database = dir.path().join("covr.sqlite");
        change(&mut config);
        let machine = &config.machine;
        let parked = Floor::new(machine.parked_x_m, machine.parked_y_m);
        let (sender, ticks) = mpsc::channel();
        let machine = IdealMachine::new(machine.limits(), machine.travel(), parked);
        let noting = Noting { machine, read: Instant::now(), ticks: sender };
        let server = Server::start_with(config, Box::new(noting)).await.unwrap();
        let host = server.address().to_string();
        let app = server.app().clone();
        let (end, told) = oneshot::channel();
        let runs = tokio::spawn(async move {
            let told = async { told.await.unwrap_or_default() };
            server.run_until(told).await.unwrap();
        });
        Self { host, app, ticks, _dir: dir, end, runs }
    }

    /// Home if need be, and arm; waits for each.
    pub async fn arm(&self) {
        if self.app.control.published().snapshot.mode != Mode::Ready {
            self.ask(RequestKind::Home, None).await;
            self.mode(Mode::Ready).await;
        }
        self.ask(RequestKind::Arm, None).await;
        self.mode(Mode::Following).await;
    }

    /// Ask until it is accepted: after a stop the machine has to rest first.
    pub async fn ask(&self, kind: RequestKind, reason: Option<&str>) {
        let asked = async {
            loop {
                let answer =
                    self.app.control.ask(Request::Machine(kind, reason.map(str::to_owned))).await.unwrap();
                if answer.outcome != covr_engine::Outcome::Refused {
                    return;
                }
                tokio::time::sleep(Duration::from_millis(5)).await;
            }
        };
        tokio::time::timeout(LONGEST, asked)
            .await
            .unwrap_or_else(|_| panic!("{kind:?} was refused for {LONGEST:?}"));
    }

    /// Wait for a mode.
    pub async fn mode(&self, mode: Mode) {
        let mut published = self.app.control.watch_published();
        let reached = published.wait_for(|published| published.snapshot.mode == mode);
        let reached = tokio::time::timeout(LONGEST, reached).await;
        assert!(reached.is_ok(), "not {} within {LONGEST:?}", mode.name());
    }

    /// The control period.
    pub fn period(&self) -> Duration {
        Duration::from_secs_f64(1.0 / self.app.config.control.rate_hz)
    }

    /// Machine at rest, sockets and store closed.
    pub async fn end(self) {
        self.end.send("the benchmark is done".into()).unwrap();
        self.runs.await.unwrap();
    }
}

impl Gantry for Noting {
    fn read(&mut self, now: Time) -> Reading {
        self.read = Instant::now();
        self.machine.read(now)
    }

    fn write(&mut self, now: Time, command: &Vetted) -> Result<(), NotTaken> {
        let taken = self.machine.write(now, command);
        let brakes = matches!(command.action(), Action::Hold | Action::Release);
        let tick = Tick { now, read: self.read, written: Instant::now(), brakes };
        // At the end nobody looks any more.
        let _ = self.ticks.send(tick);
        taken
    }

    fn taken(&self) -> Time {
        self.machine.taken()
    }

    fn name(&self) -> &str {
        "ideal"
    }

    fn travel(&self) -> Travel {
        self.machine.travel()
    }

    fn limits(&self) -> Limits {
        self.machine.limits()
    }
}

const LONGEST: Duration = Duration::from_secs(20);
