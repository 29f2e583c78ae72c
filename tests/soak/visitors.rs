//! Who else is connected: a person who walks and whose link is cut now and then, and dashboards of both kinds.

use std::time::{Duration, Instant};

use covr_study::random::Random;
use covr_tests::client::VrClient;
use covr_tests::dashboard::Dashboard;
use covr_wire::client::Encoding;
use futures_util::{SinkExt, StreamExt};
use tokio_tungstenite::tungstenite::Message;

/// Somebody on a circle, at 90 poses a second; every few seconds the client is gone without a word, and comes back.
pub async fn walk(host: String) {
    let mut random = Random::seeded(1);
    let began = Instant::now();
    loop {
        let mut client = VrClient::greeted(&host, "walker", Encoding::Json).await;
        client.enter("ada").await;
        let ends = Instant::now() + Duration::from_secs_f64(random.between(3.0, 12.0));
        let mut beat = tokio::time::interval(Duration::from_secs_f64(1.0 / 90.0));
        for sequence in 1.. {
            beat.tick().await;
            let turn = std::f64::consts::TAU * began.elapsed().as_secs_f64() / 20.0;
            let pose = client.pose_message("ada", 2.4 + turn.cos(), 2.4 + turn.sin(), sequence).to_string();
            let (sink_ends, over) =
                (client.socket.send(Message::Text(pose.into())).await.is_err(), Instant::now() > ends);
            // What the server says is read, so that its writer is not held up.
            while let Ok(Some(Ok(_))) = tokio::time::timeout(Duration::ZERO, client.socket.next()).await {}
            if sink_ends || over {
                break;
            }
        }
        drop(client);
        tokio::time::sleep(Duration::from_secs_f64(random.between(0.05, 1.5))).await;
    }
}

/// Dashboards that read everything, for a while each.
pub async fn look_on(host: String) {
    let mut random = Random::seeded(2);
    loop {
        let mut dashboard = Dashboard::connect(&host).await;
        let reads = async { while let Some(Ok(_)) = dashboard.socket.next().await {} };
        let _ = tokio::time::timeout(Duration::from_secs_f64(random.between(0.2, 5.0)), reads).await;
    }
}

/// Dashboards that read nothing, some at a time.
pub async fn look_away(host: String) {
    let mut random = Random::seeded(3);
    let mut deaf = std::collections::VecDeque::new();
    loop {
        deaf.push_back(Dashboard::connect(&host).await);
        if deaf.len() > 8 {
            deaf.pop_front();
        }
        tokio::time::sleep(Duration::from_secs_f64(random.between(0.1, 2.0))).await;
    }
}
