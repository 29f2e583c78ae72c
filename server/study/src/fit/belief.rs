//! The log loss of a rule's belief before recorded reaches: poses, sights and rule, no machine. Fast enough to search with.

use std::sync::Arc;

use covr_engine::frames::{Planar, Pose, Room};
use covr_engine::intention::{Belief, IntentionParameters, RuleName, Sight, View, sights};
use covr_engine::observation::{Hands, PersonId, PoseSample};
use covr_engine::person::Person;
use covr_engine::safety::parameters::Parameters;
use covr_engine::time::{Span, Time};

use super::folds::{Loss, Objective, Tally};
use crate::evaluate::{Draw, EvaluationProblem, Objects};
use crate::parallel;
use crate::replay::{LOOKS_BEFORE_REACH_SECS, TrialProblem};
use crate::trace::Recording;

/// The mean negative logarithm of the goal's probability 0, 0.5, 1, 2 and 3 s before the reach.
#[derive(Debug)]
pub struct BeliefLoss {
    rule: RuleName,
    reaches: Vec<Arc<Watched>>,
    threads: usize,
}

/// A reach as the engine would see it.
#[derive(Debug)]
struct Watched {
    person: String,
    goal: usize,
    heads: Vec<(Time, Pose<Room>, Planar, Hands)>,
    /// Of all targets, head by head.
    sights: Vec<Sight>,
    targets: usize,
    /// Which targets are shown, each number of objects once.
    shown: Vec<Vec<usize>>,
    /// Which heads the belief is looked at; none before the beginning.
    looks: Vec<usize>,
}

impl BeliefLoss {
    /// Of the recordings with a goal and a reach, with each of these numbers of objects.
    pub fn new(
        recordings: &[Recording],
        rule: RuleName,
        objects: &[Objects],
        threads: usize,
    ) -> Result<Self, TrialProblem> {
        let mut reaches = Vec::new();
        for recording in recordings {
            if let (Some(goal), Some(reach)) = (recording.goal, recording.events.reach) {
                reaches.push(Arc::new(Watched::of(recording, goal, reach, objects)?));
            }
        }
        Ok(Self { rule, reaches, threads })
    }
}

impl Objective for BeliefLoss {
    fn name(&self) -> &'static str {
        "log-loss"
    }

    fn figure(&self) -> &'static str {
        "log loss of the goal"
    }

    fn losses(&self, parameters: &[IntentionParameters]) -> Result<Vec<Loss>, EvaluationProblem> {
        Ok(parameters.iter().map(|parameters| self.loss(parameters)).collect())
    }
}

impl BeliefLoss {
    fn loss(&self, parameters: &IntentionParameters) -> Loss {
        let tallies = parallel::each(self.reaches.len(), self.threads, |index| {
            self.reaches[index].tally(self.rule, parameters)
        });
        // Summed up in their order, whoever did them.
        let mut loss = Loss::new();
        for (reach, tally) in self.reaches.iter().zip(tallies) {
            let sum = loss.entry(reach.person.clone()).or_default();
            *sum = sum.with(tally);
        }
        loss
    }
}

impl Watched {
    fn of(
        recording: &Recording,
        goal: usize,
        reach: Time,
        objects: &[Objects],
    ) -> Result<Self, TrialProblem> {
        let trial = || recording.trial.clone();
        let all: Vec<usize> = (0..recording.targets.len()).collect();
        let scene =
            recording.scene(&all).map_err(|problems| TrialProblem::Scene { trial: trial(), problems })?;
        let first = recording.frames.first().ok_or_else(|| TrialProblem::NoFrames(trial()))?.at;
        let begins = recording.events.preview_end.map_or(first, |at| at - BEFORE_PREVIEW_END).max(first);
        let room_from_trace = recording.room_from_trace();
        let parameters = Parameters::new(1.6);
        let mut person = Person::new(PersonId(1), begins);
        let priors = vec![1.0; all.len()];
        let (mut heads, mut seen, mut now) = (Vec::new(), Vec::new(), Vec::new());
        for sample in recording.resampled_between(POSE_HZ, begins, reach) {
            let pose = room_from_trace.pose(&sample.pose);
            let hands = sample.hands_in(&room_from_trace);
            person.take_pose(
                PoseSample { taken_at: sample.at, pose, tracked: true, worn: true, hands },
                &scene,
                scene.enabled(),
                &parameters,
            );
            sights(&scene, &priors, scene.enabled(), &pose, &mut now);
            seen.extend_from_slice(&now);
            heads.push((sample.at, pose, person.velocity(), hands));
        }
        if heads.is_empty() {
            return Err(TrialProblem::NoFrames(trial()));
        }
        let last_by = |before_secs: &f64| {
            heads.iter().rposition(|(at, ..)| *at <= reach - Span::from_secs(*before_secs))
        };
        let looks = LOOKS_BEFORE_REACH_SECS.iter().filter_map(last_by).collect();
        let mut shown: Vec<Vec<usize>> = objects
            .iter()
            .map(|count| Draw::Hash.targets(recording, &recording.trial, goal, count.of(all.len())))
            .collect();
        shown.dedup();
        let (person, targets) = (recording.user.clone(), all.len());
        Ok(Self { person, goal, heads, sights: seen, targets, shown, looks })
    }

    fn tally(&self, rule: RuleName, parameters: &IntentionParameters) -> Tally {
        let mut tally = Tally::default();
        let (mut belief, mut view) = (Belief::default(), Vec::new());
        for shown in &self.shown {
            let mut rule = rule.rule(parameters);
            for (index, (taken_at, head, velocity, hands)) in self.heads.iter().enumerate() {
                let all = &self.sights[index * self.targets..][..self.targets];
                view.clear();
                view.extend(shown.iter().map(|target| all[*target]));
                let (taken_at, head, velocity, hands) = (*taken_at, *head, *velocity, *hands);
                rule.weigh(&View { taken_at, head, velocity, hands, sights: &view }, &mut belief);
                for _ in self.looks.iter().filter(|look| **look == index) {
                    tally.loss += self.loss_of(&belief, shown);
                    tally.cases += 1;
                }
            }
        }
        tally
    }

    fn loss_of(&self, belief: &Belief, shown: &[usize]) -> f64 {
        let weight = shown.iter().position(|target| *target == self.goal).map_or(0.0, |i| belief.weights[i]);
        let total = belief.total();
        let probability = if total > 0.0 { weight / total } else { 0.0 };
        -probability.max(LEAST_PROBABILITY).ln()
    }
}

/// The paper's head tracking, Hz.
const POSE_HZ: f64 = 75.0;
/// A replay begins this long before the scene is hidden.
const BEFORE_PREVIEW_END: Span = Span::from_millis(2_000);
/// A rule that gives the goal no chance at all loses this much, not everything.
const LEAST_PROBABILITY: f64 = 1e-3;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::{Start, fit};
    use crate::trace::Recordings;
    use std::io::Cursor;
    use std::path::Path;

    /// Somebody who walks along +x to B without looking there: distance tells, direction misleads.
    fn recordings() -> Vec<Recording> {
        let line = |user: &str, z: i32| {
            let frames: Vec<String> =
                (0..=90).map(|i| format!("[{},{},2000,{z},1571,0]", i * 1000 / 30, 1000 + i * 20)).collect();
            format!(
                r#"{{"dataset":"made","trial":"{user}","user":"{user}","arena":{{"x":[0,4],"y":[0,4]}},"goal":"B","targets":[{{"id":"A","x":1,"y":3.5,"z":1.6,"r":0.1}},{{"id":"B","x":3.4,"y":2,"z":1.6,"r":0.1}}],"events":{{"reach":3.0}},"cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],"frames":[{}]}}"#,
                frames.join(",")
            )
        };
        let text = ["u", "v", "w"].map(|user| line(user, 1600)).join("\n");
        Recordings::from_lines(Path::new("made"), Box::new(Cursor::new(text))).map(Result::unwrap).collect()
    }

    #[test]
    fn where_distance_tells_more_distance_is_given_its_weight() {
        let loss = BeliefLoss::new(&recordings(), RuleName::Paper, &[Objects::Count(2)], 1).unwrap();
        let fitted = fit(&loss, RuleName::Paper, 3, Start::Default, &|| ()).unwrap();
        assert!(fitted.parameters.paper.distance_share > 0.9, "{fitted:?}");
        assert!(fitted.in_sample < fitted.before);
        // Three people who are alike: what was left out is as good.
        assert!((fitted.left_out.unwrap() - fitted.in_sample).abs() < 1e-9);
    }

    #[test]
    fn the_loss_is_the_same_for_any_number_of_threads_and_nothing_of_one_object() {
        let of = |objects: &[usize], threads| {
            let objects: Vec<Objects> = objects.iter().copied().map(Objects::Count).collect();
            BeliefLoss::new(&recordings(), RuleName::PaperBest, &objects, threads)
                .unwrap()
                .loss(&IntentionParameters::default())
        };
        assert_eq!(of(&[1, 2], 1), of(&[1, 2], 3));
        // The goal alone is certain: five looks, the last of which is the first pose.
        assert_eq!(of(&[1], 1)["u"], Tally { loss: 0.0, cases: 5 });
    }
}
