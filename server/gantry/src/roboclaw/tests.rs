//! The driver against the emulated boards, on virtual time: the bytes of one are the other's, and neither knows the other's code.

mod faults;
mod motion;
mod switches;

use std::io;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{Homing, Limits, Travel};
use covr_engine::safety::vetted::{Action, Setpoint};
use covr_engine::time::{Span, Time};

use super::board::Refused;
use super::driver::Order;
use super::emulator::Emulator;
use super::emulator::orders::Axis;
use super::emulator::setup::{Eeprom, EndSwitches, Setup, Wiring};
use super::port::Port;
use super::session::Session;
use super::settings::{AxisSettings, Boards, HomeBy, Settings};
use crate::homing::HomingParameters;
use crate::sim::parameters::MachineParameters;

/// Boards and the time that passes for them.
struct World {
    emulator: Emulator,
    now: Time,
    begun: Instant,
    /// The numbers of the commands that went out.
    sent: Vec<u8>,
}

/// The line to them; waiting is what makes time pass.
#[derive(Clone)]
struct VirtualPort(Arc<Mutex<World>>);

impl VirtualPort {
    fn with<T>(&self, look: impl FnOnce(&mut World) -> T) -> T {
        look(&mut self.0.lock().unwrap())
    }

    fn time(&self) -> Time {
        self.with(|world| world.now)
    }

    fn wait(&self, span: Span) {
        self.with(|world| world.now += span);
    }
}

impl Port for VirtualPort {
    fn now(&self) -> Instant {
        self.with(|world| world.begun + Duration::from_micros(world.now.micros() as u64))
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.with(|world| {
            world.sent.push(bytes[1]);
            world.emulator.receive(world.now, bytes);
        });
        Ok(())
    }

    fn receive(&mut self, into: &mut [u8], deadline: Instant) -> io::Result<usize> {
        self.with(|world| {
            let last = Time::from_micros((deadline - world.begun).as_micros() as i64 + 1);
            loop {
                let bytes = world.emulator.poll(world.now);
                if !bytes.is_empty() || world.now >= last {
                    assert!(bytes.len() <= into.len(), "more came than was asked for");
                    into[..bytes.len()].copy_from_slice(&bytes);
                    return Ok(bytes.len());
                }
                let due = world.emulator.next_due().unwrap_or(last);
                world.now =
                    due.clamp(world.now + Span::from_micros(10), last.max(world.now + Span::from_micros(10)));
            }
        })
    }
}

/// What stands on the other side of the line.
#[derive(Clone, Copy)]
struct Kind {
    firmware: &'static str,
    boards: Boards,
    home_by: HomeBy,
    baud: u32,
}

const USUAL: Kind =
    Kind { firmware: "newer", boards: Boards::One(0x80), home_by: HomeBy::Switches, baud: 460_800 };

fn travel() -> Travel {
    Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) }
}

fn settings(kind: Kind) -> Settings {
    let axis = |metres_per_count: f64| AxisSettings {
        counts_per_metre: 1.0 / metres_per_count,
        reversed: false,
        velocity_pid: None,
    };
    let machine = MachineParameters::paper(travel());
    Settings {
        port: "virtual".into(),
        baud: kind.baud,
        boards: kind.boards,
        axes: [axis(machine.x.metres_per_count()), axis(machine.y.metres_per_count())],
        limits: Limits::PAPER,
        travel: travel(),
        parked: Floor::new(1.0, 1.0),
        current_limit_amps: 7.0,
        homing_current_amps: 3.0,
        serial_timeout: Span::from_millis(200),
        period: Span::from_millis(10),
        homing: HomingParameters {
            switch_outside_m: if kind.home_by == HomeBy::Switches { 0.01 } else { machine.stop_outside_m },
            ..machine.homing
        },
        home_by: kind.home_by,
        position_gain_per_s: 8.0,
    }
}

/// A driver on its boards.
struct Bench {
    port: VirtualPort,
    session: Session<VirtualPort>,
}

impl Bench {
    fn world(kind: Kind, start: Floor) -> VirtualPort {
        let machine = MachineParameters { start, ..MachineParameters::paper(travel()) };
        let setup = Setup {
            wiring: if matches!(kind.boards, Boards::One(_)) { Wiring::OneBoard } else { Wiring::TwoBoards },
            firmware: kind.firmware.parse().unwrap(),
            baud: kind.baud,
            end_switches: if kind.home_by == HomeBy::Switches { EndSwitches::Low } else { EndSwitches::None },
            eeprom: Eeprom::Tuned,
            ..Setup::paper(machine)
        };
        let world = World {
            emulator: Emulator::new(setup).unwrap(),
            now: Time::from_micros(1_000),
            begun: Instant::now(),
            sent: Vec::new(),
        };
        let port = VirtualPort(Arc::new(Mutex::new(world)));
        // A board takes a moment to start.
        port.with(|world| world.emulator.poll(world.now));
        port.wait(Span::from_secs(2.0));
        if matches!(Self::try_new(kind, &port), Err(Refused::SwitchOffAndOn { .. })) {
            Self::switch_off_and_on(&port);
            // Of two boards the second is configured when the first is through.
            if matches!(Self::try_new(kind, &port), Err(Refused::SwitchOffAndOn { .. })) {
                Self::switch_off_and_on(&port);
            }
        }
        port
    }

    fn switch_off_and_on(port: &VirtualPort) {
        port.with(|world| world.emulator.give(world.now, "brown-out 200".parse().unwrap()));
        port.wait(Span::from_secs(2.0));
    }

    fn try_new(kind: Kind, port: &VirtualPort) -> Result<Self, Refused> {
        let session = Session::open(port.clone(), &settings(kind), Floor::new(1.0, 1.0))?;
        Ok(Self { port: port.clone(), session })
    }

    fn new(kind: Kind, start: Floor) -> Self {
        Self::try_new(kind, &Self::world(kind, start)).unwrap()
    }

    fn homed(kind: Kind) -> Self {
        let mut bench = Self::new(kind, Floor::new(0.4, 0.3));
        assert_eq!(bench.home(), Homing::Homed);
        bench
    }

    fn give(&self, order: &str) {
        self.port.with(|world| world.emulator.give(world.now, order.parse().unwrap()));
    }

    fn truth(&self) -> (Floor, Planar) {
        self.port.with(|world| {
            let [x, y] = Axis::BOTH.map(|axis| world.emulator.truth(axis));
            (Floor::new(x.position_m, y.position_m), Planar::new(x.speed_mps, y.speed_mps))
        })
    }

    /// One cycle under an action that was vetted now; the next begins no sooner than a control period after this.
    fn cycle(&mut self, action: Action) -> Result<bool, Refused> {
        self.cycle_with(Order { vetted_at: self.port.time(), action })
    }

    fn cycle_with(&mut self, order: Order) -> Result<bool, Refused> {
        let begun = self.port.time();
        let port = self.port.clone();
        let outcome = self.session.cycle(&order, &move || port.time());
        let next = begun + CONTROL_PERIOD;
        self.port.with(|world| world.now = world.now.max(next));
        outcome
    }

    fn home(&mut self) -> Homing {
        let begun = self.port.time();
        while self.port.time() - begun < Span::from_secs(120.0) {
            self.cycle(Action::Home).unwrap();
            let report = self.session.report();
            assert_eq!(report.trouble, None);
            if matches!(report.homing, Homing::Homed | Homing::Failed) {
                break;
            }
        }
        self.session.report().homing
    }
}

fn setpoint(position: Floor, velocity: Planar, acceleration: Planar) -> Action {
    Action::Track(Setpoint { position, velocity, acceleration, valid_for: Span::from_millis(50) })
}

const CONTROL_PERIOD: Span = Span::from_millis(4);
