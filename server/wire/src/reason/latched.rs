//! What a latched stop leaves for the next run: its rule and its reason, as one text that the engine hands on unread.

use covr_engine::reason::Reason as Engine;
use covr_engine::snapshot::RuleId;
use serde::{Deserialize, Serialize};

use super::Reason;

#[derive(Serialize, Deserialize)]
struct Record {
    rule: String,
    because: Reason,
}

/// What to keep of a latched stop; `because` is `reason` as the wire has it. A stop that the run before had left is kept
/// as it was.
pub fn latch_record(rule: Option<RuleId>, reason: &Engine, because: Reason) -> String {
    if let Engine::LastRunLatched(record) = reason {
        return record.clone();
    }
    let record = Record { rule: rule.map_or_else(String::new, RuleId::name), because };
    // Names, numbers and texts always have a JSON form; without one the next run is latched all the same.
    serde_json::to_string(&record).unwrap_or_default()
}

/// The record of the run before, read; one that an earlier version wrote begins with its rule: "R4: software stop".
pub fn last_run(record: &str) -> Reason {
    match serde_json::from_str(record) {
        Ok(Record { rule, because }) => Reason::LastRunLatched {
            rule: Some(rule).filter(|rule| !rule.is_empty()),
            because: Some(Box::new(because)),
        },
        Err(_) => {
            let rule = record.split_once(": ").map(|(rule, _)| rule.to_owned());
            Reason::LastRunLatched { rule: rule.filter(|rule| is_rule(rule)), because: None }
        }
    }
}

fn is_rule(text: &str) -> bool {
    text.strip_prefix('R').is_some_and(|number| number.parse::<u8>().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_latched_stop_is_told_by_the_next_run_and_the_one_after() {
        let because = Reason::SoftwareStop { said: Some("hand in the way".into()) };
        let reason = Engine::SoftwareStop("hand in the way".into());
        let record = latch_record(Some(RuleId(4)), &reason, because.clone());
        let told = last_run(&record);
        let rule = Some("R4".to_owned());
        assert_eq!(told, Reason::LastRunLatched { rule, because: Some(Box::new(because)) });
        assert_eq!(latch_record(Some(RuleId(4)), &Engine::LastRunLatched(record.clone()), told), record);
    }

    #[test]
    fn a_record_of_an_earlier_version_tells_its_rule() {
        let told = |record| last_run(record).to_string();
        assert_eq!(told("R2: the pose is old"), "the last run ended in a latched stop: R2");
        assert_eq!(told("stopped: so"), "the last run ended in a latched stop");
        assert_eq!(told(""), "the last run ended in a latched stop");
    }
}
