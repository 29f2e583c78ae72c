//! covr-wire: the messages of clients and dashboards, scenes as serialised, frame conversion. Pure.

pub mod accepts;
pub mod answers;
pub mod calibration;
pub mod client;
pub mod clock;
pub mod commissioning;
pub mod complaint;
pub mod convention;
pub mod dashboard;
pub mod examples;
pub mod link;
pub mod phrase;
pub mod reason;
pub mod records;
mod sample;
pub mod scene;
