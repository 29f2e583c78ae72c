//! Events: what happened, in order.

use covr_wire::dashboard::Event;

use sqlx::SqliteConnection;

use super::{Store, StoreError, unreadable};

/// An event on its way into the store.
#[derive(Debug, Clone, PartialEq)]
pub struct NewEvent {
    /// The session that it belongs to.
    pub session_id: Option<i64>,
    /// What happened.
    pub event: Event,
}

impl Store {
    /// Store events, all or none, and count them to their sessions.
    pub async fn add_events(&self, events: &[NewEvent]) -> Result<(), StoreError> {
        let mut transaction = self.pool.begin().await?;
        for NewEvent { session_id, event } in events {
            sqlx::query(
                "INSERT INTO events (session_id, at_micros, at, kind, summary, detail) VALUES (?, ?, ?, ?, ?, ?)",
            )
            .bind(session_id)
            .bind(event.at_micros)
            .bind(&event.at)
            .bind(&event.kind)
            .bind(&event.summary)
            .bind(event.detail.to_string())
            .execute(&mut *transaction)
            .await?;
            if let Some(session) = session_id {
                count(&mut transaction, *session, event).await?;
            }
        }
        transaction.commit().await?;
        Ok(())
    }

    /// Events of a session that come after the one of this number, oldest first, with their numbers.
    pub async fn session_events(
        &self,
        session: i64,
        after: i64,
        limit: u32,
    ) -> Result<Vec<(i64, Event)>, StoreError> {
        let rows: Vec<(i64, i64, String, String, String, String)> = sqlx::query_as(
            "SELECT id, at_micros, at, kind, summary, detail FROM events \
             WHERE session_id = ? AND id > ? ORDER BY id LIMIT ?",
        )
        .bind(session)
        .bind(after)
        .bind(limit)
        .fetch_all(&self.pool)
        .await?;
        rows.into_iter()
            .map(|(id, at_micros, at, kind, summary, detail)| {
                let detail = serde_json::from_str(&detail).map_err(unreadable("event"))?;
                Ok((id, Event { at_micros, at, kind, summary, detail }))
            })
            .collect()
    }

    /// The newest events, newest first, of one session or of all.
    pub async fn events(&self, limit: u32, session: Option<i64>) -> Result<Vec<Event>, StoreError> {
        let rows: Vec<(i64, String, String, String, String)> = sqlx::query_as(
            "SELECT at_micros, at, kind, summary, detail FROM events \
             WHERE ?2 IS NULL OR session_id = ?2 ORDER BY id DESC LIMIT ?1",
        )
        .bind(limit)
        .bind(session)
        .fetch_all(&self.pool)
        .await?;
        rows.into_iter()
            .map(|(at_micros, at, kind, summary, detail)| {
                let detail = serde_json::from_str(&detail).map_err(unreadable("event"))?;
                Ok(Event { at_micros, at, kind, summary, detail })
            })
            .collect()
    }
}

/// What an event changes of its session: how many reaches and stops it has, who is in it, which scene is in force.
async fn count(connection: &mut SqliteConnection, session: i64, event: &Event) -> Result<(), StoreError> {
    let detail = &event.detail;
    let statement = match event.kind.as_str() {
        "touch_began" if detail["served"] == true => {
            "UPDATE sessions SET reaches = reaches + 1, reaches_served = reaches_served + 1 WHERE id = ?"
        }
        "touch_began" => "UPDATE sessions SET reaches = reaches + 1 WHERE id = ?",
        "mode_changed" if detail["to"] == "protective_stop" || detail["to"] == "latched_stop" => {
            "UPDATE sessions SET stops = stops + 1 WHERE id = ?"
        }
        "person_entered" => {
            sqlx::query("INSERT OR IGNORE INTO session_persons (session_id, name) VALUES (?, ?)")
                .bind(session)
                .bind(detail["name"].as_str().unwrap_or("without a name"))
                .execute(connection)
                .await?;
            return Ok(());
        }
        "scene_activated" => {
            let (Some(scene), Some(version)) = (detail["scene"].as_i64(), detail["version"].as_i64()) else {
                return Ok(());
            };
            sqlx::query("INSERT OR REPLACE INTO session_scenes (session_id, from_micros, scene_id, scene_version) VALUES (?, ?, ?, ?)")
                .bind(session)
                .bind(event.at_micros)
                .bind(scene)
                .bind(version)
                .execute(connection)
                .await?;
            return Ok(());
        }
        _ => return Ok(()),
    };
    sqlx::query(statement).bind(session).execute(connection).await?;
    Ok(())
}
