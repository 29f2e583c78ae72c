//! Hands that go out, swing, rest, jump and are not there.

use super::super::super::tests::{sight, view};
use super::super::super::{Belief, Rule};
use super::super::{Bayes, BayesParameters};
use super::*;
use crate::frames::Point;
use proptest::prelude::*;

fn rule() -> Bayes {
    Bayes::new(BayesParameters::default())
}

/// The right hand at these places from the head, m, at 75 Hz; the head stands still and looks along +x.
fn reached(rule: &mut Bayes, sights: &[Sight], offs: &[Option<Vector3<f64>>]) -> Belief {
    let mut belief = Belief::default();
    for (k, off) in (0..).zip(offs) {
        let seen = View { velocity: Planar::ZERO, ..view(k * 1000 / 75, sights) };
        let right = off.map(|off| Point::from_vector(seen.head.position.vector() + off));
        rule.weigh(&View { hands: Hands { left: None, right }, ..seen }, &mut belief);
    }
    belief
}

/// From one place to the other in so many poses, at one speed.
fn straight(from: Vector3<f64>, to: Vector3<f64>, poses: usize) -> Vec<Option<Vector3<f64>>> {
    (0..=poses).map(|k| Some(from + (to - from) * (k as f64 / poses as f64))).collect()
}

fn place(sight: &Sight) -> Vector3<f64> {
    Vector3::new(sight.offset.x, sight.offset.y, sight.rise_m)
}

/// In front of the belly, m from the head.
const AT_REST: Vector3<f64> = Vector3::new(0.3, -0.15, -0.5);

/// Two lamps at arm's length, to both sides of the view, and the hand's way to the left one.
fn two_lamps() -> [Sight; 2] {
    [Sight { rise_m: -0.3, ..sight(0.7, 25.0, 1.0) }, Sight { rise_m: -0.3, ..sight(0.7, -25.0, 1.0) }]
}

#[test]
fn a_hand_that_goes_out_tells_neighbours_apart_before_it_is_there() {
    let lamps = two_lamps();
    let from = Vector3::new(0.35, 0.0, -0.4);
    let way = straight(from, place(&lamps[0]), 30);
    let belief = reached(&mut rule(), &lamps, &way[..=20]);
    assert!(belief.weights[0] > 0.9 && belief.committed == Some(0), "{belief:?}");
}

#[test]
fn what_a_hand_did_is_forgotten_soon() {
    let lamps = two_lamps();
    let mut way = straight(Vector3::new(0.35, 0.0, -0.4), place(&lamps[0]), 30);
    way.extend(std::iter::repeat_n(Some(place(&lamps[0])), 3 * 75));
    let belief = reached(&mut rule(), &lamps, &way);
    assert!((belief.weights[0] / belief.weights[1] - 1.0).abs() < 0.1, "{belief:?}");
}

#[test]
fn a_hand_that_rests_swings_at_the_hip_or_is_drawn_back_says_nothing() {
    let lamps = two_lamps();
    let nothing = reached(&mut rule(), &lamps, &[None; 60]);
    let swings: Vec<_> =
        (0..60).map(|k| Some(Vector3::new(0.2 * (f64::from(k) * 0.08).sin(), -0.25, -0.8))).collect();
    let trembles: Vec<_> = (0..60)
        .map(|k| Some(AT_REST + Vector3::new(0.15, 0.1, 0.2) + Vector3::x() * 0.001 * f64::from(k % 2)))
        .collect();
    let back = straight(Vector3::new(0.7, 0.0, -0.3), Vector3::new(0.1, 0.0, -0.3), 59);
    for (what, offs) in [("swings", swings), ("trembles", trembles), ("is drawn back", back)] {
        let belief = reached(&mut rule(), &lamps, &offs);
        for (with, without) in belief.weights.iter().zip(&nothing.weights) {
            assert!((with - without).abs() < 0.02, "a hand that {what}: {belief:?}, without {nothing:?}");
        }
    }
}

#[test]
fn a_hand_that_tracking_finds_elsewhere_did_not_go_there() {
    let lamps = two_lamps();
    let jumps: Vec<_> = [AT_REST; 30].into_iter().chain([place(&lamps[0]); 30]).map(Some).collect();
    assert_eq!(reached(&mut rule(), &lamps, &jumps), reached(&mut rule(), &lamps, &[None; 60]));
}

#[test]
fn who_reaches_where_nothing_is_means_none_of_them() {
    let behind = [sight(1.0, 120.0, 1.0), sight(1.0, -120.0, 1.0)];
    let out = straight(AT_REST, Vector3::new(0.8, -0.1, -0.1), 40);
    let with = reached(&mut rule(), &behind, &out);
    let without = reached(&mut rule(), &behind, &[None; 41]);
    assert!(with.none > 4.0 * without.none, "{with:?}, without a hand {without:?}");
}

/// Coordinates from the head, m; some nonsense among them.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![20 => -1.2..1.2f64, 1 => Just(f64::NAN), 1 => Just(f64::INFINITY), 1 => -1e9..1e9f64]
}

fn off() -> impl Strategy<Value = Option<Vector3<f64>>> {
    let point = (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| Vector3::new(x, y, z));
    prop::option::weighted(0.9, point)
}

fn sights() -> impl Strategy<Value = Vec<Sight>> {
    let one = (0.3..3.0f64, -180.0..180.0f64, -1.2..0.5f64, 0.05..1.0f64);
    let one = one
        .prop_map(|(away_m, angle_deg, rise_m, prior)| Sight { rise_m, ..sight(away_m, angle_deg, prior) });
    prop::collection::vec(one, 1..8)
}

proptest! {
    #[test]
    fn whatever_hands_do_the_belief_is_a_distribution(
        sights in sights(), offs in prop::collection::vec(off(), 1..60),
    ) {
        let belief = reached(&mut rule(), &sights, &offs);
        let in_range = |p: f64| (0.0..=1.0).contains(&p);
        prop_assert!(belief.weights.iter().all(|p| in_range(*p)) && in_range(belief.none), "{:?}", belief);
        prop_assert!((belief.total() - 1.0).abs() < 1e-9, "{:?}", belief);
    }

    /// At every moment of the way, not at its end alone.
    #[test]
    fn a_hand_on_its_way_to_an_object_never_lowers_it(
        sights in sights(), goal in any::<prop::sample::Index>(), from in (-0.5..0.5f64, -0.5..0.5f64, -0.9..0.2f64),
        poses in 15..120usize,
    ) {
        let goal = goal.index(sights.len());
        let from = Vector3::new(from.0, from.1, from.2);
        let way = straight(from, place(&sights[goal]), poses);
        for so_far in (1..=way.len()).step_by(5) {
            let with_hand = reached(&mut rule(), &sights, &way[..so_far]);
            let without = reached(&mut rule(), &sights, &vec![None; so_far]);
            prop_assert!(with_hand.weights[goal] >= without.weights[goal] - 1e-9, "{:?}, without {:?}", with_hand, without);
        }
    }

    /// Bit for bit the filter of the head, whatever the numbers of the hands are.
    #[test]
    fn without_a_tracked_hand_it_is_what_head_and_walk_say(
        sights in sights(), poses in 1..90usize, hand_rate in 0.0..1e3f64, hand_secs in 0.05..5.0f64,
    ) {
        let mut rule = Bayes::new(BayesParameters { hand_rate, hand_secs, ..BayesParameters::default() });
        let belief = reached(&mut rule, &sights, &vec![None; poses]);
        let most = rule.now.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut expected: Vec<f64> = rule.probabilities.iter().zip(&rule.now).map(|(p, now)| p * (now - most).exp()).collect();
        let total: f64 = expected.iter().sum();
        expected.iter_mut().for_each(|p| *p /= total);
        let found: Vec<u64> = belief.weights.iter().chain([&belief.none]).map(|p| p.to_bits()).collect();
        prop_assert_eq!(found, expected.iter().map(|p| p.to_bits()).collect::<Vec<_>>());
    }
}
