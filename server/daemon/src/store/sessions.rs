//! Sessions: from arming to disarming, a latched stop, a fault or the end of the server.

use serde::{Deserialize, Serialize};

use super::{Store, StoreError};
use crate::clock::wall_now;

/// How a session ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SessionEnd {
    /// Somebody disarmed.
    Disarmed,
    /// A stop latched.
    LatchedStop,
    /// The machine faulted.
    Faulted,
    /// The server was shut down.
    Shutdown,
    /// The server ended without a word; said at the next start.
    Interrupted,
}

/// A session.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, sqlx::FromRow, utoipa::ToSchema)]
pub struct StoredSession {
    /// The store's number of the session.
    pub id: i64,
    /// When the machine was armed, RFC 3339.
    pub started_at: String,
    /// When it ended; null while it runs.
    pub ended_at: Option<String>,
    /// `disarmed`, `latched_stop`, `faulted`, `shutdown` or `interrupted`; null while it runs.
    pub how: Option<String>,
    /// The scene that was active at its start.
    pub scene_id: i64,
    /// And its version.
    pub scene_version: i64,
    /// What people call that scene.
    pub scene: String,
}

impl SessionEnd {
    /// The name on every surface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Disarmed => "disarmed",
            Self::LatchedStop => "latched_stop",
            Self::Faulted => "faulted",
            Self::Shutdown => "shutdown",
            Self::Interrupted => "interrupted",
        }
    }
}

impl Store {
    /// Begin a session; its number.
    pub async fn begin_session(&self, started: &str, scene: (i64, i64)) -> Result<i64, StoreError> {
        let done = sqlx::query("INSERT INTO sessions (started, scene_id, scene_version) VALUES (?, ?, ?)")
            .bind(started)
            .bind(scene.0)
            .bind(scene.1)
            .execute(&self.pool)
            .await?;
        Ok(done.last_insert_rowid())
    }

    /// End a session that is open.
    pub async fn end_session(&self, id: i64, ended: &str, how: SessionEnd) -> Result<(), StoreError> {
        sqlx::query("UPDATE sessions SET ended = ?, how = ? WHERE id = ? AND ended IS NULL")
            .bind(ended)
            .bind(how.name())
            .bind(id)
            .execute(&self.pool)
            .await?;
        Ok(())
    }

    /// The newest sessions first.
    pub async fn sessions(&self, limit: u32) -> Result<Vec<StoredSession>, StoreError> {
        Ok(sqlx::query_as(
            "SELECT x.id, x.started AS started_at, x.ended AS ended_at, x.how, x.scene_id, x.scene_version, \
             s.name AS scene FROM sessions x JOIN scenes s ON s.id = x.scene_id ORDER BY x.id DESC LIMIT ?",
        )
        .bind(limit)
        .fetch_all(&self.pool)
        .await?)
    }

    /// Close every open session as interrupted; how many. It ended no later than its last event.
    pub(super) async fn interrupt_open_sessions(&self) -> Result<u64, StoreError> {
        let done = sqlx::query(
            "UPDATE sessions SET how = 'interrupted', \
             ended = COALESCE((SELECT MAX(at) FROM events WHERE session_id = sessions.id), ?) WHERE ended IS NULL",
        )
        .bind(wall_now())
        .execute(&self.pool)
        .await?;
        Ok(done.rows_affected())
    }
}
