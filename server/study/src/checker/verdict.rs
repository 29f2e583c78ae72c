//! What a checker found: counts, and the first violations in words.

use std::fmt;

use covr_engine::time::Time;

use super::{Axis, Motion, Quantity, Subject, Track};

/// What was found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Verdict {
    /// Ticks checked.
    pub ticks: u64,
    /// Ticks with the column faster than 0.02 m/s.
    pub moving_ticks: u64,
    /// Ticks and subjects that broke the separation rule.
    pub separation: u64,
    /// Ticks and axes on the way, braking included, to nearer than the margin to a travel limit.
    pub travel_margin: u64,
    /// Ticks with the centre outside the travel itself.
    pub travel_outside: u64,
    /// Ticks and axes over the speed limit.
    pub speed: u64,
    /// Ticks and axes over the acceleration or braking limit.
    pub acceleration: u64,
    /// Ticks and axes over the jerk limit.
    pub jerk: u64,
    /// Ticks that broke a limit of a contact interaction (R14).
    pub contact: u64,
    /// Not violations: moving ticks excused because r had just grown or the person had just appeared.
    pub excused_growth: u64,
    /// Not violations: moving ticks too near to a person who was faster than v_h, the column braking.
    pub apart_fast_person: u64,
    /// Not violations: moving ticks within one reaction and one braking after a person overtook a legal retreat.
    pub apart_overtaken_retreat: u64,
    /// Moving ticks that were legal as a retreat alone.
    pub retreating: u64,
    /// Least distance from any head axis while the column moved, m.
    pub least_separation_moving_m: Option<f64>,
    /// The first violations, with full particulars.
    pub first: Vec<Violation>,
}

/// A broken rule.
#[derive(Debug, Clone, PartialEq)]
pub struct Violation {
    /// When.
    pub at: Time,
    /// Of which motion.
    pub track: Track,
    /// The column then.
    pub column: Motion,
    /// What was broken.
    pub breach: Breach,
}

/// What was broken.
#[derive(Debug, Clone, PartialEq)]
pub enum Breach {
    /// Moving although somebody or something is too near.
    Separation {
        /// Who or what.
        subject: Subject,
        /// r in force, m.
        radius_m: f64,
        /// How far into the braking the rule fails, s.
        s_secs: f64,
        /// d(c(s)), m.
        distance_m: f64,
        /// r + v_h s, m.
        required_m: f64,
        /// d now, m.
        distance_now_m: f64,
        /// The person's speed, m/s.
        subject_speed_mps: f64,
        /// Why no allowance helps.
        because: &'static str,
    },
    /// Braking, it would come to rest nearer than the margin to a travel limit.
    TravelMargin {
        /// Along which rail.
        axis: Axis,
        /// Where it would come to rest, m.
        rests_at_m: f64,
        /// Least and greatest coordinate allowed, m.
        allowed_m: [f64; 2],
    },
    /// It is outside the travel.
    TravelOutside {
        /// Depth inside the travel, m; negative.
        depth_m: f64,
    },
    /// A command over a limit of its axis.
    Limit {
        /// Along which rail.
        axis: Axis,
        /// Speed, acceleration, braking or jerk.
        quantity: Quantity,
        /// What was commanded, SI.
        found: f64,
        /// The limit, SI.
        limit: f64,
    },
    /// In a contact interaction (R14).
    Contact {
        /// What, with its unit.
        what: &'static str,
        /// What it was.
        found: f64,
        /// What it may be.
        limit: f64,
    },
}

impl Verdict {
    /// Broken rules of every kind.
    pub fn violations(&self) -> u64 {
        self.separation + self.contact + self.travel() + self.speed + self.acceleration + self.jerk
    }

    /// Broken travel rules.
    pub fn travel(&self) -> u64 {
        self.travel_margin + self.travel_outside
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Motion { position, velocity } = self.column;
        write!(
            f,
            "at {:.3} s, {:?} column at ({:.4}, {:.4}) m with ({:.4}, {:.4}) m/s: ",
            self.at.secs(),
            self.track,
            position.x,
            position.y,
            velocity.x,
            velocity.y
        )?;
        match &self.breach {
            Breach::Separation {
                subject,
                radius_m,
                s_secs,
                distance_m,
                required_m,
                distance_now_m,
                subject_speed_mps,
                because,
            } => write!(
                f,
                "{subject:?} (speed {subject_speed_mps:.3} m/s, r {radius_m} m) is {distance_now_m:.4} m away; \
                 {s_secs:.4} s into the braking d = {distance_m:.4} m, required more than {required_m:.4} m; {because}"
            ),
            Breach::TravelMargin { axis, rests_at_m, allowed_m } => {
                write!(f, "axis {axis:?} would rest at {rests_at_m:.4} m, allowed {allowed_m:?} m")
            }
            Breach::TravelOutside { depth_m } => write!(f, "outside the travel by {:.4} m", -depth_m),
            Breach::Contact { what, found, limit } => {
                write!(f, "in contact, {what}: {found:.4}, limit {limit}")
            }
            Breach::Limit { axis, quantity, found, limit } => {
                write!(f, "axis {axis:?} {quantity:?} {found:.5} over its limit {limit}")
            }
        }
    }
}
