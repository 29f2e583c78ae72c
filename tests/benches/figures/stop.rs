//! From the last byte of `POST /api/v1/stop` to the first braking command. The machine is the ideal one, so that each
//! stop is reset, homed and armed again within a few control periods; socket, handler, lane and loop are the real ones.
//! The column rests, so the drive is let go instead of braked: either counts.

use std::time::{Duration, Instant};

use covr_engine::mode::{Mode, RequestKind};
use covr_study::random::Random;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;

use crate::bed::{Bed, Tick};
use crate::samples::Samples;
use crate::table::Row;
use crate::{Effort, Known};

/// The row of the stop.
pub async fn measure(effort: Effort, known: &Known) -> Vec<Row> {
    let (warm_up, stops) = effort.of((20, 2_000), (2, 20));
    let bed = Bed::start(|_| {}).await;
    let mut connection = TcpStream::connect(&bed.host).await.unwrap();
    connection.set_nodelay(true).unwrap();
    let request = format!("POST /api/v1/stop HTTP/1.1\r\nHost: {}\r\nContent-Length: 0\r\n\r\n", bed.host);
    let mut random = Random::seeded(2);
    let mut took = Samples::default();
    for stop in 0..(warm_up + stops) {
        bed.arm().await;
        tokio::time::sleep(Duration::from_micros(random.between(0.0, 8_000.0) as u64)).await;
        while bed.ticks.try_recv().is_ok() {}
        let pressed = Instant::now();
        connection.write_all(request.as_bytes()).await.unwrap();
        answered(&mut connection).await;
        let brakes = |tick: &Tick| tick.brakes && tick.written > pressed;
        let braked = bed.ticks.try_iter().find(brakes).expect("the answer comes after the braking command");
        if stop >= warm_up {
            took.add((braked.written - pressed).as_secs_f64() * 1e6);
        }
        bed.ask(RequestKind::Reset, Some("benchmark")).await;
        bed.mode(Mode::Disarmed).await;
    }
    let period = bed.period().as_secs_f64() * 1e6;
    bed.end().await;

    let p999 = took.percentile(0.999);
    let lateness = known.lateness_p999_micros;
    let limit = 2.0 * period + lateness.unwrap_or(0.0);
    vec![Row {
        what: "stop: HTTP request to braking command".into(),
        figure: format!("99.9th percentile {p999:.0} us, median {:.0} us", took.median()),
        beside: match lateness {
            Some(lateness) => format!("lateness of the control loop: 99.9th percentile {lateness:.0} us"),
            None => "lateness not measured in this run, taken as 0".into(),
        },
        ratio: format!("{:.2} of the limit", p999 / limit),
        limit: format!("2 periods + that lateness = {limit:.0} us"),
        met: Some(p999 < limit),
        how: format!(
            "{} stops at random moments on a kept connection, {warm_up} to warm up; ideal machine",
            took.count()
        ),
    }]
}

/// Read one whole answer, which must be 200.
async fn answered(connection: &mut TcpStream) {
    let mut answer = Vec::new();
    loop {
        let mut part = [0; 4_096];
        let read = connection.read(&mut part).await.unwrap();
        assert!(read > 0, "the server closed the connection");
        answer.extend_from_slice(&part[..read]);
        let text = String::from_utf8_lossy(&answer);
        let Some((head, body)) = text.split_once("\r\n\r\n") else { continue };
        assert!(head.starts_with("HTTP/1.1 200"), "{text}");
        let length =
            head.lines().find_map(|line| line.to_lowercase().strip_prefix("content-length: ")?.parse().ok());
        if body.len() >= length.unwrap_or(0) {
            return;
        }
    }
}
