//! Too many who connect, and one who says too much.

use std::time::Duration;

use covr_tests::client::VrClient;
use covr_tests::dashboard::Dashboard;
use covr_tests::process::{Process, Start};
use covr_tests::{HOMED, SOON, eventually, eventually_within};
use covr_wire::client::Encoding;
use covr_wire::dashboard::ToDashboard;
use futures_util::SinkExt;
use nix::sys::resource::{Resource, getrlimit, setrlimit};
use tempfile::TempDir;
use tokio::io::AsyncReadExt;
use tokio::net::TcpStream;
use tokio_tungstenite::tungstenite::Message;

#[tokio::test]
async fn two_hundred_dashboards_that_read_nothing_hold_up_nobody() {
    let dir = TempDir::new().unwrap();
    let env = [("COVR_DASHBOARDS__MOST", "300")];
    let server = Process::serve_with(dir.path(), Start { env: &env, ..Start::default() }).await;
    let mut deaf = Vec::new();
    for _ in 0..200 {
        deaf.push(Dashboard::connect(&server.host()).await);
    }
    let steps = server.metric("covr_control_steps_total").await;
    // Until the sockets' buffers are full of what nobody reads, or as long as it takes to see that nothing piles up.
    eventually_within(HOMED, "the loop goes on before them", || async {
        (server.metric("covr_control_steps_total").await > steps + 1_000.0).then_some(())
    })
    .await;
    server.stop().await;
    let mut reads = Dashboard::connect(&server.host()).await;
    reads.hear("a live state", |m| matches!(m, ToDashboard::Snapshot(_)).then_some(())).await;
    let kb = server.memory_kb("VmRSS");
    assert!(kb < 400_000.0, "{kb} kB with 200 dashboards that read nothing");
    drop(deaf);
}

#[tokio::test]
async fn a_thousand_connections_that_send_nothing_take_no_stop_its_place_and_are_ended() {
    let (_, most) = getrlimit(Resource::RLIMIT_NOFILE).unwrap();
    setrlimit(Resource::RLIMIT_NOFILE, most, most).unwrap();
    let dir = TempDir::new().unwrap();
    let env = [("COVR_SERVER__HEADER_TIMEOUT_SECS", "3.0")];
    let server = Process::serve_with(dir.path(), Start { env: &env, ..Start::default() }).await;
    let mut silent = Vec::new();
    for _ in 0..1_000 {
        silent.push(TcpStream::connect(server.address).await.unwrap());
    }
    server.stop().await;
    for mut connection in silent {
        let ended = tokio::time::timeout(SOON, connection.read(&mut [0; 64])).await;
        assert!(ended.is_ok(), "a connection that asks nothing is still open");
    }
    server.stop().await;
}

#[tokio::test]
async fn a_client_that_says_ten_thousand_messages_a_second_is_sent_away_and_others_are_heard() {
    let dir = TempDir::new().unwrap();
    let server = Process::serve(dir.path()).await;
    let mut good = VrClient::greeted(&server.host(), "quest", Encoding::Json).await;
    good.enter("ada").await;
    let flood = tokio::spawn({
        let host = server.host();
        async move {
            // Sent away, it comes again, for as long as the test lasts.
            for round in 0.. {
                let mut client = VrClient::greeted(&host, &format!("flood {round}"), Encoding::Json).await;
                client.enter("mob").await;
                for sequence in 1..10_000 {
                    let message = client.pose_message("mob", 2.0, 2.0, sequence).to_string();
                    if client.socket.feed(Message::Text(message.into())).await.is_err() {
                        break;
                    }
                }
            }
        }
    });
    let walks = async {
        let mut beat = tokio::time::interval(Duration::from_millis(11));
        loop {
            beat.tick().await;
            good.pose("ada", 1.0, 1.0).await;
        }
    };
    let looks = async {
        eventually("the flood is sent away", || async {
            let events = server.good("GET", "/api/v1/events?kind=client_error", None).await;
            events.to_string().contains("too_many_messages").then_some(())
        })
        .await;
        server.stop().await;
        let state = server.good("GET", "/api/v1/state", None).await;
        let persons = state["persons"].as_array().unwrap();
        let ada = persons.iter().find(|person| person["name"] == "ada");
        assert!(ada.is_some_and(|ada| ada["tracked"] == true), "{persons:?}");
    };
    tokio::select! {
        () = walks => {}
        () = looks => {}
    }
    flood.abort();
}
