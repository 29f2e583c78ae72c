//! `covr visitor`: a person, recorded or made up, as a VR client over the real WebSocket at real rate.
//!
//! It knows the server as any headset does: by its protocol and its public HTTP API.

mod api;
pub mod credentials;
mod headset;
mod recorded;

use std::time::Duration;

use anyhow::{Context, bail};
use covr_engine::frames::{Pose, Room};
use covr_engine::observation::Hands;
use covr_engine::time::Time;
use covr_study::visitor::{Phase, Visitor as MadeUp, VisitorSample};
use covr_wire::scene::{SceneDocument, build_scene};

use crate::cli::Visitor;
use api::Api;
use credentials::Credentials;
use headset::Headset;
use recorded::Program;

/// Play until the connection is lost; with `--wait-for-server`, then again.
pub async fn run(options: Visitor) -> anyhow::Result<()> {
    let credentials = Credentials::new(options.token.as_deref(), options.authority.as_deref())?;
    let api = Api::new(&options.url, credentials)?;
    let mut program =
        options.trace.as_deref().map(|path| Program::open(path, options.trial.as_deref())).transpose()?;
    loop {
        if options.wait_for_server {
            api.wait_until_healthy().await;
        }
        let Err(error) = visit(&options, &api, program.as_mut()).await;
        if !options.wait_for_server || error.downcast_ref::<headset::Lost>().is_none() {
            return Err(error);
        }
        tracing::warn!("{error:#}; waiting for the server");
        tokio::time::sleep(RECONNECT_AFTER).await;
    }
}

/// One connection's life.
async fn visit(
    options: &Visitor,
    api: &Api,
    program: Option<&mut Program>,
) -> Result<std::convert::Infallible, anyhow::Error> {
    let ready = options.arm && api.home_simulated_machine().await?;
    let mut headset = Headset::connect(&options.url, &options.name, api.credentials()).await?;
    if ready {
        api.arm().await?;
    }
    match program {
        Some(program) => play_recordings(options, api, &mut headset, program).await,
        None => walk_for_ever(options, &mut headset).await,
    }
}

async fn play_recordings(
    options: &Visitor,
    api: &Api,
    headset: &mut Headset,
    program: &mut Program,
) -> Result<std::convert::Infallible, anyhow::Error> {
    let mut shown: Option<SceneDocument> = None;
    loop {
        let recording = program.next_recording()?;
        if let Some(scene) = recorded::scene_of(&recording)
            && shown.as_ref() != Some(&scene)
        {
            api.show_scene(&scene, &options.name).await?;
            shown = Some(scene);
        }
        tracing::info!(
            trial = recording.trial,
            person = recording.user,
            secs = recording.duration().secs(),
            "a recorded person enters"
        );
        let room_from_trace = recording.room_from_trace();
        let samples = recording.resampled(SEND_HZ / options.speed).map(|sample| Moment {
            at: sample.at,
            head: room_from_trace.pose(&sample.pose),
            hands: sample.hands_in(&room_from_trace),
            touches: None,
        });
        play(options, headset, samples).await?;
    }
}

async fn walk_for_ever(
    options: &Visitor,
    headset: &mut Headset,
) -> Result<std::convert::Infallible, anyhow::Error> {
    for walk in 0.. {
        let Some(document) = headset.scene() else { bail!("the server has no active scene") };
        let scene = build_scene(document).map_err(|errors| {
            anyhow::anyhow!(
                "the server's scene: {}",
                errors.first().map(ToString::to_string).unwrap_or_default()
            )
        })?;
        tracing::info!(scene = document.name, "a made-up person enters");
        let ids: Vec<String> = scene.spec().objects.iter().map(|object| object.id.clone()).collect();
        let mut person =
            MadeUp::of_scene(scene.spec(), SEND_HZ / options.speed, options.seed.wrapping_add(walk));
        let samples = std::iter::from_fn(move || Some(Moment::of_made_up(&person.sample(), &ids)));
        play(options, headset, samples).await?;
    }
    bail!("the visitor walked for ever")
}

/// Enter, send each sample at its moment, leave. Ends early when the server changes its scene.
async fn play(
    options: &Visitor,
    headset: &mut Headset,
    mut samples: impl Iterator<Item = Moment>,
) -> anyhow::Result<()> {
    let scene_version = headset.scene_version();
    let Some(first) = samples.next() else { return Ok(()) };
    headset.enter(&options.name, &first.head, &first.hands).await?;
    let started = tokio::time::Instant::now();
    let mut touches: Option<String> = None;
    for moment in samples {
        let since_first = (moment.at - first.at).secs() / options.speed;
        headset.listen_until(started + Duration::from_secs_f64(since_first.max(0.0))).await?;
        if options.trace.is_none() && headset.scene_version() != scene_version {
            break;
        }
        headset.send_pose(&options.name, &moment.head, &moment.hands).await.context("a pose")?;
        if touches != moment.touches {
            if let Some(object) = std::mem::replace(&mut touches, moment.touches) {
                headset.let_go(&options.name, &object).await?;
            }
            if let Some(object) = &touches {
                headset.touch(&options.name, object).await?;
            }
        }
    }
    headset.leave(&options.name).await
}

/// A person at one moment.
struct Moment {
    at: Time,
    head: Pose<Room>,
    hands: Hands,
    /// The object at which the hand is. Recordings do not say.
    touches: Option<String>,
}

impl Moment {
    fn of_made_up(sample: &VisitorSample, objects: &[String]) -> Self {
        let touched = sample.goal.filter(|_| sample.phase == Phase::Dwells);
        let touches = touched.and_then(|goal| objects.get(goal)).cloned();
        Self { at: sample.at, head: sample.pose, hands: sample.hands, touches }
    }
}

/// Within the protocol's 60 to 120 Hz, whatever the speed.
const SEND_HZ: f64 = 75.0;
const RECONNECT_AFTER: Duration = Duration::from_millis(500);
