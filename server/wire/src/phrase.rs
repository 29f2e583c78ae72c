//! What was found and expected somewhere, as an id and its values, so that a page says it in its reader's language.
//!
//! The sentences are made in many rooms, some of them in libraries (serde). They stay the plain English that they are; here
//! they are known again, where a document is made of them. A hole takes a number (`{n:number}`), something in quotation
//! marks (`{id:quoted}`), or anything (`{known}`).

mod table;

use std::collections::BTreeMap;
use std::sync::LazyLock;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

use table::PHRASES;

/// A phrase: an id that stays, and the values that it is about.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Phrase {
    /// Which phrase.
    pub id: String,
    /// Its values by name, as the English has them.
    pub values: BTreeMap<String, String>,
}

impl Phrase {
    /// The phrase that a text is: of those that fit, the one that says most of it itself. None for a value as it stands, and for
    /// what this version has no phrase for.
    pub fn of(text: &str) -> Option<Self> {
        let fits = PARTS.iter().filter_map(|(id, parts)| {
            let mut values = BTreeMap::new();
            takes(parts, text, &mut values).then(|| (own_len(parts), Self { id: (*id).to_owned(), values }))
        });
        // The first of the longest.
        fits.reduce(|best, next| if next.0 > best.0 { next } else { best }).map(|(_, phrase)| phrase)
    }

    /// Every phrase by id, with its English: `{least} to {most}`. For the catalogues that must have them all.
    pub fn all() -> impl Iterator<Item = (&'static str, String)> {
        PHRASES.iter().map(|(id, english)| (*id, english.replace(":number}", "}").replace(":quoted}", "}")))
    }
}

/// Whether a text is a value as it stands: a number, something in quotation marks, yes or no, a list of numbers.
pub fn is_value(text: &str) -> bool {
    text.starts_with('"') && text.ends_with('"') && text.len() > 1
        || text.starts_with('`') && text.ends_with('`') && text.len() > 1
        || text.starts_with('[') && text.ends_with(']')
        || is_number(text)
        || matches!(text, "true" | "false" | "null")
}

/// The table, taken apart once.
static PARTS: LazyLock<Vec<(&str, Vec<Part>)>> =
    LazyLock::new(|| PHRASES.iter().map(|(id, english)| (*id, parts(english))).collect());

enum Part {
    Words(&'static str),
    Hole { name: &'static str, kind: &'static str },
}

fn parts(english: &'static str) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut rest = english;
    while let Some((before, after)) = rest.split_once('{') {
        let (hole, after) = after.split_once('}').unwrap_or((after, ""));
        let (name, kind) = hole.split_once(':').unwrap_or((hole, ""));
        parts.extend([Part::Words(before), Part::Hole { name, kind }]);
        rest = after;
    }
    parts.push(Part::Words(rest));
    parts
}

fn own_len(parts: &[Part]) -> usize {
    parts.iter().map(|part| if let Part::Words(words) = part { words.len() } else { 0 }).sum()
}

fn takes(parts: &[Part], text: &str, values: &mut BTreeMap<String, String>) -> bool {
    match parts {
        [] => text.is_empty(),
        [Part::Words(words), rest @ ..] => {
            text.strip_prefix(words).is_some_and(|after| takes(rest, after, values))
        }
        [Part::Hole { name, kind }, rest @ ..] => {
            let ends = text.char_indices().map(|(at, _)| at).skip(1).chain([text.len()]);
            ends.into_iter().any(|end| {
                let (value, after) = text.split_at(end);
                let fits = match *kind {
                    "number" => is_number(value),
                    "quoted" => value.len() > 1 && value.starts_with('"') && value.ends_with('"'),
                    _ => !value.is_empty(),
                };
                let fits = fits && takes(rest, after, values);
                if fits {
                    values.insert((*name).to_owned(), value.to_owned());
                }
                fits
            })
        }
    }
}

fn is_number(text: &str) -> bool {
    text.parse::<f64>().is_ok()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    fn said(text: &str) -> Option<(String, Vec<String>)> {
        Phrase::of(text).map(|phrase| (phrase.id, phrase.values.into_values().collect()))
    }

    #[test]
    fn a_text_is_known_again_with_its_values() {
        assert_eq!(
            said("a number from 0 to 1"),
            Some(("number_between".into(), vec!["0".into(), "1".into()]))
        );
        assert_eq!(
            said("an object of this scene: \"lamp\", \"door\""),
            Some(("object_of_scene".into(), vec!["\"lamp\", \"door\"".into()]))
        );
        assert_eq!(
            said("the priors add up to 0.90 and not to 1: only their ratios count"),
            Some(("priors_sum".into(), vec!["0.90".into()]))
        );
    }

    #[test]
    fn a_number_is_asked_for_where_one_is_due() {
        assert_eq!(said("here to there"), None);
        assert_eq!(said("something nobody ever said"), None);
    }

    #[test]
    fn each_phrase_is_its_own_and_is_found_by_its_own_words() {
        let mut ids = HashSet::new();
        for (id, english) in PHRASES {
            assert!(ids.insert(*id), "{id} twice");
            let sample: String = parts(english)
                .iter()
                .map(|part| match part {
                    Part::Words(words) => (*words).to_owned(),
                    Part::Hole { kind: "number", .. } => "12.5".into(),
                    Part::Hole { kind: "quoted", .. } => "\"lamp\"".into(),
                    Part::Hole { .. } => "props[3]".into(),
                })
                .collect();
            let found = Phrase::of(&sample).map(|phrase| phrase.id);
            assert_eq!(found.as_deref(), Some(*id), "{sample}");
        }
    }

    #[test]
    fn values_as_they_stand_are_no_phrases() {
        for value in ["\"lamp\"", "`radius`", "3.5", "-0", "[1, 2]", "true", "null"] {
            assert!(is_value(value), "{value}");
            assert_eq!(said(value), None, "{value}");
        }
        assert!(!is_value("a value"));
    }
}
