use std::collections::BTreeSet;
use std::fmt::Write;
use std::io::Cursor;
use std::path::Path;

use proptest::prelude::*;

use super::*;
use crate::trace::Recordings;

/// A person who stands at (2, 0.5) m for a second, then walks to 0.6 m before the ball at (2, 3.4) m.
fn walk(walks_for_secs: f64) -> Recording {
    let total = 1.0 + walks_for_secs;
    let mut frames = String::new();
    for i in 0..=(total * 30.0).ceil() as i64 {
        let t = i as f64 / 30.0;
        let s = ((t - 1.0) / walks_for_secs).clamp(0.0, 1.0);
        let y = 0.5 + 2.3 * s * s * (3.0 - 2.0 * s);
        let comma = if i > 0 { "," } else { "" };
        write!(frames, "{comma}[{},2000,{},1600,1571,-150]", (t * 1000.0) as i64, (y * 1000.0) as i64)
            .unwrap();
    }
    let line = format!(
        r#"{{"dataset":"made","trial":"walk","user":"u","arena":{{"x":[0,4],"y":[0,4]}},"goal":"far","targets":[{{"id":"far","x":2,"y":3.4,"z":1.1,"r":0.1}}],"events":{{"reach":{total}}},"cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],"frames":[{frames}]}}"#
    );
    Recordings::from_lines(Path::new("made"), Box::new(Cursor::new(line))).next().unwrap().unwrap()
}

fn asked(recording: &Recording, start: Floor, v_h_mps: f64, limits: Limits) -> Bound {
    let travel = recording.travel();
    let scene = recording.scene(&[0]).unwrap();
    let (begins, reach) = (recording.frames[0].at, recording.events.reach.unwrap());
    let place = scene.objects()[0].column_place();
    bound(&Question { recording, scene: &scene, place, start, begins, reach, limits, travel, v_h_mps })
        .unwrap()
}

#[test]
fn an_easy_reach_is_possible_by_a_motion_within_the_limits() {
    let Bound::Possible(driven) = asked(&walk(4.0), Floor::new(1.0, 3.0), 1.6, Limits::PAPER) else {
        panic!("expected a motion");
    };
    assert_eq!(driven.verdict.violations(), 0);
    // 1.077 m as the crow flies, less what being near allows; the motion that is found need not be the shortest.
    assert!((0.95..6.0).contains(&driven.column_travel_m), "{}", driven.column_travel_m);
    assert!(driven.peaks[0] <= 1.1 + 1e-9 && driven.peaks[1] <= 2.5 + 1e-6, "{:?}", driven.peaks);
    assert!(driven.in_place_before_reach_secs > 0.15 && driven.distance_at_reach_m <= 0.1, "{driven:?}");
    let plan = driven.plan;
    assert_eq!(plan.at(0.0).position, Floor::new(1.0, 3.0));
    let mut before = plan.at(0.0);
    for tick in 1..1250 {
        let now = plan.at(f64::from(tick) * 0.004);
        let gained = now.velocity - before.velocity;
        assert!(now.velocity.x.abs() <= 1.1 + 1e-9 && now.velocity.y.abs() <= 1.1 + 1e-9);
        for (gained, v) in [(gained.x, before.velocity.x), (gained.y, before.velocity.y)] {
            let most_mps2 = if gained * v < -1e-12 { 2.5 } else { 1.25 };
            assert!(gained.abs() <= most_mps2 * 0.004 + 1e-9, "{gained} at {tick}");
        }
        assert!(now.position.distance_m(before.position) <= 1.56 * 0.004);
        before = now;
    }
}

#[test]
fn a_reach_for_which_there_is_no_time_is_impossible() {
    // 3.1 m along an axis within 1.9 s.
    assert_eq!(asked(&walk(0.9), Floor::new(3.8, 0.3), 1.6, Limits::PAPER), Bound::Impossible);
}

#[test]
fn a_person_in_the_way_all_the_time_makes_it_impossible() {
    // The person stands 0.2 m from the place: crawling, so with r 1 m, nothing may move there.
    let mut recording = walk(1.0);
    recording.frames.iter_mut().for_each(|frame| frame.y_m = 3.2);
    recording.frames.iter_mut().for_each(|frame| frame.z_m = Some(0.8));
    assert_eq!(asked(&recording, Floor::new(1.2, 2.9), 1.6, Limits::PAPER), Bound::Impossible);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// What makes the lenient search lenient: it can follow whatever an axis may do, within what the rule is blurred by.
    #[test]
    fn any_motion_of_an_axis_is_followed_closely_by_the_lenient_lattice(
        pushes in prop::collection::vec((-1.0..1.0f64, 1..14usize, any::<bool>()), 1..14),
    ) {
        let own = Limits::PAPER.x;
        let step_secs = step_secs(&Limits::PAPER, LENIENT_LEVELS);
        let lattice = AxisLattice::new(&own, HASTE, step_secs, [-9.0, 9.0], 0.0);
        let moves = lattice.moves();
        let unit_m = lattice.place_m(1) - lattice.place_m(0);
        let (mut place, mut speed) = (0.0f64, 0.0f64);
        let mut near: BTreeSet<(i32, i32)> = [(0, 0)].into();
        let (parts, mut part) = (16, 0);
        for (push, lasts, full) in pushes {
            for _ in 0..lasts * 4 {
                // Full pushes are the worst case; others are anything between.
                let push = if full { push.signum() } else { push };
                let brakes = push * speed < 0.0;
                let most = if brakes { own.braking_mps2 } else { own.acceleration_mps2 };
                let dt = step_secs / f64::from(parts);
                let next = speed + push * most * dt;
                let next = if brakes && next * speed < 0.0 { 0.0 } else { next };
                let next = next.clamp(-own.speed_mps, own.speed_mps);
                place += 0.5 * (speed + next) * dt;
                speed = next;
                part += 1;
                if part % parts != 0 {
                    continue;
                }
                near = near
                    .iter()
                    .flat_map(|&(x, v)| {
                        moves.iter().filter(move |step| step.from == v).map(move |step| (x + step.covers(), step.to))
                    })
                    .filter(|&(x, v)| {
                        (f64::from(x) * unit_m - place).abs() <= BLUR_M
                            && (f64::from(v) * lattice.quantum_mps() - speed).abs() <= lattice.quantum_mps()
                    })
                    .collect();
                prop_assert!(!near.is_empty(), "lost at {place} m, {speed} m/s");
            }
        }
    }
}
