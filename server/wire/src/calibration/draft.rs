//! What the points taken so far give.

use covr_engine::frames::{Floor, Point, Pose, RigidMap, Room};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

use super::{
    Bounds, CalibrationDraft, CalibrationKind, CalibrationPoint, CalibrationRefusal, CalibrationResult,
    ColumnVisit, Pair, PointOn, PropBounds, PropTouch, RoomFit, RoomFromTracking, fit_column, fit_prop,
};
use crate::client::Convention;

/// What the fit of a draft needs of the client that measures.
#[derive(Debug, Clone, Copy)]
pub struct Measured {
    /// What it declares.
    pub convention: Convention,
    /// Its map in force; a prop is measured by it.
    pub room_from_tracking: RoomFromTracking,
}

impl CalibrationDraft {
    /// Fit the points anew: result and residuals, or why there is none.
    pub fn fit(&mut self, by: &Measured) {
        for point in &mut self.points {
            (point.residual_m, point.used) = (None, None);
        }
        let done = match self.task.kind {
            CalibrationKind::RoomFromTracking => self.fit_room(by.convention),
            CalibrationKind::Prop => self.fit_prop(&by.room_from_tracking),
        };
        self.refused_because = done.as_ref().err().map(ToString::to_string);
        (self.result, self.why) = match done {
            Ok(result) => (Some(result), None),
            Err(why) => (None, Some(why)),
        };
    }

    fn fit_room(&mut self, convention: Convention) -> Result<CalibrationResult, CalibrationRefusal> {
        let visits: Vec<ColumnVisit> = self
            .on(PointOn::Column)
            .map(|point| ColumnVisit {
                tracking: Point::from_vector(point.tracking_m.into()),
                column: column(point),
            })
            .collect();
        let touched: Vec<Pair> = self
            .on(PointOn::Place)
            .map(|point| Pair {
                tracking: Point::from_vector(point.tracking_m.into()),
                room: Point::from_vector(point.room_m.into()),
            })
            .collect();
        let rides = !visits.is_empty();
        // Without a visit there is no offset to be found.
        let offset_m = self.task.offset_m.or((!rides).then_some([0.0; 3]));
        let fit = fit_column(&visits, &touched, offset_m, &Bounds::default())?;
        let order: Vec<usize> =
            self.places(PointOn::Column).into_iter().chain(self.places(PointOn::Place)).collect();
        for (place, residual) in order.into_iter().zip(&fit.room.residuals) {
            self.points[place].residual_m = Some(residual.distance_m);
            self.points[place].used = Some(residual.used);
        }
        Ok(room_result(&fit.room, convention, rides.then_some(fit.offset_m)))
    }

    fn fit_prop(&mut self, map: &RoomFromTracking) -> Result<CalibrationResult, CalibrationRefusal> {
        let touches = |on: PointOn| -> Vec<PropTouch> {
            let touch = |point: &CalibrationPoint| PropTouch {
                touched: map.point(&Point::from_vector(point.tracking_m.into())),
                column: column(point),
            };
            self.on(on).map(touch).collect()
        };
        let fit =
            fit_prop(&touches(PointOn::PropPoint), &touches(PointOn::PropFace), &PropBounds::default())?;
        let on_face = fit.face.as_ref().map_or(&[][..], |face| &face.residuals_m);
        for (on, residuals) in [(PointOn::PropPoint, &fit.residuals_m[..]), (PointOn::PropFace, on_face)] {
            for (place, residual) in self.places(on).into_iter().zip(residuals) {
                self.points[place].residual_m = Some(*residual);
                self.points[place].used = Some(true);
            }
        }
        Ok(CalibrationResult::Prop {
            prop: self.task.prop.clone().unwrap_or_default(),
            offset_m: [fit.offset.x, fit.offset.y],
            height_m: fit.height_m,
            rms_m: fit.rms_m,
            facing_rad: fit.face.as_ref().map(|face| face.facing_rad),
            facing_sd_rad: fit.face.as_ref().map(|face| face.facing_sd_rad),
        })
    }

    fn on(&self, on: PointOn) -> impl Iterator<Item = &CalibrationPoint> {
        self.points.iter().filter(move |point| point.on == on)
    }

    fn places(&self, on: PointOn) -> Vec<usize> {
        (0..self.points.len()).filter(|place| self.points[*place].on == on).collect()
    }
}

impl CalibrationResult {
    /// The map of a calibrated room, with what the client had declared; none for a prop.
    pub fn room(&self) -> Option<(Convention, RoomFromTracking)> {
        let Self::RoomFromTracking { convention, position_m, orientation: [x, y, z, w], .. } = self else {
            return None;
        };
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(*w, *x, *y, *z));
        let shift = Translation3::from(Vector3::from(*position_m));
        Some((*convention, RigidMap::new(Isometry3::from_parts(shift, turn))))
    }
}

fn room_result(fit: &RoomFit, convention: Convention, offset_m: Option<[f64; 3]>) -> CalibrationResult {
    let origin = Pose { position: Point::new(0.0, 0.0, 0.0), orientation: UnitQuaternion::identity() };
    let origin: Pose<Room> = fit.room_from_tracking.pose(&origin);
    let turn = origin.orientation;
    CalibrationResult::RoomFromTracking {
        convention,
        position_m: origin.position.vector().into(),
        orientation: [turn.i, turn.j, turn.k, turn.w],
        rms_m: fit.rms_m,
        scale: fit.scale,
        tilt_rad: fit.tilt_rad,
        uncertainty_m: fit.uncertainty_m,
        turn_sd_rad: fit.turn_sd_rad,
        offset_m,
    }
}

const fn column(point: &CalibrationPoint) -> Floor {
    Floor::new(point.room_m[0], point.room_m[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::{CalibrationTask, Pointer};

    const PLACES: [[f64; 3]; 7] = [
        [0.0, 0.0, 0.0],
        [3.0, 0.0, 0.0],
        [3.0, 2.0, 0.0],
        [0.0, 2.0, 0.0],
        [1.5, 1.0, 0.0],
        [1.0, 0.5, 1.0],
        [2.0, 1.5, 1.0],
    ];

    fn truth() -> RoomFromTracking {
        RigidMap::from_yaw(0.8, Vector3::new(2.0, 1.0, 0.1))
    }

    fn taken(on: PointOn, number: u32, at: [f64; 3], room_m: [f64; 3]) -> CalibrationPoint {
        let tracking_m = truth().inverse().point(&Point::from_vector(at.into())).vector().into();
        CalibrationPoint {
            number,
            on,
            tracking_m,
            room_m,
            poses: 90,
            jitter_m: 0.0,
            residual_m: None,
            used: None,
        }
    }

    fn draft(kind: CalibrationKind, points: Vec<CalibrationPoint>) -> CalibrationDraft {
        let task = CalibrationTask {
            kind,
            client: "headset 1".into(),
            pointer: Pointer::Head,
            offset_m: None,
            prop: Some("handle".into()),
        };
        CalibrationDraft {
            task,
            author: "Ada".into(),
            points,
            result: None,
            refused_because: None,
            why: None,
        }
    }

    fn measured() -> Measured {
        Measured { convention: Convention::Unity, room_from_tracking: truth() }
    }

    #[test]
    fn touched_places_give_the_map_and_it_comes_back_from_its_text() {
        let points = (1..).zip(PLACES).map(|(n, at)| taken(PointOn::Place, n, at, at)).collect();
        let mut draft = draft(CalibrationKind::RoomFromTracking, points);
        draft.fit(&measured());
        let text = serde_json::to_string(&draft.result).unwrap();
        let result: Option<CalibrationResult> = serde_json::from_str(&text).unwrap();
        let (convention, map) = result.unwrap().room().unwrap();
        assert_eq!(convention, Convention::Unity);
        let at = Point::new(0.3, -1.2, 1.7);
        assert!(map.point(&at).distance_m(&truth().point(&at)) < 1e-9);
        assert!(draft.points.iter().all(|point| point.used == Some(true)));
    }

    #[test]
    fn residuals_go_to_their_own_points_when_column_and_places_are_mixed() {
        let offset = [0.1, -0.2, 1.6];
        let mut points: Vec<_> = (1..).zip(PLACES).map(|(n, at)| taken(PointOn::Place, n, at, at)).collect();
        for (n, [x, y, _]) in (8..).zip(PLACES) {
            let on_column = [x + offset[0], y + offset[1], offset[2]];
            points.insert(0, taken(PointOn::Column, n, on_column, [x, y, 0.0]));
        }
        // One place that is wrong.
        let wrong = points.iter().position(|point| point.number == 3).unwrap();
        points[wrong].room_m[0] += 0.4;
        let mut draft = draft(CalibrationKind::RoomFromTracking, points);
        draft.fit(&measured());
        let Some(CalibrationResult::RoomFromTracking { offset_m: Some(found), .. }) = draft.result else {
            panic!("{draft:?}");
        };
        assert!((0..3).all(|axis| (found[axis] - offset[axis]).abs() < 1e-6), "{found:?}");
        let left_out: Vec<u32> =
            draft.points.iter().filter(|point| point.used == Some(false)).map(|point| point.number).collect();
        assert_eq!(left_out, [3]);
    }

    #[test]
    fn a_prop_is_found_by_the_map_in_force() {
        let touch =
            |n, on, [x, y]: [f64; 2], dx: f64, dy: f64| taken(on, n, [x + dx, y + dy, 1.1], [x, y, 0.0]);
        let points = vec![
            touch(1, PointOn::PropPoint, [1.0, 1.0], 0.0, 0.3),
            touch(2, PointOn::PropPoint, [2.0, 1.0], 0.0, 0.3),
            touch(3, PointOn::PropPoint, [1.0, 2.0], 0.0, 0.3),
            touch(4, PointOn::PropFace, [1.0, 1.0], -0.2, 0.3),
            touch(5, PointOn::PropFace, [1.0, 1.0], -0.1, 0.3),
            touch(6, PointOn::PropFace, [1.0, 1.0], 0.1, 0.3),
            touch(7, PointOn::PropFace, [1.0, 1.0], 0.2, 0.3),
        ];
        let mut draft = draft(CalibrationKind::Prop, points);
        draft.fit(&measured());
        let Some(CalibrationResult::Prop { offset_m, facing_rad: Some(facing), height_m, .. }) = draft.result
        else {
            panic!("{draft:?}");
        };
        assert!(offset_m[0].abs() < 1e-9 && (offset_m[1] - 0.3).abs() < 1e-9, "{offset_m:?}");
        assert!((facing - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
        assert!((height_m - 1.1).abs() < 1e-9);
    }

    #[test]
    fn too_few_points_say_so_and_leave_no_residuals() {
        let points = (1..).zip(PLACES).take(3).map(|(n, at)| taken(PointOn::Place, n, at, at)).collect();
        let mut draft = draft(CalibrationKind::RoomFromTracking, points);
        draft.fit(&measured());
        assert!(draft.refused_because.as_ref().unwrap().contains("3 points are too few"), "{draft:?}");
        assert!(draft.result.is_none() && draft.points[0].used.is_none());
    }
}
