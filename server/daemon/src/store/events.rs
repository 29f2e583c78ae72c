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

/// Which events; what is not given does not restrict.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct EventFilter {
    /// Of one session.
    pub session: Option<i64>,
    /// Stored before this row.
    pub before: Option<i64>,
    /// Of one of these kinds.
    pub kinds: Option<Vec<String>>,
    /// With this text in their summary; upper and lower case are the same for plain letters.
    pub search: Option<String>,
    /// About the person of this name.
    pub person: Option<String>,
}

/// Some events, newest first.
#[derive(Debug, Clone, PartialEq)]
pub struct EventPage {
    /// The events.
    pub events: Vec<Event>,
    /// `before` of the next page; none when these were the last.
    pub next: Option<i64>,
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

    /// The newest events that pass a filter, newest first; with more behind them, where the next page begins.
    pub async fn events(&self, limit: u32, filter: &EventFilter) -> Result<EventPage, StoreError> {
        let kinds = filter.kinds.as_ref().map(|kinds| serde_json::json!(kinds).to_string());
        let mut rows: Vec<Row> = sqlx::query_as(
            "SELECT id, at_micros, at, kind, summary, detail FROM events \
             WHERE (?2 IS NULL OR session_id = ?2) AND (?3 IS NULL OR id < ?3) \
             AND (?4 IS NULL OR kind IN (SELECT value FROM json_each(?4))) \
             AND (?5 IS NULL OR instr(lower(summary), lower(?5)) > 0) \
             AND (?6 IS NULL OR (json_extract(detail, '$.person') IS NOT NULL AND json_extract(detail, '$.name') = ?6)) \
             ORDER BY id DESC LIMIT ?1",
        )
        // One more than asked tells whether there is a next page.
        .bind(i64::from(limit) + 1)
        .bind(filter.session)
        .bind(filter.before)
        .bind(kinds)
        .bind(&filter.search)
        .bind(&filter.person)
        .fetch_all(&self.pool)
        .await?;
        let more = rows.len() > limit as usize;
        rows.truncate(limit as usize);
        let next = rows.last().filter(|_| more).map(|oldest| oldest.0);
        let read = |(_, at_micros, at, kind, summary, detail): Row| {
            let detail = serde_json::from_str(&detail).map_err(unreadable("event"))?;
            Ok(Event { at_micros, at, kind, summary, detail })
        };
        Ok(EventPage { events: rows.into_iter().map(read).collect::<Result<_, StoreError>>()?, next })
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

type Row = (i64, i64, String, String, String, String);
