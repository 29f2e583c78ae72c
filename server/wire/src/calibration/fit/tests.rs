//! Truths are drawn anywhere: a turn, a shift, 12 places over an arena of 4 m by 4 m and 2 m high, two of them wrong.

use std::f64::consts::{PI, TAU};

use covr_engine::frames::{Point, Pose};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng};

use super::*;

/// What a fit is held against, and what it was given.
struct Drawn {
    truth: Isometry3<f64>,
    pairs: Vec<Pair>,
    wrong: [usize; 2],
}

struct Chance(TestRng);

impl Chance {
    fn new(seed: u64) -> Self {
        let mut bytes = [0; 32];
        bytes[..8].copy_from_slice(&seed.to_le_bytes());
        Self(TestRng::from_seed(RngAlgorithm::ChaCha, &bytes))
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Box and Muller.
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.within(0.0, 1.0)).ln()).sqrt();
        radius * (TAU * self.within(0.0, 1.0)).cos()
    }

    fn vector(&mut self, sigma: f64) -> Vector3<f64> {
        Vector3::new(self.normal(), self.normal(), self.normal()) * sigma
    }

    fn direction(&mut self) -> Vector3<f64> {
        self.vector(1.0).normalize()
    }

    /// `poses` of each place are averaged; each has noise `sigma_m` along each axis.
    fn draw(&mut self, points: usize, sigma_m: f64, poses: usize) -> Drawn {
        let tilt = UnitQuaternion::from_scaled_axis(
            Vector3::new(self.normal(), self.normal(), 0.0) * 0.3_f64.to_radians(),
        );
        let yaw = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.within(-PI, PI));
        let shift = Vector3::new(self.within(-5.0, 5.0), self.within(-5.0, 5.0), self.within(-1.0, 1.0));
        let truth = Isometry3::from_parts(Translation3::from(shift), tilt * yaw);
        // One place in each of the fields of a grid, as a guided procedure asks for.
        let places: Vec<Vector3<f64>> = (0..points)
            .map(|i| {
                let (column, row) = ((i % 4) as f64, (i / 4) as f64);
                let rows = points.div_ceil(4) as f64;
                Vector3::new(
                    column + self.within(0.0, 1.0),
                    (row + self.within(0.0, 1.0)) * 4.0 / rows,
                    self.within(0.0, 2.0),
                )
            })
            .collect();
        let first = self.within(0.0, points as f64) as usize;
        let second = (first + 1 + self.within(0.0, points as f64 - 1.0) as usize) % points;
        let wrong = [first, second];
        let pairs = places
            .into_iter()
            .enumerate()
            .map(|(index, room)| {
                let mut noise = Vector3::zeros();
                for _ in 0..poses {
                    noise += self.vector(sigma_m) / poses as f64;
                }
                if wrong.contains(&index) {
                    noise += self.direction() * self.within(0.1, 1.0);
                }
                let seen = truth.inverse_transform_point(&(room + noise).into()).coords;
                Pair { tracking: Point::from_vector(seen), room: Point::from_vector(room) }
            })
            .collect();
        Drawn { truth, pairs, wrong }
    }
}

/// How far the map is off at the worst place of a right point (m), and how far it is turned (rad).
fn off(drawn: &Drawn, found: &RoomFromTracking) -> (f64, f64) {
    let right = drawn.pairs.iter().enumerate().filter(|(index, _)| !drawn.wrong.contains(index));
    let farthest = right
        .map(|(_, pair)| {
            let seen = drawn.truth.inverse_transform_point(&pair.room.vector().into()).coords;
            found.point(&Point::from_vector(seen)).distance_m(&pair.room)
        })
        .fold(0.0, f64::max);
    let still = Pose { position: Point::new(0.0, 0.0, 0.0), orientation: UnitQuaternion::identity() };
    (farthest, found.pose(&still).orientation.angle_to(&drawn.truth.rotation))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// The figure, as the guided procedure measures: 5 mm of noise along each axis of every pose, a second of them at each
    /// of 12 points, two of which are 10 cm to 1 m wrong. Held wherever a right point was, not at their centre alone; in a corner of the
    /// arena whose own points were the wrong ones it can be 2.5 mm.
    #[test]
    fn a_truth_is_found_within_2_mm_and_a_fifth_of_a_degree(seed in any::<u64>()) {
        let drawn = Chance::new(seed).draw(12, 0.005, 90);
        let fit = fit_room(&drawn.pairs, &Bounds::default()).unwrap();
        let (metres, turn) = off(&drawn, &fit.room_from_tracking);
        prop_assert!(metres < 0.002, "{metres} m off");
        prop_assert!(turn < 0.2_f64.to_radians(), "{turn} rad off");
        for index in drawn.wrong {
            prop_assert!(!fit.residuals[index].used, "point {index} is wrong and used");
        }
        prop_assert!(fit.residuals.iter().filter(|residual| !residual.used).count() <= 3);
        prop_assert!((fit.scale - 1.0).abs() < 0.002);
    }

    /// Ten poses of independent noise at each point are enough for it, at the centre of the points.
    #[test]
    fn ten_poses_at_a_point_are_enough_at_the_centre(seed in any::<u64>()) {
        let drawn = Chance::new(seed).draw(12, 0.005, 12);
        let fit = fit_room(&drawn.pairs, &Bounds::default()).unwrap();
        let right = drawn.pairs.iter().enumerate().filter(|(index, _)| !drawn.wrong.contains(index));
        let centre = right.map(|(_, pair)| pair.room.vector()).sum::<Vector3<f64>>() / 10.0;
        let seen = Point::from_vector(drawn.truth.inverse_transform_point(&centre.into()).coords);
        let metres = (fit.room_from_tracking.point(&seen).vector() - centre).norm();
        prop_assert!(metres < 0.0022, "{metres} m off");
    }

    #[test]
    fn without_noise_the_truth_itself_is_found(seed in any::<u64>()) {
        let drawn = Chance::new(seed).draw(12, 0.0, 1);
        let fit = fit_room(&drawn.pairs, &Bounds::default()).unwrap();
        let (metres, turn) = off(&drawn, &fit.room_from_tracking);
        prop_assert!(metres < 1e-9 && turn < 1e-7, "{metres} m, {turn} rad");
        prop_assert!(fit.rms_m < 1e-9);
    }

    /// Points may come in any order.
    #[test]
    fn the_order_of_the_points_does_not_matter(seed in any::<u64>(), by in 1_usize..12) {
        let drawn = Chance::new(seed).draw(12, 0.005, 20);
        let mut turned = drawn.pairs.clone();
        turned.rotate_left(by);
        let (one, other) =
            (fit_room(&drawn.pairs, &Bounds::default()).unwrap(), fit_room(&turned, &Bounds::default()).unwrap());
        let at = Point::new(1.0, 2.0, 1.5);
        let apart = one.room_from_tracking.point(&at).distance_m(&other.room_from_tracking.point(&at));
        prop_assert!(apart < 1e-6, "{apart} m apart");
    }

    /// A mirror image is refused, whatever the layout.
    #[test]
    fn a_mirrored_tracking_space_is_refused(seed in any::<u64>(), flat in any::<bool>()) {
        let mut drawn = Chance::new(seed).draw(12, 0.001, 1);
        for pair in &mut drawn.pairs {
            if flat {
                let on_floor = Point::new(pair.room.x(), pair.room.y(), 0.0);
                let shift = on_floor.vector() - pair.room.vector();
                pair.tracking = Point::from_vector(pair.tracking.vector() + drawn.truth.rotation.inverse() * shift);
                pair.room = on_floor;
            }
            pair.tracking = Point::new(-pair.tracking.x(), pair.tracking.y(), pair.tracking.z());
        }
        prop_assert_eq!(fit_room(&drawn.pairs, &Bounds::default()), Err(CalibrationRefusal::Mirrored));
    }
}

/// What one pose a point can give, and what it cannot: the standard error of the shift alone is 5 / sqrt(10) = 1.6 mm along
/// each axis. The fit is as good as theory allows, and says how uncertain it is; no fit could keep to 2 mm in every draw.
#[test]
fn with_one_pose_a_point_it_is_as_good_as_theory_allows_and_says_so() {
    let mut chance = Chance::new(6);
    let draws = 1_000;
    let (mut squares, mut within, mut turned, mut covered, mut fitted) = (0.0, 0, 0, 0, 0);
    for _ in 0..draws {
        let drawn = chance.draw(12, 0.005, 1);
        let Ok(fit) = fit_room(&drawn.pairs, &Bounds::default()) else { continue };
        fitted += 1;
        let right: Vec<Vector3<f64>> = drawn
            .pairs
            .iter()
            .enumerate()
            .filter(|(index, _)| !drawn.wrong.contains(index))
            .map(|(_, pair)| pair.room.vector())
            .collect();
        let centre = right.iter().sum::<Vector3<f64>>() / right.len() as f64;
        let at = |place: &Vector3<f64>| {
            let seen = Point::from_vector(drawn.truth.inverse_transform_point(&(*place).into()).coords);
            (fit.room_from_tracking.point(&seen).vector() - place).norm()
        };
        squares += at(&centre).powi(2);
        within += usize::from(at(&centre) < 0.002);
        let farthest =
            right.iter().max_by(|a, b| (*a - centre).norm().total_cmp(&(*b - centre).norm())).unwrap();
        covered += usize::from(at(farthest) < fit.uncertainty_m);
        turned += usize::from(off(&drawn, &fit.room_from_tracking).1 < 0.2_f64.to_radians());
    }
    let rms_mm = (squares / f64::from(fitted)).sqrt() * 1e3;
    let share = |count: usize| 100.0 * count as f64 / f64::from(fitted);
    println!(
        "one pose a point, 5 mm along each axis: {fitted} of {draws} accepted; centre {rms_mm:.2} mm rms (theory 2.74); \
         within 2 mm {:.0} %, within 0.2 degrees {:.0} %; the stated 95 % holds in {:.0} %",
        share(within),
        share(turned),
        share(covered)
    );
    assert!(rms_mm < 2.74 * 1.1, "{rms_mm} mm");
    assert!((92.0..99.0).contains(&share(covered)), "{} %", share(covered));
}

fn grid() -> Vec<Pair> {
    let at = |i: usize| Point::new((i % 4) as f64, (i / 4) as f64, (i % 3) as f64 * 0.5);
    (0..12).map(|i| Pair { tracking: Point::from_vector(at(i).vector()), room: at(i) }).collect()
}

fn moved(change: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Vec<Pair> {
    grid()
        .into_iter()
        .map(|pair| Pair { tracking: Point::from_vector(change(pair.tracking.vector())), ..pair })
        .collect()
}

#[test]
fn wrong_units_are_called_that() {
    let refused = fit_room(&moved(|p| p * 100.0), &Bounds::default()).unwrap_err();
    assert!(matches!(refused, CalibrationRefusal::WrongScale { .. }), "{refused:?}");
    assert!(refused.to_string().contains("centimetres"), "{refused}");
    let refused = fit_room(&moved(|p| p * 1.015), &Bounds::default()).unwrap_err();
    assert!(matches!(refused, CalibrationRefusal::WrongScale { .. }), "{refused:?}");
    assert!(fit_room(&moved(|p| p * 1.005), &Bounds::default()).is_ok());
}

#[test]
fn a_headset_that_never_moved_is_refused() {
    let refused = fit_room(&moved(|_| Vector3::zeros()), &Bounds::default()).unwrap_err();
    assert!(matches!(refused, CalibrationRefusal::WrongScale { .. }), "{refused:?}");
}

#[test]
fn layouts_that_tell_too_little_are_refused() {
    let of = |places: Vec<[f64; 3]>| {
        let pairs: Vec<Pair> = places
            .into_iter()
            .map(|p| Pair { tracking: Point::from_vector(p.into()), room: Point::from_vector(p.into()) })
            .collect();
        fit_room(&pairs, &Bounds::default()).unwrap_err()
    };
    let few = of((0..5).map(|i| [f64::from(i), f64::from(i * i), 0.0]).collect());
    assert_eq!(few, CalibrationRefusal::TooFewPoints { found: 5, fewest: FEWEST_POINTS });
    let many = of((0..31).map(|i| [f64::from(i), f64::from(i % 3), 0.0]).collect());
    assert_eq!(many, CalibrationRefusal::TooManyPoints { found: 31, most: MOST_POINTS });
    let line = of((0..12).map(|i| [f64::from(i) * 0.3, f64::from(i % 2) * 0.1, 0.0]).collect());
    assert!(matches!(line, CalibrationRefusal::PointsOnALine { .. }), "{line:?}");
    let heap = of((0..12).map(|i| [f64::from(i % 4) * 0.2, f64::from(i / 4) * 0.2, 0.0]).collect());
    assert!(matches!(heap, CalibrationRefusal::PointsTooClose { .. }), "{heap:?}");
}

#[test]
fn a_tilted_tracking_space_is_refused() {
    let tilt = |degrees: f64| {
        let turn = UnitQuaternion::from_scaled_axis(Vector3::x() * degrees.to_radians());
        fit_room(&moved(|p| turn * p), &Bounds::default())
    };
    assert!((tilt(1.5).unwrap().tilt_rad - 1.5_f64.to_radians()).abs() < 1e-9);
    let refused = tilt(2.5).unwrap_err();
    assert!(matches!(refused, CalibrationRefusal::Tilted { .. }), "{refused:?}");
}

#[test]
fn places_that_were_mixed_up_are_refused() {
    let mut pairs = grid();
    let places: Vec<_> = pairs.iter().map(|pair| pair.room).collect();
    for (index, pair) in pairs.iter_mut().enumerate() {
        pair.room = places[(index * 5 + 1) % 12];
    }
    let refused = fit_room(&pairs, &Bounds::default()).unwrap_err();
    assert!(
        matches!(
            refused,
            CalibrationRefusal::WrongScale { .. }
                | CalibrationRefusal::TooManyOutliers { .. }
                | CalibrationRefusal::PoorFit { .. }
                | CalibrationRefusal::Mirrored
        ),
        "{refused:?}"
    );
}

#[test]
fn five_wrong_points_of_twelve_are_refused() {
    let mut pairs = grid();
    for (index, by) in [(0, 0.4), (3, -0.5), (5, 0.3), (8, -0.3), (11, 0.6)] {
        let room = pairs[index].room;
        pairs[index].room = Point::new(room.x(), room.y() + by, room.z() + by / 2.0);
    }
    let refused = fit_room(&pairs, &Bounds::default()).unwrap_err();
    assert!(
        matches!(
            refused,
            CalibrationRefusal::TooManyOutliers { .. }
                | CalibrationRefusal::PoorFit { .. }
                | CalibrationRefusal::WrongScale { .. }
        ),
        "{refused:?}"
    );
}
