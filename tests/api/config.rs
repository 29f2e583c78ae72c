//! The configuration in force.

use covr_server::config::keys;
use covr_tests::server::TestServer;
use covr_wire::records::{ConfigInForce, ConfigOrigin};

#[tokio::test]
async fn every_key_tells_its_value_its_default_its_meaning_and_who_set_it() {
    let server = TestServer::start_with(|config| config.control.publish_hz = 20.0).await;
    let found = server.good("GET", "/api/v1/config", None).await;
    let found: ConfigInForce = serde_json::from_value(found).unwrap();
    assert_eq!(found.version, env!("CARGO_PKG_VERSION"));
    assert!(found.built.rustc.starts_with("rustc "), "{:?}", found.built);
    assert!(found.built.target.contains("linux"), "{:?}", found.built);
    assert_eq!(found.keys.len(), keys().len());
    let key = |name: &str| found.keys.iter().find(|key| key.name == name).unwrap();
    let publish = key("control.publish_hz");
    assert_eq!((&publish.value, &publish.default), (&20.0.into(), &30.0.into()));
    assert_eq!(publish.from, ConfigOrigin::CommandLine);
    assert!(publish.meaning.contains("Hz") && publish.accepts.contains("from 1 to 120"));
    assert_eq!(key("control.rate_hz").from, ConfigOrigin::Default);
    assert_eq!(key("machine.travel_m").value, serde_json::json!([0.0, 0.0, 1.0, 1.0]));
    assert_eq!(key("recording.enabled").value, true);
}
