//! The independent checker of separation, travel and limits. It knows the truth: where heads and column really are.
//!
//! It shares no code with the engine's safety room and must never do so; it takes from the engine only the words for
//! frames, time, limits and travel. One checker follows one track: the true motion of the machine, or the commanded.
//!
//! Separation. d(c) is the horizontal distance from a head axis to the nearest point of the footprint, props included,
//! with the column's centre at c. Follow the column as if it braked from now on, each axis at its own braking limit,
//! to rest at s_end. It may be moving only if for every person and every s in [0, s_end] `d(c(s)) > r + v_h s`, or it
//! retreats from that one person. [`separation`] holds the rule and its allowances, clause by clause.

mod contact;
mod geometry;
mod limits;
mod separation;
mod verdict;

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{Limits, Travel};
use covr_engine::observation::PersonId;
use covr_engine::scene::KeepOutShape;
use covr_engine::time::{Span, Time};

use contact::ContactWatch;
pub use geometry::Rectangle;
pub use limits::{Axis, Quantity};
use limits::{LimitsWatch, travel_breach};
pub use separation::Subject;
use separation::{SeparationWatch, Standing};
pub use verdict::{Breach, Verdict, Violation};

/// What the motion is checked against.
#[derive(Debug, Clone, PartialEq)]
pub struct Rules {
    /// What each axis may do; `braking_mps2` is also what the braking of the rule uses.
    pub limits: Limits,
    /// Where the column's centre can stand mechanically.
    pub travel: Travel,
    /// How much nearer than the travel limits it must not come, braking included, m.
    pub travel_margin_m: f64,
    /// Column and props.
    pub footprint: Vec<Rectangle>,
    /// Where the column must never go.
    pub keep_outs: Vec<KeepOutShape>,
    /// The speed of a walking person, m/s.
    pub v_h_mps: f64,
    /// One reaction, where the rule allows one.
    pub reaction: Span,
}

/// Which motion a checker follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Track {
    /// What the machine really does.
    True,
    /// What it is told to do; its speed, acceleration and jerk are checked too.
    Commanded,
}

/// The column's centre at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Where, room frame.
    pub position: Floor,
    /// How fast, m/s.
    pub velocity: Planar,
}

/// A person at one moment, as it really is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PersonNow {
    /// Who.
    pub id: PersonId,
    /// The floor under the head.
    pub head: Floor,
    /// The head above the floor, m.
    pub height_m: f64,
    /// From the head to the nearest surface of an enabled object, m; none without an enabled object.
    pub to_enabled_object_m: Option<f64>,
    /// A contact interaction is under way with this person: its own limits replace this rule (R14).
    pub contact: Option<ContactNow>,
}

/// A contact interaction with a person, as far as the checker needs to know it: from the record, not from the engine's safety room.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactNow {
    /// Which.
    pub kind: ContactKind,
    /// The rectangle of the prop in contact, as an index into the footprint; none: the prop takes no floor, or is the column itself.
    pub rectangle: Option<usize>,
    /// From the column's centre to the prop's point of touch, m.
    pub offset: Planar,
}

/// The contact interactions of R14.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactKind {
    /// Somebody holds on and is pulled.
    Lead,
    /// Somebody sits on it and is carried.
    Transport,
    /// A prop comes up to somebody.
    Brush,
}

/// Everything that the checker is told at one tick.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'a> {
    /// When.
    pub at: Time,
    /// The column.
    pub column: Motion,
    /// It follows setpoints now; else it brakes or is pushed, and limits on commands have no meaning.
    pub follows_setpoints: bool,
    /// Positions are in the room frame; else the travel rule has no meaning.
    pub homed: bool,
    /// A stop is latched: no retreat.
    pub latched: bool,
    /// Everybody in the arena.
    pub persons: &'a [PersonNow],
}

/// Follows one track, tick by tick.
#[derive(Debug, Clone)]
pub struct Checker {
    rules: Rules,
    track: Track,
    separation: SeparationWatch,
    contacts: ContactWatch,
    limits: LimitsWatch,
    verdict: Verdict,
}

/// The column counts as moving above this speed, m/s: a machine told to rest closes the last 2 mm of its following
/// error, at the ten per second of its position loop, more slowly than this.
pub const MOVING_MPS: f64 = 0.02;

/// Violations kept with full particulars.
const MOST_KEPT: usize = 8;

impl Rules {
    /// The rules by default for a machine and a scene's shapes: v_h 1.6 m/s, margin 2 cm, reaction 50 ms.
    pub fn of(
        limits: Limits,
        travel: Travel,
        footprint: Vec<Rectangle>,
        keep_outs: Vec<KeepOutShape>,
    ) -> Self {
        let reaction = Span::from_millis(50);
        Self { limits, travel, travel_margin_m: 0.02, footprint, keep_outs, v_h_mps: 1.6, reaction }
    }
}

impl Checker {
    /// A checker that has seen nothing.
    pub fn new(rules: Rules, track: Track) -> Self {
        Self {
            rules,
            track,
            separation: SeparationWatch::default(),
            contacts: ContactWatch::default(),
            limits: LimitsWatch::default(),
            verdict: Verdict::default(),
        }
    }

    /// The scene changed. With other props on the column or other keep-outs everything appears anew; with the same
    /// nothing does, so that a change of objects alone opens no allowance.
    pub fn change_shapes(&mut self, footprint: Vec<Rectangle>, keep_outs: Vec<KeepOutShape>) {
        if self.rules.footprint == footprint && self.rules.keep_outs == keep_outs {
            return;
        }
        self.rules.footprint = footprint;
        self.rules.keep_outs = keep_outs;
        self.separation.forget_subjects();
    }

    /// Check one tick. Ticks come in order of time.
    pub fn check(&mut self, moment: &Moment<'_>) {
        self.verdict.ticks += 1;
        let moving = moment.column.velocity.norm() > MOVING_MPS;
        if moving {
            self.verdict.moving_ticks += 1;
        }
        self.check_separation(moment, moving);
        self.check_contacts(moment);
        if moment.homed {
            self.check_travel(moment, moving);
        }
        if self.track == Track::Commanded {
            self.check_limits(moment);
        }
    }

    /// What was found so far.
    pub fn verdict(&self) -> &Verdict {
        &self.verdict
    }

    /// What was found so far; it counts anew from now on, and forgets nothing of what it follows.
    pub fn take_verdict(&mut self) -> Verdict {
        std::mem::take(&mut self.verdict)
    }

    fn check_separation(&mut self, moment: &Moment<'_>, moving: bool) {
        for found in self.separation.tick(&self.rules, moment) {
            if moving && matches!(found.subject, Subject::Person(_)) {
                let least = &mut self.verdict.least_separation_moving_m;
                *least = Some(least.map_or(found.distance_m, |so_far| so_far.min(found.distance_m)));
            }
            match found.standing {
                Standing::Legal => {}
                Standing::Retreating => self.verdict.retreating += 1,
                Standing::ExcusedGrowth => self.verdict.excused_growth += 1,
                Standing::ApartFastPerson => self.verdict.apart_fast_person += 1,
                Standing::ApartOvertakenRetreat => self.verdict.apart_overtaken_retreat += 1,
                Standing::Violated { shortfall, because } => {
                    self.verdict.separation += 1;
                    self.keep(
                        moment,
                        Breach::Separation {
                            subject: found.subject,
                            radius_m: shortfall.radius_m,
                            s_secs: shortfall.s_secs,
                            distance_m: shortfall.distance_m,
                            required_m: shortfall.required_m,
                            distance_now_m: found.distance_m,
                            subject_speed_mps: found.speed_mps,
                            because,
                        },
                    );
                }
            }
        }
    }

    fn check_contacts(&mut self, moment: &Moment<'_>) {
        for breach in self.contacts.tick(&self.rules, moment, self.track) {
            self.verdict.contact += 1;
            self.keep(moment, breach);
        }
    }

    fn check_travel(&mut self, moment: &Moment<'_>, moving: bool) {
        let depth_m = self.rules.travel.depth_m(moment.column.position);
        if depth_m < -TOLERANCE_M {
            self.verdict.travel_outside += 1;
            self.keep(moment, Breach::TravelOutside { depth_m });
        }
        for axis in Axis::BOTH {
            if let Some(breach) = travel_breach(&self.rules, moment.column, axis).filter(|_| moving) {
                self.verdict.travel_margin += 1;
                self.keep(moment, breach);
            }
        }
    }

    fn check_limits(&mut self, moment: &Moment<'_>) {
        let breaches = self.limits.tick(&self.rules.limits, moment);
        for breach in breaches {
            if let Breach::Limit { quantity, .. } = breach {
                match quantity {
                    Quantity::Speed => self.verdict.speed += 1,
                    Quantity::Acceleration | Quantity::Braking => self.verdict.acceleration += 1,
                    Quantity::Jerk => self.verdict.jerk += 1,
                }
            }
            self.keep(moment, breach);
        }
    }

    fn keep(&mut self, moment: &Moment<'_>, breach: Breach) {
        if self.verdict.first.len() < MOST_KEPT {
            let (at, track, column) = (moment.at, self.track, moment.column);
            self.verdict.first.push(Violation { at, track, column, breach });
        }
    }
}

/// A position is compared to a travel limit no more finely than this, m.
const TOLERANCE_M: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;

    fn rules() -> Rules {
        let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        let carriage = Rectangle { offset: Planar::ZERO, size_m: Planar::new(0.2, 0.2) };
        Rules::of(Limits::PAPER, travel, vec![carriage], Vec::new())
    }

    fn moment(millis: i64, x: f64, v: f64, persons: &[PersonNow]) -> Moment<'_> {
        Moment {
            at: Time::ZERO + Span::from_millis(millis),
            column: Motion { position: Floor::new(x, 2.0), velocity: Planar::new(v, 0.0) },
            follows_setpoints: true,
            homed: true,
            latched: false,
            persons,
        }
    }

    fn standing(x: f64) -> PersonNow {
        PersonNow {
            id: PersonId(1),
            head: Floor::new(x, 2.0),
            height_m: 1.6,
            to_enabled_object_m: None,
            contact: None,
        }
    }

    #[test]
    fn a_violation_says_everything_that_is_needed_to_understand_it() {
        let mut checker = Checker::new(rules(), Track::True);
        let persons = [standing(3.0)];
        checker.check(&moment(0, 1.0, 0.0, &persons));
        // Front at 2.1 m, 0.9 m away at 1 m/s: after 0.4 s it would rest at 2.3 m, 0.7 m away; 0.99 m are required.
        checker.check(&moment(1000, 2.0, 1.0, &persons));
        let verdict = checker.verdict();
        assert_eq!((verdict.separation, verdict.violations()), (1, 1));
        assert_eq!((verdict.ticks, verdict.moving_ticks), (2, 1));
        assert!((verdict.least_separation_moving_m.unwrap() - 0.9).abs() < 1e-9);
        let text = verdict.first[0].to_string();
        for part in [
            "at 1.000 s, True column at (2.0000, 2.0000) m",
            "Person(PersonId(1))",
            "0.9000 m away",
            "0.9900 m",
        ] {
            assert!(text.contains(part), "{part:?} is not in {text:?}");
        }
    }

    #[test]
    fn only_the_first_violations_are_kept_but_all_are_counted() {
        let mut checker = Checker::new(rules(), Track::True);
        let persons = [standing(3.0)];
        checker.check(&moment(0, 1.0, 0.0, &persons));
        (0..20).for_each(|i| checker.check(&moment(1000 + 4 * i, 2.4, 1.0, &persons)));
        assert_eq!((checker.verdict().separation, checker.verdict().first.len()), (20, MOST_KEPT));
    }

    #[test]
    fn travel_is_kept_with_its_margin_while_moving_and_outside_never() {
        let mut checker = Checker::new(rules(), Track::True);
        // From 3.77 m at 1 m/s it rests at 3.97 m: allowed up to 3.98 m. From 3.79 m it would rest at 3.99 m.
        checker.check(&moment(0, 3.77, 1.0, &[]));
        assert_eq!(checker.verdict().travel(), 0);
        checker.check(&moment(4, 3.79, 1.0, &[]));
        assert_eq!((checker.verdict().travel_margin, checker.verdict().travel_outside), (1, 0));
        // At rest at the switches, and leaving them, is legal.
        checker.check(&moment(8, 0.005, 0.0, &[]));
        checker.check(&moment(12, 0.005, 0.3, &[]));
        assert_eq!(checker.verdict().travel_margin, 1);
        checker.check(&moment(16, -0.001, 0.0, &[]));
        assert_eq!(checker.verdict().travel_outside, 1);
        // Before homing positions mean nothing.
        checker.check(&Moment { homed: false, ..moment(20, -3.0, -1.0, &[]) });
        assert_eq!(checker.verdict().travel(), 2);
    }

    #[test]
    fn limits_bind_the_commanded_track_alone() {
        for (track, expected) in [(Track::True, 0), (Track::Commanded, 1)] {
            let mut checker = Checker::new(rules(), track);
            checker.check(&moment(0, 1.0, 1.2, &[]));
            assert_eq!(checker.verdict().speed, expected);
        }
    }

    #[test]
    fn a_changed_scene_is_checked_from_then_on() {
        let mut checker = Checker::new(rules(), Track::True);
        checker.check(&moment(0, 1.0, 0.5, &[]));
        let disc = KeepOutShape::Circle { centre: Floor::new(1.5, 2.0), radius_m: 0.1 };
        checker.change_shapes(checker.rules.footprint.clone(), vec![disc]);
        checker.check(&moment(4, 1.0, 0.5, &[]));
        assert_eq!((checker.verdict().excused_growth, checker.verdict().separation), (1, 0));
        checker.check(&moment(1000, 1.0, 0.5, &[]));
        assert_eq!(checker.verdict().separation, 1);
    }
}
