//! covr-wire: the messages of clients and dashboards, scenes as serialised, frame conversion. Pure.

pub mod client;
mod complaint;
pub mod dashboard;
pub mod scene;
