//! The corpora of `fuzz/`, through the functions that are fuzzed, on the stable compiler.

#[path = "../../fuzz/src/lib.rs"]
mod fuzz;

use std::path::Path;

/// Every input of a corpus; panics with its name.
fn corpus(name: &str, target: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(name);
    let mut count = 0;
    for entry in std::fs::read_dir(&folder).unwrap_or_else(|why| panic!("{}: {why}", folder.display())) {
        let path = entry.expect("an entry").path();
        eprintln!("{}", path.display());
        target(&std::fs::read(&path).expect("an input"));
        count += 1;
    }
    assert!(count >= 3, "{count} inputs of {name}");
}

#[test]
fn no_frame_of_the_corpus_breaks_the_clients_decoder() {
    corpus("client_decoder", fuzz::client_decoder);
}

#[test]
fn no_text_of_the_corpus_breaks_the_scene_parser() {
    corpus("scene_parser", fuzz::scene_parser);
}

#[test]
fn no_text_of_the_corpus_breaks_the_trace_reader() {
    corpus("trace_reader", fuzz::trace_reader);
}

#[test]
fn no_order_of_events_of_the_corpus_breaks_the_supervisor() {
    corpus("supervisor", fuzz::supervisor);
}
