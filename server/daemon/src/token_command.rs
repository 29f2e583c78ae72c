//! `covr token`: tokens are made, listed and taken back on the machine that has the database. A running server
//! knows of it within a second.

use std::path::PathBuf;
use std::time::{Duration, SystemTime};

use anyhow::{Context, bail, ensure};
use clap::{Args, Subcommand};

use crate::access::{Role, Token};
use crate::clock::wall_now;
use crate::config;
use crate::store::{Store, StoredToken};

/// Make, list and take back tokens.
#[derive(Debug, Clone, Args)]
pub struct TokenCommand {
    /// What to do.
    #[command(subcommand)]
    pub what: What,
    /// Configuration file (TOML) of the server.
    #[arg(long, env = "COVR_CONFIG", global = true)]
    pub config: Option<PathBuf>,
    /// Database file of the server, instead of server.database.
    #[arg(long, global = true)]
    pub database: Option<PathBuf>,
}

/// What to do with tokens.
#[derive(Debug, Clone, Subcommand)]
pub enum What {
    /// Make a token and print it: this once. From the first one on, the server asks everybody who they are.
    Create {
        /// What its holder is called in the record: "front desk", "headset 2".
        name: String,
        /// What its holder may do.
        #[arg(long, value_enum)]
        role: Role,
        /// Days until it ends by itself; 0: never.
        #[arg(long, default_value_t = 90, value_parser = clap::value_parser!(u32).range(0..=3650))]
        days: u32,
    },
    /// Every token, without its secret.
    List,
    /// Take a token back, by its name or its id, and sign its holder out.
    Revoke {
        /// Name or id.
        token: String,
    },
}

/// Do it; what is for standard output.
pub async fn run(command: TokenCommand) -> anyhow::Result<String> {
    let mut loaded = config::load(command.config.as_deref(), std::env::vars())?;
    loaded.set_by_command_line("server.database", command.database, |c| &mut c.server.database);
    let path = &loaded.config.server.database;
    let store = Store::open(path).await.with_context(|| format!("database {}", path.display()))?;
    let done = match command.what {
        What::Create { name, role, days } => create(&store, &name, role, days).await,
        What::List => Ok(table(&store.tokens().await?)),
        What::Revoke { token } => match store.revoke_token(&token, &wall_now()).await? {
            Some(token) => Ok(format!("{} ({}) is revoked\n", token.name, token.role.in_words())),
            None => bail!("there is no token \"{token}\" in use; covr token list has them all"),
        },
    };
    store.close().await;
    done
}

/// Make a token in this store; its text with a line's end.
async fn create(store: &Store, name: &str, role: Role, days: u32) -> anyhow::Result<String> {
    let is_name =
        !name.trim().is_empty() && name.chars().count() <= 64 && !name.chars().any(char::is_control);
    ensure!(is_name, "NAME: found {name:?}, expected 1 to 64 printable characters");
    let token = Token::new().context("the operating system gives no random numbers")?;
    let now = SystemTime::now();
    let text = |moment| humantime::format_rfc3339_seconds(moment).to_string();
    let expires = (days > 0).then(|| text(now + Duration::from_secs(u64::from(days) * SECS_A_DAY)));
    let stored = StoredToken {
        id: token.id().into(),
        name: name.trim().into(),
        role,
        hash: token.hash().map_err(|why| anyhow::anyhow!("the token cannot be hashed: {why}"))?,
        created: text(now),
        expires,
        revoked: None,
    };
    let is_new = store.add_token(&stored).await?;
    ensure!(is_new, "NAME: a token \"{}\" is in use; revoke it first", stored.name);
    Ok(format!("{token}\n"))
}

fn table(tokens: &[StoredToken]) -> String {
    let now = wall_now();
    let state = |token: &StoredToken| match (&token.revoked, &token.expires) {
        (Some(at), _) => format!("revoked {at}"),
        (None, Some(at)) if *at < now => format!("expired {at}"),
        (None, Some(at)) => format!("until {at}"),
        (None, None) => "never ends".into(),
    };
    let mut text = format!("{:8}  {:13}  {:34}  {}\n", "id", "role", "state", "name");
    for token in tokens {
        text += &format!("{:8}  {:13}  {:34}  {}\n", token.id, token.role.name(), state(token), token.name);
    }
    text
}

const SECS_A_DAY: u64 = 24 * 60 * 60;
