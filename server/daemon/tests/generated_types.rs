//! The TypeScript types of HTTP answers that the web builds against are the ones that the server serialises.
//!
//! `COVR_UPDATE_TYPES=1 cargo nextest run -p covr-server generated_types` rewrites them.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use covr_server::checklist::ChecklistNow;
use covr_server::config;
use covr_server::http::{Answered, Me, PriorsPreview, Problem, SceneChecked, SceneStored, StopAcknowledged};
use ts_rs::{Config, TS};

#[test]
fn the_committed_types_of_answers_are_the_generated_ones() {
    let generated = generate();
    let committed_in = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../web/src/api/answers");
    if std::env::var_os("COVR_UPDATE_TYPES").is_some() {
        if committed_in.exists() {
            fs::remove_dir_all(&committed_in).expect("the stale files removed");
        }
        fs::create_dir_all(&committed_in).expect("the web's folder");
        for (name, text) in &generated {
            fs::write(committed_in.join(name), text).expect("a file written");
        }
    }
    let committed = read(&committed_in);
    assert_eq!(committed, generated, "run again with COVR_UPDATE_TYPES=1 and commit");
}

/// Every file by name. 64-bit integers are `number`: microseconds and row numbers stay far below 2^53.
fn generate() -> BTreeMap<String, String> {
    let out = tempfile::tempdir().expect("a temporary directory");
    let config = Config::new().with_large_int("number").with_out_dir(out.path());
    Answered::export_all(&config).expect("what came of a request");
    StopAcknowledged::export_all(&config).expect("a stop");
    SceneStored::export_all(&config).expect("a stored scene");
    SceneChecked::export_all(&config).expect("a checked scene");
    ChecklistNow::export_all(&config).expect("the checklist");
    Problem::export_all(&config).expect("a problem");
    Me::export_all(&config).expect("who I am");
    PriorsPreview::export_all(&config).expect("a preview");
    let mut files = read(out.path());
    files.insert("configKeys.json".into(), config_keys());
    files
}

/// Every configuration key with its meaning, for the test of the page's French catalogue.
fn config_keys() -> String {
    let keys: BTreeMap<_, _> = config::keys().into_iter().map(|key| (key.name, key.meaning)).collect();
    format!("{}\n", serde_json::to_string_pretty(&keys).expect("texts as JSON"))
}

fn read(folder: &Path) -> BTreeMap<String, String> {
    let Ok(entries) = fs::read_dir(folder) else { return BTreeMap::new() };
    entries
        .map(|entry| {
            let path = entry.expect("a readable folder").path();
            let name = path.file_name().expect("a file").to_string_lossy().into_owned();
            (name, fs::read_to_string(path).expect("a text file"))
        })
        .collect()
}
