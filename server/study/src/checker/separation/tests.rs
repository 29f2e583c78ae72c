//! Hand-computed cases for every clause. The carriage is 0.2 m square on the line y = 0, so that its front is 0.1 m
//! ahead of its centre; braking is 2.5 m/s2: at 1 m/s it rests after 0.4 s and 0.2 m, at 0.5 m/s after 0.2 s and 0.05 m.

use super::super::{ContactKind, ContactNow, Motion, PersonNow, Rectangle};
use super::*;
use covr_engine::frames::Planar;
use covr_engine::machine::{AxisLimits, Limits, Travel};
use covr_engine::scene::KeepOutShape;

/// A run of the watch, one tick each 4 ms.
struct Run {
    rules: Rules,
    watch: SeparationWatch,
    at: Time,
    latched: bool,
}

impl Run {
    fn new() -> Self {
        let travel = Travel { min: Floor::new(-9.0, -9.0), max: Floor::new(9.0, 9.0) };
        let carriage = Rectangle { offset: Planar::ZERO, size_m: Planar::new(0.2, 0.2) };
        // Without a bound on jerk the times below can be worked out in the head.
        let abrupt = AxisLimits { jerk_mps3: f64::INFINITY, ..AxisLimits::PAPER };
        let rules = Rules::of(Limits { x: abrupt, y: abrupt }, travel, vec![carriage], Vec::new());
        Self { rules, watch: SeparationWatch::default(), at: Time::ZERO, latched: false }
    }

    /// A second of rest somewhere far away with these persons present, so that no allowance is left.
    fn settled(persons: &[PersonNow]) -> Self {
        let mut run = Self::new();
        run.settle(persons);
        run
    }

    fn settle(&mut self, persons: &[PersonNow]) {
        self.tick(-8.0, 0.0, persons);
        self.at += Span::from_millis(1000);
        self.tick(-8.0, 0.0, persons);
    }

    /// The column's centre at (x, 0) with velocity (v, 0).
    fn tick(&mut self, x: f64, v: f64, persons: &[PersonNow]) -> Vec<Standing> {
        self.tick_planar(Floor::new(x, 0.0), Planar::new(v, 0.0), persons)
    }

    fn tick_planar(&mut self, position: Floor, velocity: Planar, persons: &[PersonNow]) -> Vec<Standing> {
        self.at += Span::from_millis(4);
        let moment = Moment {
            at: self.at,
            column: Motion { position, velocity },
            follows_setpoints: true,
            homed: true,
            latched: self.latched,
            persons,
        };
        self.watch.tick(&self.rules, &moment).into_iter().map(|found| found.standing).collect()
    }
}

const CONTACT: ContactNow = ContactNow { kind: ContactKind::Lead, rectangle: None, offset: Planar::ZERO };

fn person(x: f64) -> PersonNow {
    let head = Floor::new(x, 0.0);
    PersonNow { id: PersonId(1), head, height_m: 1.7, to_enabled_object_m: None, contact: None }
}

fn at_object(x: f64, distance: f64) -> PersonNow {
    PersonNow { to_enabled_object_m: Some(distance), ..person(x) }
}

fn low(x: f64) -> PersonNow {
    PersonNow { height_m: 0.99, ..person(x) }
}

/// Whether a settled column at the origin may have this velocity with this person in front of it.
fn legal(v: f64, someone: PersonNow) -> bool {
    match &Run::settled(&[someone]).tick(0.0, v, &[someone])[..] {
        [Standing::Legal] => true,
        [Standing::Violated { .. }] => false,
        other => panic!("{other:?}"),
    }
}

#[test]
fn standing_people_need_r_and_the_walk_during_the_braking() {
    // At rest 0.2 m on, front at 0.3; 0.35 + 1.6 * 0.4 = 0.99 required: the head may be at 1.29 m, not nearer.
    assert!(legal(1.0, person(1.2901)));
    assert!(!legal(1.0, person(1.2899)));
    // Rest at 0.05, front at 0.15; 0.35 + 0.32 = 0.67: 0.82 m.
    assert!(legal(0.5, person(0.8201)));
    assert!(!legal(0.5, person(0.8199)));
    // Moving away counts what is won: rest at -0.2, front at -0.1, needs 0.99; head at 0.89. At s = 0: 0.35.
    assert!(legal(-1.0, person(0.8901)));
    assert!(!legal(-1.0, person(0.8899)));
}

#[test]
fn at_rest_everything_is_legal() {
    assert!(legal(0.0, person(0.05)));
    assert!(legal(0.0099, person(0.3)));
    assert!(!legal(0.0201, person(0.3)));
}

#[test]
fn v_h_is_the_one_of_the_rules() {
    let someone = [person(1.3)];
    let mut run = Run::settled(&someone);
    assert_eq!(run.tick(0.0, 1.0, &someone), [Standing::Legal]);
    run.rules.v_h_mps = 2.0;
    assert!(matches!(run.tick(0.0, 1.0, &someone)[..], [Standing::Violated { .. }]));
}

#[test]
fn props_are_part_of_the_footprint() {
    let someone = [person(1.5)];
    let mut run = Run::settled(&someone);
    assert_eq!(run.tick(0.0, 1.0, &someone), [Standing::Legal]);
    // An arm whose end is 0.4 m ahead of the centre.
    run.rules.footprint.push(Rectangle { offset: Planar::new(0.3, 0.0), size_m: Planar::new(0.2, 0.05) });
    assert!(matches!(run.tick(0.0, 1.0, &someone)[..], [Standing::Violated { .. }]));
}

#[test]
fn at_an_enabled_object_the_creeping_column_comes_nearer() {
    // 0.25 m/s: 0.1 s and 0.0125 m; 0.1 + 0.0125 + 0.25 + 0.16 = 0.5225 m. With r = 0.35: 0.6225 m.
    assert!(legal(0.25, at_object(0.523, 0.75)));
    assert!(!legal(0.25, at_object(0.522, 0.75)));
    assert!(!legal(0.25, at_object(0.622, 0.76)), "0.76 m is not at the object");
    // Faster than 0.25 m/s r is 0.35 also there: 0.26 m/s: 0.104 s, 0.01352 m; 0.1 + 0.0135 + 0.35 + 0.1664 = 0.6299 m.
    assert!(!legal(0.26, at_object(0.629, 0.5)));
    assert!(legal(0.26, at_object(0.631, 0.5)));
}

#[test]
fn a_head_leaves_an_object_later_than_it_comes() {
    let mut run = Run::settled(&[at_object(0.6, 0.75)]);
    assert_eq!(run.tick(0.0, 0.25, &[at_object(0.6, 0.85)]), [Standing::Legal], "still there at 0.85 m");
    assert_eq!(run.tick(0.0, 0.25, &[at_object(0.6, 0.86)]), [Standing::ExcusedGrowth], "left at 0.86 m");
    run.settle(&[at_object(0.6, 0.8)]);
    assert!(
        matches!(run.tick(0.0, 0.25, &[at_object(0.6, 0.8)])[..], [Standing::Violated { .. }]),
        "0.8 m is not back"
    );
}

#[test]
fn a_low_head_has_one_metre_also_at_an_object() {
    // 0.5 m/s: front at rest 0.15, 1 + 0.32: 1.47 m.
    assert!(legal(0.5, low(1.471)));
    assert!(!legal(0.5, low(1.469)));
    assert!(!legal(0.2, PersonNow { to_enabled_object_m: Some(0.1), ..low(1.0) }));
    assert!(legal(0.5, PersonNow { height_m: 1.0, ..low(1.469) }), "lower than 1 m, not at 1 m");
}

#[test]
fn when_r_grows_there_is_one_reaction_and_one_braking() {
    let (up, down) = ([person(0.9)], [low(0.9)]);
    let mut run = Run::settled(&up);
    assert_eq!(run.tick(0.0, 0.5, &up), [Standing::Legal]);
    // Growth at t0. Allowed until t0 + 50 ms + (0.5 + 1.25 * 0.05) / 2.5 = 275 ms. Constant speed in the reaction.
    for i in 0..13 {
        assert_eq!(run.tick(0.0, 0.5, &down), [Standing::ExcusedGrowth], "tick {i}");
    }
    // 52 ms after: it has to brake from here on.
    for i in 1..=56 {
        let v = 0.5 - 0.005 * f64::from(i);
        assert_eq!(run.tick(0.0, v, &down), [Standing::ExcusedGrowth], "braking tick {i}");
    }
    // 272 ms after was the last tick within.
    assert!(matches!(run.tick(0.0, 0.2, &down)[..], [Standing::Violated { .. }]));
}

#[test]
fn in_an_allowance_the_speed_must_not_rise_after_the_reaction() {
    let (up, down) = ([person(1.3)], [low(1.3)]);
    let mut run = Run::settled(&up);
    run.tick(0.0, 0.4, &up);
    (0..13).for_each(|i| {
        assert_eq!(run.tick(0.0, 0.4 + 0.005 * f64::from(i), &down), [Standing::ExcusedGrowth])
    });
    // 0.46 m/s now; 0.465 is within what cannot be told from no rise, 0.475 is not.
    assert_eq!(run.tick(0.0, 0.465, &down), [Standing::ExcusedGrowth]);
    assert!(
        matches!(run.tick(0.0, 0.475, &down)[..], [Standing::Violated { because, .. }] if because.contains("rose"))
    );
}

#[test]
fn growth_excuses_nothing_that_the_r_before_forbids() {
    let mut run = Run::settled(&[person(1.3)]);
    run.tick(0.0, 0.5, &[person(1.3)]);
    // At 0.82 m also r = 0.35 is broken at 0.5 m/s. The head moves there slowly enough for v_h.
    let mut x = 1.3;
    while x > 0.9 {
        x -= 0.006;
        run.tick(0.0, 0.0, &[person(x)]);
    }
    assert_eq!(run.tick(0.0, 0.5, &[low(x)]), [Standing::ExcusedGrowth]);
    let mut nearer = x;
    let mut standing = vec![Standing::ExcusedGrowth];
    while nearer > 0.81 {
        nearer -= 0.0063;
        standing = run.tick(0.0, 0.5, &[low(nearer)]);
    }
    assert!(matches!(standing[..], [Standing::Violated { .. }]), "{standing:?}");
}

#[test]
fn somebody_who_appears_gives_one_reaction_and_one_braking() {
    let mut run = Run::new();
    run.tick(0.0, 0.5, &[]);
    assert_eq!(run.tick(0.0, 0.5, &[person(0.6)]), [Standing::ExcusedGrowth]);
    run.at += Span::from_millis(268);
    assert_eq!(run.tick(0.0, 0.4, &[person(0.6)]), [Standing::ExcusedGrowth], "272 ms");
    assert!(matches!(run.tick(0.0, 0.4, &[person(0.6)])[..], [Standing::Violated { .. }]));
}

#[test]
fn a_person_faster_than_v_h_is_counted_apart_while_the_column_brakes() {
    let mut x = 1.6;
    let mut run = Run::settled(&[person(x)]);
    let mut step = |run: &mut Run, v: f64, pace: f64| {
        x -= pace * 0.004;
        run.tick(0.0, v, &[person(x)])
    };
    // 2 m/s for 80 ms, while the column drives 1 m/s: required is 1.29 m.
    (0..20).for_each(|_| assert_eq!(step(&mut run, 1.0, 2.0), [Standing::Legal]));
    (0..18).for_each(|_| assert_eq!(step(&mut run, 1.0, 2.0), [Standing::Legal]));
    // 1.296 m; the next tick is too near, the runner has run for longer than a reaction: brake at once.
    assert_eq!(step(&mut run, 1.0, 2.0), [Standing::ApartFastPerson]);
    assert_eq!(step(&mut run, 1.0, 2.0), [Standing::ApartFastPerson]);
    assert!(matches!(step(&mut run, 1.02, 2.0)[..], [Standing::Violated { .. }]));
}

#[test]
fn a_person_at_v_h_is_not_fast() {
    let mut run = Run::settled(&[person(1.0)]);
    assert!(matches!(run.tick(0.0, 0.5, &[person(1.0 - 1.6 * 0.004)])[..], [Standing::Legal]));
    let near = person(0.8);
    let mut run = Run::settled(&[near]);
    assert!(matches!(run.tick(0.0, 0.5, &[person(0.8 - 1.6 * 0.004)])[..], [Standing::Violated { .. }]));
}

/// The head at the origin, the carriage's nearest side `d` to its right, moving with this velocity.
fn retreat(run: &mut Run, d: f64, velocity: Planar, others: &[PersonNow]) -> Standing {
    let mut everyone = vec![person(0.0)];
    everyone.extend_from_slice(others);
    run.tick_planar(Floor::new(d + 0.1, 0.0), velocity, &everyone).swap_remove(0)
}

#[test]
fn the_column_may_retreat_slowly_straight_away_and_not_from_closer_than_r() {
    let judge = |d: f64, velocity: Planar| {
        let mut run = Run::settled(&[person(0.0)]);
        retreat(&mut run, d, Planar::ZERO, &[]);
        // Long enough for the way here not to count as d falling just now.
        run.at += Span::from_millis(1000);
        retreat(&mut run, d, Planar::ZERO, &[]);
        retreat(&mut run, d + 0.001, velocity, &[])
    };
    // Under the full rule 0.3 m/s away needs 0.35 + 0.192 - 0.018 = 0.524 m.
    assert_eq!(judge(0.53, Planar::new(0.3, 0.0)), Standing::Legal);
    assert_eq!(judge(0.5, Planar::new(0.3, 0.0)), Standing::Retreating);
    assert_eq!(judge(0.35, Planar::new(0.3, 0.0)), Standing::Retreating);
    let broken = |standing| matches!(standing, Standing::Violated { .. });
    assert!(broken(judge(0.348, Planar::new(0.3, 0.0))), "closer than 0.35 m");
    assert!(broken(judge(0.4, Planar::new(0.31, 0.0))), "faster than 0.3 m/s");
    assert_eq!(judge(0.4, Planar::new(0.3, 0.0).turned(59_f64.to_radians())), Standing::Retreating);
    assert!(
        broken(judge(0.4, Planar::new(0.3, 0.0).turned(61_f64.to_radians()))),
        "more than 60 degrees off"
    );
}

#[test]
fn no_retreat_while_d_falls_in_a_latched_stop_or_towards_others() {
    let away = Planar::new(0.3, 0.0);
    let broken = |standing| matches!(standing, Standing::Violated { .. });

    let mut run = Run::settled(&[person(0.0)]);
    // d has been falling for 0.2 s when it sets out: longer than a reaction and a braking from rest.
    for i in 0..50 {
        assert_eq!(retreat(&mut run, 0.45 - 0.001 * f64::from(i), Planar::ZERO, &[]), Standing::Legal);
    }
    assert!(broken(retreat(&mut run, 0.4, away, &[])), "d falls");

    let mut run = Run::settled(&[person(0.0)]);
    run.latched = true;
    retreat(&mut run, 0.4, Planar::ZERO, &[]);
    assert!(broken(retreat(&mut run, 0.401, away, &[])), "latched");

    // The other one, behind the column, must be under the full rule: rest 0.018 m on, 0.192 + 0.35 m: 0.56 m needed.
    for (gap, allowed) in [(0.57, true), (0.55, false)] {
        let other = PersonNow { id: PersonId(2), ..person(0.4 + 0.2 + gap + 0.001) };
        let mut run = Run::settled(&[person(0.0), other]);
        retreat(&mut run, 0.4, Planar::ZERO, &[other]);
        let standing = retreat(&mut run, 0.401, away, &[other]);
        assert_eq!(standing == Standing::Retreating, allowed, "{gap}: {standing:?}");
    }
}

#[test]
fn an_overtaken_retreat_is_counted_apart_for_one_reaction_and_one_braking() {
    let away = Planar::new(0.3, 0.0);
    let mut run = Run::settled(&[person(0.0)]);
    retreat(&mut run, 0.4, Planar::ZERO, &[]);
    assert_eq!(retreat(&mut run, 0.401, away, &[]), Standing::Retreating);
    // The person follows at 1 m/s. 50 ms of reaction at full speed, then braking.
    for i in 1..=13 {
        let d = 0.401 - 0.0028 * f64::from(i);
        assert_eq!(retreat(&mut run, d, away, &[]), Standing::ApartOvertakenRetreat, "tick {i}");
    }
    assert_eq!(retreat(&mut run, 0.36, away * 0.9, &[]), Standing::ApartOvertakenRetreat);
    assert!(matches!(retreat(&mut run, 0.359, away, &[]), Standing::Violated { .. }), "sped up again");
    // Turning towards the person is no retreat, overtaken or not.
    assert!(matches!(retreat(&mut run, 0.358, -away, &[]), Standing::Violated { .. }));
}

#[test]
fn keep_outs_have_the_same_r_and_stand_still() {
    let mut run = Run::new();
    run.rules.keep_outs.push(KeepOutShape::Circle { centre: Floor::new(2.0, 0.0), radius_m: 0.5 });
    run.settle(&[]);
    // 1 m/s: front at rest 0.3 m further than the centre now; the rim is at 1.5 m, 0.35 m before it is 1.15 m.
    assert_eq!(run.tick(0.849, 1.0, &[]), [Standing::Legal]);
    assert!(matches!(run.tick(0.851, 1.0, &[])[..], [Standing::Violated { .. }]));
}

#[test]
fn an_armed_contact_interaction_replaces_the_rule_for_that_visitor_alone() {
    let visitor = PersonNow { contact: Some(CONTACT), ..person(0.3) };
    let other = PersonNow { id: PersonId(2), ..person(0.3) };
    let mut run = Run::settled(&[visitor, other]);
    assert_eq!(run.tick(0.0, 0.5, &[visitor]), []);
    run.settle(&[visitor, other]);
    assert!(matches!(run.tick(0.0, 0.5, &[visitor, other])[..], [Standing::Violated { .. }]));
}
