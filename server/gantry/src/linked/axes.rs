//! What is known of both axes and decided between two looks at a controller; no port, no clock, and no units but metres.
//!
//! ```text
//! order:  release ─▶ no torque
//!         hold ────▶ brake ──at rest──▶ keep that place
//!         home ────▶ the homing sequence of both axes ──▶ keep the place of rest
//!         track ───▶ position loop        (not homed, or the order is old: as hold)
//! ```

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{Drive as DriveState, Homing, Limits, MachineReport, Travel, Trouble};
use covr_engine::safety::vetted::Action;
use covr_engine::time::{Span, Time};

use super::contact::Contact;
use super::follow::{AxisSpeed, Follower, KEEPING_SECS};
use crate::homing::{HomeBy, HomingAxis, HomingParameters, HomingPlan, HomingStep, RAMP_MPS2, Seen};

/// What the control thread wants, and when it said so.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Order {
    /// When it was vetted.
    pub vetted_at: Time,
    /// What it says.
    pub action: Action,
}

/// What the controller is to be told.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tell {
    /// No torque.
    Release,
    /// Go on like this: the long rail and the cross rail.
    Go([AxisSpeed; 2]),
}

/// One look at the motors, in metres along the axes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Look {
    /// How far the encoder went since the last look, m.
    pub steps_m: [f64; 2],
    /// m/s.
    pub speeds_mps: [f64; 2],
    /// A.
    pub amps: [f64; 2],
    /// What the controller says.
    pub status: Status,
}

/// What a controller says of itself, however its protocol puts it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Status {
    /// The emergency stop's pin is active, or latched.
    pub emergency_stop: bool,
    /// A bridge is broken, or the controller keeps its motors off for a reason that has no name of its own here.
    pub driver_fault: bool,
    /// It is too hot and has switched off.
    pub too_hot: bool,
    /// A supply is outside what it stands, and it has switched off.
    pub bad_supply: bool,
    /// It has started anew since the last look.
    pub restarted: bool,
    /// It limits a motor's current now.
    pub current_limited: [bool; 2],
    /// The home switches.
    pub at_switch: [bool; 2],
}

/// What both axes are made of, as far as decisions need it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxesSettings {
    /// What each axis may do.
    pub limits: Limits,
    /// Where the column's centre can stand, room frame.
    pub travel: Travel,
    /// Above this the controller limits a motor's current, A.
    pub current_limit_amps: f64,
    /// How homing moves.
    pub homing: HomingParameters,
    /// What homing looks for.
    pub home_by: HomeBy,
    /// Gain of the position loop, 1/s.
    pub position_gain_per_s: f64,
}

/// Both axes between finding their controller and losing it.
#[derive(Debug, Clone)]
pub struct Axes {
    settings: AxesSettings,
    follower: Follower,
    /// Where it stood when counting began, room frame, as far as known.
    stood_at: Floor,
    axes: [Axis; 2],
    homing: Homing,
    switches_m: Option<[f64; 2]>,
    home_repeatability_m: Option<[f64; 2]>,
    was_told_to_home: bool,
    kept_m: Option<[f64; 2]>,
    /// The count went on as no machine can move, or the controller has restarted.
    is_lost: bool,
    drive: DriveState,
    status: Status,
    seen_at: Time,
    since_last_secs: f64,
}

/// One axis: its place since counting began, and where it is in homing.
#[derive(Debug, Clone)]
struct Axis {
    here_m: f64,
    speed_mps: f64,
    amps: f64,
    told_mps: f64,
    sequence: HomingAxis,
    plan: HomingPlan,
    contact: Contact,
}

impl Axes {
    /// A machine that stands there, not homed.
    pub fn new(settings: AxesSettings, stood_at: Floor) -> Self {
        let span = settings.travel.max - settings.travel.min;
        let axis = |span_m: f64| Axis {
            here_m: 0.0,
            speed_mps: 0.0,
            amps: 0.0,
            told_mps: 0.0,
            sequence: HomingAxis::default(),
            plan: HomingPlan::new(settings.homing, span_m + BEYOND_TRAVEL_M),
            contact: Contact::default(),
        };
        Self {
            follower: Follower::new(settings.position_gain_per_s, settings.limits),
            stood_at,
            axes: [axis(span.x), axis(span.y)],
            homing: Homing::NotHomed,
            switches_m: None,
            home_repeatability_m: None,
            was_told_to_home: false,
            kept_m: None,
            is_lost: false,
            drive: DriveState::Released,
            status: Status::default(),
            seen_at: Time::ZERO,
            since_last_secs: 0.0,
            settings,
        }
    }

    /// Take in what the controller says. Where the count did not go on as a machine can move, the place is lost: the controller has
    /// restarted, perhaps with other settings, so it brakes and moves no more until it was configured anew.
    pub fn see(&mut self, look: &Look, at: Time) {
        self.since_last_secs = if self.seen_at == Time::ZERO { 0.0 } else { (at - self.seen_at).secs() };
        let before = self.report().position;
        let limits = [self.settings.limits.x.speed_mps, self.settings.limits.y.speed_mps];
        let homes_by_switches = self.homing == Homing::Running && self.settings.home_by == HomeBy::Switches;
        let mut is_lost = look.status.restarted;
        for (i, axis) in self.axes.iter_mut().enumerate() {
            let most_m = SPARE_M + MOST_OVER * limits[i] * self.since_last_secs;
            let is_continuous = axis.see(look, i, most_m);
            // A controller may set its count to nothing at the home switch, while it homes: that is no loss.
            let is_expected = homes_by_switches && look.status.at_switch[i];
            is_lost |= !(is_continuous || is_expected);
        }
        if is_lost {
            self.lose_place(before);
        }
        self.status = look.status;
        self.seen_at = at;
    }

    /// The place is lost, and nothing holds the column any more.
    pub fn is_over(&self) -> bool {
        self.is_lost && self.drive == DriveState::Released
    }

    /// What to tell the controller at `now`, with the next look a `period` later.
    pub fn next(&mut self, now: Time, order: &Order, period: Span) -> Tell {
        let age = now - order.vetted_at;
        let action = match order.action {
            Action::Track(setpoint) if age > setpoint.valid_for || self.homing != Homing::Homed => {
                Action::Hold
            }
            Action::Home if age > OLDEST_HOME || self.is_lost => Action::Hold,
            action => action,
        };
        if action != Action::Home {
            if self.homing == Homing::Running {
                self.homing = Homing::NotHomed;
            }
            self.was_told_to_home = false;
        }
        if !matches!(action, Action::Hold) {
            self.kept_m = None;
        }
        let speeds = match action {
            Action::Release => {
                self.drive = DriveState::Released;
                self.follower.forget();
                self.axes.iter_mut().for_each(|axis| axis.told_mps = 0.0);
                return Tell::Release;
            }
            Action::Hold => self.hold(),
            Action::Home => self.home(),
            Action::Track(setpoint) => {
                let report = self.report();
                self.follower.follow(now, order.vetted_at, &setpoint, &report, period)
            }
        };
        if self.homing == Homing::Failed && action == Action::Home {
            // Something is in the way, or there is no switch: do not lean on it.
            self.drive = DriveState::Released;
            return Tell::Release;
        }
        self.drive = DriveState::On;
        self.tell(speeds)
    }

    /// What the machine says of itself.
    pub fn report(&self) -> MachineReport {
        let [x, y] = &self.axes;
        let position = match self.switches_m {
            Some([switch_x, switch_y]) => {
                let outside_m = self.settings.homing.switch_outside_m;
                self.settings.travel.min
                    + Planar::new(x.here_m - switch_x - outside_m, y.here_m - switch_y - outside_m)
            }
            None => self.stood_at + Planar::new(x.here_m, y.here_m),
        };
        let trouble = self.trouble();
        MachineReport {
            answered_at: self.seen_at,
            position,
            velocity: Planar::new(x.speed_mps, y.speed_mps),
            current_amps: [0, 1].map(|i| self.amps(i)),
            drive: if trouble.is_some() { DriveState::Released } else { self.drive },
            homing: self.homing,
            home_repeatability_m: self.home_repeatability_m,
            trouble,
        }
    }

    /// Whether the lower current limit of homing is wanted.
    pub fn pushes_gently(&self) -> bool {
        self.homing == Homing::Running
    }

    /// A controller that limits a current says so at once, while what it measures swings about the limit: it counts as over.
    /// Not while homing, where it is meant to.
    fn amps(&self, axis: usize) -> f64 {
        let amps = self.axes[axis].amps;
        if self.status.current_limited[axis] && !self.pushes_gently() {
            amps.max(self.settings.current_limit_amps + OVER_AMPS)
        } else {
            amps
        }
    }

    fn trouble(&self) -> Option<Trouble> {
        let Status { emergency_stop, driver_fault, too_hot, bad_supply, .. } = self.status;
        [
            (emergency_stop, Trouble::EmergencyStop),
            (driver_fault, Trouble::DriverFault),
            (too_hot, Trouble::TooHot),
            (bad_supply, Trouble::BadSupply),
            (self.is_lost, Trouble::Restarted),
        ]
        .into_iter()
        .find_map(|(is_so, trouble)| is_so.then_some(trouble))
    }

    fn lose_place(&mut self, stood_at: Floor) {
        self.is_lost = true;
        self.stood_at = stood_at;
        self.homing = Homing::NotHomed;
        self.switches_m = None;
        self.home_repeatability_m = None;
        self.kept_m = None;
        self.was_told_to_home = false;
        self.axes.iter_mut().for_each(|axis| axis.here_m = 0.0);
    }

    fn hold(&mut self) -> [AxisSpeed; 2] {
        let kept = match self.kept_m {
            Some(kept) => kept,
            None if self.axes.iter().all(Axis::is_at_rest) => {
                self.follower.forget();
                *self.kept_m.insert([self.axes[0].here_m, self.axes[1].here_m])
            }
            None => return [0, 1].map(|i| self.brake(i)),
        };
        [0, 1].map(|i| self.keep(i, kept[i]))
    }

    fn home(&mut self) -> [AxisSpeed; 2] {
        if !self.was_told_to_home {
            self.was_told_to_home = true;
            self.homing = Homing::Running;
            self.follower.forget();
            for axis in &mut self.axes {
                axis.sequence = HomingAxis::default();
                axis.contact = Contact::default();
            }
        }
        if self.homing != Homing::Running {
            return self.hold();
        }
        let mut speeds = [self.brake(0), self.brake(1)];
        let mut are_done = [false; 2];
        for i in 0..2 {
            let on_switch = match self.settings.home_by {
                HomeBy::Switches => self.status.at_switch[i],
                HomeBy::Stops => {
                    let axis = &mut self.axes[i];
                    axis.contact.look(axis.here_m, axis.told_mps, self.since_last_secs)
                }
            };
            let axis = &mut self.axes[i];
            let seen = Seen {
                here_m: axis.here_m,
                at_rest: axis.is_at_rest(),
                on_switch,
                since_last_secs: self.since_last_secs,
            };
            match axis.sequence.step(&axis.plan, seen) {
                HomingStep::Move(speed_mps) => {
                    let distance_m = speed_mps.abs() * KEEPING_SECS;
                    speeds[i] =
                        AxisSpeed { speed_mps, acceleration_mps2: RAMP_MPS2, slope_mps2: 0.0, distance_m };
                }
                HomingStep::Brake => {}
                HomingStep::Rest { at_m } => speeds[i] = self.keep(i, at_m),
                HomingStep::Done => are_done[i] = true,
                HomingStep::Failed => {
                    self.homing = Homing::Failed;
                    return speeds;
                }
            }
        }
        if are_done == [true; 2]
            && let (Some(x), Some(y)) = (self.axes[0].sequence.switch_m(), self.axes[1].sequence.switch_m())
        {
            self.homing = Homing::Homed;
            self.switches_m = Some([x, y]);
            let sequences = [self.axes[0].sequence, self.axes[1].sequence];
            self.home_repeatability_m = HomingAxis::both_repeatabilities_m(&sequences);
        }
        speeds
    }

    fn brake(&self, axis: usize) -> AxisSpeed {
        let limits = [self.settings.limits.x, self.settings.limits.y][axis];
        AxisSpeed { speed_mps: 0.0, acceleration_mps2: limits.braking_mps2, slope_mps2: 0.0, distance_m: 0.0 }
    }

    fn keep(&mut self, axis: usize, place_m: f64) -> AxisSpeed {
        let (here_m, speed_mps) = (self.axes[axis].here_m, self.axes[axis].speed_mps);
        self.follower.keep_at(axis, place_m, here_m, speed_mps)
    }

    fn tell(&mut self, speeds: [AxisSpeed; 2]) -> Tell {
        for (axis, speed) in self.axes.iter_mut().zip(speeds) {
            axis.told_mps = speed.speed_mps;
        }
        Tell::Go(speeds)
    }
}

impl Axis {
    /// Whether the count went on by no more than this, m. Where it did not, the old place is kept and counting goes on from the new count.
    fn see(&mut self, look: &Look, i: usize, most_m: f64) -> bool {
        let is_continuous = look.steps_m[i].abs() <= most_m;
        if is_continuous {
            self.here_m += look.steps_m[i];
        }
        self.speed_mps = look.speeds_mps[i];
        self.amps = look.amps[i];
        is_continuous
    }

    fn is_at_rest(&self) -> bool {
        self.told_mps == 0.0 && self.speed_mps.abs() < STILL_MPS
    }
}

/// Homing may lead past the travel to the hard stops on both sides, m.
const BEYOND_TRAVEL_M: f64 = 0.2;
/// Between two looks an axis moves no more than this times its greatest speed and [`SPARE_M`].
const MOST_OVER: f64 = 2.0;
const SPARE_M: f64 = 0.02;
/// An axis slower than this rests, m/s.
const STILL_MPS: f64 = 2e-3;
/// An order to home that is older than this is none: the control thread says it every period.
const OLDEST_HOME: Span = Span::from_millis(100);
/// The current that a limited motor is reported with lies so far over the limit, A.
const OVER_AMPS: f64 = 0.01;
