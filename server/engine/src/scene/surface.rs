//! An object's true surface: distance from a head and hits of a view ray. The one place that knows parry.

use nalgebra::Vector3;
use parry3d_f64::math::Vector;
use parry3d_f64::query::Ray;
use parry3d_f64::shape::{Ball, ConvexPolyhedron, Cuboid, Cylinder, SharedShape, TriMesh, TriMeshFlags};

use super::spec::{ObjectSpec, Shape};
use crate::frames::{Point, Pose, Room};

/// A surface standing in the room.
#[derive(Clone)]
pub struct Surface {
    shape: SharedShape,
    centre: Point<Room>,
    /// No surface point is farther from the centre, m.
    reach_m: f64,
    yaw_sin_cos: (f64, f64),
    upright: bool,
}

/// Why a shape is no surface: the key, what was found, what was expected.
pub type ShapeProblem = (&'static str, String, String);

impl std::fmt::Debug for Surface {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Surface").field("centre", &self.centre).finish_non_exhaustive()
    }
}

impl Surface {
    /// Build the surface of a described object.
    pub fn build(spec: &ObjectSpec) -> Result<Self, ShapeProblem> {
        let shape = match &spec.shape {
            Shape::Sphere { radius_m } => SharedShape::new(Ball::new(size("shape.radius", *radius_m)?)),
            Shape::Box { size_m } => {
                for side in size_m {
                    size("shape.size", *side)?;
                }
                SharedShape::new(Cuboid::new(vector(size_m) * 0.5))
            }
            Shape::Cylinder { radius_m, height_m } => SharedShape::new(Cylinder::new(
                0.5 * size("shape.height", *height_m)?,
                size("shape.radius", *radius_m)?,
            )),
            Shape::ConvexMesh { points_m } => convex(points_m)?,
            Shape::TriangleMesh { vertices_m, triangles } => triangle_mesh(vertices_m, triangles)?,
        };
        Ok(Self {
            shape,
            centre: spec.position,
            reach_m: reach_m(&spec.shape) + ROUNDING_M,
            yaw_sin_cos: spec.yaw_rad.sin_cos(),
            upright: matches!(spec.shape, Shape::Cylinder { .. }),
        })
    }

    /// From the head to the nearest surface point, m; 0 inside.
    pub fn distance_m(&self, head: &Point<Room>) -> f64 {
        let local = self.local(head.vector() - self.centre.vector());
        let nearest = self.shape.project_local_point(local, true);
        if nearest.is_inside { 0.0 } else { nearest.point.distance(local) }
    }

    /// No less than this from the head to the nearest surface point, m: to the ball about it; negative inside the ball.
    pub fn at_least_m(&self, head: &Point<Room>) -> f64 {
        (head.vector() - self.centre.vector()).norm() - self.reach_m - ROUNDING_M
    }

    /// Angle between the view axis and the object, rad: 0 when the view ray hits any surface point, else to its centre.
    pub fn angle_rad(&self, head: &Pose<Room>) -> f64 {
        let to_centre = self.centre.vector() - head.position.vector();
        let view = head.view();
        if self.may_be_hit(&view, &to_centre) {
            let ray = Ray { origin: self.local(-to_centre), dir: self.local(view) };
            if self.shape.intersects_local_ray(&ray, FARTHEST_SIGHT_M) {
                return 0.0;
            }
        }
        view.angle(&to_centre)
    }

    /// The view ray comes into the ball about the surface; only then is the surface itself asked.
    fn may_be_hit(&self, view: &Vector3<f64>, to_centre: &Vector3<f64>) -> bool {
        let along = view.dot(to_centre).max(0.0);
        (to_centre - view * along).norm_squared() <= self.reach_m * self.reach_m
    }

    /// Room axes to the shape's own; parry's cylinders stand along y.
    fn local(&self, v: Vector3<f64>) -> Vector {
        let (sin, cos) = self.yaw_sin_cos;
        let (x, y, z) = (cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z);
        if self.upright { Vector::new(x, z, -y) } else { Vector::new(x, y, z) }
    }
}

/// The greatest distance of a surface point from the centre, m.
fn reach_m(shape: &Shape) -> f64 {
    let farthest = |points: &[[f64; 3]]| points.iter().map(|p| vector(p).length()).fold(0.0, f64::max);
    match shape {
        Shape::Sphere { radius_m } => *radius_m,
        Shape::Box { size_m } => 0.5 * vector(size_m).length(),
        Shape::Cylinder { radius_m, height_m } => radius_m.hypot(0.5 * height_m),
        Shape::ConvexMesh { points_m } => farthest(points_m),
        Shape::TriangleMesh { vertices_m, .. } => farthest(vertices_m),
    }
}

fn size(key: &'static str, metres: f64) -> Result<f64, ShapeProblem> {
    if metres.is_finite() && (LEAST_SIZE_M..=GREATEST_SIZE_M).contains(&metres) {
        Ok(metres)
    } else {
        Err((key, format!("{metres}"), format!("a length from {LEAST_SIZE_M} to {GREATEST_SIZE_M} m")))
    }
}

fn coordinates(key: &'static str, points: &[[f64; 3]]) -> Result<Vec<Vector>, ShapeProblem> {
    match points.iter().position(|p| p.iter().any(|c| !c.is_finite() || c.abs() > GREATEST_SIZE_M)) {
        Some(i) => Err((
            key,
            format!("{:?} at index {i}", points[i]),
            format!("finite coordinates within {GREATEST_SIZE_M} m of the object's centre"),
        )),
        None => Ok(points.iter().map(vector).collect()),
    }
}

fn convex(points_m: &[[f64; 3]]) -> Result<SharedShape, ShapeProblem> {
    const KEY: &str = "shape.points";
    let points = coordinates(KEY, points_m)?;
    if !(4..=MOST_VERTICES).contains(&points.len()) {
        return Err((KEY, format!("{} points", points.len()), format!("4 to {MOST_VERTICES} points")));
    }
    if !spans_a_volume(points_m) {
        return Err((KEY, "points in one plane".into(), "at least 4 points that span a volume".into()));
    }
    ConvexPolyhedron::from_convex_hull(&points)
        .map(SharedShape::new)
        .ok_or_else(|| (KEY, "points without a convex hull".into(), "points that span a volume".into()))
}

/// Some four of the points are not in one plane: asked before parry, whose hull wants it so.
fn spans_a_volume(points: &[[f64; 3]]) -> bool {
    let at = |p: &[f64; 3]| Vector3::new(p[0], p[1], p[2]);
    let origin = at(&points[0]);
    let farthest = |score: &dyn Fn(Vector3<f64>) -> f64| {
        points.iter().map(|p| at(p) - origin).max_by(|a, b| score(*a).total_cmp(&score(*b)))
    };
    let Some(along) = farthest(&|p| p.norm()) else { return false };
    let Some(aside) = farthest(&|p| along.cross(&p).norm()) else { return false };
    let normal = along.cross(&aside);
    let Some(out) = farthest(&|p| normal.dot(&p).abs()) else { return false };
    normal.norm() > 1e-9 && normal.dot(&out).abs() / normal.norm() > 1e-4
}

fn triangle_mesh(vertices_m: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<SharedShape, ShapeProblem> {
    let vertices = coordinates("shape.vertices", vertices_m)?;
    if !(3..=MOST_VERTICES).contains(&vertices.len()) {
        let expected = format!("3 to {MOST_VERTICES} vertices");
        return Err(("shape.vertices", format!("{} vertices", vertices.len()), expected));
    }
    const KEY: &str = "shape.triangles";
    if !(1..=MOST_VERTICES).contains(&triangles.len()) {
        return Err((
            KEY,
            format!("{} triangles", triangles.len()),
            format!("1 to {MOST_VERTICES} triangles"),
        ));
    }
    for (i, triangle) in triangles.iter().enumerate() {
        if let Some(corner) = triangle.iter().find(|c| **c as usize >= vertices.len()) {
            let expected = format!("an index below {}", vertices.len());
            return Err((KEY, format!("vertex {corner} in triangle {i}"), expected));
        }
        let [a, b, c] = triangle.map(|corner| from_vector(vertices[corner as usize]));
        if (b - a).cross(&(c - a)).norm() < 1e-12 {
            return Err((
                KEY,
                format!("triangle {i} without an area"),
                "three corners not in one line".into(),
            ));
        }
    }
    // A closed, consistently wound mesh knows its inside (d is 0 there); an open one is a sheet.
    let closed = TriMeshFlags::ORIENTED | TriMeshFlags::MERGE_DUPLICATE_VERTICES;
    TriMesh::with_flags(vertices.clone(), triangles.to_vec(), closed)
        .or_else(|_| TriMesh::new(vertices, triangles.to_vec()))
        .map(SharedShape::new)
        .map_err(|e| (KEY, e.to_string(), "a triangle mesh".into()))
}

fn vector(v: &[f64; 3]) -> Vector {
    Vector::new(v[0], v[1], v[2])
}

fn from_vector(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z)
}

const LEAST_SIZE_M: f64 = 0.001;
const GREATEST_SIZE_M: f64 = 50.0;
const MOST_VERTICES: usize = 100_000;
/// Floating point at the size of an arena, m.
const ROUNDING_M: f64 = 1e-6;
/// No arena is larger.
const FARTHEST_SIGHT_M: f64 = 200.0;

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;
    use proptest::prelude::*;

    fn object(shape: Shape) -> ObjectSpec {
        ObjectSpec {
            id: "o".into(),
            position: Point::new(2.0, 1.0, 1.0),
            yaw_rad: 0.3,
            shape,
            prop: None,
            prior: 1.0,
            enabled: true,
        }
    }

    fn head(x: f64, y: f64, z: f64, yaw_rad: f64) -> Pose<Room> {
        Pose {
            position: Point::new(x, y, z),
            orientation: UnitQuaternion::from_euler_angles(0.0, 0.0, yaw_rad),
        }
    }

    #[test]
    fn distance_is_to_the_true_surface_and_zero_inside() {
        let ball = Surface::build(&object(Shape::Sphere { radius_m: 0.25 })).unwrap();
        assert!((ball.distance_m(&Point::new(0.0, 1.0, 1.0)) - 1.75).abs() < 1e-12);
        assert_eq!(ball.distance_m(&Point::new(2.1, 1.0, 1.0)), 0.0);
        let cylinder = Surface::build(&object(Shape::Cylinder { radius_m: 0.1, height_m: 2.0 })).unwrap();
        assert!(
            (cylinder.distance_m(&Point::new(2.0, 1.0, 2.5)) - 0.5).abs() < 1e-9,
            "a cylinder stands upright"
        );
        assert!((cylinder.distance_m(&Point::new(1.0, 1.0, 1.9)) - 0.9).abs() < 1e-9);
    }

    #[test]
    fn a_yawed_box_turns_with_its_yaw() {
        let mut spec = object(Shape::Box { size_m: [2.0, 0.2, 0.2] });
        spec.yaw_rad = std::f64::consts::FRAC_PI_2;
        let wall = Surface::build(&spec).unwrap();
        assert!((wall.distance_m(&Point::new(2.0, 2.5, 1.0)) - 0.5).abs() < 1e-9);
        assert!((wall.distance_m(&Point::new(3.0, 1.0, 1.0)) - 0.9).abs() < 1e-9);
    }

    #[test]
    fn a_view_ray_that_hits_any_surface_point_has_no_angle() {
        let ball = Surface::build(&object(Shape::Sphere { radius_m: 0.25 })).unwrap();
        let just_hits = (0.24_f64 / 2.0).asin();
        assert_eq!(ball.angle_rad(&head(0.0, 1.0, 1.0, just_hits)), 0.0);
        let misses = ball.angle_rad(&head(0.0, 1.0, 1.0, 0.3));
        assert!((misses - 0.3).abs() < 1e-9, "angle to the centre: {misses}");
        assert!(
            (ball.angle_rad(&head(0.0, 1.0, 1.0, std::f64::consts::PI)) - std::f64::consts::PI).abs() < 1e-9
        );
    }

    #[test]
    fn a_closed_mesh_has_an_inside() {
        let corners: Vec<[f64; 3]> = (0..8)
            .map(|i| [(i & 1) as f64 - 0.5, ((i >> 1) & 1) as f64 - 0.5, ((i >> 2) & 1) as f64 - 0.5])
            .collect();
        let triangles = [
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        let mesh = Shape::TriangleMesh { vertices_m: corners.clone(), triangles: triangles.to_vec() };
        let mut spec = object(mesh);
        spec.yaw_rad = 0.0;
        let cube = Surface::build(&spec).unwrap();
        assert_eq!(cube.distance_m(&Point::new(2.1, 1.0, 1.0)), 0.0);
        assert!((cube.distance_m(&Point::new(3.0, 1.0, 1.0)) - 0.5).abs() < 1e-9);
        spec.shape = Shape::ConvexMesh { points_m: corners };
        let hull = Surface::build(&spec).unwrap();
        assert!((hull.distance_m(&Point::new(3.0, 1.0, 1.0)) - 0.5).abs() < 1e-9);
        assert_eq!(hull.angle_rad(&head(0.0, 1.0, 1.0, 0.0)), 0.0);
    }

    fn shapes() -> [Shape; 5] {
        let corners: Vec<[f64; 3]> =
            vec![[0.4, 0.0, -0.1], [-0.2, 0.3, -0.1], [-0.2, -0.3, -0.1], [0.0, 0.0, 0.5]];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        [
            Shape::Sphere { radius_m: 0.3 },
            Shape::Box { size_m: [1.0, 0.2, 0.6] },
            Shape::Cylinder { radius_m: 0.2, height_m: 1.4 },
            Shape::ConvexMesh { points_m: corners.clone() },
            Shape::TriangleMesh { vertices_m: corners, triangles },
        ]
    }

    proptest! {
        /// What the ball about a surface leaves out, the surface itself would have left out.
        #[test]
        fn the_ball_about_a_surface_changes_nothing(
            (x, y, z) in (0.0..4.0f64, -1.0..3.0f64, 0.0..2.0f64), yaw in -3.2..3.2f64, pitch in -1.5..1.5f64,
        ) {
            let position = Point::new(x, y, z);
            for shape in shapes() {
                let surface = Surface::build(&object(shape)).unwrap();
                prop_assert!(surface.distance_m(&position) >= surface.at_least_m(&position));
                let looks = |yaw: f64, pitch: f64| {
                    let orientation = UnitQuaternion::from_euler_angles(0.0, pitch, yaw);
                    let head = Pose { position, orientation };
                    let to_centre = surface.centre.vector() - position.vector();
                    let ray = Ray { origin: surface.local(-to_centre), dir: surface.local(head.view()) };
                    let hits = surface.shape.intersects_local_ray(&ray, FARTHEST_SIGHT_M);
                    let asked = if hits { 0.0 } else { head.view().angle(&to_centre) };
                    (surface.angle_rad(&head), asked)
                };
                let (found, asked) = looks(yaw, pitch);
                prop_assert_eq!(found, asked);
                // About the object too, where most rays hit or just miss.
                let to = surface.centre.vector() - position.vector();
                let (found, asked) = looks(to.y.atan2(to.x) + 0.1 * yaw, -to.z.atan2(to.x.hypot(to.y)) + 0.1 * pitch);
                prop_assert_eq!(found, asked);
            }
        }
    }

    #[test]
    fn shapes_that_are_no_surface_are_refused_with_their_key() {
        let refused = |shape| Surface::build(&object(shape)).unwrap_err().0;
        assert_eq!(refused(Shape::Sphere { radius_m: 0.0 }), "shape.radius");
        assert_eq!(refused(Shape::Sphere { radius_m: f64::NAN }), "shape.radius");
        assert_eq!(refused(Shape::Box { size_m: [1.0, -1.0, 1.0] }), "shape.size");
        let flat = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        assert_eq!(refused(Shape::ConvexMesh { points_m: flat.clone() }), "shape.points");
        assert_eq!(
            refused(Shape::TriangleMesh { vertices_m: flat, triangles: vec![[0, 1, 9]] }),
            "shape.triangles"
        );
    }
}
