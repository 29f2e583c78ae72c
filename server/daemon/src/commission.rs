//! `covr commission`: the first motion of a machine, walked through step by step on a running server, and no step left out.
//!
//! Everything that moves here moves as a jog does: for as long as this program says so, ten times a second, through the same safety
//! rules as ever. Ctrl-C, a closed terminal or a cut cable let go of it. The brake's figures are the server's own.

mod desk;

use std::io::Write;
use std::path::PathBuf;
use std::time::Duration;

use anyhow::{Context, bail, ensure};
use clap::Args;
use covr_engine::machine::{AxisLimits, Limits};
use covr_wire::commissioning::{
    BrakeRun, Commissioning, CommissioningStep, END_MARGIN_M, NewCommissioning, RailAxis, test_speed_mps,
};
use covr_wire::dashboard::{JogAim, Mode, Snapshot};
use serde_json::json;

use crate::visitor::credentials::Credentials;
use desk::Desk;

/// Walk through the first motion of a machine.
#[derive(Debug, Clone, Args)]
pub struct Commission {
    /// The server.
    #[arg(long, default_value = "http://127.0.0.1:7878")]
    pub url: String,
    /// The token that it signs in with, where the server has tokens: a game master's or an administrator's.
    #[arg(long, env = "COVR_TOKEN", hide_env_values = true)]
    pub token: Option<String>,
    /// The authority of the server's certificate (PEM), for https.
    #[arg(long)]
    pub authority: Option<PathBuf>,
}

/// Walk through it; answers are read from standard input.
pub async fn run(options: &Commission) -> anyhow::Result<()> {
    let credentials = Credentials::new(options.token.as_deref(), options.authority.as_deref())?;
    let mut desk = Desk::connect(&options.url, &credentials).await?;
    say(&format!("Commissioning of the {} machine at {}.", desk.machine, options.url))?;
    say("Keep the wired emergency stop in your hand. Ctrl-C lets go of the column at any time.")?;
    desk.author = ask("Who are you?").await?;
    ensure!(!desk.author.is_empty(), "a name is needed: it is recorded with the commissioning");
    let load_kg = ask_number("What hangs on the carriage, column and props, in kg?").await?;
    let begun_at = newest_event_time(&desk).await?;
    let mut steps = Vec::new();
    for step in CommissioningStep::ALL {
        say(&format!("\n{}. {}", steps.len() + 1, capital(step.in_words())))?;
        match step {
            CommissioningStep::WiredStop => wired_stop(&mut desk).await,
            CommissioningStep::ArenaClear => {
                confirm("Look into the arena: is nobody in it, and nothing in the column's way?").await
            }
            CommissioningStep::Link => link(&mut desk).await,
            CommissioningStep::Home => home(&mut desk).await,
            CommissioningStep::Directions => directions(&mut desk).await,
            CommissioningStep::StopLanes => stop_lanes(&mut desk).await,
            CommissioningStep::Brake => brake(&mut desk).await,
        }
        .with_context(|| format!("not commissioned: {}", step.in_words()))?;
        steps.push(step);
    }
    let new = NewCommissioning { begun_at, load_kg, steps };
    let stored = desk.post("commissionings", Some(serde_json::to_value(new)?)).await?;
    let stored: Commissioning = serde_json::from_value(stored)?;
    let [x, y] = stored.braking_mps2;
    say(&format!(
        "\nCommissioned under {load_kg:.1} kg: the brake does {x:.2} m/s2 along x and {y:.2} m/s2 along y. \
         Until the machine changes it can be armed."
    ))
}

async fn wired_stop(desk: &mut Desk) -> anyhow::Result<()> {
    confirm(
        "Press the wired emergency stop. Have the motors lost their power, so that the column can be pushed? Then release it; \
         a board that latches it wants its own power off and on.",
    )
    .await?;
    reset_if_stopped(desk, LONGEST_MENDING).await
}

async fn link(desk: &mut Desk) -> anyhow::Result<()> {
    let before = desk.state().await?;
    let Some(health) = before.machine_health else { return say("   This machine has no link.") };
    let (exchanges, lost) = (health.link.exchanges, health.link.lost);
    let enough = |snapshot: &Snapshot| {
        snapshot
            .machine_health
            .as_ref()
            .is_some_and(|now| now.link.exchanges + now.link.lost > exchanges + lost + EXCHANGES)
    };
    let after = desk.wait("exchanges on the link", LONGEST_LINK, enough).await?;
    let link = after.machine_health.context("the link is gone")?.link;
    let (answered, lost) = (link.exchanges.saturating_sub(exchanges), link.lost.saturating_sub(lost));
    let share = 100.0 * lost as f64 / (answered + lost) as f64;
    say(&format!(
        "   {:.0} cycles a second, {share:.2} % of {} exchanges lost.",
        link.rate_hz,
        answered + lost
    ))?;
    ensure!(
        share < 1.0,
        "more than a hundredth of the exchanges is lost: look at cable, ground and baud rate"
    );
    Ok(())
}

async fn home(desk: &mut Desk) -> anyhow::Result<()> {
    reset_if_stopped(desk, LONGEST_STOP).await?;
    if desk.state().await?.mode != Mode::Ready {
        desk.post("home", None).await?;
    }
    let homed = desk.wait("homed", LONGEST_HOMING, |snapshot| match snapshot.mode {
        Mode::Ready | Mode::LatchedStop | Mode::Faulted => true,
        Mode::Disarmed | Mode::Homing | Mode::Following | Mode::ProtectiveStop => false,
    });
    let homed = homed.await?;
    if let Some(stop) = homed.stop {
        bail!("it stopped: {}", stop.reason);
    }
    let [x, y] = homed.column.position_m;
    say(&format!("   Homed; the column stands at ({x:.3}, {y:.3}) m."))?;
    let Some([x, y]) = homed.column.home_repeatability_m else { return Ok(()) };
    say(&format!(
        "   The second, slow approach found the home {:+.2} mm along x and {:+.2} mm along y from the first.",
        x * 1e3,
        y * 1e3
    ))
}

async fn directions(desk: &mut Desk) -> anyhow::Result<()> {
    for (axis, along, question) in [
        (RailAxis::X, [1.0, 0.0], "Did it go along the long rail, away from the home corner?"),
        (RailAxis::Y, [0.0, 1.0], "Did it go along the cross rail, away from the home corner?"),
    ] {
        confirm(&format!("The column will creep {CREEP_WAY_M} m along {}. Ready?", axis.name())).await?;
        let from = desk.state().await?.column.position_m;
        let gone = |snapshot: &Snapshot| {
            snapshot.column.position_m[axis as usize] - from[axis as usize] > CREEP_WAY_M
        };
        let moved = desk.jog(JogAim::Along(along), CREEP_MPS, LONGEST_CREEP, gone).await;
        desk.let_go().await?;
        moved.context(
            "it was told to go away from the home corner; is an encoder or a motor the other way round?",
        )?;
        confirm(question).await?;
    }
    Ok(())
}

async fn stop_lanes(desk: &mut Desk) -> anyhow::Result<()> {
    confirm("The column will creep and be stopped twice. Ready?").await?;
    for by_http in [true, false] {
        let to_middle = middle(desk);
        desk.jog(JogAim::Place(to_middle), CREEP_MPS, LONGEST_CREEP, |snapshot| {
            speed(snapshot) > 0.5 * CREEP_MPS
        })
        .await?;
        if by_http {
            say(&format!(
                "   By HTTP: at the drive after {:.1} ms.",
                desk.stop_by_http().await? as f64 / 1e3
            ))?;
        } else {
            desk.stop_by_socket().await?;
            say("   By the dashboard's socket: acknowledged.")?;
        }
        desk.wait("at rest", LONGEST_STOP, |snapshot| speed(snapshot) < AT_REST_MPS).await?;
        reset_if_stopped(desk, LONGEST_STOP).await?;
    }
    Ok(())
}

async fn brake(desk: &mut Desk) -> anyhow::Result<()> {
    let shape = desk.shape.clone();
    let [x0, y0, x1, y1] = shape.travel_m;
    for axis in RailAxis::BOTH {
        let i = axis as usize;
        let (low, high) = if axis == RailAxis::X { (x0, x1) } else { (y0, y1) };
        let limits = axis_limits(&shape.speed_mps, &shape.acceleration_mps2, &shape.braking_mps2, i);
        let fastest_mps = test_speed_mps(high - low, &limits);
        for positive in [true, false] {
            for share in [0.5, 1.0] {
                let speed_mps = share * fastest_mps;
                let way = if positive { "away from" } else { "towards" };
                confirm(&format!(
                    "The column will run at {speed_mps:.2} m/s along {}, {way} the home corner, and be stopped. Is nobody in the arena?",
                    axis.name()
                ))
                .await?;
                let run = one_run(desk, axis, positive, speed_mps, (low, high)).await?;
                let braking_mps2 = run.braking_mps2[i].context("the server measured no deceleration")?;
                say(&format!(
                    "   Stopped from {:.2} m/s within {:.3} m of {:.3} m that are allowed for: {braking_mps2:.2} m/s2.",
                    run.velocity_mps[i].abs(),
                    run.distance_m[i].abs(),
                    run.allowed_m[i]
                ))?;
                // A faster run relies on half of what the limits say.
                ensure!(
                    braking_mps2 > 0.6 * limits.braking_mps2,
                    "that is far less than the {:.2} m/s2 of its limits: lower machine.{}.braking_mps2, or mend the brake",
                    limits.braking_mps2,
                    axis.name()
                );
            }
        }
    }
    Ok(())
}

async fn one_run(
    desk: &mut Desk,
    axis: RailAxis,
    positive: bool,
    speed_mps: f64,
    (low, high): (f64, f64),
) -> anyhow::Result<BrakeRun> {
    let i = axis as usize;
    let mut start = middle(desk);
    start[i] = if positive { low + END_MARGIN_M } else { high - END_MARGIN_M };
    desk.post("arena/clear", None).await?;
    let there = |snapshot: &Snapshot| {
        let [x, y] = snapshot.column.position_m;
        (x - start[0]).hypot(y - start[1]) < AT_START_M && speed(snapshot) < AT_REST_MPS
    };
    desk.jog(JogAim::Place(start), REDUCED_MPS, LONGEST_CREEP, there).await.context("to its start")?;
    desk.forget_events();
    let mut along = [0.0; 2];
    along[i] = if positive { 1.0 } else { -1.0 };
    let at_speed = |snapshot: &Snapshot| snapshot.column.velocity_mps[i].abs() > AT_SPEED_SHARE * speed_mps;
    desk.jog(JogAim::Along(along), speed_mps, LONGEST_CREEP, at_speed).await.context("up to speed")?;
    desk.stop_by_http().await?;
    let event = desk.event("came_to_rest", LONGEST_STOP).await?;
    reset_if_stopped(desk, LONGEST_STOP).await?;
    Ok(serde_json::from_value(event.detail)?)
}

/// Leave a stop that this program made, or the wired stop.
async fn reset_if_stopped(desk: &mut Desk, patience: Duration) -> anyhow::Result<()> {
    let stopped = |snapshot: &Snapshot| matches!(snapshot.mode, Mode::LatchedStop | Mode::Faulted);
    if stopped(&desk.state().await?) {
        let may_reset = |snapshot: &Snapshot| {
            snapshot.requests.iter().any(|state| state.request == "reset" && state.refused_because.is_none())
        };
        desk.wait("the cause of the stop is gone", patience, may_reset).await?;
        desk.post("reset", Some(json!({ "reason": "commissioning" }))).await?;
        desk.wait("reset", LONGEST_STOP, |snapshot| !stopped(snapshot)).await?;
    }
    Ok(())
}

/// Events have the server's clock: the newest one's time, so that what is measured from now on is later.
async fn newest_event_time(desk: &Desk) -> anyhow::Result<String> {
    // Whoever begins this says that the arena is clear; that makes an event of now.
    desk.post("arena/clear", None).await?;
    let events = desk.get("events?limit=1").await?;
    events[0]["at"].as_str().map(str::to_owned).context("the server has no event")
}

fn middle(desk: &Desk) -> [f64; 2] {
    let [x0, y0, x1, y1] = desk.shape.travel_m;
    [0.5 * (x0 + x1), 0.5 * (y0 + y1)]
}

fn axis_limits(speed: &[f64; 2], up: &[f64; 2], down: &[f64; 2], i: usize) -> AxisLimits {
    AxisLimits {
        speed_mps: speed[i],
        acceleration_mps2: up[i],
        braking_mps2: down[i],
        jerk_mps3: Limits::PAPER.x.jerk_mps3,
    }
}

fn speed(snapshot: &Snapshot) -> f64 {
    let [x, y] = snapshot.column.velocity_mps;
    x.hypot(y)
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + letters.as_str())
}

/// Ask for a yes; anything else ends it.
async fn confirm(question: &str) -> anyhow::Result<()> {
    let answer = ask(&format!("   {question} [yes/no]")).await?;
    ensure!(answer.eq_ignore_ascii_case("yes"), "answered \"{answer}\", and only yes goes on");
    Ok(())
}

async fn ask_number(question: &str) -> anyhow::Result<f64> {
    let answer = ask(question).await?;
    match answer.replace(',', ".").parse::<f64>() {
        Ok(number) if number >= 0.0 && number.is_finite() => Ok(number),
        _ => bail!("found \"{answer}\", expected a number of kilograms"),
    }
}

async fn ask(question: &str) -> anyhow::Result<String> {
    say(question)?;
    let line = tokio::task::spawn_blocking(|| {
        let mut line = String::new();
        std::io::stdin().read_line(&mut line).map(|read| (read, line))
    });
    let (read, line) = line.await??;
    ensure!(read > 0, "nobody answers");
    Ok(line.trim().to_owned())
}

fn say(words: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{words}")?;
    Ok(out.flush()?)
}

const CREEP_WAY_M: f64 = 0.2;
const CREEP_MPS: f64 = 0.1;
const REDUCED_MPS: f64 = 0.24;
const AT_SPEED_SHARE: f64 = 0.97;
const AT_START_M: f64 = 0.02;
const AT_REST_MPS: f64 = 0.01;
const EXCHANGES: u64 = 500;
const LONGEST_LINK: Duration = Duration::from_secs(60);
const LONGEST_HOMING: Duration = Duration::from_secs(180);
const LONGEST_CREEP: Duration = Duration::from_secs(120);
const LONGEST_STOP: Duration = Duration::from_secs(20);
/// Somebody walks to the board and back.
const LONGEST_MENDING: Duration = Duration::from_secs(300);
