//! Reading the tagged shapes by hand, so that an error inside one keeps its path: a derived reader of a tagged enum
//! buffers the fields and forgets where they were.

use serde::de::Error;
use serde::{Deserialize, Deserializer};

use super::{KeepOutShape, ShapeDocument};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ShapeFields {
    kind: ShapeKind,
    #[serde(default, deserialize_with = "written")]
    radius: Option<f64>,
    #[serde(default, deserialize_with = "written")]
    height: Option<f64>,
    #[serde(default, deserialize_with = "written")]
    size: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "written")]
    points: Option<Vec<[f64; 3]>>,
    #[serde(default, deserialize_with = "written")]
    vertices: Option<Vec<[f64; 3]>>,
    #[serde(default, deserialize_with = "written")]
    triangles: Option<Vec<[u32; 3]>>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum ShapeKind {
    Sphere,
    Box,
    Cylinder,
    ConvexMesh,
    TriangleMesh,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct KeepOutFields {
    kind: KeepOutKind,
    #[serde(default, deserialize_with = "written")]
    centre: Option<[f64; 2]>,
    #[serde(default, deserialize_with = "written")]
    radius: Option<f64>,
    #[serde(default, deserialize_with = "written")]
    corners: Option<Vec<[f64; 2]>>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum KeepOutKind {
    Circle,
    Polygon,
}

impl<'de> Deserialize<'de> for ShapeDocument {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let fields = ShapeFields::deserialize(deserializer)?;
        let present = [
            ("radius", fields.radius.is_some()),
            ("height", fields.height.is_some()),
            ("size", fields.size.is_some()),
            ("points", fields.points.is_some()),
            ("vertices", fields.vertices.is_some()),
            ("triangles", fields.triangles.is_some()),
        ];
        let no_other = |known: &'static [&'static str]| only::<D>(&present, known);
        Ok(match fields.kind {
            ShapeKind::Sphere => {
                no_other(&["radius"])?;
                Self::Sphere { radius: due::<D, _>(fields.radius, "radius")? }
            }
            ShapeKind::Box => {
                no_other(&["size"])?;
                Self::Box { size: due::<D, _>(fields.size, "size")? }
            }
            ShapeKind::Cylinder => {
                no_other(&["radius", "height"])?;
                Self::Cylinder {
                    radius: due::<D, _>(fields.radius, "radius")?,
                    height: due::<D, _>(fields.height, "height")?,
                }
            }
            ShapeKind::ConvexMesh => {
                no_other(&["points"])?;
                Self::ConvexMesh { points: due::<D, _>(fields.points, "points")? }
            }
            ShapeKind::TriangleMesh => {
                no_other(&["vertices", "triangles"])?;
                Self::TriangleMesh {
                    vertices: due::<D, _>(fields.vertices, "vertices")?,
                    triangles: due::<D, _>(fields.triangles, "triangles")?,
                }
            }
        })
    }
}

impl<'de> Deserialize<'de> for KeepOutShape {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let fields = KeepOutFields::deserialize(deserializer)?;
        let present = [
            ("centre", fields.centre.is_some()),
            ("radius", fields.radius.is_some()),
            ("corners", fields.corners.is_some()),
        ];
        Ok(match fields.kind {
            KeepOutKind::Circle => {
                only::<D>(&present, &["centre", "radius"])?;
                Self::Circle {
                    centre: due::<D, _>(fields.centre, "centre")?,
                    radius: due::<D, _>(fields.radius, "radius")?,
                }
            }
            KeepOutKind::Polygon => {
                only::<D>(&present, &["corners"])?;
                Self::Polygon { corners: due::<D, _>(fields.corners, "corners")? }
            }
        })
    }
}

/// A field that is written has a value: null is none.
pub(super) fn written<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    deserializer: D,
) -> Result<Option<T>, D::Error> {
    T::deserialize(deserializer).map(Some)
}

pub(super) fn due<'de, D: Deserializer<'de>, T>(field: Option<T>, name: &'static str) -> Result<T, D::Error> {
    field.ok_or_else(|| D::Error::missing_field(name))
}

pub(super) fn only<'de, D: Deserializer<'de>>(
    present: &[(&'static str, bool)],
    known: &'static [&'static str],
) -> Result<(), D::Error> {
    match present.iter().find(|(name, is_there)| *is_there && !known.contains(name)) {
        Some((name, _)) => Err(D::Error::unknown_field(name, known)),
        None => Ok(()),
    }
}
