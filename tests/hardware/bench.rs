//! A machine on a bench: how time passes for it, and how its link and its power are cut.

use std::time::Duration;

use covr_engine::machine::Limits;
use covr_engine::time::{Span, Time};
use covr_gantry::contract::{Gantry, Simulated};
use covr_gantry::ideal::IdealMachine;
use covr_gantry::sim::SimulatedMachine;
use covr_gantry::sim::faults::{Faults, LinkFault};
use covr_gantry::sim::parameters::MachineParameters;
use covr_tests::boards::{Boards, PARKED, TRAVEL};

/// One machine and its surroundings.
pub trait Bench {
    /// The machine.
    fn gantry(&mut self) -> &mut dyn Gantry;

    /// Its clock.
    fn now(&self) -> Time;

    /// Let so much time go by: virtual, or real.
    fn pass(&mut self, span: Span);

    /// Cut its link, or mend it; false where there is none to cut.
    fn cut(&mut self, _cut: bool) -> bool {
        false
    }

    /// Take its power away for a moment; false where that cannot be done.
    fn interrupt_power(&mut self) -> bool {
        false
    }
}

/// The simulated machine on virtual time.
pub struct SimulatedBench {
    machine: SimulatedMachine,
    now: Time,
}

impl SimulatedBench {
    pub fn new() -> Self {
        let parameters = MachineParameters { start: PARKED, ..MachineParameters::paper(TRAVEL) };
        Self { machine: SimulatedMachine::new(parameters).unwrap(), now: Time::from_micros(1_000_000) }
    }
}

impl Bench for SimulatedBench {
    fn gantry(&mut self) -> &mut dyn Gantry {
        &mut self.machine
    }

    fn now(&self) -> Time {
        self.now
    }

    fn pass(&mut self, span: Span) {
        self.now += span;
    }

    fn cut(&mut self, cut: bool) -> bool {
        let link = if cut { LinkFault::Dead } else { LinkFault::None };
        self.machine.set_faults(Faults { link, ..Faults::default() });
        true
    }
}

/// The ideal machine on virtual time.
pub struct Ideal {
    machine: IdealMachine,
    now: Time,
}

impl Ideal {
    pub fn new() -> Self {
        Self { machine: IdealMachine::new(Limits::PAPER, TRAVEL, PARKED), now: Time::from_micros(1_000_000) }
    }
}

impl Bench for Ideal {
    fn gantry(&mut self) -> &mut dyn Gantry {
        &mut self.machine
    }

    fn now(&self) -> Time {
        self.now
    }

    fn pass(&mut self, span: Span) {
        self.now += span;
    }
}

impl Bench for Boards {
    fn gantry(&mut self) -> &mut dyn Gantry {
        &mut self.machine
    }

    fn now(&self) -> Time {
        Boards::now(self)
    }

    fn pass(&mut self, span: Span) {
        std::thread::sleep(Duration::from_micros(span.micros() as u64));
    }

    fn cut(&mut self, cut: bool) -> bool {
        self.order(if cut { "unplug" } else { "plug" });
        true
    }

    fn interrupt_power(&mut self) -> bool {
        self.order("brown-out 100");
        true
    }
}
