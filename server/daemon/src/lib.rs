//! The covr daemon: sockets, HTTP, store, configuration, tasks. It carries; it decides nothing about motion.
//!
//! - [`control`]: the one thread that owns engine and gantry.
//! - [`recorder`], [`store`]: what outlives the process.
//! - [`http`], [`ws`]: the ways in and out.
//! - [`access`]: who may do what.
//! - [`serve`]: puts them together, and takes them apart with the machine at rest first.

pub mod access;
pub mod app;
pub mod calibrations;
pub mod cert_command;
pub mod checklist;
pub mod cli;
pub mod clients;
pub mod clock;
pub mod commission;
pub mod commissionings;
pub mod config;
pub mod control;
pub mod emulate;
pub mod evaluate;
pub mod explain;
pub mod fit;
pub mod hand;
pub mod http;
pub mod identify;
pub mod inputs;
pub mod listen;
pub mod live;
pub mod logs;
pub mod meters;
pub mod persons;
pub mod prove;
pub mod recorder;
pub mod recording;
pub mod serve;
pub mod stage;
pub mod store;
pub mod token_command;
pub mod visitor;
pub mod web;
pub mod ws;
