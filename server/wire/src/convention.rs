//! Conversion between a client's convention and the room, once, here and nowhere else.
//!
//! | convention | handed | right | up | forward | unit |
//! |---|---|---|---|---|---|
//! | `openxr` (and WebXR) | right | +x | +y | -z | m |
//! | `unity` | left | +x | +y | +z | m |
//! | `unreal` | left | +y | +z | +x | cm |
//! | `godot` (and three.js) | right | +x | +y | -z | m |
//! | `steamvr` | right | +x | +y | -z | m |
//! | `ros` (REP 103) | right | -y | +z | +x | m |
//!
//! The tracking frame that every convention becomes has +x along its forward, +y to its left and +z up, in metres;
//! so the body axes of a head (x forward, y left, z up) are those of a client's head that is not rotated.
//! `room_from_tracking` of the calibration then takes it to the room.

use covr_engine::frames::{Planar, Point, Pose, RigidMap, Room, Tracking};
use covr_engine::observation;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::client::{Convention, Hands};

impl Convention {
    /// A position in this convention's axes and unit.
    pub fn point_to_tracking(self, position: [f64; 3]) -> Point<Tracking> {
        Point::from_vector(self.tracking_from_axes() * Vector3::from(position) * self.metres_per_unit())
    }

    /// A head's pose in this convention. The quaternion (x, y, z, w) must be of unit length but for rounding, which
    /// is taken out here.
    pub fn pose_to_tracking(self, position: [f64; 3], [x, y, z, w]: [f64; 4]) -> Pose<Tracking> {
        let axis = self.turning_axis(self.tracking_from_axes(), Vector3::new(x, y, z));
        Pose {
            position: self.point_to_tracking(position),
            orientation: UnitQuaternion::from_quaternion(Quaternion::from_parts(w, axis)),
        }
    }

    /// A point in this convention's axes and unit.
    pub fn point_from_tracking(self, point: &Point<Tracking>) -> [f64; 3] {
        (self.tracking_from_axes().transpose() * point.vector() / self.metres_per_unit()).into()
    }

    /// A pose in this convention: position, and quaternion (x, y, z, w).
    pub fn pose_from_tracking(self, pose: &Pose<Tracking>) -> ([f64; 3], [f64; 4]) {
        let axis = self.turning_axis(self.tracking_from_axes().transpose(), pose.orientation.imag());
        (self.point_from_tracking(&pose.position), [axis.x, axis.y, axis.z, pose.orientation.w])
    }

    /// Metres in one unit of length.
    pub const fn metres_per_unit(self) -> f64 {
        match self {
            Self::Unreal => 0.01,
            Self::Openxr | Self::Unity | Self::Godot | Self::Steamvr | Self::Ros => 1.0,
        }
    }

    /// A right-handed convention.
    pub const fn is_right_handed(self) -> bool {
        !matches!(self, Self::Unity | Self::Unreal)
    }

    /// Rows: forward, left and up in this convention's axes.
    #[rustfmt::skip]
    fn tracking_from_axes(self) -> Matrix3<f64> {
        match self {
            Self::Openxr | Self::Godot | Self::Steamvr => Matrix3::new(
                 0.0, 0.0, -1.0,
                -1.0, 0.0,  0.0,
                 0.0, 1.0,  0.0,
            ),
            Self::Unity => Matrix3::new(
                 0.0, 0.0,  1.0,
                -1.0, 0.0,  0.0,
                 0.0, 1.0,  0.0,
            ),
            Self::Unreal => Matrix3::new(
                 1.0,  0.0, 0.0,
                 0.0, -1.0, 0.0,
                 0.0,  0.0, 1.0,
            ),
            Self::Ros => Matrix3::identity(),
        }
    }

    /// A mirror turns every rotation the other way: the axis of a turn changes sign where the hand does.
    fn turning_axis(self, axes: Matrix3<f64>, axis: Vector3<f64>) -> Vector3<f64> {
        let hand = if self.is_right_handed() { 1.0 } else { -1.0 };
        axes * axis * hand
    }
}

/// One client's convention and its place in the room.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClientFrame {
    convention: Convention,
    room_from_tracking: RigidMap<Tracking, Room>,
}

impl ClientFrame {
    /// From the hello's convention and the calibration.
    pub const fn new(convention: Convention, room_from_tracking: RigidMap<Tracking, Room>) -> Self {
        Self { convention, room_from_tracking }
    }

    /// The client's convention.
    pub const fn convention(&self) -> Convention {
        self.convention
    }

    /// A client's head pose in the room.
    pub fn room_pose(&self, position: [f64; 3], orientation: [f64; 4]) -> Pose<Room> {
        self.room_from_tracking.pose(&self.convention.pose_to_tracking(position, orientation))
    }

    /// A client's point (a hand) in the room.
    pub fn room_point(&self, position: [f64; 3]) -> Point<Room> {
        self.room_from_tracking.point(&self.convention.point_to_tracking(position))
    }

    /// A client's hands in the room; unknown where it sends none.
    pub fn room_hands(&self, hands: Option<Hands>) -> observation::Hands {
        let room = |hand: Option<[f64; 3]>| hand.map(|position| self.room_point(position));
        hands.map_or(observation::Hands::UNKNOWN, |hands| observation::Hands {
            left: room(hands.left),
            right: room(hands.right),
        })
    }

    /// Hands of the room in the client's convention and unit; none where neither is known.
    pub fn client_hands(&self, hands: &observation::Hands) -> Option<Hands> {
        let client = |hand: Option<Point<Room>>| hand.map(|point| self.client_point(&point));
        let [left, right] = hands.both().map(client);
        (left.is_some() || right.is_some()).then_some(Hands { left, right })
    }

    /// A point of the room in the client's convention and unit.
    pub fn client_point(&self, point: &Point<Room>) -> [f64; 3] {
        self.convention.point_from_tracking(&self.room_from_tracking.inverse().point(point))
    }

    /// A pose of the room in the client's convention and unit: position, and quaternion (x, y, z, w).
    pub fn client_pose(&self, pose: &Pose<Room>) -> ([f64; 3], [f64; 4]) {
        self.convention.pose_from_tracking(&self.room_from_tracking.inverse().pose(pose))
    }

    /// A velocity in the room's floor plane (m/s) in the client's convention and units a second.
    pub fn client_velocity(&self, velocity: Planar) -> [f64; 3] {
        self.client_direction(Vector3::new(velocity.x, velocity.y, 0.0)).into()
    }

    /// A shift over the room's floor (m) along the client's axes, in metres whatever its unit.
    pub fn client_shift_m(&self, shift: Planar) -> [f64; 3] {
        let direction = self.client_direction(Vector3::new(shift.x, shift.y, 0.0));
        (direction * self.convention.metres_per_unit()).into()
    }

    /// The affine map from the room (x, y, z, 1; m) to the client's convention and unit: three rows of four.
    pub fn client_from_room(&self) -> [[f64; 4]; 3] {
        let origin = self.client_point(&Point::new(0.0, 0.0, 0.0));
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| self.client_direction(axis));
        std::array::from_fn(|row| [x[row], y[row], z[row], origin[row]])
    }

    fn client_direction(&self, direction: Vector3<f64>) -> Vector3<f64> {
        let tip = self.client_point(&Point::from_vector(direction));
        Vector3::from(tip) - Vector3::from(self.client_point(&Point::new(0.0, 0.0, 0.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_1_SQRT_2, PI};

    const HALF: f64 = FRAC_1_SQRT_2;

    /// By hand: a head 1 m ahead, 2 m to the right, 1.5 m up, turned a quarter to its left.
    const AHEAD_RIGHT_UP_TURNED_LEFT: [(Convention, [f64; 3], [f64; 4]); 6] = [
        (Convention::Openxr, [2.0, 1.5, -1.0], [0.0, HALF, 0.0, HALF]),
        (Convention::Unity, [2.0, 1.5, 1.0], [0.0, -HALF, 0.0, HALF]),
        (Convention::Unreal, [100.0, 200.0, 150.0], [0.0, 0.0, -HALF, HALF]),
        (Convention::Godot, [2.0, 1.5, -1.0], [0.0, HALF, 0.0, HALF]),
        (Convention::Steamvr, [2.0, 1.5, -1.0], [0.0, HALF, 0.0, HALF]),
        (Convention::Ros, [1.0, -2.0, 1.5], [0.0, 0.0, HALF, HALF]),
    ];

    /// By hand: a head that looks 30 degrees down. In OpenXR that is a negative turn about +x (right hand), in Unity
    /// a positive one about +x (left hand), in Unreal a positive one about +y (right, left hand), in ROS a positive one
    /// about +y (left, right hand).
    const LOOKING_DOWN: [(Convention, [f64; 4]); 4] = [
        (Convention::Openxr, [-0.258_819_045, 0.0, 0.0, 0.965_925_826]),
        (Convention::Unity, [0.258_819_045, 0.0, 0.0, 0.965_925_826]),
        (Convention::Unreal, [0.0, 0.258_819_045, 0.0, 0.965_925_826]),
        (Convention::Ros, [0.0, 0.258_819_045, 0.0, 0.965_925_826]),
    ];

    #[test]
    fn a_pose_worked_out_by_hand_arrives_in_every_convention() {
        for (convention, position, orientation) in AHEAD_RIGHT_UP_TURNED_LEFT {
            let pose = convention.pose_to_tracking(position, orientation);
            assert!(pose.position.distance_m(&Point::new(1.0, -2.0, 1.5)) < 1e-12, "{convention:?}");
            assert!(
                (pose.view() - Vector3::y()).norm() < 1e-12,
                "{convention:?} looks along {}",
                pose.view()
            );
            let head_top = pose.orientation * Vector3::z();
            assert!((head_top - Vector3::z()).norm() < 1e-12, "{convention:?}");
        }
    }

    #[test]
    fn a_head_that_looks_down_looks_down_in_every_convention() {
        for (convention, orientation) in LOOKING_DOWN {
            let view = convention.pose_to_tracking([0.0; 3], orientation).view();
            let down = Vector3::new((PI / 6.0).cos(), 0.0, -(PI / 6.0).sin());
            assert!((view - down).norm() < 1e-8, "{convention:?} looks along {view}");
        }
    }

    #[test]
    fn a_head_that_is_not_rotated_looks_forward() {
        for convention in Convention::ALL {
            let pose = convention.pose_to_tracking([0.0; 3], [0.0, 0.0, 0.0, 1.0]);
            assert!((pose.view() - Vector3::x()).norm() < 1e-12, "{convention:?}");
        }
    }

    #[test]
    fn the_hand_of_the_axes_is_the_declared_one() {
        for convention in Convention::ALL {
            let determinant = convention.tracking_from_axes().determinant();
            assert!((determinant - if convention.is_right_handed() { 1.0 } else { -1.0 }).abs() < 1e-12);
        }
    }

    #[test]
    fn the_calibration_is_applied_after_the_convention() {
        let room_from_tracking = RigidMap::from_yaw(PI / 2.0, Vector3::new(2.0, 1.0, 0.0));
        let frame = ClientFrame::new(Convention::Unity, room_from_tracking);
        let pose = frame.room_pose([0.5, 1.7, 1.0], [0.0, 0.0, 0.0, 1.0]);
        assert!(pose.position.distance_m(&Point::new(2.5, 2.0, 1.7)) < 1e-12);
        assert!((pose.view() - Vector3::y()).norm() < 1e-12);
        let velocity = frame.client_velocity(Planar::new(0.0, 1.0));
        assert!((Vector3::from(velocity) - Vector3::z()).norm() < 1e-12);
    }

    fn any_convention() -> impl Strategy<Value = Convention> {
        prop::sample::select(&Convention::ALL[..])
    }

    fn any_rotation() -> impl Strategy<Value = UnitQuaternion<f64>> {
        (-PI..PI, -1.5..1.5, -PI..PI).prop_map(|(r, p, y)| UnitQuaternion::from_euler_angles(r, p, y))
    }

    fn any_frame() -> impl Strategy<Value = ClientFrame> {
        (any_convention(), -PI..PI, prop::array::uniform3(-5.0..5.0)).prop_map(|(convention, yaw, offset)| {
            ClientFrame::new(convention, RigidMap::from_yaw(yaw, Vector3::from(offset)))
        })
    }

    proptest! {
        #[test]
        fn a_pose_comes_back_as_it_went(
            frame in any_frame(),
            position in prop::array::uniform3(-10.0..10.0),
            orientation in any_rotation(),
        ) {
            let pose = Pose::<Room> { position: Point::from_vector(Vector3::from(position)), orientation };
            let (client_position, client_orientation) = frame.client_pose(&pose);
            let back = frame.room_pose(client_position, client_orientation);
            prop_assert!(back.position.distance_m(&pose.position) < 1e-9);
            prop_assert!(back.orientation.angle_to(&pose.orientation) < 1e-7);
        }

        #[test]
        fn hands_come_back_as_they_went_each_where_it_is_known(
            frame in any_frame(),
            left in prop::option::of(prop::array::uniform3(-10.0..10.0)),
            right in prop::option::of(prop::array::uniform3(-10.0..10.0)),
        ) {
            let room = |hand: Option<[f64; 3]>| hand.map(|at| Point::<Room>::from_vector(Vector3::from(at)));
            let hands = observation::Hands { left: room(left), right: room(right) };
            let sent = frame.client_hands(&hands);
            prop_assert_eq!(sent.is_some(), left.is_some() || right.is_some());
            for (back, hand) in frame.room_hands(sent).both().into_iter().zip(hands.both()) {
                prop_assert_eq!(back.is_some(), hand.is_some());
                prop_assert!(back.zip(hand).is_none_or(|(back, hand)| back.distance_m(&hand) < 1e-9));
            }
        }

        /// A rotation composed in the client's algebra is the same rotation composed in the tracking frame.
        #[test]
        fn turning_twice_is_turning_twice(convention in any_convention(), a in any_rotation(), b in any_rotation()) {
            let client = |q: UnitQuaternion<f64>| {
                let pose = Pose::<Tracking> { position: Point::new(0.0, 0.0, 0.0), orientation: q };
                let (_, [x, y, z, w]) = convention.pose_from_tracking(&pose);
                UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
            };
            prop_assert!((client(a) * client(b)).angle_to(&client(a * b)) < 1e-7);
        }

        #[test]
        fn lengths_are_kept_but_for_the_unit(
            convention in any_convention(),
            a in prop::array::uniform3(-10.0..10.0),
            b in prop::array::uniform3(-10.0..10.0),
        ) {
            let metres = convention.point_to_tracking(a).distance_m(&convention.point_to_tracking(b));
            let units = (Vector3::from(a) - Vector3::from(b)).norm();
            prop_assert!((metres - units * convention.metres_per_unit()).abs() < 1e-9);
        }

        #[test]
        fn the_matrix_maps_as_the_map_does(frame in any_frame(), position in prop::array::uniform3(-10.0..10.0)) {
            let [x, y, z] = position;
            let mapped = frame.client_point(&Point::new(x, y, z));
            for (row, expected) in frame.client_from_room().iter().zip(mapped) {
                let by_matrix = row[0] * x + row[1] * y + row[2] * z + row[3];
                prop_assert!((by_matrix - expected).abs() < 1e-6);
            }
        }
    }
}
