//! A controller of `covr emulate`, a process of its own, over a real pseudo-terminal on the real clock.

use std::io::Write;
use std::path::PathBuf;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::time::Instant;

use covr_engine::frames::Floor;
use covr_engine::machine::Travel;
use covr_engine::time::Time;
use covr_gantry::homing::HomeBy;
use covr_gantry::linked::machine::Linked;
use covr_gantry::{odrive, roboclaw};
use covr_server::config::Config;
use tempfile::TempDir;

use crate::process::program;

/// An emulated controller, and the driver at the other end of the line.
pub struct Boards {
    // Before the emulator: its last word still goes out.
    /// The driver.
    pub machine: Linked,
    emulator: Child,
    orders: ChildStdin,
    began: Instant,
    _dir: TempDir,
}

impl Boards {
    /// RoboClaw boards with these options of the emulator on a line of this rate; with a second address there are two.
    pub fn emulated(options: &[&str], baud: usize, second_address: usize) -> Self {
        let baud_option = baud.to_string();
        let usual = ["--tuned", "--end-switches", "none", "--baud", &baud_option];
        Self::start("roboclaw", &[&usual, options].concat(), |port, began| {
            let mut config = config();
            let boards = &mut config.machine.roboclaw;
            boards.port = port;
            boards.baud = baud;
            boards.second_address = second_address;
            boards.current_limit_amps = 7.0;
            boards.home_by = HomeBy::Stops;
            boards.homing.switch_outside_m = 0.03;
            roboclaw::start(boards.clone().settings(&config), move || since(began), || ()).unwrap()
        })
    }

    /// An ODrive with these options of the emulator.
    pub fn odrive(options: &[&str]) -> Self {
        Self::start("odrive", options, |port, began| {
            let mut config = config();
            let board = &mut config.machine.odrive;
            board.port = port;
            board.current_limit_amps = 7.0;
            odrive::start(board.clone().settings(&config), move || since(began), || ()).unwrap()
        })
    }

    fn start(what: &str, options: &[&str], driver: impl FnOnce(PathBuf, Instant) -> Linked) -> Self {
        let dir = tempfile::tempdir().unwrap();
        let port = dir.path().join("boards");
        let corner = |at: Floor| format!("{},{}", at.x, at.y);
        let mut emulator = Command::new(program())
            .args(["emulate", what])
            .args(["--travel", &format!("{},{}", corner(TRAVEL.min), corner(TRAVEL.max))])
            .args(["--start", &corner(PARKED), "--link"])
            .arg(&port)
            .args(options)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let orders = emulator.stdin.take().unwrap();
        let began = Instant::now();
        let machine = driver(port, began);
        Self { machine, emulator, orders, began, _dir: dir }
    }

    /// Give the emulator an order, as on its standard input.
    pub fn order(&mut self, order: &str) {
        writeln!(self.orders, "{order}").unwrap();
    }
}

impl Boards {
    /// The driver's clock.
    pub fn now(&self) -> Time {
        since(self.began)
    }
}

impl Drop for Boards {
    fn drop(&mut self) {
        // Already gone is gone.
        let _ = self.emulator.kill();
        let _ = self.emulator.wait();
    }
}

fn config() -> Config {
    let mut config = Config::default();
    config.machine.travel_m = [TRAVEL.min.x, TRAVEL.min.y, TRAVEL.max.x, TRAVEL.max.y];
    (config.machine.parked_x_m, config.machine.parked_y_m) = (PARKED.x, PARKED.y);
    config
}

fn since(began: Instant) -> Time {
    Time::from_micros(1_000_000 + began.elapsed().as_micros() as i64)
}

/// A metre by a metre, so that homing is short.
pub const TRAVEL: Travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(1.0, 1.0) };
/// Where the column is parked.
pub const PARKED: Floor = Floor::new(0.3, 0.2);
