//! The scene of a recording, in its room.

use covr_engine::frames::Floor;
use covr_engine::machine::Travel;
use covr_engine::scene::{ObjectSpec, Scene, SceneProblem, SceneSpec, Shape};

use super::Recording;

impl Recording {
    /// Where a column of the recording's room can stand: its arena.
    pub fn travel(&self) -> Travel {
        Travel { min: Floor::default(), max: Floor::default() + self.size_m() }
    }

    /// Some of the targets, as spheres about a column without props; every prior 1.
    pub fn scene(&self, targets: &[usize]) -> Result<Scene, Vec<SceneProblem>> {
        let room_from_trace = self.room_from_trace();
        let object = |&index: &usize| {
            let target = &self.targets[index];
            ObjectSpec {
                id: target.id.clone(),
                position: room_from_trace.point(&target.position),
                yaw_rad: 0.0,
                shape: Shape::Sphere { radius_m: target.radius_m },
                prop: None,
                prior: 1.0,
                enabled: true,
            }
        };
        Scene::build(SceneSpec::open(self.travel(), targets.iter().map(object).collect()))
    }
}
