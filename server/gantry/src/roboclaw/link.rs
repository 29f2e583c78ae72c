//! The link thread: it owns the port, opens it, brings the boards to where they can be driven, and drives them until they are
//! lost; then again from the beginning.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::time::{Duration, Instant};

use arc_swap::ArcSwap;
use covr_engine::machine::{MachineReport, Trouble};
use covr_engine::safety::vetted::Action;
use covr_engine::time::Time;

use super::board::Refused;
use super::driver::Order;
use super::exchange::Lost;
use super::figures::Figures;
use super::port::Port;
use super::session::Session;
use super::settings::Settings;
use crate::contract::Health;

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
    pub settings: Settings,
    pub shared: Arc<Shared>,
    pub open: O,
    pub clock: C,
}

/// Why the boards were lost.
#[derive(Debug, thiserror::Error)]
enum Ended {
    #[error("cannot open the port: {0}")]
    NoPort(std::io::Error),
    #[error(transparent)]
    Refused(#[from] Refused),
    #[error("no good answer for {} ms; the last: {last}", .after.as_millis())]
    Silent { after: Duration, last: Lost },
    #[error("a board has restarted, or its counts jumped: it is configured anew")]
    Restarted,
}

impl<P: Port, O: FnMut() -> std::io::Result<P>, C: Fn() -> Time> Link<O, C> {
    /// Until told to quit.
    pub fn run(mut self) {
        let mut figures = Figures::default();
        while !self.shared.quit.load(Ordering::Acquire) {
            let Err(why) = self.session(&mut figures) else { return };
            self.say_lost(&why, &mut figures);
            // Boards that do not answer yet may still be starting; whatever else is wrong stays so.
            if !matches!(why, Ended::Refused(Refused::Lost(_)) | Ended::Silent { .. }) {
                self.say_begun();
            }
            std::thread::park_timeout(RETRY);
        }
    }

    /// From opening the port until the boards are lost; well ended only when told to quit.
    fn session(&mut self, figures: &mut Figures) -> Result<(), Ended> {
        let port = (self.open)().map_err(Ended::NoPort)?;
        let stood_at = self.shared.state.load().report.position;
        let mut boards = Session::open(port, &self.settings, stood_at)?;
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
                Err(Refused::Lost(last @ Lost::Port(_))) => {
                    return Err(Ended::Silent { after: good_at.elapsed(), last });
                }
                Err(Refused::Lost(last)) if good_at.elapsed() < LONGEST_SILENCE => {
                    figures.lost(&last);
                }
                Err(Refused::Lost(last)) => return Err(Ended::Silent { after: good_at.elapsed(), last }),
                Err(refused) => return Err(refused.into()),
            }
            if is_last {
                return Ok(());
            }
            cycle += 1;
            if cycle.is_multiple_of(SLOW_EVERY) {
                slow_look(&mut boards, cycle / SLOW_EVERY, figures)?;
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

    fn say_lost(&self, why: &Ended, figures: &mut Figures) {
        let trouble = match why {
            Ended::NoPort(_) => Trouble::NoPort,
            Ended::Refused(Refused::Lost(_)) | Ended::Silent { .. } => Trouble::NoAnswer,
            Ended::Refused(Refused::UnknownFirmware { .. } | Refused::DifferentFirmwares(..)) => {
                Trouble::UnknownFirmware
            }
            Ended::Refused(Refused::NotKept { .. }) => Trouble::NotConfigured,
            Ended::Refused(Refused::SwitchOffAndOn { .. }) => Trouble::SwitchOffAndOn,
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
        let period = Duration::from_micros(self.settings.period.micros().max(0) as u64);
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

/// What changes slowly, one thing at a time.
fn slow_look<P: Port>(boards: &mut Session<P>, turn: u64, figures: &mut Figures) -> Result<(), Ended> {
    let board = boards.board();
    // A lost answer here is nothing to act on: the next turn asks again, and the fast looks watch the link.
    match turn % 3 {
        0 => figures.volts(board.main_volts().ok()),
        1 => figures.temperature(board.temperature_c().ok()),
        _ => {
            if matches!(board.keeps_its_timeout(), Ok(false)) {
                return Err(Ended::Restarted);
            }
        }
    }
    Ok(())
}

/// Boards that are gone are tried again so often.
const RETRY: Duration = Duration::from_millis(250);
/// Without a good look for so long the port is opened anew. R8 has stopped everything long before.
const LONGEST_SILENCE: Duration = Duration::from_millis(500);
/// One slow thing after so many cycles.
const SLOW_EVERY: u64 = 10;
/// What holds before the control thread's first order.
pub const NO_ORDER: Order = Order { vetted_at: Time::ZERO, action: Action::Release };
/// For whoever starts the machine: how long the first try may take.
pub const LONGEST_START: Duration = Duration::from_secs(3);
