//! The command line.

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

use crate::cert_command::CertCommand;
use crate::commission::Commission;
use crate::config::LogFormat;
use crate::emulate::EmulateCommand;
use crate::evaluate::Evaluate;
use crate::explain::Explain;
use crate::fit::Fit;
use crate::identify::Identify;
use crate::prove::Prove;
use crate::token_command::TokenCommand;

/// CoVR: the column is there before your hand is.
#[derive(Debug, Parser)]
#[command(name = "covr", version, args_conflicts_with_subcommands = true)]
pub struct Cli {
    /// What to do; serve when nothing is said.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// For serve.
    #[command(flatten)]
    pub serve: Serve,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run the server.
    Serve(Serve),
    /// Check a scene file and say what is wrong with it and what is worth a second look; exit code 1 if anything is wrong.
    Check(Check),
    /// Play a person as a VR client: recorded with --trace, else made up.
    Visitor(Visitor),
    /// Walk through the first motion of a machine on a running server: the wired stop, directions, the software stop, the brake.
    Commission(Commission),
    /// Replay recorded people on virtual time and say how often the column was there before the hand.
    Evaluate(Box<Evaluate>),
    /// Say in words what happened in one recorded reach, and draw it.
    Explain(Box<Explain>),
    /// Fit the parameters of an intention rule to recorded people, and judge them on people left out.
    Fit(Fit),
    /// Work out an axis's inertia, friction, limits and delays from a recorded run of it.
    Identify(Identify),
    /// Try to have the machine break the separation rule in random worlds; exit code 1 if it ever does.
    Prove(Prove),
    /// Make, list and take back the tokens that people and programs sign in with.
    Token(TokenCommand),
    /// Make a local authority and a certificate for TLS.
    Cert(CertCommand),
    /// Emulate hardware, for trying a driver without any.
    Emulate(EmulateCommand),
    /// Ask a running server whether it is ready; exit code 2 if it is not.
    Health(Health),
    /// Print every configuration key with its default and its meaning.
    Config,
}

/// Run the server.
#[derive(Debug, Clone, Args)]
pub struct Serve {
    /// Configuration file (TOML); every key has a default.
    #[arg(long, env = "COVR_CONFIG")]
    pub config: Option<PathBuf>,
    /// Address and port to listen on, instead of server.bind.
    #[arg(long)]
    pub bind: Option<SocketAddr>,
    /// Database file, instead of server.database.
    #[arg(long)]
    pub database: Option<PathBuf>,
    /// Let the network reach a server without tokens and TLS, as server.insecure_lan = true: with the simulated machine alone.
    #[arg(long)]
    pub insecure_lan: bool,
    /// Log lines as text or JSON, instead of log.format.
    #[arg(long, value_enum)]
    pub log_format: Option<LogFormat>,
}

/// Check a scene file.
#[derive(Debug, Clone, Args)]
pub struct Check {
    /// The scene.
    pub scene: PathBuf,
    /// Say it as JSON on standard output, with the seconds that the column needs from each object to each other.
    #[arg(long)]
    pub json: bool,
}

/// Ask a running server.
#[derive(Debug, Clone, Args)]
pub struct Health {
    /// The server.
    #[arg(long, default_value = "http://127.0.0.1:7878")]
    pub url: String,
    /// The authority of the server's certificate (PEM), for https.
    #[arg(long)]
    pub authority: Option<PathBuf>,
}

/// Play a person.
#[derive(Debug, Clone, Args)]
pub struct Visitor {
    /// A recording (.jsonl, .jsonl.gz) or a folder of them.
    #[arg(long)]
    pub trace: Option<PathBuf>,
    /// How much faster than real; the clock of the poses runs along.
    #[arg(long, default_value_t = 1.0, value_parser = speed)]
    pub speed: f64,
    /// The server.
    #[arg(long, default_value = "ws://127.0.0.1:7878")]
    pub url: String,
    /// The token that it signs in with, where the server has tokens.
    #[arg(long, env = "COVR_TOKEN", hide_env_values = true)]
    pub token: Option<String>,
    /// The authority of the server's certificate (PEM), for wss and https.
    #[arg(long)]
    pub authority: Option<PathBuf>,
    /// What the client calls itself and its person.
    #[arg(long, default_value = "visitor")]
    pub name: String,
    /// Seed of the person made up.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// The trial to begin with: its number from 1, or its id.
    #[arg(long)]
    pub trial: Option<String>,
    /// Wait until the server answers.
    #[arg(long)]
    pub wait_for_server: bool,
    /// Home and arm first: with the simulated machine alone.
    #[arg(long)]
    pub arm: bool,
}

fn speed(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(speed) if (0.05..=20.0).contains(&speed) => Ok(speed),
        _ => Err("expected a number from 0.05 to 20".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn serve_is_the_default_command() {
        let cli = Cli::parse_from(["covr", "--bind", "127.0.0.1:9000"]);
        assert!(cli.command.is_none());
        assert_eq!(cli.serve.bind.map(|bind| bind.port()), Some(9000));
        assert!(Cli::try_parse_from(["covr", "visitor", "--speed", "0"]).is_err());
    }
}
