//! Which distractors are shown beside the goal.

use sha2::{Digest, Sha256};

use crate::trace::Recording;

/// How distractors are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Draw {
    /// By hash alone.
    Hash,
    /// Those of the goal's own wall first: the view at the start gives the wall away.
    SameWall,
}

impl Draw {
    /// Its name on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hash => "hash",
            Self::SameWall => "same-wall",
        }
    }

    /// The targets shown, as indices in the order of their ids: the goal and the first distractors by the hex SHA-256
    /// of `drawn_for/objects/target`; all targets where there are fewer. `drawn_for` is the trial, in a session the
    /// trial and the visit's number.
    pub fn targets(self, recording: &Recording, drawn_for: &str, goal: usize, objects: usize) -> Vec<usize> {
        let mut shown = self.distractors(recording, drawn_for, goal, objects);
        shown.truncate(objects.saturating_sub(1));
        shown.push(goal);
        shown.sort_by(|a, b| recording.targets[*a].id.cmp(&recording.targets[*b].id));
        shown
    }

    /// The distractor that a wrong prior names: the first drawn.
    pub fn first_distractor(
        self,
        recording: &Recording,
        drawn_for: &str,
        goal: usize,
        objects: usize,
    ) -> Option<usize> {
        self.distractors(recording, drawn_for, goal, objects).first().copied()
    }

    /// Every other target, in the order of the draw.
    fn distractors(self, recording: &Recording, drawn_for: &str, goal: usize, objects: usize) -> Vec<usize> {
        let targets = &recording.targets;
        let mut others: Vec<(bool, String, usize)> = (0..targets.len())
            .filter(|&index| index != goal)
            .map(|index| {
                let key = format!("{drawn_for}/{objects}/{}", targets[index].id);
                let elsewhere = self == Self::SameWall && targets[index].view_deg != targets[goal].view_deg;
                (elsewhere, hex(&Sha256::digest(key)), index)
            })
            .collect();
        others.sort();
        others.into_iter().map(|(_, _, index)| index).collect()
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Recordings;
    use std::io::Cursor;
    use std::path::Path;

    fn recording() -> Recording {
        let targets: Vec<String> = (0..6)
            .map(|i| format!(r#"{{"id":"T{i}","x":{i},"y":0,"z":1,"r":0.1,"view_deg":{}}}"#, (i % 2) * 90))
            .collect();
        let line = format!(
            r#"{{"dataset":"made","trial":"a/1","user":"u","goal":"T4","targets":[{}],"cols":["t_ms","x_mm","y_mm"],"frames":[[0,0,0]]}}"#,
            targets.join(",")
        );
        Recordings::from_lines(Path::new("made"), Box::new(Cursor::new(line))).next().unwrap().unwrap()
    }

    #[test]
    fn the_goal_is_always_shown_and_the_order_is_by_id() {
        let recording = recording();
        for objects in 1..=6 {
            let shown = Draw::Hash.targets(&recording, "a/1", 4, objects);
            assert!(shown.len() == objects && shown.contains(&4) && shown.is_sorted(), "{shown:?}");
        }
        assert_eq!(Draw::Hash.targets(&recording, "a/1", 4, 9).len(), 6);
    }

    #[test]
    fn the_draw_is_the_published_hash() {
        // printf 'a/1/2/T0' | sha256sum, and so on for the other four: T5 has the least.
        let recording = recording();
        let least =
            (0..6).filter(|i| *i != 4).min_by_key(|i| hex(&Sha256::digest(format!("a/1/2/T{i}")))).unwrap();
        assert_eq!(Draw::Hash.first_distractor(&recording, "a/1", 4, 2), Some(least));
        assert!(Draw::Hash.targets(&recording, "a/1", 4, 2).contains(&least));
    }

    #[test]
    fn the_same_wall_comes_first() {
        let shown = Draw::SameWall.targets(&recording(), "a/1", 4, 3);
        assert_eq!(shown, [0, 2, 4]);
    }
}
