//! Calibration: a headset is brought to places, a map is fitted, accepted or refused, and used.

use std::time::Duration;

use covr_engine::mode::Mode;
use covr_server::config::{GameMasterNeeded, MachineKind};
use covr_server::store::NewCalibration;
use covr_tests::client::VrClient;
use covr_tests::server::TestServer;
use covr_wire::calibration::{CalibrationKind, CalibrationResult, Hardware};
use covr_wire::client::{Convention, Encoding, ToClient};
use serde_json::{Value, json};
use tempfile::TempDir;

const NAME: &str = "headset 1";
/// Where the tracking space is in the room: turned by this about z, then moved, m.
const YAW_RAD: f64 = 0.5;
const ORIGIN_M: [f64; 3] = [2.0, 1.0, 0.1];

/// Where the headset says that it is, OpenXR, when it is at a place of the room.
fn seen([x, y, z]: [f64; 3]) -> [f64; 3] {
    let (x, y, z) = (x - ORIGIN_M[0], y - ORIGIN_M[1], z - ORIGIN_M[2]);
    let (sin, cos) = YAW_RAD.sin_cos();
    let (forward, left) = (cos * x + sin * y, -sin * x + cos * y);
    [-left, z, -forward]
}

/// A headset that somebody carries from place to place.
struct Headset {
    client: VrClient,
    sequence: u32,
}

impl Headset {
    async fn connect(server: &TestServer) -> Self {
        let mut client = VrClient::greeted(&server.host, NAME, Encoding::Json).await;
        client.enter("Ada").await;
        let mut headset = Self { client, sequence: 0 };
        headset.pose([1.0, 1.0, 1.0]).await;
        // Whoever speaks is shown a moment later; until then it is not known to be there.
        server
            .published("Ada is in the arena", Duration::from_secs(5), |p| !p.snapshot.persons.is_empty())
            .await;
        for _ in 0..50 {
            tokio::time::sleep(Duration::from_millis(20)).await;
            headset.pose([1.0, 1.0, 1.0]).await;
            if server.app.clients.list().iter().any(|client| !client.persons.is_empty()) {
                return headset;
            }
        }
        panic!("the client is not shown with its person");
    }

    async fn pose(&mut self, at: [f64; 3]) {
        self.sequence += 1;
        let mut message = self.client.pose_message("Ada", 0.0, 0.0, self.sequence);
        message["position"] = json!(seen(at));
        self.client.say(&message).await;
    }

    /// Take a point while the headset is where `at` says (s since the beginning); status and answer.
    async fn take(
        &mut self,
        server: &TestServer,
        point: Value,
        at: impl Fn(f64) -> [f64; 3],
    ) -> (u16, Value) {
        let body = point.to_string();
        // What was said before is heard before: no pose of the last place is still on its way.
        self.pose(at(0.0)).await;
        let client_time_micros = self.client.now_micros();
        let ping =
            json!({ "type": "clock_ping", "id": self.sequence, "client_time_micros": client_time_micros });
        self.client.say(&ping).await;
        self.client.hear("a pong", |m| matches!(m, ToClient::ClockPong(_)).then_some(())).await;
        let call = server.call("POST", "/api/v1/calibrations/draft/points", Some(&body));
        tokio::pin!(call);
        let began = std::time::Instant::now();
        let mut due = tokio::time::interval(Duration::from_millis(11));
        loop {
            tokio::select! {
                answer = &mut call => {
                    let status = answer.status().as_u16();
                    return (status, answer.json().await.unwrap());
                }
                _ = due.tick() => self.pose(at(began.elapsed().as_secs_f64())).await,
            }
        }
    }

    async fn touch(&mut self, server: &TestServer, place: [f64; 3], really: [f64; 3]) -> Value {
        let (status, draft) = self.take(server, json!({ "on": "place", "place_m": place }), |_| really).await;
        assert_eq!(status, 200, "{draft}");
        draft
    }
}

async fn begin(server: &TestServer) -> Value {
    let task = json!({ "kind": "room_from_tracking", "client": NAME }).to_string();
    server.good("PUT", "/api/v1/calibrations/draft", Some(&task)).await
}

fn room(hardware: Hardware, position_m: [f64; 3]) -> NewCalibration {
    let half = YAW_RAD / 2.0;
    NewCalibration {
        kind: CalibrationKind::RoomFromTracking,
        subject: NAME.into(),
        result: CalibrationResult::RoomFromTracking {
            convention: Convention::Openxr,
            position_m,
            orientation: [0.0, 0.0, half.sin(), half.cos()],
            rms_m: 0.002,
            scale: 1.0,
            tilt_rad: 0.0,
            uncertainty_m: 0.002,
            turn_sd_rad: 0.0005,
            offset_m: None,
        },
        points: Vec::new(),
        hardware,
        author: "Ada".into(),
    }
}

const PLACES: [[f64; 3]; 7] = [
    [0.0, 0.0, 0.0],
    [2.0, 0.0, 0.0],
    [2.0, 2.0, 0.0],
    [0.0, 2.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.5, 1.5, 0.8],
    [1.5, 0.5, 0.8],
];

#[tokio::test]
async fn a_headset_is_calibrated_from_touched_places_and_is_where_it_is_from_then_on() {
    let server = TestServer::start().await;
    let mut headset = Headset::connect(&server).await;
    let draft = begin(&server).await;
    assert_eq!(draft["why"]["id"], "too_few_points");
    // Fewer than are needed: refused, and nothing is stored.
    headset.touch(&server, PLACES[0], PLACES[0]).await;
    let refused = server.refused(409, "POST", "/api/v1/calibrations", None).await;
    assert!(refused.detail.contains("1 points are too few"), "{refused:?}");
    assert_eq!(server.good("GET", "/api/v1/calibrations", None).await, json!([]));
    for place in &PLACES[1..6] {
        headset.touch(&server, *place, *place).await;
    }
    // Somebody stood at another mark than they said.
    let draft = headset.touch(&server, PLACES[6], [1.1, 0.5, 0.8]).await;
    assert_eq!(draft["points"][6]["used"], false, "{draft}");
    assert!(draft["points"][6]["residual_m"].as_f64().unwrap() > 0.3);
    assert!(draft["points"][0]["residual_m"].as_f64().unwrap() < 1e-6, "{draft}");
    assert!(draft["points"][0]["poses"].as_u64().unwrap() >= 30);

    let stored = server.call_as(Some("Grace"), "POST", "/api/v1/calibrations", None).await;
    assert_eq!(stored.status(), 201);
    assert_eq!(stored.headers()["location"], "/api/v1/calibrations/1");
    let list = server.good("GET", "/api/v1/calibrations", None).await;
    assert_eq!(list[0]["author"], "Grace");
    assert_eq!((&list[0]["in_force"], &list[0]["version"]), (&true.into(), &1.into()));
    assert_eq!((&list[0]["points_used"], &list[0]["points_left_out"]), (&6.into(), &1.into()));
    assert_eq!(list[0]["changed"], json!([]));
    let whole = server.good("GET", "/api/v1/calibrations/1", None).await;
    assert_eq!(whole["hardware"]["machine"], "simulated");
    server.refused(404, "GET", "/api/v1/calibrations/draft", None).await;

    // It is told where the room is, and its next pose is where it is.
    let told = headset
        .client
        .hear("the room anew", |message| match message {
            ToClient::Scene(scene) => Some(scene.client_from_room),
            _ => None,
        })
        .await;
    let expected = seen([0.0, 0.0, 0.0]);
    assert!((0..3).all(|axis| (told[axis][3] - expected[axis]).abs() < 1e-6), "{told:?}");
    headset.pose([1.2, 0.7, 1.6]).await;
    server
        .published("the head is where it is", Duration::from_secs(5), |published| {
            published.snapshot.persons.iter().any(|person| {
                person.pose.is_some_and(|pose| {
                    let [x, y, z] = [1.2, 0.7, 1.6];
                    (pose.position.x() - x).abs()
                        + (pose.position.y() - y).abs()
                        + (pose.position.z() - z).abs()
                        < 1e-5
                })
            })
        })
        .await;
    let events = server.good("GET", "/api/v1/events", None).await.to_string();
    assert!(events.contains("calibration_accepted") && events.contains("calibration_refused"), "{events}");

    // It survives a restart.
    drop(headset);
    let dir = server.shutdown().await;
    let again = TestServer::start_in(dir, |_| {}).await;
    let map = again.app.calibrations.map(NAME, Convention::Openxr).unwrap();
    let at = Convention::Openxr.point_to_tracking(seen([1.2, 0.7, 1.6]));
    assert!((map.point(&at).x() - 1.2).abs() < 1e-6);
}

#[tokio::test]
async fn what_cannot_be_measured_is_refused_and_leaves_no_point() {
    let server = TestServer::start().await;
    let task = json!({ "kind": "room_from_tracking", "client": NAME }).to_string();
    let nobody = server.refused(409, "PUT", "/api/v1/calibrations/draft", Some(&task)).await;
    assert!(nobody.detail.contains("no client headset 1 is connected"), "{nobody:?}");
    let point = json!({ "on": "place", "place_m": [0, 0, 0] });
    server.refused(404, "POST", "/api/v1/calibrations/draft/points", Some(&point.to_string())).await;
    server.refused(404, "POST", "/api/v1/calibrations", None).await;

    let mut headset = Headset::connect(&server).await;
    begin(&server).await;
    let (status, problem) = headset.take(&server, point.clone(), |secs| [1.0 + 0.1 * secs, 1.0, 0.0]).await;
    assert_eq!((status, &problem["why"]["refusal"]["id"]), (409, &"moved".into()), "{problem}");
    // The column's place means nothing before it is homed.
    let (status, problem) = headset.take(&server, json!({ "on": "column" }), |_| [1.0; 3]).await;
    assert_eq!((status, &problem["why"]["id"]), (409, &"home_first".into()), "{problem}");
    for (bad, field) in [
        (json!({ "on": "place" }), "place_m"),
        (json!({ "on": "place", "place_m": [0, 0, 400] }), "place_m[2]"),
        (json!({ "on": "column", "place_m": [0, 0, 0] }), "place_m"),
        (json!({ "on": "prop_point" }), "on"),
    ] {
        let path = "/api/v1/calibrations/draft/points";
        let problem = server.refused(422, "POST", path, Some(&bad.to_string())).await;
        assert_eq!(problem.errors[0].path, field, "{problem:?}");
    }
    let task = json!({ "kind": "room_from_tracking", "client": NAME, "pointer": "left_hand" }).to_string();
    server.good("PUT", "/api/v1/calibrations/draft", Some(&task)).await;
    let (status, problem) = headset.take(&server, point, |_| [1.0; 3]).await;
    assert_eq!((status, &problem["why"]["id"]), (409, &"no_pointer".into()), "{problem}");
    let draft = server.good("GET", "/api/v1/calibrations/draft", None).await;
    assert_eq!(draft["points"], json!([]));
    server.refused(404, "DELETE", "/api/v1/calibrations/draft/points/1", None).await;
    server.refused(404, "PUT", "/api/v1/calibrations/7/activate", None).await;
    server.good("DELETE", "/api/v1/calibrations/draft", None).await;
    server.refused(404, "GET", "/api/v1/calibrations/draft", None).await;
}

#[tokio::test]
async fn another_is_put_in_force_and_out_of_it_but_not_while_armed() {
    let server = TestServer::start().await;
    let hardware = server.app.calibrations.hardware(&server.app.control.published());
    for x in [1.0, 2.0] {
        server
            .app
            .calibrations
            .accept(&server.app.store, &room(hardware.clone(), [x, 0.0, 0.0]))
            .await
            .unwrap();
    }
    let x_of = |server: &TestServer| {
        let origin = Convention::Openxr.point_to_tracking([0.0; 3]);
        server.app.calibrations.map(NAME, Convention::Openxr).map(|map| map.point(&origin).x())
    };
    assert_eq!(x_of(&server), Some(2.0));
    let first = server.good("PUT", "/api/v1/calibrations/1/activate", None).await;
    assert_eq!(first["in_force"], true);
    assert_eq!(x_of(&server), Some(1.0));
    let list = server.good("GET", "/api/v1/calibrations", None).await;
    assert_eq!((&list[0]["version"], &list[0]["in_force"]), (&2.into(), &false.into()));
    server.good("PUT", "/api/v1/calibrations/1/retire", None).await;
    assert_eq!(x_of(&server), None);

    server.arm().await;
    let refused = server.refused(409, "PUT", "/api/v1/calibrations/1/activate", None).await;
    assert!(refused.detail.contains("not while the machine is armed"), "{refused:?}");
    assert_eq!(x_of(&server), None);
}

#[tokio::test]
async fn a_real_machine_is_not_armed_on_a_calibration_of_other_hardware() {
    let server = TestServer::start_on_a_simulation(TempDir::new().unwrap(), |config| {
        config.machine.kind = MachineKind::RoboClaw;
        // That it was not commissioned is another test's.
        config.machine.roboclaw.emulated = true;
        config.safety.game_master = GameMasterNeeded::Never;
    })
    .await;
    let now = server.app.calibrations.hardware(&server.app.control.published());
    let other = Hardware { controller: Some("/dev/roboclaw-old".into()), ..now.clone() };
    server.app.calibrations.accept(&server.app.store, &room(other, ORIGIN_M)).await.unwrap();
    server.good("POST", "/api/v1/home", None).await;
    server.mode(Mode::Ready).await;
    // Nobody relies on it yet.
    server.good("POST", "/api/v1/arm", None).await;
    // While armed, its client's person is not let in.
    let mut late = VrClient::greeted(&server.host, NAME, Encoding::Json).await;
    late.enter("Ada").await;
    let error = late.error().await;
    assert!(error.message.contains("/dev/roboclaw-old"), "{error:?}");
    drop(late);
    server.good("POST", "/api/v1/disarm", None).await;
    server.mode(Mode::Disarmed).await;

    let _headset = Headset::connect(&server).await;
    let refused = server.refused(409, "POST", "/api/v1/arm", None).await;
    assert!(refused.detail.contains("the motor controller was /dev/roboclaw-old"), "{refused:?}");
    let state = server.good("GET", "/api/v1/state", None).await;
    let arm = state["requests"].as_array().unwrap().iter().find(|one| one["request"] == "arm").unwrap();
    assert!(arm["refused_because"].is_string(), "{arm}");
    let events = server.good("GET", "/api/v1/events", None).await.to_string();
    assert!(events.contains("calibration_outdated"), "{events}");
    // Calibrated anew, it is no longer what keeps it from being armed.
    server.app.calibrations.accept(&server.app.store, &room(now, ORIGIN_M)).await.unwrap();
    assert_eq!(server.app.why_not_armed(), None);
}

#[tokio::test]
async fn a_touched_prop_is_offered_as_a_new_version_of_the_scene() {
    let server = TestServer::start().await;
    // Homed before anybody comes near.
    server.good("POST", "/api/v1/home", None).await;
    let column = server.mode(Mode::Ready).await.snapshot.column.position;
    let mut headset = Headset::connect(&server).await;
    let task = json!({ "kind": "prop", "client": NAME, "prop": "panel" }).to_string();
    let refused = server.refused(409, "PUT", "/api/v1/calibrations/draft", Some(&task)).await;
    assert!(refused.detail.contains("calibrate its room first"), "{refused:?}");
    let hardware = server.app.calibrations.hardware(&server.app.control.published());
    server.app.calibrations.accept(&server.app.store, &room(hardware, ORIGIN_M)).await.unwrap();
    let unknown = json!({ "kind": "prop", "client": NAME, "prop": "teapot" }).to_string();
    server.refused(409, "PUT", "/api/v1/calibrations/draft", Some(&unknown)).await;
    server.good("PUT", "/api/v1/calibrations/draft", Some(&task)).await;
    let at = |dx: f64, dy: f64| [column.x + dx, column.y + dy, 1.1];
    let mut points = vec![("prop_point", at(0.02, 0.2)); 3];
    points.extend([-0.1, -0.05, 0.05, 0.1].map(|dx| ("prop_face", at(dx, 0.2))));
    for (on, place) in points {
        let (status, draft) = headset.take(&server, json!({ "on": on }), |_| place).await;
        assert_eq!(status, 200, "{draft}");
    }
    let stored = server.good("POST", "/api/v1/calibrations", None).await;
    assert_eq!(stored["result"]["prop"], "panel");
    let before = server.good("GET", "/api/v1/scenes/1", None).await;
    assert_eq!(before["props"][0]["offset"], json!([0.0, 0.09]), "nothing is changed by itself");
    let path = format!("/api/v1/calibrations/{}/scene", stored["id"]);
    let version = server.good("POST", &path, None).await;
    assert_eq!(version["version"], 2);
    let prop = server.good("GET", "/api/v1/scenes/1?version=2", None).await["props"][0].clone();
    assert!((prop["offset"][0].as_f64().unwrap() - 0.02).abs() < 1e-3, "{prop}");
    assert!((prop["offset"][1].as_f64().unwrap() - 0.2).abs() < 1e-3, "{prop}");
    assert!((prop["facing"].as_f64().unwrap() - std::f64::consts::FRAC_PI_2).abs() < 1e-2, "{prop}");
    let room_of = format!("/api/v1/calibrations/{}/scene", 1);
    server.refused(409, "POST", &room_of, None).await;
}

#[tokio::test]
async fn a_headset_on_the_column_is_nobody_and_its_place_is_where_the_machine_measures_it() {
    let server = TestServer::start().await;
    server.good("POST", "/api/v1/home", None).await;
    let column = server.mode(Mode::Ready).await.snapshot.column.position;
    let mut client = VrClient::greeted(&server.host, NAME, Encoding::Json).await;
    let ridden = client.pose_message("tracker", column.x, column.y, 1);
    client.say(&ridden).await;
    assert!(client.error().await.message.contains("tracker"), "nothing is measured, so nobody is expected");
    begin(&server).await;
    let mut headset = Headset { client, sequence: 0 };
    let at = [column.x + 0.1, column.y, 1.5];
    let (status, draft) = headset.take(&server, json!({ "on": "column" }), |_| at).await;
    assert_eq!(status, 200, "{draft}");
    let measured = &draft["points"][0];
    assert!((measured["room_m"][0].as_f64().unwrap() - column.x).abs() < 0.002, "{measured}");
    assert!((measured["room_m"][1].as_f64().unwrap() - column.y).abs() < 0.002, "{measured}");
    assert_eq!(measured["room_m"][2], 0.0);
    assert!(server.app.control.published().snapshot.persons.is_empty(), "it is nobody");
    let events = server.good("GET", "/api/v1/events", None).await.to_string();
    assert!(!events.contains("person_entered"), "{events}");
}
