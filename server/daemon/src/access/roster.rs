//! Who is who: the tokens and logins in force, in memory. Nobody waits for the database to be told who asks; the
//! database is looked into once a second, and once more for a token that is not known yet.
//!
//! Where no token was ever made, everybody who reaches the server may do everything.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use arc_swap::ArcSwap;
use serde_json::{Value, json};
use tokio::sync::{Semaphore, watch};

use super::table::{self, Who};
use super::token::{Fingerprint, fingerprint, hex, random_text};
use super::{Role, Token};
use crate::store::{Store, StoreError, StoredLogin, StoredToken};

/// Whoever asks for something.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Caller {
    /// Somebody who reaches a server that asks nobody who they are.
    Unasked,
    /// The holder of a token.
    Known(Holder),
    /// Somebody without a token, or with one that is not in force.
    Stranger,
}

/// The holder of a token, as it was when they came.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Holder {
    /// The token's public part.
    pub token_id: String,
    /// What the holder is called.
    pub name: String,
    /// What they are.
    pub role: Role,
    /// They signed in by a browser with this cookie.
    login: Option<Fingerprint>,
}

/// What a caller's word is worth now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// As much as when they came.
    InForce,
    /// Their token or login has ended: they may look on and stop.
    Ended,
    /// Their token was taken back, or they have signed out.
    TakenBack,
}

/// A browser was signed in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SignedIn {
    /// The cookie.
    pub cookie: String,
    /// Who it is.
    pub holder: Holder,
    /// How long it lasts.
    pub lasts: Duration,
}

/// What changed among the tokens since the database was last looked into.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Change {
    /// There is a new one.
    Made(StoredToken),
    /// One was taken back.
    Revoked(StoredToken),
}

/// Why somebody was not let in.
#[derive(Debug, thiserror::Error)]
pub enum NotLetIn {
    /// Not a token, or not one in force.
    #[error("the token is not known, has ended, or was taken back")]
    NotInForce,
    /// The token could not be kept.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// Nothing secret can be made.
    #[error("the operating system gives no random numbers: {0}")]
    Random(#[from] getrandom::Error),
}

/// The tokens, logins and tickets in force.
#[derive(Debug)]
pub struct Roster {
    store: Store,
    login_lasts: Duration,
    tokens: ArcSwap<HashMap<String, Held>>,
    /// What was matched before, so that argon2 is asked once for each token.
    matched: Mutex<HashMap<String, Fingerprint>>,
    logins: Mutex<HashMap<Fingerprint, Login>>,
    tickets: Mutex<HashMap<Fingerprint, Ticket>>,
    /// One hash at a time: whoever guesses cannot take every core.
    hashing: Arc<Semaphore>,
    /// Held while the database is looked into: what was read first never replaces what was read later.
    looking: tokio::sync::Mutex<()>,
    /// What changed among the tokens and is not recorded yet.
    changes: Mutex<Vec<Change>>,
    changed: watch::Sender<()>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Held {
    stored: StoredToken,
    expires: Option<SystemTime>,
}

#[derive(Debug, Clone)]
struct Login {
    token_id: String,
    expires: SystemTime,
}

#[derive(Debug)]
struct Ticket {
    caller: Caller,
    until: Instant,
}

impl Roster {
    /// As the database has it.
    pub async fn open(store: Store, login_lasts: Duration) -> Result<Self, StoreError> {
        let roster = Self {
            login_lasts,
            tokens: ArcSwap::from_pointee(HashMap::new()),
            matched: Mutex::default(),
            logins: Mutex::default(),
            tickets: Mutex::default(),
            hashing: Arc::new(Semaphore::new(1)),
            looking: tokio::sync::Mutex::default(),
            changes: Mutex::default(),
            changed: watch::Sender::new(()),
            store,
        };
        roster.refresh().await?;
        // What was there before is no change.
        roster.take_changes();
        let logins = roster.store.logins().await?.into_iter().filter_map(|stored| {
            let hash = bytes_of(&stored.hash)?;
            Some((hash, Login { token_id: stored.token_id, expires: moment(&stored.expires)? }))
        });
        lock(&roster.logins).extend(logins);
        Ok(roster)
    }

    /// Look into the database.
    pub async fn refresh(&self) -> Result<(), StoreError> {
        let _alone = self.looking.lock().await;
        let stored = self.store.tokens().await?;
        let before = self.tokens.load_full();
        let held = |stored: StoredToken| {
            // A moment that cannot be read has passed.
            let expires = stored.expires.as_deref().map(|at| moment(at).unwrap_or(SystemTime::UNIX_EPOCH));
            (stored.id.clone(), Held { stored, expires })
        };
        let now: HashMap<String, Held> = stored.into_iter().map(held).collect();
        let mut changes = lock(&self.changes);
        for (id, Held { stored, .. }) in &now {
            let known = before.get(id).map(|held| &held.stored);
            if known.is_none() {
                changes.push(Change::Made(stored.clone()));
            }
            if stored.revoked.is_some() && known.is_none_or(|known| known.revoked.is_none()) {
                changes.push(Change::Revoked(stored.clone()));
            }
        }
        if *before != now {
            self.tokens.store(Arc::new(now));
            self.changed.send_replace(());
        }
        Ok(())
    }

    /// What changed among the tokens since this was last asked, whoever looked into the database meanwhile.
    pub fn take_changes(&self) -> Vec<Change> {
        std::mem::take(&mut lock(&self.changes))
    }

    /// Whether everybody is asked who they are: from the first token on, for ever.
    pub fn asks(&self) -> bool {
        !self.tokens.load().is_empty()
    }

    /// Whether anybody could be let in.
    pub fn has_token_in_force(&self) -> bool {
        let now = SystemTime::now();
        self.tokens.load().values().any(|held| held.standing(now) == Standing::InForce)
    }

    /// Somebody who shows nothing.
    pub fn nobody(&self) -> Caller {
        if self.asks() { Caller::Stranger } else { Caller::Unasked }
    }

    /// Who shows this token.
    pub async fn by_token(&self, text: &str) -> Result<Holder, NotLetIn> {
        if let Some(known) = self.at_once(text) {
            return known;
        }
        let token = Token::parse(text).ok_or(NotLetIn::NotInForce)?;
        let alone = self.hashing.clone().acquire_owned().await;
        if !self.tokens.load().contains_key(token.id()) {
            self.refresh().await?;
        }
        let holder = self.holder(token.id(), None).ok_or(NotLetIn::NotInForce)?;
        let hash =
            self.tokens.load().get(token.id()).map(|held| held.stored.hash.clone()).unwrap_or_default();
        let (id, print) = (token.id().to_owned(), token.fingerprint());
        let hashed = tokio::task::spawn_blocking(move || {
            // Until it is hashed, also when whoever asked has gone.
            let _alone = alone;
            token.matches(&hash)
        });
        let matches = hashed.await.unwrap_or(false);
        if !matches {
            return Err(NotLetIn::NotInForce);
        }
        lock(&self.matched).insert(id, print);
        Ok(holder)
    }

    /// Who shows this token; none where that takes a hash or the database.
    pub fn at_once(&self, text: &str) -> Option<Result<Holder, NotLetIn>> {
        let Some(token) = Token::parse(text) else { return Some(Err(NotLetIn::NotInForce)) };
        if !self.tokens.load().contains_key(token.id()) {
            return None;
        }
        let Some(holder) = self.holder(token.id(), None) else { return Some(Err(NotLetIn::NotInForce)) };
        (lock(&self.matched).get(token.id()) == Some(&token.fingerprint())).then_some(Ok(holder))
    }

    /// Who shows this cookie.
    pub fn by_cookie(&self, cookie: &str) -> Option<Holder> {
        let hash = fingerprint(cookie);
        let login = lock(&self.logins).get(&hash).cloned()?;
        (login.expires > SystemTime::now()).then(|| self.holder(&login.token_id, Some(hash)))?
    }

    /// Who was given this ticket. It is good once.
    pub fn by_ticket(&self, ticket: &str) -> Option<Caller> {
        let ticket = lock(&self.tickets).remove(&fingerprint(ticket))?;
        let is_good = ticket.until > Instant::now() && self.standing(&ticket.caller) == Standing::InForce;
        is_good.then_some(ticket.caller)
    }

    /// A ticket for one WebSocket, good for [`TICKET_LASTS`].
    pub fn ticket(&self, caller: Caller) -> Result<String, getrandom::Error> {
        let (text, now) = (random_text()?, Instant::now());
        let mut tickets = lock(&self.tickets);
        tickets.retain(|_, ticket| ticket.until > now);
        if tickets.len() >= MOST_TICKETS {
            // The oldest goes: whoever asked for so many uses none of them.
            let oldest = tickets.iter().min_by_key(|(_, ticket)| ticket.until).map(|(hash, _)| *hash);
            oldest.and_then(|hash| tickets.remove(&hash));
        }
        tickets.insert(fingerprint(&text), Ticket { caller, until: now + TICKET_LASTS });
        Ok(text)
    }

    /// Sign a browser in. The login survives a restart.
    pub async fn sign_in(&self, token: &str) -> Result<SignedIn, NotLetIn> {
        let holder = self.by_token(token).await?;
        let (cookie, now) = (random_text()?, SystemTime::now());
        let hash = fingerprint(&cookie);
        let login = Login { token_id: holder.token_id.clone(), expires: now + self.login_lasts };
        let stored = StoredLogin {
            hash: hex(&hash),
            token_id: login.token_id.clone(),
            expires: humantime::format_rfc3339_seconds(login.expires).to_string(),
        };
        self.store.add_login(&stored, &humantime::format_rfc3339_seconds(now).to_string()).await?;
        let mut logins = lock(&self.logins);
        // Whoever still looks on with a login that has ended is told from one who signed out.
        logins.retain(|_, login| login.expires + FORGET_AFTER > now);
        logins.insert(hash, login);
        Ok(SignedIn { cookie, holder: Holder { login: Some(hash), ..holder }, lasts: self.login_lasts })
    }

    /// Sign a browser out.
    pub async fn sign_out(&self, holder: &Holder) -> Result<(), StoreError> {
        let Some(hash) = holder.login else { return Ok(()) };
        lock(&self.logins).remove(&hash);
        self.changed.send_replace(());
        self.store.remove_login(&hex(&hash)).await
    }

    /// What a caller's word is worth now.
    pub fn standing(&self, caller: &Caller) -> Standing {
        match caller {
            Caller::Stranger => Standing::Ended,
            // A token was made meanwhile: from now on everybody is asked.
            Caller::Unasked if self.asks() => Standing::Ended,
            Caller::Unasked => Standing::InForce,
            Caller::Known(holder) => {
                let now = SystemTime::now();
                let tokens = self.tokens.load();
                let Some(held) = tokens.get(&holder.token_id) else { return Standing::TakenBack };
                match (held.standing(now), &holder.login) {
                    (Standing::InForce, Some(hash)) => match lock(&self.logins).get(hash) {
                        Some(login) if login.expires > now => Standing::InForce,
                        Some(_) => Standing::Ended,
                        None => Standing::TakenBack,
                    },
                    (standing, _) => standing,
                }
            }
        }
    }

    /// Whether this caller may do now what the key names.
    pub fn allows(&self, caller: &Caller, key: &str) -> bool {
        let Some(who) = table::who_may(key) else { return false };
        who == Who::Anybody
            || self.standing(caller) == Standing::InForce
                && match caller {
                    Caller::Unasked => true,
                    Caller::Known(holder) => who.includes(Some(holder.role)),
                    Caller::Stranger => false,
                }
    }

    /// Why this caller may not do what the key names, in words.
    pub fn why_not(&self, caller: &Caller, key: &str) -> String {
        match (caller, self.standing(caller)) {
            (Caller::Known(Holder { name, role, .. }), Standing::InForce) => {
                format!("{name} is {}, who may not {key}", role.with_article())
            }
            (Caller::Known(_), _) => "the token or the login has ended: sign in again".into(),
            (Caller::Unasked | Caller::Stranger, _) => {
                "who asks? send a token as `Authorization: Bearer covr_...`, or sign in on the page".into()
            }
        }
    }

    /// Told whenever a token or a login may have ended before its time; and once at first, for what ended just before.
    pub fn watch(&self) -> watch::Receiver<()> {
        let mut changed = self.changed.subscribe();
        changed.mark_changed();
        changed
    }

    /// The holder of a token in force.
    fn holder(&self, id: &str, login: Option<Fingerprint>) -> Option<Holder> {
        let tokens = self.tokens.load();
        let held = tokens.get(id).filter(|held| held.standing(SystemTime::now()) == Standing::InForce)?;
        let Held { stored, .. } = held;
        Some(Holder { token_id: id.into(), name: stored.name.clone(), role: stored.role, login })
    }
}

impl Held {
    fn standing(&self, now: SystemTime) -> Standing {
        if self.stored.revoked.is_some() {
            Standing::TakenBack
        } else if self.expires.is_some_and(|at| at <= now) {
            Standing::Ended
        } else {
            Standing::InForce
        }
    }
}

impl Caller {
    /// The holder, of those who are known.
    pub fn holder(&self) -> Option<&Holder> {
        match self {
            Self::Known(holder) => Some(holder),
            Self::Unasked | Self::Stranger => None,
        }
    }
}

impl Holder {
    /// Who acted, for the record.
    pub fn actor(&self) -> Value {
        json!({ "token": self.name, "token_id": self.token_id, "role": self.role })
    }

    /// They came with a cookie, which a browser sends unasked.
    pub fn came_by_cookie(&self) -> bool {
        self.login.is_some()
    }

    /// What a page proves with that it was this server's own that asked; none without a cookie. Another site can make a
    /// browser send the cookie, and cannot read this.
    pub fn csrf(&self) -> Option<String> {
        self.login.map(|hash| hex(&fingerprint(&format!("csrf {}", hex(&hash)))))
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn moment(text: &str) -> Option<SystemTime> {
    humantime::parse_rfc3339(text).ok()
}

fn bytes_of(text: &str) -> Option<Fingerprint> {
    let mut bytes = Fingerprint::default();
    if text.len() != 2 * bytes.len() {
        return None;
    }
    for (index, byte) in bytes.iter_mut().enumerate() {
        *byte = u8::from_str_radix(text.get(2 * index..2 * index + 2)?, 16).ok()?;
    }
    Some(bytes)
}

/// A ticket is for the connection that follows.
pub const TICKET_LASTS: Duration = Duration::from_secs(30);
const FORGET_AFTER: Duration = Duration::from_secs(24 * 60 * 60);
const MOST_TICKETS: usize = 1_000;
