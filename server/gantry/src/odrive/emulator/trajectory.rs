//! The trapezoidal trajectory: to a place at a greatest speed, speeding up and slowing at limits, from whatever it does now.
//!
//! The limits are those that hold when it begins. Above the greatest speed it slows at the limit of speeding up (as the board does).

/// One trajectory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trajectory {
    /// Where it ends, turns.
    pub goal: f64,
    /// turns/s.
    pub greatest_speed: f64,
    /// turns/s2.
    pub speeding_up: f64,
    /// turns/s2.
    pub slowing: f64,
}

impl Trajectory {
    /// Place and speed a moment later, and whether it is through.
    pub fn step(&self, place: f64, speed: f64, secs: f64) -> (f64, f64, bool) {
        let left = self.goal - place;
        let stops_over = speed * speed / (2.0 * self.slowing);
        let is_last_step =
            left.abs() <= 0.5 * self.slowing * secs * secs && speed.abs() <= self.slowing * secs;
        if is_last_step {
            return (self.goal, 0.0, true);
        }
        let way = left.signum();
        let goes_there = speed * way >= 0.0;
        let new_speed = if !goes_there || stops_over >= left.abs() - speed.abs() * secs {
            // To rest: the goal is behind, or it is time to brake. No faster than what still ends at the goal.
            let most = (2.0 * self.slowing * left.abs()).sqrt();
            let slower = speed - speed.signum() * (self.slowing * secs).min(speed.abs());
            if goes_there && slower == 0.0 { way * most.min(self.slowing * secs) } else { slower }
        } else if speed.abs() > self.greatest_speed {
            way * (speed.abs() - self.speeding_up * secs).max(self.greatest_speed)
        } else {
            let most = self.greatest_speed.min((2.0 * self.slowing * left.abs()).sqrt());
            way * (speed.abs() + self.speeding_up * secs).min(most)
        };
        let moved = 0.5 * (speed + new_speed) * secs;
        if goes_there && moved.abs() >= left.abs() {
            return (self.goal, 0.0, true);
        }
        (place + moved, new_speed, false)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const MILLI: f64 = 1e-3;

    proptest! {
        #[test]
        fn from_anything_it_ends_at_its_goal_within_its_limits(
            goal in -50.0_f64..50.0, speed in -40.0_f64..40.0, greatest in 0.1_f64..40.0, limit in 20.0_f64..200.0,
        ) {
            let trajectory = Trajectory { goal, greatest_speed: greatest, speeding_up: limit, slowing: limit };
            let (mut place, mut now, mut steps) = (0.0_f64, speed, 0);
            let mut farthest = 0.0_f64;
            loop {
                let (next, next_speed, is_through) = trajectory.step(place, now, MILLI);
                if is_through {
                    prop_assert_eq!((next, next_speed), (goal, 0.0));
                    break;
                }
                prop_assert!((next_speed - now).abs() <= 2.0 * limit * MILLI + 1e-9, "{now} {next_speed}");
                prop_assert!(next_speed.abs() <= greatest.max(speed.abs()) + 1e-9);
                (place, now) = (next, next_speed);
                farthest = farthest.max(place.abs());
                steps += 1;
                prop_assert!(steps < 1_200_000, "at {place}, {now}");
            }
            prop_assert!(farthest <= goal.abs() + speed * speed / (2.0 * limit) + 0.1, "{farthest}");
        }
    }
}
