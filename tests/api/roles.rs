//! Who may do what: every route of the published contract and every message of both sockets, with every role.

use std::collections::BTreeSet;

use covr_server::access::{Role, Who, table};
use covr_tests::client::VrClient;
use covr_tests::dashboard::Dashboard;
use covr_tests::eventually;
use covr_tests::server::{TestServer, problem};
use covr_wire::client::{Encoding, ErrorCode, FromClient, ToClient};
use covr_wire::dashboard::{FromDashboard, MachineRequest, Outcome, ToDashboard};
use covr_wire::examples;
use serde_json::{Value, json};

use crate::openapi::operations;

/// Every role with a token of it, and nobody.
async fn everybody(server: &TestServer) -> Vec<(Option<Role>, Option<String>)> {
    let mut all = vec![(None, None)];
    for role in Role::ALL {
        all.push((Some(role), Some(server.token(role).await)));
    }
    all
}

#[tokio::test]
async fn every_route_answers_the_roles_of_the_table_and_no_other() {
    let server = TestServer::start().await;
    let contract = server.contract().await;
    let everybody = everybody(&server).await;
    let mut walked = BTreeSet::new();
    for operation in operations(contract) {
        let key = format!("{} {}", operation.method, operation.path);
        let who = table::who_may(&key).unwrap_or_else(|| panic!("the table does not have {key}"));
        let said = operation.about.get("x-covr-roles").cloned();
        let roles = match who {
            Who::Anybody => None,
            Who::Roles(roles) => Some(roles.iter().map(|role| role.name()).collect::<Value>()),
        };
        assert_eq!(said, roles, "{key}: what the contract says");
        for (role, token) in &everybody {
            let (address, body) = (operation.address(), operation.body());
            let response = server.call_with(token.as_deref(), &operation.method, &address, body.as_deref());
            let status = response.await.status().as_u16();
            let expected = match (who.includes(*role), role) {
                (true, _) => None,
                (false, None) => Some(401),
                (false, Some(_)) => Some(403),
            };
            // Signing in is open to everybody, and refuses a wrong token: the example is one.
            let is_sign_in = key == "POST /api/v1/login";
            let refused = Some(status).filter(|status| [401, 403].contains(status) && !is_sign_in);
            assert_eq!(refused, expected, "{key} for {role:?}: {status}");
            assert!(operation.about["responses"].get(status.to_string()).is_some(), "{key}: {status}");
        }
        walked.insert(key);
    }
    let of_http = table::keys().filter(|key| key.contains(" /")).map(str::to_owned);
    let missing: Vec<_> = of_http.filter(|key| !walked.contains(key)).collect();
    assert_eq!(missing, ["GET /api/docs"], "in the table and not in the contract");
}

#[tokio::test]
async fn what_is_no_token_in_force_is_refused_and_stops_all_the_same() {
    let server = TestServer::start().await;
    let ended = server.token_until(Role::GameMaster, Some("2026-01-02T00:00:00Z")).await;
    let other_secret = format!("{}{}", &ended[..20], "0".repeat(ended.len() - 20));
    for token in [None, Some(ended.as_str()), Some(other_secret.as_str()), Some("covr_nonsense"), Some("")] {
        let response = server.call_with(token, "GET", "/api/v1/state", None).await;
        assert_eq!(response.headers()["www-authenticate"], "Bearer");
        problem(401, "/api/v1/state", response).await;
        let stopped = server.call_with(token, "POST", "/api/v1/stop", None).await;
        assert_eq!(stopped.status(), 200, "{token:?} stops");
    }
    assert_eq!(server.app.control.published().snapshot.mode.name(), "latched_stop");
}

#[tokio::test]
async fn a_token_that_is_used_as_soon_as_it_is_made_is_in_the_record_all_the_same() {
    let server = TestServer::start().await;
    let token = server.token(Role::Observer).await;
    eventually("it is in the record", || async {
        let events = server.app.store.events(50, &Default::default()).await.unwrap().events;
        events.iter().any(|event| event.detail["token_id"] == token[5..13]).then_some(())
    })
    .await;
}

#[tokio::test]
async fn a_database_that_does_not_answer_is_no_wrong_token_and_stops_nobody_who_is_known() {
    let server = TestServer::start().await;
    let known = server.token(Role::Observer).await;
    assert_eq!(server.call_with(Some(&known), "GET", "/api/v1/state", None).await.status(), 200);
    server.app.store.close().await;
    let unknown = format!("covr_00000000_{}", "0".repeat(64));
    let response = server.call_with(Some(&unknown), "GET", "/api/v1/state", None).await;
    assert_eq!(response.headers().get("www-authenticate"), None);
    problem(503, "/api/v1/state", response).await;
    assert_eq!(server.call_with(Some(&known), "GET", "/api/v1/state", None).await.status(), 200);
    assert_eq!(server.call_with(Some(&unknown), "POST", "/api/v1/stop", None).await.status(), 200);
}

#[tokio::test]
async fn a_token_that_is_taken_back_ends_what_its_holder_has_open() {
    let server = TestServer::start().await;
    let (master, headset) = (server.token(Role::GameMaster).await, server.token(Role::Client).await);
    let mut dashboard = Dashboard::connect_with(&server.host, Some(&master)).await.ok().unwrap();
    let mut client = VrClient::connect(&server.host, Encoding::Json).await;
    client.say(&json!({"type": "hello", "name": "h", "convention": "openxr", "token": headset})).await;
    client.hear("a welcome", |m| matches!(m, ToClient::Welcome(_)).then_some(())).await;
    for token in [&master, &headset] {
        let id = &token[5..13];
        assert!(server.app.store.revoke_token(id, "2026-01-02T00:00:00Z").await.unwrap().is_some());
    }
    assert_eq!(client.error().await.code, ErrorCode::Unauthorized);
    assert!(dashboard.closed().await.unwrap().reason.contains("taken back"));
    let response = server.call_with(Some(&master), "GET", "/api/v1/state", None).await;
    problem(401, "/api/v1/state", response).await;
    eventually("it is in the record", || async {
        let events = server.app.store.events(50, &Default::default()).await.unwrap().events;
        (events.iter().filter(|event| event.kind == "token_revoked").count() == 2).then_some(())
    })
    .await;
}

#[tokio::test]
async fn every_message_of_a_dashboard_is_answered_to_the_roles_of_the_table_and_no_other() {
    let server = TestServer::start().await;
    let requests = types_of_requests();
    let messages: Vec<FromDashboard> = std::iter::once(FromDashboard::Stop { request_id: 1, reason: None })
        .chain(requests.into_iter().map(|request| FromDashboard::Request {
            request_id: 2,
            request,
            reason: Some("walked".into()),
        }))
        .chain([FromDashboard::Jog { request_id: 3, to: None, speed_mps: 0.0 }])
        .collect();
    let keys: BTreeSet<_> = messages.iter().map(table::dashboard_key).collect();
    let of_dashboards: BTreeSet<_> = table::keys().filter(|key| key.starts_with("dashboard ")).collect();
    assert_eq!(keys, of_dashboards);
    for (role, token) in everybody(&server).await {
        let may_look_on = table::who_may("GET /ws/v1/dashboard").unwrap().includes(role);
        let mut dashboard = match Dashboard::connect_with(&server.host, token.as_deref()).await {
            Ok(dashboard) => dashboard,
            Err(status) => {
                assert_eq!(
                    (may_look_on, status),
                    (false, if role.is_none() { 401 } else { 403 }),
                    "{role:?}"
                );
                continue;
            }
        };
        assert!(may_look_on, "{role:?} looks on");
        for message in &messages {
            dashboard.say(message).await;
            let (outcome, detail) = dashboard
                .hear("an answer", |m| match m {
                    ToDashboard::Answer { outcome, detail, .. } => Some((*outcome, detail.clone())),
                    _ => None,
                })
                .await;
            let key = table::dashboard_key(message);
            let is_of_the_role = outcome == Outcome::Refused && detail.contains("who may not");
            assert_eq!(
                is_of_the_role,
                !table::who_may(key).unwrap().includes(role),
                "{key}: {role:?}: {detail}"
            );
        }
    }
}

#[tokio::test]
async fn every_message_of_a_vr_client_is_taken_from_the_roles_of_the_table_and_no_other() {
    let server = TestServer::start().await;
    let messages = examples::from_client();
    let keys: BTreeSet<_> = messages.iter().map(table::client_key).collect();
    let of_clients: BTreeSet<_> = table::keys().filter(|key| key.starts_with("client ")).collect();
    assert_eq!(keys, of_clients);
    for (role, token) in everybody(&server).await {
        for message in &messages {
            let key = table::client_key(message);
            let may = table::who_may(key).unwrap().includes(role);
            let mut client = VrClient::connect(&server.host, Encoding::Json).await;
            let is_hello = matches!(message, FromClient::Hello(_));
            if !matches!(message, FromClient::ClockPing(_)) {
                let hello = json!({"type": "hello", "name": key, "convention": "openxr", "token": token});
                client.say(&hello).await;
            }
            if !is_hello {
                client.say(&serde_json::to_value(message).unwrap()).await;
            }
            // A ping after it shows that it was taken: what is refused for its role ends the connection.
            client.say(&json!({"type": "clock_ping", "id": 77, "client_time_micros": 1})).await;
            let refused = client
                .hear("a pong or the end", |m| match m {
                    ToClient::Error(error) if error.code == ErrorCode::Unauthorized => Some(true),
                    ToClient::ClockPong(pong) if pong.id == 77 => Some(false),
                    _ => None,
                })
                .await;
            assert_eq!(refused, !may, "{key}: {role:?}");
            client.socket.close(None).await.ok();
            eventually("the seat is free", || async { server.app.clients.list().is_empty().then_some(()) })
                .await;
        }
    }
}

/// Something of this schema.
fn example_of(schema: &Value) -> Value {
    match schema["type"].as_str() {
        Some("string") => json!("x"),
        Some("object") => {
            let fields = schema["properties"].as_object().unwrap();
            fields.iter().map(|(name, of)| (name.clone(), example_of(of))).collect()
        }
        _ => json!(3),
    }
}

/// Every request that the contract has, from its schema: a new one is walked without anybody's doing.
fn types_of_requests() -> Vec<MachineRequest> {
    let schema = schemars::schema_for!(MachineRequest).to_value();
    let variants = schema["oneOf"].as_array().unwrap().clone();
    let values = variants.iter().flat_map(|variant| match variant["properties"].as_object() {
        Some(fields) => {
            fields.iter().map(|(name, about)| json!({ name: example_of(about) })).collect::<Vec<_>>()
        }
        None => match (&variant["const"], &variant["enum"]) {
            (Value::String(name), _) => vec![json!(name)],
            (_, Value::Array(names)) => names.clone(),
            _ => panic!("{variant}"),
        },
    });
    values.map(|value| serde_json::from_value(value).unwrap()).collect()
}
