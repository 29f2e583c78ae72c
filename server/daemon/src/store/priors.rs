//! Prior changes: who, when, from what, to what, of which object in which scene.

use covr_wire::answers::PriorChange as StoredPriorChange;

use super::{Store, StoreError};

/// One object's change of prior.
#[derive(Debug, Clone, PartialEq)]
pub struct PriorChange {
    /// The scene's id of the object.
    pub object: String,
    /// Before.
    pub from: f64,
    /// After.
    pub to: f64,
}

impl Store {
    /// Store changes of one author, all or none.
    pub async fn add_prior_changes(
        &self,
        at: &str,
        author: &str,
        scene: (i64, i64),
        changes: &[PriorChange],
    ) -> Result<(), StoreError> {
        let mut transaction = self.pool.begin().await?;
        for change in changes {
            sqlx::query(
                "INSERT INTO prior_changes (at, author, object, from_prior, to_prior, scene_id, scene_version) \
                 VALUES (?, ?, ?, ?, ?, ?, ?)",
            )
            .bind(at)
            .bind(author)
            .bind(&change.object)
            .bind(change.from)
            .bind(change.to)
            .bind(scene.0)
            .bind(scene.1)
            .execute(&mut *transaction)
            .await?;
        }
        transaction.commit().await?;
        Ok(())
    }

    /// The newest changes, newest first.
    pub async fn prior_changes(&self, limit: u32) -> Result<Vec<StoredPriorChange>, StoreError> {
        let rows: Vec<(String, String, String, f64, f64, i64, i64)> = sqlx::query_as(
            "SELECT at, author, object, from_prior, to_prior, scene_id, scene_version \
             FROM prior_changes ORDER BY id DESC LIMIT ?",
        )
        .bind(limit)
        .fetch_all(&self.pool)
        .await?;
        let change = |(at, author, object, from, to, scene_id, scene_version)| StoredPriorChange {
            at,
            author,
            object,
            from,
            to,
            scene_id,
            scene_version,
        };
        Ok(rows.into_iter().map(change).collect())
    }

    /// The priors changed since the active scene was activated, the newest of each object.
    pub async fn priors_in_force(&self) -> Result<Vec<(String, f64)>, StoreError> {
        Ok(sqlx::query_as(
            "SELECT object, to_prior FROM prior_changes p, server_state s \
             WHERE p.id > s.priors_after AND p.scene_id = s.active_scene_id \
             AND p.scene_version = s.active_scene_version \
             AND p.id = (SELECT MAX(id) FROM prior_changes q WHERE q.object = p.object \
                         AND q.scene_id = p.scene_id AND q.scene_version = p.scene_version)",
        )
        .fetch_all(&self.pool)
        .await?)
    }
}
