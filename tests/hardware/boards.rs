//! RoboClaw boards of `covr emulate roboclaw`, a process of its own, over a real pseudo-terminal on the real clock.

use std::io::Write;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::time::{Duration, Instant};

use covr_engine::time::{Span, Time};
use covr_gantry::contract::Gantry;
use covr_gantry::roboclaw::RoboClaw;
use covr_gantry::roboclaw::settings::HomeBy;
use covr_server::config::Config;
use covr_tests::process::program;
use tempfile::TempDir;

use super::bench::{Bench, PARKED, TRAVEL};

/// Emulated boards, and the driver at the other end of the line.
pub struct Boards {
    // Before the emulator: its last word still goes out.
    machine: RoboClaw,
    emulator: Child,
    orders: ChildStdin,
    began: Instant,
    _dir: TempDir,
}

impl Boards {
    pub fn emulated(options: &[&str], baud: usize, second_address: usize) -> Self {
        let dir = tempfile::tempdir().unwrap();
        let port = dir.path().join("boards");
        let corner = |at: covr_engine::frames::Floor| format!("{},{}", at.x, at.y);
        let mut emulator = Command::new(program())
            .args(["emulate", "roboclaw", "--tuned", "--end-switches", "none", "--baud", &baud.to_string()])
            .args(["--travel", &format!("{},{}", corner(TRAVEL.min), corner(TRAVEL.max))])
            .args(["--start", &corner(PARKED), "--link"])
            .arg(&port)
            .args(options)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let orders = emulator.stdin.take().unwrap();
        let mut config = Config::default();
        config.machine.travel_m = [TRAVEL.min.x, TRAVEL.min.y, TRAVEL.max.x, TRAVEL.max.y];
        (config.machine.parked_x_m, config.machine.parked_y_m) = (PARKED.x, PARKED.y);
        let boards = &mut config.machine.roboclaw;
        boards.port = port;
        boards.baud = baud;
        boards.second_address = second_address;
        boards.current_limit_amps = 7.0;
        boards.home_by = HomeBy::Stops;
        boards.homing.switch_outside_m = 0.03;
        let settings = config.machine.roboclaw.settings(&config);
        let began = Instant::now();
        let machine = RoboClaw::start(settings, move || since(began), || ()).unwrap();
        Self { machine, emulator, orders, began, _dir: dir }
    }

    fn order(&mut self, order: &str) {
        writeln!(self.orders, "{order}").unwrap();
    }
}

impl Bench for Boards {
    fn gantry(&mut self) -> &mut dyn Gantry {
        &mut self.machine
    }

    fn now(&self) -> Time {
        since(self.began)
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

impl Drop for Boards {
    fn drop(&mut self) {
        // Already gone is gone.
        let _ = self.emulator.kill();
        let _ = self.emulator.wait();
    }
}

fn since(began: Instant) -> Time {
    Time::from_micros(1_000_000 + began.elapsed().as_micros() as i64)
}
