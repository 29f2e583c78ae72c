//! From the engine's state to what a client is told, in its own convention and units.

use std::collections::BTreeMap;

use covr_engine::frames::{Point, Pose, Room};
use covr_engine::machine::Limits;
use covr_engine::mode::Mode;
use covr_engine::scene::Scene;
use covr_engine::snapshot::Snapshot;
use nalgebra::{UnitQuaternion, Vector3};

use super::{
    ActiveScene, ClientLimits, ColumnNow, InteractionNow, MAX_FRAME_BYTES, ObjectPlace, Prediction, PropAt,
    ScenarioNow, StopState,
};
use crate::convention::ClientFrame;
use crate::dashboard::clears_when;
use crate::reason::Reason;
use crate::scene::SceneDocument;

impl ActiveScene {
    /// A stored scene for one client.
    pub fn new(id: i64, version: i64, document: SceneDocument, frame: &ClientFrame) -> Self {
        let places = document
            .objects
            .iter()
            .map(|object| {
                let [x, y, z] = object.position;
                let orientation = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), object.yaw);
                let pose = Pose::<Room> { position: Point::new(x, y, z), orientation };
                let (position, orientation) = frame.client_pose(&pose);
                ObjectPlace { object: object.id.clone(), position, orientation }
            })
            .collect();
        Self { id, version, document, client_from_room: frame.client_from_room(), places }
    }
}

impl ClientLimits {
    /// The machine's limits and the protocol's; `max_pose_age_secs` is the limit of R2.
    pub fn new(limits: &Limits, max_pose_age_secs: f64) -> Self {
        Self {
            speed_mps: [limits.x.speed_mps, limits.y.speed_mps],
            acceleration_mps2: [limits.x.acceleration_mps2, limits.y.acceleration_mps2],
            braking_mps2: [limits.x.braking_mps2, limits.y.braking_mps2],
            pose_rate_hz: POSE_RATE_HZ,
            frame_bytes: MAX_FRAME_BYTES,
            max_pose_age_secs,
        }
    }
}

impl ColumnNow {
    /// The column as one client sees it. The snapshot is of this scene.
    pub fn new(state: &Snapshot, scene: &Scene, frame: &ClientFrame) -> Self {
        let column = &state.column;
        let spec = scene.spec();
        let prop_at = state
            .objects
            .iter()
            .zip(&spec.objects)
            .map(|(now, object)| PropAt {
                object: now.id.clone(),
                prop: object.prop.and_then(|prop| spec.props.get(prop)).map(|prop| prop.id.clone()),
                in_place: column.homed && column.position.distance_m(now.column_place) <= IN_PLACE_M,
            })
            .collect();
        Self {
            at_micros: state.at.micros(),
            mode: state.mode.into(),
            position: frame.client_point(&Point::new(column.position.x, column.position.y, 0.0)),
            velocity: frame.client_velocity(column.velocity),
            homed: column.homed,
            prop_at,
            interaction: state.interaction.as_ref().and_then(|now| {
                let object = spec.objects.get(now.object)?;
                let offset = object.prop.and_then(|prop| spec.props.get(prop)).map(|prop| prop.offset);
                let place = column.position + offset.unwrap_or_default();
                Some(InteractionNow {
                    object: object.id.clone(),
                    interaction: now.interaction.into(),
                    phase: now.phase.into(),
                    position: frame.client_point(&Point::new(place.x, place.y, object.position.z())),
                })
            }),
        }
    }
}

impl Prediction {
    /// The object that the rule is committed to, else the most probable one; none while nobody is served.
    pub fn new(state: &Snapshot, frame: &ClientFrame) -> Option<Self> {
        state.column.serves?;
        let committed = state.column.committed.and_then(|i| state.objects.get(i));
        let probable = || state.objects.iter().max_by(|a, b| a.probability.total_cmp(&b.probability));
        let object = committed.or_else(probable)?;
        Some(Self {
            at_micros: state.at.micros(),
            object: object.id.clone(),
            probability: object.probability,
            arrival_secs: object.arrival_secs,
            late_by_s: object.late_by_secs,
            in_time_probability: object.in_time_probability,
            offset_m: object.offset.map(|offset| frame.client_shift_m(offset)),
        })
    }
}

impl ScenarioNow {
    /// The scenario of a snapshot; none where the scene has none.
    pub fn new(state: &Snapshot) -> Option<Self> {
        let scenario = state.scenario.as_ref()?;
        let variables = scenario.variables.iter().map(|(id, value)| (id.clone(), (*value).into()));
        Some(Self {
            state: scenario.state.clone(),
            runs: scenario.runs,
            entered: scenario.entered,
            variables: variables.collect(),
        })
    }
}

impl From<&Snapshot> for StopState {
    fn from(state: &Snapshot) -> Self {
        let stop = state.stop.as_ref();
        let nobody = BTreeMap::new();
        Self {
            stopped: matches!(state.mode, Mode::ProtectiveStop | Mode::LatchedStop | Mode::Faulted),
            mode: state.mode.into(),
            rule: stop.map(|stop| stop.rule.name()),
            reason: stop.map(|stop| Reason::new(&stop.reason, &nobody).to_string()),
            clears_when: stop.map(|stop| clears_when(stop.rule).into()),
        }
    }
}

/// Below, separation has to assume more than the person did; above, nothing is gained.
pub const POSE_RATE_HZ: [f64; 2] = [60.0, 120.0];
/// The machine's accuracy.
const IN_PLACE_M: f64 = 0.02;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::client::Convention;
    use crate::sample;
    use covr_engine::frames::{Floor, RigidMap};

    fn unreal() -> ClientFrame {
        ClientFrame::new(Convention::Unreal, RigidMap::from_yaw(0.0, Vector3::new(2.0, 2.0, 0.0)))
    }

    #[test]
    fn the_column_is_told_in_the_clients_units() {
        let scene = sample::scene();
        let mut state = sample::snapshot();
        let told = ColumnNow::new(&state, &scene, &unreal());
        assert!((Vector3::from(told.position) - Vector3::new(-100.0, 50.0, 0.0)).norm() < 1e-9);
        assert!((Vector3::from(told.velocity) - Vector3::new(20.0, -10.0, 0.0)).norm() < 1e-9);
        assert!(!told.prop_at[0].in_place);
        state.column.position = state.objects[0].column_place + covr_engine::frames::Planar::new(0.015, 0.0);
        let told = ColumnNow::new(&state, &scene, &unreal());
        assert_eq!(told.prop_at.iter().map(|p| p.in_place).collect::<Vec<_>>(), [true, false]);
        assert_eq!(told.prop_at[0].prop.as_deref(), Some("handle"));
        state.column.homed = false;
        assert!(!ColumnNow::new(&state, &scene, &unreal()).prop_at[0].in_place);
    }

    #[test]
    fn a_prediction_says_how_late_the_column_is() {
        let mut state = sample::snapshot();
        let told = Prediction::new(&state, &unreal()).unwrap();
        assert_eq!(told.object, "kettle");
        assert_eq!((told.late_by_s, told.in_time_probability), (Some(0.5), Some(0.25)));
        // The room's +y is Unreal's left; centimetres there, metres here.
        let offset = Vector3::from(told.offset_m.unwrap());
        assert!((offset - Vector3::new(0.01, -0.02, 0.0)).norm() < 1e-9, "{offset}");
        state.column.committed = None;
        let told = Prediction::new(&state, &unreal()).unwrap();
        assert_eq!((told.object.as_str(), told.offset_m), ("lamp", None));
        state.column.serves = None;
        assert_eq!(Prediction::new(&state, &unreal()), None);
    }

    #[test]
    fn a_stop_is_told_with_what_clears_it() {
        let mut state = sample::snapshot();
        let told = StopState::from(&state);
        assert!(told.stopped);
        assert_eq!(told.rule.as_deref(), Some("R2"));
        state.mode = Mode::Ready;
        state.stop = None;
        assert!(!StopState::from(&state).stopped);
    }

    #[test]
    fn every_object_has_its_place_in_the_clients_space() {
        let told = ActiveScene::new(1, 2, sample::document(), &unreal());
        let object = &told.document.objects[0];
        let room = unreal().room_pose(told.places[0].position, told.places[0].orientation);
        assert!(room.position.floor().distance_m(Floor::new(object.position[0], object.position[1])) < 1e-9);
        assert!((room.view().y.atan2(room.view().x) - object.yaw).abs() < 1e-9);
    }
}
