//! Sessions: from arming to disarming, a latched stop, a fault or the end of the server.

use std::time::{Duration, SystemTime};

use covr_wire::dashboard::MachineShape;
use covr_wire::records::{SceneInForce, Session, SessionDetail};

use super::{Store, StoreError, unreadable};
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

/// How a session begins.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NewSession {
    /// When, RFC 3339.
    pub started: String,
    /// When, server time.
    pub started_micros: i64,
    /// The active scene's id and version.
    pub scene: (i64, i64),
    /// Column and travel.
    pub machine_shape: Option<MachineShape>,
    /// The names of everybody who is inside already.
    pub persons: Vec<String>,
}

/// Which sessions.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SessionFilter {
    /// Most rows.
    pub limit: u32,
    /// Sessions with a smaller number alone.
    pub before: Option<i64>,
    /// Words in the scene's name, in how it ended or in a person's name, or the number itself.
    pub search: Option<String>,
}

impl SessionEnd {
    /// Every end.
    pub const ALL: [Self; 5] =
        [Self::Disarmed, Self::LatchedStop, Self::Faulted, Self::Shutdown, Self::Interrupted];

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

#[derive(sqlx::FromRow)]
struct Row {
    id: i64,
    started: String,
    ended: Option<String>,
    how: Option<String>,
    scene_id: i64,
    scene_version: i64,
    scene: String,
    reaches: u32,
    reaches_served: u32,
    stops: u32,
    recorded_frames: i64,
    dropped_frames: i64,
    recording_bytes: i64,
    recording_removed: Option<String>,
}

/// What a session has beside its row, and what was last heard of it.
type Beside = (Option<i64>, Option<i64>, Option<String>);

impl Store {
    /// Begin a session; its number.
    pub async fn begin_session(&self, session: &NewSession) -> Result<i64, StoreError> {
        let shape = session.machine_shape.as_ref().map(serde_json::to_string).transpose();
        let mut transaction = self.pool.begin().await?;
        let id = sqlx::query(
            "INSERT INTO sessions (started, started_micros, scene_id, scene_version, machine_shape) \
             VALUES (?, ?, ?, ?, ?)",
        )
        .bind(&session.started)
        .bind(session.started_micros)
        .bind(session.scene.0)
        .bind(session.scene.1)
        .bind(shape.map_err(unreadable("machine shape"))?)
        .execute(&mut *transaction)
        .await?
        .last_insert_rowid();
        sqlx::query(
            "INSERT INTO session_scenes (session_id, from_micros, scene_id, scene_version) VALUES (?, ?, ?, ?)",
        )
        .bind(id)
        .bind(session.started_micros)
        .bind(session.scene.0)
        .bind(session.scene.1)
        .execute(&mut *transaction)
        .await?;
        for name in &session.persons {
            sqlx::query("INSERT OR IGNORE INTO session_persons (session_id, name) VALUES (?, ?)")
                .bind(id)
                .bind(name)
                .execute(&mut *transaction)
                .await?;
        }
        transaction.commit().await?;
        Ok(id)
    }

    /// End a session that is open, at this wall clock and server time.
    pub async fn end_session(
        &self,
        id: i64,
        ended: &str,
        ended_micros: Option<i64>,
        how: SessionEnd,
    ) -> Result<(), StoreError> {
        sqlx::query(
            "UPDATE sessions SET ended = ?, ended_micros = ?, how = ? WHERE id = ? AND ended IS NULL",
        )
        .bind(ended)
        .bind(ended_micros)
        .bind(how.name())
        .bind(id)
        .execute(&self.pool)
        .await?;
        Ok(())
    }

    /// The newest sessions first; the length of a running one is until `now`.
    pub async fn sessions(
        &self,
        filter: &SessionFilter,
        now: SystemTime,
    ) -> Result<Vec<Session>, StoreError> {
        let word = filter.search.as_ref().map(|words| words.replace('_', " "));
        let pattern = word
            .as_ref()
            .map(|word| format!("%{}%", word.replace('\\', "\\\\").replace('%', "\\%").replace('_', "\\_")));
        let rows: Vec<Row> = sqlx::query_as(
            "SELECT x.*, s.name AS scene FROM sessions x JOIN scenes s ON s.id = x.scene_id \
             WHERE (?2 IS NULL OR x.id < ?2) AND (?3 IS NULL OR CAST(x.id AS TEXT) = ?4 \
             OR replace(s.name, '_', ' ') LIKE ?3 ESCAPE '\\' \
             OR replace(COALESCE(x.how, 'running'), '_', ' ') LIKE ?3 ESCAPE '\\' \
             OR EXISTS (SELECT 1 FROM session_persons p WHERE p.session_id = x.id \
             AND replace(p.name, '_', ' ') LIKE ?3 ESCAPE '\\')) ORDER BY x.id DESC LIMIT ?1",
        )
        .bind(filter.limit)
        .bind(filter.before)
        .bind(pattern)
        .bind(word)
        .fetch_all(&self.pool)
        .await?;
        Ok(rows.into_iter().map(|row| row.told(now)).collect())
    }

    /// One session with what belongs to it; none when there is none of this number.
    pub async fn session(&self, id: i64, now: SystemTime) -> Result<Option<SessionDetail>, StoreError> {
        let row: Option<Row> = sqlx::query_as(
            "SELECT x.*, s.name AS scene FROM sessions x JOIN scenes s ON s.id = x.scene_id WHERE x.id = ?",
        )
        .bind(id)
        .fetch_optional(&self.pool)
        .await?;
        let Some(row) = row else { return Ok(None) };
        let (first_micros, ended_micros, shape): Beside =
            sqlx::query_as("SELECT started_micros, ended_micros, machine_shape FROM sessions WHERE id = ?")
                .bind(id)
                .fetch_one(&self.pool)
                .await?;
        let (frame, event, _) = self.last_heard(id).await?;
        let persons =
            sqlx::query_scalar("SELECT name FROM session_persons WHERE session_id = ? ORDER BY name")
                .bind(id)
                .fetch_all(&self.pool)
                .await?;
        let scenes: Vec<(i64, i64, i64)> = sqlx::query_as(
            "SELECT scene_id, scene_version, from_micros FROM session_scenes WHERE session_id = ? \
             ORDER BY from_micros",
        )
        .bind(id)
        .fetch_all(&self.pool)
        .await?;
        let from_secs = |micros: i64| (micros - first_micros.unwrap_or(micros)) as f64 * 1e-6;
        Ok(Some(SessionDetail {
            session: row.told(now),
            persons,
            scenes: scenes
                .into_iter()
                .map(|(id, version, from)| SceneInForce { id, version, from_secs: from_secs(from) })
                .collect(),
            first_micros,
            last_micros: first_micros.and(ended_micros.max(frame).max(event)),
            machine_shape: shape
                .map(|shape| serde_json::from_str(&shape).map_err(unreadable("machine shape")))
                .transpose()?,
        }))
    }

    /// Server time of a session's last frame and of its last event, and that event's wall clock.
    async fn last_heard(&self, id: i64) -> Result<Beside, StoreError> {
        Ok(sqlx::query_as(
            "SELECT (SELECT MAX(last_micros) FROM recording_chunks WHERE session_id = ?1), MAX(at_micros), MAX(at) \
             FROM events WHERE session_id = ?1",
        )
        .bind(id)
        .fetch_one(&self.pool)
        .await?)
    }

    /// Close every open session as interrupted; how many. It ended no later than its last event or frame.
    pub(super) async fn interrupt_open_sessions(&self) -> Result<u64, StoreError> {
        let open: Vec<(i64, String, Option<i64>)> =
            sqlx::query_as("SELECT id, started, started_micros FROM sessions WHERE ended IS NULL")
                .fetch_all(&self.pool)
                .await?;
        for (id, started, started_micros) in &open {
            let (frame, event, at) = self.last_heard(*id).await?;
            let ended_micros = started_micros.and_then(|start| frame.max(event).max(Some(start)));
            let begun = humantime::parse_rfc3339(started).ok();
            // The wall clock of the end follows from the start's, as both clocks ran together.
            let ended = begun.zip(started_micros.zip(ended_micros)).map(|(begun, (start, end))| {
                let lasted = Duration::from_micros(u64::try_from(end - start).unwrap_or(0));
                humantime::format_rfc3339_micros(begun + lasted).to_string()
            });
            let ended = ended.or(at).unwrap_or_else(wall_now);
            self.end_session(*id, &ended, ended_micros, SessionEnd::Interrupted).await?;
        }
        Ok(open.len() as u64)
    }
}

impl Row {
    fn told(self, now: SystemTime) -> Session {
        let end = match &self.ended {
            None => Some(now),
            Some(ended) => humantime::parse_rfc3339(ended).ok(),
        };
        let start = humantime::parse_rfc3339(&self.started).ok();
        let length = start.zip(end).map(|(start, end)| end.duration_since(start).unwrap_or_default());
        Session {
            id: self.id,
            started_at: self.started,
            ended_at: self.ended,
            how: self.how,
            scene_id: self.scene_id,
            scene_version: self.scene_version,
            scene: self.scene,
            length_secs: length.map(|length| length.as_secs_f64()),
            reaches: self.reaches,
            reaches_served: self.reaches_served,
            stops: self.stops,
            recorded_frames: self.recorded_frames.cast_unsigned(),
            dropped_frames: self.dropped_frames.cast_unsigned(),
            recording_bytes: self.recording_bytes.cast_unsigned(),
            recording_removed_at: self.recording_removed,
        }
    }
}
