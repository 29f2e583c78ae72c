//! `covr emulate roboclaw` as a program: a real pseudo-terminal, orders on standard input, signals.

#![allow(clippy::unwrap_used, reason = "helpers of tests are outside #[test] functions")]

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, ErrorKind, Lines, Read, Write};
use std::os::fd::AsFd;
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Output, Stdio};
use std::time::{Duration, Instant};

use nix::libc::{O_NOCTTY, O_NONBLOCK};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use serde_json::Value;

/// A running emulator, killed when dropped.
struct Boards {
    child: Child,
    said: Lines<BufReader<ChildStdout>>,
    path: PathBuf,
}

impl Boards {
    fn start(args: &[&str]) -> Self {
        let mut child = command(args).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let said = BufReader::new(child.stdout.take().unwrap()).lines();
        let mut boards = Self { child, said, path: PathBuf::new() };
        boards.path = boards.plugged();
        boards
    }

    /// The path that it says next.
    fn plugged(&mut self) -> PathBuf {
        let line = self.said.next().unwrap().unwrap();
        line.strip_prefix("roboclaw emulator on ").expect(&line).into()
    }

    fn tell(&mut self, line: &str) {
        writeln!(self.child.stdin.as_mut().unwrap(), "{line}").unwrap();
    }

    fn order(&mut self, line: &str) {
        self.tell(line);
        assert_eq!(self.said.next().unwrap().unwrap(), format!("done: {line}"));
    }

    fn show(&mut self) -> Value {
        self.tell("show");
        serde_json::from_str(&self.said.next().unwrap().unwrap()).unwrap()
    }

    fn signal(&self, signal: Signal) {
        kill(Pid::from_raw(self.child.id().cast_signed()), signal).unwrap();
    }
}

impl Drop for Boards {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A line out, a line of an answer in.
fn line_exchange(port: &mut File, line: &str, count: usize) -> String {
    String::from_utf8(exchange(port, line.as_bytes(), count, LONG)).unwrap()
}

fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_covr"));
    command.args(["emulate", "roboclaw"]).args(args);
    command
}

fn refused(args: &[&str]) -> Output {
    command(args).stdin(Stdio::null()).output().unwrap()
}

fn open(path: &Path) -> File {
    OpenOptions::new().read(true).write(true).custom_flags(O_NOCTTY | O_NONBLOCK).open(path).unwrap()
}

/// So many bytes of an answer; fewer when no more come for `patience`.
fn exchange(port: &mut File, sent: &[u8], count: usize, patience: Duration) -> Vec<u8> {
    port.write_all(sent).unwrap();
    let deadline = Instant::now() + patience;
    let mut found = Vec::new();
    while found.len() < count {
        let left = PollTimeout::try_from(deadline.saturating_duration_since(Instant::now())).unwrap();
        if poll(&mut [PollFd::new(port.as_fd(), PollFlags::POLLIN)], left).unwrap() == 0 {
            break;
        }
        let mut bytes = [0; 64];
        match port.read(&mut bytes) {
            Ok(more) => found.extend(&bytes[..more]),
            Err(error) if error.kind() == ErrorKind::WouldBlock => {}
            Err(error) => panic!("{error}"),
        }
    }
    found
}

/// Long enough on any machine; a test that passes does not wait for it.
const LONG: Duration = Duration::from_secs(20);
/// The check words of these are in the golden tests of the emulator.
const SET_TIMEOUT: [u8; 5] = [0x80, 0x0E, 0x02, 0x38, 0x17];
const TIMEOUT: [u8; 3] = [0x02, 0x0B, 0x26];

#[test]
fn a_host_reads_the_version_and_the_encoders_through_a_pseudo_terminal() {
    let boards = Boards::start(&["--firmware", "4.1.34", "--baud", "460800"]);
    let mut port = open(&boards.path);
    let version = exchange(&mut port, &[0x80, 21], 30, LONG);
    assert!(version.starts_with(b"USB Roboclaw 2x15a v4.1.34\n\0"), "{version:02X?}");
    assert_eq!(version.len(), 30);
    assert_eq!(exchange(&mut port, &[0x80, 78], 10, LONG)[..8], [0; 8]);
}

#[test]
fn orders_come_on_standard_input_and_the_truth_goes_out() {
    let mut boards = Boards::start(&["--order", "after 3600 press", "--seed", "7", "--tuned"]);
    let mut port = open(&boards.path);
    assert_eq!(exchange(&mut port, &[0x80, 90], 6, LONG)[..4], [0, 0, 0, 0]);
    boards.order("press");
    let deadline = Instant::now() + LONG;
    while exchange(&mut port, &[0x80, 90], 6, LONG)[..4] != [0, 0, 0, 1] {
        assert!(Instant::now() < deadline);
    }
    let shown = boards.show();
    assert_eq!(shown["is_e_stopped"], true);
    assert_eq!((&shown["x"]["position_m"], &shown["y"]["position_m"]), (&2.0.into(), &2.0.into()));
    assert!(shown["packets"].as_u64().unwrap() >= 2);
    // A line that is no order changes nothing and ends nothing.
    boards.tell("explode");
    boards.order("brown-out 0");
    let deadline = Instant::now() + LONG;
    while boards.show()["starts"] != 2 {
        assert!(Instant::now() < deadline);
    }
}

#[test]
fn the_boards_stay_powered_when_the_host_closes_its_port() {
    let boards = Boards::start(&[]);
    let mut port = open(&boards.path);
    assert_eq!(exchange(&mut port, &SET_TIMEOUT, 1, LONG), [0xFF]);
    // An answer that nobody reads is for nobody.
    port.write_all(&[0x80, 21]).unwrap();
    drop(port);
    let mut port = open(&boards.path);
    let deadline = Instant::now() + LONG;
    loop {
        let found = exchange(&mut port, &[0x80, 15], 3, Duration::from_millis(50));
        if found == TIMEOUT {
            return;
        }
        assert!(Instant::now() < deadline, "{found:02X?}");
    }
}

#[test]
fn a_cable_can_be_out_and_in_again_and_the_link_follows() {
    let dir = tempfile::tempdir().unwrap();
    let link = dir.path().join("roboclaw");
    let mut boards = Boards::start(&["--link", link.to_str().unwrap()]);
    let mut port = open(&link);
    assert_eq!(exchange(&mut port, &SET_TIMEOUT, 1, LONG), [0xFF]);
    boards.order("unplug");
    assert!(!link.is_symlink());
    // The end of the file, or EIO.
    assert!(matches!(port.read(&mut [0; 8]), Ok(0) | Err(_)));
    assert!(port.write_all(&[0x80, 15]).is_err());
    boards.tell("plug");
    assert_eq!(boards.plugged(), std::fs::read_link(&link).unwrap());
    assert_eq!(exchange(&mut open(&link), &[0x80, 15], 3, LONG), TIMEOUT);
}

#[test]
fn a_signal_ends_it_well_and_the_link_is_gone() {
    for signal in [Signal::SIGINT, Signal::SIGTERM] {
        let dir = tempfile::tempdir().unwrap();
        let link = dir.path().join("roboclaw");
        let mut boards = Boards::start(&["--link", link.to_str().unwrap()]);
        boards.signal(signal);
        assert_eq!(boards.child.wait().unwrap().code(), Some(0), "{signal}");
        assert!(!link.is_symlink());
    }
}

#[test]
fn what_no_board_can_be_is_refused_by_name() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("file");
    std::fs::write(&file, "mine").unwrap();
    for (args, complaint) in [
        (["--baud", "100000"], "found 100000, expected 2400"),
        (["--address", "0x90"], "found 0x90, expected 0x80 to 0x87"),
        (["--address", "0x100"], "expected 0x80 to 0x87"),
        (["--firmware", "3"], "expected older, newer"),
        (["--order", "explode"], "expected lose, flip"),
        (["--usb-latency-ms", "0"], "found 0 microseconds"),
        (["--travel", "0,0,4"], "expected 4 numbers"),
        (["--start", "9,9"], "below the travel's high end"),
        (["--link", file.to_str().unwrap()], "found a file, expected a link or nothing"),
    ] {
        let output = refused(&args);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{args:?}: {said}");
        assert!(said.contains(complaint), "{args:?}: {said}");
    }
    assert_eq!(std::fs::read_to_string(file).unwrap(), "mine");
}

#[test]
fn the_help_tells_every_order() {
    let output = refused(&["--help"]);
    let said = String::from_utf8_lossy(&output.stdout);
    for order in ["brown-out MS", "after SECONDS ORDER", "unplug", "plug", "show", "stick LEVEL"] {
        assert!(said.contains(order), "{order}");
    }
}

#[test]
fn an_odrive_answers_through_a_pseudo_terminal_and_obeys_orders() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_covr"))
        .args(["emulate", "odrive", "--firmware", "0.5.5", "--seed", "7"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let said = BufReader::new(child.stdout.take().unwrap()).lines();
    let mut boards = Boards { child, said, path: PathBuf::new() };
    let line = boards.said.next().unwrap().unwrap();
    boards.path = line.strip_prefix("odrive emulator on ").expect(&line).into();
    let mut port = open(&boards.path);
    assert_eq!(line_exchange(&mut port, "r fw_version_revision\n", 3), "5\r\n");
    assert_eq!(line_exchange(&mut port, "r vbus_voltage *93\n", 14), "24.000000*40\r\n");
    boards.order("error x encoder");
    assert_eq!(line_exchange(&mut port, "r axis0.error\n", 5), "256\r\n");
    assert_eq!(boards.show()["is_x_on"], false);
    // A line that is no order changes nothing and ends nothing.
    boards.tell("press");
    boards.order("supply 22");
}
