//! One motor channel of a board: what it was told, its ramp, its buffer, its velocity loop. From counts to duty, every
//! millisecond.
//!
//! What the manual says: speeds are ramped by the acceleration of the command; a command without one accelerates "as
//! fast as possible"; buffered commands follow one another; `QPPS` is the speed at 100 % duty. *Unverified*, for no
//! manual says it:
//!
//! - When a distance is covered and nothing is buffered, the channel ramps to rest by the acceleration of that command.
//! - An acceleration of 0 never reaches its speed.
//! - The position loop asks for the least of the command's speed, what its deceleration can still brake from, and P
//!   (in 1024ths, 1/s) times the error; I and D are kept and not used. With P = 0, as from the factory, nothing moves.

use std::collections::VecDeque;

use super::encoder::Encoder;
use super::settings::{PositionPid, VelocityPid};
use super::speed_loop::SpeedLoop;

/// One channel.
#[derive(Debug, Clone)]
pub(super) struct Channel {
    pub(super) encoder: Encoder,
    goal: Goal,
    running: Option<Running>,
    waiting: VecDeque<Stage>,
    /// The ramped speed, counts/s.
    asked_cps: f64,
    /// What is on the motor: 1 is 100 % forward. None with the bridge open.
    duty: Option<f64>,
    speed_loop: SpeedLoop,
    /// Off its place by this much, counts, while a position command runs.
    position_error: f64,
}

/// What the channel is after.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Goal {
    /// The bridge is open: the motor coasts.
    Open,
    /// This duty, no faster than so much a second.
    Duty { target: f64, slope: f64 },
    /// This speed, counts/s, no faster than so much a second.
    Speed { cps: f64, slope: f64 },
}

/// A buffered command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stage {
    /// So far at this speed.
    Distance { cps: f64, slope: f64, counts: f64 },
    /// To this value of the encoder's register, and hold it.
    Position { acceleration: f64, cps: f64, deceleration: f64, register: i32 },
}

#[derive(Debug, Clone, Copy)]
struct Running {
    stage: Stage,
    from_counts: i64,
    is_done: bool,
}

/// Which ways a switch keeps the motor from going.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Blocked {
    pub(super) forward: bool,
    pub(super) reverse: bool,
}

impl Channel {
    pub(super) fn new() -> Self {
        Self {
            encoder: Encoder::default(),
            goal: Goal::STOP,
            running: None,
            waiting: VecDeque::new(),
            asked_cps: 0.0,
            duty: Some(0.0),
            speed_loop: SpeedLoop::default(),
            position_error: 0.0,
        }
    }

    /// A command that is not buffered: it ends whatever runs or waits.
    pub(super) fn drive(&mut self, goal: Goal) {
        self.running = None;
        self.waiting.clear();
        self.pursue(goal);
    }

    /// A buffered command. False when the buffer is full.
    pub(super) fn buffer(&mut self, stage: Stage, replace: bool) -> bool {
        if replace {
            self.running = None;
            self.waiting.clear();
        }
        let may_begin = self.running.is_none_or(|running| running.is_done) && self.waiting.is_empty();
        if may_begin {
            self.begin(stage);
        } else if self.waiting.len() < BUFFER_LENGTH {
            self.waiting.push_back(stage);
        } else {
            return false;
        }
        true
    }

    /// A millisecond: from counts since power-on to the duty, none with the bridge open.
    pub(super) fn tick(
        &mut self,
        counts: i64,
        velocity: &VelocityPid,
        position: &PositionPid,
        blocked: Blocked,
    ) -> Option<f64> {
        let moved = self.speed_loop.measure(counts);
        self.encoder.tick(counts);
        self.follow_buffer(counts, position);
        let stops = |way: f64| (way > 0.0 && blocked.forward) || (way < 0.0 && blocked.reverse);
        let duty = match self.goal {
            Goal::Open => {
                self.asked_cps = moved;
                self.duty = None;
                return None;
            }
            Goal::Duty { target, slope } => {
                self.asked_cps = moved;
                let duty = towards(self.duty.unwrap_or(0.0), target, slope * TICK_SECS);
                if stops(duty) { 0.0 } else { duty }
            }
            Goal::Speed { cps, slope } => {
                self.asked_cps = towards(self.asked_cps, cps, slope * TICK_SECS);
                if stops(self.asked_cps) {
                    self.asked_cps = 0.0;
                    self.speed_loop.forget();
                }
                self.speed_loop.duty(self.asked_cps, velocity)
            }
        };
        self.duty = Some(duty);
        self.duty
    }

    /// How many commands wait; 0x80 when none runs or waits (manual, "47 - Read Buffer Length").
    pub(super) fn buffer_depth(&self) -> u8 {
        match self.running {
            Some(running) if !running.is_done => self.waiting.len() as u8,
            _ if self.waiting.is_empty() => BUFFER_IS_EMPTY,
            _ => self.waiting.len() as u8,
        }
    }

    /// What is on the motor: 1 is 100 % forward.
    pub(super) fn duty(&self) -> f64 {
        self.duty.unwrap_or(0.0)
    }

    /// Measured speed, counts/s.
    pub(super) const fn measured_cps(&self) -> f64 {
        self.speed_loop.measured_cps
    }

    /// How far its speed is off what the ramp asks, counts/s; none while no speed is asked.
    pub(super) const fn speed_error(&self) -> f64 {
        match self.goal {
            Goal::Speed { .. } => self.speed_loop.last_error,
            Goal::Open | Goal::Duty { .. } => 0.0,
        }
    }

    /// How far its position is off, counts; 0 while no position is asked.
    pub(super) const fn position_error(&self) -> f64 {
        self.position_error
    }

    fn pursue(&mut self, goal: Goal) {
        if !matches!(self.goal, Goal::Speed { .. }) {
            self.asked_cps = self.speed_loop.measured_cps;
            self.speed_loop.forget();
        }
        self.position_error = 0.0;
        self.goal = goal;
    }

    fn begin(&mut self, stage: Stage) {
        let from_counts = self.speed_loop.counts;
        self.running = Some(Running { stage, from_counts, is_done: false });
        if let Stage::Distance { cps, slope, .. } = stage {
            self.pursue(Goal::Speed { cps, slope });
        } else {
            self.pursue(Goal::Speed { cps: 0.0, slope: f64::INFINITY });
        }
    }

    fn follow_buffer(&mut self, counts: i64, position: &PositionPid) {
        let Some(running) = self.running else { return };
        let is_done = match running.stage {
            Stage::Distance { cps, counts: distance, .. } => {
                (counts - running.from_counts) as f64 * cps.signum() >= distance
            }
            Stage::Position { .. } => self.approach(counts, position, running.stage),
        };
        if !is_done {
            return;
        }
        if let Some(next) = self.waiting.pop_front() {
            self.begin(next);
        } else if let Stage::Distance { slope, .. } = running.stage {
            self.running = None;
            self.goal = Goal::Speed { cps: 0.0, slope };
        } else {
            // It goes on holding its place.
            self.running = Some(Running { is_done: true, ..running });
        }
    }

    /// Ask for the speed that leads to a position. True once it is there.
    fn approach(&mut self, counts: i64, pid: &PositionPid, stage: Stage) -> bool {
        let Stage::Position { acceleration, cps, deceleration, register } = stage else { return true };
        // Both at zero, as from the factory, limit nothing (unverified).
        let has_limits = pid.min < pid.max;
        let register = if has_limits { register.clamp(pid.min, pid.max) } else { register };
        let error = (self.encoder.counts_at(register) - counts) as f64;
        self.position_error = error;
        let is_near = error.abs() <= f64::from(pid.deadzone.max(1));
        let wanted = if is_near {
            0.0
        } else {
            let by_gain = f64::from(pid.p) / POSITION_GAIN_UNIT * error.abs();
            let by_braking = (2.0 * deceleration * error.abs()).sqrt();
            error.signum() * cps.abs().min(by_gain).min(by_braking)
        };
        let is_slowing = wanted.abs() < self.asked_cps.abs();
        let slope = if is_slowing { deceleration.max(acceleration) } else { acceleration };
        self.goal = Goal::Speed { cps: wanted, slope };
        is_near
    }
}

impl Goal {
    /// No duty: the windings are shorted, which brakes (*unverified*).
    pub(super) const STOP: Self = Self::Duty { target: 0.0, slope: f64::INFINITY };
}

fn towards(from: f64, to: f64, step: f64) -> f64 {
    if (to - from).abs() <= step { to } else { from + step.copysign(to - from) }
}

pub(super) const TICK_SECS: f64 = 1e-3;
const POSITION_GAIN_UNIT: f64 = 1_024.0;
/// Manual, "47 - Read Buffer Length": "The maximum buffer size per motor is 64 commands".
const BUFFER_LENGTH: usize = 64;
const BUFFER_IS_EMPTY: u8 = 0x80;

#[cfg(test)]
mod tests {
    use super::*;

    /// A motor without inertia or friction: 10 counts a millisecond at full duty.
    struct Motor {
        channel: Channel,
        place: f64,
        pid: VelocityPid,
        position: PositionPid,
        blocked: Blocked,
    }

    impl Motor {
        fn new() -> Self {
            Self {
                channel: Channel::new(),
                place: 0.0,
                pid: VelocityPid { p: 0, i: 0, d: 0, qpps: 10_000 },
                position: PositionPid { p: 10 * 1_024, deadzone: 2, ..PositionPid::default() },
                blocked: Blocked::default(),
            }
        }

        fn run(&mut self, millis: usize) -> f64 {
            for _ in 0..millis {
                let counts = self.place.floor() as i64;
                let duty = self.channel.tick(counts, &self.pid, &self.position, self.blocked);
                self.place += 10.0 * duty.unwrap_or(0.0);
            }
            self.place
        }
    }

    #[test]
    fn a_ramp_takes_the_time_of_its_acceleration() {
        let mut motor = Motor::new();
        motor.channel.drive(Goal::Speed { cps: 5_000.0, slope: 10_000.0 });
        motor.run(250);
        assert_eq!(motor.channel.duty(), 0.25);
        motor.run(250);
        assert_eq!(motor.channel.duty(), 0.5);
        motor.channel.drive(Goal::Speed { cps: -5_000.0, slope: f64::INFINITY });
        motor.run(1);
        assert_eq!(motor.channel.duty(), -0.5);
    }

    #[test]
    fn an_acceleration_of_nothing_gets_nowhere() {
        let mut motor = Motor::new();
        motor.channel.drive(Goal::Speed { cps: 5_000.0, slope: 0.0 });
        assert_eq!(motor.run(1_000), 0.0);
    }

    #[test]
    fn stages_follow_one_another_and_the_last_ends_at_rest() {
        let mut motor = Motor::new();
        let go = |cps| Stage::Distance { cps, slope: f64::INFINITY, counts: 1_000.0 };
        assert_eq!(motor.channel.buffer_depth(), 0x80);
        for cps in [1_000.0, 2_000.0, -1_000.0] {
            assert!(motor.channel.buffer(go(cps), false));
        }
        assert_eq!(motor.channel.buffer_depth(), 2);
        motor.run(1_100);
        assert_eq!((motor.channel.buffer_depth(), motor.channel.duty()), (1, 0.2));
        motor.run(1_000);
        assert_eq!((motor.channel.buffer_depth(), motor.channel.duty()), (0, -0.1));
        motor.run(1_000);
        assert_eq!((motor.channel.buffer_depth(), motor.channel.duty()), (0x80, 0.0));
        assert!((motor.place - 1_000.0).abs() < 10.0, "{}", motor.place);
    }

    #[test]
    fn a_distance_that_replaces_ends_what_runs_and_what_waits() {
        let mut motor = Motor::new();
        let go = |cps| Stage::Distance { cps, slope: 100_000.0, counts: 100.0 };
        assert!(motor.channel.buffer(go(1_000.0), false) && motor.channel.buffer(go(1_000.0), false));
        motor.run(5);
        assert!(motor.channel.buffer(go(-1_000.0), true));
        assert_eq!(motor.channel.buffer_depth(), 0);
        motor.run(1_000);
        assert!((motor.place + 100.0).abs() < 12.0, "{}", motor.place);
    }

    #[test]
    fn the_buffer_takes_64_and_no_more() {
        let mut motor = Motor::new();
        let stage = Stage::Distance { cps: 1.0, slope: 1.0, counts: 1e9 };
        for _ in 0..=64 {
            assert!(motor.channel.buffer(stage, false));
        }
        assert!(!motor.channel.buffer(stage, false));
        assert_eq!(motor.channel.buffer_depth(), 64);
    }

    #[test]
    fn a_position_is_reached_and_held_from_either_side() {
        for register in [3_000, -3_000] {
            let mut motor = Motor::new();
            let stage =
                Stage::Position { acceleration: 20_000.0, cps: 5_000.0, deceleration: 20_000.0, register };
            assert!(motor.channel.buffer(stage, false));
            motor.run(300);
            assert_eq!(motor.channel.duty().abs(), 0.5);
            motor.run(3_000);
            assert!((motor.place - f64::from(register)).abs() <= 3.0, "{}", motor.place);
            assert_eq!(motor.channel.buffer_depth(), 0x80);
            motor.place += 500.0;
            motor.run(2_000);
            assert!((motor.place - f64::from(register)).abs() <= 3.0, "{}", motor.place);
        }
    }

    #[test]
    fn a_position_without_gain_moves_nothing() {
        let mut motor = Motor::new();
        motor.position.p = 0;
        let stage = Stage::Position { acceleration: 1e4, cps: 5e3, deceleration: 1e4, register: 1_000 };
        assert!(motor.channel.buffer(stage, false));
        assert_eq!(motor.run(1_000), 0.0);
    }

    #[test]
    fn a_blocked_way_is_not_gone() {
        let mut motor = Motor::new();
        motor.blocked.reverse = true;
        for goal in [
            Goal::Speed { cps: -5_000.0, slope: f64::INFINITY },
            Goal::Duty { target: -0.5, slope: f64::INFINITY },
        ] {
            motor.channel.drive(goal);
            assert_eq!(motor.run(100), 0.0, "{goal:?}");
        }
        motor.channel.drive(Goal::Speed { cps: 5_000.0, slope: f64::INFINITY });
        assert!(motor.run(100) > 400.0);
    }
}
