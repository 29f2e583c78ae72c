use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;

use super::*;

/// A small noise of a known bound, so that what is found can be held to one.
fn noise(seed: u64, index: usize, size_m: f64) -> Vector3<f64> {
    let at = |axis: u64| {
        let mixed = (seed ^ (index as u64 * 3 + axis).wrapping_mul(0x9E37_79B9_7F4A_7C15))
            .wrapping_mul(0xBF58_476D_1CE4_E5B9);
        ((mixed >> 33) as f64 / f64::from(u32::MAX >> 1) - 0.5) * 2.0 * size_m
    };
    Vector3::new(at(0), at(1), at(2))
}

struct Drawn {
    truth: Isometry3<f64>,
    visits: Vec<ColumnVisit>,
    touched: Vec<Pair>,
}

fn draw(seed: u64, yaw: f64, shift: [f64; 3], offset: [f64; 3], size_m: f64) -> Drawn {
    let truth = Isometry3::from_parts(
        Translation3::from(Vector3::from(shift)),
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw),
    );
    let seen = |room: Vector3<f64>, index: usize| {
        Point::from_vector(truth.inverse_transform_point(&(room + noise(seed, index, size_m)).into()).coords)
    };
    let visits = (0..9)
        .map(|i| {
            let column = Floor::new((i % 3) as f64 * 1.5 + 0.5, (i / 3) as f64 * 1.2 + 0.5);
            let headset = Vector3::new(column.x, column.y, 0.0) + Vector3::from(offset);
            ColumnVisit { tracking: seen(headset, i), column }
        })
        .collect();
    let touched = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 3.0, 0.0], [0.0, 3.0, 0.0]]
        .into_iter()
        .enumerate()
        .map(|(i, place)| Pair {
            tracking: seen(place.into(), 9 + i),
            room: Point::from_vector(place.into()),
        })
        .collect();
    Drawn { truth, visits, touched }
}

fn apart_m(truth: &Isometry3<f64>, fit: &ColumnFit, at: Vector3<f64>) -> f64 {
    let seen = Point::from_vector(truth.inverse_transform_point(&at.into()).coords);
    (fit.room.room_from_tracking.point(&seen).vector() - at).norm()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn visits_and_touched_points_give_map_and_offset(
        seed in any::<u64>(),
        yaw in -3.1..3.1,
        shift in prop::array::uniform3(-3.0..3.0),
        offset in prop::array::uniform3(-0.4..0.4),
    ) {
        let offset = [offset[0], offset[1], offset[2] + 1.5];
        let drawn = draw(seed, yaw, shift, offset, 0.002);
        let fit = fit_column(&drawn.visits, &drawn.touched, None, &Bounds::default()).unwrap();
        for axis in 0..3 {
            prop_assert!((fit.offset_m[axis] - offset[axis]).abs() < 0.004, "{:?}, not {offset:?}", fit.offset_m);
        }
        for at in [Vector3::new(2.0, 1.5, 0.0), Vector3::new(2.0, 1.5, 1.7)] {
            let apart = apart_m(&drawn.truth, &fit, at);
            prop_assert!(apart < 0.006, "{apart} m off");
        }
        prop_assert_eq!(fit.room.residuals.len(), 13);
        prop_assert!(fit.room.rms_m < 0.004);
    }

    #[test]
    fn a_given_offset_needs_no_touched_point(seed in any::<u64>(), yaw in -3.1..3.1, shift in prop::array::uniform3(-3.0..3.0)) {
        let offset = [0.1, 0.2, 1.6];
        let drawn = draw(seed, yaw, shift, offset, 0.002);
        let fit = fit_column(&drawn.visits, &[], Some(offset), &Bounds::default()).unwrap();
        prop_assert!(apart_m(&drawn.truth, &fit, Vector3::new(2.0, 1.5, 1.6)) < 0.004);
    }
}

#[test]
fn without_an_offset_and_touched_points_it_is_refused() {
    let drawn = draw(1, 0.4, [1.0, 2.0, 0.0], [0.1, 0.0, 1.5], 0.0);
    let refused = fit_column(&drawn.visits, &drawn.touched[..2], None, &Bounds::default());
    assert_eq!(refused, Err(CalibrationRefusal::OffsetUnknown { found: 2, fewest: FEWEST_TOUCHED }));
    let refused = fit_column(&drawn.visits[..5], &drawn.touched, None, &Bounds::default());
    assert_eq!(refused, Err(CalibrationRefusal::TooFewPoints { found: 5, fewest: FEWEST_POINTS }));
}

#[test]
fn a_touched_point_that_is_wrong_is_left_out() {
    let mut drawn = draw(2, -1.0, [0.5, 0.0, 0.2], [0.1, 0.0, 1.5], 0.001);
    let room = drawn.touched[1].room;
    drawn.touched[1].room = Point::new(room.x() + 0.3, room.y(), room.z());
    let fit = fit_column(&drawn.visits, &drawn.touched, None, &Bounds::default()).unwrap();
    assert!(!fit.room.residuals[10].used);
    assert!(apart_m(&drawn.truth, &fit, Vector3::new(2.0, 1.5, 1.0)) < 0.004);
}
