//! `covr token` on a database of its own.

use std::path::Path;
use std::process::{Command, Output};

use covr_tests::process::program;
use tempfile::TempDir;

fn token(dir: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(program());
    command.arg("token").args(arguments).arg("--database").arg(dir.join("covr.sqlite"));
    command.output().unwrap()
}

fn said(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).unwrap()
}

#[test]
fn a_token_is_shown_once_stored_as_a_hash_and_taken_back_by_its_name() {
    let dir = TempDir::new().unwrap();
    let made = said(&token(dir.path(), &["create", "front desk", "--role", "game_master"]));
    let id = made.strip_prefix("covr_").and_then(|rest| rest.split('_').next()).unwrap();
    let secret = made.trim().rsplit('_').next().unwrap();
    assert_eq!((id.len(), secret.len()), (8, 64), "{made}");

    let listed = said(&token(dir.path(), &["list"]));
    assert!(listed.contains(id) && listed.contains("game_master") && listed.contains("until 20"), "{listed}");
    assert!(!listed.contains(secret), "{listed}");
    let stored = [dir.path().join("covr.sqlite"), dir.path().join("covr.sqlite-wal")];
    let stored: Vec<u8> = stored.iter().filter_map(|path| std::fs::read(path).ok()).flatten().collect();
    let has = |text: &str| stored.windows(text.len()).any(|bytes| bytes == text.as_bytes());
    assert!(has(id) && has("$argon2id$") && !has(secret));

    let taken = token(dir.path(), &["create", "front desk", "--role", "observer"]);
    let words = String::from_utf8_lossy(&taken.stderr).into_owned();
    assert!(taken.status.code() == Some(2) && words.contains("\"front desk\" is in use"), "{words}");
    said(&token(dir.path(), &["revoke", "front desk"]));
    assert!(said(&token(dir.path(), &["list"])).contains("revoked 20"));
    let again = token(dir.path(), &["revoke", "front desk"]);
    assert!(String::from_utf8_lossy(&again.stderr).contains("no token \"front desk\" in use"));
    said(&token(dir.path(), &["create", "front desk", "--role", "observer", "--days", "0"]));
    assert!(said(&token(dir.path(), &["list"])).contains("never ends"));
}
