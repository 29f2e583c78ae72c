//! Scenes: each edit is a new version with its author.

use covr_wire::answers::{SceneSummary, SceneVersionSummary};
use covr_wire::scene::SceneDocument;

use super::{Store, StoreError, unreadable};
use crate::clock::wall_now;

/// One version of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneVersion {
    /// The store's number of the scene.
    pub id: i64,
    /// The version.
    pub version: i64,
    /// Who wrote it.
    pub author: String,
    /// When.
    pub created: String,
    /// What.
    pub document: SceneDocument,
}

impl Store {
    /// Store a new scene as its version 1; its number.
    pub async fn add_scene(&self, document: &SceneDocument, author: &str) -> Result<i64, StoreError> {
        let (text, now) = (as_text(document)?, wall_now());
        let mut transaction = self.pool.begin().await?;
        let id = sqlx::query("INSERT INTO scenes (name, created) VALUES (?, ?)")
            .bind(&document.name)
            .bind(&now)
            .execute(&mut *transaction)
            .await?
            .last_insert_rowid();
        sqlx::query(
            "INSERT INTO scene_versions (scene_id, version, document, author, created) VALUES (?, 1, ?, ?, ?)",
        )
        .bind(id)
        .bind(text)
        .bind(author)
        .bind(&now)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(id)
    }

    /// Store a new version of a scene; its version, or none when there is no such scene.
    pub async fn add_scene_version(
        &self,
        id: i64,
        document: &SceneDocument,
        author: &str,
    ) -> Result<Option<i64>, StoreError> {
        let text = as_text(document)?;
        let mut transaction = self.pool.begin_with("BEGIN IMMEDIATE").await?;
        let renamed = sqlx::query("UPDATE scenes SET name = ? WHERE id = ?")
            .bind(&document.name)
            .bind(id)
            .execute(&mut *transaction)
            .await?;
        if renamed.rows_affected() == 0 {
            return Ok(None);
        }
        let version: i64 = sqlx::query_scalar(
            "INSERT INTO scene_versions (scene_id, version, document, author, created) \
             SELECT ?1, 1 + MAX(version), ?2, ?3, ?4 FROM scene_versions WHERE scene_id = ?1 RETURNING version",
        )
        .bind(id)
        .bind(text)
        .bind(author)
        .bind(wall_now())
        .fetch_one(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(Some(version))
    }

    /// Every scene, oldest first.
    pub async fn scenes(&self) -> Result<Vec<SceneSummary>, StoreError> {
        let rows: Vec<(i64, String, i64, String, String, bool)> = sqlx::query_as(
            "SELECT s.id, s.name, v.version, v.author, v.created, \
             s.id IS (SELECT active_scene_id FROM server_state) \
             FROM scenes s JOIN scene_versions v ON v.scene_id = s.id \
             WHERE v.version = (SELECT MAX(version) FROM scene_versions WHERE scene_id = s.id) ORDER BY s.id",
        )
        .fetch_all(&self.pool)
        .await?;
        let summary = |(id, name, version, author, changed_at, active)| SceneSummary {
            id,
            name,
            version,
            author,
            changed_at,
            active,
        };
        Ok(rows.into_iter().map(summary).collect())
    }

    /// Every version of a scene, newest first; empty when there is no such scene.
    pub async fn scene_versions(&self, id: i64) -> Result<Vec<SceneVersionSummary>, StoreError> {
        let rows: Vec<(i64, String, String, bool, i64)> = sqlx::query_as(
            "SELECT v.version, v.author, v.created, \
             (v.scene_id IS s.active_scene_id AND v.version IS s.active_scene_version), \
             json_array_length(v.document, '$.objects') \
             FROM scene_versions v, server_state s WHERE v.scene_id = ? ORDER BY v.version DESC",
        )
        .bind(id)
        .fetch_all(&self.pool)
        .await?;
        let summary = |(version, author, created_at, active, objects)| SceneVersionSummary {
            version,
            author,
            created_at,
            active,
            objects,
        };
        Ok(rows.into_iter().map(summary).collect())
    }

    /// A version of a scene, the newest when none is named.
    pub async fn scene(&self, id: i64, version: Option<i64>) -> Result<Option<SceneVersion>, StoreError> {
        let row: Option<(i64, String, String, String)> = sqlx::query_as(
            "SELECT version, author, created, document FROM scene_versions \
             WHERE scene_id = ?1 AND (?2 IS NULL OR version = ?2) ORDER BY version DESC LIMIT 1",
        )
        .bind(id)
        .bind(version)
        .fetch_optional(&self.pool)
        .await?;
        row.map(|(version, author, created, text)| {
            let document =
                serde_json::from_str(&text).map_err(unreadable(format!("scene {id} version {version}")))?;
            Ok(SceneVersion { id, version, author, created, document })
        })
        .transpose()
    }

    /// Remember the active scene. Its priors start again from the document.
    pub async fn set_active_scene(&self, id: i64, version: i64) -> Result<(), StoreError> {
        sqlx::query(
            "UPDATE server_state SET active_scene_id = ?, active_scene_version = ?, \
             priors_after = (SELECT COALESCE(MAX(id), 0) FROM prior_changes)",
        )
        .bind(id)
        .bind(version)
        .execute(&self.pool)
        .await?;
        Ok(())
    }
}

fn as_text(document: &SceneDocument) -> Result<String, StoreError> {
    serde_json::to_string(document).map_err(unreadable("scene"))
}
