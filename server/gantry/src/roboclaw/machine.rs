//! The machine as the control thread sees it.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::thread::JoinHandle;

use arc_swap::ArcSwap;
use covr_engine::frames::Planar;
use covr_engine::machine::{Drive, Homing, Limits, MachineReport, Travel, Trouble};
use covr_engine::safety::vetted::{Action, Vetted};
use covr_engine::time::Time;

use super::driver::Order;
use super::link::{LONGEST_START, Link, NO_ORDER, Shared, State};
use super::port::Serial;
use super::settings::Settings;
use crate::contract::{Gantry, Health, LinkError, NotTaken, Reading};

/// One or two RoboClaws on a serial line.
pub struct RoboClaw {
    limits: Limits,
    travel: Travel,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl RoboClaw {
    /// Start its link thread, and wait a little until it has reached the boards. A machine that is not there yet is one that does
    /// not answer: it is tried again for as long as it takes.
    ///
    /// `clock` tells the server's time; `on_thread` is the first thing that the thread does, such as asking for its priority.
    pub fn start(
        settings: Settings,
        clock: impl Fn() -> Time + Send + 'static,
        on_thread: impl FnOnce() + Send + 'static,
    ) -> std::io::Result<Self> {
        let report = MachineReport {
            answered_at: Time::ZERO,
            position: settings.parked,
            velocity: Planar::ZERO,
            current_amps: [0.0; 2],
            drive: Drive::Released,
            homing: Homing::NotHomed,
            trouble: Some(Trouble::NoAnswer),
        };
        let state = State { report, answers: false, taken: Time::ZERO, health: Arc::default() };
        let shared = Arc::new(Shared {
            order: ArcSwap::from_pointee(NO_ORDER),
            state: ArcSwap::from_pointee(state),
            quit: AtomicBool::new(false),
            begun: (Mutex::new(false), Condvar::new()),
        });
        let (limits, travel) = (settings.limits, settings.travel);
        let (port, baud): (PathBuf, u32) = (settings.port.clone(), settings.baud);
        let link = Link { settings, shared: shared.clone(), open: move || Serial::open(&port, baud), clock };
        let thread = std::thread::Builder::new().name("roboclaw".into()).spawn(move || {
            on_thread();
            link.run();
        })?;
        if let Ok(begun) = shared.begun.0.lock() {
            // Whether it was reached in time or not, the state says so.
            drop(shared.begun.1.wait_timeout_while(begun, LONGEST_START, |begun| !*begun));
        }
        Ok(Self { limits, travel, shared, thread: Some(thread) })
    }

    fn silence(&self, now: Time, state: &State) -> LinkError {
        LinkError::Silent { for_span: now - state.report.answered_at }
    }
}

impl Gantry for RoboClaw {
    fn read(&mut self, now: Time) -> Reading {
        let state = self.shared.state.load();
        let link = if state.answers { Ok(()) } else { Err(self.silence(now, &state)) };
        Reading { report: state.report, link }
    }

    fn write(&mut self, now: Time, command: &Vetted) -> Result<(), NotTaken> {
        let state = self.shared.state.load();
        let mut order = Order { vetted_at: command.at(), action: command.action() };
        let mut outcome = if state.answers { Ok(()) } else { Err(self.silence(now, &state).into()) };
        if let Action::Track(setpoint) = order.action {
            let is_finite = setpoint.position.is_finite()
                && setpoint.velocity.norm().is_finite()
                && setpoint.acceleration.norm().is_finite();
            if !is_finite {
                outcome = Err(NotTaken::NotFinite);
            } else if state.report.homing != Homing::Homed {
                outcome = Err(NotTaken::NotHomed);
            }
            if outcome.is_err() {
                order.action = Action::Hold;
            }
        }
        self.shared.order.store(Arc::new(order));
        if let Some(thread) = &self.thread {
            thread.thread().unpark();
        }
        outcome
    }

    fn taken(&self) -> Time {
        self.shared.state.load().taken
    }

    fn health(&self) -> Option<Arc<Health>> {
        Some(self.shared.state.load().health.clone())
    }

    fn name(&self) -> &str {
        "RoboClaw"
    }

    fn travel(&self) -> Travel {
        self.travel
    }

    fn limits(&self) -> Limits {
        self.limits
    }
}

impl Drop for RoboClaw {
    /// The last order still goes out.
    fn drop(&mut self) {
        self.shared.quit.store(true, Ordering::Release);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            // A thread that panicked has nothing more to say; the board's own timeout stops it.
            drop(thread.join());
        }
    }
}
