//! The covr binary: reads the command line and the configuration, and leaves with a code.

use std::io::Write;
use std::process::ExitCode;
use std::time::Duration;

use anyhow::Context;
use clap::Parser;
use covr_engine::placing::serve_secs;
use covr_server::cli::{Check, Cli, Command, Health, Serve, Visitor};
use covr_server::commission::{self, Commission};
use covr_server::config::{self, Config};
use covr_server::prove::Prove;
use covr_server::serve::{Server, stop_at_signal, stop_signal, told_by_signal};
use covr_server::visitor::credentials::Credentials;
use covr_server::{
    cert_command, emulate, evaluate, explain, fit, identify, logs, prove, token_command, visitor,
};
use covr_wire::scene::{parse_scene, scene_warnings};

fn main() -> ExitCode {
    let cli = Cli::parse();
    let done = match cli.command.unwrap_or(Command::Serve(cli.serve)) {
        Command::Serve(options) => serve(options),
        Command::Check(options) => return check(&options),
        Command::Visitor(options) => visit(options),
        Command::Commission(options) => first_motion(&options),
        Command::Evaluate(options) => evaluate::run(&options).and_then(|table| print(&table)),
        Command::Explain(options) => explain::run(&options).and_then(|words| print(&words)),
        Command::Fit(options) => fit::run(&options).and_then(|report| print(&report)),
        Command::Identify(options) => identify::run(&options).and_then(|words| print(&words)),
        Command::Prove(options) => return attempt(&options),
        Command::Token(options) => runtime()
            .and_then(|runtime| runtime.block_on(token_command::run(options)))
            .and_then(|words| print(&words)),
        Command::Cert(options) => cert_command::run(&options).and_then(|words| print(&words)),
        Command::Emulate(options) => emulate::run(&options),
        Command::Health(options) => health(&options),
        Command::Config => print(&config::reference(&Config::default())),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            complain(&format!("covr: {error:#}"));
            ExitCode::from(FAILED)
        }
    }
}

fn serve(options: Serve) -> anyhow::Result<()> {
    let mut loaded = config::load(options.config.as_deref(), std::env::vars())?;
    loaded.set_by_command_line("server.bind", options.bind, |c| &mut c.server.bind);
    loaded.set_by_command_line("server.database", options.database, |c| &mut c.server.database);
    let insecure_lan = options.insecure_lan.then_some(true);
    loaded.set_by_command_line("server.insecure_lan", insecure_lan, |c| &mut c.server.insecure_lan);
    loaded.set_by_command_line("log.format", options.log_format, |c| &mut c.log.format);
    let _logs = logs::start(&loaded.config.log)?;
    runtime()?.block_on(async {
        // Before anybody can know of the server: without a listener the signal would end the process.
        let (presses, told) = (stop_signal()?, told_by_signal());
        let server = Server::start(loaded).await?;
        tokio::spawn(stop_at_signal(server.app().clone(), presses));
        server.run_until(told).await
    })
}

fn visit(options: Visitor) -> anyhow::Result<()> {
    let _logs = logs::start(&Config::default().log)?;
    runtime()?.block_on(async {
        tokio::select! {
            done = visitor::run(options) => done,
            _ = told_by_signal() => Ok(()),
        }
    })
}

fn first_motion(options: &Commission) -> anyhow::Result<()> {
    runtime()?.block_on(async {
        tokio::select! {
            done = commission::run(options) => done,
            _ = told_by_signal() => anyhow::bail!("not commissioned: ended by a signal"),
        }
    })
}

fn health(options: &Health) -> anyhow::Result<()> {
    let url = format!("{}/readyz", options.url.trim_end_matches('/'));
    let credentials = Credentials::new(None, options.authority.as_deref())?;
    let answer = runtime()?.block_on(async {
        let client = credentials.http().timeout(LONGEST_HEALTH_CALL).build()?;
        client.get(&url).send().await?.error_for_status()
    });
    answer.with_context(|| format!("{url}: not ready"))?;
    print("ready\n")
}

fn attempt(options: &Prove) -> ExitCode {
    let found = prove::run(options).and_then(|findings| print(&findings.to_string()).map(|()| findings));
    match found {
        Ok(findings) if findings.violations == 0 => ExitCode::SUCCESS,
        Ok(_) => ExitCode::from(FAILED),
        Err(error) => {
            complain(&format!("covr: {error:#}"));
            ExitCode::from(FAILED)
        }
    }
}

fn check(options: &Check) -> ExitCode {
    let name = options.scene.display();
    let text = match std::fs::read(&options.scene) {
        Ok(text) => text,
        Err(error) => {
            complain(&format!("{name}: {error}"));
            return ExitCode::from(FAILED);
        }
    };
    let machine = Config::default().machine;
    let read = parse_scene(&text);
    let warnings = read
        .as_ref()
        .map_or_else(|_| Vec::new(), |(_, scene)| scene_warnings(&text, scene, &machine.travel()));
    let code = if read.is_ok() { ExitCode::SUCCESS } else { ExitCode::from(INVALID) };
    if options.json {
        let secs = read.as_ref().ok().map(|(_, scene)| serve_secs(scene, &machine.limits()));
        let (document, errors) = match read {
            Ok((document, _)) => (Some(document), Vec::new()),
            Err(errors) => (None, errors),
        };
        let said = serde_json::json!({
            "scene": name.to_string(),
            "valid": document.is_some(),
            "name": document.as_ref().map(|document| &document.name),
            "objects": document.as_ref().map(|document| document.objects.len()),
            "serve_secs": secs,
            "errors": errors,
            "warnings": warnings,
        });
        return print(&format!("{said:#}\n")).map_or(ExitCode::from(FAILED), |()| code);
    }
    match read {
        Ok((document, _)) => {
            for warning in &warnings {
                complain(&format!("{name}: warning: {warning}"));
            }
            let objects = document.objects.len();
            let states =
                document.scenario.map_or_else(String::new, |s| format!(", {} states", s.states.len()));
            let _ = print(&format!("{name}: \"{}\" is good: {objects} objects{states}\n", document.name));
        }
        Err(errors) => errors.iter().for_each(|error| complain(&format!("{name}: {error}"))),
    }
    code
}

fn runtime() -> anyhow::Result<tokio::runtime::Runtime> {
    tokio::runtime::Builder::new_multi_thread().enable_all().build().context("the asynchronous runtime")
}

fn print(text: &str) -> anyhow::Result<()> {
    Ok(std::io::stdout().lock().write_all(text.as_bytes())?)
}

fn complain(text: &str) {
    // With standard error closed there is nobody to tell; the exit code still says it.
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// A server that does not answer within this is not ready.
const LONGEST_HEALTH_CALL: Duration = Duration::from_secs(2);
/// A scene or a file is not good.
const INVALID: u8 = 1;
/// The command could not do its work.
const FAILED: u8 = 2;
