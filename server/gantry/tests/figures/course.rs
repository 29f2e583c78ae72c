//! Drives a machine in an empty arena, one control period of 4 ms at a time, and looks at it every period.

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{Homing, MachineReport, Travel};
use covr_engine::safety::vetted::{Action, ArenaConfirmedClear, Setpoint, Vetted};
use covr_engine::time::{Span, Time};
use covr_gantry::contract::{Gantry, NotTaken, Reading};
use covr_gantry::sim::SimulatedMachine;
use covr_gantry::sim::parameters::MachineParameters;

use crate::reference::Move;

pub const PERIOD: Span = Span::from_millis(4);
pub const ARENA: Travel = Travel { min: Floor { x: 0.0, y: 0.0 }, max: Floor { x: 4.0, y: 4.0 } };

/// A machine and the time on its course.
pub struct Course {
    pub machine: SimulatedMachine,
    pub now: Time,
}

/// What was seen in one period of a move.
pub struct Seen {
    pub reference: (Floor, Planar, Planar),
    pub position: Floor,
    pub velocity: Planar,
    pub amps: [f64; 2],
    pub reading: Reading,
}

impl Course {
    pub fn new(parameters: MachineParameters) -> Self {
        Self { machine: SimulatedMachine::new(parameters).unwrap(), now: Time::from_micros(1_000_000) }
    }

    /// Homed, at rest at the home corner.
    pub fn homed() -> Self {
        let mut parameters = MachineParameters::paper(ARENA);
        parameters.start = Floor::new(0.4, 0.3);
        let mut course = Self::new(parameters);
        assert_eq!(course.home(), Homing::Homed);
        course
    }

    /// Homed, then moved to `place`.
    pub fn homed_at(place: Floor) -> Self {
        let mut course = Self::homed();
        course.travel_to(place, |_| {});
        course
    }

    /// Built homed and standing at `place`.
    pub fn standing_at(place: Floor) -> Self {
        let parameters = MachineParameters { start: place, ..MachineParameters::paper(ARENA) };
        let machine = SimulatedMachine::standing(parameters).unwrap();
        Self { machine, now: Time::from_micros(1_000_000) }
    }

    /// One period under `action`: what is read at its end.
    pub fn step(&mut self, action: Action) -> (Result<(), NotTaken>, Reading) {
        self.step_for(action, PERIOD)
    }

    /// The same, over another period.
    pub fn step_for(&mut self, action: Action, period: Span) -> (Result<(), NotTaken>, Reading) {
        let clear = ArenaConfirmedClear::by_a_person_who_looked();
        let (limits, travel) = (self.machine.limits(), self.machine.travel());
        let command = Vetted::on_clear_course(clear, self.now, action, &limits, &travel).unwrap();
        let taken = self.machine.write(self.now, &command);
        self.now += period;
        (taken, self.machine.read(self.now))
    }

    /// The same action for so long.
    pub fn keep(&mut self, action: Action, secs: f64) -> MachineReport {
        let mut last = self.machine.read(self.now);
        for _ in 0..(secs / PERIOD.secs()).round() as usize {
            last = self.step(action).1;
        }
        last.report
    }

    /// Nobody writes for so long.
    pub fn be_silent(&mut self, secs: f64) -> MachineReport {
        let mut last = self.machine.read(self.now);
        for _ in 0..(secs / PERIOD.secs()).round() as usize {
            self.now += PERIOD;
            last = self.machine.read(self.now);
        }
        last.report
    }

    /// Home until it is done or given up.
    pub fn home(&mut self) -> Homing {
        for _ in 0..(120.0 / PERIOD.secs()) as usize {
            let homing = self.step(Action::Home).1.report.homing;
            if matches!(homing, Homing::Homed | Homing::Failed) {
                return homing;
            }
        }
        Homing::Running
    }

    /// Follow a reference to `place`, both axes at once, and half a second more.
    pub fn travel_to(&mut self, place: Floor, look: impl FnMut(&Seen)) {
        self.travel_in_periods(place, || PERIOD, look);
    }

    /// The same, in periods of any length.
    pub fn travel_in_periods(
        &mut self,
        place: Floor,
        mut period: impl FnMut() -> Span,
        mut look: impl FnMut(&Seen),
    ) {
        let start = self.machine.read(self.now).report.position;
        let began = self.now;
        let limits = self.machine.limits();
        let (x, y) = (Move::new(place.x - start.x, &limits.x), Move::new(place.y - start.y, &limits.y));
        let secs = x.secs().max(y.secs()) + 0.5;
        let at = |t: f64| {
            let ((sx, vx, ax), (sy, vy, ay)) = (x.at(t), y.at(t));
            (start + Planar::new(sx, sy), Planar::new(vx, vy), Planar::new(ax, ay))
        };
        while (self.now - began).secs() < secs {
            let (position, velocity, acceleration) = at((self.now - began).secs());
            let valid_for = Span::from_millis(40);
            let setpoint = Setpoint { position, velocity, acceleration, valid_for };
            let (taken, reading) = self.step_for(Action::Track(setpoint), period());
            taken.unwrap();
            look(&Seen {
                reference: at((self.now - began).secs()),
                position: self.machine.true_position(),
                velocity: self.machine.true_velocity(),
                amps: self.machine.true_current_amps(),
                reading,
            });
        }
    }
}
