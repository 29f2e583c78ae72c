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
    /// How its trajectory changes its speed since the last goal, signed, m/s2.
    changes_mps2: f64,
    /// Where it brakes to, or rests, m.
    rests_at_m: Option<f64>,
}

impl Aim {
    /// An axis that brakes at this limit, m/s2.
    pub const fn new(braking_mps2: f64) -> Self {
        Self { braking_mps2, changes_mps2: 0.0, rests_at_m: None }
    }

    /// It is let go: where it was to rest means nothing any more.
    pub const fn forget(&mut self) {
        self.rests_at_m = None;
        self.changes_mps2 = 0.0;
    }

    /// The next goal, `since_secs` after the look that the state is of.
    ///
    /// The trajectory is told to go on as the course does, for as long as the command is good: then a host that is late has nothing to
    /// catch up with.
    pub fn next(&mut self, wanted: &AxisSpeed, state: &AxisState, since_secs: f64) -> Goal {
        // The trajectory leads the column by little. Where it does not (something holds the column), it gets no further ahead: set free, the
        // column goes no further than this.
        let lead_m = (state.setpoint_m - state.here_m).clamp(-MOST_LEAD_M, MOST_LEAD_M);
        let since_secs = since_secs.clamp(0.0, MOST_AHEAD_SECS);
        let from_m = state.here_m + lead_m + state.setpoint_mps * since_secs;
        let brakes_over_m = |mps: f64| mps * mps.abs() / (2.0 * self.braking_mps2);
        if wanted.speed_mps == 0.0 {
            self.changes_mps2 = 0.0;
            let place = from_m + brakes_over_m(state.setpoint_mps);
            return Goal { at_m: *self.rests_at_m.get_or_insert(place), pace: None };
        }
        self.rests_at_m = None;
        let now_mps = state.setpoint_mps + self.changes_mps2 * since_secs;
        let good_secs = wanted.distance_m / wanted.speed_mps.abs();
        // As the course goes on, and what it is off its speed by.
        let most_mps2 = wanted.acceleration_mps2.max(LEAST_RAMP_MPS2);
        let mps2 = wanted.slope_mps2 + (wanted.speed_mps - now_mps) / REACHED_SECS;
        let mps2 = mps2.clamp(-most_mps2, most_mps2);
        let to_mps = Self::ends_at_mps(wanted, now_mps, mps2, good_secs);
        let ramp_mps2 = mps2.abs().max(LEAST_RAMP_MPS2);
        let reached_secs = ((to_mps - now_mps).abs() / ramp_mps2).min(good_secs);
        self.changes_mps2 = if to_mps == now_mps { 0.0 } else { ramp_mps2 * (to_mps - now_mps).signum() };
        let then_mps = now_mps + self.changes_mps2 * reached_secs;
        let good_m = 0.5 * (now_mps + then_mps) * reached_secs + then_mps * (good_secs - reached_secs);
        // A trajectory needs some speed to be one, and some way to go.
        let speed_mps = to_mps.abs().max(LEAST_MPS);
        let least_m = wanted.speed_mps.signum() * LEAST_MPS * good_secs;
        Goal {
            at_m: from_m + good_m + brakes_over_m(then_mps) + least_m,
            pace: Some(Pace { speed_mps, ramp_mps2 }),
        }
    }

    /// The speed in which such a change ends while the command is good: no further than the course leads, nor back the other way.
    fn ends_at_mps(wanted: &AxisSpeed, now_mps: f64, mps2: f64, good_secs: f64) -> f64 {
        let ahead_mps = wanted.speed_mps + wanted.slope_mps2 * good_secs;
        let least = now_mps.min(wanted.speed_mps).min(ahead_mps);
        let most = now_mps.max(wanted.speed_mps).max(ahead_mps);
        let to_mps = (now_mps + mps2 * good_secs).clamp(least, most);
        let turns_round = to_mps * wanted.speed_mps < 0.0 && now_mps * wanted.speed_mps >= 0.0;
        if turns_round { 0.0 } else { to_mps }
    }
}

/// How far the board's trajectory may lead the column, m.
const MOST_LEAD_M: f64 = 0.02;
/// A look that is older than this is carried on no further, s.
const MOST_AHEAD_SECS: f64 = 0.02;
/// In this time the trajectory takes up what the position loop adds, s.
const REACHED_SECS: f64 = 0.02;
/// Half a millimetre a second.
const LEAST_MPS: f64 = 5e-4;
/// A trajectory needs some ramp, m/s2.
const LEAST_RAMP_MPS2: f64 = 0.05;

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn wanted(speed_mps: f64, slope_mps2: f64) -> AxisSpeed {
        AxisSpeed { speed_mps, acceleration_mps2: 2.5, slope_mps2, distance_m: speed_mps.abs() * 0.05 }
    }

    fn moving(at_m: f64, mps: f64) -> AxisState {
        AxisState { here_m: at_m, setpoint_m: at_m, setpoint_mps: mps }
    }

    #[test]
    fn a_goal_is_the_cap_and_a_brake_ahead() {
        let goal = Aim::new(2.5).next(&wanted(1.0, 0.0), &moving(2.0, 1.0), 0.0);
        assert_eq!(goal.pace.map(|pace| pace.speed_mps), Some(1.0));
        assert!((goal.at_m - (2.0 + 0.05 + 0.2)).abs() < 1e-4, "{}", goal.at_m);
    }

    #[test]
    fn on_its_course_it_goes_on_as_the_course_does_for_as_long_as_the_command_is_good() {
        for (slope, way_m) in [
            (1.0, 0.5 * (1.0 + 1.05) * 0.05 + 1.05 * 1.05 / 5.0),
            (-2.0, 0.5 * (1.0 + 0.9) * 0.05 + 0.9 * 0.9 / 5.0),
        ] {
            let goal = Aim::new(2.5).next(&wanted(1.0, slope), &moving(0.0, 1.0), 0.0);
            assert_eq!(goal.pace, Some(Pace { speed_mps: 1.0 + slope * 0.05, ramp_mps2: slope.abs() }));
            assert!((goal.at_m - way_m).abs() < 1e-4, "{} {way_m}", goal.at_m);
        }
        let ends = Aim::new(2.5).next(&wanted(0.05, -2.5), &moving(0.0, 0.05), 0.0);
        assert_eq!(
            ends.pace,
            Some(Pace { speed_mps: LEAST_MPS, ramp_mps2: 2.5 }),
            "it ends, and does not turn round"
        );
    }

    #[test]
    fn a_brake_has_one_place_until_it_is_told_to_go_on() {
        let mut aim = Aim::new(2.5);
        let first = aim.next(&wanted(0.0, 0.0), &moving(2.0, -1.0), 0.0);
        assert_eq!(first, Goal { at_m: 2.0 - 0.2, pace: None });
        assert_eq!(aim.next(&wanted(0.0, 0.0), &moving(1.9, -0.7), 0.0), first);
        let on = aim.next(&wanted(-0.7, 0.0), &moving(1.9, -0.7), 0.0);
        assert!(on.at_m < 1.8 && on.pace.is_some_and(|pace| pace.speed_mps == 0.7), "{on:?}");
    }

    #[test]
    fn it_speeds_up_no_steeper_than_it_may() {
        let goal = Aim::new(2.5).next(&wanted(1.0, 1.25), &moving(0.0, 0.0), 0.0);
        assert_eq!(goal.pace.map(|pace| pace.ramp_mps2), Some(2.5));
        // At the end of the cap, of 50 ms, it has come to 0.125 m/s, from which it brakes.
        assert!((goal.at_m - (0.5 * 0.125 * 0.05 + 0.125 * 0.125 / 5.0)).abs() < 1e-4, "{}", goal.at_m);
    }

    proptest! {
        /// However far the trajectory has run ahead of a column that is held, and whatever the age of the look: no goal is further from
        /// the column than the cap, a brake, and the lead.
        #[test]
        fn no_goal_is_further_than_the_cap_and_a_brake(
            speed in -1.2_f64..1.2, slope in -2.5_f64..2.5, setpoint in -10.0_f64..10.0, mps in -1.2_f64..1.2,
            since in 0.0_f64..5.0,
        ) {
            let mut aim = Aim { changes_mps2: slope, ..Aim::new(2.5) };
            let state = AxisState { here_m: 0.0, setpoint_m: setpoint, setpoint_mps: mps };
            let goal = aim.next(&wanted(speed, slope), &state, since);
            // Speeding up goes on while the command is good, and did since the look.
            let most = (speed.abs() + 2.5 * 0.05).max(mps.abs() + 2.5 * MOST_AHEAD_SECS);
            let cap_m = most * 0.05 + most * most / 5.0;
            prop_assert!(goal.at_m.abs() <= cap_m + MOST_LEAD_M + most * MOST_AHEAD_SECS + 1e-4, "{}", goal.at_m);
        }
    }
}
