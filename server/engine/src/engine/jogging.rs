//! Jog in `ready`: who may move the column by hand, how fast, and what ends it.

use super::Engine;
use super::requests::{Answer, accepted, refused};
use crate::event::EventKind;
use crate::mode::{self, Mode, RequestKind, Response};
use crate::motion::jog::{Aim, JogOrder};
use crate::reason::Reason;
use crate::time::Time;

/// The order in force.
#[derive(Debug, Clone, Copy)]
pub(super) struct Jog {
    order: JogOrder,
    ordered_at: Time,
}

impl Engine {
    /// Take an order: it holds until the next, until it is let go of, or until it has grown old.
    pub(super) fn take_jog(&mut self, now: Time, order: JogOrder) -> Answer {
        match mode::respond(self.mode, RequestKind::Jog, &self.conditions(now)) {
            Response::Go(to) if to != self.mode => {
                self.enter(to, None, Reason::Asked(RequestKind::Jog), now);
            }
            Response::Go(_) => {}
            Response::AlreadySo(reason) | Response::Refuse(reason) => return refused(reason),
        }
        let inside = self.config.travel.shrunk(self.parameters.travel_margin_m);
        let reason = match order.aim {
            Aim::Along(way) if way.unit().is_none() => Some(self.no_jog_order()),
            Aim::To(place) if inside.depth_m(place) < 0.0 => Some(Reason::JogOutsideTravel),
            _ if !(order.speed_mps > 0.0 && order.speed_mps <= self.fastest_mps()) => {
                Some(self.no_jog_order())
            }
            _ => self.why_no_jog(now),
        };
        if let Some(reason) = reason {
            return refused(reason);
        }
        if self.jog.replace(Jog { order, ordered_at: now }).is_none()
            && let Some(report) = self.report
        {
            self.pending.push(EventKind::JogBegan(report.position));
        }
        accepted(Reason::JogsWhileHeld)
    }

    /// The hand let go.
    pub(super) fn let_go_of_jog(&mut self) -> Answer {
        self.end_jog(Reason::JogLetGo);
        accepted(Reason::JogLetGo)
    }

    /// The order to move by now, and the greatest speed; none when there is none, and when something forbids it.
    pub(super) fn jog_now(&mut self, now: Time) -> Option<(JogOrder, f64)> {
        let Jog { order, ordered_at } = self.jog?;
        let over = if self.mode != Mode::Ready {
            Some(Reason::JogOver(self.mode))
        } else if now - ordered_at > self.parameters.hold_to_run {
            Some(Reason::JogSilent)
        } else {
            self.why_no_jog(now)
        };
        match over {
            None => Some((order, self.jog_speed_mps()?)),
            Some(reason) => {
                self.end_jog(reason);
                None
            }
        }
    }

    /// How fast the column may be moved by hand as things are, m/s: at creep speed where nobody vouches for the arena
    /// (R16), at reduced speed among people, at the machine's own in an arena that is clear.
    pub(super) fn jog_speed_mps(&self) -> Option<f64> {
        let p = &self.parameters;
        (self.mode == Mode::Ready).then(|| match (self.persons.is_empty(), self.arena_confirmed_clear) {
            (true, true) => self.fastest_mps(),
            (true, false) => p.creep_speed_mps,
            (false, _) => p.reduced_speed_mps,
        })
    }

    /// A rule asks for a stop, did a moment ago, or somebody is inside whom nobody has seen yet.
    fn why_no_jog(&self, now: Time) -> Option<Reason> {
        if let Some(unseen) = self.persons.iter().find(|p| p.is_unseen()) {
            return Some(Reason::NoPoseYet(unseen.id(), (now - unseen.entered_at()).secs()));
        }
        let quiet = self.quiet_since.is_some_and(|since| now - since >= self.parameters.clears_after);
        if quiet { None } else { Some(self.supervisor.breached().unwrap_or(Reason::JogNotYet)) }
    }

    fn end_jog(&mut self, because: Reason) {
        if self.jog.take().is_some()
            && let Some(report) = self.report
        {
            self.pending.push(EventKind::JogEnded { at: report.position, because });
        }
    }

    pub(super) fn no_jog_order(&self) -> Reason {
        Reason::NoJogOrder { fastest_mps: self.fastest_mps() }
    }

    fn fastest_mps(&self) -> f64 {
        self.config.limits.x.speed_mps.min(self.config.limits.y.speed_mps)
    }
}
