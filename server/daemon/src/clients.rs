//! The connected VR clients, as dashboards see them.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use covr_wire::dashboard::Client;

/// Every connected client, by connection number.
#[derive(Debug)]
pub struct Clients {
    most: usize,
    connected: Mutex<Connected>,
}

#[derive(Debug, Default)]
struct Connected {
    next: u64,
    open: usize,
    said_hello: BTreeMap<u64, Client>,
}

/// A place among the clients, given back when dropped.
#[derive(Debug)]
pub struct Seat {
    clients: Arc<Clients>,
    number: u64,
}

impl Clients {
    /// Room for so many.
    pub fn new(most: usize) -> Self {
        Self { most, connected: Mutex::default() }
    }

    /// Take a place, if one is left.
    pub fn take_seat(self: &Arc<Self>) -> Option<Seat> {
        let mut connected = self.connected();
        if connected.open >= self.most {
            return None;
        }
        connected.open += 1;
        connected.next += 1;
        Some(Seat { clients: self.clone(), number: connected.next })
    }

    /// Everybody who said hello.
    pub fn list(&self) -> Vec<Client> {
        self.connected().said_hello.values().cloned().collect()
    }

    fn connected(&self) -> MutexGuard<'_, Connected> {
        // Every change here is whole, so a panic elsewhere leaves nothing half done.
        self.connected.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Seat {
    /// Show this client as it is now.
    pub fn show(&self, client: Client) {
        self.clients.connected().said_hello.insert(self.number, client);
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        let mut connected = self.clients.connected();
        connected.open -= 1;
        connected.said_hello.remove(&self.number);
    }
}
