//! Cycles of transitions that could be taken without anything happening: a macrostep would not end.
//!
//! Nothing but variables changes during a macrostep, and every state entered in it is new. So a cycle can go on for ever only if
//! all its guards can hold together at the entry of its states. Bounds on variables that such transitions change are not counted on: a
//! loop that counts is refused too.

use super::Scenario;
use super::formula::{Conjunction, Quantity, Range};
use super::spec::{ScenarioProblem, Transition};

/// A problem for each transition that closes such a cycle.
pub(super) fn find(scenario: &Scenario) -> Vec<ScenarioProblem> {
    let mut search = Search {
        scenario,
        edges: edges(scenario),
        on_path: Vec::new(),
        left: MOST_LOOKED_AT,
        found: Vec::new(),
    };
    for start in 0..scenario.states.len() {
        search.from(start, start, &Conjunction::default());
    }
    search.found
}

/// A transition that may be taken at the entry of its state.
struct Edge {
    path: String,
    to: usize,
    ways: Vec<Conjunction>,
    changes: Vec<usize>,
}

struct Search<'a> {
    scenario: &'a Scenario,
    edges: Vec<Vec<Edge>>,
    on_path: Vec<(usize, usize)>,
    left: usize,
    found: Vec<ScenarioProblem>,
}

impl Search<'_> {
    /// Go on from `state`, by states after `start` alone, so that each cycle is found once.
    fn from(&mut self, start: usize, state: usize, so_far: &Conjunction) {
        for edge in 0..self.edges[state].len() {
            let to = self.edges[state][edge].to;
            if self.left == 0
                || to < start
                || self.on_path.iter().any(|(known, _)| *known == to && to != start)
            {
                continue;
            }
            for way in 0..self.edges[state][edge].ways.len() {
                self.left = self.left.saturating_sub(1);
                let Some(both) = so_far.and(&self.edges[state][edge].ways[way]) else { continue };
                self.on_path.push((state, edge));
                if to == start {
                    self.closes();
                } else {
                    self.from(start, to, &both);
                }
                self.on_path.pop();
                if !self.found.is_empty() && to == start {
                    break;
                }
            }
        }
    }

    fn closes(&mut self) {
        let names = self.on_path.iter().map(|(state, _)| format!("\"{}\"", self.scenario.states[*state].id));
        let first = self.on_path.first().map(|(state, _)| format!("\"{}\"", self.scenario.states[*state].id));
        let names: Vec<String> = names.chain(first).collect();
        let Some((state, edge)) = self.on_path.last() else { return };
        let path = self.edges[*state][*edge].path.clone();
        if !self.found.iter().any(|known| known.path == path) {
            let found = format!("a cycle that goes on without anything happening: {}", names.join(" to "));
            let expected = "an event or a time in the state that ends it".to_owned();
            self.found.push(ScenarioProblem { path, found, expected });
        }
    }
}

fn edges(scenario: &Scenario) -> Vec<Vec<Edge>> {
    let range = Range::at_entry(scenario);
    let edge = |path: String, way: &Transition<usize>| {
        let to = way.to.filter(|_| way.on.is_empty())?;
        // Too many ways to tell: it may be taken.
        let ways = range.ways(way.when.as_ref()).unwrap_or_else(|| vec![Conjunction::default()]);
        let entry = &scenario.states[to].entry;
        let changes: Vec<usize> = way.acts.iter().chain(entry).map(|act| act.variable()).collect();
        (!ways.is_empty()).then_some(Edge { path, to, ways, changes })
    };
    let mut edges: Vec<Vec<Edge>> = (0..scenario.states.len())
        .map(|state| {
            let ways = scenario.ways(state);
            let place = |anywhere: bool, index: usize| {
                if anywhere {
                    format!("anywhere[{index}]")
                } else {
                    format!("states[{state}].transitions[{index}]")
                }
            };
            ways.filter_map(|(anywhere, index, way)| edge(place(anywhere, index), way)).collect()
        })
        .collect();
    let changed: Vec<usize> = edges.iter().flatten().flat_map(|edge| edge.changes.iter().copied()).collect();
    for edge in edges.iter_mut().flatten() {
        let is_changed = |quantity| matches!(quantity, Quantity::Variable(index) if changed.contains(&index));
        edge.ways = edge.ways.drain(..).map(|way| way.without(is_changed)).collect();
    }
    edges
}

/// Transitions looked at. Beyond them a cycle may be left, which the running scenario cuts.
const MOST_LOOKED_AT: usize = 20_000;
