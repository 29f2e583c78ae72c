//! What breaks around the server, and what must happen then: `server/SAFETY.md` has the table. While each fault lasts the
//! machine's stop is pressed over HTTP, and must be acknowledged. Nothing is asserted of how long anything takes.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the report")]

mod crash;
mod crowd;
mod database;
mod headset;
mod starved;
