//! Each switch of the emulator while the column is moved: the table in `server/SAFETY.md` is made of this.
//!
//! `COVR_UPDATE_SAFETY=1 cargo nextest run -p covr-gantry the_committed_switches` rewrites it.

use super::*;
use crate::linked::bench::moved::{Switch, committed};

const SWITCHES: [Switch; 20] = [
    ("lose 0.00005", false),
    ("flip 0.00005", false),
    ("missing 0.0005", false),
    ("gap 0.0005 40", false),
    ("late 0.0005 40", false),
    ("lose 1", true),
    ("missing 1", true),
    ("late 1 200", true),
    ("brown-out 100", true),
    ("error x encoder", true),
    ("error x controller", true),
    ("error y estop", true),
    ("slip x 1", true),
    ("jam x on", true),
    ("push x -400", true),
    ("runaway x positive", true),
    ("runaway x negative", true),
    ("supply 7", true),
    ("temperature 130", true),
    ("firmware unknown", true),
];

#[test]
fn the_committed_switches_of_an_odrive_are_the_generated_ones() {
    committed("odrive switches", &SWITCHES, || Bench::new(Floor::new(0.4, 0.3)));
}
