//! Frames in the types: a point, a vector or a pose says which frame it is in, and two frames do not mix.
//!
//! All frames are right-handed with metres and radians. What the types do not catch: two rooms with
//! different origins, and a heading mistaken for an angle of another meaning.

use std::marker::PhantomData;
use std::ops::{Add, AddAssign, Mul, Neg, Sub};

use nalgebra::{Isometry3, UnitQuaternion, Vector2, Vector3};

/// The room: +z up, origin on the floor under the home corner, +x along the long rail. Every decision is made here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Room {}

/// A client's tracking space after conversion to right-handed, z-up metres. It lives in `covr-wire` only.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tracking {}

/// A point in frame `F`, metres.
#[derive(Debug, PartialEq)]
pub struct Point<F> {
    metres: Vector3<f64>,
    frame: PhantomData<F>,
}

/// A point on the floor plane of the room, metres.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Floor {
    /// Along the long rail, metres.
    pub x: f64,
    /// Across, metres.
    pub y: f64,
}

/// A vector in the floor plane of the room: a displacement (m), a velocity (m/s) or an acceleration (m/s2), as its name says.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Planar {
    /// Along the long rail.
    pub x: f64,
    /// Across.
    pub y: f64,
}

/// A head's pose in frame `F`. Body axes: +x forward (the view axis), +y left, +z up.
#[derive(Debug, PartialEq)]
pub struct Pose<F> {
    /// Position of the head.
    pub position: Point<F>,
    /// Rotation from body axes to the frame's axes.
    pub orientation: UnitQuaternion<f64>,
}

/// A rigid map from frame `A` to frame `B`, named `b_from_a`.
#[derive(Debug, PartialEq)]
pub struct RigidMap<A, B> {
    isometry: Isometry3<f64>,
    frames: PhantomData<(A, B)>,
}

impl<F> Clone for Point<F> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<F> Copy for Point<F> {}
impl<F> Clone for Pose<F> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<F> Copy for Pose<F> {}
impl<A, B> Clone for RigidMap<A, B> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<A, B> Copy for RigidMap<A, B> {}

impl<F> Point<F> {
    /// The point (x, y, z), metres.
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self { metres: Vector3::new(x, y, z), frame: PhantomData }
    }

    /// From coordinates in metres.
    pub const fn from_vector(metres: Vector3<f64>) -> Self {
        Self { metres, frame: PhantomData }
    }

    /// x, metres.
    pub fn x(&self) -> f64 {
        self.metres.x
    }

    /// y, metres.
    pub fn y(&self) -> f64 {
        self.metres.y
    }

    /// z, metres.
    pub fn z(&self) -> f64 {
        self.metres.z
    }

    /// Coordinates in metres.
    pub fn vector(&self) -> Vector3<f64> {
        self.metres
    }

    /// Distance to another point of the same frame, metres.
    pub fn distance_m(&self, other: &Self) -> f64 {
        (self.metres - other.metres).norm()
    }
}

impl Point<Room> {
    /// The point of the floor under this one.
    pub fn floor(&self) -> Floor {
        Floor { x: self.metres.x, y: self.metres.y }
    }
}

impl<F> Pose<F> {
    /// The view axis as a unit vector in the frame.
    pub fn view(&self) -> Vector3<f64> {
        self.orientation * Vector3::x()
    }
}

impl<A, B> RigidMap<A, B> {
    /// From an isometry taking coordinates in `A` to coordinates in `B`.
    pub const fn new(isometry: Isometry3<f64>) -> Self {
        Self { isometry, frames: PhantomData }
    }

    /// Turn by `yaw_rad` about z, then move by `offset_m`.
    pub fn from_yaw(yaw_rad: f64, offset_m: Vector3<f64>) -> Self {
        Self::new(Isometry3::new(offset_m, Vector3::z() * yaw_rad))
    }

    /// Map a point.
    pub fn point(&self, point: &Point<A>) -> Point<B> {
        Point::from_vector(self.isometry.rotation * point.metres + self.isometry.translation.vector)
    }

    /// Map a pose.
    pub fn pose(&self, pose: &Pose<A>) -> Pose<B> {
        Pose { position: self.point(&pose.position), orientation: self.isometry.rotation * pose.orientation }
    }

    /// The map the other way.
    pub fn inverse(&self) -> RigidMap<B, A> {
        RigidMap::new(self.isometry.inverse())
    }
}

impl Floor {
    /// The point (x, y), metres.
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// Distance to another point, metres.
    pub fn distance_m(self, other: Self) -> f64 {
        (self - other).norm()
    }

    /// Both coordinates are finite.
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

impl Planar {
    /// No displacement, no motion.
    pub const ZERO: Self = Self { x: 0.0, y: 0.0 };

    /// The vector (x, y).
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// Length.
    pub fn norm(self) -> f64 {
        // Not `hypot`: rooms are metres wide, so no square over- or underflows, and this is asked in every look ahead.
        self.dot(self).sqrt()
    }

    /// Scalar product.
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y
    }

    /// z of the vector product: positive when `other` is to the left of `self`.
    pub fn cross(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }

    /// A quarter turn to the left.
    pub fn left(self) -> Self {
        Self { x: -self.y, y: self.x }
    }

    /// Turned counter-clockwise by `angle_rad`.
    pub fn turned(self, angle_rad: f64) -> Self {
        let (sin, cos) = angle_rad.sin_cos();
        self.turned_by(sin, cos)
    }

    /// Turned to the left by the angle of this sine and cosine.
    pub fn turned_by(self, sin: f64, cos: f64) -> Self {
        Self { x: cos * self.x - sin * self.y, y: sin * self.x + cos * self.y }
    }

    /// The unit vector of this direction, or none for a vector too short to have one.
    pub fn unit(self) -> Option<Self> {
        let norm = self.norm();
        (norm > 1e-9).then(|| self * (1.0 / norm))
    }

    /// The same direction, no longer than `most`.
    pub fn capped(self, most: f64) -> Self {
        let norm = self.norm();
        if norm > most { self * (most / norm) } else { self }
    }
}

impl From<Vector2<f64>> for Planar {
    fn from(v: Vector2<f64>) -> Self {
        Self { x: v.x, y: v.y }
    }
}

impl Sub for Floor {
    type Output = Planar;
    fn sub(self, other: Self) -> Planar {
        Planar { x: self.x - other.x, y: self.y - other.y }
    }
}
impl Add<Planar> for Floor {
    type Output = Self;
    fn add(self, by: Planar) -> Self {
        Self { x: self.x + by.x, y: self.y + by.y }
    }
}
impl AddAssign<Planar> for Floor {
    fn add_assign(&mut self, by: Planar) {
        *self = *self + by;
    }
}
impl Sub<Planar> for Floor {
    type Output = Self;
    fn sub(self, by: Planar) -> Self {
        Self { x: self.x - by.x, y: self.y - by.y }
    }
}
impl Add for Planar {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y }
    }
}
impl AddAssign for Planar {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl Sub for Planar {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y }
    }
}
impl Neg for Planar {
    type Output = Self;
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y }
    }
}
impl Mul<f64> for Planar {
    type Output = Self;
    fn mul(self, by: f64) -> Self {
        Self { x: self.x * by, y: self.y * by }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_map_and_its_inverse_cancel() {
        let room_from_tracking = RigidMap::<Tracking, Room>::from_yaw(0.7, Vector3::new(1.0, -2.0, 0.1));
        let point = Point::<Tracking>::new(0.3, 0.4, 1.6);
        let back = room_from_tracking.inverse().point(&room_from_tracking.point(&point));
        assert!(back.distance_m(&point) < 1e-12);
    }

    #[test]
    fn a_quarter_turn_takes_the_view_from_x_to_y() {
        let map = RigidMap::<Tracking, Room>::from_yaw(FRAC_PI_2, Vector3::zeros());
        let pose = Pose { position: Point::new(1.0, 0.0, 0.0), orientation: UnitQuaternion::identity() };
        let turned = map.pose(&pose);
        assert!((turned.view() - Vector3::y()).norm() < 1e-12);
        assert!((turned.position.y() - 1.0).abs() < 1e-12);
    }
}
