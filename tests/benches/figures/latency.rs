//! From a pose at the client's socket to the first command that was decided with it.
//!
//! Each pose says the opposite of the one before about `tracked`, so the step that takes it in breaches or clears rule R2
//! and says so in an event of its own time; the machine's note of that time is the command. Poses leave at random
//! moments of the period.

use std::time::{Duration, Instant};

use covr_study::random::Random;
use covr_tests::client::VrClient;
use covr_wire::client::Encoding;
use futures_util::{SinkExt, StreamExt};
use serde_json::json;
use tokio_tungstenite::tungstenite::Message;

use crate::Effort;
use crate::bed::Bed;
use crate::echo::Echo;
use crate::samples::Samples;
use crate::table::Row;

/// The row of the latency.
pub async fn measure(effort: Effort) -> Vec<Row> {
    let (warm_up, poses) = effort.of((200, 5_000), (5, 50));
    let bed = Bed::start(|_| {}).await;
    let echo = Echo::start().await;
    let mut mirror = echo.connect().await;
    bed.arm().await;
    let mut events = bed.app.recorder.live();
    let mut client = VrClient::greeted(&bed.host, "bench", Encoding::Json).await;
    client.enter("ada").await;
    let (mut sink, mut stream) = client.socket.split();
    let reader = tokio::spawn(async move { while let Some(Ok(_)) = stream.next().await {} });

    let began = Instant::now();
    let mut random = Random::seeded(1);
    let (mut latency, mut round_trip) = (Samples::default(), Samples::default());
    // The first pose is as expected, so that every later one is a change.
    for sequence in 0..=(warm_up + poses) {
        let frame = pose(sequence, began.elapsed(), sequence % 2 == 0);
        while bed.ticks.try_recv().is_ok() {}
        let sent = Instant::now();
        sink.send(Message::text(frame.clone())).await.unwrap();
        if sequence > 0 {
            let at_micros = r2_changed(&mut events).await;
            // The event is told after the write, so the note is there.
            let tick = bed.ticks.try_iter().find(|tick| tick.now.micros() == at_micros);
            let tick = tick.expect("a step's event comes after its command");
            let (there, echoed) = (tick.written - sent, once_around(&mut mirror, frame).await);
            if sequence > warm_up {
                latency.add(there.as_secs_f64() * 1e6);
                round_trip.add(echoed.as_secs_f64() * 1e6);
            }
        } else {
            tokio::time::sleep(Duration::from_millis(100)).await;
        }
        tokio::time::sleep(Duration::from_micros(random.between(4_000.0, 12_000.0) as u64)).await;
    }
    reader.abort();
    let period = bed.period().as_secs_f64() * 1e6;
    bed.end().await;

    let (p99, rtt) = (latency.percentile(0.99), round_trip.percentile(0.99));
    let limit = period + 1.5 * rtt;
    vec![Row {
        what: "pose in to command out".into(),
        figure: format!("99th percentile {p99:.0} us, median {:.0} us", latency.median()),
        beside: format!(
            "round trip of a bare echo: 99th percentile {rtt:.0} us, median {:.0} us",
            round_trip.median()
        ),
        ratio: format!("{:.2} of the limit", p99 / limit),
        limit: format!("one period ({period:.0} us) + 1.5 round trips = {limit:.0} us"),
        met: Some(p99 <= limit),
        how: format!(
            "{} poses at random moments, {warm_up} to warm up; after each the same frame to the echo server",
            latency.count()
        ),
    }]
}

fn pose(sequence: u32, at: Duration, tracked: bool) -> String {
    json!({
        "type": "pose", "person": "ada", "sequence": sequence, "client_time_micros": at.as_micros() as i64,
        "position": [-2.0, 1.7, -2.0], "orientation": [0.0, 0.0, 0.0, 1.0], "tracked": tracked, "worn": true,
    })
    .to_string()
}

async fn r2_changed(
    events: &mut tokio::sync::broadcast::Receiver<std::sync::Arc<covr_wire::dashboard::Event>>,
) -> i64 {
    let changed = async {
        loop {
            let event = events.recv().await.unwrap();
            if matches!(event.kind.as_str(), "rule_breached" | "rule_cleared") && event.detail["rule"] == "R2"
            {
                return event.at_micros;
            }
        }
    };
    tokio::time::timeout(Duration::from_secs(5), changed).await.expect("the pose changes R2")
}

async fn once_around(mirror: &mut crate::echo::Socket, frame: String) -> Duration {
    let sent = Instant::now();
    mirror.send(Message::text(frame)).await.unwrap();
    mirror.next().await.unwrap().unwrap();
    sent.elapsed()
}
