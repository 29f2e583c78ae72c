//! From a speed and its distance cap to a place ahead at which the board rests by itself.
//!
//! A board that loses its host in speed control goes on at that speed until its watchdog lets the motor go, and the column coasts from
//! there: metres. So it is never in speed control. Each command is a goal of its trapezoidal trajectory: the place where the column comes to rest
//! when the cap is through and it brakes at the limit, at most as fast as told. Told nothing more, the board goes there, brakes, and
//! holds. The watchdog is for what is left: a motor held for ever that nobody speaks to.

use crate::linked::follow::AxisSpeed;

/// What the board says of one axis, m and m/s in its own count.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisState {
    /// Where the encoder is.
    pub here_m: f64,
    /// Where its trajectory is.
    pub setpoint_m: f64,
    /// How fast its trajectory goes.
    pub setpoint_mps: f64,
}

/// What the board is told for one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Where it comes to rest unless told otherwise, m.
    pub at_m: f64,
    /// How it goes there; none: as before. A brake needs no other.
    pub pace: Option<Pace>,
}

/// How fast a trajectory goes and gets there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// Its greatest speed, m/s.
    pub speed_mps: f64,
    /// How steeply it changes to that, m/s2. As steep as a brake, speeding up would take more current than R5 allows.
    pub ramp_mps2: f64,
}

/// The goals of one axis, one after the other.
#[derive(Debug, Clone, Copy)]
pub struct Aim {
    braking_mps2: f64,
    /// What it was last told, m/s.
    told_mps: f64,
    /// Where it brakes to, or rests, m.
    rests_at_m: Option<f64>,
}

impl Aim {
    /// An axis that brakes at this limit, m/s2.
    pub const fn new(braking_mps2: f64) -> Self {
        Self { braking_mps2, told_mps: 0.0, rests_at_m: None }
    }

    /// It is let go: where it was to rest means nothing any more.
    pub const fn forget(&mut self) {
        self.rests_at_m = None;
        self.told_mps = 0.0;
    }

    /// The next goal, `since_secs` after the look that the state is of and `period_secs` after the last goal.
    pub fn next(&mut self, wanted: &AxisSpeed, state: &AxisState, since_secs: f64, period_secs: f64) -> Goal {
        // The trajectory leads the column by little. Where it does not (something holds the column), it gets no further ahead: set free, the
        // column goes no further than this.
        let lead_m = (state.setpoint_m - state.here_m).clamp(-MOST_LEAD_M, MOST_LEAD_M);
        let from_m = state.here_m + lead_m + state.setpoint_mps * since_secs.clamp(0.0, MOST_AHEAD_SECS);
        let brakes_over_m = |mps: f64| mps * mps.abs() / (2.0 * self.braking_mps2);
        if wanted.speed_mps == 0.0 {
            self.told_mps = 0.0;
            let place = from_m + brakes_over_m(state.setpoint_mps);
            return Goal { at_m: *self.rests_at_m.get_or_insert(place), pace: None };
        }
        if self.rests_at_m.take().is_some() {
            self.told_mps = state.setpoint_mps;
        }
        let step_mps = wanted.acceleration_mps2 * period_secs;
        let told_mps = self.told_mps + (wanted.speed_mps - self.told_mps).clamp(-step_mps, step_mps);
        self.told_mps = told_mps;
        let cap_secs = wanted.distance_m / wanted.speed_mps.abs();
        // A trajectory needs some speed to be one.
        let speed_mps = told_mps.abs().max(LEAST_MPS);
        let way = if told_mps == 0.0 { wanted.speed_mps.signum() } else { told_mps.signum() };
        let at_m = from_m + way * (speed_mps * cap_secs + brakes_over_m(speed_mps));
        Goal { at_m, pace: Some(Pace { speed_mps, ramp_mps2: wanted.acceleration_mps2 }) }
    }
}

/// How far the board's trajectory may lead the column, m.
const MOST_LEAD_M: f64 = 0.02;
/// A look that is older than this is carried on no further, s.
const MOST_AHEAD_SECS: f64 = 0.02;
/// Half a millimetre a second.
const LEAST_MPS: f64 = 5e-4;

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn wanted(speed_mps: f64) -> AxisSpeed {
        AxisSpeed { speed_mps, acceleration_mps2: 2.5, distance_m: speed_mps.abs() * 0.05 }
    }

    fn moving(at_m: f64, mps: f64) -> AxisState {
        AxisState { here_m: at_m, setpoint_m: at_m, setpoint_mps: mps }
    }

    #[test]
    fn a_goal_is_the_cap_and_a_brake_ahead() {
        let mut aim = Aim { told_mps: 1.0, ..Aim::new(2.5) };
        let goal = aim.next(&wanted(1.0), &moving(2.0, 1.0), 0.0, 0.008);
        assert_eq!(goal.pace, Some(Pace { speed_mps: 1.0, ramp_mps2: 2.5 }));
        assert!((goal.at_m - (2.0 + 0.05 + 0.2)).abs() < 1e-9, "{}", goal.at_m);
    }

    #[test]
    fn a_brake_has_one_place_until_it_is_told_to_go_on() {
        let mut aim = Aim { told_mps: 1.0, ..Aim::new(2.5) };
        let first = aim.next(&wanted(0.0), &moving(2.0, -1.0), 0.0, 0.008);
        assert_eq!(first, Goal { at_m: 2.0 - 0.2, pace: None });
        assert_eq!(aim.next(&wanted(0.0), &moving(1.9, -0.7), 0.0, 0.008), first);
        let on = aim.next(&wanted(-0.7), &moving(1.9, -0.7), 0.0, 0.008);
        assert!(on.at_m < 1.8 && on.pace.is_some_and(|pace| pace.speed_mps == 0.7), "{on:?}");
    }

    #[test]
    fn speed_rises_no_faster_than_its_ramp() {
        let mut aim = Aim::new(2.5);
        let goal = aim.next(&wanted(1.0), &moving(0.0, 0.0), 0.0, 0.008);
        assert_eq!(goal.pace.map(|pace| pace.speed_mps), Some(0.02));
    }

    proptest! {
        /// However far the trajectory has run ahead of a column that is held, and whatever the age of the look: no goal is further from
        /// the column than the cap, a brake, and the lead.
        #[test]
        fn no_goal_is_further_than_the_cap_and_a_brake(
            speed in -1.2_f64..1.2, setpoint in -10.0_f64..10.0, mps in -1.2_f64..1.2, since in 0.0_f64..5.0,
        ) {
            let mut aim = Aim { told_mps: mps, ..Aim::new(2.5) };
            let state = AxisState { here_m: 0.0, setpoint_m: setpoint, setpoint_mps: mps };
            let goal = aim.next(&wanted(speed), &state, since, 0.008);
            let most = speed.abs().max(mps.abs());
            let cap_m = most * 0.05 + most * most / 5.0;
            prop_assert!(goal.at_m.abs() <= cap_m + MOST_LEAD_M + most * MOST_AHEAD_SECS + 1e-4, "{}", goal.at_m);
        }
    }
}
