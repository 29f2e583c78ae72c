//! Calibrations: only ever added; the last choice of a kind and subject is in force.

use covr_wire::calibration::{
    Calibration, CalibrationKind, CalibrationPoint, CalibrationResult, CalibrationSummary, Hardware,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Store, StoreError, unreadable};
use crate::clock::wall_now;

/// A calibration to be stored.
#[derive(Debug, Clone, PartialEq)]
pub struct NewCalibration {
    /// What is calibrated.
    pub kind: CalibrationKind,
    /// Of what.
    pub subject: String,
    /// What was worked out.
    pub result: CalibrationResult,
    /// From what.
    pub points: Vec<CalibrationPoint>,
    /// On what.
    pub hardware: Hardware,
    /// Who accepted it.
    pub author: String,
}

type Row = (i64, String, String, i64, String, String, String, String, String, bool);

impl Store {
    /// Store a calibration as its subject's next version and put it in force, both or neither; its number.
    pub async fn add_calibration(&self, new: &NewCalibration) -> Result<i64, StoreError> {
        let (result, points, hardware) = (text(&new.result)?, text(&new.points)?, text(&new.hardware)?);
        let (kind, now) = (kind_name(new.kind), wall_now());
        let mut transaction = self.pool.begin_with("BEGIN IMMEDIATE").await?;
        let id: i64 = sqlx::query_scalar(
            "INSERT INTO calibrations (kind, subject, version, result, points, hardware, author, created) \
             SELECT ?1, ?2, 1 + COALESCE(MAX(version), 0), ?3, ?4, ?5, ?6, ?7 FROM calibrations \
             WHERE kind = ?1 AND subject = ?2 RETURNING id",
        )
        .bind(kind)
        .bind(&new.subject)
        .bind(result)
        .bind(points)
        .bind(hardware)
        .bind(&new.author)
        .bind(&now)
        .fetch_one(&mut *transaction)
        .await?;
        sqlx::query(
            "INSERT INTO calibration_choices (kind, subject, calibration_id, author, at) VALUES (?, ?, ?, ?, ?)",
        )
        .bind(kind)
        .bind(&new.subject)
        .bind(id)
        .bind(&new.author)
        .bind(&now)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(id)
    }

    /// Put a stored calibration in force, or none of its subject.
    pub async fn choose_calibration(
        &self,
        summary: &CalibrationSummary,
        is_in_force: bool,
        author: &str,
    ) -> Result<(), StoreError> {
        sqlx::query(
            "INSERT INTO calibration_choices (kind, subject, calibration_id, author, at) VALUES (?, ?, ?, ?, ?)",
        )
        .bind(kind_name(summary.kind))
        .bind(&summary.subject)
        .bind(is_in_force.then_some(summary.id))
        .bind(author)
        .bind(wall_now())
        .execute(&self.pool)
        .await?;
        Ok(())
    }

    /// Every calibration, newest first, with its points. `changed` of each is left empty.
    pub async fn calibrations(&self) -> Result<Vec<Calibration>, StoreError> {
        let rows: Vec<Row> = sqlx::query_as(SELECT).bind(None::<i64>).fetch_all(&self.pool).await?;
        rows.into_iter().map(calibration).collect()
    }

    /// One of them.
    pub async fn calibration(&self, id: i64) -> Result<Option<Calibration>, StoreError> {
        let row: Option<Row> = sqlx::query_as(SELECT).bind(id).fetch_optional(&self.pool).await?;
        row.map(calibration).transpose()
    }
}

const SELECT: &str = "SELECT c.id, c.kind, c.subject, c.version, c.result, c.points, c.hardware, c.author, c.created, \
     c.id IS (SELECT calibration_id FROM calibration_choices x WHERE x.kind = c.kind AND x.subject = c.subject \
     ORDER BY x.id DESC LIMIT 1) FROM calibrations c WHERE ?1 IS NULL OR c.id = ?1 ORDER BY c.id DESC";

fn calibration(
    (id, kind, subject, version, result, points, hardware, author, created_at, in_force): Row,
) -> Result<Calibration, StoreError> {
    let points: Vec<CalibrationPoint> = read(id, &points)?;
    let points_used = points.iter().filter(|point| point.used == Some(true)).count();
    let summary = CalibrationSummary {
        id,
        kind: read(id, &format!("\"{kind}\""))?,
        subject,
        version,
        author,
        created_at,
        in_force,
        points_used,
        points_left_out: points.len() - points_used,
        result: read::<CalibrationResult>(id, &result)?,
        changed: Vec::new(),
    };
    Ok(Calibration { summary, points, hardware: read::<Hardware>(id, &hardware)? })
}

const fn kind_name(kind: CalibrationKind) -> &'static str {
    match kind {
        CalibrationKind::RoomFromTracking => "room_from_tracking",
        CalibrationKind::Prop => "prop",
    }
}

fn text(value: &impl Serialize) -> Result<String, StoreError> {
    serde_json::to_string(value).map_err(unreadable("calibration"))
}

fn read<T: DeserializeOwned>(id: i64, text: &str) -> Result<T, StoreError> {
    serde_json::from_str(text).map_err(unreadable(format!("calibration {id}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use covr_wire::client::Convention;
    use tempfile::TempDir;

    fn new(subject: &str) -> NewCalibration {
        NewCalibration {
            kind: CalibrationKind::RoomFromTracking,
            subject: subject.into(),
            result: CalibrationResult::RoomFromTracking {
                convention: Convention::Unity,
                position_m: [1.0, 2.0, 0.1 + 0.2],
                orientation: [0.0, 0.0, 0.0, 1.0],
                rms_m: 0.002,
                scale: 1.0,
                tilt_rad: 0.0,
                uncertainty_m: 0.003,
                turn_sd_rad: 0.0,
                offset_m: None,
            },
            points: Vec::new(),
            hardware: Hardware {
                machine: "simulated".into(),
                travel_m: [[0.0, 0.0], [4.0, 4.0]],
                controller: None,
                firmware: None,
                counts_per_metre: None,
            },
            author: "Ada".into(),
        }
    }

    #[tokio::test]
    async fn versions_count_by_subject_and_the_last_choice_is_in_force() {
        let dir = TempDir::new().unwrap();
        let store = Store::open(&dir.path().join("covr.sqlite")).await.unwrap();
        for subject in ["a", "b", "a"] {
            store.add_calibration(&new(subject)).await.unwrap();
        }
        let all = store.calibrations().await.unwrap();
        let shown: Vec<_> = all
            .iter()
            .map(|one| (one.summary.subject.as_str(), one.summary.version, one.summary.in_force))
            .collect();
        assert_eq!(shown, [("a", 2, true), ("b", 1, true), ("a", 1, false)]);
        assert_eq!(all[0].summary.result, new("a").result, "to the last bit");
        store.choose_calibration(&all[2].summary, true, "Bo").await.unwrap();
        store.choose_calibration(&all[1].summary, false, "Bo").await.unwrap();
        let all = store.calibrations().await.unwrap();
        let in_force: Vec<_> = all.iter().map(|one| one.summary.in_force).collect();
        assert_eq!(in_force, [false, false, true]);
    }

    #[tokio::test]
    async fn nothing_that_is_stored_is_changed_or_removed() {
        let dir = TempDir::new().unwrap();
        let store = Store::open(&dir.path().join("covr.sqlite")).await.unwrap();
        store.add_calibration(&new("a")).await.unwrap();
        for statement in [
            "UPDATE calibrations SET author = 'Eve'",
            "DELETE FROM calibrations",
            "UPDATE calibration_choices SET author = 'Eve'",
            "DELETE FROM calibration_choices",
        ] {
            let refused = sqlx::query(statement).execute(&store.pool).await.unwrap_err().to_string();
            assert!(refused.contains("is never"), "{statement}: {refused}");
        }
    }
}
