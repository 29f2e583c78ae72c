//! Whether a game master is at a dashboard (R11): somebody who may arm, whose page still answers. A page whose cable was
//! cut looks connected for minutes; one that answers no ping is not there.

use std::time::{Duration, Instant};

use tokio::sync::watch;
use tokio::time::MissedTickBehavior;

use crate::access::Caller;
use crate::app::App;

/// Keep the game master's seat while this caller may arm and was heard of late. Never ends.
pub async fn attend(app: &App, caller: &Caller, heard: &watch::Receiver<Instant>) {
    let mut seat = None;
    let mut due = tokio::time::interval(LOOK_EVERY);
    due.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        due.tick().await;
        let is_heard = heard.borrow().elapsed() < SILENCE;
        seat = match (is_heard && app.roster.allows(caller, "dashboard arm"), seat) {
            (true, None) => Some(app.control.seat_game_master()),
            (true, seat) => seat,
            (false, _) => None,
        };
    }
}

/// Every dashboard is sent a ping so often; browsers answer by themselves.
pub const PING_EVERY: Duration = Duration::from_secs(1);
/// Three pings that nobody answered.
const SILENCE: Duration = Duration::from_secs(3);
const LOOK_EVERY: Duration = Duration::from_millis(250);
