//! A real server over real sockets: every route's main path and its errors, both protocols, both stop lanes.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the report")]

mod calibrations;
mod clients;
mod cockpit;
mod commissioning;
mod config;
mod contract;
mod dashboards;
mod game_master;
mod guards;
mod jog;
mod links;
mod login;
mod machine;
mod monitoring;
mod openapi;
mod person;
mod priors;
mod record;
mod roles;
mod scenario;
mod scenes;
mod schemathesis;
mod sessions;
mod visitor;
