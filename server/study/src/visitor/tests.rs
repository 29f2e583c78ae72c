//! The visitor moves like recorded people, and nothing but the seed decides how.

use super::*;

fn demo(seed: u64) -> Visitor {
    let arena = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
    let places = [(0.6, 0.7), (3.3, 0.8), (3.4, 3.2), (0.7, 3.3), (2.0, 2.2)];
    let goals = (0..)
        .zip(places)
        .map(|(object, (x, y))| VisitorGoal { object, position: Point::new(x, y, 1.1) })
        .collect();
    Visitor::new(arena, goals, 90.0, seed)
}

/// Horizontal speeds from half a second before setting out to the arrival, as in the recorded responses; sorted, m/s.
fn speeds_on_the_way(samples: usize) -> Vec<f64> {
    let mut speeds = Vec::new();
    for seed in 0..10 {
        let visit: Vec<_> = demo(seed).take(samples / 10).collect();
        for (pair, soon) in visit.windows(2).zip(visit.iter().skip(45)) {
            let sets_out = pair[1].phase == Phase::Searches && soon.phase == Phase::Walks;
            if sets_out || matches!(pair[1].phase, Phase::Walks | Phase::Reaches) {
                let step = pair[0].pose.position.floor().distance_m(pair[1].pose.position.floor());
                speeds.push(step * 90.0);
            }
        }
    }
    speeds.sort_by(f64::total_cmp);
    speeds
}

#[test]
fn speeds_have_the_percentiles_of_recorded_people() {
    let speeds = speeds_on_the_way(400_000);
    let percentile = |p: f64| speeds[(p * (speeds.len() - 1) as f64) as usize];
    let found = [0.5, 0.95, 0.99, 1.0].map(percentile);
    for (found_mps, (recorded_mps, tolerance_mps)) in
        found.into_iter().zip([(0.26, 0.05), (0.87, 0.06), (1.12, 0.08), (1.58, 0.1)])
    {
        assert!(
            (found_mps - recorded_mps).abs() <= tolerance_mps,
            "found {found:?} m/s, recorded p50/p95/p99/max 0.26/0.87/1.12/1.58"
        );
    }
}

#[test]
fn the_seed_decides_the_visit() {
    let of = |seed| demo(seed).take(20_000).collect::<Vec<_>>();
    assert_eq!(of(3), of(3));
    assert_ne!(of(3), of(4));
}

#[test]
fn a_reach_ends_an_arms_length_before_the_object_looking_at_it() {
    let mut distances = Vec::new();
    let mut before = Phase::Reads;
    for sample in demo(1).take(100_000) {
        if before == Phase::Reaches && sample.phase == Phase::Dwells {
            let object = demo(1).goals[sample.goal.unwrap()].position;
            let head = sample.pose.position;
            distances.push(head.floor().distance_m(object.floor()));
            let to_object = (object.vector() - head.vector()).normalize();
            assert!(sample.pose.view().dot(&to_object) > 0.95, "looks elsewhere at {:?}", sample.at);
        }
        before = sample.phase;
    }
    assert!(distances.len() > 80, "{} reaches", distances.len());
    assert!(distances.iter().all(|d| (0.45..0.75).contains(d)), "{distances:?}");
}

/// And it is nearly there before: the hand sets out while the head still comes.
#[test]
fn a_reach_ends_with_a_hand_at_the_object_and_the_hand_goes_back_to_the_side() {
    let goals = demo(4).goals;
    let visit: Vec<_> = demo(4).take(100_000).collect();
    let off = |sample: &VisitorSample| {
        let object = goals[sample.goal.unwrap()].position;
        let hands = sample.hands.both();
        hands.into_iter().flatten().map(|hand| hand.distance_m(&object)).fold(f64::INFINITY, f64::min)
    };
    let mut reaches = 0;
    for pair in
        visit.windows(2).filter(|pair| pair[1].phase == Phase::Dwells && pair[0].phase != Phase::Dwells)
    {
        // The shoulder is 0.25 m beneath the eyes; what is farther from it than an arm is pointed at.
        let object = goals[pair[1].goal.unwrap()].position;
        let shoulder = pair[1].pose.position.vector() - nalgebra::Vector3::z() * 0.25;
        let beyond_m = ((object.vector() - shoulder).norm() - 0.7).max(0.0);
        assert!(off(&pair[1]) < beyond_m + 0.02, "{} m off at {:?}", off(&pair[1]), pair[1].at);
        reaches += 1;
    }
    assert!(reaches > 80, "{reaches} reaches");
    for sample in visit.iter().filter(|sample| sample.phase == Phase::Reads) {
        for hand in sample.hands.both().into_iter().flatten() {
            assert!(hand.floor().distance_m(sample.pose.position.floor()) < 0.35, "{sample:?}");
        }
    }
}

#[test]
fn hands_neither_jump_nor_go_faster_than_hands_do() {
    for pair in demo(6).take(100_000).collect::<Vec<_>>().windows(2) {
        for (a, b) in pair[0].hands.both().into_iter().zip(pair[1].hands.both()) {
            let step_m = a.zip(b).map_or(0.0, |(a, b)| a.distance_m(&b));
            assert!(step_m * 90.0 < 4.0, "{} m/s at {:?}", step_m * 90.0, pair[1].at);
        }
    }
}

#[test]
fn the_head_stays_in_the_arena_and_neither_jumps_nor_spins() {
    let visit: Vec<_> = demo(2).take(100_000).collect();
    for pair in visit.windows(2) {
        let [a, b] = [pair[0].pose, pair[1].pose];
        assert!(demo(2).arena.depth_m(b.position.floor()) > 0.1);
        assert!(a.position.distance_m(&b.position) * 90.0 < 1.65, "jump at {:?}", pair[1].at);
        assert!(a.orientation.angle_to(&b.orientation) * 90.0 < 4.0, "spin at {:?}", pair[1].at);
    }
    let goals: std::collections::BTreeSet<_> = visit.iter().filter_map(|sample| sample.goal).collect();
    assert_eq!(goals.len(), 5, "every object is visited");
}

#[test]
fn searching_heads_scan_and_walking_heads_do_not() {
    let visit: Vec<_> = demo(5).take(100_000).collect();
    let mean_turn = |phase: Phase| {
        let turns: Vec<f64> = visit
            .windows(2)
            .filter(|pair| pair[1].phase == phase)
            .map(|pair| pair[0].pose.orientation.angle_to(&pair[1].pose.orientation) * 90.0)
            .collect();
        turns.iter().sum::<f64>() / turns.len() as f64
    };
    assert!(mean_turn(Phase::Searches) > 3.0 * mean_turn(Phase::Walks));
}

#[test]
fn a_scene_with_one_object_or_none_is_visited_too() {
    let arena = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(3.0, 3.0) };
    let only = VisitorGoal { object: 4, position: Point::new(1.0, 1.0, 1.0) };
    let visit: Vec<_> = Visitor::new(arena, vec![only], 75.0, 1).take(20_000).collect();
    let arrivals = visit.windows(2).filter(|p| p[0].phase == Phase::Reaches && p[1].phase == Phase::Dwells);
    let goals: Vec<_> = arrivals.map(|p| p[1].goal).collect();
    assert!(goals.len() > 10 && goals.iter().all(|goal| *goal == Some(4)), "{goals:?}");
    assert!(Visitor::new(arena, Vec::new(), 75.0, 1).take(20_000).all(|sample| sample.goal.is_none()));
}
