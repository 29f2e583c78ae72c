//! Commissionings: only ever added; the last one counts.

use covr_wire::commissioning::{BrakeRun, Commissioning};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Store, StoreError, unreadable};

type Row = (i64, f64, String, String, String, String, String);

impl Store {
    /// Store a commissioning; its number, which the one given has not. `changed` is not stored.
    pub async fn add_commissioning(&self, new: &Commissioning) -> Result<i64, StoreError> {
        Ok(sqlx::query_scalar(
            "INSERT INTO commissionings (load_kg, braking_mps2, runs, hardware, author, created) \
             VALUES (?, ?, ?, ?, ?, ?) RETURNING id",
        )
        .bind(new.load_kg)
        .bind(text(&new.braking_mps2)?)
        .bind(text(&new.runs)?)
        .bind(text(&new.hardware)?)
        .bind(&new.author)
        .bind(&new.created_at)
        .fetch_one(&self.pool)
        .await?)
    }

    /// Every commissioning, newest first. `changed` of each is left empty.
    pub async fn commissionings(&self) -> Result<Vec<Commissioning>, StoreError> {
        let rows: Vec<Row> = sqlx::query_as(
            "SELECT id, load_kg, braking_mps2, runs, hardware, author, created FROM commissionings ORDER BY id DESC",
        )
        .fetch_all(&self.pool)
        .await?;
        rows.into_iter().map(commissioning).collect()
    }

    /// The stops from speed since then (as `wall_now` writes it), oldest first.
    pub async fn stops_measured_since(&self, since: &str) -> Result<Vec<BrakeRun>, StoreError> {
        let rows: Vec<(i64, String)> = sqlx::query_as(
            "SELECT id, detail FROM events WHERE kind = 'came_to_rest' AND at >= ? ORDER BY id",
        )
        .bind(since)
        .fetch_all(&self.pool)
        .await?;
        rows.into_iter().map(|(id, detail)| read(id, &detail)).collect()
    }
}

fn commissioning(
    (id, load_kg, braking, runs, hardware, author, created_at): Row,
) -> Result<Commissioning, StoreError> {
    Ok(Commissioning {
        id,
        author,
        created_at,
        load_kg,
        braking_mps2: read(id, &braking)?,
        runs: read(id, &runs)?,
        hardware: read(id, &hardware)?,
        changed: Vec::new(),
    })
}

fn text(value: &impl Serialize) -> Result<String, StoreError> {
    serde_json::to_string(value).map_err(unreadable("commissioning"))
}

fn read<T: DeserializeOwned>(id: i64, text: &str) -> Result<T, StoreError> {
    serde_json::from_str(text).map_err(unreadable(format!("commissioning {id}")))
}
