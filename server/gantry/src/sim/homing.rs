//! The homing sequence of one axis: onto the switch at creep speed, back off, again and slower, to rest inside.
//!
//! It never moves faster than the creep speed, and gives up when it does not move or finds no switch.

use super::axis::{AxisController, SpeedCourse, TICK_SECS};
use super::parameters::{HomingParameters, MachineParameters};

/// Where one axis is in the sequence.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct HomingAxis {
    phase: Phase,
    switch_m: Option<f64>,
    watched_m: f64,
    watched_ticks: u32,
    phase_start_m: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum Phase {
    /// Standing; the first step looks at the switch.
    #[default]
    Start,
    /// On the switch: off it.
    Clearing,
    /// Towards the switch at creep speed.
    Seeking,
    /// To rest on it.
    Braking,
    /// Off it again.
    BackingOff,
    /// To rest off it.
    Turning,
    /// Back onto it, slowly: this is what counts.
    Approaching,
    /// To rest on it.
    Measured,
    /// To the place of rest.
    Leaving,
    /// Coming to rest there.
    Resting,
}

/// Speeds and distances of the sequence.
#[derive(Debug, Clone, Copy)]
pub(super) struct HomingPlan {
    parameters: HomingParameters,
    longest_seek_m: f64,
}

/// What the axis is to do in this tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum HomingStep {
    Move(SpeedCourse),
    Brake,
    Rest { at_m: f64 },
    Done,
    Failed,
}

impl HomingPlan {
    pub(super) fn new(machine: &MachineParameters, span_m: f64) -> Self {
        Self { parameters: machine.homing, longest_seek_m: span_m + 2.0 * machine.stop_outside_m + SPARE_M }
    }
}

impl HomingAxis {
    pub(super) fn step(&mut self, plan: &HomingPlan, axis: &AxisController, on_switch: bool) -> HomingStep {
        let here_m = axis.measured_m();
        let p = &plan.parameters;
        match self.phase {
            Phase::Start => self.enter(if on_switch { Phase::Clearing } else { Phase::Seeking }, here_m),
            Phase::Clearing if on_switch => self.phase_start_m = here_m,
            Phase::Clearing if here_m - self.phase_start_m > CLEAR_M => self.enter(Phase::Seeking, here_m),
            Phase::Seeking if on_switch => self.enter(Phase::Braking, here_m),
            Phase::Seeking if self.phase_start_m - here_m > plan.longest_seek_m => return HomingStep::Failed,
            Phase::Braking if axis.is_at_rest() => self.enter(Phase::BackingOff, here_m),
            Phase::BackingOff if on_switch => self.phase_start_m = here_m,
            Phase::BackingOff if here_m - self.phase_start_m > CLEAR_M => self.enter(Phase::Turning, here_m),
            Phase::Turning if axis.is_at_rest() => self.enter(Phase::Approaching, here_m),
            Phase::Approaching if on_switch => {
                self.switch_m = Some(here_m);
                self.enter(Phase::Measured, here_m);
            }
            Phase::Measured if axis.is_at_rest() => self.enter(Phase::Leaving, here_m),
            _ => {}
        }
        let creep = |speed_mps| HomingStep::Move(course(speed_mps));
        let step = match self.phase {
            Phase::Clearing | Phase::BackingOff => creep(p.creep_mps),
            Phase::Start | Phase::Seeking => creep(-p.creep_mps),
            Phase::Approaching => creep(-p.approach_mps),
            Phase::Braking | Phase::Turning | Phase::Measured => HomingStep::Brake,
            Phase::Leaving => self.leave(plan, here_m),
            Phase::Resting if axis.is_at_rest() => HomingStep::Done,
            Phase::Resting => HomingStep::Rest { at_m: self.rest_m(plan) },
        };
        if self.is_stuck(here_m, step) { HomingStep::Failed } else { step }
    }

    /// Where the switch tripped on the measuring approach, m since power-on.
    pub(super) const fn switch_m(&self) -> Option<f64> {
        self.switch_m
    }

    fn enter(&mut self, phase: Phase, here_m: f64) {
        self.phase = phase;
        self.phase_start_m = here_m;
        self.watched_m = here_m;
        self.watched_ticks = 0;
    }

    fn rest_m(&self, plan: &HomingPlan) -> f64 {
        let p = &plan.parameters;
        self.switch_m.unwrap_or(self.phase_start_m) + p.switch_outside_m + p.rest_inside_m
    }

    fn leave(&mut self, plan: &HomingPlan, here_m: f64) -> HomingStep {
        let left_m = self.rest_m(plan) - here_m;
        if left_m < NEAR_M {
            self.enter(Phase::Resting, here_m);
            return HomingStep::Rest { at_m: self.rest_m(plan) };
        }
        let speed = plan.parameters.creep_mps.min((RAMP_MPS2 * left_m).sqrt());
        HomingStep::Move(course(speed))
    }

    /// Told to move, and has not for a while.
    fn is_stuck(&mut self, here_m: f64, step: HomingStep) -> bool {
        let HomingStep::Move(_) = step else { return false };
        if (here_m - self.watched_m).abs() > PROGRESS_M {
            self.watched_m = here_m;
            self.watched_ticks = 0;
        }
        self.watched_ticks += 1;
        f64::from(self.watched_ticks) * TICK_SECS > STUCK_SECS
    }
}

fn course(speed_mps: f64) -> SpeedCourse {
    SpeedCourse { target_mps: speed_mps, slope_mps2: 0.0, most_mps2: RAMP_MPS2 }
}

/// Ramps are gentle, and short enough to come to rest on the switch before the spring stops.
const RAMP_MPS2: f64 = 1.0;
/// How far off the switch it goes before it turns, m.
const CLEAR_M: f64 = 0.01;
/// From here the position loop takes the axis to its place of rest, m.
const NEAR_M: f64 = 0.001;
/// Less than this in [`STUCK_SECS`] is no motion, m.
const PROGRESS_M: f64 = 0.002;
const STUCK_SECS: f64 = 0.6;
/// Beyond the whole travel and its stops, m.
const SPARE_M: f64 = 0.1;
