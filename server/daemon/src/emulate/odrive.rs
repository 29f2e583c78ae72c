//! The command line of `covr emulate odrive`.

use std::path::PathBuf;

use clap::Args;
use covr_engine::frames::Floor;
use covr_engine::machine::Travel;
use covr_engine::time::Span;
use covr_gantry::odrive::emulator::firmware::Firmware;
use covr_gantry::odrive::emulator::orders::{ORDERS, Order};
use covr_gantry::odrive::emulator::setup::Setup;
use covr_gantry::sim::parameters::MachineParameters;

use super::options::{numbers, orders_help};

/// An ODrive on a pseudo-terminal, in front of the simulated motors: x on axis0, y on axis1.
#[derive(Debug, Clone, Args)]
#[command(after_help = orders_help(ORDERS))]
pub struct Odrive {
    /// Firmware: 0.5.6, 0.5.5, 0.5.4, or one that is not driven: 0.5.1, or unknown, a version of newer boards.
    #[arg(long, default_value = "0.5.6")]
    pub firmware: Firmware,
    /// Answers arrive in bursts at multiples of so many milliseconds: USB has a frame each millisecond.
    #[arg(long, default_value_t = 1.0)]
    pub usb_latency_ms: f64,
    /// Motors and encoders have never been calibrated.
    #[arg(long)]
    pub uncalibrated: bool,
    /// Travel of the column: least x and y, greatest x and y, room frame, m.
    #[arg(long, value_name = "X,Y,X,Y", default_value = "0,0,4,4", value_parser = numbers::<4>)]
    pub travel: [f64; 4],
    /// Where the column stands when the power comes on, room frame, m; the middle of the travel when not given.
    #[arg(long, value_name = "X,Y", value_parser = numbers::<2>)]
    pub start: Option<[f64; 2]>,
    /// What hangs on the column beyond the moving masses, kg.
    #[arg(long, default_value_t = 0.0)]
    pub load: f64,
    /// Seed of what goes wrong by chance.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// An order to begin with; may be repeated.
    #[arg(long, value_name = "ORDER")]
    pub order: Vec<Order>,
    /// A symbolic link to the pseudo-terminal, for as long as it runs.
    #[arg(long)]
    pub link: Option<PathBuf>,
}

impl Odrive {
    /// What to emulate.
    pub fn setup(&self) -> Setup {
        let [min_x, min_y, max_x, max_y] = self.travel;
        let travel = Travel { min: Floor::new(min_x, min_y), max: Floor::new(max_x, max_y) };
        let mut machine = MachineParameters::paper(travel);
        machine.load_kg = self.load;
        if let Some([x, y]) = self.start {
            machine.start = Floor::new(x, y);
        }
        Setup {
            firmware: self.firmware,
            usb_latency: Span::from_secs(self.usb_latency_ms * 1e-3),
            is_calibrated: !self.uncalibrated,
            seed: self.seed,
            ..Setup::paper(machine)
        }
    }
}
