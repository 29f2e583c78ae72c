//! One axis of a board: its state, its watchdog, its errors, its trajectory and loops; a millisecond at a time, where a board has an
//! eighth of one.
//!
//! From the maker's documents (firmware 0.5): "Control", "Trajectory", the reference of `Axis`, `Controller`, `Encoder`. *Chosen* where
//! those say nothing: the bandwidth of the encoder's filter (the board's is 1000 rad/s, which steps of a millisecond cannot follow).

use crate::sim::parameters::{AxisParameters, MachineParameters};

use super::trajectory::Trajectory;

/// What an axis is told to be, and is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// 1: no torque.
    Idle,
    /// 8: the loops are closed.
    ClosedLoop,
}

/// What is kept when it is saved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisConfig {
    pub control_mode: i32,
    pub input_mode: i32,
    pub pos_gain: f32,
    pub vel_gain: f32,
    pub vel_integrator_gain: f32,
    pub inertia: f32,
    pub vel_limit: f32,
    pub vel_limit_tolerance: f32,
    pub enable_vel_limit: bool,
    pub enable_overspeed_error: bool,
    pub circular_setpoints: bool,
    pub trajectory_vel_limit: f32,
    pub accel_limit: f32,
    pub decel_limit: f32,
    pub current_lim: f32,
    pub torque_constant: f32,
    pub enable_watchdog: bool,
    pub watchdog_timeout: f32,
    pub enable_step_dir: bool,
    pub startup_closed_loop_control: bool,
    pub startup_homing: bool,
    pub startup_motor_calibration: bool,
    pub temp_limit_upper: f32,
}

/// One axis.
#[derive(Debug, Clone)]
pub struct Axis {
    pub config: AxisConfig,
    pub state: State,
    pub error: u32,
    pub is_calibrated: bool,
    pub input_pos: f32,
    pub input_vel: f32,
    pub input_torque: f32,
    pub pos_setpoint: f64,
    pub vel_setpoint: f64,
    pub iq_measured: f32,
    pub pos_estimate: f64,
    pub vel_estimate: f64,
    trajectory: Option<Trajectory>,
    /// What the trajectory's change of speed takes, N m.
    feedforward: f64,
    integrator: f64,
    watchdog_ticks: u32,
    requested: Option<State>,
    counts_per_turn: f64,
    counts_at_start: i64,
    /// Winding resistance, ohm, and back-EMF, V s/turn: for the voltage that its current loop arrives at.
    winding: (f64, f64),
}

impl AxisConfig {
    /// As the maker ships it, with the gains that tuning finds for this motor and what hangs on it.
    pub fn tuned(axis: &AxisParameters, machine: &MachineParameters) -> Self {
        let metres_per_turn = axis.pulley_circumference_m / axis.gear_ratio;
        let torque_per_newton = axis.motor.torque_constant / axis.force_per_amp();
        let inertia = axis.effective_mass_kg() * metres_per_turn * torque_per_newton;
        let vel_gain = machine.tuning.velocity_bandwidth_rad_per_s * inertia;
        Self {
            control_mode: 3,
            input_mode: 1,
            pos_gain: 20.0,
            vel_gain: vel_gain as f32,
            vel_integrator_gain: (machine.tuning.integral_rate_per_s * vel_gain) as f32,
            inertia: inertia as f32,
            vel_limit: 2.0,
            vel_limit_tolerance: 1.2,
            enable_vel_limit: true,
            enable_overspeed_error: true,
            circular_setpoints: false,
            trajectory_vel_limit: 2.0,
            accel_limit: 0.5,
            decel_limit: 0.5,
            current_lim: 10.0,
            torque_constant: axis.motor.torque_constant as f32,
            enable_watchdog: false,
            watchdog_timeout: 0.0,
            enable_step_dir: false,
            startup_closed_loop_control: false,
            startup_homing: false,
            startup_motor_calibration: false,
            temp_limit_upper: 120.0,
        }
    }
}

impl Axis {
    /// At power-on, with what was saved; the encoder counts from here.
    pub fn new(config: AxisConfig, parameters: &AxisParameters, is_calibrated: bool, counts: i64) -> Self {
        Self {
            config,
            state: State::Idle,
            error: 0,
            is_calibrated,
            input_pos: 0.0,
            input_vel: 0.0,
            input_torque: 0.0,
            pos_setpoint: 0.0,
            vel_setpoint: 0.0,
            iq_measured: 0.0,
            pos_estimate: 0.0,
            vel_estimate: 0.0,
            trajectory: None,
            feedforward: 0.0,
            integrator: 0.0,
            watchdog_ticks: 0,
            requested: None,
            counts_per_turn: parameters.counts_per_turn,
            counts_at_start: counts,
            winding: (
                parameters.motor.resistance_ohm,
                parameters.motor.torque_constant * std::f64::consts::TAU,
            ),
        }
    }

    /// `requested_state`.
    pub fn request(&mut self, state: State) {
        self.requested = Some(state);
    }

    /// A new `input_pos` from a command: in trajectory mode a new trajectory.
    pub fn input_pos_updated(&mut self) {
        if self.config.input_mode == TRAPEZOIDAL {
            self.trajectory = Some(Trajectory {
                goal: f64::from(self.input_pos),
                greatest_speed: f64::from(self.config.trajectory_vel_limit),
                speeding_up: f64::from(self.config.accel_limit),
                slowing: f64::from(self.config.decel_limit),
            });
        }
    }

    /// The watchdog begins anew.
    pub fn feed_watchdog(&mut self) {
        self.watchdog_ticks = (f64::from(self.config.watchdog_timeout) * 1e3).max(0.0) as u32;
    }

    /// An error: the motor is let go.
    pub fn fail(&mut self, bits: u32) {
        self.error |= bits;
        self.let_go();
    }

    /// A millisecond: the share of this supply on the motor, none with its bridge open.
    pub fn tick(&mut self, counts: i64, amps: f64, supply_volts: f64) -> Option<f64> {
        self.measure(counts);
        self.iq_measured = amps as f32;
        if self.config.enable_watchdog {
            if self.watchdog_ticks == 0 {
                self.fail(WATCHDOG_TIMER_EXPIRED);
            } else {
                self.watchdog_ticks -= 1;
            }
        }
        match self.requested.take() {
            Some(State::Idle) => self.let_go(),
            Some(State::ClosedLoop) => self.close_loop(),
            None => {}
        }
        if self.state == State::Idle {
            return None;
        }
        self.follow_inputs();
        let torque = self.control()?;
        let amps = torque / f64::from(self.config.torque_constant);
        let (ohm, volts_per_turn) = self.winding;
        let volts = ohm * amps + volts_per_turn * self.vel_estimate;
        Some((volts / supply_volts).clamp(-1.0, 1.0))
    }

    fn measure(&mut self, counts: i64) {
        let seen = (counts - self.counts_at_start) as f64 / self.counts_per_turn;
        self.pos_estimate += TICK_SECS * self.vel_estimate;
        let off = seen - self.pos_estimate;
        self.pos_estimate += TICK_SECS * 2.0 * FILTER_RAD_PER_S * off;
        self.vel_estimate += TICK_SECS * FILTER_RAD_PER_S * FILTER_RAD_PER_S * off;
        if self.vel_estimate.abs() < 0.5 * TICK_SECS * FILTER_RAD_PER_S.powi(2) / self.counts_per_turn {
            // Between two counts there is no speed to see.
            self.vel_estimate = 0.0;
        }
    }

    fn close_loop(&mut self) {
        if !self.is_calibrated {
            self.fail(INVALID_STATE);
            return;
        }
        // With an error it comes on and goes off in the same step.
        if self.error != 0 {
            self.let_go();
            return;
        }
        self.feed_watchdog();
        self.state = State::ClosedLoop;
        // It begins where it is.
        self.pos_setpoint = self.pos_estimate;
        self.input_pos = self.pos_estimate as f32;
        (self.vel_setpoint, self.integrator) = (0.0, 0.0);
        self.input_pos_updated();
    }

    fn let_go(&mut self) {
        self.state = State::Idle;
        self.trajectory = None;
        (self.vel_setpoint, self.integrator) = (0.0, 0.0);
    }

    fn follow_inputs(&mut self) {
        self.feedforward = 0.0;
        match self.config.input_mode {
            PASSTHROUGH => {
                self.pos_setpoint = f64::from(self.input_pos);
                self.vel_setpoint = f64::from(self.input_vel);
            }
            TRAPEZOIDAL => {
                if let Some(trajectory) = self.trajectory {
                    let (place, speed, is_through) =
                        trajectory.step(self.pos_setpoint, self.vel_setpoint, TICK_SECS);
                    let acceleration = (speed - self.vel_setpoint) / TICK_SECS;
                    self.feedforward = f64::from(self.config.inertia) * acceleration;
                    (self.pos_setpoint, self.vel_setpoint) = (place, speed);
                    if is_through {
                        self.trajectory = None;
                    }
                }
            }
            _ => {}
        }
    }

    /// The torque, N m; none when it has just failed.
    fn control(&mut self) -> Option<f64> {
        let limit = f64::from(self.config.vel_limit);
        let mut wanted = self.vel_setpoint;
        if self.config.control_mode >= POSITION {
            wanted += f64::from(self.config.pos_gain) * (self.pos_setpoint - self.pos_estimate);
        }
        if self.config.enable_vel_limit {
            wanted = wanted.clamp(-limit, limit);
        }
        let tolerated = f64::from(self.config.vel_limit_tolerance) * limit;
        if self.config.enable_overspeed_error && self.vel_estimate.abs() > tolerated {
            self.fail(CONTROLLER_FAILED);
            return None;
        }
        let off = wanted - self.vel_estimate;
        let torque = self.feedforward + f64::from(self.config.vel_gain) * off + self.integrator;
        let most = f64::from(self.config.current_lim) * f64::from(self.config.torque_constant);
        if torque.abs() > most {
            self.integrator *= DECAY;
        } else {
            self.integrator += f64::from(self.config.vel_integrator_gain) * TICK_SECS * off;
        }
        Some(torque.clamp(-most, most))
    }
}

pub const PASSTHROUGH: i32 = 1;
pub const TRAPEZOIDAL: i32 = 5;
pub const POSITION: i32 = 3;
const INVALID_STATE: u32 = 0x1;
const CONTROLLER_FAILED: u32 = 0x200;
pub const MOTOR_FAILED: u32 = 0x40;
const WATCHDOG_TIMER_EXPIRED: u32 = 0x800;
const TICK_SECS: f64 = 1e-3;
const FILTER_RAD_PER_S: f64 = 500.0;
/// 0.99 in each of the board's eight steps a millisecond.
const DECAY: f64 = 0.923;
