//! covr-engine: every decision about motion, and nothing else.
//!
//! Pure: it reads no clock, file, socket or random source and starts no thread. `now` is always an
//! argument. The same inputs in the same order give the same outputs, bit for bit.
//!
//! Three verbs: [`Engine::observe`], [`Engine::request`], [`Engine::step`].

pub mod engine;
pub mod event;
pub mod frames;
pub mod intention;
pub mod interaction;
pub mod machine;
pub mod mode;
pub mod motion;
pub mod observation;
pub mod person;
pub mod placing;
pub mod reason;
pub mod safety;
pub mod scenario;
pub mod scene;
pub mod snapshot;
pub mod time;

pub use engine::outlook::{Outlook, Preview};
pub use engine::{Answer, Engine, EngineConfig, Outcome, Request};
