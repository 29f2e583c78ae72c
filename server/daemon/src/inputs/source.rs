//! Where an input's words come from: a line protocol on a serial port, a pseudo-terminal or a FIFO; or a GPIO's value file.

use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, IsTerminal, Read};
use std::os::fd::AsFd;
use std::os::unix::fs::OpenOptionsExt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use nix::libc::{O_NOCTTY, O_NONBLOCK};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::termios::{BaudRate, ControlFlags, SetArg, cfmakeraw, cfsetspeed, tcgetattr, tcsetattr};

use super::lane::{Lane, Seen};
use crate::clock::Clock;
use crate::config::{Input, Level};

/// Follows one input until it is told to end.
pub struct Follower {
    pub input: Input,
    pub lane: Arc<Lane>,
    pub clock: Clock,
    pub quit: Arc<AtomicBool>,
}

impl Follower {
    pub fn run(self) {
        let (input, source) = (&self.input.name, self.input.source.display());
        let mut complaint = String::new();
        while !self.quit.load(Ordering::Acquire) {
            let lost = self.follow().err();
            self.lane.lose(self.clock.now());
            let why = lost.map_or_else(|| "the line is cut".to_owned(), |error| error.to_string());
            if why != complaint && !self.quit.load(Ordering::Acquire) {
                tracing::warn!(input, %source, why, "a digital input is lost; it counts as active");
                complaint = why;
            }
            std::thread::sleep(REOPEN_EVERY);
        }
    }

    /// Read until the source ends.
    fn follow(&self) -> std::io::Result<()> {
        let file =
            OpenOptions::new().read(true).custom_flags(O_NONBLOCK | O_NOCTTY).open(&self.input.source)?;
        if file.metadata()?.is_file() {
            return self.follow_value();
        }
        if file.is_terminal() {
            make_raw(&file)?;
        }
        self.follow_lines(file)
    }

    /// A value file is the level itself; a read that succeeds is its heartbeat.
    fn follow_value(&self) -> std::io::Result<()> {
        while !self.quit.load(Ordering::Acquire) {
            let mut text = Vec::new();
            File::open(&self.input.source)?.take(LONGEST_WORD as u64).read_to_end(&mut text)?;
            self.hear(&text);
            std::thread::sleep(LOOK_AT_VALUE_EVERY);
        }
        Ok(())
    }

    fn follow_lines(&self, mut file: File) -> std::io::Result<()> {
        let mut word = Vec::new();
        let mut bytes = [0; 256];
        while !self.quit.load(Ordering::Acquire) {
            poll(
                &mut [PollFd::new(file.as_fd(), PollFlags::POLLIN)],
                PollTimeout::from(LOOK_AT_QUIT_EVERY_MILLIS),
            )?;
            let count = match file.read(&mut bytes) {
                Ok(0) => return Ok(()),
                Ok(count) => count,
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {
                    continue;
                }
                Err(error) => return Err(error),
            };
            for byte in &bytes[..count] {
                match byte {
                    b'\n' => {
                        if !word.trim_ascii().is_empty() {
                            self.hear(&word);
                        }
                        word.clear();
                    }
                    _ if word.len() < LONGEST_WORD => word.push(*byte),
                    _ => self.lane.lose(self.clock.now()),
                }
            }
        }
        Ok(())
    }

    fn hear(&self, word: &[u8]) {
        let level = match word.trim_ascii() {
            b"0" => Level::Low,
            b"1" => Level::High,
            _ => return self.lane.lose(self.clock.now()),
        };
        let now = self.clock.now();
        let active = level == self.input.active;
        if (self.lane.look(now) == Seen::Active) != active {
            tracing::info!(input = self.input.name, active, "a digital input changed");
        }
        self.lane.say(active, now);
    }
}

/// 115200 baud, 8N1, no echo, no flow control, no modem lines.
fn make_raw(port: &File) -> std::io::Result<()> {
    let mut settings = tcgetattr(port)?;
    cfmakeraw(&mut settings);
    settings.control_flags |= ControlFlags::CLOCAL | ControlFlags::CREAD;
    cfsetspeed(&mut settings, BaudRate::B115200)?;
    tcsetattr(port, SetArg::TCSANOW, &settings)?;
    Ok(())
}

/// A source that is gone makes no event when it is back: it is tried so often, on this input's own thread.
const REOPEN_EVERY: Duration = Duration::from_millis(50);
/// A value file is polled: only some GPIO drivers tell of an edge, and a look that succeeds is the heartbeat.
const LOOK_AT_VALUE_EVERY: Duration = Duration::from_millis(2);
const LOOK_AT_QUIT_EVERY_MILLIS: u8 = 50;
/// A longer one is no word.
const LONGEST_WORD: usize = 16;
