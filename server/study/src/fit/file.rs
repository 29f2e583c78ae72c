//! A parameter file: TOML that people can read, with where its numbers come from.

use std::fmt::Write;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use covr_engine::intention::{IntentionParameters, RuleName};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::parameters::{PARAMETERS, Parameter, of_rule};

/// The parameters of one rule, and where they come from.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterFile {
    /// The rule that they were fitted for.
    pub rule: RuleName,
    /// All parameters; those that the file does not name are the defaults.
    pub parameters: IntentionParameters,
    /// Where they come from; none when somebody wrote them.
    pub fitted: Option<Fitted>,
}

/// Where parameters come from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fitted {
    /// When, by the caller's clock, RFC 3339.
    pub at: String,
    /// By which version of the program.
    pub version: String,
    /// By which command.
    pub command: String,
    /// What was made least.
    pub objective: String,
    /// Mean loss with the default parameters.
    pub before: f64,
    /// Mean loss of the people that they were fitted to.
    pub in_sample: f64,
    /// Mean loss of people left out, each under parameters that were not fitted to them.
    pub left_out: Option<f64>,
    /// How many groups of people were left out in turn.
    pub folds: usize,
    /// Who they were fitted to.
    pub people: Vec<String>,
    /// On what.
    pub files: Vec<FittedOn>,
}

/// A file of recordings.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FittedOn {
    /// Its name, without its folder.
    pub name: String,
    /// Of its content, hex.
    pub sha256: String,
}

/// Why a parameter file is refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{origin}, line {line}, {key}: found {found}, expected {expected}")]
pub struct FileProblem {
    /// The file.
    pub origin: String,
    /// Which line, from 1.
    pub line: usize,
    /// Which key.
    pub key: String,
    /// What is there.
    pub found: String,
    /// What should be.
    pub expected: String,
}

impl FittedOn {
    /// A file as it is now.
    pub fn of(file: &Path) -> io::Result<Self> {
        let mut hash = Sha256::new();
        let mut content = File::open(file)?;
        let mut part = vec![0; 1 << 16];
        loop {
            match content.read(&mut part)? {
                0 => break,
                read => hash.update(&part[..read]),
            }
        }
        let sha256 = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
        let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        Ok(Self { name, sha256 })
    }
}

impl ParameterFile {
    /// Read a text; `origin` is what errors will name.
    pub fn read(text: &str, origin: &str) -> Result<Self, FileProblem> {
        let reading = Reading { text, origin };
        let whole = DeTable::parse(text).map_err(|error| {
            reading.problem(error.span().map_or(0, |span| span.start), "the file", error.message(), "TOML")
        })?;
        let (mut rule, mut is_of_schema) = (None, false);
        let (mut parameters, mut fitted) = (IntentionParameters::default(), None);
        for (key, value) in whole.get_ref() {
            let (name, at) = (key.get_ref().as_ref(), value.span().start);
            match (name, value.get_ref()) {
                ("schema", DeValue::String(schema)) if schema == SCHEMA => is_of_schema = true,
                ("schema", _) => return Err(reading.found(name, value, SCHEMA)),
                ("rule", DeValue::String(named)) if RuleName::parse(named).is_some() => {
                    rule = RuleName::parse(named)
                }
                ("rule", _) => {
                    let names = RuleName::ALL.map(RuleName::name).join(", ");
                    return Err(reading.found(name, value, &format!("one of {names}")));
                }
                ("fitted", _) => fitted = Some(reading.fitted(at)?),
                (group, DeValue::Table(table)) if is_group(group) => {
                    reading.group(group, table, &mut parameters)?;
                }
                _ => {
                    let expected = "schema, rule, fitted or a group of parameters";
                    return Err(reading.problem(key.span().start, name, "this key", expected));
                }
            }
        }
        let missing = |key: &str| reading.problem(0, key, "nothing", "this key");
        if !is_of_schema {
            return Err(missing("schema"));
        }
        Ok(Self { rule: rule.ok_or_else(|| missing("rule"))?, parameters, fitted })
    }

    /// The text of the file.
    pub fn text(&self) -> Result<String, toml::ser::Error> {
        let mut text = format!("schema = \"{SCHEMA}\"\nrule = \"{}\"\n", self.rule.name());
        let mut group = "";
        for parameter in of_rule(self.rule) {
            let (of, name) = parameter.name.split_once('.').unwrap_or(("", parameter.name));
            if of != group {
                group = of;
                let _ = write!(text, "\n[{group}]\n");
            }
            let unit = if parameter.unit.is_empty() { String::new() } else { format!(" {}", parameter.unit) };
            let (least, most, default) = (parameter.least, parameter.most, parameter.default());
            let _ = writeln!(text, "# {}", parameter.meaning);
            let _ = writeln!(text, "# From {least}{unit} to {most}{unit}; {default}{unit} by default.");
            let _ = writeln!(text, "{name} = {:?}", parameter.get(&self.parameters));
        }
        if let Some(fitted) = &self.fitted {
            text += &format!("\n{}", toml::to_string(&Section { fitted: Some(fitted.clone()) })?);
        }
        Ok(text)
    }
}

/// The part of the file that says where it comes from.
#[derive(Serialize, Deserialize)]
struct Section {
    fitted: Option<Fitted>,
}

struct Reading<'a> {
    text: &'a str,
    origin: &'a str,
}

impl Reading<'_> {
    fn fitted(&self, at: usize) -> Result<Fitted, FileProblem> {
        let problem = |error: toml::de::Error| {
            let at = error.span().map_or(at, |span| span.start);
            self.problem(
                at,
                "fitted",
                error.message(),
                "where the parameters come from, as `covr fit` writes it",
            )
        };
        let section: Section = toml::from_str(self.text).map_err(problem)?;
        section.fitted.ok_or_else(|| self.problem(at, "fitted", "nothing", "a table"))
    }

    fn group(
        &self,
        group: &str,
        table: &DeTable<'_>,
        parameters: &mut IntentionParameters,
    ) -> Result<(), FileProblem> {
        for (key, value) in table {
            let name = format!("{group}.{}", key.get_ref());
            let Some(parameter) = Parameter::named(&name) else {
                let names: Vec<&str> = PARAMETERS.iter().map(|parameter| parameter.name).collect();
                return Err(self.problem(
                    key.span().start,
                    &name,
                    "this key",
                    &format!("one of {}", names.join(", ")),
                ));
            };
            let number = match value.get_ref() {
                DeValue::Float(_) | DeValue::Integer(_) => {
                    self.text[value.span()].replace('_', "").parse().ok()
                }
                _ => None,
            };
            let Some(number) = number.filter(|number| parameter.range().contains(number)) else {
                let expected = format!("a number from {} to {}", parameter.least, parameter.most);
                return Err(self.found(&name, value, &expected));
            };
            parameter.set(parameters, number);
        }
        Ok(())
    }

    fn found(&self, key: &str, value: &Spanned<DeValue<'_>>, expected: &str) -> FileProblem {
        self.problem(value.span().start, key, &self.text[value.span()], expected)
    }

    fn problem(&self, at: usize, key: &str, found: &str, expected: &str) -> FileProblem {
        let line = 1 + self.text.bytes().take(at).filter(|byte| *byte == b'\n').count();
        let (origin, key) = (self.origin.to_owned(), key.to_owned());
        FileProblem { origin, line, key, found: found.to_owned(), expected: expected.to_owned() }
    }
}

fn is_group(name: &str) -> bool {
    PARAMETERS.iter().any(|parameter| parameter.name.split_once('.').is_some_and(|(group, _)| group == name))
}

/// Of this form.
const SCHEMA: &str = "covr.parameters.v1";

#[cfg(test)]
mod tests {
    use super::*;

    fn fitted() -> ParameterFile {
        let mut parameters = IntentionParameters::default();
        parameters.paper.distance_share = 0.1 + 0.2;
        let files = vec![FittedOn { name: "reach.jsonl.gz".into(), sha256: "00ff".into() }];
        let fitted = Fitted {
            at: "2026-11-26T14:00:00Z".into(),
            version: "0.1.0".into(),
            command: "covr fit reach.jsonl.gz --rule paper-best".into(),
            objective: "log-loss".into(),
            before: 0.75,
            in_sample: 0.5,
            left_out: Some(0.625),
            folds: 5,
            people: vec!["a".into(), "b".into()],
            files,
        };
        ParameterFile { rule: RuleName::PaperBest, parameters, fitted: Some(fitted) }
    }

    #[test]
    fn a_file_is_read_back_to_the_last_bit() {
        let file = fitted();
        let text = file.text().unwrap();
        assert_eq!(ParameterFile::read(&text, "f"), Ok(file), "{text}");
        let bare = "schema = \"covr.parameters.v1\"\nrule = \"paper\"\n";
        let bare = ParameterFile::read(bare, "f").unwrap();
        assert_eq!((bare.parameters, bare.fitted), (IntentionParameters::default(), None));
    }

    #[test]
    fn the_shipped_file_is_what_is_compiled_in() {
        let text = include_str!("../../../../deploy/parameters/bayes.toml");
        let shipped = ParameterFile::read(text, "deploy/parameters/bayes.toml").unwrap();
        assert_eq!((shipped.rule, &shipped.parameters), (RuleName::Bayes, &IntentionParameters::default()));
        // Every parameter is named, as the program would write it, below where they come from.
        let (provenance, rest) = text.split_at(text.find("schema").unwrap());
        assert_eq!(rest, shipped.text().unwrap());
        assert!(provenance.contains("People:") && provenance.contains("Objective:"));
    }

    #[test]
    fn a_file_of_recordings_is_known_by_its_content() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("abc.jsonl");
        std::fs::write(&file, "abc").unwrap();
        let of = FittedOn::of(&file).unwrap();
        // The published example of FIPS 180.
        assert_eq!(of.sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        assert_eq!(of.name, "abc.jsonl");
    }

    #[test]
    fn each_wrong_key_is_named_with_its_line() {
        let good = fitted().text().unwrap();
        let cases = [
            (
                "distance_share = 0.30000000000000004",
                "distance_share = 1.5",
                7,
                "paper.distance_share",
                "1.5",
            ),
            (
                "distance_share = 0.30000000000000004",
                "distance_share = \"x\"",
                7,
                "paper.distance_share",
                "\"x\"",
            ),
            ("distance_share = 0.30000000000000004", "share = 0.3", 7, "paper.share", "this key"),
            ("\"paper-best\"", "\"best\"", 2, "rule", "\"best\""),
            ("parameters.v1", "parameters.v9", 1, "schema", "\"covr.parameters.v9\""),
            ("[paper]", "[papper]", 4, "papper", "this key"),
            ("[paper]", "[paper", 4, "the file", ""),
            ("folds = 5", "folds = -5", 0, "fitted", ""),
        ];
        for (from, to, line, key, found) in cases {
            let bad = ParameterFile::read(&good.replacen(from, to, 1), "f").unwrap_err();
            assert_eq!((bad.key.as_str(), bad.origin.as_str()), (key, "f"), "{bad}");
            assert!(line == 0 || bad.line == line, "{bad}");
            assert!(found.is_empty() || bad.found == found, "{bad}");
        }
        let bad = ParameterFile::read("rule = \"paper\"", "f").unwrap_err();
        assert_eq!((bad.key.as_str(), bad.found.as_str()), ("schema", "nothing"));
    }
}
