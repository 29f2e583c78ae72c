//! The driver against the emulated board, on virtual time.

mod faults;
mod motion;
mod switches;

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::Homing;
use covr_engine::safety::vetted::Action;
use covr_engine::time::Span;

use super::board::Refused;
use super::emulator::Emulator;
use super::emulator::setup::Setup;
use super::session::Session;
use super::settings::Settings;
use super::settings::tests::paper;
use crate::linked::bench::{VirtualPort, setpoint, travel};
use crate::linked::link::Session as _;
use crate::sim::parameters::MachineParameters;

/// A driver on its board.
type Bench = crate::linked::bench::Bench<Emulator, Session<VirtualPort<Emulator>>>;

impl Bench {
    fn world(setup: impl FnOnce(Setup) -> Setup, start: Floor) -> VirtualPort<Emulator> {
        let machine = MachineParameters { start, ..MachineParameters::paper(travel()) };
        VirtualPort::new(Emulator::new(setup(Setup::paper(machine))).unwrap())
    }

    fn try_new(settings: &Settings, port: &VirtualPort<Emulator>) -> Result<Self, Refused> {
        let session = Session::open(port.clone(), settings, Floor::new(1.0, 1.0))?;
        Ok(Self { port: port.clone(), session })
    }

    fn new(start: Floor) -> Self {
        Self::try_new(&paper(travel()), &Self::world(|setup| setup, start)).unwrap()
    }

    fn homed() -> Self {
        let mut bench = Self::new(Floor::new(0.4, 0.3));
        assert_eq!(bench.home(), Homing::Homed);
        bench
    }
}
