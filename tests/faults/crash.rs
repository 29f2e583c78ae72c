//! Kill -9 while everything is written at once.

use std::cell::RefCell;
use std::time::Duration;

use covr_study::random::Random;
use covr_tests::process::Process;
use serde_json::{Value, json};
use tempfile::TempDir;

/// What the server acknowledged, and what it was asked last without an answer.
#[derive(Debug, Clone, Default)]
struct Said {
    /// Number and name of every scene stored.
    scenes: Vec<(i64, String)>,
    /// The prior last acknowledged, and the one asked for after it.
    prior: (Option<f64>, Option<f64>),
    /// Whether a stop is latched; none while the answer is awaited.
    latched: Option<bool>,
}

#[tokio::test]
async fn killed_at_random_moments_it_keeps_every_acknowledged_write_and_starts_disarmed_or_latched() {
    let dir = TempDir::new().unwrap();
    let mut random = Random::seeded(5);
    let said = RefCell::new(Said { latched: Some(false), ..Said::default() });
    for round in 0..6 {
        let server = Process::serve(dir.path()).await;
        let known = said.borrow().clone();
        check(&server, &known).await;
        let moment = Duration::from_secs_f64(random.between(0.02, 0.6));
        tokio::select! {
            () = write_for_ever(&server, round, &said) => {}
            // The moment of the kill is the fault.
            () = tokio::time::sleep(moment) => {}
        }
        server.kill_9();
    }
    let server = Process::serve(dir.path()).await;
    let said = said.into_inner();
    check(&server, &said).await;
    server.stop().await;
    assert!(
        said.scenes.len() > 5 && said.prior.0.is_some(),
        "too little was written to prove anything: {said:?}"
    );
}

async fn check(server: &Process, said: &Said) {
    let state = server.good("GET", "/api/v1/state", None).await;
    match (state["mode"].as_str().unwrap(), said.latched) {
        ("latched_stop", Some(true) | None) | ("disarmed", Some(false) | None) => {}
        (mode, latched) => panic!("{mode} after a run that ended latched: {latched:?}"),
    }
    for (id, name) in &said.scenes {
        let scene = server.good("GET", &format!("/api/v1/scenes/{id}"), None).await;
        assert_eq!(&scene["name"], name, "an acknowledged scene is not there");
    }
    if let (Some(acknowledged), asked) = said.prior {
        let objects = state["objects"].as_array().unwrap();
        let lamp = objects.iter().find(|object| object["id"] == "lamp").unwrap()["prior"].as_f64();
        assert!(
            lamp == Some(acknowledged) || lamp == asked,
            "{lamp:?}, acknowledged {acknowledged}, asked {asked:?}"
        );
    }
}

async fn write_for_ever(server: &Process, round: usize, said: &RefCell<Said>) {
    let mut scene = server.good("GET", "/api/v1/scenes/1", None).await;
    for turn in 0.. {
        let name = format!("round {round} turn {turn}");
        scene["name"] = name.clone().into();
        let stored = server.good("POST", "/api/v1/scenes", Some(&scene.to_string())).await;
        said.borrow_mut().scenes.push((stored["id"].as_i64().unwrap(), name));

        let prior = f64::from(turn % 100) / 100.0;
        said.borrow_mut().prior.1 = Some(prior);
        server.good("PATCH", "/api/v1/priors", Some(&json!({ "lamp": prior }).to_string())).await;
        said.borrow_mut().prior = (Some(prior), None);

        said.borrow_mut().latched = None;
        let latched = turn % 2 == 0;
        let (path, body): (_, Option<Value>) = if latched {
            ("/api/v1/stop", None)
        } else {
            ("/api/v1/reset", Some(json!({ "reason": "looked" })))
        };
        server.good("POST", path, body.map(|body| body.to_string()).as_deref()).await;
        said.borrow_mut().latched = Some(latched);
    }
}
