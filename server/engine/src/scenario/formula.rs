//! What can be said of conditions without playing: whether one can hold at all, always holds, or holds together with others.
//!
//! Every atom is a quantity against a bound: how long somebody touches, whether somebody is inside (0 or 1), a variable. A
//! condition becomes a disjunction of boxes (an interval for each quantity); it can hold when one box is not empty.

use super::Scenario;
use super::spec::{Act, Comparison, Condition, Value};

/// A quantity that conditions bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// For how long an object is touched in the state, s; -1 when it is not.
    Touch(usize),
    /// For how long it is looked at, s; -1 when it is not.
    Look(usize),
    /// Whether somebody is in a zone.
    Zone(usize),
    /// Whether the column stands for an object.
    Place(usize),
    /// For how long a state lasts, s.
    InState,
    /// A variable.
    Variable(usize),
}

/// From the first on, below the second; whole numbers where the quantity is one.
type Interval = (f64, f64);

/// What must hold together: an interval for each quantity that is bound.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Conjunction(Vec<(Quantity, Interval)>);

impl Conjunction {
    /// Bound a quantity further; false when nothing is left.
    pub fn bound(&mut self, quantity: Quantity, within: Interval) -> bool {
        let known = match self.0.iter_mut().find(|(known, _)| *known == quantity) {
            Some((_, known)) => known,
            None => {
                self.0.push((quantity, (f64::NEG_INFINITY, f64::INFINITY)));
                let last = self.0.len() - 1;
                &mut self.0[last].1
            }
        };
        *known = (known.0.max(within.0), known.1.min(within.1));
        known.0 < known.1
    }

    /// Both together; none when that cannot be.
    pub fn and(&self, other: &Self) -> Option<Self> {
        let mut both = self.clone();
        other.0.iter().all(|(quantity, within)| both.bound(*quantity, *within)).then_some(both)
    }

    /// Without the bounds on these.
    pub fn without(mut self, forgotten: impl Fn(Quantity) -> bool) -> Self {
        self.0.retain(|(quantity, _)| !forgotten(*quantity));
        self
    }
}

/// What is known beforehand: the range of each quantity.
#[derive(Debug, Clone, Copy)]
pub struct Range<'a> {
    scenario: &'a Scenario,
    /// The state has lasted for less, s; and so has what lasts in it.
    under_secs: f64,
}

impl<'a> Range<'a> {
    /// Of a state that may have lasted.
    pub const fn at_any_time(scenario: &'a Scenario) -> Self {
        Self { scenario, under_secs: f64::INFINITY }
    }

    /// Of a state that has just been entered.
    pub const fn at_entry(scenario: &'a Scenario) -> Self {
        Self { scenario, under_secs: f64::MIN_POSITIVE }
    }

    fn of(&self, quantity: Quantity) -> Interval {
        match quantity {
            Quantity::Touch(_) | Quantity::Look(_) => (-1.0, self.under_secs),
            Quantity::Zone(_) | Quantity::Place(_) => (0.0, 2.0),
            Quantity::InState => (0.0, self.under_secs),
            Quantity::Variable(index) => {
                let start = self.scenario.variables[index].start;
                if !self.scenario.sets(index) {
                    (start.number() as f64, start.number() as f64 + 1.0)
                } else if matches!(start, Value::Boolean(_)) {
                    (0.0, 2.0)
                } else {
                    (f64::NEG_INFINITY, f64::INFINITY)
                }
            }
        }
    }

    /// Every way in which the condition can hold; none when there are too many to say. Without a condition: the one without bounds.
    pub fn ways(&self, when: Option<&Condition<usize>>) -> Option<Vec<Conjunction>> {
        match when {
            None => Some(vec![Conjunction::default()]),
            Some(when) => self.expand(when, true),
        }
    }

    /// It can never hold.
    pub fn never(&self, when: Option<&Condition<usize>>) -> bool {
        self.ways(when).is_some_and(|ways| ways.is_empty())
    }

    /// It always holds.
    pub fn always(&self, when: Option<&Condition<usize>>) -> bool {
        when.is_none_or(|when| self.expand(when, false).is_some_and(|ways| ways.is_empty()))
    }

    fn expand(&self, condition: &Condition<usize>, holds: bool) -> Option<Vec<Conjunction>> {
        match (condition, holds) {
            (Condition::All(parts), true) | (Condition::Any(parts), false) => {
                let mut ways = vec![Conjunction::default()];
                for part in parts {
                    let more = self.expand(part, holds)?;
                    ways = ways.iter().flat_map(|way| more.iter().filter_map(|with| way.and(with))).collect();
                    if ways.len() > MOST_WAYS {
                        return None;
                    }
                }
                Some(ways)
            }
            (Condition::Any(parts), true) | (Condition::All(parts), false) => {
                let mut ways = Vec::new();
                for part in parts {
                    ways.extend(self.expand(part, holds)?);
                    if ways.len() > MOST_WAYS {
                        return None;
                    }
                }
                Some(ways)
            }
            (Condition::Not(part), _) => self.expand(part, !holds),
            (atom, _) => {
                let ways = bounds(atom, holds).into_iter().filter_map(|(quantity, within)| {
                    let mut way = Conjunction::default();
                    (way.bound(quantity, self.of(quantity)) && way.bound(quantity, within)).then_some(way)
                });
                Some(ways.collect())
            }
        }
    }
}

/// An atom as bounds, any of which will do.
fn bounds(atom: &Condition<usize>, holds: bool) -> Vec<(Quantity, Interval)> {
    let from = |least: f64| if holds { (least, f64::INFINITY) } else { (f64::NEG_INFINITY, least) };
    match atom {
        Condition::Touching { object, secs } => vec![(Quantity::Touch(*object), from(*secs))],
        Condition::LooksAt { object, secs } => vec![(Quantity::Look(*object), from(*secs))],
        Condition::InZone(zone) => vec![(Quantity::Zone(*zone), from(1.0))],
        Condition::InPlace(object) => vec![(Quantity::Place(*object), from(1.0))],
        Condition::TimeInState(secs) => vec![(Quantity::InState, from(*secs))],
        Condition::Variable { variable, is, value } => {
            let (quantity, value) = (Quantity::Variable(*variable), value.number() as f64);
            let (below, after) = ((f64::NEG_INFINITY, value), (value + 1.0, f64::INFINITY));
            let intervals = match if holds { *is } else { is.opposite() } {
                Comparison::Equal => vec![(value, value + 1.0)],
                Comparison::NotEqual => vec![below, after],
                Comparison::Less => vec![below],
                Comparison::AtMost => vec![(f64::NEG_INFINITY, value + 1.0)],
                Comparison::Greater => vec![after],
                Comparison::AtLeast => vec![(value, f64::INFINITY)],
            };
            intervals.into_iter().map(|within| (quantity, within)).collect()
        }
        Condition::All(_) | Condition::Any(_) | Condition::Not(_) => Vec::new(),
    }
}

impl Comparison {
    const fn opposite(self) -> Self {
        match self {
            Self::Equal => Self::NotEqual,
            Self::NotEqual => Self::Equal,
            Self::Less => Self::AtLeast,
            Self::AtMost => Self::Greater,
            Self::Greater => Self::AtMost,
            Self::AtLeast => Self::Less,
        }
    }
}

impl Scenario {
    /// Something changes the variable.
    pub(super) fn sets(&self, variable: usize) -> bool {
        let ways = self.states.iter().flat_map(|state| &state.transitions).chain(&self.anywhere);
        let acts = self.states.iter().flat_map(|state| &state.entry).chain(ways.flat_map(|way| &way.acts));
        acts.into_iter().any(|act| act.variable() == variable)
    }
}

impl Act<usize> {
    /// The variable that it changes.
    pub const fn variable(&self) -> usize {
        match self {
            Self::Set { variable, .. } | Self::Add { variable, .. } => *variable,
        }
    }
}

/// A condition that can hold in more ways than this is taken to be able to hold.
const MOST_WAYS: usize = 128;
