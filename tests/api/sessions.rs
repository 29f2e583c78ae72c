//! Sessions and their recordings: list, one, frames, events, exports, and what is refused.

use std::time::Duration;

use covr_engine::mode::Mode;
use covr_tests::client::VrClient;
use covr_tests::eventually;
use covr_tests::server::TestServer;
use covr_wire::client::Encoding;
use covr_wire::dashboard::Event;
use covr_wire::records::{RecordedFrame, RecordedFrames, Session, SessionDetail};
use serde_json::{Value, json};

/// Touch an object and let go, where the column stands now.
async fn touch(client: &mut VrClient, object: &str) {
    for kind in ["touch_began", "touch_ended"] {
        let at = client.now_micros();
        client.say(&json!({"type": kind, "person": "ada", "object": object, "client_time_micros": at})).await;
    }
}

async fn sessions(server: &TestServer, query: &str) -> Vec<Session> {
    serde_json::from_value(server.good("GET", &format!("/api/v1/sessions{query}"), None).await).unwrap()
}

async fn frames(server: &TestServer, id: i64, query: &str) -> Vec<RecordedFrame> {
    let found = server.good("GET", &format!("/api/v1/sessions/{id}/frames{query}"), None).await;
    serde_json::from_value::<RecordedFrames>(found).unwrap().frames
}

/// A server with a session that is over: Ada stood in the corner and touched the lamp once.
async fn with_a_session() -> (TestServer, Session) {
    let server = TestServer::start().await;
    server.arm().await;
    let mut ada = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    ada.enter("ada").await;
    ada.pose("ada", 3.5, 3.5).await;
    while frames(&server, 1, "").await.len() < 30 {
        ada.pose("ada", 3.5, 3.5).await;
    }
    touch(&mut ada, "lamp").await;
    eventually("the touch is in the record", || async {
        (sessions(&server, "").await[0].reaches == 1).then_some(())
    })
    .await;
    server.good("POST", "/api/v1/disarm", None).await;
    let session = eventually("the recording is stored", || async {
        let last = frames(&server, 1, "").await.pop()?;
        let newest = sessions(&server, "").await.remove(0);
        (newest.ended_at.is_some() && last.mode == covr_wire::dashboard::Mode::Disarmed).then_some(newest)
    })
    .await;
    (server, session)
}

#[tokio::test]
async fn a_session_tells_its_length_reaches_and_recording() {
    let (server, session) = with_a_session().await;
    assert_eq!((session.reaches, session.how.as_deref()), (1, Some("disarmed")));
    let length = session.length_secs.unwrap();
    assert!((1.0..20.0).contains(&length), "{length}");
    assert!(session.recorded_frames > 20 && session.recording_bytes > 1_000, "{session:?}");

    let path = format!("/api/v1/sessions/{}", session.id);
    let one: SessionDetail = serde_json::from_value(server.good("GET", &path, None).await).unwrap();
    assert_eq!(one.session, session);
    assert_eq!(one.persons, ["ada"]);
    assert_eq!((one.scenes[0].id, one.scenes[0].version, one.scenes[0].from_secs), (1, 1, 0.0));
    assert_eq!(one.machine_shape.unwrap().travel_m, [0.0, 0.0, 1.0, 1.0]);
    let (first, last) = (one.first_micros.unwrap(), one.last_micros.unwrap());
    assert!(last - first >= (length * 1e6) as i64, "{first} to {last}, {length} s");

    let all = frames(&server, session.id, "").await;
    assert_eq!(all.len() as u64, session.recorded_frames);
    assert!(all.is_sorted_by_key(|frame| frame.at_micros));
    assert!(all[0].at_micros >= first && all[0].at_micros < first + 500_000, "recorded from the start");
    let ada = &all[all.len() / 2].persons[0];
    assert_eq!((ada.name.as_str(), ada.head_m), ("ada", Some([3.5, 3.5, 1.7])));
    assert!(all[0].objects.iter().any(|object| object.id == "lamp"));

    let second = frames(&server, session.id, "?from_secs=0.5&to_secs=1").await;
    assert!(!second.is_empty() && second.len() < all.len());
    let inside = first + 500_000..=first + 1_000_000;
    assert!(second.iter().all(|frame| inside.contains(&frame.at_micros)));
    let thin = frames(&server, session.id, "?every_secs=0.25").await;
    assert!(thin.len() > 2 && thin.windows(2).all(|two| two[1].at_micros - two[0].at_micros >= 250_000));
    assert_eq!(frames(&server, session.id, "?from_secs=3000").await, []);
}

#[tokio::test]
async fn a_touch_is_served_where_the_column_stands_and_only_there() {
    let server = TestServer::start().await;
    server.arm().await;
    let mut ada = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    ada.enter("ada").await;
    ada.pose("ada", 3.5, 3.5).await;
    // An object where the column stands now, and one where it does not.
    let at = server.app.control.published().snapshot.column.position;
    let mut scene = server.good("GET", "/api/v1/scenes/1", None).await;
    let mut near = scene["objects"][0].clone();
    let mut far = near.clone();
    for (object, id, place) in
        [(&mut near, "near", [at.x, at.y, 1.0]), (&mut far, "far", [at.x + 0.5, at.y, 1.0])]
    {
        object["id"] = id.into();
        object["position"] = json!(place);
        object.as_object_mut().unwrap().remove("prop");
    }
    scene["objects"] = json!([near, far]);
    let stored = server.good("POST", "/api/v1/scenes", Some(&scene.to_string())).await["id"].clone();
    server.good("PUT", &format!("/api/v1/scenes/{stored}/activate"), None).await;
    server.good("POST", "/api/v1/stop", None).await;
    server.published("at rest", Duration::from_secs(5), |p| p.snapshot.column.velocity.norm() < 1e-3).await;
    // On a busy host the last published state can be older than a touch is held against; then it is touched again.
    let mut touches: Vec<Value> = Vec::new();
    for tries in 1..=10 {
        for object in ["near", "far"] {
            touch(&mut ada, object).await;
        }
        touches = eventually("both touches are in the record", || async {
            let events = server.good("GET", "/api/v1/events?limit=1000", None).await;
            let touches: Vec<Value> =
                events.as_array().unwrap().iter().filter(|e| e["kind"] == "touch_began").cloned().collect();
            (touches.len() == 2 * tries).then_some(touches)
        })
        .await;
        if touches[..2].iter().all(|touch| touch["detail"]["column_off_m"].is_f64()) {
            break;
        }
    }
    let detail =
        |object: &str| touches.iter().find(|t| t["detail"]["object"] == object).unwrap()["detail"].clone();
    assert_eq!(detail("near")["served"], true, "{touches:?}");
    assert_eq!(detail("far")["served"], false, "{touches:?}");
    assert!(detail("far")["column_off_m"].as_f64().unwrap() > 0.1, "{touches:?}");
}

#[tokio::test]
async fn stops_are_counted_and_a_running_session_can_be_opened() {
    let server = TestServer::start().await;
    server.arm().await;
    let running = eventually("a second is recorded", || async {
        let session = sessions(&server, "?search=running").await.remove(0);
        (session.recorded_frames > 0).then_some(session)
    })
    .await;
    assert_eq!((running.ended_at, running.how), (None, None));
    assert!(running.length_secs.unwrap() > 0.5);
    assert!(!frames(&server, running.id, "").await.is_empty());
    server.good("POST", "/api/v1/stop", None).await;
    let session = sessions(&server, "").await.remove(0);
    // On a busy machine R9 may put a protective stop between.
    assert!(session.stops >= 1, "{session:?}");
    assert_eq!(session.how.as_deref(), Some("latched_stop"));
    let last = eventually("its last frame shows the stop", || async {
        frames(&server, session.id, "")
            .await
            .pop()
            .filter(|frame| frame.mode != covr_wire::dashboard::Mode::Following)
    })
    .await;
    assert_eq!(last.mode, covr_wire::dashboard::Mode::LatchedStop);
}

#[tokio::test]
async fn the_list_is_searched_and_paged() {
    let server = TestServer::start().await;
    for _ in 0..3 {
        server.arm().await;
        server.good("POST", "/api/v1/disarm", None).await;
        server.mode(Mode::Disarmed).await;
    }
    let ids = |sessions: Vec<Session>| sessions.into_iter().map(|session| session.id).collect::<Vec<_>>();
    let all = ids(sessions(&server, "").await);
    assert_eq!(all, [3, 2, 1]);
    assert_eq!(ids(sessions(&server, "?limit=2").await), [3, 2]);
    assert_eq!(ids(sessions(&server, "?limit=2&before=2").await), [1]);
    assert_eq!(ids(sessions(&server, "?search=four%20CORNERS").await), [3, 2, 1]);
    assert_eq!(ids(sessions(&server, "?search=2").await), [2]);
    assert_eq!(ids(sessions(&server, "?search=disarmed&before=3").await), [2, 1]);
    assert_eq!(ids(sessions(&server, "?search=%25").await), Vec::<i64>::new(), "a percent sign is a letter");
    let problem =
        server.refused(422, "GET", &format!("/api/v1/sessions?search={}", "x".repeat(201)), None).await;
    assert_eq!(problem.errors[0].path, "search");
    server.refused(400, "GET", "/api/v1/sessions?befor=3", None).await;
}

#[tokio::test]
async fn wrong_questions_about_a_session_are_refused_by_name() {
    let server = TestServer::start().await;
    server.arm().await;
    for path in [
        "/api/v1/sessions/99",
        "/api/v1/sessions/nine",
        "/api/v1/sessions/99/frames",
        "/api/v1/sessions/-1/events",
        "/api/v1/sessions/99/export?format=csv",
    ] {
        let problem = server.refused(404, "GET", path, None).await;
        assert!(problem.detail.starts_with("there is no session \""), "{}", problem.detail);
    }
    for (query, named) in [
        ("from_secs=-1", "from_secs"),
        ("from_secs=NaN", "from_secs"),
        ("from_secs=5&to_secs=4", "to_secs"),
        ("every_secs=-0.1", "every_secs"),
    ] {
        let problem = server.refused(422, "GET", &format!("/api/v1/sessions/1/frames?{query}"), None).await;
        assert_eq!(problem.errors[0].path, named, "{query}");
    }
    server.refused(400, "GET", "/api/v1/sessions/1/frames?from_secs=soon", None).await;
    for query in ["", "?format=xlsx"] {
        let problem = server.refused(422, "GET", &format!("/api/v1/sessions/1/export{query}"), None).await;
        assert_eq!(problem.errors[0].path, "format");
    }
}

#[tokio::test]
async fn more_frames_than_an_answer_takes_are_refused_and_thinned_ones_are_not() {
    let server = TestServer::start().await;
    server.arm().await;
    let (document, frame) = eventually("a second is recorded", || async {
        let chunk = server.app.store.next_chunk(1, None, i64::MIN, i64::MAX).await.unwrap()?;
        let frames = covr_server::recording::chunk::decode(&chunk.document).unwrap();
        Some((chunk.document, frames[0].clone()))
    })
    .await;
    // A long recording, as the writer would have left it.
    for number in 1..=40_i64 {
        let first_micros = frame.at_micros + number * 100_000_000;
        let frames: Vec<_> = (0..256)
            .map(|i| RecordedFrame { at_micros: first_micros + i * 33_333, ..frame.clone() })
            .collect();
        let chunk = covr_server::store::NewChunk {
            session_id: 1,
            first_micros,
            last_micros: first_micros + 255 * 33_333,
            frames: 256,
            dropped: 0,
            document: covr_server::recording::chunk::encode(&frames).unwrap(),
        };
        server.app.store.add_chunk(&chunk).await.unwrap();
    }
    assert!(!document.is_empty());
    let problem = server.refused(422, "GET", "/api/v1/sessions/1/frames", None).await;
    assert_eq!(problem.errors[0].path, "every_secs");
    assert!(problem.detail.contains("at most 10000"), "{}", problem.detail);
    let thin = frames(&server, 1, "?every_secs=1").await;
    assert!((300..1_000).contains(&thin.len()), "{}", thin.len());
    let part = frames(&server, 1, "?from_secs=99&to_secs=300").await;
    assert_eq!(part.len(), 512);
}

#[tokio::test]
async fn exports_hold_everything_and_parse_back() {
    let (server, session) = with_a_session().await;
    let all = frames(&server, session.id, "").await;
    let path = format!("/api/v1/sessions/{}", session.id);
    let events: Vec<Event> =
        serde_json::from_value(server.good("GET", &format!("{path}/events"), None).await).unwrap();
    assert_eq!(events[0].detail["to"], "following", "oldest first");
    assert_eq!(events.last().unwrap().detail["to"], "disarmed");
    assert!(events.iter().any(|event| event.kind == "touch_began"));

    let response = server.call("GET", &format!("{path}/export?format=json"), None).await;
    let header = |name: &str| response.headers()[name].to_str().unwrap().to_owned();
    assert_eq!(header("content-type"), "application/json");
    let disposition = header("content-disposition");
    assert!(disposition.starts_with("attachment; filename=\"covr-session-1-20"), "{disposition}");
    assert!(disposition.ends_with(".json\""), "{disposition}");
    let export: Value = response.json().await.unwrap();
    assert_eq!(serde_json::from_value::<Vec<RecordedFrame>>(export["frames"].clone()).unwrap(), all);
    assert_eq!(serde_json::from_value::<Vec<Event>>(export["events"].clone()).unwrap(), events);
    assert_eq!(serde_json::from_value::<Session>(export["session"].clone()).unwrap(), session);
    assert_eq!(export["scenes"][0]["document"], server.good("GET", "/api/v1/scenes/1", None).await);

    let response = server.call("GET", &format!("{path}/export?format=csv"), None).await;
    assert!(response.headers()["content-type"].to_str().unwrap().starts_with("text/csv"));
    let text = response.text().await.unwrap();
    let mut rows = text.split_terminator("\r\n").map(|row| row.split(',').collect::<Vec<_>>());
    let names = rows.next().unwrap();
    let column =
        |name: &str| names.iter().position(|known| *known == name).unwrap_or_else(|| panic!("{name}"));
    let rows: Vec<_> = rows.collect();
    assert_eq!(rows.len(), all.iter().map(|frame| frame.persons.len().max(1)).sum::<usize>());
    let expected = all.iter().flat_map(|frame| {
        let nobody = frame.persons.is_empty().then_some((frame, None));
        frame.persons.iter().map(move |person| (frame, Some(person))).chain(nobody)
    });
    for (row, (frame, person)) in rows.iter().zip(expected) {
        assert_eq!(row[column("at_micros")], frame.at_micros.to_string());
        assert_eq!(row[column("column_x_m")].parse(), Ok(frame.column.position_m[0]));
        assert_eq!(row[column("person_name")], person.map_or("", |person| &person.name));
        assert_eq!(row[column("required_m")].parse().ok(), person.map(|person| person.required_m));
    }
    assert!(rows.iter().any(|row| row[column("person_name")] == "ada"));
}
