//! Who set which value.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use covr_wire::records::ConfigOrigin;

use super::{Config, keys};

/// A configuration, and who set what of it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Loaded {
    /// The values.
    pub config: Config,
    /// Who set them.
    pub origins: Origins,
}

/// Who set which key.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Origins {
    file: Option<PathBuf>,
    by_key: BTreeMap<&'static str, ConfigOrigin>,
}

impl Loaded {
    /// Put the value of an option of the command in place, if it was given.
    pub fn set_by_command_line<T>(
        &mut self,
        key: &'static str,
        given: Option<T>,
        place: fn(&mut Config) -> &mut T,
    ) {
        if let Some(given) = given {
            *place(&mut self.config) = given;
            self.origins.set(key, ConfigOrigin::CommandLine);
        }
    }
}

impl From<Config> for Loaded {
    /// A configuration that a program made: what is not the default counts as said on the command line.
    fn from(config: Config) -> Self {
        let mut origins = Origins::default();
        let default = Config::default();
        for key in keys::all().iter().filter(|key| key.value(&config) != key.value(&default)) {
            origins.set(key.name, ConfigOrigin::CommandLine);
        }
        Self { config, origins }
    }
}

impl Origins {
    /// Who set this key.
    pub fn of(&self, key: &str) -> ConfigOrigin {
        self.by_key.get(key).copied().unwrap_or_default()
    }

    /// The file that was read.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    pub(super) fn read(&mut self, file: &Path) {
        self.file = Some(file.into());
    }

    pub(super) fn set(&mut self, key: &'static str, by: ConfigOrigin) {
        self.by_key.insert(key, by);
    }
}
