//! What is worth a second look in a scenario that can be played: states that nothing leads to, ways that are never or always
//! taken, priors that do not add up.

use super::Scenario;
use super::formula::Range;
use super::spec::{Condition, Prior, Transition, Trigger};

/// Something worth a second look.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// Where, from the scenario on.
    pub path: String,
    /// What is found, in plain words.
    pub words: String,
}

/// What a scenario is checked against.
#[derive(Debug, Clone, Copy)]
pub struct Stage<'a> {
    /// Ids of the objects.
    pub objects: &'a [&'a str],
    /// Ids of the zones.
    pub zones: &'a [&'a str],
    /// The scene's own priors.
    pub priors: &'a [f64],
    /// Which objects the scene itself has not switched off.
    pub enabled: &'a [bool],
}

impl Scenario {
    /// Everything worth a second look, in the scenario's order.
    pub fn findings(&self, stage: Stage<'_>) -> Vec<Finding> {
        let mut findings = Findings { scenario: self, stage, found: Vec::new() };
        let reached = self.reached();
        for (index, reached) in reached.iter().enumerate() {
            findings.state(index, *reached);
        }
        findings.anywhere();
        findings.variables();
        findings.never_used();
        findings.found
    }

    /// Which states something leads to, skips of the game master apart.
    fn reached(&self) -> Vec<bool> {
        let mut reached = vec![false; self.states.len()];
        let mut open = vec![self.initial];
        while let Some(state) = open.pop() {
            if std::mem::replace(&mut reached[state], true) {
                continue;
            }
            open.extend(self.ways_taken(state).filter_map(|way| way.to));
        }
        reached
    }

    /// The ways from a state that can be taken at all.
    fn ways_taken(&self, state: usize) -> impl Iterator<Item = &Transition<usize>> {
        let ways: Vec<_> = self.ways(state).map(|(_, _, way)| way).collect();
        let taken: Vec<_> =
            (0..ways.len()).filter(|i| self.never_taken(&ways, *i).is_none()).map(|i| ways[i]).collect();
        taken.into_iter()
    }

    /// Why one of the ways from a state is never taken.
    fn never_taken(&self, ways: &[&Transition<usize>], index: usize) -> Option<String> {
        let range = Range::at_any_time(self);
        let way = ways[index];
        if range.never(way.when.as_ref()) {
            return Some("its condition can never hold".into());
        }
        let at_once =
            |way: &Transition<usize>| way.on.is_empty() && Range::at_entry(self).always(way.when.as_ref());
        let first_at_once = ways.iter().position(|way| at_once(way));
        if first_at_once.is_some_and(|first| first != index && (first < index || !way.on.is_empty())) {
            return Some("the state is left at once by another way".into());
        }
        let covers = |other: &&Transition<usize>| {
            !way.on.is_empty()
                && way.on.iter().all(|trigger| other.on.contains(trigger))
                && range.always(other.when.as_ref())
        };
        let covered = ways[..index].iter().any(covers);
        covered.then(|| "a way before it is always taken for the same event".into())
    }
}

struct Findings<'a> {
    scenario: &'a Scenario,
    stage: Stage<'a>,
    found: Vec<Finding>,
}

impl Findings<'_> {
    fn state(&mut self, index: usize, is_reached: bool) {
        let state = &self.scenario.states[index];
        let at = format!("states[{index}]");
        if !is_reached {
            self.add(
                &at,
                format!("nothing leads to the state \"{}\"; the game master alone can skip to it", state.id),
            );
        }
        let goes_on = self.scenario.ways_taken(index).any(|way| way.to.is_some_and(|to| to != index));
        if !state.is_final && !goes_on {
            self.add(
                &at,
                format!("nothing leads on from the state \"{}\", and it is not marked as final", state.id),
            );
        }
        let ways: Vec<_> = self.scenario.ways(index).collect();
        let plain: Vec<_> = ways.iter().map(|(_, _, way)| *way).collect();
        for (i, (_, number, way)) in ways.iter().enumerate().filter(|(_, (anywhere, ..))| !anywhere) {
            let path = format!("{at}.transitions[{number}]");
            self.way(&path, way, Some(index));
            if let Some(why) = self.scenario.never_taken(&plain, i) {
                self.add(&path, format!("never taken: {why}"));
            } else if way.on.is_empty() && Range::at_entry(self.scenario).always(way.when.as_ref()) {
                let words = format!("always taken at once: the state \"{}\" does not last", state.id);
                self.add(&path, words);
            }
        }
        for (object, id) in self.stage.objects.iter().enumerate() {
            if state.enabled[object] && !self.stage.enabled[object] {
                self.add(
                    &format!("{at}.enabled"),
                    format!("the scene has \"{id}\" switched off: it is not served here either"),
                );
            }
        }
        self.priors(&at, index);
    }

    fn anywhere(&mut self) {
        for (index, way) in self.scenario.anywhere.iter().enumerate() {
            let path = format!("anywhere[{index}]");
            self.way(&path, way, None);
            if Range::at_any_time(self.scenario).never(way.when.as_ref()) {
                self.add(&path, "never taken: its condition can never hold".into());
            } else if way.on.is_empty() && Range::at_entry(self.scenario).always(way.when.as_ref()) {
                self.add(&path, "always taken at once: no other state lasts".into());
            }
        }
    }

    /// What a way waits for must be able to happen in its state; none: in any state.
    fn way(&mut self, at: &str, way: &Transition<usize>, state: Option<usize>) {
        let can_be_served = |object: usize| match state {
            Some(state) => self.scenario.states[state].enabled[object],
            None => self.scenario.states.iter().any(|state| state.enabled[object]),
        };
        let mut found = Vec::new();
        for (i, trigger) in way.on.iter().enumerate() {
            if let Trigger::TouchBegan(object) = trigger
                && !can_be_served(*object)
            {
                found.push((format!("{at}.on[{i}]"), "waits for a touch of", *object));
            }
        }
        if let Some(when) = &way.when {
            awaited(when, &mut |part| match part {
                Condition::Touching { object, .. } if !can_be_served(*object) => {
                    found.push((format!("{at}.when"), "waits for a touch of", *object));
                }
                Condition::InPlace(object) if !can_be_served(*object) => {
                    found.push((format!("{at}.when"), "waits for the column at", *object));
                }
                _ => {}
            });
        }
        let place = if state.is_some() { "here" } else { "in any state" };
        for (path, waits, object) in found {
            let object = self.stage.objects[object];
            self.add(&path, format!("{waits} \"{object}\", which is not enabled {place}"));
        }
    }

    fn priors(&mut self, at: &str, index: usize) {
        let state = &self.scenario.states[index];
        let enabled = || (0..state.enabled.len()).filter(|object| state.enabled[*object]);
        let of = |object: usize| state.priors[object].unwrap_or(Prior::constant(self.stage.priors[object]));
        if enabled().next().is_some() && enabled().all(|object| stays_zero(&of(object))) {
            self.add(&format!("{at}.priors"), "every prior is 0: nothing is served here".into());
            return;
        }
        let all_said = enabled().count() > 1 && enabled().all(|object| state.priors[object].is_some());
        let sum: f64 = enabled().map(|object| of(object).value).sum();
        if all_said && (sum - 1.0).abs() > ADDS_UP_WITHIN {
            let words = format!("the priors add up to {sum:.2} and not to 1: only their ratios count");
            self.add(&format!("{at}.priors"), words);
        }
    }

    fn variables(&mut self) {
        for (index, variable) in self.scenario.variables.iter().enumerate() {
            if !self.scenario.sets(index) {
                self.add(&format!("variables[{index}]"), format!("nothing ever changes \"{}\"", variable.id));
            }
        }
    }

    fn never_used(&mut self) {
        let mut used = vec![false; self.stage.zones.len()];
        let ways =
            self.scenario.states.iter().flat_map(|state| &state.transitions).chain(&self.scenario.anywhere);
        for way in ways {
            for trigger in &way.on {
                if let Trigger::ZoneEntered(zone) | Trigger::ZoneLeft(zone) = trigger {
                    used[*zone] = true;
                }
            }
            way.when.iter().for_each(|when| {
                when.visit(&mut |part| {
                    if let Condition::InZone(zone) = part {
                        used[*zone] = true;
                    }
                });
            });
        }
        for (object, id) in self.stage.objects.iter().enumerate() {
            if !self.scenario.states.iter().any(|state| state.enabled[object]) {
                self.add("states", format!("no state enables the object \"{id}\""));
            }
        }
        for (id, _) in self.stage.zones.iter().zip(&used).filter(|(_, used)| !**used) {
            self.add("states", format!("nothing waits for the zone \"{id}\""));
        }
    }

    fn add(&mut self, path: &str, words: String) {
        self.found.push(Finding { path: path.to_owned(), words });
    }
}

/// What a condition waits for: what it wants not to be so is left out.
fn awaited(condition: &Condition<usize>, seen: &mut impl FnMut(&Condition<usize>)) {
    match condition {
        Condition::All(parts) | Condition::Any(parts) => parts.iter().for_each(|part| awaited(part, seen)),
        Condition::Not(_) => {}
        atom => seen(atom),
    }
}

fn stays_zero(prior: &Prior) -> bool {
    prior.most == 0.0 || prior.value == 0.0 && prior.per_s <= 0.0 && prior.per_touch <= 0.0
}

/// A sum of priors this near to 1 adds up.
const ADDS_UP_WITHIN: f64 = 0.005;
