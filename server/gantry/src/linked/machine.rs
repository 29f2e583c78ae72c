//! The machine as the control thread sees it.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::thread::JoinHandle;

use arc_swap::ArcSwap;
use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{Drive, Homing, Limits, MachineReport, Travel, Trouble};
use covr_engine::safety::vetted::{Action, Vetted};
use covr_engine::time::{Span, Time};

use super::axes::Order;
use super::link::{LONGEST_START, Link, NO_ORDER, NotBegun, Session, Shared, State};
use crate::contract::{Gantry, Health, LinkError, NotTaken, Reading};

/// A machine whose controller is driven by a link thread.
pub struct Linked {
    name: &'static str,
    limits: Limits,
    travel: Travel,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

/// What is known of a machine before its controller is reached.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Machine {
    /// What people call it; its thread too.
    pub name: &'static str,
    /// What each axis may do.
    pub limits: Limits,
    /// Where the column's centre can stand, room frame.
    pub travel: Travel,
    /// Where the column is parked when the power comes on, room frame.
    pub parked: Floor,
    /// Longest time from one look to the next.
    pub period: Span,
}

impl Linked {
    /// Start its link thread, and wait a little until it has reached the controller. A machine that is not there yet is one that
    /// does not answer: it is tried again for as long as it takes.
    ///
    /// `open` reaches the controller; `clock` tells the server's time; `on_thread` is the first thing that the thread does, such as
    /// asking for its priority.
    pub(crate) fn start<S: Session>(
        machine: Machine,
        open: impl FnMut(Floor) -> Result<S, NotBegun<S::Refused>> + Send + 'static,
        clock: impl Fn() -> Time + Send + 'static,
        on_thread: impl FnOnce() + Send + 'static,
    ) -> std::io::Result<Self> {
        let report = MachineReport {
            answered_at: Time::ZERO,
            position: machine.parked,
            velocity: Planar::ZERO,
            current_amps: [0.0; 2],
            drive: Drive::Released,
            homing: Homing::NotHomed,
            home_repeatability_m: None,
            trouble: Some(Trouble::NoAnswer),
        };
        let state = State { report, answers: false, taken: Time::ZERO, health: Arc::default() };
        let shared = Arc::new(Shared {
            order: ArcSwap::from_pointee(NO_ORDER),
            state: ArcSwap::from_pointee(state),
            quit: AtomicBool::new(false),
            begun: (Mutex::new(false), Condvar::new()),
        });
        let Machine { name, limits, travel, period, .. } = machine;
        let link = Link { period, shared: shared.clone(), open, clock };
        let thread = std::thread::Builder::new().name(name.into()).spawn(move || {
            on_thread();
            link.run();
        })?;
        if let Ok(begun) = shared.begun.0.lock() {
            // Whether it was reached in time or not, the state says so.
            drop(shared.begun.1.wait_timeout_while(begun, LONGEST_START, |begun| !*begun));
        }
        Ok(Self { name, limits, travel, shared, thread: Some(thread) })
    }

    fn silence(&self, now: Time, state: &State) -> LinkError {
        LinkError::Silent { for_span: now - state.report.answered_at }
    }
}

impl Gantry for Linked {
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
        self.name
    }

    fn travel(&self) -> Travel {
        self.travel
    }

    fn limits(&self) -> Limits {
        self.limits
    }
}

impl Drop for Linked {
    /// The last order still goes out.
    fn drop(&mut self) {
        self.shared.quit.store(true, Ordering::Release);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            // A thread that panicked has nothing more to say; the controller's own dead-man stops it.
            drop(thread.join());
        }
    }
}
