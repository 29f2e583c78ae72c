//! A simulated gantry: true motion, what the encoders see of it, a motor controller, the host's loop, and the link.
//!
//! ```text
//! write ─▶ host: position loop ─▶ link ─▶ controller: dead-man, homing, velocity loop ─▶ volts
//!                                                                                        │
//! read  ◀─ report ◀── link ◀── counts, current ◀── encoder ◀── winding, mass, friction ◀─┘
//! ```
//!
//! It advances to the time that it is given, real or virtual, in steps of 0.5 ms. It owns no clock and no random
//! source: the same calls give the same motion, bit for bit. A step allocates nothing.

mod axis;
mod controller;
pub mod faults;
mod host;
mod link;
pub mod parameters;
pub(crate) mod plant;

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{Homing, Limits, MachineReport, Travel};
use covr_engine::safety::vetted::{Action, Vetted};
use covr_engine::time::{Span, Time};

use crate::contract::{Gantry, LinkError, NotTaken, Reading, Simulated, Truth};
use axis::TICK_MICROS;
use controller::{Controller, Packet};
use faults::{Faults, LinkFault};
use host::Host;
use link::Link;
use parameters::{MachineParameters, ParameterProblem};
use plant::{Plant, STEP_MICROS};

/// The simulated machine.
#[derive(Debug, Clone)]
pub struct SimulatedMachine {
    /// What is wrong with it now; change at will.
    pub faults: Faults,
    parameters: MachineParameters,
    plants: [Plant; 2],
    volts: [Option<f64>; 2],
    controller: Controller,
    host: Host,
    link: Link,
    /// Where the motion has got to; none before the first call.
    clock: Option<Time>,
    last_report: MachineReport,
    taken: Time,
}

impl SimulatedMachine {
    /// A machine that was just powered on. Its time starts with the first call.
    pub fn new(parameters: MachineParameters) -> Result<Self, ParameterProblem> {
        parameters.check()?;
        let MachineParameters { travel, start, .. } = parameters;
        let plants = [
            Plant::new(&parameters.x, &parameters, (travel.min.x, travel.max.x), start.x),
            Plant::new(&parameters.y, &parameters, (travel.min.y, travel.max.y), start.y),
        ];
        let controller = Controller::new(&parameters);
        let last_report = MachineReport {
            answered_at: Time::ZERO,
            position: parameters.parked,
            velocity: Planar::ZERO,
            current_amps: [0.0; 2],
            drive: controller.drive(),
            homing: controller.homing(),
            home_repeatability_m: controller.home_repeatability_m(),
            trouble: None,
        };
        Ok(Self {
            faults: Faults::default(),
            host: Host::new(&parameters),
            link: Link::default(),
            volts: [None; 2],
            clock: None,
            parameters,
            plants,
            controller,
            last_report,
            taken: Time::ZERO,
        })
    }

    /// A machine that was homed, drove to the start of its parameters and has held there since: its drive is on and
    /// its motors carry nothing. Homing leaves the reported place up to a few counts off; here it is exact.
    pub fn standing(parameters: MachineParameters) -> Result<Self, ParameterProblem> {
        let mut machine = Self::new(parameters)?;
        let outside_m = parameters.homing.switch_outside_m;
        let corner = parameters.travel.min - parameters.start;
        machine.controller.stand(0.0, [corner.x - outside_m, corner.y - outside_m]);
        machine.last_report = machine.report(Time::ZERO);
        Ok(machine)
    }

    /// A force from outside on the column from now on, N: somebody leans on it.
    pub fn push(&mut self, force_n: Planar) {
        self.plants[0].push_n = force_n.x;
        self.plants[1].push_n = force_n.y;
    }

    /// What it is made of.
    pub const fn parameters(&self) -> &MachineParameters {
        &self.parameters
    }

    /// True position of the column's centre, room frame.
    pub fn true_position(&self) -> Floor {
        Floor::new(self.plants[0].position_m(), self.plants[1].position_m())
    }

    /// True velocity of the column, m/s.
    pub fn true_velocity(&self) -> Planar {
        Planar::new(self.plants[0].speed_mps(), self.plants[1].speed_mps())
    }

    /// True winding currents x, y; signed, A.
    pub fn true_current_amps(&self) -> [f64; 2] {
        [self.plants[0].amps(), self.plants[1].amps()]
    }

    fn advance(&mut self, now: Time) {
        let mut clock = *self.clock.get_or_insert(now);
        // A caller that was away for long finds the machine at rest: its dead-man stopped it in the first second.
        if now - clock > MOST_CATCH_UP {
            clock = now - MOST_CATCH_UP;
        }
        while clock + Span::from_micros(STEP_MICROS) <= now {
            if clock.micros().rem_euclid(TICK_MICROS) < STEP_MICROS {
                self.tick(clock);
            }
            self.plants[0].step(self.volts[0], &self.faults.x);
            self.plants[1].step(self.volts[1], &self.faults.y);
            clock += Span::from_micros(STEP_MICROS);
        }
        self.clock = Some(clock);
    }

    fn tick(&mut self, clock: Time) {
        while let Some(packet) = self.link.packet_due(clock) {
            self.controller.take(packet);
        }
        let MachineParameters { travel, homing, supply_volts, .. } = &self.parameters;
        let counts = [self.plants[0].counts(), self.plants[1].counts()];
        let switches = [
            self.plants[0].position_m() <= travel.min.x - homing.switch_outside_m,
            self.plants[1].position_m() <= travel.min.y - homing.switch_outside_m,
        ];
        self.volts = self.controller.tick(counts, switches);
        for (volts, faults) in self.volts.iter_mut().zip([&self.faults.x, &self.faults.y]) {
            if let (Some(volts), Some(direction)) = (volts.as_mut(), faults.runaway) {
                *volts = direction.sign() * supply_volts;
            }
        }
    }

    fn report(&self, now: Time) -> MachineReport {
        let places = [0, 1].map(|i| self.plants[i].counts() as f64 * self.metres_per_count(i));
        let homing = self.controller.homing();
        let position = match self.controller.switch_places_m() {
            Some(switches) => {
                let outside = self.parameters.homing.switch_outside_m;
                self.parameters.travel.min
                    + Planar::new(places[0] - switches[0] - outside, places[1] - switches[1] - outside)
            }
            None => self.parameters.parked + Planar::new(places[0], places[1]),
        };
        let speed = |i: usize| self.controller.axes[i].measured_mps();
        let amps = |i: usize| (self.plants[i].amps().abs() / CURRENT_STEP_AMPS).round() * CURRENT_STEP_AMPS;
        MachineReport {
            answered_at: now,
            position,
            velocity: Planar::new(speed(0), speed(1)),
            current_amps: [amps(0), amps(1)],
            drive: self.controller.drive(),
            homing,
            home_repeatability_m: self.controller.home_repeatability_m(),
            trouble: None,
        }
    }

    fn metres_per_count(&self, axis: usize) -> f64 {
        [&self.parameters.x, &self.parameters.y][axis].metres_per_count()
    }

    fn silence(&self, now: Time) -> LinkError {
        LinkError::Silent { for_span: now - self.last_report.answered_at }
    }

    fn packet_for(&mut self, now: Time, command: &Vetted) -> (Packet, Result<(), NotTaken>) {
        let refused = match command.action() {
            Action::Track(setpoint) => {
                let is_finite = setpoint.position.is_finite()
                    && setpoint.velocity.norm().is_finite()
                    && setpoint.acceleration.norm().is_finite();
                if !is_finite {
                    NotTaken::NotFinite
                } else if self.last_report.homing != Homing::Homed {
                    NotTaken::NotHomed
                } else {
                    let packet = self.host.follow(now, command.at(), &setpoint, &self.last_report);
                    return (packet, Ok(()));
                }
            }
            action => {
                self.host.forget();
                let packet = match action {
                    Action::Release => Packet::Release,
                    Action::Home => Packet::Home,
                    Action::Hold | Action::Track(_) => Packet::Brake,
                };
                return (packet, Ok(()));
            }
        };
        self.host.forget();
        (Packet::Brake, Err(refused))
    }
}

impl Gantry for SimulatedMachine {
    fn read(&mut self, now: Time) -> Reading {
        self.advance(now);
        if self.faults.link == LinkFault::Dead {
            return Reading { report: self.last_report, link: Err(self.silence(now)) };
        }
        let report = self.report(now);
        if let Some(arrived) = self.link.report_through(now, report, self.faults.link) {
            self.last_report = arrived;
        }
        Reading { report: self.last_report, link: Ok(()) }
    }

    fn write(&mut self, now: Time, command: &Vetted) -> Result<(), NotTaken> {
        self.advance(now);
        if self.faults.link == LinkFault::Dead {
            return Err(self.silence(now).into());
        }
        let (packet, outcome) = self.packet_for(now, command);
        self.link.send(now, packet, self.faults.link);
        if outcome.is_ok() {
            self.taken = command.at();
        }
        outcome
    }

    fn taken(&self) -> Time {
        self.taken
    }

    fn name(&self) -> &str {
        "simulated gantry"
    }

    fn travel(&self) -> Travel {
        self.parameters.travel
    }

    fn limits(&self) -> Limits {
        self.parameters.limits
    }
}

impl Simulated for SimulatedMachine {
    fn set_faults(&mut self, faults: Faults) {
        self.faults = faults;
    }

    fn truth(&self) -> Truth {
        Truth {
            position: self.true_position(),
            velocity: self.true_velocity(),
            current_amps: self.true_current_amps(),
        }
    }
}

/// The longest absence that is caught up with, so that a call never takes long.
const MOST_CATCH_UP: Span = Span::from_millis(10_000);
/// RoboClaw reports currents in steps of 10 mA.
const CURRENT_STEP_AMPS: f64 = 0.01;
