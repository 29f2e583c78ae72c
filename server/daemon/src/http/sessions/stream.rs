//! Answers of any length in bounded memory: a task writes pieces into a short queue, the connection takes them out.
//! No database connection and no lock is held while a slow reader reads.

use std::future::Future;

use axum::body::{Body, Bytes};
use covr_wire::records::RecordedFrame;
use futures_util::stream;
use tokio::sync::mpsc;

use crate::recording::chunk;
use crate::store::Store;

/// A part of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stretch {
    /// First moment, server time.
    pub from_micros: i64,
    /// Last moment, server time.
    pub to_micros: i64,
    /// Frames nearer to each other than this are left out.
    pub every_micros: i64,
    /// The end of what there is of it.
    pub ends_micros: i64,
}

/// Where the pieces of an answer go.
pub struct Pieces(mpsc::Sender<anyhow::Result<Bytes>>);

/// The reader has gone.
#[derive(Debug, thiserror::Error)]
#[error("the reader has gone")]
pub struct ReaderGone;

impl Stretch {
    /// All of it.
    pub const ALL: Self =
        Self { from_micros: i64::MIN, to_micros: i64::MAX, every_micros: 0, ends_micros: i64::MAX };

    /// How many of so many frames are left at most.
    pub fn thinned(&self, frames: u64) -> u64 {
        if self.every_micros <= 0 {
            return frames;
        }
        // A thinned frame may come up to a period late, never early.
        let left = (self.ends_micros - self.from_micros) / self.every_micros + 1;
        frames.min(left.max(0).cast_unsigned())
    }
}

impl Pieces {
    /// Hand a piece over; waits while the reader has enough.
    pub async fn give(&self, piece: impl Into<Bytes>) -> Result<(), ReaderGone> {
        self.0.send(Ok(piece.into())).await.map_err(|_| ReaderGone)
    }
}

/// A body whose pieces `write` hands over. Should it fail midway the connection is cut, so that what arrived cannot pass for
/// the whole.
pub fn body<F>(write: impl FnOnce(Pieces) -> F) -> Body
where
    F: Future<Output = anyhow::Result<()>> + Send + 'static,
{
    let (pieces, pieces_out) = mpsc::channel(QUEUE);
    let failed = pieces.clone();
    let writing = write(Pieces(pieces));
    tokio::spawn(async move {
        if let Err(why) = writing.await
            && !why.is::<ReaderGone>()
        {
            tracing::error!(%why, "an answer was cut short");
            // Without a reader nobody needs to know.
            let _ = failed.send(Err(why)).await;
        }
    });
    Body::from_stream(stream::unfold(pieces_out, |mut pieces| async move {
        let piece = pieces.recv().await?;
        Some((piece, pieces))
    }))
}

/// The frames of a stretch, chunk by chunk, thinned.
pub struct Frames {
    store: Store,
    session: i64,
    stretch: Stretch,
    after: Option<i64>,
    next_micros: i64,
}

impl Frames {
    /// Of a session.
    pub fn new(store: Store, session: i64, stretch: Stretch) -> Self {
        Self { store, session, stretch, after: None, next_micros: stretch.from_micros }
    }

    /// The next frames, made into a piece off the asynchronous threads; none at the end.
    pub async fn next<T: Send + 'static>(
        &mut self,
        make: impl FnOnce(Vec<RecordedFrame>) -> anyhow::Result<T> + Send + 'static,
    ) -> anyhow::Result<Option<T>> {
        let Stretch { from_micros, to_micros, every_micros, .. } = self.stretch;
        let Some(chunk) = self.store.next_chunk(self.session, self.after, from_micros, to_micros).await?
        else {
            return Ok(None);
        };
        self.after = Some(chunk.first_micros);
        let mut next_micros = self.next_micros;
        let (made, next_micros) = tokio::task::spawn_blocking(move || {
            let mut frames = chunk::decode(&chunk.document)?;
            frames.retain(|frame| {
                let wanted = (next_micros..=to_micros).contains(&frame.at_micros);
                if wanted {
                    next_micros = frame.at_micros + every_micros;
                }
                wanted
            });
            Ok::<_, anyhow::Error>((make(frames)?, next_micros))
        })
        .await??;
        self.next_micros = next_micros;
        Ok(Some(made))
    }
}

const QUEUE: usize = 2;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_is_counted_from_the_stretch_that_there_is() {
        let stretch = Stretch {
            from_micros: 1_000_000,
            to_micros: i64::MAX,
            every_micros: 500_000,
            ends_micros: 3_000_000,
        };
        assert_eq!(stretch.thinned(60), 5);
        assert_eq!(stretch.thinned(3), 3);
        assert_eq!(Stretch::ALL.thinned(7), 7);
    }

    #[tokio::test]
    async fn a_failure_midway_cuts_the_body() {
        let body = body(|pieces| async move {
            pieces.give("half").await?;
            anyhow::bail!("the disk is gone")
        });
        assert!(axum::body::to_bytes(body, 1_000).await.is_err());
    }
}
