//! Why a calibration is refused, as an id and its values, and in plain English.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

/// Why points do not make a calibration. Lengths in metres, angles in radians.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(tag = "id", rename_all = "snake_case")]
pub enum CalibrationRefusal {
    /// Too few points.
    TooFewPoints {
        /// How many there are.
        found: usize,
        /// The fewest that are enough.
        fewest: usize,
    },
    /// More points than are taken.
    TooManyPoints {
        /// How many there are.
        found: usize,
        /// The most that are taken.
        most: usize,
    },
    /// The points lie too close together.
    PointsTooClose {
        /// How far they spread, root mean square along the longest direction.
        spread_m: f64,
        /// How far they must.
        least_m: f64,
    },
    /// The points lie on one line.
    PointsOnALine {
        /// How far they spread across the line, root mean square.
        spread_m: f64,
        /// How far they must.
        least_m: f64,
    },
    /// Distances in the tracking space are not those of the room.
    WrongScale {
        /// Room metres in a tracking metre.
        scale: f64,
        /// The most that it may be off 1.
        most_off: f64,
    },
    /// The points fit in a mirror only: the client declares axes that it does not have.
    Mirrored,
    /// Too many points disagree with the others.
    TooManyOutliers {
        /// How many disagree.
        outliers: usize,
        /// Of so many.
        points: usize,
        /// The most that may.
        most: usize,
    },
    /// The points do not fit well enough.
    PoorFit {
        /// Root mean square of the distances that are left.
        rms_m: f64,
        /// The most that it may be.
        most_m: f64,
    },
    /// The room would be tilted.
    Tilted {
        /// Between the two frames' upward axes.
        tilt_rad: f64,
        /// The most that it may be.
        most_rad: f64,
    },
    /// The result is too uncertain.
    Uncertain {
        /// 95 % of such fits are within this at the worst of the points.
        uncertainty_m: f64,
        /// The most that it may be.
        most_m: f64,
    },
    /// The headset moved while it was being measured.
    Moved {
        /// How far from its mean place.
        moved_m: f64,
        /// The most that it may.
        most_m: f64,
    },
    /// Too few poses came while it was being measured.
    TooFewPoses {
        /// How many came.
        found: usize,
        /// The fewest that are enough.
        fewest: usize,
    },
    /// The headset lost its place while it was being measured.
    NotTracked,
    /// A headset on the column whose offset is not known, and no point to tell it by.
    OffsetUnknown {
        /// How many touched points there are.
        found: usize,
        /// The fewest that tell it.
        fewest: usize,
    },
    /// The column moved while the point was taken.
    ColumnMoved {
        /// How far.
        moved_m: f64,
        /// The most that it may.
        most_m: f64,
    },
}

impl CalibrationRefusal {
    /// One of each, for the catalogues that must have them all.
    pub fn examples() -> Vec<Self> {
        vec![
            Self::TooFewPoints { found: 4, fewest: 6 },
            Self::TooManyPoints { found: 31, most: 30 },
            Self::PointsTooClose { spread_m: 0.21, least_m: 0.5 },
            Self::PointsOnALine { spread_m: 0.04, least_m: 0.25 },
            Self::WrongScale { scale: 1.034, most_off: 0.01 },
            Self::Mirrored,
            Self::TooManyOutliers { outliers: 5, points: 12, most: 4 },
            Self::PoorFit { rms_m: 0.0312, most_m: 0.015 },
            Self::Tilted { tilt_rad: 0.0524, most_rad: 0.0349 },
            Self::Uncertain { uncertainty_m: 0.0123, most_m: 0.01 },
            Self::Moved { moved_m: 0.0214, most_m: 0.008 },
            Self::TooFewPoses { found: 12, fewest: 30 },
            Self::NotTracked,
            Self::OffsetUnknown { found: 1, fewest: 3 },
            Self::ColumnMoved { moved_m: 0.0041, most_m: 0.002 },
        ]
    }
}

impl fmt::Display for CalibrationRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFewPoints { found, fewest } => {
                write!(f, "{found} points are too few: at least {fewest} are needed")
            }
            Self::TooManyPoints { found, most } => write!(f, "{found} points are more than the {most} that are taken"),
            Self::PointsTooClose { spread_m, least_m } => write!(
                f,
                "the points are too close together: they spread {spread_m:.2} m, at least {least_m:.2} m is needed; use the whole arena"
            ),
            Self::PointsOnALine { spread_m, least_m } => write!(
                f,
                "the points lie nearly on one line: they spread {spread_m:.2} m across it, at least {least_m:.2} m is needed"
            ),
            Self::WrongScale { scale, most_off } => {
                write!(f, "a metre of the headset is {scale:.3} m in the room; ")?;
                if (0.005..0.02).contains(scale) {
                    f.write_str("the client seems to send centimetres under a convention of metres")
                } else if (50.0..200.0).contains(scale) {
                    f.write_str("the client seems to send metres under a convention of centimetres")
                } else {
                    write!(
                        f,
                        "it may be off 1 by {:.0} % at most: the client's unit, or the places that were entered, are wrong",
                        most_off * 100.0
                    )
                }
            }
            Self::Mirrored => f.write_str(
                "the points fit only in a mirror or upside down: the client declares a convention whose axes are not its own",
            ),
            Self::TooManyOutliers { outliers, points, most } => write!(
                f,
                "{outliers} of {points} points disagree with the others, at most {most} may: were places mixed up?"
            ),
            Self::PoorFit { rms_m, most_m } => write!(
                f,
                "the points are {:.1} mm off on average, at most {:.1} mm is good enough: were places mixed up, or did the tracking jump?",
                rms_m * 1e3,
                most_m * 1e3
            ),
            Self::Tilted { tilt_rad, most_rad } => write!(
                f,
                "the headset's upward axis is {:.1} degrees off the room's, at most {:.1} is believed: are the heights right?",
                tilt_rad.to_degrees(),
                most_rad.to_degrees()
            ),
            Self::Uncertain { uncertainty_m, most_m } => write!(
                f,
                "the result would be uncertain by {:.1} mm, at most {:.1} mm is good enough: take more points, further apart",
                uncertainty_m * 1e3,
                most_m * 1e3
            ),
            Self::Moved { moved_m, most_m } => write!(
                f,
                "it moved by {:.1} mm while it was being measured, at most {:.1} mm is still: hold it still or put it down",
                moved_m * 1e3,
                most_m * 1e3
            ),
            Self::TooFewPoses { found, fewest } => {
                write!(f, "{found} poses came in that time, at least {fewest} are needed: is the headset awake?")
            }
            Self::NotTracked => f.write_str("the headset did not know its place all the time"),
            Self::OffsetUnknown { found, fewest } => write!(
                f,
                "where the headset sits on the column is not known: enter it, or touch at least {fewest} places with the same headset ({found} so far)"
            ),
            Self::ColumnMoved { moved_m, most_m } => write!(
                f,
                "the column moved by {:.1} mm while the point was taken, at most {:.1} mm is at rest",
                moved_m * 1e3,
                most_m * 1e3
            ),
        }
    }
}

impl std::error::Error for CalibrationRefusal {}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn there_is_an_example_of_each() {
        let schema = schemars::schema_for!(CalibrationRefusal).to_value();
        let known = schema["oneOf"].as_array().unwrap().iter();
        let known: BTreeSet<_> = known.map(|one| one["properties"]["id"]["const"].to_string()).collect();
        let shown = CalibrationRefusal::examples().into_iter();
        let shown: Vec<_> = shown.map(|one| serde_json::to_value(one).unwrap()["id"].to_string()).collect();
        assert_eq!(shown.len(), known.len());
        assert_eq!(shown.into_iter().collect::<BTreeSet<_>>(), known);
    }
}
