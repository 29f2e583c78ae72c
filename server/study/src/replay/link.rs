//! The way of a pose from a headset to the engine: delay, jitter, loss. Poses may overtake each other.

use covr_engine::observation::{PersonId, PoseSample};
use covr_engine::time::{Span, Time};

use crate::random::Random;

/// What a link does to poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkProfile {
    /// Every pose takes at least this long.
    pub delay: Span,
    /// And up to this much longer.
    pub jitter: Span,
    /// This share never arrives.
    pub loss: f64,
}

/// A link with poses under way.
#[derive(Debug, Clone)]
pub struct PoseLink {
    profile: LinkProfile,
    random: Random,
    under_way: Vec<Parcel>,
    arrived: Vec<Parcel>,
}

#[derive(Debug, Clone, Copy)]
struct Parcel {
    due: Time,
    person: PersonId,
    sample: PoseSample,
}

impl LinkProfile {
    /// A cable: at once, always.
    pub const PERFECT: Self = Self { delay: Span::ZERO, jitter: Span::ZERO, loss: 0.0 };
    /// A headset on a good wireless network.
    pub const WIRELESS: Self =
        Self { delay: Span::from_millis(12), jitter: Span::from_millis(6), loss: 0.002 };
}

impl PoseLink {
    /// An empty link.
    pub fn new(profile: LinkProfile, random: Random) -> Self {
        Self { profile, random, under_way: Vec::new(), arrived: Vec::new() }
    }

    /// Put a pose on its way.
    pub fn send(&mut self, now: Time, person: PersonId, sample: PoseSample) {
        // Both numbers are drawn for every pose, so that a loss changes nothing for the poses after it.
        let lost = self.random.chance(self.profile.loss);
        let late = Span::from_secs(self.profile.jitter.secs() * self.random.unit());
        if !lost {
            self.under_way.push(Parcel { due: now + self.profile.delay + late, person, sample });
        }
    }

    /// What has arrived by `now`, in the order of arrival.
    pub fn due(&mut self, now: Time) -> impl Iterator<Item = (PersonId, PoseSample)> + '_ {
        self.arrived.clear();
        self.arrived.extend(self.under_way.extract_if(.., |parcel| parcel.due <= now));
        self.arrived.sort_by_key(|parcel| parcel.due);
        self.arrived.iter().map(|parcel| (parcel.person, parcel.sample))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::frames::{Point, Pose};
    use covr_engine::observation::Hands;
    use nalgebra::UnitQuaternion;

    fn sample(millis: i64) -> PoseSample {
        PoseSample {
            taken_at: Time::from_micros(millis * 1000),
            pose: Pose { position: Point::new(0.0, 0.0, 1.6), orientation: UnitQuaternion::identity() },
            tracked: true,
            worn: true,
            hands: Hands::UNKNOWN,
        }
    }

    /// For each pose sent at 10 ms steps, when it arrived, in ms.
    fn arrivals(profile: LinkProfile, count: i64) -> Vec<(i64, i64)> {
        let mut link = PoseLink::new(profile, Random::seeded(5));
        let mut arrivals = Vec::new();
        for now in 0..count * 10 + 1000 {
            let at = Time::from_micros(now * 1000);
            if now % 10 == 0 && now < count * 10 {
                link.send(at, PersonId(1), sample(now));
            }
            arrivals.extend(link.due(at).map(|(_, s)| (s.taken_at.micros() / 1000, now)));
        }
        arrivals
    }

    #[test]
    fn a_perfect_link_brings_everything_at_once() {
        let arrivals = arrivals(LinkProfile::PERFECT, 100);
        assert!(arrivals.len() == 100 && arrivals.iter().all(|(sent, arrived)| sent == arrived));
    }

    #[test]
    fn delay_jitter_and_loss_are_what_the_profile_says() {
        let profile = LinkProfile { delay: Span::from_millis(20), jitter: Span::from_millis(30), loss: 0.25 };
        let arrivals = arrivals(profile, 4000);
        let share = arrivals.len() as f64 / 4000.0;
        assert!((share - 0.75).abs() < 0.03, "{share} arrived");
        let late: Vec<i64> = arrivals.iter().map(|(sent, arrived)| arrived - sent).collect();
        assert!(late.iter().all(|late| (20..=51).contains(late)));
        let mean = late.iter().sum::<i64>() as f64 / late.len() as f64;
        assert!((mean - 35.5).abs() < 1.0, "mean {mean} ms");
        assert!(arrivals.windows(2).any(|pair| pair[1].0 < pair[0].0), "some overtake others");
    }
}
