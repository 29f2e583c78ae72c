//! Messages a second: real poses through the real socket path, against the same frames at a bare echo server.
//!
//! The guard of the message rate stays in force. Its allowance grows with `clients.persons_each`, which is set so high
//! here that the flood is within it.

use std::time::{Duration, Instant};

use covr_tests::client::VrClient;
use covr_wire::client::Encoding;
use futures_util::{SinkExt, StreamExt};
use serde_json::json;
use tokio_tungstenite::tungstenite::Message;

use crate::Effort;
use crate::bed::Bed;
use crate::echo::{Echo, Socket};
use crate::samples::Samples;
use crate::table::Row;

/// The rows of one connection and of fifty.
pub async fn measure(effort: Effort) -> Vec<Row> {
    vec![with(1, effort).await, with(50, effort).await]
}

async fn with(connections: usize, effort: Effort) -> Row {
    let (rounds, messages) = effort.of((11, 40_000), (2, 500));
    let each = messages / connections;
    let bed = Bed::start(|config| {
        config.clients.persons_each = 100_000;
        config.clients.most = connections;
    })
    .await;
    let echo = Echo::start().await;
    let (mut clients, mut mirrors) = (Vec::new(), Vec::new());
    for number in 0..connections {
        let mut client = VrClient::greeted(&bed.host, &format!("bench {number}"), Encoding::Json).await;
        client.enter("ada").await;
        clients.push(client.socket);
        mirrors.push(echo.connect().await);
    }
    let (mut served, mut echoed) = (Samples::default(), Samples::default());
    // The first round warms up and does not count.
    for round in 0..=rounds {
        let mut frames: Vec<Message> = (0..each).map(|k| pose(round * each + k)).collect();
        // Messages are taken in one after another, so the answer to this one says that all are.
        frames.push(Message::text(
            json!({"type": "clock_ping", "id": round, "client_time_micros": 0}).to_string(),
        ));
        let per_second = |took: Duration| (each * connections) as f64 / took.as_secs_f64();
        let is_pong = |message: &Message| message.to_text().is_ok_and(|text| text.contains("\"clock_pong\""));
        let at_server = flood(&mut clients, &frames, |_| is_pong).await;
        let all = frames.len();
        let at_echo = flood(&mut mirrors, &frames, |_| {
            let mut left = all;
            move |_: &Message| {
                left -= 1;
                left == 0
            }
        })
        .await;
        if round > 0 {
            served.add(per_second(at_server));
            echoed.add(per_second(at_echo));
        }
    }
    let sent = ((rounds + 1) * each * connections) as u64;
    let taken = || bed.app.clients.list().iter().map(|client| client.poses).sum::<u64>();
    covr_tests::eventually("every pose is accepted", || async { (taken() == sent).then_some(()) }).await;
    let refused: u64 = bed.app.clients.list().iter().map(|client| client.errors).sum();
    bed.end().await;
    assert_eq!(refused, 0, "the benchmark's poses are good ones");

    let (figure, beside) = (served.median(), echoed.median());
    let ratio = figure / beside;
    Row {
        what: format!("ingest of poses, {connections} connection{}", if connections == 1 { "" } else { "s" }),
        figure: format!("{figure:.0} messages/s"),
        beside: format!("bare echo: {beside:.0} messages/s"),
        ratio: format!("{ratio:.2}"),
        limit: "at least 0.60 of the echo".into(),
        met: Some(ratio >= 0.6),
        how: format!(
            "medians of {rounds} rounds of {} JSON poses, turn about, one flush a message; all {sent} accepted",
            each * connections
        ),
    }
}

/// Every connection sends all frames and reads until it is done; how long the slowest took.
async fn flood<D>(sockets: &mut [Socket], frames: &[Message], done: impl Fn(usize) -> D) -> Duration
where
    D: FnMut(&Message) -> bool,
{
    let began = Instant::now();
    let runs = sockets.iter_mut().enumerate().map(|(number, socket)| {
        let mut done = done(number);
        async move {
            let (mut sink, mut stream) = socket.split();
            let send = async {
                for frame in frames {
                    sink.send(frame.clone()).await.unwrap();
                }
            };
            let read = async {
                loop {
                    let message = stream.next().await.expect("the connection stays").unwrap();
                    if done(&message) {
                        return;
                    }
                }
            };
            tokio::join!(send, read);
        }
    });
    let all = futures_util::future::join_all(runs);
    tokio::time::timeout(Duration::from_secs(120), all).await.expect("a flood is taken in");
    began.elapsed()
}

fn pose(sequence: usize) -> Message {
    let step = sequence as f64 * 1e-4;
    Message::text(
        json!({
            "type": "pose", "person": "ada", "sequence": sequence, "client_time_micros": sequence * 10,
            "position": [-2.0 + 0.3 * step.sin(), 1.7, -2.0 + 0.3 * step.cos()],
            "orientation": [0.0, (0.5 * step).sin(), 0.0, (0.5 * step).cos()], "tracked": true, "worn": true,
        })
        .to_string(),
    )
}
