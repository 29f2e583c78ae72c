//! Whether a condition holds now, and when it would by the passing of time alone.

use super::senses::Senses;
use super::spec::Condition;
use crate::time::Span;

/// All that a condition may look at.
#[derive(Debug, Clone, Copy)]
pub struct Now<'a> {
    /// Who does what.
    pub senses: &'a Senses,
    /// The variables, as numbers.
    pub variables: &'a [i64],
    /// For how long the state has lasted.
    pub in_state: Span,
    /// The scenario's clock.
    pub clock: Span,
}

impl Now<'_> {
    /// For how long something has lasted in this state: what began before it counts from its entry.
    fn lasts(&self, since: Span) -> Span {
        (self.clock - since).min(self.in_state)
    }
}

impl Condition<usize> {
    /// Whether it holds.
    pub fn holds(&self, now: &Now<'_>) -> bool {
        let lasts = |since: Option<Span>, secs: f64| {
            since.is_some_and(|since| now.lasts(since) >= Span::from_secs(secs))
        };
        match self {
            Self::Touching { object, secs } => lasts(now.senses.touched_since(*object), *secs),
            Self::LooksAt { object, secs } => lasts(now.senses.looked_at_since(*object), *secs),
            Self::InZone(zone) => now.senses.is_inside(*zone),
            Self::InPlace(object) => now.senses.is_in_place(*object),
            Self::TimeInState(secs) => now.in_state >= Span::from_secs(*secs),
            Self::Variable { variable, is, value } => {
                now.variables.get(*variable).is_some_and(|number| is.holds(*number, value.number()))
            }
            Self::All(parts) => parts.iter().all(|part| part.holds(now)),
            Self::Any(parts) => parts.iter().any(|part| part.holds(now)),
            Self::Not(part) => !part.holds(now),
        }
    }

    /// In how many seconds it holds if everybody goes on with what they do; 0 when it does now, infinite when time alone will not do.
    pub fn due_secs(&self, now: &Now<'_>) -> f64 {
        let left = |since: Option<Span>, secs: f64| {
            since.map_or(f64::INFINITY, |since| (secs - now.lasts(since).secs()).max(0.0))
        };
        let at_once = |holds: bool| if holds { 0.0 } else { f64::INFINITY };
        match self {
            Self::Touching { object, secs } => left(now.senses.touched_since(*object), *secs),
            Self::LooksAt { object, secs } => left(now.senses.looked_at_since(*object), *secs),
            Self::TimeInState(secs) => (secs - now.in_state.secs()).max(0.0),
            Self::All(parts) => parts.iter().map(|part| part.due_secs(now)).fold(0.0, f64::max),
            Self::Any(parts) => parts.iter().map(|part| part.due_secs(now)).fold(f64::INFINITY, f64::min),
            Self::InZone(_) | Self::InPlace(_) | Self::Variable { .. } | Self::Not(_) => {
                at_once(self.holds(now))
            }
        }
    }
}
