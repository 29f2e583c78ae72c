//! The numbers of the safety rules, in one place, each with the rule that it belongs to.

use crate::machine::Limits;
use crate::time::Span;

/// The parameters of R1 to R16. Defaults are those of the safety design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameters {
    /// R1: the column's centre, braking included, stays this far inside the travel, m.
    pub travel_margin_m: f64,
    /// R2: greatest age of a pose, on the server's clock.
    pub pose_age: Span,
    /// R3: a walking person's greatest speed, m/s (ISO 13855, ISO 10218-2).
    pub v_h_mps: f64,
    /// R3: a body of 0.25 m and a margin, m.
    pub radius_m: f64,
    /// R3: near an enabled object, at creeping speed alone, m.
    pub near_radius_m: f64,
    /// R3: greatest speed with the near radius, m/s.
    pub near_speed_mps: f64,
    /// R3: a head nearer than this to an enabled object is near, m; half of the hysteresis.
    pub near_enter_m: f64,
    /// R3: it is near until it is farther than this, m.
    pub near_leave_m: f64,
    /// R3: a person who crawls or sits, m.
    pub low_radius_m: f64,
    /// R3: a head below this is low, m.
    pub low_head_m: f64,
    /// R3: a head goes down no faster than this, m/s: a quick crouch, with a margin.
    pub stoop_mps: f64,
    /// R3: from a decision to its effect on the machine, T_r.
    pub reaction: Span,
    /// R3: greatest speed of a retreat, m/s; the rule's 0.3 less what a machine may overshoot.
    pub retreat_speed_mps: f64,
    /// R3: half the cone of a retreat about "directly away", rad. Braking per axis turns the velocity by up to 45
    /// degrees while it dies, and the rule's cone is 60 degrees.
    pub retreat_cone_rad: f64,
    /// R3: what the commanded path keeps beyond the rule, for the following error of a healthy machine, m.
    pub following_allowance_m: f64,
    /// R6: farther than this from the command the column is held until it rests, m: half of the allowance, as it comes
    /// to rest farther on.
    pub astray_m: f64,
    /// R6: but it may come along behind the command by this long.
    pub astray_lag: Span,
    /// R6: and so it is when its velocity differs by more than this, m/s.
    pub astray_mps: f64,
    /// R6: so often within [`Self::astray_within`] is a breach.
    pub astray_times: u32,
    /// R6: see [`Self::astray_times`].
    pub astray_within: Span,
    /// R5: greatest motor current, A.
    pub current_amps: f64,
    /// R5: for so long.
    pub current_for: Span,
    /// R6: greatest following error, m.
    pub following_error_m: f64,
    /// R6: for so long.
    pub following_error_for: Span,
    /// R7: greatest difference between commanded and measured velocity, m/s.
    pub velocity_error_mps: f64,
    /// R7: for so long.
    pub velocity_error_for: Span,
    /// R7: faster than this no head moves, m/s.
    pub head_speed_mps: f64,
    /// R8: the controller's last good answer is not older.
    pub link: Span,
    /// R9: so many missed deadlines in a row.
    pub missed_deadlines: u32,
    /// A protective stop clears when its cause has been gone for so long.
    pub clears_after: Span,
    /// R16 and homing: creep speed, m/s.
    pub creep_speed_mps: f64,
    /// A jog with people in the arena, m/s: reduced speed, 250 mm/s (ISO 10218-1, manual control), less what a turn adds while
    /// one axis still slows and the other goes already.
    pub reduced_speed_mps: f64,
    /// R14: lead and transport, m/s.
    pub contact_speed_mps: f64,
    /// R14: brush, m/s.
    pub brush_speed_mps: f64,
    /// R14: how hard the column may pull at somebody's hand, and come up to a face, m/s2.
    pub contact_acceleration_mps2: f64,
    /// R14: see [`Self::contact_acceleration_mps2`], m/s3.
    pub contact_jerk_mps3: f64,
    /// R14: a rider is not to be thrown, m/s2: under what standing passengers of trains bear (0.9 to 1.5; Hoberock 1976).
    pub ride_acceleration_mps2: f64,
    /// R14: and for jerk, m/s3 (0.6 to 2 there).
    pub ride_jerk_mps3: f64,
    /// R14: from the head to everything of the column but the prop in contact, m.
    pub contact_radius_m: f64,
    /// R14: farther than this from the seat nobody sits on it, m.
    pub aboard_m: f64,
    /// R14: a pose in contact is not older.
    pub contact_pose_age: Span,
    /// R14: an arming of contact lasts no longer.
    pub longest_contact: Span,
    /// Hold-to-run: an order to jog that is not given again for so long is over.
    pub hold_to_run: Span,
}

impl Parameters {
    /// The defaults of the safety design with this v_h.
    pub fn new(v_h_mps: f64) -> Self {
        Self {
            travel_margin_m: 0.02,
            pose_age: Span::from_millis(500),
            v_h_mps,
            radius_m: 0.35,
            near_radius_m: 0.25,
            near_speed_mps: 0.25,
            near_enter_m: 0.75,
            near_leave_m: 0.85,
            low_radius_m: 1.0,
            low_head_m: 1.0,
            stoop_mps: 1.8,
            reaction: Span::from_millis(50),
            retreat_speed_mps: 0.25,
            retreat_cone_rad: 12.0_f64.to_radians(),
            following_allowance_m: 0.012,
            astray_m: 0.006,
            astray_lag: Span::from_millis(20),
            astray_mps: 0.1,
            astray_times: 3,
            astray_within: Span::from_millis(2_000),
            current_amps: 5.0,
            current_for: Span::from_millis(20),
            following_error_m: 0.05,
            following_error_for: Span::from_millis(100),
            velocity_error_mps: 0.35,
            velocity_error_for: Span::from_millis(100),
            head_speed_mps: 6.0,
            link: Span::from_millis(100),
            missed_deadlines: 3,
            clears_after: Span::from_millis(1000),
            creep_speed_mps: 0.1,
            reduced_speed_mps: 0.24,
            contact_speed_mps: 0.6,
            brush_speed_mps: 0.3,
            contact_acceleration_mps2: 0.5,
            contact_jerk_mps3: 5.0,
            ride_acceleration_mps2: 0.4,
            ride_jerk_mps3: 1.0,
            contact_radius_m: 0.35,
            aboard_m: 0.6,
            contact_pose_age: Span::from_millis(200),
            longest_contact: Span::from_millis(300_000),
            hold_to_run: Span::from_millis(300),
        }
    }

    /// R3: how long a machine goes on by one setpoint, from when it was vetted. When the link dies in the moment in which
    /// somebody appears, the speed still rises for a period that nobody commands, for this long, and until the acceleration is
    /// ramped out; together one reaction. A machine that ramps slowly has five periods all the same, which a busy link needs.
    pub fn setpoint_valid(&self, limits: &Limits, period: Span) -> Span {
        let ramp_secs = [limits.x, limits.y].map(|axis| axis.acceleration_mps2 / axis.jerk_mps3);
        let ramp = Span::from_secs(ramp_secs[0].max(ramp_secs[1]));
        let five_periods = Span::from_micros(5 * period.micros());
        (self.reaction - ramp - period).max(five_periods).min(self.reaction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::AxisLimits;
    use proptest::prelude::*;

    proptest! {
        /// What nobody commands any more speeds up for one reaction at most, wherever the ramp leaves room for that.
        #[test]
        fn a_machine_that_hears_no_more_speeds_up_for_a_reaction_at_most(
            (ax, ay) in (0.1..3.0f64, 0.1..3.0f64),
            (jx, jy) in (5.0..500.0f64, 5.0..500.0f64),
            period_millis in 1..20i64,
        ) {
            let axis = |acceleration_mps2, jerk_mps3| AxisLimits { acceleration_mps2, jerk_mps3, ..AxisLimits::PAPER };
            let limits = Limits { x: axis(ax, jx), y: axis(ay, jy) };
            let (parameters, period) = (Parameters::new(1.6), Span::from_millis(period_millis));
            let valid = parameters.setpoint_valid(&limits, period);
            prop_assert!(valid >= period && valid <= parameters.reaction);
            let speeds_up_secs = (period + valid).secs() + (ax / jx).max(ay / jy);
            let busy = valid == Span::from_millis(5 * period_millis) || valid == parameters.reaction;
            prop_assert!(busy || speeds_up_secs <= parameters.reaction.secs() + 1e-6, "{} s", speeds_up_secs);
        }
    }

    #[test]
    fn by_the_papers_limits_a_setpoint_is_good_for_30_ms() {
        let valid = Parameters::new(1.6).setpoint_valid(&Limits::PAPER, Span::from_millis(4));
        assert_eq!(valid.micros() / 1_000, 30);
    }
}
