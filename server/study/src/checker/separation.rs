//! The separation rule, clause by clause, for every person and every keep-out shape.
//!
//! r is 0.35 m; 0.25 m at no more than 0.25 m/s while the head is within 0.75 m (0.85 m to leave) of an enabled object,
//! and faster than that 0.35 m still; 1 m while the head is lower than 1 m, also near an object. Keep-outs: 0.35 m, v_h 0.
//!
//! Allowances, all of one reaction and one braking: r grew (what held with the r before must still hold), somebody
//! appeared, a person was faster than v_h, d began to fall under a motion that
//! is a retreat in all else (a person came after it). Once the reaction is over the column's
//! speed must not rise while it uses one of them. The last two are counted apart.

mod braking;

use std::collections::BTreeMap;

use covr_engine::frames::Floor;
use covr_engine::observation::PersonId;
use covr_engine::scene::KeepOutShape;
use covr_engine::time::{Span, Time};

use super::geometry::{Gap, Rectangle, to_point, to_shape};
use super::{MOVING_MPS, Moment, Rules};
use braking::Braking;
pub(super) use braking::Shortfall;

/// Who or what must be kept away from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subject {
    /// A person.
    Person(PersonId),
    /// A keep-out shape, by index.
    KeepOut(usize),
}

/// How the column stands towards one subject at one tick.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Found {
    pub(super) subject: Subject,
    pub(super) distance_m: f64,
    pub(super) speed_mps: f64,
    pub(super) standing: Standing,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Standing {
    Legal,
    Retreating,
    ExcusedGrowth,
    ApartFastPerson,
    ApartOvertakenRetreat,
    Violated { shortfall: Shortfall, because: &'static str },
}

/// What has to be remembered from tick to tick.
#[derive(Debug, Clone, Default)]
pub(super) struct SeparationWatch {
    watched: BTreeMap<Subject, Watched>,
    at_before: Option<Time>,
    speed_before_mps: f64,
}

/// Which r applies, in rising order of r.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Zone {
    AtObject,
    Open,
    Low,
}

#[derive(Debug, Clone)]
struct Watched {
    zone: Zone,
    at_object: bool,
    head: Option<Floor>,
    speed_mps: f64,
    distance_m: f64,
    /// Since when d has been falling, tick by tick.
    falling_since: Option<Time>,
    graces: Vec<Grace>,
}

#[derive(Debug, Clone, Copy)]
struct Grace {
    reason: Reason,
    onset: Time,
    until: Time,
    /// Least speed since the reaction was over, while the grace is in use.
    lowest_mps: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Reason {
    Grew { from: Zone },
    Appeared,
    FastPerson,
    OvertakenRetreat,
}

/// A subject as it is at this tick.
struct Sighting<'a> {
    subject: Subject,
    head: Option<Floor>,
    v_h_mps: f64,
    gap: Gap,
    place: Place<'a>,
}

/// Where a subject is.
#[derive(Debug, Clone, Copy)]
enum Place<'a> {
    Head(Floor),
    Shape(&'a KeepOutShape),
}

/// What every subject's judgement at this tick needs.
struct Scales<'a> {
    at: Time,
    speed_mps: f64,
    speed_before_mps: f64,
    reaction: Span,
    /// One reaction at the greatest acceleration and one braking, from now.
    allowance: Span,
    braking: Braking,
    footprint: &'a [Rectangle],
}

impl SeparationWatch {
    /// Everything will appear anew.
    pub(super) fn forget_subjects(&mut self) {
        self.watched.clear();
    }

    /// How the column stands towards everyone and everything.
    pub(super) fn tick(&mut self, rules: &Rules, moment: &Moment<'_>) -> Vec<Found> {
        let scales = self.scales(rules, moment);
        let sightings = sightings(rules, moment);
        self.watched.retain(|subject, _| sightings.iter().any(|sighting| sighting.subject == *subject));
        for sighting in &sightings {
            self.watch(sighting, rules, moment, &scales);
        }
        let mut standings: Vec<Standing> =
            sightings.iter().map(|sighting| self.by_the_rule(sighting, &scales)).collect();
        let broken: Vec<usize> =
            (0..standings.len()).filter(|&i| matches!(standings[i], Standing::Violated { .. })).collect();
        // One subject may be retreated from, everyone else being under the full rule.
        if let [only] = broken[..] {
            standings[only] = self.by_retreat(&sightings[only], &standings[only], moment, &scales);
        }
        self.at_before = Some(moment.at);
        self.speed_before_mps = scales.speed_mps;
        let mut found = Vec::with_capacity(sightings.len());
        for (sighting, standing) in sightings.into_iter().zip(standings) {
            let Some(watched) = self.watched.get_mut(&sighting.subject) else { continue };
            watched.distance_m = sighting.gap.distance_m;
            found.push(Found {
                subject: sighting.subject,
                distance_m: sighting.gap.distance_m,
                speed_mps: watched.speed_mps,
                standing,
            });
        }
        found
    }

    fn scales<'a>(&self, rules: &'a Rules, moment: &Moment<'_>) -> Scales<'a> {
        let velocity = moment.column.velocity;
        let reaction = rules.reaction;
        let brake_secs = |speed: f64, own: &covr_engine::machine::AxisLimits| {
            let fastest =
                (speed.abs() + own.acceleration_mps2 * reaction.secs()).min(own.speed_mps.max(speed.abs()));
            // a_b is that of a jerk-limited stop: the ramps of the deceleration take their time too.
            fastest / own.braking_mps2 + own.braking_mps2 / own.jerk_mps3
        };
        let longest = brake_secs(velocity.x, &rules.limits.x).max(brake_secs(velocity.y, &rules.limits.y));
        Scales {
            at: moment.at,
            speed_mps: velocity.norm(),
            speed_before_mps: self.speed_before_mps,
            reaction,
            allowance: Span::from_secs(reaction.secs() + longest),
            braking: Braking::new(moment.column, &rules.limits),
            footprint: &rules.footprint,
        }
    }

    /// Bring what is remembered of a subject up to date, and open the allowances that it gives rise to.
    fn watch(&mut self, sighting: &Sighting<'_>, rules: &Rules, moment: &Moment<'_>, scales: &Scales<'_>) {
        let person = moment.persons.iter().find(|person| sighting.subject == Subject::Person(person.id));
        let at_object = |before: bool| {
            let within = if before { LEAVES_OBJECT_M } else { COMES_TO_OBJECT_M };
            person.and_then(|person| person.to_enabled_object_m).is_some_and(|distance| distance <= within)
        };
        let zone_of = |at_object: bool| match person {
            Some(person) if person.height_m < LOW_M => Zone::Low,
            _ if at_object => Zone::AtObject,
            _ => Zone::Open,
        };
        let grace = |reason: Reason| Grace {
            reason,
            onset: scales.at,
            until: scales.at + scales.allowance,
            lowest_mps: None,
        };
        let Some(watched) = self.watched.get_mut(&sighting.subject) else {
            let at_object = at_object(false);
            let watched = Watched {
                zone: zone_of(at_object),
                at_object,
                head: sighting.head,
                speed_mps: 0.0,
                distance_m: sighting.gap.distance_m,
                falling_since: None,
                graces: vec![grace(Reason::Appeared)],
            };
            self.watched.insert(sighting.subject, watched);
            return;
        };
        watched.graces.retain(|grace| scales.at <= grace.until);
        let falls = sighting.gap.distance_m < watched.distance_m - FALLING_M;
        if falls && watched.falling_since.is_none() {
            watched.graces.push(grace(Reason::OvertakenRetreat));
        }
        watched.falling_since = if falls { watched.falling_since.or(Some(scales.at)) } else { None };
        watched.at_object = at_object(watched.at_object);
        let zone = zone_of(watched.at_object);
        if zone > watched.zone {
            watched.graces.push(grace(Reason::Grew { from: watched.zone }));
        }
        watched.zone = zone;
        let dt = self.at_before.map_or(0.0, |before| (scales.at - before).secs());
        if let (Some(now), Some(before)) = (sighting.head, watched.head)
            && dt > 0.0
        {
            watched.speed_mps = now.distance_m(before) / dt;
            if watched.speed_mps > rules.v_h_mps * (1.0 + SPEED_TOLERANCE) {
                match watched.graces.iter_mut().find(|grace| grace.reason == Reason::FastPerson) {
                    Some(already) => already.until = scales.at + scales.allowance,
                    None => watched.graces.push(grace(Reason::FastPerson)),
                }
            }
        }
        watched.head = sighting.head;
    }

    /// The rule in full, and the allowances.
    fn by_the_rule(&mut self, sighting: &Sighting<'_>, scales: &Scales<'_>) -> Standing {
        let Some(watched) = self.watched.get_mut(&sighting.subject) else { return Standing::Legal };
        let shortfall =
            if scales.speed_mps <= MOVING_MPS { None } else { scales.shortfall(sighting, watched.zone) };
        let Some(shortfall) = shortfall else {
            watched.graces.iter_mut().for_each(|grace| grace.lowest_mps = None);
            return Standing::Legal;
        };
        let mut because = "no allowance applies";
        for grace in &mut watched.graces {
            let standing = match grace.reason {
                Reason::Grew { from } if scales.shortfall(sighting, from).is_some() => {
                    because = "r grew, but with the r before it is broken too";
                    continue;
                }
                Reason::Grew { .. } | Reason::Appeared => Standing::ExcusedGrowth,
                Reason::FastPerson => Standing::ApartFastPerson,
                Reason::OvertakenRetreat => continue,
            };
            if grace.permits(scales) {
                return standing;
            }
            because = "an allowance applies, but after the reaction the speed rose";
        }
        Standing::Violated { shortfall, because }
    }

    /// The retreat: what is left when the rule is broken towards this subject alone.
    fn by_retreat(
        &mut self,
        sighting: &Sighting<'_>,
        standing: &Standing,
        moment: &Moment<'_>,
        scales: &Scales<'_>,
    ) -> Standing {
        let Some(watched) = self.watched.get_mut(&sighting.subject) else { return standing.clone() };
        let Gap { distance_m, away } = sighting.gap;
        let velocity = moment.column.velocity;
        let goes_away = velocity.dot(away) >= RETREAT_COSINE * velocity.norm() * away.norm();
        let slow = scales.speed_mps <= RETREAT_MPS + 1e-9;
        if moment.latched || !goes_away || !slow {
            return standing.clone();
        }
        if distance_m >= RETREAT_LEAST_M && watched.falling_since.is_none() {
            return Standing::Retreating;
        }
        let mut overtaken =
            watched.graces.iter_mut().filter(|grace| grace.reason == Reason::OvertakenRetreat);
        if overtaken.any(|grace| grace.permits(scales)) {
            Standing::ApartOvertakenRetreat
        } else {
            standing.clone()
        }
    }
}

/// A smaller rise of the speed cannot be told from none, m/s.
const RISE_MPS: f64 = 0.01;

impl Grace {
    /// Within the reaction anything; after it the column must brake.
    fn permits(&mut self, scales: &Scales<'_>) -> bool {
        if scales.at <= self.onset + scales.reaction {
            return true;
        }
        let lowest = self.lowest_mps.get_or_insert(scales.speed_before_mps);
        let brakes = scales.speed_mps <= *lowest + RISE_MPS;
        *lowest = lowest.min(scales.speed_mps);
        brakes
    }
}

impl Place<'_> {
    fn gap(self, footprint: &[Rectangle], centre: Floor) -> Gap {
        match self {
            Self::Head(head) => to_point(footprint, centre, head),
            Self::Shape(shape) => to_shape(footprint, centre, shape),
        }
    }
}

impl Scales<'_> {
    fn shortfall(&self, sighting: &Sighting<'_>, zone: Zone) -> Option<Shortfall> {
        let radius_m = match zone {
            Zone::AtObject if self.speed_mps <= AT_OBJECT_MPS + 1e-9 => AT_OBJECT_RADIUS_M,
            Zone::AtObject | Zone::Open => OPEN_RADIUS_M,
            Zone::Low => LOW_RADIUS_M,
        };
        let distance_m = |centre: Floor| sighting.place.gap(self.footprint, centre).distance_m;
        self.braking.shortfall(distance_m, radius_m, sighting.v_h_mps)
    }
}

fn sightings<'a>(rules: &'a Rules, moment: &Moment<'_>) -> Vec<Sighting<'a>> {
    let centre = moment.column.position;
    let persons = moment.persons.iter().filter(|person| person.contact.is_none()).map(|person| {
        let head = person.head;
        Sighting {
            subject: Subject::Person(person.id),
            head: Some(head),
            v_h_mps: rules.v_h_mps,
            gap: Place::Head(head).gap(&rules.footprint, centre),
            place: Place::Head(head),
        }
    });
    let keep_outs = rules.keep_outs.iter().enumerate().map(|(i, shape)| Sighting {
        subject: Subject::KeepOut(i),
        head: None,
        v_h_mps: 0.0,
        gap: Place::Shape(shape).gap(&rules.footprint, centre),
        place: Place::Shape(shape),
    });
    persons.chain(keep_outs).collect()
}

/// A body of 0.25 m and a margin, m.
const OPEN_RADIUS_M: f64 = 0.35;
/// While the head is at an enabled object and the column creeps, m.
const AT_OBJECT_RADIUS_M: f64 = 0.25;
/// How slow the column must be for that radius, m/s.
const AT_OBJECT_MPS: f64 = 0.25;
/// A head this near to an enabled object comes to it, m.
const COMES_TO_OBJECT_M: f64 = 0.75;
/// And leaves it farther than this, m.
const LEAVES_OBJECT_M: f64 = 0.85;
/// Crawling or sitting, m.
const LOW_RADIUS_M: f64 = 1.0;
/// A head lower than this crawls or sits, m.
const LOW_M: f64 = 1.0;
/// Cosine of 60 degrees, within which the velocity of a retreat points away.
const RETREAT_COSINE: f64 = 0.5;
/// Greatest speed of a retreat, m/s.
const RETREAT_MPS: f64 = 0.3;
/// Nearer than this nothing moves, m.
const RETREAT_LEAST_M: f64 = 0.35;
/// A distance that changes by less than this in a tick does not fall, m.
const FALLING_M: f64 = 1e-6;
/// Room for rounding when heads are differenced.
const SPEED_TOLERANCE: f64 = 1e-6;

#[cfg(test)]
mod tests;
