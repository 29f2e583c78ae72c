//! The homing sequence of one axis: onto the switch at creep speed, back off, again and slower, to rest inside.
//!
//! It never moves faster than the creep speed, and gives up when it does not move or finds no switch. Every machine
//! here homes by it; where there is no switch, a machine says of the hard stop that it is one.

/// Where one axis is in the sequence.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct HomingAxis {
    phase: Phase,
    /// Where it tripped on the first approach, and on the measuring one, m since power-on.
    first_m: Option<f64>,
    switch_m: Option<f64>,
    watched_m: f64,
    watched_secs: f64,
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
pub(crate) struct HomingPlan {
    parameters: HomingParameters,
    longest_seek_m: f64,
}

/// How homing moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HomingParameters {
    /// Towards the switch, and back into the room, m/s.
    pub creep_mps: f64,
    /// The last, measuring approach, m/s.
    pub approach_mps: f64,
    /// How far outside the travel's low end the switches trip, m.
    pub switch_outside_m: f64,
    /// How far inside the travel's corner it comes to rest once homed, m (outside the 2 cm of R1).
    pub rest_inside_m: f64,
}

/// What homing looks for at the low end of each rail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HomeBy {
    /// Switches.
    Switches,
    /// The hard stops.
    Stops,
}

/// What the axis says of itself at one step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen {
    /// Its place since power-on, m.
    pub here_m: f64,
    /// It neither moves nor is told to.
    pub at_rest: bool,
    /// It is on the switch, or against the hard stop that stands for one.
    pub on_switch: bool,
    /// Since the last step, s.
    pub since_last_secs: f64,
}

/// What the axis is to do until the next step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum HomingStep {
    /// Go at this speed, m/s, along a ramp of [`RAMP_MPS2`].
    Move(f64),
    Brake,
    Rest {
        at_m: f64,
    },
    Done,
    Failed,
}

impl HomingPlan {
    /// For an axis that can move over this length, stops included, m.
    pub(crate) fn new(parameters: HomingParameters, length_m: f64) -> Self {
        Self { parameters, longest_seek_m: length_m + SPARE_M }
    }
}

impl HomingAxis {
    pub(crate) fn step(&mut self, plan: &HomingPlan, seen: Seen) -> HomingStep {
        let Seen { here_m, at_rest, on_switch, since_last_secs } = seen;
        let p = &plan.parameters;
        match self.phase {
            Phase::Start => self.enter(if on_switch { Phase::Clearing } else { Phase::Seeking }, here_m),
            Phase::Clearing if on_switch => self.phase_start_m = here_m,
            Phase::Clearing if here_m - self.phase_start_m > CLEAR_M => self.enter(Phase::Seeking, here_m),
            Phase::Seeking if on_switch => {
                self.first_m = Some(here_m);
                self.enter(Phase::Braking, here_m);
            }
            Phase::Seeking if self.phase_start_m - here_m > plan.longest_seek_m => return HomingStep::Failed,
            Phase::Braking if at_rest => self.enter(Phase::BackingOff, here_m),
            Phase::BackingOff if on_switch => self.phase_start_m = here_m,
            Phase::BackingOff if here_m - self.phase_start_m > CLEAR_M => self.enter(Phase::Turning, here_m),
            Phase::Turning if at_rest => self.enter(Phase::Approaching, here_m),
            Phase::Approaching if on_switch => {
                self.switch_m = Some(here_m);
                self.enter(Phase::Measured, here_m);
            }
            Phase::Measured if at_rest => self.enter(Phase::Leaving, here_m),
            _ => {}
        }
        let step = match self.phase {
            Phase::Clearing | Phase::BackingOff => HomingStep::Move(p.creep_mps),
            Phase::Start | Phase::Seeking => HomingStep::Move(-p.creep_mps),
            Phase::Approaching => HomingStep::Move(-p.approach_mps),
            Phase::Braking | Phase::Turning | Phase::Measured => HomingStep::Brake,
            Phase::Leaving => self.leave(plan, here_m),
            Phase::Resting if at_rest => HomingStep::Done,
            Phase::Resting => HomingStep::Rest { at_m: self.rest_m(plan) },
        };
        if self.is_stuck(here_m, since_last_secs, step) { HomingStep::Failed } else { step }
    }

    /// Where the switch tripped on the measuring approach, m since power-on.
    pub(crate) const fn switch_m(&self) -> Option<f64> {
        self.switch_m
    }

    /// Where the measuring approach found the switch, less where the first one did, m.
    pub(crate) fn repeatability_m(&self) -> Option<f64> {
        Some(self.switch_m? - self.first_m?)
    }

    /// Of both axes, m.
    pub(crate) fn both_repeatabilities_m(sequences: &[Self; 2]) -> Option<[f64; 2]> {
        Some([sequences[0].repeatability_m()?, sequences[1].repeatability_m()?])
    }

    fn enter(&mut self, phase: Phase, here_m: f64) {
        self.phase = phase;
        self.phase_start_m = here_m;
        self.watched_m = here_m;
        self.watched_secs = 0.0;
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
        HomingStep::Move(speed)
    }

    /// Told to move, and has not for a while.
    fn is_stuck(&mut self, here_m: f64, since_last_secs: f64, step: HomingStep) -> bool {
        let HomingStep::Move(_) = step else { return false };
        if (here_m - self.watched_m).abs() > PROGRESS_M {
            self.watched_m = here_m;
            self.watched_secs = 0.0;
        }
        self.watched_secs += since_last_secs;
        self.watched_secs > STUCK_SECS
    }
}

/// Ramps are gentle, and short enough to come to rest on the switch before the spring stops.
pub(crate) const RAMP_MPS2: f64 = 1.0;
/// How far off the switch it goes before it turns, m.
const CLEAR_M: f64 = 0.01;
/// From here the position loop takes the axis to its place of rest, m.
const NEAR_M: f64 = 0.001;
/// Less than this in [`STUCK_SECS`] is no motion, m.
const PROGRESS_M: f64 = 0.002;
const STUCK_SECS: f64 = 0.6;
/// Beyond the whole travel and its stops, m.
const SPARE_M: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;

    /// Home an axis that moves as told, with a switch that trips at the first of these places on the first approach and at the second
    /// afterwards, m.
    fn homed(switch_m: [f64; 2]) -> HomingAxis {
        let parameters = HomingParameters {
            creep_mps: 0.1,
            approach_mps: 0.02,
            switch_outside_m: 0.01,
            rest_inside_m: 0.05,
        };
        let plan = HomingPlan::new(parameters, 4.0);
        let (mut axis, mut here_m, mut speed_mps) = (HomingAxis::default(), 0.0, 0.0);
        let mut trips_at_m = switch_m[0];
        for _ in 0..1_000_000 {
            let on_switch = here_m <= trips_at_m;
            let seen = Seen { here_m, at_rest: speed_mps == 0.0, on_switch, since_last_secs: 1e-4 };
            speed_mps = match axis.step(&plan, seen) {
                HomingStep::Move(mps) => mps,
                HomingStep::Brake | HomingStep::Rest { .. } => 0.0,
                HomingStep::Done => return axis,
                HomingStep::Failed => panic!("it failed at {here_m} m"),
            };
            if speed_mps > 0.0 {
                trips_at_m = switch_m[1];
            }
            here_m += speed_mps * 1e-4;
        }
        panic!("it never ends");
    }

    #[test]
    fn it_repeats_as_well_as_its_switch_does() {
        // A step of the fast approach is 10 micrometres, one of the slow approach 2.
        for off_m in [0.0, 0.0007, -0.0012] {
            let found_m = homed([-0.2, -0.2 + off_m]).repeatability_m().unwrap();
            assert!((found_m - off_m).abs() < 15e-6, "{found_m} for {off_m}");
        }
        assert_eq!(HomingAxis::default().repeatability_m(), None);
    }
}
