//! The arrows between the rooms, held against the code: nothing points up, and the engine stays pure.

use std::path::{Path, PathBuf};
use std::process::Command;

fn top() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Names of every crate that `package` builds with, itself included.
fn dependency_tree(package: &str) -> Vec<String> {
    let output = Command::new(env!("CARGO"))
        .args([
            "tree",
            "--locked",
            "--offline",
            "--edges",
            "normal",
            "--prefix",
            "none",
            "--package",
            package,
        ])
        .current_dir(top())
        .output()
        .expect("cargo tree");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    text.lines().filter_map(|line| line.split(' ').next()).map(str::to_owned).collect()
}

/// Every Rust source below a folder, with its text.
fn sources(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push((path.clone(), std::fs::read_to_string(&path).expect("text")));
        }
    }
    found
}

#[test]
fn the_engine_builds_without_a_runtime_database_socket_serial_line_or_clock() {
    let tree = dependency_tree("covr-engine");
    let banned = [
        "tokio",
        "async-std",
        "mio",
        "futures",
        "axum",
        "hyper",
        "sqlx",
        "rusqlite",
        "tungstenite",
        "socket2",
        "rustix",
        "nix",
        "serial2",
        "serialport",
        "chrono",
        "time",
        "rand",
        "getrandom",
        "serde",
        "rayon",
        "crossbeam",
        "tracing",
    ];
    for name in banned {
        assert!(
            !tree.iter().any(|t| t == name || t.starts_with(&format!("{name}-"))),
            "the engine builds with {name}"
        );
    }
    assert!(tree.iter().any(|t| t == "nalgebra"), "the tree was read: {tree:?}");
}

#[test]
fn nothing_points_up() {
    let above = [
        ("covr-engine", &["covr-wire", "covr-gantry", "covr-study", "covr-server"][..]),
        ("covr-wire", &["covr-gantry", "covr-study", "covr-server", "tokio", "axum", "sqlx"][..]),
        ("covr-gantry", &["covr-wire", "covr-study", "covr-server", "tokio", "axum", "sqlx"][..]),
        ("covr-study", &["covr-server", "tokio", "axum", "sqlx"][..]),
    ];
    for (package, banned) in above {
        let tree = dependency_tree(package);
        for name in banned {
            assert!(!tree.iter().any(|t| t == name), "{package} builds with {name}");
        }
    }
}

#[test]
fn the_engine_reads_no_clock_file_socket_or_random_source_and_starts_no_thread() {
    let banned = [
        "std::time",
        "Instant::",
        "SystemTime",
        "std::fs",
        "std::net",
        "std::thread",
        "std::env",
        "HashSet",
        "RandomState",
    ];
    for (path, text) in sources(&top().join("server/engine/src")) {
        for name in banned {
            assert!(!text.contains(name), "{} names {name}", path.display());
        }
    }
}

#[test]
fn safety_never_imports_intention_or_motion() {
    let mut files = sources(&top().join("server/engine/src/safety"));
    let head = top().join("server/engine/src/safety.rs");
    files.push((head.clone(), std::fs::read_to_string(head).expect("text")));
    for (path, text) in files {
        for name in ["crate::intention", "crate::motion", "super::intention"] {
            assert!(!text.contains(name), "{} imports {name}", path.display());
        }
    }
}

#[test]
fn only_safety_makes_commands() {
    for room in ["engine", "wire", "gantry", "study", "daemon"] {
        for (path, text) in sources(&top().join("server").join(room).join("src")) {
            let inside = path.components().any(|c| c.as_os_str() == "safety");
            assert!(inside || !text.contains("Vetted::new("), "{} makes a command", path.display());
        }
    }
}

#[test]
fn the_server_never_says_that_everything_is_simulated() {
    let study = sources(&top().join("server/study/src"));
    assert!(study.iter().any(|(_, text)| text.contains("WhollySimulated")), "replays say it");
    for room in ["daemon", "gantry", "wire"] {
        for (path, text) in sources(&top().join("server").join(room).join("src")) {
            for name in ["WhollySimulated", "KeptFrom::Nobody", "kept_from()"] {
                assert!(!text.contains(name), "{} names {name}", path.display());
            }
        }
    }
}

#[test]
fn every_test_that_the_hazard_table_names_is_there() {
    let count = tests_named("# Hazards", "| hazard", 4);
    assert!(count > 30, "{count} tests named");
}

#[test]
fn every_test_that_the_table_of_faults_names_is_there() {
    let count = tests_named("Faults around the server", "| fault", 2);
    assert!(count > 13, "{count} tests named");
}

/// How many tests this column of a table in SAFETY.md names. Panics when one is not there, or a row has none.
fn tests_named(section: &str, head: &str, column: usize) -> usize {
    let text = std::fs::read_to_string(top().join("server/SAFETY.md")).expect("SAFETY.md");
    let mut code = sources(&top().join("server"));
    code.extend(sources(&top().join("tests")));
    let is_there = |name: &str| {
        let script = name.starts_with("tests/") && top().join(name).exists();
        script || code.iter().any(|(_, text)| text.contains(&format!("fn {name}(")))
    };
    let table = text.split("\n## ").find(|part| part.starts_with(section)).expect("the section");
    let rows = table.lines().filter(|line| line.starts_with("| ") && !line.starts_with(head));
    let mut count = 0;
    for row in rows {
        let shown_by = row.split(" | ").nth(column).unwrap_or_else(|| panic!("more columns: {row}"));
        let names: Vec<&str> = shown_by.split('`').skip(1).step_by(2).collect();
        assert!(!names.is_empty(), "a row without a test: {row}");
        for name in names {
            assert!(is_there(name), "SAFETY.md names the test {name}, which is not there");
            count += 1;
        }
    }
    count
}

/// The wall clock may jump. It dates the record and ends tokens; what the machine does goes by the monotonic clock alone.
#[test]
fn nothing_that_moves_or_stops_the_machine_goes_by_the_wall_clock() {
    let may_date =
        ["clock.rs", "recording.rs", "sessions.rs", "recordings.rs", "roster.rs", "token_command.rs"];
    for room in ["engine", "wire", "gantry", "study", "daemon"] {
        for (path, text) in sources(&top().join("server").join(room).join("src")) {
            let dates = may_date.iter().any(|name| path.ends_with(name)) && room == "daemon";
            assert!(dates || !text.contains("SystemTime"), "{} goes by the wall clock", path.display());
        }
    }
    for part in ["control.rs", "control", "inputs.rs", "inputs", "ws"] {
        let path = top().join("server/daemon/src").join(part);
        let files = if path.is_dir() {
            sources(&path)
        } else {
            vec![(path.clone(), std::fs::read_to_string(&path).expect("text"))]
        };
        assert!(!files.is_empty(), "{part}");
        for (path, text) in files {
            assert!(!text.contains("wall_now"), "{} goes by the wall clock", path.display());
        }
    }
}
