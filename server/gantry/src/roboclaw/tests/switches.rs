//! Each switch of the emulator while the column is moved: what the engine did, within which time and which way, on virtual time. The
//! table in `server/SAFETY.md` is made of this.
//!
//! `COVR_UPDATE_SAFETY=1 cargo nextest run -p covr-gantry the_committed_switches` rewrites it.

use super::*;
use crate::linked::bench::moved::{Switch, committed};

const SWITCHES: [Switch; 18] = [
    ("lose 0.002", false),
    ("flip 0.002", false),
    ("missing 0.02", false),
    ("gap 0.001 40", false),
    ("late 0.001 40", false),
    ("lose 1", true),
    ("missing 1", true),
    ("late 1 200", true),
    ("brown-out 100", true),
    ("press", true),
    ("stick pressed", true),
    ("slip x 1", true),
    ("jam x on", true),
    ("push x -400", true),
    ("runaway x positive", true),
    ("runaway x negative", true),
    ("supply 5", true),
    ("temperature 105", true),
];

#[test]
fn the_committed_switches_are_the_generated_ones() {
    committed("switches", &SWITCHES, || Bench::new(USUAL, Floor::new(0.4, 0.3)));
}
