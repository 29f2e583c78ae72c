//! Builds the dashboard into OUT_DIR/web, to be embedded. Without Node, without `web`, or with COVR_SKIP_WEB=1
//! it makes one page that says how to build the dashboard.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let out = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default()).join("web");
    // As it is when this runs: a target directory may serve several clones.
    let web = Path::new(&env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default()).join(WEB);
    println!("cargo::rerun-if-env-changed=COVR_SKIP_WEB");
    println!("cargo::rerun-if-env-changed=COVR_COMMIT");
    say_what_builds();
    for input in INPUTS {
        println!("cargo::rerun-if-changed={WEB}/{input}");
    }
    fs::create_dir_all(&out)?;
    let skipped = env::var_os("COVR_SKIP_WEB").is_some_and(|value| value != "0");
    let why_not = if skipped {
        "COVR_SKIP_WEB was set"
    } else if !web.join("package.json").exists() {
        "the folder web is missing"
    } else if !runs(Command::new("npm").arg("--version")) {
        "npm was not found"
    } else if !install(&web) {
        println!("cargo::warning=npm ci failed: the dashboard is not built");
        "npm ci failed"
    } else if !runs(
        Command::new("npx").args(["vite", "build", "--emptyOutDir", "--outDir"]).arg(&out).current_dir(&web),
    ) {
        println!("cargo::warning=vite build failed: the dashboard is not built");
        "vite build failed"
    } else {
        return Ok(());
    };
    fs::write(out.join("index.html"), PAGE.replace("WHY", why_not))
}

/// For `GET /api/v1/config`.
fn say_what_builds() {
    let rustc = env::var_os("RUSTC").map(|rustc| Command::new(rustc).arg("--version").output());
    let rustc =
        rustc.and_then(Result::ok).and_then(|done| String::from_utf8(done.stdout).ok()).unwrap_or_default();
    println!("cargo::rustc-env=COVR_RUSTC={}", rustc.trim());
    println!("cargo::rustc-env=COVR_TARGET={}", env::var("TARGET").unwrap_or_default());
}

/// `npm ci` when the lock file is newer than the last one.
fn install(web: &Path) -> bool {
    let stamp = web.join("node_modules/.covr-installed");
    let changed =
        |path: &Path| fs::metadata(path).and_then(|m| m.modified()).unwrap_or(SystemTime::UNIX_EPOCH);
    let lock = web.join("package-lock.json");
    if stamp.exists() && changed(&stamp) >= changed(&lock) {
        return true;
    }
    runs(Command::new("npm").args(["ci", "--no-audit", "--no-fund"]).current_dir(web))
        && fs::write(&stamp, "").is_ok()
}

fn runs(command: &mut Command) -> bool {
    command.output().is_ok_and(|done| {
        if !done.status.success() {
            for line in String::from_utf8_lossy(&done.stderr).lines().take(20) {
                println!("cargo::warning={line}");
            }
        }
        done.status.success()
    })
}

/// From this package.
const WEB: &str = "../../web";
const INPUTS: [&str; 9] = [
    "src",
    "public",
    "index.html",
    "package.json",
    "package-lock.json",
    "vite.config.ts",
    "tsconfig.json",
    "docs.html",
    "examples",
];

const PAGE: &str = r#"<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>CoVR: dashboard not built</title>
<h1>The dashboard is not in this build</h1>
<p>WHY. The server itself runs: its API is described at <a href="/api/v1/openapi.json">/api/v1/openapi.json</a>.</p>
<p>To build the dashboard, install Node 20 or newer with npm, then build the server again:</p>
<pre>cargo build -p covr-server</pre>
<p><strong>No stop button here.</strong> Use the wired stop, or: <code>curl -X POST http://127.0.0.1:7878/api/v1/stop</code></p>
"#;
