//! Commissioning: the first motion of a machine, walked through by `covr commission`, and the brake test that it ends in. SI units.

use covr_engine::machine::{AxisLimits, Limits, Travel};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

use crate::calibration::{Hardware, HardwareChange};
use crate::reason::Reason;

/// A step of the checklist.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum CommissioningStep {
    /// The wired emergency stop takes the motors' power away.
    WiredStop,
    /// Somebody looked: nobody is in the arena.
    ArenaClear,
    /// The link to the controller loses less than a hundredth of what is said on it.
    Link,
    /// It homes.
    Home,
    /// Each axis moves the way that it is told.
    Directions,
    /// The software stop stops it, by HTTP and by the dashboard's socket.
    StopLanes,
    /// The brake, from speed, both ways on both axes.
    Brake,
}

impl CommissioningStep {
    /// Every step, in its order.
    pub const ALL: [Self; 7] = [
        Self::WiredStop,
        Self::ArenaClear,
        Self::Link,
        Self::Home,
        Self::Directions,
        Self::StopLanes,
        Self::Brake,
    ];

    /// In plain words.
    pub const fn in_words(self) -> &'static str {
        match self {
            Self::WiredStop => "the wired stop",
            Self::ArenaClear => "the look into the arena",
            Self::Link => "the link",
            Self::Home => "homing",
            Self::Directions => "the directions of the axes",
            Self::StopLanes => "the software stop",
            Self::Brake => "the brake",
        }
    }
}

/// What `covr commission` hands in: the body of `POST /api/v1/commissionings`. The brake's figures are not in it: the server takes
/// those of its own record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct NewCommissioning {
    /// Stops that were measured from then on count, RFC 3339, by the server's clock.
    pub begun_at: String,
    /// What hangs on the carriage, kg.
    #[schemars(range(min = 0.0, max = 500.0))]
    pub load_kg: f64,
    /// The steps done; all of them are due.
    pub steps: Vec<CommissioningStep>,
}

/// A stop from speed, as the server measured it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct BrakeRun {
    /// When the stop began, m/s.
    pub velocity_mps: [f64; 2],
    /// From the stop to rest, s.
    pub secs: f64,
    /// The way along x and y, m.
    pub distance_m: [f64; 2],
    /// The way along x and y that separation allowed for, m.
    pub allowed_m: [f64; 2],
    /// Deceleration of x and y, m/s2; null for an axis that hardly moved.
    pub braking_mps2: [Option<f64>; 2],
}

/// A commissioning as stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Commissioning {
    /// The store's number.
    #[ts(type = "number")]
    pub id: i64,
    /// Who walked through it.
    pub author: String,
    /// When it was accepted, RFC 3339.
    pub created_at: String,
    /// What hung on the carriage, kg.
    pub load_kg: f64,
    /// The least deceleration of x and y that was measured at speed, m/s2: a_b.
    pub braking_mps2: [f64; 2],
    /// The stops that this is from.
    pub runs: Vec<BrakeRun>,
    /// The machine then.
    pub hardware: Hardware,
    /// What of it is another now.
    pub changed: Vec<HardwareChange>,
}

/// An axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum RailAxis {
    /// The long rail.
    X,
    /// The cross rail.
    Y,
}

impl RailAxis {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::X, Self::Y];

    /// Its letter.
    pub const fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
        }
    }
}

/// The speed of a brake test on a rail of this length, m/s: the axis' own where there is room to get there and to brake with half of the
/// deceleration that it should have.
pub fn test_speed_mps(length_m: f64, limits: &AxisLimits) -> f64 {
    let room = (length_m - 2.0 * END_MARGIN_M).max(0.0);
    // Up, a tenth of a second at speed, and down at half: v2 / 2a + 0.1 v + v2 / b.
    let square = 0.5 / limits.acceleration_mps2 + 1.0 / limits.braking_mps2;
    let fastest =
        ((AT_SPEED_SECS * AT_SPEED_SECS + 4.0 * square * room).sqrt() - AT_SPEED_SECS) / (2.0 * square);
    fastest.min(limits.speed_mps)
}

/// What the brake can do, m/s2 for x and y, if these stops show that it does what separation relies on: from speed, both ways on both
/// axes, at least the deceleration of the limits, and within the way that was allowed for.
pub fn judge(runs: &[BrakeRun], limits: &Limits, travel: &Travel) -> Result<[f64; 2], Reason> {
    let mut least = [0.0; 2];
    for axis in RailAxis::BOTH {
        let i = axis as usize;
        let (own, length_m) = match axis {
            RailAxis::X => (&limits.x, travel.max.x - travel.min.x),
            RailAxis::Y => (&limits.y, travel.max.y - travel.min.y),
        };
        let needed_mps = SPEED_SHARE * test_speed_mps(length_m, own);
        let at_speed = |run: &&BrakeRun| run.velocity_mps[i].abs() >= needed_mps;
        for positive in [true, false] {
            let way = |run: &&BrakeRun| (run.velocity_mps[i] > 0.0) == positive;
            if !runs.iter().any(|run| at_speed(&run) && way(&run) && run.braking_mps2[i].is_some()) {
                return Err(Reason::NoBrakeRun { axis, positive, needed_mps });
            }
        }
        let measured = runs.iter().filter(at_speed).filter_map(|run| run.braking_mps2[i]);
        let measured_mps2 = measured.fold(f64::INFINITY, f64::min);
        if measured_mps2 < MEASURING_SHARE * own.braking_mps2 {
            return Err(Reason::BrakesWorse { axis, measured_mps2, needed_mps2: own.braking_mps2 });
        }
        for run in runs {
            let (distance_m, allowed_m) = (run.distance_m[i].abs(), run.allowed_m[i] + FOLLOWING_M);
            if distance_m > allowed_m {
                return Err(Reason::BrakesLonger { axis, distance_m, allowed_m });
            }
        }
        least[i] = measured_mps2;
    }
    Ok(least)
}

/// A brake test begins and ends this far from the ends of the travel, m.
pub const END_MARGIN_M: f64 = 0.1;
/// The time at speed before the stop, s.
const AT_SPEED_SECS: f64 = 0.1;
/// A stop counts from this share of the speed of the test on.
const SPEED_SHARE: f64 = 0.9;
/// Reports come every few milliseconds, so a deceleration is found to some percent.
const MEASURING_SHARE: f64 = 0.95;
/// The following error that separation allows for, m.
const FOLLOWING_M: f64 = 0.012;

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::frames::Floor;
    use proptest::prelude::*;

    const TRAVEL: Travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 1.0) };

    fn run(axis: RailAxis, speed_mps: f64, braking_mps2: f64) -> BrakeRun {
        let only = |value: f64| match axis {
            RailAxis::X => [value, 0.0],
            RailAxis::Y => [0.0, value],
        };
        let way = 0.5 * speed_mps * speed_mps / braking_mps2;
        BrakeRun {
            velocity_mps: only(speed_mps),
            secs: speed_mps.abs() / braking_mps2,
            distance_m: only(way.copysign(speed_mps)),
            allowed_m: only(0.05 * speed_mps.abs() + 0.5 * speed_mps * speed_mps / 2.5),
            braking_mps2: only(braking_mps2).map(|b| (b > 0.0).then_some(b)),
        }
    }

    fn all(braking_mps2: f64) -> Vec<BrakeRun> {
        let speeds = [(RailAxis::X, 1.1), (RailAxis::X, -1.1), (RailAxis::Y, 0.95), (RailAxis::Y, -0.95)];
        speeds.map(|(axis, speed)| run(axis, speed, braking_mps2)).to_vec()
    }

    #[test]
    fn a_brake_that_does_what_separation_relies_on_is_good() {
        assert_eq!(judge(&all(2.6), &Limits::PAPER, &TRAVEL), Ok([2.6; 2]));
    }

    #[test]
    fn what_is_missing_or_worse_is_named() {
        for left_out in 0..4 {
            let mut runs = all(2.6);
            runs.remove(left_out);
            let why = judge(&runs, &Limits::PAPER, &TRAVEL).unwrap_err();
            let named = matches!(why, Reason::NoBrakeRun { axis, positive, .. }
                if axis == RailAxis::BOTH[left_out / 2] && positive == (left_out % 2 == 0));
            assert!(named, "{why}");
        }
        let mut slow = all(2.6);
        slow[2].velocity_mps[1] = 0.5;
        assert!(matches!(
            judge(&slow, &Limits::PAPER, &TRAVEL),
            Err(Reason::NoBrakeRun { axis: RailAxis::Y, .. })
        ));
        let mut weak = all(2.6);
        weak[1].braking_mps2[0] = Some(2.0);
        assert!(matches!(
            judge(&weak, &Limits::PAPER, &TRAVEL),
            Err(Reason::BrakesWorse { axis: RailAxis::X, .. })
        ));
        let mut long = all(2.6);
        long[3].distance_m[1] = -0.6;
        assert!(matches!(
            judge(&long, &Limits::PAPER, &TRAVEL),
            Err(Reason::BrakesLonger { axis: RailAxis::Y, .. })
        ));
    }

    proptest! {
        /// There is room for the test, with half the brake.
        #[test]
        fn a_test_fits_its_rail(length_m in 0.5..10.0f64, speed in 0.3..2.0f64, up in 0.3..3.0f64, down in 0.5..5.0f64) {
            let limits = AxisLimits { speed_mps: speed, acceleration_mps2: up, braking_mps2: down, jerk_mps3: 80.0 };
            let v = test_speed_mps(length_m, &limits);
            prop_assert!(v <= speed);
            let way = v * v / (2.0 * up) + AT_SPEED_SECS * v + v * v / down;
            prop_assert!(way <= length_m - 2.0 * END_MARGIN_M + 1e-9, "{} m", way);
        }
    }
}
