//! The operator: stops by every lane, looks that each stopped, and gets the machine going again; stores scenes and priors.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use covr_study::random::Random;
use covr_tests::dashboard::Dashboard;
use covr_tests::process::Process;
use covr_tests::{HOMED, eventually, eventually_within};
use covr_wire::dashboard::{FromDashboard, ToDashboard};
use nix::sys::signal::Signal;
use serde_json::{Value, json};

use crate::BREATH;

/// A stop input as a value file.
pub struct Button(PathBuf);

/// What the server acknowledged.
#[derive(Debug, Default)]
pub struct Done {
    /// Stops by lane, as the record names the lanes.
    pub stops: BTreeMap<&'static str, i64>,
    /// Number and name of each scene.
    pub scenes: Vec<(i64, String)>,
    /// Changes of priors.
    pub priors: i64,
}

/// The operator.
pub struct Operator<'a> {
    server: &'a Process,
    button: Button,
    random: Random,
    done: Done,
    /// What was active before the last activation.
    scene: i64,
}

impl Button {
    /// Let go.
    pub fn new(dir: &Path) -> Self {
        let button = Self(dir.join("button"));
        button.set(false);
        button
    }

    /// `safety.inputs` for it.
    pub fn configuration(&self) -> String {
        format!(
            "[{{name = \"button\", kind = \"stop\", source = \"{}\", heartbeat_timeout_secs = 5.0}}]",
            self.0.display()
        )
    }

    fn set(&self, pressed: bool) {
        let next = self.0.with_extension("next");
        std::fs::write(&next, if pressed { "0\n" } else { "1\n" }).unwrap();
        std::fs::rename(&next, &self.0).unwrap();
    }
}

impl<'a> Operator<'a> {
    /// At the desk of this server.
    pub fn new(server: &'a Process, button: Button) -> Self {
        Self { server, button, random: Random::seeded(4), done: Done::default(), scene: 1 }
    }

    /// Get the machine going, change something, stop by some lane. Ends latched.
    pub async fn act(&mut self) {
        self.get_going().await;
        for _ in 0..1 + self.random.below(6) {
            self.change_something().await;
            tokio::time::sleep(BREATH).await;
        }
        self.stop().await;
    }

    /// What was done.
    pub fn done(self) -> Done {
        self.done
    }

    async fn get_going(&self) {
        eventually_within(HOMED, "the machine is armed", || async {
            let state = self.server.good("GET", "/api/v1/state", None).await;
            let path = match state["mode"].as_str().unwrap() {
                "latched_stop" | "faulted" => "reset",
                "disarmed" if refused(&state, "arm") => "home",
                "disarmed" | "ready" => "arm",
                "following" | "protective_stop" => return Some(()),
                _ => return None,
            };
            // A refusal has its time: the column has to rest first.
            self.server.call("POST", &format!("/api/v1/{path}"), Some("{\"reason\": \"soak\"}")).await;
            None
        })
        .await;
    }

    async fn change_something(&mut self) {
        if self.random.chance(0.5) {
            let prior = (self.random.unit() * 1e6).round() / 1e6;
            self.server.good("PATCH", "/api/v1/priors", Some(&json!({ "lamp": prior }).to_string())).await;
            self.done.priors += 1;
            return;
        }
        let mut scene = self.server.good("GET", "/api/v1/scenes/1", None).await;
        let name = format!("soak {}", self.done.scenes.len());
        scene["name"] = name.clone().into();
        let stored = self.server.good("POST", "/api/v1/scenes", Some(&scene.to_string())).await;
        let id = stored["id"].as_i64().unwrap();
        self.done.scenes.push((id, name));
        // Refused where the column stands too near a keep-out: the scene in force stays.
        self.server.call("PUT", &format!("/api/v1/scenes/{}/activate", self.scene), None).await;
        self.scene = id;
    }

    async fn stop(&mut self) {
        let lane = ["http", "dashboard", "signal", "input"][self.random.below(4)];
        match lane {
            "http" => self.server.stop().await,
            "dashboard" => self.stop_by_dashboard().await,
            "signal" => self.server.signal(Signal::SIGUSR1),
            _ => self.button.set(true),
        }
        self.server.mode("latched_stop").await;
        *self.done.stops.entry(lane).or_default() += 1;
        self.button.set(false);
        // The lanes that answer nobody are recorded a moment later, and the end of the run is a kill -9.
        let counted = format!("covr_stops_pressed_total{{lane=\"{lane}\"}}");
        let pressed = self.done.stops[lane] as f64;
        eventually("the stop is counted", || async {
            (self.server.metric(&counted).await >= pressed).then_some(())
        })
        .await;
        self.settle().await;
    }

    async fn stop_by_dashboard(&self) {
        let mut dashboard = Dashboard::connect(&self.server.host()).await;
        dashboard.say(&FromDashboard::Stop { request_id: 7, reason: None }).await;
        let answered = |m: &ToDashboard| {
            matches!(m, ToDashboard::Answer { request_id: 7, to_drive_micros: Some(_), .. })
        };
        dashboard.hear("the stop's answer", |m| answered(m).then_some(())).await;
    }

    /// The record is written in order: an answered act comes after all that was recorded before it.
    async fn settle(&self) {
        self.server.call("POST", "/api/v1/disarm", None).await;
    }
}

fn refused(state: &Value, request: &str) -> bool {
    let requests = state["requests"].as_array().unwrap();
    let asked = requests.iter().find(|found| found["request"] == request).unwrap();
    !asked["refused_because"].is_null()
}
