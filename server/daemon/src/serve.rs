//! The server: put together, run, and taken apart with the machine at rest first.

use std::future::Future;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context, bail};
use covr_engine::frames::Floor;
use covr_engine::mode::{Mode, RequestKind};
use covr_engine::safety::separation::KeptFrom;
use covr_engine::time::Span;
use covr_engine::{Engine, EngineConfig, Request};
use covr_gantry::contract::Gantry;
use covr_gantry::sim::SimulatedMachine;
use covr_gantry::sim::parameters::MachineParameters;
use covr_gantry::{odrive, roboclaw};
use covr_wire::dashboard::MachineShape;
use covr_wire::reason::last_run;
use covr_wire::scene::parse_scene;
use tokio::net::TcpListener;
use tokio::signal::unix::{Signal, SignalKind, signal};
use tokio::sync::{Semaphore, watch};
use tokio::time::MissedTickBehavior;

use crate::access::{Caller, Roster};
use crate::app::{App, Asker};
use crate::calibrations::Calibrations;
use crate::checklist::Checklist;
use crate::clients::Clients;
use crate::clock::Clock;
use crate::commissionings::Commissionings;
use crate::config::{Config, Loaded, MachineKind};
use crate::control::{Control, Ended, Setup, StopLaneName, real_time};
use crate::hand::Hand;
use crate::http::Limits;
use crate::inputs::InputLines;
use crate::listen::{Listening, check_reach, check_tokens, listen, tls};
use crate::persons::Persons;
use crate::recorder::{Desk, Recorder};
use crate::recording::{Booth, Recording};
use crate::stage::{ActiveScene, Stage};
use crate::store::Store;
use crate::{http, live, meters};

/// A running server.
pub struct Server {
    app: Arc<App>,
    address: SocketAddr,
    closing: watch::Sender<Option<String>>,
    http: Listening,
}

impl Server {
    /// Start: store, control thread, sockets. The machine starts disarmed, or latched if the last run ended so.
    pub async fn start(config: impl Into<Loaded>) -> anyhow::Result<Self> {
        let loaded = config.into();
        let clock = Clock::started_now();
        let of = loaded.config.clone();
        // A machine that is not there yet is waited for a little.
        let gantry =
            tokio::task::spawn_blocking(move || machine(&of, clock)).await.context("the machine")??;
        Self::start_on(loaded, gantry, clock).await
    }

    /// The same with a machine of the caller's: for measurements and tests. Its travel and limits must be the
    /// configuration's.
    pub async fn start_with(config: impl Into<Loaded>, gantry: Box<dyn Gantry>) -> anyhow::Result<Self> {
        Self::start_on(config.into(), gantry, Clock::started_now()).await
    }

    async fn start_on(loaded: Loaded, gantry: Box<dyn Gantry>, clock: Clock) -> anyhow::Result<Self> {
        let Loaded { config, origins } = loaded;
        check_reach(&config)?;
        let tls = tls(&config).await?;
        let intention = config.people.intention()?;
        let prometheus = meters::install()?;
        if !config.machine.kind.is_simulated() && !config.needs_game_master() {
            tracing::warn!(
                "safety.game_master: a real machine may be armed while nobody is at a dashboard (R11)"
            );
        }
        let path = &config.server.database;
        let store = Store::open(path).await.with_context(|| format!("database {}", path.display()))?;
        let left_over = store.take_over().await.context("database")?;
        // Who cannot write could not keep a latched stop.
        store.probe().await.with_context(|| format!("database {} cannot be written", path.display()))?;
        if left_over.interrupted_sessions > 0 {
            tracing::warn!(
                sessions = left_over.interrupted_sessions,
                "the last run was interrupted in a session"
            );
        }
        if let Some(record) = &left_over.latched_because {
            tracing::warn!("{}; reset it to go on", last_run(record));
        }
        let login_lasts = Duration::from_secs_f64(config.access.login_hours * SECS_AN_HOUR);
        let roster = Arc::new(Roster::open(store.clone(), login_lasts).await.context("tokens")?);
        check_tokens(&config, &roster)?;
        let active = active_scene(&store, left_over.active_scene).await?;
        let priors = store.priors_in_force().await?;

        let calibrations = Calibrations::open(&config, &store).await.context("calibrations")?;
        let commissionings = Commissionings::open(&config, &store).await.context("commissionings")?;
        let persons = Arc::new(Persons::default());
        let clients = Arc::new(Clients::new(config.clients.most));
        let scene = active.scene.clone();
        let stage = Arc::new(Stage::new(active));
        let desk = Desk {
            store: store.clone(),
            clock,
            persons: persons.clone(),
            stage: stage.clone(),
            machine_shape: MachineShape::new(&config.machine.travel(), &config.machine.limits()),
        };
        let (recorder, events) = Recorder::start(desk, config.dashboards.event_queue);
        let period = Duration::from_secs_f64(1.0 / config.control.rate_hz);
        let engine_config = EngineConfig {
            limits: config.machine.limits(),
            travel: config.machine.travel(),
            period: Span::from_secs(period.as_secs_f64()),
            intention_rule: config.people.intention_rule,
            intention,
            motion: config.people.motion,
            standing: config.people.standing,
            kept_from: KeptFrom::Everybody,
            v_h_mps: config.people.v_h_mps,
            needs_game_master: config.needs_game_master(),
            latched_because: left_over.latched_because,
        };
        let of = (config.safety.inputs.clone(), clock);
        let inputs = tokio::task::spawn_blocking(move || InputLines::start(&of.0, of.1))
            .await
            .context("the digital inputs")?
            .context("a digital input's thread")?;
        let control = Control::start(Setup {
            engine: Engine::new(engine_config, scene),
            gantry,
            inputs,
            clock,
            period,
            publish_every: Duration::from_secs_f64(1.0 / config.control.publish_hz),
            real_time_priority: config.control.real_time.then_some(config.control.priority),
            request_queue: config.control.request_queue,
            events,
        })
        .context("the control thread")?;
        stage.restore_priors(&control, &priors).await?;
        let recording = Recording::start(Booth {
            store: store.clone(),
            recorder: recorder.clone(),
            persons: persons.clone(),
            published: control.watch_published(),
            settings: config.recording.clone(),
        });

        let listener = TcpListener::bind(config.server.bind)
            .await
            .with_context(|| format!("cannot listen on {}", config.server.bind))?;
        let address = listener.local_addr()?;
        let limits = Limits::new(config.server.requests_per_sec);
        let (dashboards, clients_most) = (config.dashboards.most, config.clients.most);
        let closing = watch::Sender::new(None);
        let frames = watch::Sender::new(Arc::from(""));
        let app = Arc::new(App {
            config,
            origins,
            clock,
            control,
            roster,
            limits,
            hand: Hand::default(),
            store,
            recorder,
            recording,
            persons,
            stage,
            checklist: Checklist::default(),
            calibrations,
            commissionings,
            clients,
            doorstep: Arc::new(Semaphore::new(clients_most)),
            dashboard_seats: Arc::new(Semaphore::new(dashboards)),
            frames: frames.subscribe(),
            closing: closing.subscribe(),
            prometheus,
        });
        tokio::spawn(live::publish(app.clone(), frames));
        tokio::spawn(follow_tokens(app.clone()));
        let http = listen(listener, &app.config, tls, http::router(app.clone()));
        tracing::info!(
            version = env!("CARGO_PKG_VERSION"),
            "covr serves; the dashboard is at {}://{address}",
            if app.config.server.is_encrypted() { "https" } else { "http" },
        );
        Ok(Self { app, address, closing, http })
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// What its handlers share.
    pub fn app(&self) -> &Arc<App> {
        &self.app
    }

    /// Serve until `told` says why to end, or until something that must not end does. The machine comes to rest
    /// first, then the sockets close with the reason, then the session and the store.
    pub async fn run_until(mut self, told: impl Future<Output = String>) -> anyhow::Result<()> {
        tokio::select! {
            reason = told => {
                tracing::info!(reason, "the server ends: machine at rest first");
                self.bring_to_rest().await;
                self.app.control.quit();
                self.app.control.ended().await;
                self.close(&reason).await;
                Ok(())
            }
            ended = self.app.control.ended() => {
                self.close("the control loop ended").await;
                match ended {
                    Ended::Panicked(words) => bail!("the control thread panicked: {words}; the machine was told to stop"),
                    Ended::AsAsked => bail!("the control thread ended unasked; the machine was told to stop"),
                }
            }
            ended = &mut self.http.http => {
                self.bring_to_rest().await;
                self.app.control.quit();
                self.close("the HTTP server ended").await;
                bail!("the HTTP server ended: {ended:?}")
            }
        }
    }

    async fn bring_to_rest(&self) {
        let longest = Duration::from_secs_f64(self.app.config.server.rest_timeout_secs);
        let at_rest = async {
            let mut published = self.app.control.watch_published();
            if let Err(why) =
                self.app.control.ask(Request::Machine(RequestKind::Disarm, Some("shutdown".into()))).await
            {
                tracing::error!(%why, "cannot disarm");
                return;
            }
            let _ = published
                .wait_for(|p| {
                    let moves = p.snapshot.column.velocity.norm() > AT_REST_MPS;
                    !moves && matches!(p.snapshot.mode, Mode::Disarmed | Mode::LatchedStop | Mode::Faulted)
                })
                .await;
        };
        if tokio::time::timeout(longest, at_rest).await.is_err() {
            tracing::error!(secs = longest.as_secs_f64(), "the machine did not come to rest in time");
        }
    }

    async fn close(&mut self, reason: &str) {
        self.closing.send_replace(Some(reason.into()));
        self.http.close(LONGEST_CLOSE);
        if !self.http.http.is_finished()
            && tokio::time::timeout(LONGEST_CLOSE, &mut self.http.http).await.is_err()
        {
            tracing::warn!("some connections did not close in time");
            self.http.http.abort();
        }
        self.app.recorder.end().await;
        self.app.recording.finish().await;
        self.app.store.close().await;
        tracing::info!("closed");
    }
}

/// SIGINT or SIGTERM from the call on, not from the first poll; the reason to end.
pub fn told_by_signal() -> impl Future<Output = String> {
    let listening = (signal(SignalKind::interrupt()), signal(SignalKind::terminate()));
    async move {
        let (Ok(mut interrupt), Ok(mut terminate)) = listening else {
            tracing::error!("cannot listen for signals");
            return std::future::pending().await;
        };
        tokio::select! {
            _ = interrupt.recv() => "SIGINT".into(),
            _ = terminate.recv() => "SIGTERM".into(),
        }
    }
}

/// Listen for SIGUSR1 from now on.
pub fn stop_signal() -> std::io::Result<Signal> {
    signal(SignalKind::user_defined1())
}

/// Press the stop at each of these signals, for as long as the server runs.
pub async fn stop_at_signal(app: Arc<App>, mut pressed: Signal) {
    while pressed.recv().await.is_some() {
        let received_at = std::time::Instant::now();
        let asker = Asker { by: "signal", given: Some("SIGUSR1".into()), caller: Caller::Unasked };
        match app.stop(&asker, StopLaneName::Signal, Some("SIGUSR1".into()), received_at).await {
            Ok(to_drive) => tracing::warn!(to_drive_micros = to_drive.as_micros() as u64, "SIGUSR1: stopped"),
            Err(why) => tracing::error!(%why, "SIGUSR1: the stop was not acknowledged"),
        }
    }
}

/// See each second what became of the tokens, and record it. Ends with the server.
async fn follow_tokens(app: Arc<App>) {
    let mut closing = app.closing.clone();
    let mut due = tokio::time::interval(LOOK_AT_TOKENS_EVERY);
    due.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        tokio::select! {
            _ = due.tick() => {}
            _ = closing.changed() => return,
        }
        app.follow_tokens().await;
        app.limits.forget();
    }
}

fn machine(config: &Config, clock: Clock) -> anyhow::Result<Box<dyn Gantry>> {
    match config.machine.kind {
        MachineKind::Simulated => {
            let parked = Floor::new(config.machine.parked_x_m, config.machine.parked_y_m);
            let parameters = MachineParameters {
                start: parked,
                parked,
                limits: config.machine.limits(),
                ..MachineParameters::paper(config.machine.travel())
            };
            Ok(Box::new(SimulatedMachine::new(parameters).context("the simulated machine")?))
        }
        MachineKind::RoboClaw => {
            let settings = config.machine.roboclaw.settings(config);
            let machine = roboclaw::start(settings, move || clock.now(), on_link_thread(config));
            Ok(Box::new(machine.context("the RoboClaw machine")?))
        }
        MachineKind::Odrive => {
            let settings = config.machine.odrive.settings(config);
            let machine = odrive::start(settings, move || clock.now(), on_link_thread(config));
            Ok(Box::new(machine.context("the ODrive machine")?))
        }
    }
}

/// What the thread that owns a controller's port begins with: below the control thread, above everything else.
fn on_link_thread(config: &Config) -> impl FnOnce() + Send + 'static {
    let priority = config.control.real_time.then(|| config.control.priority.saturating_sub(1).max(1));
    move || {
        let came_of_it = real_time::ask(priority);
        tracing::debug!(?came_of_it, "the link thread's scheduling");
    }
}

/// The scene of the last run; at the very first start, the one that comes with the server.
async fn active_scene(store: &Store, last: Option<(i64, i64)>) -> anyhow::Result<ActiveScene> {
    if let Some((id, version)) = last
        && let Some(stored) = store.scene(id, Some(version)).await?
    {
        match ActiveScene::build(stored) {
            Ok(active) => return Ok(active),
            Err(errors) => {
                for error in errors {
                    tracing::error!(scene = id, version, %error, "the active scene does not pass today's checks");
                }
            }
        }
    }
    let (document, _) = parse_scene(FIRST_SCENE.as_bytes()).map_err(|errors| {
        anyhow::anyhow!(
            "the scene that comes with the server: {}",
            errors.first().map(ToString::to_string).unwrap_or_default()
        )
    })?;
    let id = store.add_scene(&document, "covr").await?;
    store.set_active_scene(id, 1).await?;
    let stored = store.scene(id, Some(1)).await?.context("the scene that was just stored is missing")?;
    ActiveScene::build(stored).map_err(|errors| anyhow::anyhow!("{errors:?}"))
}

const FIRST_SCENE: &str = include_str!("../../../deploy/scenes/demo.json");
const LOOK_AT_TOKENS_EVERY: Duration = Duration::from_secs(1);
const SECS_AN_HOUR: f64 = 3_600.0;
const AT_REST_MPS: f64 = 0.01;
const LONGEST_CLOSE: Duration = Duration::from_secs(3);
