//! The parameters of the intention rule, from the file that the configuration names.

use std::io;
use std::path::PathBuf;

use covr_engine::intention::IntentionParameters;
use covr_study::fit::{FileProblem, ParameterFile};

use super::People;

/// Why the file of parameters is refused.
#[derive(Debug, thiserror::Error)]
pub enum ParametersRefused {
    /// It cannot be read.
    #[error("people.intention_parameters: cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// It is no file of parameters.
    #[error("people.intention_parameters: {0}")]
    Bad(#[from] FileProblem),
    /// It is one of another rule.
    #[error(
        "people.intention_parameters: {}: found parameters of `{found}`, expected those of `{expected}`, the people.intention_rule",
        path.display()
    )]
    OfAnotherRule {
        /// The file.
        path: PathBuf,
        /// Its rule.
        found: &'static str,
        /// The rule in force.
        expected: &'static str,
    },
}

impl People {
    /// The parameters of the intention rule.
    pub fn intention(&self) -> Result<IntentionParameters, ParametersRefused> {
        let Some(path) = &self.intention_parameters else { return Ok(IntentionParameters::default()) };
        let text = std::fs::read_to_string(path)
            .map_err(|source| ParametersRefused::Unreadable { path: path.clone(), source })?;
        let file = ParameterFile::read(&text, &path.display().to_string())?;
        if file.rule != self.intention_rule {
            let (found, expected) = (file.rule.name(), self.intention_rule.name());
            return Err(ParametersRefused::OfAnotherRule { path: path.clone(), found, expected });
        }
        Ok(file.parameters)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use covr_engine::intention::RuleName;

    fn of_file(text: &str) -> Result<IntentionParameters, ParametersRefused> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("parameters.toml");
        std::fs::write(&path, text).unwrap();
        let intention_rule = RuleName::PaperBest;
        People { intention_rule, intention_parameters: Some(path), ..Config::default().people }.intention()
    }

    #[test]
    fn the_file_is_used_and_a_bad_one_is_refused_by_key_file_and_line() {
        let good = "schema = \"covr.parameters.v1\"\nrule = \"paper-best\"\n[paper]\ndistance_share = 0.5\n";
        assert_eq!(of_file(good).unwrap().paper.distance_share, 0.5);
        let bad = of_file(&good.replace("0.5", "5")).unwrap_err().to_string();
        for part in ["people.intention_parameters", "parameters.toml, line 4", "found 5", "from 0 to 1"] {
            assert!(bad.contains(part), "{part:?} is not in {bad:?}");
        }
        let other = of_file(&good.replace("paper-best", "paper")).unwrap_err().to_string();
        assert!(other.contains("found parameters of `paper`, expected those of `paper-best`"), "{other}");
    }

    #[test]
    fn without_a_file_the_defaults_stand_and_a_missing_one_is_named() {
        assert_eq!(Config::default().people.intention().unwrap(), IntentionParameters::default());
        let gone = People { intention_parameters: Some("no/such.toml".into()), ..Config::default().people };
        assert!(gone.intention().unwrap_err().to_string().contains("cannot read no/such.toml"));
    }
}
