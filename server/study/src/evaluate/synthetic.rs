//! Reaches of the made-up visitor, in the form of recordings: for machines without any. They are no evidence about
//! people.

use covr_engine::frames::Point;
use covr_engine::time::Time;

use crate::trace::{Arena, Frame, Heights, Moments, Recording, Target};
use crate::visitor::{Phase, Visitor};
use crate::workload::Load;

/// So many reaches: ten of each visitor, who has ten objects of their own.
pub(super) fn recordings(reaches: usize) -> impl Iterator<Item = Recording> {
    (1..).flat_map(of_visitor).take(reaches)
}

fn of_visitor(visitor: u64) -> Vec<Recording> {
    let scene = Load { seed: visitor, ..Load::USUAL }.scene();
    let targets: Vec<Target> = scene
        .objects
        .iter()
        .map(|object| {
            let [x, y, z] = [object.position.x(), object.position.y(), object.position.z()];
            let position = Point::new(x, y, z);
            Target {
                id: object.id.clone(),
                label: String::new(),
                position,
                radius_m: RADIUS_M,
                view_deg: None,
            }
        })
        .collect();
    let (min, max) = (scene.arena.min, scene.arena.max);
    let arena = Arena { x_m: [min.x, max.x], y_m: [min.y, max.y] };
    let mut recordings = Vec::new();
    let mut frames: Vec<Frame> = Vec::new();
    let mut was = Phase::Reads;
    let mut visits = Visitor::of_scene(&scene, HZ, visitor);
    while recordings.len() < REACHES_EACH {
        let sample = visits.sample();
        let first = frames.first().map_or(sample.at, |frame| frame.at);
        if was != Phase::Dwells && sample.phase == Phase::Dwells {
            let reach = Time::ZERO + (sample.at - first);
            let of_start = |frame: Frame| Frame { at: Time::ZERO + (frame.at - first), ..frame };
            recordings.push(Recording {
                dataset: "synthetic".into(),
                trial: format!("synthetic/{visitor}/{}", recordings.len() + 1),
                user: format!("synthetic {visitor}"),
                mode: Some("synthetic".into()),
                arena: Some(arena),
                targets: targets.clone(),
                goal: sample.goal,
                events: Moments { reach: Some(reach), ..Moments::default() },
                visits: Vec::new(),
                heights: Heights::AboveFloor,
                frames: std::mem::take(&mut frames).into_iter().map(of_start).collect(),
            });
        }
        was = sample.phase;
        let (head, view) = (sample.pose.position, sample.pose.view());
        frames.push(Frame {
            at: sample.at,
            x_m: head.x(),
            y_m: head.y(),
            z_m: Some(head.z()),
            yaw_rad: Some(view.y.atan2(view.x)),
            pitch_rad: Some(view.z.clamp(-1.0, 1.0).asin()),
            hands: sample.hands.both().map(|hand| hand.map(|hand| Point::from_vector(hand.vector()))),
        });
    }
    recordings
}

/// As the recorded people are.
const HZ: f64 = 30.0;
const REACHES_EACH: usize = 10;
const RADIUS_M: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_made_up_reach_ends_at_its_goal() {
        let all: Vec<Recording> = recordings(12).collect();
        assert_eq!(all.len(), 12);
        assert_eq!((all[9].user.as_str(), all[10].user.as_str()), ("synthetic 1", "synthetic 2"));
        for recording in &all {
            let goal = &recording.targets[recording.goal.unwrap()];
            let last = recording.frames.last().unwrap();
            let away = (goal.position.x() - last.x_m).hypot(goal.position.y() - last.y_m);
            assert!(away < 1.2, "{} ends {away} m from its goal", recording.trial);
            assert!(recording.frames.windows(2).all(|pair| pair[0].at < pair[1].at));
        }
    }
}
