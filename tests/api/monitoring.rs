//! What `deploy/monitoring` asks Prometheus for is what a running server has.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use covr_tests::client::VrClient;
use covr_tests::eventually;
use covr_tests::server::TestServer;
use covr_wire::client::{Encoding, ToClient};
use serde_json::{Value, json};

#[tokio::test]
async fn every_metric_of_the_rules_and_the_dashboard_is_on_a_running_server() {
    let server = TestServer::start().await;
    let mut client = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    client.enter("ada").await;
    // Two poses have a jitter; two pings close an exchange.
    for turn in 0..2 {
        client.pose("ada", 1.0, 1.0).await;
        let previous = (turn > 0).then(|| json!({"id": 0, "received_client_time_micros": 900}));
        let mut ping = json!({"type": "clock_ping", "id": turn, "client_time_micros": 1_000 * turn});
        if let Some(previous) = previous {
            ping["previous"] = previous;
        }
        client.say(&ping).await;
        client.hear("a pong", |message| matches!(message, ToClient::ClockPong(_)).then_some(())).await;
    }

    let mut asked = BTreeSet::new();
    for expression in expressions() {
        asked.extend(metrics_in(&expression));
    }
    assert!(asked.len() > 20, "{asked:?}");
    eventually("every metric that is asked for", || async {
        let text = server.call("GET", "/metrics", None).await.text().await.unwrap();
        let types = text.lines().filter_map(|line| line.strip_prefix("# TYPE ")?.split_once(' '));
        let there: BTreeSet<String> = types.map(|(name, _)| name.to_owned()).collect();
        let missing: Vec<&String> = asked.difference(&there).collect();
        if missing.is_empty() {
            return Some(());
        }
        eprintln!("still missing: {missing:?}");
        None
    })
    .await;
}

#[test]
fn every_alert_says_how_grave_it_is_and_what_to_do() {
    for rule in alerts() {
        let name = rule["alert"].as_str().unwrap();
        assert!(matches!(rule["labels"]["severity"].as_str(), Some("warning" | "critical")), "{name}");
        for words in ["summary", "action"] {
            assert!(
                rule["annotations"][words].as_str().is_some_and(|text| !text.is_empty()),
                "{name}: {words}"
            );
        }
    }
}

#[test]
fn prometheus_and_grafana_are_told_of_files_that_are_there() {
    let prometheus = yaml("prometheus.yml");
    for file in prometheus["rule_files"].as_array().unwrap() {
        assert!(folder().join(file.as_str().unwrap()).exists(), "{file}");
    }
    assert_eq!(prometheus["scrape_configs"][0]["job_name"], "covr", "the rules ask for up{{job=\"covr\"}}");
    yaml("grafana/provisioning/datasources/covr.yml");
    yaml("grafana/provisioning/dashboards/covr.yml");
    for service in ["prometheus", "grafana"] {
        for mount in yaml("../compose.yaml")["services"][service]["volumes"].as_array().unwrap() {
            let (here, _) = mount.as_str().unwrap().split_once(':').unwrap();
            let is_file = here.starts_with('.');
            assert!(!is_file || folder().join("..").join(here).exists(), "{mount}");
        }
    }
    let mut ids = BTreeSet::new();
    for panel in dashboard()["panels"].as_array().unwrap() {
        assert!(ids.insert(panel["id"].as_u64().unwrap()), "panel {panel} has the number of another");
        let is_row = panel["type"] == "row";
        assert!(is_row || !panel["targets"].as_array().unwrap().is_empty(), "{}", panel["title"]);
    }
}

/// Every PromQL expression of rules and dashboard.
fn expressions() -> Vec<String> {
    let of_rules = alerts().into_iter().map(|rule| rule["expr"].clone());
    let panels = dashboard()["panels"].as_array().unwrap().clone();
    let targets = panels.into_iter().filter_map(|panel| panel["targets"].as_array().cloned()).flatten();
    let expressions = of_rules.chain(targets.map(|target| target["expr"].clone()));
    expressions.map(|expression| expression.as_str().unwrap().to_owned()).collect()
}

/// The server's metrics that an expression names; a histogram's series by the histogram's name.
fn metrics_in(expression: &str) -> BTreeSet<String> {
    let words = expression.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    words
        .filter(|word| word.starts_with("covr_"))
        .map(|word| {
            let suffix = ["_bucket", "_sum", "_count"].into_iter().find_map(|end| word.strip_suffix(end));
            suffix.unwrap_or(word).to_owned()
        })
        .collect()
}

fn alerts() -> Vec<Value> {
    let groups = yaml("rules.yml")["groups"].as_array().unwrap().clone();
    groups.into_iter().flat_map(|group| group["rules"].as_array().unwrap().clone()).collect()
}

fn dashboard() -> Value {
    serde_json::from_str(&read("grafana/dashboards/covr.json")).unwrap()
}

fn yaml(file: &str) -> Value {
    serde_yaml_ng::from_str(&read(file)).unwrap_or_else(|why| panic!("{file}: {why}"))
}

fn read(file: &str) -> String {
    std::fs::read_to_string(folder().join(file)).unwrap_or_else(|why| panic!("{file}: {why}"))
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../deploy/monitoring")
}
