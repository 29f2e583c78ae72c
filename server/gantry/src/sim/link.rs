//! The link between host and controller: packets one way, reports the other, both in order and possibly late.

use std::collections::VecDeque;

use covr_engine::machine::MachineReport;
use covr_engine::time::{Span, Time};

use super::controller::Packet;
use super::faults::LinkFault;

/// What is under way.
#[derive(Debug, Clone)]
pub(super) struct Link {
    packets: VecDeque<(Time, Packet)>,
    reports: VecDeque<(Time, MachineReport)>,
}

impl Default for Link {
    fn default() -> Self {
        Self { packets: VecDeque::with_capacity(CAPACITY), reports: VecDeque::with_capacity(CAPACITY) }
    }
}

impl Link {
    /// Put a packet on its way.
    pub(super) fn send(&mut self, now: Time, packet: Packet, fault: LinkFault) {
        self.packets.push_back((now + delay(fault), packet));
    }

    /// The next packet that has arrived by `now`.
    pub(super) fn packet_due(&mut self, now: Time) -> Option<Packet> {
        pop_due(&mut self.packets, now)
    }

    /// Put a report on its way, and take the newest that has arrived by `now`.
    pub(super) fn report_through(
        &mut self,
        now: Time,
        report: MachineReport,
        fault: LinkFault,
    ) -> Option<MachineReport> {
        self.reports.push_back((now + delay(fault), report));
        let mut newest = None;
        while let Some(report) = pop_due(&mut self.reports, now) {
            newest = Some(report);
        }
        newest
    }
}

fn delay(fault: LinkFault) -> Span {
    match fault {
        LinkFault::Slow(by) => by,
        LinkFault::None | LinkFault::Dead => Span::ZERO,
    }
}

fn pop_due<T>(queue: &mut VecDeque<(Time, T)>, now: Time) -> Option<T> {
    match queue.front() {
        Some((due, _)) if *due <= now => queue.pop_front().map(|(_, value)| value),
        _ => None,
    }
}

/// Room for a second of lateness at 250 Hz without allocation.
const CAPACITY: usize = 256;

#[cfg(test)]
mod tests {
    use super::*;

    const SLOW: LinkFault = LinkFault::Slow(Span::from_millis(10));

    fn at(millis: i64) -> Time {
        Time::ZERO + Span::from_millis(millis)
    }

    #[test]
    fn a_good_link_delivers_at_once() {
        let mut link = Link::default();
        link.send(at(5), Packet::Home, LinkFault::None);
        assert_eq!(link.packet_due(at(5)), Some(Packet::Home));
        assert_eq!(link.packet_due(at(5)), None);
    }

    #[test]
    fn a_slow_link_delivers_late_and_in_order_also_once_it_is_well_again() {
        let mut link = Link::default();
        link.send(at(0), Packet::Home, SLOW);
        link.send(at(1), Packet::Release, LinkFault::None);
        assert_eq!(link.packet_due(at(9)), None, "the later packet waits behind the slow one");
        assert_eq!(link.packet_due(at(10)), Some(Packet::Home));
        assert_eq!(link.packet_due(at(10)), Some(Packet::Release));
    }
}
