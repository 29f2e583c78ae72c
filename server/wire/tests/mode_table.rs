//! The table of modes in `server/SAFETY.md` is the one that the engine goes by, in the words of the wire.
//!
//! `COVR_UPDATE_SAFETY=1 cargo nextest run -p covr-wire --test mode_table` rewrites it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use covr_engine::mode::{Conditions, Mode, RequestKind, Response, Trigger, react, respond};
use covr_engine::reason::Reason as Engine;
use covr_wire::reason::Reason;

#[test]
fn the_committed_table_is_the_generated_one() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../SAFETY.md");
    let text = fs::read_to_string(&path).expect("SAFETY.md");
    let (before, rest) = text.split_once(BEGIN).expect("the table's first mark");
    let (committed, after) = rest.split_once(END).expect("the table's last mark");
    let generated = format!("\n{}\n{}", requests(), triggers());
    if std::env::var_os("COVR_UPDATE_SAFETY").is_some() {
        fs::write(&path, [before, BEGIN, &generated, END, after].concat()).expect("SAFETY.md written");
    } else {
        assert_eq!(committed, generated, "run again with COVR_UPDATE_SAFETY=1 and commit");
    }
}

fn requests() -> String {
    table(&RequestKind::ALL.map(|request| request.name()), |mode| {
        RequestKind::ALL.iter().map(|request| response_cell(mode, *request)).collect()
    })
}

fn triggers() -> String {
    table(&Trigger::ALL.map(trigger_in_words), |mode| {
        Trigger::ALL.iter().map(|trigger| trigger_cell(mode, *trigger)).collect()
    })
}

fn table(columns: &[&str], cells: impl Fn(Mode) -> Vec<String>) -> String {
    let row = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let head: Vec<_> = std::iter::once("mode").chain(columns.iter().copied()).map(str::to_owned).collect();
    let mut text = row(&head) + &format!("|{}\n", "---|".repeat(head.len()));
    for mode in Mode::ALL {
        let mut line = vec![format!("`{}`", mode.name())];
        line.extend(cells(mode));
        text.push_str(&row(&line));
    }
    text
}

/// What is answered when nothing stands against it, then what each condition changes.
fn response_cell(mode: Mode, request: RequestKind) -> String {
    let good = Conditions { homed: true, moves: false, game_master_absent: false, cause_still_there: None };
    let usual = response(mode, request, &good);
    let mut text = usual.clone();
    for (condition, conditions) in [
        ("moves", Conditions { moves: true, ..good.clone() }),
        ("not homed", Conditions { homed: false, ..good.clone() }),
        ("no game master where one is needed", Conditions { game_master_absent: true, ..good.clone() }),
        ("cause there", Conditions { cause_still_there: Some(still_there()), ..good.clone() }),
    ] {
        let other = response(mode, request, &conditions);
        if other != usual {
            text.push_str(&format!("; {condition}: {other}"));
        }
    }
    text
}

fn response(mode: Mode, request: RequestKind, conditions: &Conditions) -> String {
    match respond(mode, request, conditions) {
        Response::Go(to) => format!("**{}**", to.name()),
        Response::AlreadySo(reason) => format!("so already: `{}`", id(&reason)),
        Response::Refuse(reason) => format!("refused: `{}`", id(&reason)),
    }
}

fn trigger_cell(mode: Mode, trigger: Trigger) -> String {
    let to = |resumes| react(mode, trigger, resumes);
    match (to(Mode::Following), to(Mode::Homing)) {
        (None, None) => "stays".into(),
        (Some(one), Some(other)) if one == other => format!("**{}**", one.name()),
        _ => "back to where it came from: **following** or **homing**".into(),
    }
}

fn trigger_in_words(trigger: Trigger) -> &'static str {
    match trigger {
        Trigger::ProtectiveDemand => "a rule demands a protective stop",
        Trigger::DemandGone => "no rule has for 1 s",
        Trigger::LatchedDemand => "a rule demands a latched stop",
        Trigger::Fault => "R8 is breached",
        Trigger::Homed => "homed, at rest",
        Trigger::HomeLost => "home lost",
    }
}

fn still_there() -> Engine {
    let because = Box::new(Engine::NoAnswerYet);
    Engine::CauseStillThere { rule: covr_engine::snapshot::RuleId(8), because }
}

/// The id on the wire.
fn id(reason: &Engine) -> String {
    let wire = serde_json::to_value(Reason::new(reason, &BTreeMap::new())).expect("a reason as JSON");
    wire["id"].as_str().expect("an id").to_owned()
}

const BEGIN: &str = "<!-- generated: modes -->";
const END: &str = "<!-- end of generated: modes -->";
