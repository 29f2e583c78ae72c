//! Metrics for Prometheus: what each is called and means, and the recorder behind `GET /metrics`.
//!
//! Samples of histograms wait in lock-free buckets until [`upkeep`] or a scrape folds them up, so that a server that
//! nobody scrapes does not grow.

use std::sync::OnceLock;
use std::time::Duration;

use covr_engine::snapshot::RuleId;
use covr_wire::dashboard::Client;
use metrics::{
    Counter, Histogram, counter, describe_counter, describe_gauge, describe_histogram, gauge, histogram,
};
use metrics_exporter_prometheus::{Matcher, PrometheusBuilder, PrometheusHandle};
use metrics_util::MetricKindMask;

use crate::control::StopLaneName;
use crate::inputs;
use crate::store::SessionEnd;

/// What every client's messages count into, looked up once.
pub struct ClientMeters {
    /// Poses accepted.
    pub poses: Counter,
    /// Messages refused.
    pub errors: Counter,
    /// Age of each pose at its reception, s.
    pub pose_age: Histogram,
}

impl Default for ClientMeters {
    /// Of this process.
    fn default() -> Self {
        Self {
            poses: counter!("covr_poses_total"),
            errors: counter!("covr_client_errors_total"),
            pose_age: histogram!("covr_pose_age_seconds"),
        }
    }
}

/// One recorder of metrics for the process, however many servers a test starts.
pub fn install() -> anyhow::Result<PrometheusHandle> {
    static HANDLE: OnceLock<Result<PrometheusHandle, String>> = OnceLock::new();
    HANDLE
        .get_or_init(|| {
            let handle = builder().and_then(PrometheusBuilder::install_recorder);
            describe();
            handle.map_err(|why| why.to_string())
        })
        .clone()
        .map_err(|why| anyhow::anyhow!("metrics: {why}"))
}

/// Fold up what histograms have taken in; to be called every few seconds.
pub fn upkeep(handle: &PrometheusHandle) {
    handle.run_upkeep();
}

/// How the links of these clients stand. The gauges of a client that is gone, or that sends no poses, go after
/// [`IDLE_GAUGE`].
pub fn show_links(clients: &[Client]) {
    for client in clients {
        let show = |name: &'static str, value: Option<f64>, to_base: f64| {
            if let Some(value) = value {
                gauge!(name, "client" => client.name.clone()).set(value * to_base);
            }
        };
        show("covr_client_pose_age_max_seconds", client.pose_age_millis, 1e-3);
        show("covr_client_jitter_seconds", client.jitter_millis, 1e-3);
        show("covr_client_loss_ratio", client.loss_percent, 1e-2);
        show("covr_client_rtt_seconds", client.rtt_millis, 1e-3);
        show("covr_client_pose_rate_hz", Some(client.pose_rate_hz), 1.0);
    }
}

/// How late each step of the control loop began.
pub fn lateness() -> Histogram {
    histogram!("covr_control_lateness_seconds")
}

/// A stop reached the drive, or did not.
pub fn stop_pressed(lane: &'static str, to_drive: Option<Duration>) {
    counter!("covr_stops_pressed_total", "lane" => lane).increment(1);
    match to_drive {
        Some(to_drive) => histogram!("covr_stop_to_drive_seconds").record(to_drive.as_secs_f64()),
        None => counter!("covr_stops_unacknowledged_total").increment(1),
    }
}

/// A rule was breached.
pub fn rule_breached(rule: RuleId) {
    counter!("covr_rule_breaches_total", "rule" => rule.name()).increment(1);
}

/// A session ended.
pub fn session_ended(how: SessionEnd) {
    counter!("covr_sessions_total", "ended" => how.name()).increment(1);
}

/// An HTTP request was answered. `route` as registered, never the path that was asked for.
pub fn http_answered(method: &'static str, route: String, status: u16, took: Duration) {
    let labels = [("method", method.to_owned()), ("route", route), ("status", status.to_string())];
    histogram!("covr_http_request_duration_seconds", &labels).record(took.as_secs_f64());
}

/// Register what has no labels or few, so that it is there from the first scrape on and a first increment is seen.
fn describe() {
    for (name, meaning) in COUNTERS {
        describe_counter!(*name, *meaning);
    }
    for (name, meaning) in GAUGES {
        describe_gauge!(*name, *meaning);
    }
    for (name, meaning, _) in HISTOGRAMS {
        describe_histogram!(*name, *meaning);
    }
    let _ = (ClientMeters::default(), lateness(), histogram!("covr_stop_to_drive_seconds"));
    for name in [
        "covr_store_errors_total",
        "covr_stops_unacknowledged_total",
        "covr_events_dropped_total",
        "covr_recording_dropped_frames_total",
    ] {
        counter!(name).increment(0);
    }
    for lane in StopLaneName::ALL.map(StopLaneName::name).into_iter().chain([inputs::LANE]) {
        counter!("covr_stops_pressed_total", "lane" => lane).increment(0);
    }
    for rule in 1..=16 {
        counter!("covr_rule_breaches_total", "rule" => RuleId(rule).name()).increment(0);
    }
    for how in SessionEnd::ALL {
        counter!("covr_sessions_total", "ended" => how.name()).increment(0);
    }
}

fn builder() -> Result<PrometheusBuilder, metrics_exporter_prometheus::BuildError> {
    let mut builder = PrometheusBuilder::new().idle_timeout(MetricKindMask::GAUGE, Some(IDLE_GAUGE));
    for (name, _, buckets) in HISTOGRAMS {
        builder = builder.set_buckets_for_metric(Matcher::Full((*name).into()), buckets)?;
    }
    Ok(builder)
}

const COUNTERS: &[(&str, &str)] = &[
    ("covr_poses_total", "Poses accepted."),
    ("covr_client_errors_total", "Messages of VR clients refused."),
    ("covr_store_errors_total", "Writes to the database that failed."),
    ("covr_events_dropped_total", "Events that found the recorder's queue full."),
    ("covr_recording_dropped_frames_total", "Frames of a session that its recording lost."),
    ("covr_control_steps_total", "Steps of the control loop."),
    ("covr_control_missed_deadlines_total", "Steps that began more than one period late."),
    ("covr_stops_pressed_total", "Software stops pressed, by lane."),
    ("covr_stops_unacknowledged_total", "Software stops that the drive did not acknowledge in time."),
    ("covr_rule_breaches_total", "Breaches of safety rules, by rule."),
    ("covr_sessions_total", "Sessions ended, by how."),
];

const GAUGES: &[(&str, &str)] = &[
    ("covr_build_info", "1; its label is the version."),
    ("covr_mode", "1 for the mode of the machine, 0 for the others."),
    ("covr_control_lateness_p99_seconds", "99th percentile of the control loop's lateness over 10 s."),
    ("covr_control_lateness_max_seconds", "Greatest lateness of the control loop over 10 s."),
    ("covr_clients", "VR clients connected."),
    ("covr_dashboards", "Dashboards connected."),
    ("covr_persons", "Persons in the arena."),
    ("covr_session_running", "1 while a session runs."),
    ("covr_column_speed_mps", "Speed of the column, m/s."),
    ("covr_client_pose_age_max_seconds", "Greatest age of a pose at its reception over the last second."),
    ("covr_client_jitter_seconds", "Interarrival jitter of the poses (RFC 3550)."),
    ("covr_client_loss_ratio", "Poses missing in their sequence over the last 10 s, 0 to 1."),
    ("covr_client_rtt_seconds", "Least round trip of the clock window."),
    ("covr_client_pose_rate_hz", "Poses a second over the last second."),
];

const HISTOGRAMS: &[(&str, &str, &[f64])] = &[
    (
        "covr_pose_age_seconds",
        "Age of each pose at its reception.",
        &[0.002, 0.005, 0.01, 0.02, 0.035, 0.05, 0.075, 0.1, 0.15, 0.25, 0.5, 1.0],
    ),
    (
        "covr_control_lateness_seconds",
        "How late each step of the control loop began.",
        &[2.5e-5, 5e-5, 1e-4, 2e-4, 4e-4, 8e-4, 1.5e-3, 3e-3, 4e-3, 8e-3, 1.6e-2, 5e-2],
    ),
    (
        "covr_stop_to_drive_seconds",
        "From the reception of a stop to the braking command at the drive.",
        &[0.001, 0.002, 0.004, 0.006, 0.008, 0.012, 0.02, 0.05, 0.1, 0.5, 1.0],
    ),
    (
        "covr_http_request_duration_seconds",
        "From the request's head to the answer's, by method, route and status.",
        &[5e-4, 1e-3, 2.5e-3, 5e-3, 1e-2, 2.5e-2, 5e-2, 0.1, 0.25, 1.0, 5.0],
    ),
];

/// Four shows of a client, many times over; a scrape each minute misses none that is there.
const IDLE_GAUGE: Duration = Duration::from_secs(10);
