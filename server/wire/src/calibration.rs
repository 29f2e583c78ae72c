//! Calibration: from places measured in two frames to the map between them. Pure; tracking coordinates stay in this crate.
//!
//! * [`fit_room`]: a rigid map from pairs of a tracking point and the room point that it is at.
//! * [`fit_column`]: the same from a headset that rides on the column, at an offset that nobody measured.
//! * [`Stillness`]: one point from the poses of a second, refused where the headset moved.
//! * [`fit_prop`]: where on the column a prop sits, and which way it faces.
//!
//! Every fit says how well each point agrees, and is refused, with a reason for people, where it is not good enough.

mod column;
mod document;
mod draft;
mod fit;
mod prop;
mod refusal;
mod robust;
mod still;

use covr_engine::frames::{Point, RigidMap, Room, Tracking};

pub use column::{ColumnFit, ColumnVisit, fit_column};
pub use document::{
    Calibration, CalibrationDraft, CalibrationKind, CalibrationPoint, CalibrationResult, CalibrationSummary,
    CalibrationTask, Hardware, HardwareChange, HardwarePart, NewCalibrationPoint, PointOn, Pointer,
};
pub use draft::Measured;
pub use fit::{Bounds, FEWEST_POINTS, MOST_POINTS, Residual, RoomFit, fit_room};
pub use prop::{FaceFit, PropBounds, PropFit, PropTouch, fit_prop};
pub use refusal::CalibrationRefusal;
pub use still::{StillPoint, Stillness};

/// One place, measured in both frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Where the headset said that it was, in its tracking space.
    pub tracking: Point<Tracking>,
    /// Where it was in the room.
    pub room: Point<Room>,
}

/// `room_from_tracking` of one tracking space.
pub type RoomFromTracking = RigidMap<Tracking, Room>;
