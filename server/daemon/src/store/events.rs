//! Events: what happened, in order.

use covr_wire::dashboard::Event;

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
    /// Store events, all or none.
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
        }
        transaction.commit().await?;
        Ok(())
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
