//! The hand that jogs the column: one dashboard's at a time, for as long as its orders come (hold-to-run).
//!
//! The engine ends a jog by itself when no order comes; here is only whose orders are passed on, in the order in which they came.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use covr_engine::motion::jog::JogOrder;
use covr_engine::safety::parameters::Parameters;
use covr_engine::{Answer, Request};
use covr_wire::reason::Reason;
use tokio::sync::oneshot;

use crate::control::{Control, NotDelivered};

/// Whose hand it is.
#[derive(Debug, Default)]
pub struct Hand(Mutex<Option<Held>>);

#[derive(Debug)]
struct Held {
    socket: u64,
    author: String,
    until: Instant,
}

/// An order on its way to the control thread.
#[derive(Debug)]
pub struct Ordered {
    /// The engine's answer.
    pub answer: oneshot::Receiver<Answer>,
    /// This order took the hand: nobody's, or this socket's from a while ago, before.
    pub taken: bool,
}

impl Hand {
    /// Pass on an order of this socket; none: it lets go. Refused while the hand is somebody else's.
    pub fn order(
        &self,
        control: &Control,
        socket: u64,
        author: &str,
        order: Option<JogOrder>,
    ) -> Result<Ordered, Reason> {
        let mut held = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let now = Instant::now();
        let current = held.as_ref().filter(|held| now < held.until);
        if let Some(other) = current.filter(|held| held.socket != socket) {
            return Err(Reason::JogHeldBy { author: other.author.clone() });
        }
        let taken = current.is_none() && order.is_some();
        let answer = control.put(order.map_or(Request::LetGo, Request::Jog)).map_err(NotDelivered::reason)?;
        *held = order.map(|_| Held { socket, author: author.to_owned(), until: now + good_for() });
        Ok(Ordered { answer, taken })
    }

    /// This socket is gone: its hand with it.
    pub fn gone(&self, control: &Control, socket: u64) {
        let is_its = |held: &Held| held.socket == socket;
        if self.0.lock().unwrap_or_else(PoisonError::into_inner).as_ref().is_some_and(is_its) {
            // What cannot be delivered ends by itself: no order follows.
            let _ = self.order(control, socket, "", None);
        }
    }
}

/// How long an order is good for.
fn good_for() -> Duration {
    Duration::from_secs_f64(Parameters::new(1.6).hold_to_run.secs())
}
