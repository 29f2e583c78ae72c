//! The link thread: it owns the port, opens it, brings the boards to where they can be driven, and drives them until they are
//! lost; then again from the beginning.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::time::{Duration, Instant};

use arc_swap::ArcSwap;
use covr_engine::frames::Floor;
use covr_engine::machine::{MachineReport, Trouble};
use covr_engine::safety::vetted::Action;
use covr_engine::time::{Span, Time};

use super::axes::Order;
use super::figures::{Figures, Tally};
use crate::contract::Health;

/// Controllers from being found until they are lost.
pub trait Session {
    /// Why they are not driven.
    type Refused: Refusal;

    /// Tell them what the order means, then look. Whether they confirmed that they have it.
    fn cycle(&mut self, order: &Order, clock: &dyn Fn() -> Time) -> Result<bool, Self::Refused>;

    /// Look at what changes slowly, one thing a turn, in one try: what is lost here is asked for again in a later turn, and a command
    /// may be waiting. Whether they still have the settings that they were given.
    fn slow_look(&mut self, turn: u64, figures: &mut Figures) -> bool;

    /// What the machine says of itself.
    fn report(&self) -> MachineReport;

    /// Its place is lost and it is let go: it is to be found and configured anew.
    fn is_over(&self) -> bool;

    /// The firmware's own words, and the profile's name.
    fn firmware(&self) -> (&str, &str);

    /// What the line has been like.
    fn tally(&self) -> Tally;
}

/// Why a controller is not driven, as far as the link has to know.
pub trait Refusal: std::error::Error {
    /// What it is called on every surface.
    fn trouble(&self) -> Trouble;

    /// An exchange that was lost, if it is one: another may go well.
    fn loss(&self) -> Option<Loss>;
}

/// How an exchange was lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Loss {
    /// There was no good answer.
    Answer,
    /// The port is gone.
    Port,
}

/// Why no session began.
#[derive(Debug, thiserror::Error)]
pub enum NotBegun<R: std::error::Error> {
    /// There is no such port.
    #[error("cannot open the port: {0}")]
    NoPort(std::io::Error),
    /// There is, and whoever is there is not driven.
    #[error(transparent)]
    Refused(R),
}

/// What control thread and link thread share. Neither ever waits for the other.
pub struct Shared {
    /// The newest order.
    pub order: ArcSwap<Order>,
    /// The newest state.
    pub state: ArcSwap<State>,
    /// The thread is to end after one more order.
    pub quit: AtomicBool,
    /// Whether the boards were reached or cannot be, for whoever starts the machine.
    pub begun: (Mutex<bool>, Condvar),
}

/// What the link thread last knew.
#[derive(Debug, Clone)]
pub struct State {
    pub report: MachineReport,
    /// The boards answer.
    pub answers: bool,
    /// When the newest order was vetted that the boards have acknowledged.
    pub taken: Time,
    pub health: Arc<Health>,
}

/// The thread's own.
pub struct Link<O, C> {
    /// Longest time from one look to the next.
    pub period: Span,
    pub shared: Arc<Shared>,
    /// Open the port and bring what is there to where it can be driven; the column stands there, as far as known.
    pub open: O,
    pub clock: C,
}

/// Why the boards were lost.
#[derive(Debug, thiserror::Error)]
enum Ended<R: std::error::Error> {
    #[error(transparent)]
    NotBegun(#[from] NotBegun<R>),
    #[error("no good answer for {} ms; the last: {last}", .after.as_millis())]
    Silent { after: Duration, last: R },
    #[error(
        "the controller has restarted, its count jumped, or it had let a motor go: it is configured anew"
    )]
    Restarted,
}

impl<S: Session, O: FnMut(Floor) -> Result<S, NotBegun<S::Refused>>, C: Fn() -> Time> Link<O, C> {
    /// Until told to quit.
    pub fn run(mut self) {
        let mut figures = Figures::default();
        while !self.shared.quit.load(Ordering::Acquire) {
            let Err(why) = self.session(&mut figures) else { return };
            self.say_lost(&why, &mut figures);
            // Boards that do not answer yet may still be starting; whatever else is wrong stays so.
            let may_be_starting = match &why {
                Ended::NotBegun(NotBegun::Refused(why)) => why.loss().is_some(),
                Ended::Silent { .. } => true,
                Ended::NotBegun(NotBegun::NoPort(_)) | Ended::Restarted => false,
            };
            if !may_be_starting {
                self.say_begun();
            }
            std::thread::park_timeout(RETRY);
        }
    }

    /// From opening the port until the boards are lost; well ended only when told to quit.
    fn session(&mut self, figures: &mut Figures) -> Result<(), Ended<S::Refused>> {
        let stood_at = self.shared.state.load().report.position;
        let mut boards = (self.open)(stood_at)?;
        figures.found(boards.firmware());
        let mut good_at = Instant::now();
        let mut cycle = 0_u64;
        loop {
            let is_last = self.shared.quit.load(Ordering::Acquire);
            let order = self.shared.order.load_full();
            let begun = Instant::now();
            match boards.cycle(&order, &self.clock) {
                Ok(taken) => {
                    good_at = Instant::now();
                    figures.cycle(begun, good_at, boards.tally());
                    self.publish(boards.report(), taken.then_some(order.vetted_at), figures);
                    self.say_begun();
                    if boards.is_over() {
                        return Err(Ended::Restarted);
                    }
                }
                Err(refused) => match refused.loss() {
                    Some(Loss::Answer) if good_at.elapsed() < LONGEST_SILENCE => {
                        figures.lost(refused.to_string());
                    }
                    Some(_) => return Err(Ended::Silent { after: good_at.elapsed(), last: refused }),
                    None => return Err(NotBegun::Refused(refused).into()),
                },
            }
            if is_last {
                return Ok(());
            }
            cycle += 1;
            if cycle.is_multiple_of(SLOW_EVERY) && !boards.slow_look(cycle / SLOW_EVERY, figures) {
                return Err(Ended::Restarted);
            }
            self.wait_for_news(&order, begun);
        }
    }

    fn publish(&self, report: MachineReport, taken: Option<Time>, figures: &mut Figures) {
        let before = self.shared.state.load();
        let state = State {
            report,
            answers: true,
            taken: taken.unwrap_or(before.taken),
            health: figures.health(report.trouble),
        };
        self.shared.state.store(Arc::new(state));
    }

    fn say_lost(&self, why: &Ended<S::Refused>, figures: &mut Figures) {
        let trouble = match why {
            Ended::NotBegun(NotBegun::NoPort(_)) => Trouble::NoPort,
            Ended::NotBegun(NotBegun::Refused(why)) => why.trouble(),
            Ended::Silent { .. } => Trouble::NoAnswer,
            Ended::Restarted => Trouble::Restarted,
        };
        figures.ended(why.to_string());
        let before = self.shared.state.load();
        let report = MachineReport { trouble: Some(trouble), ..before.report };
        let health = figures.health(Some(trouble));
        self.shared.state.store(Arc::new(State { report, answers: false, taken: before.taken, health }));
    }

    fn say_begun(&self) {
        if let Ok(mut begun) = self.shared.begun.0.lock()
            && !*begun
        {
            *begun = true;
            self.shared.begun.1.notify_all();
        }
    }

    /// Until there is another order, or the period is over. The control thread wakes this one with each order.
    fn wait_for_news(&self, order: &Arc<Order>, begun: Instant) {
        let period = Duration::from_micros(self.period.micros().max(0) as u64);
        loop {
            let left = period.saturating_sub(begun.elapsed());
            let is_news = !Arc::ptr_eq(order, &self.shared.order.load());
            if left.is_zero() || is_news || self.shared.quit.load(Ordering::Acquire) {
                return;
            }
            std::thread::park_timeout(left);
        }
    }
}

/// Boards that are gone are tried again so often.
const RETRY: Duration = Duration::from_millis(250);
/// Without a good look for so long the port is opened anew. R8 has stopped everything long before.
pub const LONGEST_SILENCE: Duration = Duration::from_millis(500);
/// One slow thing after so many cycles.
const SLOW_EVERY: u64 = 10;
/// What holds before the control thread's first order.
pub const NO_ORDER: Order = Order { vetted_at: Time::ZERO, action: Action::Release };
/// For whoever starts the machine: how long the first try may take.
pub const LONGEST_START: Duration = Duration::from_secs(3);
