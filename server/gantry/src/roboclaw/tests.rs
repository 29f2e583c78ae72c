//! The driver against the emulated boards, on virtual time: the bytes of one are the other's, and neither knows the other's code.

mod faults;
mod motion;
mod switches;

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{Homing, Limits};
use covr_engine::safety::vetted::Action;
use covr_engine::time::Span;

use super::board::Refused;
use super::emulator::Emulator;
use super::emulator::setup::{Eeprom, EndSwitches, Setup, Wiring};
use super::session::Session;
use super::settings::{AxisSettings, Boards, Settings};
use crate::emulation::Emulated as _;
use crate::homing::{HomeBy, HomingParameters};
use crate::linked::bench::{VirtualPort, setpoint, travel};
use crate::linked::link::Session as _;
use crate::sim::parameters::MachineParameters;

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
type Bench = crate::linked::bench::Bench<Emulator, Session<VirtualPort<Emulator>>>;

impl Bench {
    fn world(kind: Kind, start: Floor) -> VirtualPort<Emulator> {
        let machine = MachineParameters { start, ..MachineParameters::paper(travel()) };
        let setup = Setup {
            wiring: if matches!(kind.boards, Boards::One(_)) { Wiring::OneBoard } else { Wiring::TwoBoards },
            firmware: kind.firmware.parse().unwrap(),
            baud: kind.baud,
            end_switches: if kind.home_by == HomeBy::Switches { EndSwitches::Low } else { EndSwitches::None },
            eeprom: Eeprom::Tuned,
            ..Setup::paper(machine)
        };
        let port = VirtualPort::new(Emulator::new(setup).unwrap());
        if matches!(Self::try_new(kind, &port), Err(Refused::SwitchOffAndOn { .. })) {
            Self::switch_off_and_on(&port);
            // Of two boards the second is configured when the first is through.
            if matches!(Self::try_new(kind, &port), Err(Refused::SwitchOffAndOn { .. })) {
                Self::switch_off_and_on(&port);
            }
        }
        port
    }

    fn switch_off_and_on(port: &VirtualPort<Emulator>) {
        port.give("brown-out 200");
        port.wait(Span::from_secs(2.0));
    }

    fn try_new(kind: Kind, port: &VirtualPort<Emulator>) -> Result<Self, Refused> {
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
}
