//! Who is who: a person is known by the client's name and the client's own name for them, and keeps one
//! number for the run of the server, also across a lost connection.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, MutexGuard, PoisonError};

use covr_engine::observation::PersonId;

/// Everybody of this run.
#[derive(Debug, Default)]
pub struct Persons {
    known: Mutex<Known>,
}

/// How a person came in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Entry {
    /// Not in the arena before.
    New(PersonId),
    /// In the arena all along; their client had gone.
    Back(PersonId),
}

/// Another live connection speaks for this person.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("person \"{person}\" of client \"{client}\" is already connected")]
pub struct Taken {
    client: String,
    person: String,
}

#[derive(Debug, Default)]
struct Known {
    next: u32,
    inside: BTreeMap<(String, String), Inside>,
    names: BTreeMap<PersonId, String>,
    /// Objects under hands, as their clients say.
    touches: BTreeMap<PersonId, BTreeSet<String>>,
}

#[derive(Debug, Clone, Copy)]
struct Inside {
    id: PersonId,
    connected: bool,
}

impl Persons {
    /// A person enters, or their client is back.
    pub fn enter(&self, client: &str, person: &str) -> Result<Entry, Taken> {
        let mut known = self.known();
        let key = (client.to_owned(), person.to_owned());
        if let Some(inside) = known.inside.get_mut(&key) {
            if inside.connected {
                return Err(Taken { client: key.0, person: key.1 });
            }
            inside.connected = true;
            return Ok(Entry::Back(inside.id));
        }
        known.next += 1;
        let id = PersonId(known.next);
        known.names.insert(id, person.to_owned());
        known.inside.insert(key, Inside { id, connected: true });
        Ok(Entry::New(id))
    }

    /// A person left the arena.
    pub fn leave(&self, id: PersonId) {
        let mut known = self.known();
        known.inside.retain(|_, inside| inside.id != id);
        known.touches.remove(&id);
    }

    /// The client of a person is gone; the person is still there.
    pub fn disconnect(&self, id: PersonId) {
        for inside in self.known().inside.values_mut().filter(|inside| inside.id == id) {
            inside.connected = false;
        }
    }

    /// What the client calls this person.
    pub fn name(&self, id: PersonId) -> String {
        self.known().names.get(&id).cloned().unwrap_or_else(|| format!("person {}", id.0))
    }

    /// The names of everybody of this run.
    pub fn names(&self) -> BTreeMap<PersonId, String> {
        self.known().names.clone()
    }

    /// A person's hand met an object, or let go of it.
    pub fn touches(&self, id: PersonId, object: &str, begins: bool) {
        let mut known = self.known();
        let touched = known.touches.entry(id).or_default();
        if begins {
            touched.insert(object.to_owned());
        } else {
            touched.remove(object);
        }
    }

    /// Somebody who touches an object now, and the object.
    pub fn touch(&self) -> Option<(String, String)> {
        let known = self.known();
        let mut touches = known.touches.iter();
        touches.find_map(|(id, objects)| Some((known.names.get(id)?.clone(), objects.first()?.clone())))
    }

    /// Another scene is played: what was touched is there no more.
    pub fn forget_touches(&self) {
        self.known().touches.clear();
    }

    /// The names of everybody in the arena.
    pub fn inside(&self) -> Vec<String> {
        self.known().inside.keys().map(|(_, person)| person.clone()).collect()
    }

    /// Whether this number is in the arena.
    pub fn is_inside(&self, id: PersonId) -> bool {
        self.known().inside.values().any(|inside| inside.id == id)
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        // Every change above is whole, so a panic elsewhere leaves nothing half done.
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lost_client_finds_its_person_again_and_a_second_one_does_not() {
        let persons = Persons::default();
        let Ok(Entry::New(id)) = persons.enter("quest", "ada") else { panic!() };
        assert!(persons.enter("quest", "ada").is_err());
        assert_ne!(persons.enter("vive", "ada"), Ok(Entry::New(id)));
        persons.disconnect(id);
        assert!(persons.is_inside(id));
        assert_eq!(persons.enter("quest", "ada"), Ok(Entry::Back(id)));
    }

    #[test]
    fn a_touch_lasts_until_it_is_let_go_or_its_person_leaves() {
        let persons = Persons::default();
        let Ok(Entry::New(id)) = persons.enter("quest", "ada") else { panic!() };
        assert_eq!(persons.touch(), None);
        persons.touches(id, "wall", true);
        persons.disconnect(id);
        assert_eq!(persons.touch(), Some(("ada".into(), "wall".into())), "a lost client lets go of nothing");
        persons.touches(id, "wall", false);
        assert_eq!(persons.touch(), None);
        persons.touches(id, "wall", true);
        persons.leave(id);
        assert_eq!(persons.touch(), None);
    }

    #[test]
    fn a_number_is_never_used_again() {
        let persons = Persons::default();
        let Ok(Entry::New(first)) = persons.enter("quest", "ada") else { panic!() };
        persons.leave(first);
        assert!(!persons.is_inside(first));
        let Ok(Entry::New(second)) = persons.enter("quest", "ada") else { panic!() };
        assert_ne!(first, second);
        assert_eq!(persons.name(first), "ada", "the record still names who left");
    }
}
