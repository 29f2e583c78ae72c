//! What is looked at before the machine is armed: the scene's own list, else the usual one; who ticked what. Ticks are for the next
//! start alone: they end with the session, and with another scene.

use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Serialize};
use ts_rs::TS;
use utoipa::ToSchema;

use crate::clock::wall_now;

/// The list as it stands.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema, TS)]
pub struct ChecklistNow {
    /// It is the scene's own.
    pub of_scene: bool,
    /// In the list's order.
    pub items: Vec<ChecklistItem>,
}

/// One thing to look at.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema, TS)]
pub struct ChecklistItem {
    /// What, in words.
    pub text: String,
    /// The same as an id, where it is of the usual list.
    pub id: Option<String>,
    /// Who ticked it; null while nobody has.
    pub ticked_by: Option<String>,
    /// When, RFC 3339.
    pub ticked_at: Option<String>,
}

/// For which start ticks count: scene, version, and the newest session that has ended.
pub type Start = (i64, i64, Option<i64>);

/// The ticks of the next start.
#[derive(Debug, Default)]
pub struct Checklist {
    ticks: Mutex<Ticks>,
}

#[derive(Debug, Default)]
struct Ticks {
    of: Option<Start>,
    /// Who and when, by item.
    by_item: Vec<Option<(String, String)>>,
}

impl Checklist {
    /// The list for a start, with its ticks.
    pub fn now(&self, start: Start, of_scene: &[String]) -> ChecklistNow {
        self.with(start, of_scene, |_| ())
    }

    /// Tick an item, or take its tick back; `None` where there is no such item.
    pub fn tick(
        &self,
        start: Start,
        of_scene: &[String],
        item: usize,
        by: Option<&str>,
    ) -> Option<ChecklistNow> {
        let mut is_there = false;
        let now = self.with(start, of_scene, |ticks| {
            if let Some(tick) = ticks.get_mut(item) {
                *tick = by.map(|by| (by.to_owned(), wall_now()));
                is_there = true;
            }
        });
        is_there.then_some(now)
    }

    fn with(
        &self,
        start: Start,
        of_scene: &[String],
        change: impl FnOnce(&mut Vec<Option<(String, String)>>),
    ) -> ChecklistNow {
        let texts: Vec<(Option<&str>, &str)> = if of_scene.is_empty() {
            USUAL.iter().map(|(id, text)| (Some(*id), *text)).collect()
        } else {
            of_scene.iter().map(|text| (None, text.as_str())).collect()
        };
        let mut ticks = self.ticks.lock().unwrap_or_else(PoisonError::into_inner);
        if ticks.of != Some(start) {
            *ticks = Ticks { of: Some(start), by_item: Vec::new() };
        }
        ticks.by_item.resize(texts.len(), None);
        change(&mut ticks.by_item);
        let items = texts.into_iter().zip(&ticks.by_item).map(|((id, text), tick)| {
            let (ticked_by, ticked_at) = tick.clone().unzip();
            ChecklistItem { text: text.into(), id: id.map(Into::into), ticked_by, ticked_at }
        });
        ChecklistNow { of_scene: !of_scene.is_empty(), items: items.collect() }
    }
}

/// What is looked at where a scene says nothing of its own.
const USUAL: [(&str, &str); 6] = [
    ("stop_in_reach", "The stop is in reach and was tried today"),
    ("arena_clear", "Nobody and nothing stands in the arena that should not"),
    ("props_mounted", "Every prop of the scene hangs on the column, and is fixed"),
    ("headset_fits", "The headset is tracked, and its picture and the room agree at a mark"),
    ("visitor_told", "The visitor knows how to stop, and that something moves near them"),
    ("scene_right", "The scene on this page is the one that is to be played"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_end_with_the_start_that_they_are_for() {
        let list = Checklist::default();
        let ticked = |now: &ChecklistNow| now.items.iter().filter(|item| item.ticked_by.is_some()).count();
        let now = list.tick((1, 1, None), &[], 2, Some("Ada")).unwrap();
        assert_eq!((ticked(&now), now.items[2].ticked_by.as_deref(), now.of_scene), (1, Some("Ada"), false));
        assert_eq!(ticked(&list.now((1, 1, None), &[])), 1, "they stay while nothing else begins");
        assert_eq!(ticked(&list.tick((1, 1, None), &[], 2, None).unwrap()), 0, "a tick is taken back");
        list.tick((1, 1, None), &[], 0, Some("Bo")).unwrap();
        assert_eq!(ticked(&list.now((1, 1, Some(4)), &[])), 0, "a session has ended");
        list.tick((1, 1, Some(4)), &[], 0, Some("Bo")).unwrap();
        assert_eq!(ticked(&list.now((1, 2, Some(4)), &[])), 0, "another version is played");
    }

    #[test]
    fn a_scene_has_its_own_list_and_no_other_items() {
        let list = Checklist::default();
        let own = ["The fan is on".to_owned()];
        let now = list.now((1, 1, None), &own);
        assert_eq!((now.items.len(), now.items[0].id.as_deref(), now.of_scene), (1, None, true));
        assert_eq!(list.tick((1, 1, None), &own, 1, Some("Ada")), None);
    }
}
