//! The emulator's clock: it waits for bytes, orders, signals and the next moment at which the line carries something.

use std::io::{Read, Write};
use std::os::fd::AsFd;
use std::path::Path;
use std::time::{Duration, Instant};

use covr_engine::time::{Span, Time};
use covr_gantry::emulation::{Axis, Emulated};
use nix::errno::Errno;
use nix::poll::{PollFd, PollFlags, ppoll};
use nix::sys::prctl::set_timerslack;
use nix::sys::signal::{SigSet, Signal};
use nix::sys::signalfd::{SfdFlags, SignalFd};
use nix::sys::time::TimeSpec;
use serde_json::{Value, json};

use crate::control::real_time;

use super::port::Port;

/// What is emulated, and where.
pub struct Start<'a, E: Emulated> {
    /// What it is called where its path is said.
    pub name: &'static str,
    /// The controller.
    pub emulator: E,
    /// What goes wrong from the beginning.
    pub orders: Vec<E::Order>,
    /// A symbolic link to the pseudo-terminal, for as long as it runs.
    pub link: Option<&'a Path>,
}

/// Until SIGINT or SIGTERM.
pub fn run<E: Emulated>(start: Start<'_, E>) -> anyhow::Result<()> {
    let mut ends = SigSet::empty();
    ends.add(Signal::SIGINT);
    ends.add(Signal::SIGTERM);
    ends.thread_block()?;
    let signals = SignalFd::with_flags(&ends, SfdFlags::SFD_NONBLOCK | SfdFlags::SFD_CLOEXEC)?;
    // The kernel's usual 50 microseconds would be half a byte at 115200 baud.
    set_timerslack(TIMER_SLACK_NANOS)?;
    let mut session = Session::new(start)?;
    // A board has a processor of its own.
    let came_of_it = real_time::ask(Some(PRIORITY));
    tracing::debug!(?came_of_it, "the boards' scheduling");
    while signals.read_signal()?.is_none() {
        session.wait(&signals)?;
        session.carry()?;
    }
    Ok(())
}

struct Session<'a, E> {
    name: &'static str,
    link: Option<&'a Path>,
    emulator: E,
    /// None while the cable is out.
    port: Option<Port>,
    began: Instant,
    /// What has come of the next order; none when standard input has ended.
    line: Option<Vec<u8>>,
    woke_at: Time,
}

impl<'a, E: Emulated> Session<'a, E> {
    fn new(start: Start<'a, E>) -> anyhow::Result<Self> {
        let Start { name, emulator, orders, link } = start;
        let (began, line) = (Instant::now(), Some(Vec::new()));
        let mut session = Self { name, link, emulator, port: None, began, line, woke_at: Time::ZERO };
        for order in orders {
            session.emulator.give(session.now(), order);
        }
        session.plug()?;
        Ok(session)
    }

    fn wait(&mut self, signals: &SignalFd) -> anyhow::Result<()> {
        let is_open = self.port.as_mut().map_or(Ok(false), Port::look)?;
        let stdin = std::io::stdin();
        let mut fds = vec![PollFd::new(signals.as_fd(), PollFlags::POLLIN)];
        if self.line.is_some() {
            fds.push(PollFd::new(stdin.as_fd(), PollFlags::POLLIN));
        }
        let has_room = self.emulator.backlog() < FULL_LINE_BYTES;
        if let Some(port) = self.port.as_ref().filter(|_| is_open && has_room) {
            fds.push(PollFd::new(port.fd(), PollFlags::POLLIN));
        }
        let longest = if self.port.is_some() && !is_open { LOOK_FOR_OPENER_EVERY } else { LONGEST_WAIT };
        let now = self.now();
        // Not for each byte of a fast line by itself.
        let due = self.emulator.next_due().map(|due| due.max(self.woke_at + LEAST_WAIT) - now);
        let wait = due.map_or(longest, |due| longest.min(Duration::from_micros(due.micros().max(0) as u64)));
        match ppoll(&mut fds, Some(TimeSpec::from_duration(wait)), None) {
            Ok(_) | Err(Errno::EINTR) => {}
            Err(error) => return Err(error.into()),
        }
        let has_orders = self.line.is_some()
            && fds[1]
                .revents()
                .is_some_and(|events| events.intersects(PollFlags::POLLIN | PollFlags::POLLHUP));
        drop(fds);
        if has_orders {
            self.hear_orders()?;
        }
        Ok(())
    }

    /// Bytes both ways.
    fn carry(&mut self) -> anyhow::Result<()> {
        let now = self.now();
        self.woke_at = now;
        if self.emulator.backlog() < FULL_LINE_BYTES
            && let Some(port) = &mut self.port
        {
            let mut bytes = [0; 1024];
            let count = port.read(&mut bytes)?;
            self.emulator.receive(now, &bytes[..count]);
        }
        let bytes = self.emulator.poll(now);
        if let Some(port) = self.port.as_mut().filter(|_| !bytes.is_empty()) {
            port.write(&bytes)?;
        }
        Ok(())
    }

    fn hear_orders(&mut self) -> anyhow::Result<()> {
        let mut bytes = [0; 1024];
        let count = std::io::stdin().lock().read(&mut bytes)?;
        if count == 0 {
            self.line = None;
            return Ok(());
        }
        for byte in &bytes[..count] {
            let Some(line) = &mut self.line else { break };
            if *byte != b'\n' {
                line.push(*byte);
                continue;
            }
            let line = String::from_utf8_lossy(&std::mem::take(line)).trim().to_owned();
            if !line.is_empty() {
                self.obey(&line)?;
            }
        }
        Ok(())
    }

    fn obey(&mut self, line: &str) -> anyhow::Result<()> {
        let now = self.now();
        match line {
            "unplug" => {
                self.port = None;
                self.emulator.unplug(now);
            }
            "plug" if self.port.is_none() => self.plug()?,
            "plug" => {}
            "show" => return say(&self.shown(now)),
            line => match line.parse::<E::Order>() {
                Ok(order) => self.emulator.give(now, order),
                Err(refused) => {
                    // With standard error closed there is nobody to tell.
                    let _ = writeln!(std::io::stderr().lock(), "covr: {refused}");
                    return Ok(());
                }
            },
        }
        say(&format!("done: {line}"))
    }

    fn plug(&mut self) -> anyhow::Result<()> {
        let port = Port::new(self.link)?;
        say(&format!("{} emulator on {}", self.name, port.path().display()))?;
        self.port = Some(port);
        Ok(())
    }

    fn shown(&mut self, now: Time) -> String {
        // Up to now; what has arrived is for the host all the same.
        let bytes = self.emulator.poll(now);
        if let Some(port) = self.port.as_mut().filter(|_| !bytes.is_empty()) {
            // The next write will say what is wrong with it.
            let _ = port.write(&bytes);
        }
        let axis = |axis| {
            let truth = self.emulator.truth(axis);
            json!({
                "position_m": truth.position_m,
                "speed_mps": truth.speed_mps,
                "amps": truth.amps,
                "counts": truth.counts,
                "is_switch_active": truth.is_switch_active,
            })
        };
        let traffic = self.emulator.traffic();
        let mut shown = json!({
            "x": axis(Axis::X),
            "y": axis(Axis::Y),
            "bytes_in": traffic.bytes_in,
            "bytes_out": traffic.bytes_out,
            "packets": traffic.packets,
            "starts": traffic.starts,
            "seconds": now.secs(),
        });
        for (name, is_so) in self.emulator.flags() {
            shown[name] = Value::Bool(is_so);
        }
        shown.to_string()
    }

    fn now(&self) -> Time {
        Time::from_micros(self.began.elapsed().as_micros() as i64)
    }
}

fn say(line: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{line}")?;
    Ok(out.flush()?)
}

/// The machine is brought up to date at least so often.
/// Above the server's control thread.
const PRIORITY: u8 = 70;
const LONGEST_WAIT: Duration = Duration::from_millis(20);
/// Nothing tells the holder of a pseudo-terminal that somebody has opened it, so it is looked at.
const LOOK_FOR_OPENER_EVERY: Duration = Duration::from_millis(1);
/// A byte at 115200 baud takes 87 microseconds, one at 460800 22.
const LEAST_WAIT: Span = Span::from_micros(50);
const TIMER_SLACK_NANOS: u64 = 1_000;
/// A host that is so far ahead of the line waits.
const FULL_LINE_BYTES: usize = 4_096;
