//! What outlives the process: scenes, sessions with their recordings, events, prior changes, tokens, calibrations, and what the next start must know.
//!
//! SQLite in WAL mode with `synchronous=FULL`: what a method has returned survives kill -9 and loss of power.
//! The control loop never comes here.

mod calibrations;
mod commissionings;
mod events;
mod priors;
mod recordings;
mod scenes;
mod sessions;
mod tokens;

use std::path::Path;
use std::str::FromStr;
use std::time::Duration;

use sqlx::migrate::Migrator;
use sqlx::sqlite::{
    SqliteConnectOptions, SqliteJournalMode, SqlitePool, SqlitePoolOptions, SqliteSynchronous,
};

pub use calibrations::NewCalibration;
pub use events::{EventFilter, EventPage, NewEvent};
pub use priors::PriorChange;
pub use recordings::{Keep, NewChunk, StoredChunk};
pub use scenes::SceneVersion;
pub use sessions::{NewSession, SessionEnd, SessionFilter};
pub use tokens::{StoredLogin, StoredToken};

/// The database.
#[derive(Debug, Clone)]
pub struct Store {
    pool: SqlitePool,
}

/// What the last run left for this one.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftOver {
    /// It ended in a latched stop, which left this record (`covr_wire::reason::latch_record`).
    pub latched_because: Option<String>,
    /// The active scene's id and version.
    pub active_scene: Option<(i64, i64)>,
    /// Sessions that it never closed, closed now as interrupted.
    pub interrupted_sessions: u64,
}

/// Why the store did not answer.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The database refused.
    #[error("database: {0}")]
    Database(#[from] sqlx::Error),
    /// The database is of another version.
    #[error("database migrations: {0}")]
    Migration(#[from] sqlx::migrate::MigrateError),
    /// What is stored cannot be read back.
    #[error("stored {what} cannot be read: {source}")]
    Unreadable {
        /// Which row.
        what: String,
        /// Why.
        source: serde_json::Error,
    },
}

static MIGRATIONS: Migrator = sqlx::migrate!("../../migrations/sqlite");

impl Store {
    /// Open the file, made when missing, and bring it to this version.
    pub async fn open(path: &Path) -> Result<Self, StoreError> {
        let options = SqliteConnectOptions::from_str("sqlite:")?
            .filename(path)
            .create_if_missing(true)
            .journal_mode(SqliteJournalMode::Wal)
            .synchronous(SqliteSynchronous::Full)
            .foreign_keys(true)
            .busy_timeout(BUSY_TIMEOUT);
        let pool = SqlitePoolOptions::new()
            .max_connections(4)
            .acquire_timeout(ACQUIRE_TIMEOUT)
            .connect_with(options)
            .await?;
        MIGRATIONS.run(&pool).await?;
        Ok(Self { pool })
    }

    /// Close what the last run left open, and say what it left.
    pub async fn take_over(&self) -> Result<LeftOver, StoreError> {
        let interrupted_sessions = self.interrupt_open_sessions().await?;
        let (latched_because, scene, version): (Option<String>, Option<i64>, Option<i64>) =
            sqlx::query_as("SELECT latched_because, active_scene_id, active_scene_version FROM server_state")
                .fetch_one(&self.pool)
                .await?;
        Ok(LeftOver { latched_because, active_scene: scene.zip(version), interrupted_sessions })
    }

    /// Remember a latched stop, or that it was reset.
    pub async fn set_latched(&self, because: Option<&str>) -> Result<(), StoreError> {
        sqlx::query("UPDATE server_state SET latched_because = ?").bind(because).execute(&self.pool).await?;
        Ok(())
    }

    /// A write that changes nothing, to know whether writing works.
    pub async fn probe(&self) -> Result<(), StoreError> {
        sqlx::query("UPDATE server_state SET only_row = 1").execute(&self.pool).await?;
        Ok(())
    }

    /// Write out and close. Later calls fail.
    pub async fn close(&self) {
        self.pool.close().await;
    }
}

const BUSY_TIMEOUT: Duration = Duration::from_secs(5);
const ACQUIRE_TIMEOUT: Duration = Duration::from_secs(5);

fn unreadable(what: impl Into<String>) -> impl FnOnce(serde_json::Error) -> StoreError {
    |source| StoreError::Unreadable { what: what.into(), source }
}
