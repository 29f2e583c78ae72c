//! The share of reaches that the column is not in place for: engine, machine and checker, the whole loop.

use covr_engine::intention::IntentionParameters;

use super::folds::{Loss, Objective, Tally};
use crate::evaluate::{EvaluationProblem, Plan, Progress, Subjects, failures};

/// The share of failed reaches of a plan, over everything that it combines.
pub struct FailureLoss<'a> {
    subjects: &'a Subjects,
    plan: &'a Plan,
    progress: Progress<'a>,
}

impl<'a> FailureLoss<'a> {
    /// Of these people by this plan; its own parameters are not used. `progress` hears of each reach of each evaluation.
    pub fn new(subjects: &'a Subjects, plan: &'a Plan, progress: Progress<'a>) -> Self {
        Self { subjects, plan, progress }
    }
}

impl Objective for FailureLoss<'_> {
    fn name(&self) -> &'static str {
        "success"
    }

    fn figure(&self) -> &'static str {
        "share of reaches not served"
    }

    fn losses(&self, parameters: &[IntentionParameters]) -> Result<Vec<Loss>, EvaluationProblem> {
        let by_person = failures(self.subjects, self.plan, parameters, self.progress)?;
        let tally = |[failed, trials]: [usize; 2]| Tally { loss: failed as f64, cases: trials };
        let loss = |people: std::collections::BTreeMap<String, [usize; 2]>| {
            people.into_iter().map(|(person, counts)| (person, tally(counts))).collect()
        };
        Ok(by_person.into_iter().map(loss).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::{MachineKind, Objects, RuleChoice, evaluate};
    use covr_engine::intention::RuleName;
    use covr_engine::motion::MotionName;

    #[test]
    fn the_loss_is_what_an_evaluation_with_these_parameters_counts() {
        let subjects = Subjects::synthetic(20);
        let plan = Plan {
            rules: vec![RuleChoice::Rule(RuleName::Paper)],
            motions: vec![MotionName::Proxy],
            objects: vec![Objects::Count(4)],
            machine: MachineKind::Ideal,
            ..Plan::new(RuleName::Paper, MotionName::Proxy)
        };
        let mut far = IntentionParameters::default();
        far.paper.distance_share = 1.0;
        let both = [IntentionParameters::default(), far];
        let losses = FailureLoss::new(&subjects, &plan, &|_, _| ()).losses(&both).unwrap();
        for (intention, loss) in both.into_iter().zip(losses) {
            let row =
                evaluate(&subjects, &Plan { intention, ..plan.clone() }, &|_, _| ()).unwrap().rows.remove(0);
            assert_eq!(loss.keys().collect::<Vec<_>>(), ["synthetic 1", "synthetic 2"]);
            let total = loss.values().fold(Tally::default(), |sum, one| sum.with(*one));
            assert_eq!(total, Tally { loss: (row.trials - row.successes) as f64, cases: 20 });
        }
    }
}
