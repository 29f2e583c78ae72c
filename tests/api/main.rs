//! A real server over real sockets: every route's main path and its errors, both protocols, both stop lanes.

mod clients;
mod dashboards;
mod guards;
mod machine;
mod person;
mod priors;
mod record;
mod scenes;
