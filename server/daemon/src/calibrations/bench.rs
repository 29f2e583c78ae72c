//! The calibration in the making: its task, its points, and the point that is being taken.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use covr_engine::frames::Floor;
use covr_wire::calibration::{
    CalibrationDraft, CalibrationPoint, CalibrationRefusal, CalibrationTask, Measured, NewCalibrationPoint,
    PointOn, Pointer, Stillness,
};
use covr_wire::client::{Convention, HeadPose};
use covr_wire::reason::Reason;

/// The calibration in the making. Poses pass by without waiting unless a point is being taken.
#[derive(Debug, Default)]
pub struct Bench {
    draft: Mutex<Option<Draft>>,
    listens: AtomicBool,
    gathering: Mutex<Option<Gathering>>,
}

#[derive(Debug)]
struct Draft {
    shown: CalibrationDraft,
    next_number: u32,
}

/// The poses of one client, while a point is taken.
#[derive(Debug)]
struct Gathering {
    client: String,
    pointer: Pointer,
    still: Stillness,
    /// Poses that had nothing to say of the pointer.
    without: usize,
}

/// Ends the gathering, also where whoever asked for the point has gone.
struct Ends<'a>(&'a Bench);

impl Drop for Ends<'_> {
    fn drop(&mut self) {
        self.0.listens.store(false, Ordering::Release);
        *locked(&self.0.gathering) = None;
    }
}

impl Bench {
    /// A pose of a client, in its own axes; it is heard while a point is taken with that client.
    pub fn hear(&self, client: &str, convention: Convention, pose: &HeadPose) {
        if !self.listens.load(Ordering::Acquire) {
            return;
        }
        let mut gathering = locked(&self.gathering);
        let Some(gathering) = gathering.as_mut().filter(|gathering| gathering.client == client) else {
            return;
        };
        let at = match gathering.pointer {
            Pointer::Head => Some(pose.position),
            Pointer::LeftHand => pose.hands.and_then(|hands| hands.left),
            Pointer::RightHand => pose.hands.and_then(|hands| hands.right),
        };
        match at {
            Some(at) => gathering.still.add(&convention.point_to_tracking(at), pose.tracked),
            None => gathering.without += 1,
        }
    }

    /// The one in the making is measured with this client.
    pub fn measures_with(&self, client: &str) -> bool {
        locked(&self.draft).as_ref().is_some_and(|draft| draft.shown.task.client == client)
    }

    /// Begin a calibration; one that was in the making is gone.
    pub fn begin(&self, task: CalibrationTask, author: &str, by: &Measured) -> CalibrationDraft {
        let mut shown = CalibrationDraft {
            task,
            author: author.into(),
            points: Vec::new(),
            result: None,
            refused_because: None,
            why: None,
        };
        shown.fit(by);
        *locked(&self.draft) = Some(Draft { shown: shown.clone(), next_number: 1 });
        shown
    }

    /// The one in the making.
    pub fn draft(&self) -> Option<CalibrationDraft> {
        locked(&self.draft).as_ref().map(|draft| draft.shown.clone())
    }

    /// Forget it; what it was.
    pub fn clear(&self) -> Option<CalibrationDraft> {
        locked(&self.draft).take().map(|draft| draft.shown)
    }

    /// Leave a point out for good; none: there is no such point.
    pub fn remove(&self, number: u32, by: &Measured) -> Option<CalibrationDraft> {
        let mut draft = locked(&self.draft);
        let shown = &mut draft.as_mut()?.shown;
        let place = shown.points.iter().position(|point| point.number == number)?;
        shown.points.remove(place);
        shown.fit(by);
        Some(shown.clone())
    }

    /// Take a point: the mean of what the client's poses say for [`LASTS`]. `column` tells where the machine measures the column.
    pub async fn take(
        &self,
        new: NewCalibrationPoint,
        by: &Measured,
        column: impl Fn() -> Floor,
    ) -> Result<CalibrationDraft, Reason> {
        let task = self.draft().ok_or(Reason::NoCalibrationDraft)?.task;
        let before = column();
        let still = {
            let _ends = self.listen(&task)?;
            tokio::time::sleep(LASTS).await;
            let taken = locked(&self.gathering).take();
            let Some(Gathering { still, without, client, .. }) = taken else {
                return Err(Reason::NoCalibrationDraft);
            };
            let found = still.point();
            if without > 0 && matches!(found, Err(CalibrationRefusal::TooFewPoses { .. })) {
                return Err(Reason::NoPointer { client });
            }
            found.map_err(bad)?
        };
        let after = column();
        let moved_m = (after - before).norm();
        if new.on != PointOn::Place && moved_m > COLUMN_AT_REST_M {
            return Err(bad(CalibrationRefusal::ColumnMoved { moved_m, most_m: COLUMN_AT_REST_M }));
        }
        let room_m = new.place_m.unwrap_or([after.x, after.y, 0.0]);
        let mut draft = locked(&self.draft);
        // Another calibration may have been begun meanwhile.
        let Some(draft) = draft.as_mut().filter(|draft| draft.shown.task == task) else {
            return Err(Reason::NoCalibrationDraft);
        };
        draft.shown.points.push(CalibrationPoint {
            number: draft.next_number,
            on: new.on,
            tracking_m: still.point.vector().into(),
            room_m,
            poses: still.poses,
            jitter_m: still.jitter_m,
            residual_m: None,
            used: None,
        });
        draft.next_number += 1;
        draft.shown.fit(by);
        Ok(draft.shown.clone())
    }

    fn listen(&self, task: &CalibrationTask) -> Result<Ends<'_>, Reason> {
        let mut gathering = locked(&self.gathering);
        if self.listens.load(Ordering::Acquire) {
            return Err(Reason::PointBeingTaken);
        }
        *gathering = Some(Gathering {
            client: task.client.clone(),
            pointer: task.pointer,
            still: Stillness::default(),
            without: 0,
        });
        self.listens.store(true, Ordering::Release);
        Ok(Ends(self))
    }
}

const fn bad(refusal: CalibrationRefusal) -> Reason {
    Reason::BadCalibration { refusal }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // Every change here is whole, so a panic elsewhere leaves nothing half done.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// How long a point is measured: 60 to 120 poses of a headset.
pub const LASTS: Duration = Duration::from_secs(1);
/// Of a column that nobody moves: its encoders are finer, and a hand that leans on it shows.
const COLUMN_AT_REST_M: f64 = 0.002;
