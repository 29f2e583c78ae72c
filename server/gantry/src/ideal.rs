//! A machine that does exactly what it is told: for sweeps over rules, where the machine is not the question.
//!
//! It is where the last setpoint says, in position, velocity and acceleration; it stops as the axis limits say when it
//! is told to, or when setpoints stop coming. It has no motors, so its currents are zero.

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{AxisLimits, Drive, Homing, Limits, MachineReport, Travel};
use covr_engine::safety::vetted::{Action, Setpoint, Vetted};
use covr_engine::time::Time;

use crate::contract::{Gantry, NotTaken, Reading, Simulated, Truth};

/// The ideal machine.
#[derive(Debug, Clone)]
pub struct IdealMachine {
    limits: Limits,
    travel: Travel,
    motion: Motion,
    drive: Drive,
    homing: Homing,
    now: Time,
    position: Floor,
    velocity: Planar,
    taken: Time,
}

/// What moves it.
#[derive(Debug, Clone, Copy)]
enum Motion {
    /// It brakes, or rests, from this state on.
    Stopping { since: Time, position: Floor, velocity: Planar },
    /// It is on a setpoint given at `since`.
    Following { since: Time, setpoint: Setpoint },
}

impl IdealMachine {
    /// At rest at `start`, which it knows: homing is done as soon as it is asked for.
    pub fn new(limits: Limits, travel: Travel, start: Floor) -> Self {
        let motion = Motion::Stopping { since: Time::ZERO, position: start, velocity: Planar::ZERO };
        Self {
            limits,
            travel,
            motion,
            drive: Drive::Released,
            homing: Homing::NotHomed,
            now: Time::ZERO,
            position: start,
            velocity: Planar::ZERO,
            taken: Time::ZERO,
        }
    }

    /// Homed and at rest at `place`, its drive on.
    pub fn standing(limits: Limits, travel: Travel, place: Floor) -> Self {
        Self { drive: Drive::On, homing: Homing::Homed, ..Self::new(limits, travel, place) }
    }

    fn advance(&mut self, now: Time) {
        self.now = now;
        if let Motion::Following { since, setpoint } = self.motion {
            let until = since + setpoint.valid_for;
            if now <= until {
                (self.position, self.velocity) = along(&setpoint, (now - since).secs());
                return;
            }
            let (position, velocity) = along(&setpoint, setpoint.valid_for.secs());
            self.motion = Motion::Stopping { since: until, position, velocity };
        }
        if let Motion::Stopping { since, position, velocity } = self.motion {
            let secs = (now - since).secs();
            let (x, vx) = braked(velocity.x, &self.limits.x, secs);
            let (y, vy) = braked(velocity.y, &self.limits.y, secs);
            self.position = position + Planar::new(x, y);
            self.velocity = Planar::new(vx, vy);
        }
    }

    fn stop(&mut self) {
        if let Motion::Following { .. } = self.motion {
            self.motion =
                Motion::Stopping { since: self.now, position: self.position, velocity: self.velocity };
        }
    }
}

/// Position and velocity `secs` after a setpoint was given: an axis that slows stops at rest.
fn along(setpoint: &Setpoint, secs: f64) -> (Floor, Planar) {
    let on = |velocity: f64, acceleration: f64| {
        let rests_after =
            if velocity * acceleration < 0.0 { -velocity / acceleration } else { f64::INFINITY };
        let t = secs.min(rests_after);
        (
            velocity * t + 0.5 * acceleration * t * t,
            if t == rests_after { 0.0 } else { velocity + acceleration * t },
        )
    };
    let (x, vx) = on(setpoint.velocity.x, setpoint.acceleration.x);
    let (y, vy) = on(setpoint.velocity.y, setpoint.acceleration.y);
    (setpoint.position + Planar::new(x, y), Planar::new(vx, vy))
}

/// Way gone and speed left, `secs` into braking from `speed_mps`.
fn braked(speed_mps: f64, limits: &AxisLimits, secs: f64) -> (f64, f64) {
    let to_rest = speed_mps.abs() / limits.braking_mps2;
    let t = secs.clamp(0.0, to_rest);
    let left = speed_mps - speed_mps.signum() * limits.braking_mps2 * t;
    let left = if t < to_rest { left } else { 0.0 };
    (0.5 * (speed_mps + left) * t, left)
}

impl Gantry for IdealMachine {
    fn read(&mut self, now: Time) -> Reading {
        self.advance(now);
        let report = MachineReport {
            answered_at: now,
            position: self.position,
            velocity: self.velocity,
            current_amps: [0.0; 2],
            drive: self.drive,
            homing: self.homing,
            home_repeatability_m: None,
            trouble: None,
        };
        Reading { report, link: Ok(()) }
    }

    fn write(&mut self, now: Time, command: &Vetted) -> Result<(), NotTaken> {
        self.advance(now);
        let mut outcome = Ok(());
        self.drive = if command.action() == Action::Release { Drive::Released } else { Drive::On };
        match command.action() {
            Action::Release | Action::Hold => self.stop(),
            Action::Home => {
                self.stop();
                self.homing = Homing::Homed;
            }
            Action::Track(_) if self.homing != Homing::Homed => {
                self.stop();
                outcome = Err(NotTaken::NotHomed);
            }
            Action::Track(setpoint) if !is_finite(&setpoint) => {
                self.stop();
                outcome = Err(NotTaken::NotFinite);
            }
            Action::Track(setpoint) => {
                self.motion = Motion::Following { since: command.at(), setpoint };
                self.advance(now);
            }
        }
        if outcome.is_ok() {
            self.taken = command.at();
        }
        outcome
    }

    fn taken(&self) -> Time {
        self.taken
    }

    fn name(&self) -> &str {
        "ideal gantry"
    }

    fn travel(&self) -> Travel {
        self.travel
    }

    fn limits(&self) -> Limits {
        self.limits
    }
}

impl Simulated for IdealMachine {
    fn truth(&self) -> Truth {
        Truth { position: self.position, velocity: self.velocity, current_amps: [0.0; 2] }
    }
}

fn is_finite(setpoint: &Setpoint) -> bool {
    setpoint.position.is_finite()
        && setpoint.velocity.norm().is_finite()
        && setpoint.acceleration.norm().is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::safety::vetted::ArenaConfirmedClear;
    use covr_engine::time::Span;

    fn machine() -> IdealMachine {
        let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        IdealMachine::new(Limits::PAPER, travel, Floor::new(1.0, 1.0))
    }

    fn write(machine: &mut IdealMachine, at: Time, action: Action) -> Result<(), NotTaken> {
        let clear = ArenaConfirmedClear::by_a_person_who_looked();
        let command =
            Vetted::on_clear_course(clear, at, action, &machine.limits(), &machine.travel()).unwrap();
        machine.write(at, &command)
    }

    const ONWARD: Setpoint = Setpoint {
        position: Floor { x: 1.0, y: 1.0 },
        velocity: Planar { x: 1.0, y: 0.0 },
        acceleration: Planar { x: 0.0, y: 0.5 },
        valid_for: Span::from_millis(20),
    };

    #[test]
    fn it_is_where_the_setpoint_says_and_brakes_by_itself_after_its_time() {
        let mut machine = machine();
        write(&mut machine, Time::ZERO, Action::Home).unwrap();
        write(&mut machine, Time::ZERO, Action::Track(ONWARD)).unwrap();
        let on_it = machine.read(Time::from_micros(10_000)).report;
        assert!((on_it.position.x - 1.01).abs() < 1e-12);
        assert!((on_it.velocity.y - 0.005).abs() < 1e-12);
        let rest = machine.read(Time::from_micros(2_000_000)).report;
        assert_eq!(rest.velocity, Planar::ZERO);
        // 20 ms at 1 m/s, then 1 / (2 * 2.5) m of braking.
        assert!((rest.position.x - 1.22).abs() < 1e-9, "{}", rest.position.x);
    }

    #[test]
    fn a_setpoint_before_homing_is_not_taken() {
        let mut machine = machine();
        assert_eq!(write(&mut machine, Time::ZERO, Action::Track(ONWARD)), Err(NotTaken::NotHomed));
        assert_eq!(machine.read(Time::from_micros(500_000)).report.position, Floor::new(1.0, 1.0));
    }

    #[test]
    fn hold_brakes_at_the_limit() {
        let mut machine = machine();
        write(&mut machine, Time::ZERO, Action::Home).unwrap();
        write(&mut machine, Time::ZERO, Action::Track(ONWARD)).unwrap();
        write(&mut machine, Time::ZERO, Action::Hold).unwrap();
        let braking = machine.read(Time::from_micros(200_000)).report;
        assert!((braking.velocity.x - 0.5).abs() < 1e-9);
        assert_eq!(braking.drive, Drive::On);
    }
}
