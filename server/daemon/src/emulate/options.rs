//! The command line of `covr emulate roboclaw`.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum};
use covr_engine::frames::Floor;
use covr_engine::machine::Travel;
use covr_engine::time::Span;
use covr_gantry::roboclaw::emulator::firmware::Firmware;
use covr_gantry::roboclaw::emulator::orders::{ORDERS, Order};
use covr_gantry::roboclaw::emulator::setup::{Eeprom, EndSwitches, Setup, Wiring};
use covr_gantry::sim::parameters::MachineParameters;

/// RoboClaw boards on a pseudo-terminal, in front of the simulated motors.
#[derive(Debug, Clone, Args)]
#[command(after_help = orders_help(ORDERS))]
pub struct Roboclaw {
    /// Boards on the line: one with x on M1 and y on M2, or two with x on M1 of the first and y on M1 of the second.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=2))]
    pub boards: u8,
    /// Address of the first board; the second has the next.
    #[arg(long, default_value = "0x80", value_parser = address)]
    pub address: u8,
    /// Firmware: older (4.1.24), newer (4.2.8), 4.1.34, 4.3.6, or unknown, a version that nobody has seen.
    #[arg(long, default_value = "newer")]
    pub firmware: Firmware,
    /// Bits a second on the line, each way.
    #[arg(long, default_value_t = 115_200)]
    pub baud: u32,
    /// Replies arrive in bursts at multiples of so many milliseconds, as through a USB bridge (1 to 16 are usual).
    #[arg(long)]
    pub usb_latency_ms: Option<f64>,
    /// Ends of each axis that have a switch, on S4 for M1 and S5 for M2.
    #[arg(long, value_enum, default_value = "low")]
    pub end_switches: Switched,
    /// Constants of the velocity and position loops that tuning finds for these motors, in the EEPROM; else the factory's.
    #[arg(long)]
    pub tuned: bool,
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
    /// Press the e-stop button after so many seconds; short for --order "after SECONDS press".
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub e_stop_after: Option<Duration>,
    /// A symbolic link to the pseudo-terminal, for as long as it runs.
    #[arg(long)]
    pub link: Option<PathBuf>,
}

/// Which ends of an axis have a switch.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Switched {
    /// None: hard stops alone.
    None,
    /// The low end, 1 cm outside the travel.
    Low,
    /// Both, on one pin.
    Both,
}

impl Roboclaw {
    /// What to emulate.
    pub fn setup(&self) -> Setup {
        let [min_x, min_y, max_x, max_y] = self.travel;
        let travel = Travel { min: Floor::new(min_x, min_y), max: Floor::new(max_x, max_y) };
        let mut machine = MachineParameters::paper(travel);
        machine.load_kg = self.load;
        if let Some([x, y]) = self.start {
            machine.start = Floor::new(x, y);
        }
        let usb_latency = self.usb_latency_ms.map(|millis| Span::from_secs(millis * 1e-3));
        Setup {
            wiring: if self.boards == 2 { Wiring::TwoBoards } else { Wiring::OneBoard },
            firmware: self.firmware,
            address: self.address,
            baud: self.baud,
            usb_latency,
            end_switches: match self.end_switches {
                Switched::None => EndSwitches::None,
                Switched::Low => EndSwitches::Low,
                Switched::Both => EndSwitches::Both,
            },
            eeprom: if self.tuned { Eeprom::Tuned } else { Eeprom::Factory },
            seed: self.seed,
            ..Setup::paper(machine)
        }
    }

    /// What goes wrong from the beginning.
    pub fn orders(&self) -> impl Iterator<Item = Order> {
        let pressed = self
            .e_stop_after
            .map(|after| Order::After(Span::from_secs(after.as_secs_f64()), Box::new(Order::Press(true))));
        self.order.iter().cloned().chain(pressed)
    }
}

pub fn orders_help(orders: &str) -> String {
    format!(
        "Orders, as --order \"ORDER\" or a line each on standard input while it runs (answered by `done: ORDER`):\n\n{}\
         \nOn standard input also:\n\n\
         unplug               the cable is out: the pseudo-terminal and its link are gone\n\
         plug                 it is in again, with a new pseudo-terminal; its path is printed\n\
         show                 one line of JSON: what is true of each axis, what the controller does, and what went over the line\n",
        orders
    )
}

fn address(text: &str) -> Result<u8, String> {
    let number = match text.strip_prefix("0x") {
        Some(digits) => u8::from_str_radix(digits, 16),
        None => text.parse(),
    };
    number.map_err(|_| "expected 0x80 to 0x87".into())
}

pub fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let found: Result<Vec<f64>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    let found = found.ok().and_then(|found| <[f64; N]>::try_from(found).ok());
    found.ok_or_else(|| format!("expected {N} numbers with commas between them"))
}

fn seconds(text: &str) -> Result<Duration, String> {
    let found = text.parse().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    found.ok_or_else(|| "expected seconds, 0 or more".into())
}
