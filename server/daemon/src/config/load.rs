//! Reading the file and the environment into a [`Config`].

use std::fmt::Write;
use std::path::{Path, PathBuf};

use toml::Value;

use super::keys::{Key, all, out_of_order};
use covr_gantry::odrive::settings::ShortWatchdog;
use covr_wire::records::ConfigOrigin;

use super::{Config, Loaded, LogFormat, MachineKind};

/// Why a configuration was refused.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// The file cannot be read.
    #[error("cannot read {}: {source}", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It is not TOML.
    #[error("{origin} is not TOML: {message}")]
    NotToml {
        /// File or variable.
        origin: String,
        /// With line and column.
        message: String,
    },
    /// No such key.
    #[error("{origin}: unknown key `{key}`{}", .nearest.map(|k| format!("; did you mean `{k}`?")).unwrap_or_default())]
    UnknownKey {
        /// File or variable.
        origin: String,
        /// The key.
        key: String,
        /// The most similar known key.
        nearest: Option<&'static str>,
    },
    /// Not what the key accepts.
    #[error("{origin}: `{key}`: found {found}, expected {expected}")]
    BadValue {
        /// File or variable.
        origin: String,
        /// The key.
        key: &'static str,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A measure would be bad before it is weak.
    #[error("`{weak_key}`: found {weak}, expected less than `{bad_key}`, which is {bad}")]
    WeakNotBelowBad {
        /// The key of the one.
        weak_key: &'static str,
        /// Its value.
        weak: f64,
        /// The key of the other.
        bad_key: &'static str,
        /// Its value.
        bad: f64,
    },
    /// The column could coast.
    #[error("{key}: {source}")]
    ShortWatchdog {
        /// The key.
        key: &'static str,
        /// By how much it is too short.
        source: ShortWatchdog,
    },
}

/// The configuration of a file (or the defaults without one), with the environment's overrides.
pub fn load(
    file: Option<&Path>,
    environment: impl IntoIterator<Item = (String, String)>,
) -> Result<Loaded, ConfigError> {
    let mut loaded = Loaded::default();
    if let Some(path) = file {
        let text = std::fs::read_to_string(path)
            .map_err(|source| ConfigError::Unreadable { path: path.into(), source })?;
        loaded = read_text(&text, &path.display().to_string())?;
        loaded.origins.read(path);
    }
    for (name, found) in environment {
        let Some(key) = name.strip_prefix("COVR_").filter(|rest| rest.contains("__")) else { continue };
        let key = key.replace("__", ".").to_lowercase();
        let value = toml::from_str::<toml::Table>(&format!("v = {found}"))
            .ok()
            .and_then(|mut table| table.remove("v"))
            .unwrap_or(Value::String(found));
        let key = set(&mut loaded.config, &key, &value, &format!("environment variable {name}"))?;
        loaded.origins.set(key, ConfigOrigin::Environment);
    }
    checked(loaded)
}

/// The configuration of a TOML text.
pub fn load_text(text: &str, origin: &str) -> Result<Loaded, ConfigError> {
    checked(read_text(text, origin)?)
}

fn read_text(text: &str, origin: &str) -> Result<Loaded, ConfigError> {
    let table: toml::Table = toml::from_str(text)
        .map_err(|error| ConfigError::NotToml { origin: origin.into(), message: error.to_string() })?;
    let mut loaded = Loaded::default();
    let mut found = Vec::new();
    let whole = Value::Table(table);
    flatten("", &whole, &mut found);
    for (key, value) in found {
        let key = set(&mut loaded.config, &key, value, origin)?;
        loaded.origins.set(key, ConfigOrigin::File);
    }
    Ok(loaded)
}

/// What no key can tell by itself.
fn checked(loaded: Loaded) -> Result<Loaded, ConfigError> {
    let machine = &loaded.config.machine;
    if machine.kind == MachineKind::Odrive {
        machine.odrive.settings(&loaded.config).check().map_err(|source| ConfigError::ShortWatchdog {
            key: "machine.odrive.watchdog_timeout_secs",
            source,
        })?;
    }
    match out_of_order(&loaded.config) {
        Some([(weak_key, weak), (bad_key, bad)]) => {
            Err(ConfigError::WeakNotBelowBad { weak_key, weak, bad_key, bad })
        }
        None => Ok(loaded),
    }
}

/// A TOML text with every key, its meaning and the value of `config`.
pub fn reference(config: &Config) -> String {
    let mut text = String::from(
        "# Every key of the CoVR server with its default. COVR_SECTION__KEY in the environment overrides a key:\n\
         # COVR_SERVER__BIND=127.0.0.1:9000\n",
    );
    let mut section = "";
    for key in all() {
        let (in_section, name) = key.name.rsplit_once('.').unwrap_or(("", key.name));
        if in_section != section {
            section = in_section;
            let _ = write!(text, "\n[{section}]\n");
        }
        let _ = writeln!(text, "# {}", key.meaning);
        let _ = writeln!(text, "# Accepts {}.", key.accepts);
        let _ = writeln!(text, "{name} = {}", key.value(config));
    }
    text
}

impl std::str::FromStr for LogFormat {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        clap::ValueEnum::from_str(text, false)
    }
}

/// Put a value in its place; the key's name.
fn set(config: &mut Config, name: &str, value: &Value, origin: &str) -> Result<&'static str, ConfigError> {
    let keys = all();
    let Some(key) = keys.iter().find(|key| key.name == name) else {
        return Err(ConfigError::UnknownKey {
            origin: origin.into(),
            key: name.into(),
            nearest: nearest(&keys, name),
        });
    };
    if key.set(config, value) {
        return Ok(key.name);
    }
    Err(ConfigError::BadValue {
        origin: origin.into(),
        key: key.name,
        found: value.to_string(),
        expected: key.accepts.to_string(),
    })
}

/// Tables whose path no key continues are reported as they stand, so that an unknown section is named whole.
fn flatten<'a>(path: &str, value: &'a Value, found: &mut Vec<(String, &'a Value)>) {
    match value {
        Value::Table(table) => {
            for (name, value) in table {
                let inner = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
                flatten(&inner, value, found);
            }
        }
        _ => found.push((path.into(), value)),
    }
}

fn nearest(keys: &[Key], name: &str) -> Option<&'static str> {
    let near = |key: &Key| strsim::jaro_winkler(key.name, name);
    keys.iter().max_by(|a, b| near(a).total_cmp(&near(b))).filter(|key| near(key) > 0.8).map(|key| key.name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn environment(name: &str, value: &str) -> Vec<(String, String)> {
        vec![(name.into(), value.into())]
    }

    #[test]
    fn the_reference_reads_back_as_the_defaults() {
        let text = reference(&Config::default());
        assert_eq!(load_text(&text, "reference").unwrap().config, Config::default());
    }

    #[test]
    fn the_example_file_is_the_reference() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../deploy/covr.example.toml");
        let example = std::fs::read_to_string(path).unwrap();
        assert_eq!(
            example,
            reference(&Config::default()),
            "write it anew with: covr config > deploy/covr.example.toml"
        );
    }

    #[test]
    fn every_key_gives_back_what_it_was_set_to() {
        let defaults = Config::default();
        for key in all() {
            let mut config = defaults.clone();
            assert!(key.set(&mut config, &key.value(&defaults)), "{} refuses its own default", key.name);
            assert_eq!(config, defaults, "{}", key.name);
            let nonsense = Value::Array(vec![Value::Boolean(true)]);
            assert!(!key.set(&mut config, &nonsense), "{} takes a list of a truth value", key.name);
        }
    }

    #[test]
    fn an_origin_is_scheme_and_host_and_no_pattern() {
        let load =
            |origin: &str| load_text(&format!("[clients]\nallowed_origins = [\"{origin}\"]"), "f.toml");
        for good in ["null", "file://", "http://localhost:5173"] {
            assert_eq!(load(good).unwrap().config.clients.allowed_origins, [good]);
        }
        for bad in ["*", "http://*", "http://lab.example/", "lab.example", "http://", ""] {
            assert!(load(bad).unwrap_err().to_string().contains("allowed_origins"), "{bad}");
        }
    }

    #[test]
    fn a_watchdog_with_which_the_column_could_coast_is_refused_for_the_machine_that_has_it() {
        let text = |kind: &str, braking: f64| {
            format!("[machine]\nkind = \"{kind}\"\n[machine.x]\nbraking_mps2 = {braking}\n")
        };
        assert!(load_text(&text("odrive", 2.5), "f.toml").is_ok());
        assert!(load_text(&text("roboclaw", 1.25), "f.toml").is_ok());
        let refused = load_text(&text("odrive", 1.25), "f.toml").unwrap_err().to_string();
        assert!(
            refused.starts_with(
                "machine.odrive.watchdog_timeout_secs: watchdog timeout: found 0.80 s, expected at least 1.08 s"
            ),
            "{refused}"
        );
    }

    #[test]
    fn an_unknown_key_is_named_with_the_nearest_known_one() {
        let error = load_text("[control]\nrate_herz = 250", "f.toml").unwrap_err();
        assert_eq!(
            error.to_string(),
            "f.toml: unknown key `control.rate_herz`; did you mean `control.rate_hz`?"
        );
        let error = load_text("[wombat]\nzzz = 1", "f.toml").unwrap_err();
        assert!(error.to_string().starts_with("f.toml: unknown key `wombat.zzz`"), "{error}");
    }

    #[test]
    fn a_bad_value_names_key_found_and_expected() {
        let error = load_text("[people]\nv_h_mps = 0.2", "f.toml").unwrap_err();
        assert_eq!(error.to_string(), "f.toml: `people.v_h_mps`: found 0.2, expected a number from 1.6 to 3");
        let error = load_text("[server]\nbind = 7878", "f.toml").unwrap_err();
        assert!(error.to_string().contains("`server.bind`: found 7878, expected an address"), "{error}");
    }

    #[test]
    fn a_measure_that_would_be_bad_before_it_is_weak_is_refused_with_both_keys() {
        let file = "[links]\njitter_weak_millis = 30\n";
        let error = load_text(file, "f.toml").unwrap_err();
        assert_eq!(
            error.to_string(),
            "`links.jitter_weak_millis`: found 30, expected less than `links.jitter_bad_millis`, which is 25"
        );
        for key in all().iter().filter(|key| key.name.starts_with("links.") && key.name.contains("_weak_")) {
            let mut loaded = Loaded::default();
            let bad = all().into_iter().find(|bad| bad.name == key.name.replace("_weak_", "_bad_")).unwrap();
            assert!(key.set(&mut loaded.config, &bad.value(&Config::default())), "{}", key.name);
            assert!(checked(loaded).is_err(), "{} may equal {}", key.name, bad.name);
        }
        let both = load_text("[links]\njitter_weak_millis = 30\njitter_bad_millis = 40\n", "f.toml").unwrap();
        assert!((both.config.links.jitter_millis.weak - 30.0).abs() < 1e-12);
    }

    #[test]
    fn the_environment_overrides_and_is_checked_as_well() {
        let loaded = load(None, environment("COVR_SERVER__BIND", "127.0.0.1:9000")).unwrap();
        assert_eq!(loaded.config.server.bind.port(), 9000);
        let loaded = load(None, environment("COVR_MACHINE__X__SPEED_MPS", "0.5")).unwrap();
        assert!((loaded.config.machine.x.speed_mps - 0.5).abs() < 1e-12);
        let error = load(None, environment("COVR_SERVER__BINT", "x")).unwrap_err();
        assert!(error.to_string().contains("did you mean `server.bind`"), "{error}");
        assert_eq!(load(None, environment("COVR_SKIP_WEB", "1")).unwrap(), Loaded::default());
    }

    #[test]
    fn who_set_a_value_is_known_and_the_last_one_counts() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("covr.toml");
        std::fs::write(&file, "[control]\nrate_hz = 250\npublish_hz = 20\n[log]\nlevel = \"warn\"\n")
            .unwrap();
        let mut loaded = load(Some(&file), environment("COVR_CONTROL__PUBLISH_HZ", "25")).unwrap();
        loaded.set_by_command_line("log.level", Some("debug".into()), |c| &mut c.log.level);
        loaded.set_by_command_line("server.database", None, |c| &mut c.server.database);
        assert_eq!((loaded.config.control.publish_hz, loaded.config.log.level.as_str()), (25.0, "debug"));
        let origins = &loaded.origins;
        assert_eq!(origins.file(), Some(&*file));
        assert_eq!(origins.of("control.rate_hz"), ConfigOrigin::File, "also where it says the default");
        assert_eq!(origins.of("control.publish_hz"), ConfigOrigin::Environment);
        assert_eq!(origins.of("log.level"), ConfigOrigin::CommandLine);
        assert_eq!(origins.of("server.database"), ConfigOrigin::Default);
    }
}
