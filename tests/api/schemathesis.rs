//! An outside scanner against the published contract: no server error, no status and no body that is not documented.

use std::path::PathBuf;
use std::process::Command;

use covr_server::access::Role;
use covr_tests::server::TestServer;

#[tokio::test(flavor = "multi_thread")]
async fn a_scanner_finds_no_server_error_and_nothing_undocumented() {
    let Some(scanner) = scanner() else { return };
    let server = TestServer::start_with(|config| config.server.requests_per_sec = 100_000).await;
    let token = server.token(Role::Administrator).await;
    let folder = tempfile::TempDir::new().unwrap();
    let url = format!("http://{}/api/v1/openapi.json", server.host);
    let header = format!("Authorization: Bearer {token}");
    let mut command = Command::new(scanner);
    command.current_dir(folder.path()).args(["run", &url, "--header", &header]);
    command.args(["--checks", CHECKS, "--phases", "examples,coverage,fuzzing", "--max-examples", "10"]);
    command.args([
        "--seed",
        "1",
        "--generation-deterministic",
        "--request-timeout",
        "15",
        "--max-redirects",
        "0",
    ]);
    // A token that is taken back ends the scan, and a socket is no answer.
    command.args(["--exclude-path-regex", "^/ws/|^/api/v1/tokens/|^/api/v1/logout"]);
    let done = tokio::task::spawn_blocking(move || command.output().unwrap()).await.unwrap();
    let said = String::from_utf8_lossy(&done.stdout).into_owned();
    assert!(done.status.success(), "{said}\n{}", String::from_utf8_lossy(&done.stderr));
    let number_after = |word: &str| {
        let rest = said.split(word).nth(1)?;
        rest.trim_start().split(|c: char| !c.is_ascii_digit()).next()?.parse::<usize>().ok()
    };
    let (tested, all) = (number_after("Tested:"), number_after("selected /"));
    assert!(
        tested.zip(all).is_some_and(|(tested, all)| tested + 4 == all),
        "every operation but four: {said}"
    );
}

/// The scanner that `tests/setup` installs beside the examples' Python; without it the test is skipped, but on CI.
fn scanner() -> Option<PathBuf> {
    let python = std::env::var_os("COVR_PYTHON").map(PathBuf::from);
    let found =
        python.and_then(|python| Some(python.parent()?.join("schemathesis"))).filter(|path| path.exists());
    if found.is_none() {
        assert!(std::env::var_os("CI").is_none(), "schemathesis is missing: run tests/setup");
        eprintln!(
            "SKIPPED a_scanner_finds_no_server_error_and_nothing_undocumented: schemathesis is missing (tests/setup)"
        );
    }
    found
}

const CHECKS: &str =
    "not_a_server_error,status_code_conformance,content_type_conformance,response_schema_conformance";
