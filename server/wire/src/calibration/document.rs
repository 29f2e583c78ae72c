//! A calibration as it is stored and shown, and one in the making. Room frame, SI units.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

use super::CalibrationRefusal;
use crate::client::Convention;

/// What is calibrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum CalibrationKind {
    /// Where a client's tracking space is in the room.
    RoomFromTracking,
    /// Where a prop is on the column, and which way it faces.
    Prop,
}

/// With what places are touched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum Pointer {
    /// The headset itself.
    #[default]
    Head,
    /// The left hand or controller.
    LeftHand,
    /// The right hand or controller.
    RightHand,
}

/// What is to be calibrated: the body of `PUT /api/v1/calibrations/draft`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct CalibrationTask {
    /// What.
    pub kind: CalibrationKind,
    /// The name of the VR client that measures; it must be connected, with one person at most. Poses of somebody who has not
    /// entered are taken for measuring: a headset on the column is nobody.
    #[schemars(length(min = 1, max = 64))]
    pub client: String,
    /// What of it is brought to the places.
    #[serde(default)]
    pub pointer: Pointer,
    /// Of a headset that rides on the column: from the column's centre on the floor to it, room axes, m. Null: worked out from
    /// three or more touched places.
    #[serde(default)]
    #[schemars(inner(inner(range(min = -3.0, max = 3.0))))]
    pub offset_m: Option<[f64; 3]>,
    /// Of a prop: its id in the active scene.
    #[serde(default)]
    pub prop: Option<String>,
}

/// What a point is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum PointOn {
    /// A place of the room that is given.
    Place,
    /// The column: the headset rides on it.
    Column,
    /// The prop's point of touch.
    PropPoint,
    /// Somewhere on the prop's face.
    PropFace,
}

/// A point to be taken now: the body of `POST /api/v1/calibrations/draft/points`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct NewCalibrationPoint {
    /// What it is on.
    pub on: PointOn,
    /// Where that is in the room, m; for a `place` alone.
    #[serde(default)]
    #[schemars(inner(inner(range(min = -100.0, max = 100.0))))]
    pub place_m: Option<[f64; 3]>,
}

/// A point that was taken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct CalibrationPoint {
    /// Its number in this calibration, from 1; a number is never used again.
    pub number: u32,
    /// What it is on.
    pub on: PointOn,
    /// Where the headset said that it was: in its own tracking space, turned to x forward, y left, z up, m.
    pub tracking_m: [f64; 3],
    /// The place in the room, m; of a point on column or prop: the column's measured centre on the floor.
    pub room_m: [f64; 3],
    /// From how many poses.
    pub poses: usize,
    /// Root mean square distance of a pose from their mean, m.
    pub jitter_m: f64,
    /// How far the fit leaves it, m; null without a fit.
    pub residual_m: Option<f64>,
    /// It has a part in the fit; false: it disagrees with the others. Null without a fit.
    pub used: Option<bool>,
}

/// What was worked out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum CalibrationResult {
    /// Where a client's tracking space is.
    RoomFromTracking {
        /// What the client had declared. A client that declares another is not calibrated by this.
        convention: Convention,
        /// Of the tracking space's origin in the room, m.
        position_m: [f64; 3],
        /// Unit quaternion x, y, z, w from tracking axes (x forward, y left, z up) to room axes.
        orientation: [f64; 4],
        /// Root mean square of the residuals of the points used, m.
        rms_m: f64,
        /// What the scale would be, were it free.
        scale: f64,
        /// Between the two upward axes, rad.
        tilt_rad: f64,
        /// 95 % of such fits are within this at the worst of the points, m.
        uncertainty_m: f64,
        /// Standard deviation of the turn about its least certain axis, rad.
        turn_sd_rad: f64,
        /// From the column's centre on the floor to the headset that rode on it, m; null where none did.
        offset_m: Option<[f64; 3]>,
    },
    /// Where a prop is.
    Prop {
        /// Its id in the scene.
        prop: String,
        /// From the column's centre to its point of touch, m.
        offset_m: [f64; 2],
        /// Of that point above the floor, m.
        height_m: f64,
        /// Root mean square distance of the touches from their mean, m.
        rms_m: f64,
        /// Heading that it faces, rad, counter-clockwise from +x; null where its face was not touched.
        facing_rad: Option<f64>,
        /// Standard deviation of that, rad.
        facing_sd_rad: Option<f64>,
    },
}

impl CalibrationResult {
    /// Root mean square of the residuals, m.
    pub const fn rms_m(&self) -> f64 {
        match self {
            Self::RoomFromTracking { rms_m, .. } | Self::Prop { rms_m, .. } => *rms_m,
        }
    }
}

/// The hardware that a calibration is made on: what the room's coordinates hang on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Hardware {
    /// `simulated`, `roboclaw`.
    pub machine: String,
    /// Where the column's centre may be: corner of least and of greatest x and y, m. Homing ends at its corner.
    pub travel_m: [[f64; 2]; 2],
    /// The controller by its port, which names its serial number; null for a machine without one.
    pub controller: Option<String>,
    /// The controller's firmware in its own words; null where there is none, and before it was asked.
    pub firmware: Option<String>,
    /// Counts a metre of each rail's encoder; null for a machine without encoders.
    pub counts_per_metre: Option<[f64; 2]>,
}

/// What of the hardware is another than when the calibration was made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct HardwareChange {
    /// What.
    pub part: HardwarePart,
    /// What it was then.
    pub was: String,
    /// What it is now.
    pub is: String,
}

/// A part of the hardware.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum HardwarePart {
    /// The kind of machine.
    Machine,
    /// The travel.
    Travel,
    /// The controller.
    Controller,
    /// Its firmware.
    Firmware,
    /// The encoders' counts a metre.
    Encoders,
    /// The convention that the client declares.
    Convention,
}

impl HardwarePart {
    /// In plain words.
    pub const fn in_words(self) -> &'static str {
        match self {
            Self::Machine => "machine",
            Self::Travel => "travel",
            Self::Controller => "motor controller",
            Self::Firmware => "controller's firmware",
            Self::Encoders => "encoders' counts a metre",
            Self::Convention => "client's convention",
        }
    }
}

impl Hardware {
    /// What is another now. A firmware that is not known, then or now, is none that changed.
    pub fn changes(&self, now: &Self) -> Vec<HardwareChange> {
        let unsaid = || "none".to_owned();
        let travel = |hardware: &Self| {
            let [[x0, y0], [x1, y1]] = hardware.travel_m;
            format!("{x0:.3} to {x1:.3} m by {y0:.3} to {y1:.3} m")
        };
        let counts =
            |hardware: &Self| hardware.counts_per_metre.map_or_else(unsaid, |[x, y]| format!("{x} and {y}"));
        let controller = |hardware: &Self| hardware.controller.clone().unwrap_or_else(unsaid);
        let firmware = |hardware: &Self, other: &Self| {
            hardware.firmware.clone().or_else(|| other.firmware.clone()).unwrap_or_else(unsaid)
        };
        [
            (HardwarePart::Machine, self.machine.clone(), now.machine.clone()),
            (HardwarePart::Travel, travel(self), travel(now)),
            (HardwarePart::Controller, controller(self), controller(now)),
            (HardwarePart::Firmware, firmware(self, now), firmware(now, self)),
            (HardwarePart::Encoders, counts(self), counts(now)),
        ]
        .into_iter()
        .filter(|(_, was, is)| was != is)
        .map(|(part, was, is)| HardwareChange { part, was, is })
        .collect()
    }
}

/// A calibration in the making.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct CalibrationDraft {
    /// What is calibrated.
    pub task: CalibrationTask,
    /// Who began it.
    pub author: String,
    /// What was taken so far.
    pub points: Vec<CalibrationPoint>,
    /// What they give; null where they are not good enough.
    pub result: Option<CalibrationResult>,
    /// Why they are not good enough, in plain words.
    pub refused_because: Option<String>,
    /// The same as an id and its values.
    pub why: Option<CalibrationRefusal>,
}

/// A stored calibration without its points: a row of `GET /api/v1/calibrations`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct CalibrationSummary {
    /// The store's number of it.
    pub id: i64,
    /// What is calibrated.
    pub kind: CalibrationKind,
    /// Of what: the client's name, or `scene 4: prop` for a prop.
    pub subject: String,
    /// Which of this subject's it is, from 1.
    pub version: i64,
    /// Who accepted it.
    pub author: String,
    /// When, RFC 3339.
    pub created_at: String,
    /// It is the one that is used.
    pub in_force: bool,
    /// How many points have a part in it.
    pub points_used: usize,
    /// How many disagreed.
    pub points_left_out: usize,
    /// What was worked out.
    pub result: CalibrationResult,
    /// What of the hardware is another than then. While this is not empty it arms no real machine.
    pub changed: Vec<HardwareChange>,
}

/// A stored calibration, whole.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Calibration {
    /// What it is.
    #[serde(flatten)]
    pub summary: CalibrationSummary,
    /// What it was made of.
    pub points: Vec<CalibrationPoint>,
    /// What it was made on.
    pub hardware: Hardware,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hardware() -> Hardware {
        Hardware {
            machine: "roboclaw".into(),
            travel_m: [[0.0, 0.0], [4.0, 3.0]],
            controller: Some("/dev/roboclaw-00A1".into()),
            firmware: Some("USB Roboclaw 2x15a v4.3.6".into()),
            counts_per_metre: Some([20_000.0, 20_000.0]),
        }
    }

    #[test]
    fn the_same_hardware_has_not_changed_and_another_is_named() {
        assert_eq!(hardware().changes(&hardware()), []);
        let shorter = Hardware { travel_m: [[0.0, 0.0], [3.8, 3.0]], ..hardware() };
        let changes = hardware().changes(&shorter);
        assert_eq!(changes.len(), 1);
        assert_eq!(changes[0].part, HardwarePart::Travel);
        assert!(changes[0].is.contains("3.800"), "{changes:?}");
        let another = Hardware { controller: Some("/dev/roboclaw-00B2".into()), ..hardware() };
        assert_eq!(hardware().changes(&another)[0].part, HardwarePart::Controller);
    }

    #[test]
    fn a_firmware_that_was_not_asked_yet_has_not_changed() {
        let silent = Hardware { firmware: None, ..hardware() };
        assert_eq!(hardware().changes(&silent), []);
        assert_eq!(silent.changes(&hardware()), []);
        let newer = Hardware { firmware: Some("v4.4.0".into()), ..hardware() };
        assert_eq!(hardware().changes(&newer)[0].part, HardwarePart::Firmware);
    }
}
