//! From the control thread's published state to what dashboards, metrics and `GET /api/v1/state` show.

use std::sync::Arc;
use std::time::{Duration, Instant};

use covr_engine::engine::outlook::POINT_EVERY;
use covr_engine::mode::Mode;
use covr_engine::time::{Span, Time};
use covr_gantry::contract::Health;
use covr_wire::dashboard::{MachineHealth, MachineLink, Snapshot, Surroundings, ToDashboard};
use metrics::{counter, gauge};
use tokio::sync::watch;

use crate::app::App;
use crate::control::Published;
use crate::meters;

/// The wire's snapshot of a published state, with the way ahead.
pub async fn wire_snapshot(app: &App, published: &Arc<Published>) -> Snapshot {
    with_path(app, published, path(published).await.0)
}

fn with_path(app: &App, published: &Published, planned_path_m: Vec<[f64; 2]>) -> Snapshot {
    let around = Surroundings {
        generation: published.generation,
        names: &app.persons.names(),
        control_loop: published.control_loop.clone(),
        machine_health: published.machine_health.as_deref().map(machine_health),
        clients: app.clients.list(),
        scene_id: Some(app.stage.active().id),
        session_id: app.recorder.session_id(),
    };
    let mut snapshot = Snapshot::new(&published.snapshot, around);
    if let Some(arm) =
        snapshot.requests.iter_mut().find(|state| state.request == "arm" && state.why.is_none())
        && let Some(why) = app.why_not_armed()
    {
        arm.refused_because = Some(why.to_string());
        arm.why = Some(why);
    }
    snapshot.column.planned_path_m = planned_path_m;
    snapshot
}

fn machine_health(health: &Health) -> MachineHealth {
    let link = &health.link;
    MachineHealth {
        firmware: health.firmware.clone(),
        profile: health.profile.clone(),
        trouble: health.trouble.map(Into::into),
        condition: health.condition.clone(),
        supply_volts: health.supply_volts,
        temperature_c: health.temperature_c,
        link: MachineLink {
            rate_hz: link.rate_hz,
            cycle_p50_micros: link.cycle_p50_micros,
            cycle_p99_micros: link.cycle_p99_micros,
            cycle_max_micros: link.cycle_max_micros,
            exchanges: link.exchanges,
            lost: link.lost,
            repeated: link.repeated,
            cycles_lost: link.cycles_lost,
            last_loss: link.last_loss.clone(),
            connections: link.connections,
        },
    }
}

/// Milliseconds of arithmetic: not on a thread that serves others. With the time that it took; empty if it was not finished.
async fn path(published: &Arc<Published>) -> (Vec<[f64; 2]>, Duration) {
    let published = published.clone();
    let found = tokio::task::spawn_blocking(move || {
        let began = Instant::now();
        let path = published.outlook.path().iter().map(|at| [at.x, at.y]).collect();
        (path, began.elapsed())
    });
    found.await.unwrap_or_default()
}

/// The way ahead, for all dashboards: looked at as often as its points are apart, and at once in another mode. Ways that are
/// dear to find, with a planner and many people, are looked at less often.
#[derive(Default)]
struct Ahead {
    looked: Option<(Mode, Time)>,
    took: Duration,
    path_m: Vec<[f64; 2]>,
}

impl Ahead {
    async fn path(&mut self, published: &Arc<Published>) -> Vec<[f64; 2]> {
        let now = (published.snapshot.mode, published.snapshot.at);
        let every = POINT_EVERY.max(Span::from_secs(self.took.as_secs_f64() / MOST_OF_A_CORE));
        let is_fresh = |(mode, at): (Mode, Time)| mode == now.0 && now.1 - at < every;
        if !self.looked.is_some_and(is_fresh) {
            self.looked = Some(now);
            (self.path_m, self.took) = path(published).await;
        }
        self.path_m.clone()
    }
}

/// Turn each newly published state into a dashboard's frame, once for all of them, and into metrics.
pub async fn publish(app: Arc<App>, frames: watch::Sender<Arc<str>>) {
    let mut published = app.control.watch_published();
    let mut meter = Meter::new();
    let mut ahead = Ahead::default();
    loop {
        let now = published.borrow_and_update().clone();
        if frames.receiver_count() > 1 {
            let message = ToDashboard::Snapshot(Box::new(with_path(&app, &now, ahead.path(&now).await)));
            match serde_json::to_string(&message) {
                Ok(text) => {
                    frames.send_replace(text.into());
                }
                Err(error) => tracing::error!(%error, "a snapshot cannot be written as JSON"),
            }
        }
        meter.show(&app, &now, frames.receiver_count() - 1);
        if published.changed().await.is_err() {
            return;
        }
    }
}

/// What looking ahead may take of a core: dashboards are promised 5 % in all.
const MOST_OF_A_CORE: f64 = 0.02;

/// Metrics, at most four times a second.
struct Meter {
    next: Instant,
    next_upkeep: Instant,
}

impl Meter {
    fn new() -> Self {
        Self { next: Instant::now(), next_upkeep: Instant::now() }
    }

    fn show(&mut self, app: &App, published: &Published, dashboards: usize) {
        if Instant::now() < self.next {
            return;
        }
        self.next = Instant::now() + Duration::from_millis(250);
        if Instant::now() >= self.next_upkeep {
            self.next_upkeep = Instant::now() + Duration::from_secs(5);
            meters::upkeep(&app.prometheus);
        }
        gauge!("covr_build_info", "version" => env!("CARGO_PKG_VERSION")).set(1.0);
        let control_loop = &published.control_loop;
        counter!("covr_control_steps_total").absolute(control_loop.steps);
        counter!("covr_control_missed_deadlines_total").absolute(control_loop.missed_deadlines);
        gauge!("covr_control_lateness_p99_seconds").set(control_loop.lateness_p99_micros * 1e-6);
        gauge!("covr_control_lateness_max_seconds").set(control_loop.lateness_max_micros * 1e-6);
        for mode in Mode::ALL {
            let is_it = published.snapshot.mode == mode;
            gauge!("covr_mode", "mode" => mode.name()).set(if is_it { 1.0 } else { 0.0 });
        }
        counter!("covr_events_dropped_total").absolute(app.control.events_dropped() + app.recorder.dropped());
        counter!("covr_recording_dropped_frames_total").absolute(app.recording.dropped());
        let clients = app.clients.list();
        meters::show_links(&clients);
        gauge!("covr_clients").set(clients.len() as f64);
        gauge!("covr_dashboards").set(dashboards as f64);
        gauge!("covr_persons").set(published.snapshot.persons.len() as f64);
        gauge!("covr_session_running").set(if app.recorder.session_id().is_some() { 1.0 } else { 0.0 });
        let speed = published.snapshot.column.velocity.norm();
        gauge!("covr_column_speed_mps").set(speed);
    }
}
