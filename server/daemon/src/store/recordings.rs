//! Recordings: chunks of frames, about a second each, and what makes room for new ones.
//!
//! Three places were weighed: files beside the database (a second thing to back up, and two that can disagree after a
//! crash), one row a frame (thirty transactions a second, three times the size), chunks in a table (chosen: one
//! transaction a second, deleted and counted together with their session).

use super::{Store, StoreError};
use crate::clock::wall_now;

/// A chunk on its way into the store.
#[derive(Debug, Clone, PartialEq)]
pub struct NewChunk {
    /// The session that it belongs to.
    pub session_id: i64,
    /// Server time of its first frame.
    pub first_micros: i64,
    /// And of its last.
    pub last_micros: i64,
    /// How many frames.
    pub frames: u32,
    /// Frames before it that were lost.
    pub dropped: u64,
    /// The encoded frames.
    pub document: Vec<u8>,
}

/// A stored chunk.
#[derive(Debug, Clone, PartialEq, sqlx::FromRow)]
pub struct StoredChunk {
    /// Server time of its first frame.
    pub first_micros: i64,
    /// The encoded frames.
    pub document: Vec<u8>,
}

/// How much of the recordings is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Keep {
    /// Sessions that ended before this moment (RFC 3339) lose their recordings; none: all are kept.
    pub since: Option<std::time::SystemTime>,
    /// Bytes of all recordings together; none: any.
    pub bytes: Option<u64>,
}

impl Store {
    /// Store a chunk, and count it to its session.
    pub async fn add_chunk(&self, chunk: &NewChunk) -> Result<(), StoreError> {
        let mut transaction = self.pool.begin_with("BEGIN IMMEDIATE").await?;
        sqlx::query(
            "INSERT INTO recording_chunks (session_id, first_micros, last_micros, frames, document) \
             VALUES (?, ?, ?, ?, ?)",
        )
        .bind(chunk.session_id)
        .bind(chunk.first_micros)
        .bind(chunk.last_micros)
        .bind(chunk.frames)
        .bind(&chunk.document)
        .execute(&mut *transaction)
        .await?;
        sqlx::query(
            "UPDATE sessions SET recorded_frames = recorded_frames + ?2, dropped_frames = dropped_frames + ?3, \
             recording_bytes = recording_bytes + ?4 WHERE id = ?1",
        )
        .bind(chunk.session_id)
        .bind(chunk.frames)
        .bind(chunk.dropped as i64)
        .bind(chunk.document.len() as i64)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(())
    }

    /// The first chunk of a session that begins after `after` and has frames from `from` to `to`, server time.
    pub async fn next_chunk(
        &self,
        session: i64,
        after: Option<i64>,
        from: i64,
        to: i64,
    ) -> Result<Option<StoredChunk>, StoreError> {
        Ok(sqlx::query_as(
            "SELECT first_micros, document FROM recording_chunks WHERE session_id = ?1 \
             AND first_micros > ?2 AND last_micros >= ?3 AND first_micros <= ?4 ORDER BY first_micros LIMIT 1",
        )
        .bind(session)
        .bind(after.unwrap_or(i64::MIN))
        .bind(from)
        .bind(to)
        .fetch_optional(&self.pool)
        .await?)
    }

    /// How many frames the chunks have that reach into a stretch of a session.
    pub async fn count_frames(&self, session: i64, from: i64, to: i64) -> Result<u64, StoreError> {
        let frames: i64 = sqlx::query_scalar(
            "SELECT COALESCE(SUM(frames), 0) FROM recording_chunks \
             WHERE session_id = ?1 AND last_micros >= ?2 AND first_micros <= ?3",
        )
        .bind(session)
        .bind(from)
        .bind(to)
        .fetch_one(&self.pool)
        .await?;
        Ok(frames.cast_unsigned())
    }

    /// Delete the oldest recordings until what is left is to be kept. Sessions stay, and say that their recording was
    /// removed. The running session loses its oldest chunks last of all. The file does not shrink: what is freed is
    /// used again.
    pub async fn make_room(&self, keep: Keep, running: Option<i64>) -> Result<u64, StoreError> {
        let mut removed = 0;
        while let Some(session) = self.too_old_or_too_much(keep).await? {
            removed += self.remove_chunks(session).await?;
            if Some(session) == running {
                break;
            }
        }
        Ok(removed)
    }

    /// The oldest session whose recording is not to be kept.
    async fn too_old_or_too_much(&self, keep: Keep) -> Result<Option<i64>, StoreError> {
        let since = keep.since.map(|since| humantime::format_rfc3339_micros(since).to_string());
        Ok(sqlx::query_scalar(
            "SELECT id FROM sessions WHERE recording_bytes > 0 AND (ended < ?1 \
             OR (SELECT SUM(recording_bytes) FROM sessions) > ?2) ORDER BY id LIMIT 1",
        )
        .bind(since)
        .bind(keep.bytes.and_then(|bytes| i64::try_from(bytes).ok()))
        .fetch_optional(&self.pool)
        .await?)
    }

    /// Delete a session's oldest chunks, as many as one transaction takes without keeping others waiting; how many.
    async fn remove_chunks(&self, session: i64) -> Result<u64, StoreError> {
        let mut transaction = self.pool.begin_with("BEGIN IMMEDIATE").await?;
        let last: Option<i64> = sqlx::query_scalar(
            "SELECT MAX(first_micros) FROM (SELECT first_micros FROM recording_chunks WHERE session_id = ?1 \
             ORDER BY first_micros LIMIT ?2)",
        )
        .bind(session)
        .bind(CHUNKS_AT_ONCE)
        .fetch_one(&mut *transaction)
        .await?;
        let done = sqlx::query("DELETE FROM recording_chunks WHERE session_id = ?1 AND first_micros <= ?2")
            .bind(session)
            .bind(last)
            .execute(&mut *transaction)
            .await?;
        // Counted anew rather than subtracted: with no chunk left it is zero, whatever it was.
        sqlx::query(
            "UPDATE sessions SET recording_removed = ?2, \
             recorded_frames = (SELECT COALESCE(SUM(frames), 0) FROM recording_chunks WHERE session_id = ?1), \
             recording_bytes = (SELECT COALESCE(SUM(length(document)), 0) FROM recording_chunks WHERE session_id = ?1) \
             WHERE id = ?1",
        )
        .bind(session)
        .bind(wall_now())
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(done.rows_affected())
    }
}

/// Two minutes of frames.
const CHUNKS_AT_ONCE: i64 = 120;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::{NewSession, SessionEnd};
    use covr_wire::scene::parse_scene;
    use std::time::{Duration, SystemTime};

    /// A store with sessions of so many chunks of 100 bytes each, the last one running; their ids.
    async fn with_sessions(dir: &tempfile::TempDir, chunks: &[i64]) -> (Store, Vec<i64>) {
        let store = Store::open(&dir.path().join("covr.sqlite")).await.unwrap();
        let scene = include_str!("../../../../deploy/scenes/demo.json");
        let scene = store.add_scene(&parse_scene(scene.as_bytes()).unwrap().0, "test").await.unwrap();
        let mut ids = Vec::new();
        for (i, chunks) in chunks.iter().enumerate() {
            let started = format!("2026-01-0{}T10:00:00.000000Z", i + 1);
            let start = NewSession { started, scene: (scene, 1), ..NewSession::default() };
            let id = store.begin_session(&start).await.unwrap();
            for number in 0..*chunks {
                let (first_micros, last_micros) = (number * 1_000_000, number * 1_000_000 + 900_000);
                let document = vec![7; 100];
                let (frames, dropped) = (30, 1);
                let chunk = NewChunk { session_id: id, first_micros, last_micros, frames, dropped, document };
                store.add_chunk(&chunk).await.unwrap();
            }
            ids.push(id);
        }
        for (i, id) in ids.iter().enumerate().take(ids.len() - 1) {
            let ended = format!("2026-01-0{}T11:00:00.000000Z", i + 1);
            store.end_session(*id, &ended, None, SessionEnd::Disarmed).await.unwrap();
        }
        (store, ids)
    }

    async fn bytes(store: &Store, id: i64) -> (u64, u64, bool) {
        let session = store.session(id, SystemTime::now()).await.unwrap().unwrap().session;
        (session.recorded_frames, session.recording_bytes, session.recording_removed_at.is_some())
    }

    #[tokio::test]
    async fn old_recordings_go_and_their_sessions_stay() {
        let dir = tempfile::tempdir().unwrap();
        let (store, ids) = with_sessions(&dir, &[300, 2, 2]).await;
        assert_eq!(bytes(&store, ids[0]).await, (9_000, 30_000, false));
        let since = humantime::parse_rfc3339("2026-01-02T00:00:00Z").unwrap();
        let removed = store.make_room(Keep { since: Some(since), bytes: None }, Some(ids[2])).await.unwrap();
        assert_eq!(removed, 300);
        assert_eq!(bytes(&store, ids[0]).await, (0, 0, true));
        assert_eq!(bytes(&store, ids[1]).await, (60, 200, false));
        let since = SystemTime::now() + Duration::from_secs(3600);
        store.make_room(Keep { since: Some(since), bytes: None }, Some(ids[2])).await.unwrap();
        assert_eq!(bytes(&store, ids[1]).await, (0, 0, true));
        assert_eq!(bytes(&store, ids[2]).await, (60, 200, false), "a running session is not old");
    }

    #[tokio::test]
    async fn too_much_goes_oldest_first_and_the_running_session_last() {
        let dir = tempfile::tempdir().unwrap();
        let (store, ids) = with_sessions(&dir, &[3, 3, 200]).await;
        let keep = |bytes| Keep { since: None, bytes: Some(bytes) };
        assert_eq!(store.make_room(keep(20_600), Some(ids[2])).await.unwrap(), 0);
        assert_eq!(store.make_room(keep(20_599), Some(ids[2])).await.unwrap(), 3);
        assert_eq!(bytes(&store, ids[0]).await, (0, 0, true));
        assert_eq!(bytes(&store, ids[1]).await, (90, 300, false));
        assert_eq!(store.make_room(keep(1_000), Some(ids[2])).await.unwrap(), 3 + 120);
        assert_eq!(bytes(&store, ids[2]).await, (80 * 30, 8_000, true));
        let first = store.next_chunk(ids[2], None, 0, i64::MAX).await.unwrap().unwrap();
        assert_eq!(first.first_micros, 120_000_000, "the newest are left");
    }

    #[tokio::test]
    async fn chunks_are_found_by_the_stretch_that_is_asked_for() {
        let dir = tempfile::tempdir().unwrap();
        let (store, ids) = with_sessions(&dir, &[5]).await;
        let id = ids[0];
        assert_eq!(store.count_frames(id, 950_000, 2_000_000).await.unwrap(), 60);
        let next = |after| store.next_chunk(id, after, 950_000, 2_000_000);
        assert_eq!(next(None).await.unwrap().unwrap().first_micros, 1_000_000);
        assert_eq!(next(Some(1_000_000)).await.unwrap().unwrap().first_micros, 2_000_000);
        assert_eq!(next(Some(2_000_000)).await.unwrap(), None);
    }
}
