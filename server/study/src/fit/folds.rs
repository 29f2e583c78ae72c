//! Fitted to some people, judged on others.

use std::collections::BTreeMap;

use covr_engine::intention::{IntentionParameters, RuleName};

use super::parameters::{Parameter, of_rule};
use super::search::least;
use crate::evaluate::EvaluationProblem;

/// What one person lost, and over how many cases.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tally {
    /// Sum of the losses.
    pub loss: f64,
    /// Number of cases.
    pub cases: usize,
}

/// What every person lost, by name.
pub type Loss = BTreeMap<String, Tally>;

/// What is made least.
pub trait Objective {
    /// Its name in files and on the command line.
    fn name(&self) -> &'static str;

    /// What its mean loss is, in reports.
    fn figure(&self) -> &'static str;

    /// What everybody loses with each of these parameters. The people are always the same.
    fn losses(&self, parameters: &[IntentionParameters]) -> Result<Vec<Loss>, EvaluationProblem>;
}

/// One fold: fitted to all but the people left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Fold {
    /// Who was left out.
    pub left_out: Vec<String>,
    /// What was found on the others.
    pub parameters: IntentionParameters,
    /// Mean loss on those that it was fitted to.
    pub in_sample: f64,
    /// Mean loss on those left out.
    pub on_left_out: f64,
}

/// What a fit found.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Fitted to everybody: what is shipped.
    pub parameters: IntentionParameters,
    /// Mean loss with the parameters by default.
    pub before: f64,
    /// Mean loss with the fitted ones, on the same people.
    pub in_sample: f64,
    /// Mean loss of each case under the fold that left its person out; none without folds.
    pub left_out: Option<f64>,
    /// The folds.
    pub folds: Vec<Fold>,
}

/// Where a search begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// At the parameters by default. Those that ship may have been found on the same people.
    Default,
    /// In the middle of every range, which nobody found on anybody.
    Middle,
}

/// Fit a rule's parameters; `folds` groups of people are left out in turn, 0 for none. `told` hears of every
/// evaluation.
pub fn fit(
    objective: &dyn Objective,
    rule: RuleName,
    folds: usize,
    start: Start,
    told: &dyn Fn(),
) -> Result<Fit, EvaluationProblem> {
    let parameters: Vec<&Parameter> = of_rule(rule).collect();
    let mut known = Known { objective, parameters: &parameters, known: Vec::new(), told };
    let default: Vec<f64> = parameters.iter().map(|p| p.share_of(p.default())).collect();
    let people: Vec<String> = known.at(&default)?.keys().cloned().collect();
    let before = mean(known.at(&default)?, &|_| true);
    let start = match start {
        Start::Default => default,
        Start::Middle => vec![0.5; parameters.len()],
    };
    let everybody = known.fitted(&start, &|_| true)?;
    // Whoever is alone cannot be judged by what was fitted to others.
    let groups = Some(folds.min(people.len())).filter(|groups| *groups >= 2).unwrap_or(0);
    let mut parts = Vec::new();
    let mut outside = Tally::default();
    for group in 0..groups {
        let left_out: Vec<String> = people.iter().skip(group).step_by(groups).cloned().collect();
        let others = |person: &str| !left_out.iter().any(|one| one == person);
        let shares = known.fitted(&start, &others)?;
        let in_sample = mean(known.at(&shares)?, &others);
        let theirs = total(known.at(&shares)?, &|person| !others(person));
        outside = outside.with(theirs);
        let parameters = known.parameters_at(&shares);
        parts.push(Fold { left_out, parameters, in_sample, on_left_out: theirs.mean() });
    }
    Ok(Fit {
        parameters: known.parameters_at(&everybody),
        before,
        in_sample: mean(known.at(&everybody)?, &|_| true),
        left_out: (!parts.is_empty()).then(|| outside.mean()),
        folds: parts,
    })
}

impl Fit {
    /// Each person with the parameters of the fold that left them out; nobody without folds.
    pub fn left_out_by_person(&self) -> BTreeMap<String, IntentionParameters> {
        let of_fold = |fold: &Fold| {
            let parameters = fold.parameters.clone();
            fold.left_out.clone().into_iter().map(move |person| (person, parameters.clone()))
        };
        self.folds.iter().flat_map(of_fold).collect()
    }
}

/// Mean loss at evenly spaced values of one parameter, the others as they are.
pub fn sweep(
    objective: &dyn Objective,
    base: &IntentionParameters,
    parameter: &Parameter,
    values: usize,
) -> Result<Vec<(f64, Loss)>, EvaluationProblem> {
    let (values, parameters): (Vec<f64>, Vec<_>) = parameter.swept(base, values).into_iter().unzip();
    Ok(values.into_iter().zip(objective.losses(&parameters)?).collect())
}

impl Tally {
    /// Both together.
    pub fn with(self, other: Self) -> Self {
        Self { loss: self.loss + other.loss, cases: self.cases + other.cases }
    }

    /// Mean loss of a case; 0 without any.
    pub fn mean(self) -> f64 {
        if self.cases > 0 { self.loss / self.cases as f64 } else { 0.0 }
    }
}

/// What was evaluated already.
struct Known<'a> {
    objective: &'a dyn Objective,
    parameters: &'a [&'static Parameter],
    known: Vec<(Vec<f64>, Loss)>,
    told: &'a dyn Fn(),
}

impl Known<'_> {
    fn at(&mut self, shares: &[f64]) -> Result<&Loss, EvaluationProblem> {
        let known = self.known.iter().position(|(known, _)| known == shares);
        let place = match known {
            Some(place) => place,
            None => {
                let losses = self.objective.losses(&[self.parameters_at(shares)])?;
                (self.told)();
                self.known.extend(losses.into_iter().map(|loss| (shares.to_vec(), loss)));
                self.known.len() - 1
            }
        };
        Ok(&self.known[place].1)
    }

    fn parameters_at(&self, shares: &[f64]) -> IntentionParameters {
        let mut parameters = IntentionParameters::default();
        for (parameter, share) in self.parameters.iter().zip(shares) {
            // A share that is the default's gives the default to the last bit.
            let is_default = parameter.share_of(parameter.default()) == *share;
            let value = if is_default { parameter.default() } else { parameter.at_share(*share) };
            parameter.set(&mut parameters, value);
        }
        parameters
    }

    /// The least loss of these people. What none of their cases depends on keeps its default: nobody found another number.
    fn fitted(&mut self, start: &[f64], among: &dyn Fn(&str) -> bool) -> Result<Vec<f64>, EvaluationProblem> {
        let mut found = least(start, |shares| Ok::<_, EvaluationProblem>(mean(self.at(shares)?, among)))?;
        for (place, parameter) in self.parameters.iter().enumerate() {
            let share = parameter.share_of(parameter.default());
            if found.shares[place] != share {
                let searched = std::mem::replace(&mut found.shares[place], share);
                if mean(self.at(&found.shares)?, among) != found.loss {
                    found.shares[place] = searched;
                }
            }
        }
        Ok(found.shares)
    }
}

fn total(loss: &Loss, among: &dyn Fn(&str) -> bool) -> Tally {
    loss.iter().filter(|(person, _)| among(person)).fold(Tally::default(), |sum, (_, tally)| sum.with(*tally))
}

fn mean(loss: &Loss, among: &dyn Fn(&str) -> bool) -> f64 {
    total(loss, among).mean()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// Each person would like another w.
    struct Wishes([(&'static str, f64); 4]);

    impl Objective for Wishes {
        fn name(&self) -> &'static str {
            "wishes"
        }

        fn figure(&self) -> &'static str {
            "distance to the wish"
        }

        fn losses(&self, parameters: &[IntentionParameters]) -> Result<Vec<Loss>, EvaluationProblem> {
            Ok(parameters.iter().map(|parameters| self.loss(parameters)).collect())
        }
    }

    impl Wishes {
        fn loss(&self, parameters: &IntentionParameters) -> Loss {
            let of = |(person, wish): &(&str, f64)| {
                let loss = (parameters.paper.distance_share - wish).powi(2);
                ((*person).to_owned(), Tally { loss, cases: 1 })
            };
            self.0.iter().map(of).collect()
        }
    }

    const FOUR: Wishes = Wishes([("a", 0.2), ("b", 0.4), ("c", 0.6), ("d", 0.8)]);

    #[test]
    fn people_left_out_are_judged_by_what_the_others_wished() {
        let fit = fit(&FOUR, RuleName::Paper, 4, Start::Default, &|| ()).unwrap();
        assert!((fit.parameters.paper.distance_share - 0.5).abs() < 0.02, "{fit:?}");
        assert!(fit.in_sample < fit.before && fit.left_out.unwrap() > fit.in_sample);
        let of_d = fit.folds.iter().find(|fold| fold.left_out == ["d"]).unwrap();
        // The others' mean is 0.4: 0.4 away from 0.8.
        assert!((of_d.parameters.paper.distance_share - 0.4).abs() < 0.02);
        assert!((of_d.on_left_out - 0.16).abs() < 0.02);
        let mut left_out: Vec<_> = fit.folds.iter().flat_map(|fold| fold.left_out.clone()).collect();
        left_out.sort();
        assert_eq!(left_out, ["a", "b", "c", "d"]);
    }

    #[test]
    fn everybody_left_out_has_the_parameters_of_the_fold_without_them() {
        let fit = fit(&FOUR, RuleName::Paper, 2, Start::Default, &|| ()).unwrap();
        let by_person = fit.left_out_by_person();
        assert_eq!(by_person.keys().collect::<Vec<_>>(), ["a", "b", "c", "d"]);
        for fold in &fit.folds {
            assert!(fold.left_out.iter().all(|person| by_person[person] == fold.parameters));
        }
        // Without a and c (0.2 and 0.6) it is 0.6, the mean of the others.
        assert!((by_person["a"].paper.distance_share - 0.6).abs() < 0.02, "{by_person:?}");
    }

    #[test]
    fn a_search_from_the_middle_finds_the_same_and_is_held_against_the_default() {
        let from = |start| fit(&FOUR, RuleName::Paper, 0, start, &|| ()).unwrap();
        let (middle, default) = (from(Start::Middle), from(Start::Default));
        assert!((middle.parameters.paper.distance_share - 0.5).abs() < 0.02);
        assert_eq!(middle.before, default.before);
        // What does not matter is not left in the middle.
        assert_eq!(middle.parameters.paper.threshold, IntentionParameters::default().paper.threshold);
    }

    #[test]
    fn nothing_is_evaluated_twice_and_parameters_that_do_not_matter_stay() {
        let count = Cell::new(0);
        let fit = fit(&FOUR, RuleName::Paper, 0, Start::Default, &|| count.set(count.get() + 1)).unwrap();
        assert!(count.get() < 60, "{}", count.get());
        assert_eq!((fit.left_out, fit.folds.len()), (None, 0));
        assert_eq!(fit.parameters.paper.threshold, IntentionParameters::default().paper.threshold);
    }

    #[test]
    fn a_sweep_goes_from_end_to_end() {
        let w = Parameter::named("paper.distance_share").unwrap();
        let swept = sweep(&FOUR, &IntentionParameters::default(), w, 13).unwrap();
        assert_eq!((swept.len(), swept[0].0, swept[12].0), (13, 0.0, 1.0));
        let best =
            swept.iter().min_by(|a, b| mean(&a.1, &|_| true).total_cmp(&mean(&b.1, &|_| true))).unwrap();
        assert_eq!(best.0, 0.5);
    }
}
