//! The words of an order: one line each, from the command line or while an emulator runs.

use std::str::SplitWhitespace;

use covr_engine::time::Span;

use super::Axis;

/// A line that is no order.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("order {line:?}: found {found}, expected {expected}")]
pub struct BadOrder {
    line: String,
    found: String,
    expected: &'static str,
}

impl BadOrder {
    /// Understand a whole line by its first word on.
    pub(crate) fn unless<T>(
        line: &str,
        order: impl FnOnce(&mut Words<'_>) -> Result<T, Wrong>,
    ) -> Result<T, Self> {
        let mut words = Words(line.split_whitespace());
        let order = order(&mut words).and_then(|order| words.end().map(|()| order));
        order.map_err(|(found, expected)| Self {
            line: line.to_owned(),
            found: found.map_or_else(|| "nothing more".to_owned(), |word| format!("{word:?}")),
            expected,
        })
    }
}

/// The words of a line that are left.
pub(crate) struct Words<'a>(SplitWhitespace<'a>);

/// What was found instead of what was expected.
pub(crate) type Wrong = (Option<String>, &'static str);

impl Words<'_> {
    pub(crate) fn next(&mut self) -> Option<String> {
        self.0.next().map(str::to_owned)
    }

    pub(crate) fn probability(&mut self) -> Result<f64, Wrong> {
        self.number(0.0, 1.0, "a probability from 0 to 1")
    }

    pub(crate) fn millis(&mut self) -> Result<Span, Wrong> {
        Ok(Span::from_secs(self.number(0.0, 60_000.0, "milliseconds from 0 to 60000")? * 1e-3))
    }

    pub(crate) fn axis(&mut self) -> Result<Axis, Wrong> {
        self.one_of(&[("x", Axis::X), ("y", Axis::Y)], "x or y")
    }

    pub(crate) fn number(&mut self, least: f64, most: f64, expected: &'static str) -> Result<f64, Wrong> {
        let word = self.next();
        let number =
            word.as_ref().and_then(|word| word.parse().ok()).filter(|number| (least..=most).contains(number));
        number.ok_or((word, expected))
    }

    pub(crate) fn one_of<T: Copy>(
        &mut self,
        choices: &[(&str, T)],
        expected: &'static str,
    ) -> Result<T, Wrong> {
        let word = self.next();
        let chosen = choices.iter().find(|(name, _)| Some(*name) == word.as_deref());
        chosen.map(|(_, value)| *value).ok_or((word, expected))
    }

    pub(crate) fn end(&mut self) -> Result<(), Wrong> {
        self.next().map_or(Ok(()), |word| Err((Some(word), "the end of the line")))
    }
}
