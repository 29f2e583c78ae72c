//! A whole recorded session against engine and machine, walks home included, without a reset between reaches.

use std::sync::Arc;

use covr_engine::engine::Request;
use covr_engine::frames::Floor;
use covr_engine::scene::Scene;
use covr_engine::time::Time;
use covr_gantry::contract::Simulated;

use super::LinkProfile;
use super::belief::BeliefWatch;
use super::foretold::ForetoldWatch;
use super::trial::{Conduct, Playback, TrialOutcome, TrialProblem, scene_of};
use super::walk::Walk;
use super::watch::ReachWatch;

/// A session and what it is replayed with.
#[derive(Debug, Clone, Copy)]
pub struct SessionReplay<'a> {
    /// The person, from the beginning to the last reach.
    pub walk: &'a Walk<'a>,
    /// The reaches, in order of time.
    pub visits: &'a [VisitPlan],
    /// How the engine decides.
    pub conduct: Conduct<'a>,
    /// How poses travel.
    pub link: LinkProfile,
    /// Decides what the link does.
    pub seed: u64,
}

/// One reach of a session: what is shown for it, and from when.
#[derive(Debug, Clone, PartialEq)]
pub struct VisitPlan {
    /// From when its objects are shown and it is watched, by the recording's clock.
    pub shown_from: Time,
    /// The hand arrives.
    pub reach: Time,
    /// The goal, as an index into the recording's targets.
    pub goal: usize,
    /// The targets shown; the goal is among them.
    pub targets: Vec<usize>,
    /// Their priors.
    pub priors: Vec<f64>,
}

impl SessionReplay<'_> {
    /// Replay it with a machine that is homed and stands where the session begins: an outcome for each visit, in order.
    /// Where the recording has a gap poses stop, and the engine does what lost tracking does.
    pub fn run(&self, machine: Box<dyn Simulated>) -> Result<Vec<TrialOutcome>, TrialProblem> {
        let recording = self.walk.recording();
        let trial = || recording.trial.clone();
        let scene = |visit: &VisitPlan| {
            scene_of(recording, &visit.targets, Some(&visit.priors))
                .map_err(|problems| TrialProblem::Scene { trial: trial(), problems })
        };
        let first = self.visits.first().ok_or_else(|| TrialProblem::NoReach(trial()))?;
        let mut playback =
            Playback::new(self.walk, scene(first)?, &self.conduct, machine, self.link, self.seed)
                .map_err(|mode| TrialProblem::NotArmed { trial: trial(), mode })?;
        let mut outcomes = Vec::with_capacity(self.visits.len());
        for (number, visit) in self.visits.iter().enumerate() {
            while playback.at() < visit.shown_from {
                playback.step();
            }
            let scene: Scene = scene(visit)?;
            let shown = visit.targets.iter().position(|&index| index == visit.goal);
            let goal = shown.ok_or_else(|| TrialProblem::GoalNotShown(trial()))?;
            let place = scene.objects()[goal].column_place();
            if number > 0 {
                playback.control.request(Request::ActivateScene(Arc::new(scene)));
            }
            let mut watch = self.watch(visit, goal, place);
            while playback.at() <= visit.reach.min(self.walk.ends()) {
                let (at, stepped) = playback.step();
                watch.see(at, &stepped, playback.control.engine());
            }
            playback.control.drain_events().for_each(|event| watch.hear(&event));
            let [true_verdict, commanded_verdict] = playback.control.take_verdicts();
            outcomes.push(watch.outcome(true_verdict, commanded_verdict));
        }
        Ok(outcomes)
    }

    fn watch(&self, visit: &VisitPlan, goal: usize, place: Floor) -> ReachWatch {
        let targets = &self.walk.recording().targets;
        let wall = targets[visit.goal].view_deg;
        let on_wall = |&index: &usize| targets[index].view_deg == wall;
        let same_wall = wall.map(|_| visit.targets.iter().map(on_wall).collect());
        let belief = BeliefWatch::new(goal, same_wall, visit.reach);
        let foretold = ForetoldWatch::new(goal, visit.reach, self.walk.period());
        ReachWatch::new(place, belief, foretold, self.walk.period())
    }
}
