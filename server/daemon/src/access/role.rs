//! The five roles.

use serde::{Deserialize, Serialize};
use ts_rs::TS;
use utoipa::ToSchema;

/// What a token's holder is to the installation. What each may do is in the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema, TS, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
#[value(rename_all = "snake_case")]
pub enum Role {
    /// Sees everything, and may stop.
    Observer,
    /// A VR client: speaks for people with headsets.
    Client,
    /// Makes scenes.
    Designer,
    /// Runs the machine and the visit.
    GameMaster,
    /// As a game master, and takes tokens back.
    Administrator,
}

impl Role {
    /// Every role.
    pub const ALL: [Self; 5] =
        [Self::Observer, Self::Client, Self::Designer, Self::GameMaster, Self::Administrator];

    /// The name on every surface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Observer => "observer",
            Self::Client => "client",
            Self::Designer => "designer",
            Self::GameMaster => "game_master",
            Self::Administrator => "administrator",
        }
    }

    /// The name in a sentence.
    pub const fn in_words(self) -> &'static str {
        match self {
            Self::GameMaster => "game master",
            other => other.name(),
        }
    }

    /// The name in a sentence, after "is".
    pub fn with_article(self) -> String {
        let vowel = matches!(self, Self::Observer | Self::Administrator);
        format!("{} {}", if vowel { "an" } else { "a" }, self.in_words())
    }

    /// The role of a name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|role| role.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_role_has_one_name_on_every_surface() {
        for role in Role::ALL {
            assert_eq!(Role::parse(role.name()), Some(role));
            assert_eq!(serde_json::to_value(role).unwrap(), role.name());
            let on_the_command_line = clap::ValueEnum::to_possible_value(&role).unwrap();
            assert_eq!(on_the_command_line.get_name(), role.name());
        }
        assert_eq!(Role::parse("emperor"), None);
    }
}
