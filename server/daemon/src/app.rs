//! What every handler shares, and the acts that HTTP and dashboards have in common.

use std::fmt;
use std::sync::Arc;
use std::time::{Duration, Instant};

use covr_engine::mode::RequestKind;
use covr_engine::observation::PersonId;
use covr_engine::time::Span;
use covr_engine::{Answer, Outcome, Request};
use covr_wire::dashboard::request_name;
use covr_wire::reason::Reason;
use metrics_exporter_prometheus::PrometheusHandle;
use serde_json::{Value, json};
use tokio::sync::{Semaphore, watch};

use crate::access::{Caller, Change, Roster};
use crate::calibrations::Calibrations;
use crate::checklist::Checklist;
use crate::clients::Clients;
use crate::clock::Clock;
use crate::commissionings::Commissionings;
use crate::config::{Config, Origins};
use crate::control::{Control, NotDelivered, NotReached, StopLaneName};
use crate::hand::{Hand, Ordered};
use crate::http::Limits;
use crate::meters;
use crate::persons::Persons;
use crate::recorder::{Recorder, Settled};
use crate::recording::Recording;
use crate::stage::Stage;
use crate::store::Store;

/// The server's shared state.
pub struct App {
    /// The configuration.
    pub config: Config,
    /// Who set what of it.
    pub origins: Origins,
    /// The clock.
    pub clock: Clock,
    /// The control thread.
    pub control: Control,
    /// Who may do what.
    pub roster: Arc<Roster>,
    /// How much one address may ask.
    pub limits: Limits,
    /// The database.
    pub store: Store,
    /// The commissioning that counts.
    pub commissionings: Commissionings,
    /// Whose hand jogs the column.
    pub hand: Hand,
    /// The recorder.
    pub recorder: Recorder,
    /// What records sessions.
    pub recording: Recording,
    /// Who is who.
    pub persons: Arc<Persons>,
    /// The active scene.
    pub stage: Arc<Stage>,
    /// What is looked at before a start.
    pub checklist: Checklist,
    /// Where the clients' tracking spaces are.
    pub calibrations: Calibrations,
    /// Connected VR clients.
    pub clients: Arc<Clients>,
    /// Places for VR clients that have not said who they are.
    pub doorstep: Arc<Semaphore>,
    /// Places for dashboards.
    pub dashboard_seats: Arc<Semaphore>,
    /// Newest snapshot for dashboards, as text.
    pub frames: watch::Receiver<Arc<str>>,
    /// Why the server closes, once it does.
    pub closing: watch::Receiver<Option<String>>,
    /// The metrics.
    pub prometheus: PrometheusHandle,
}

/// Who asks, and by what way.
#[derive(Debug, Clone)]
pub struct Asker {
    /// `http`, `dashboard`, `signal`.
    pub by: &'static str,
    /// The name that they give themselves, if they do.
    pub given: Option<String>,
    /// Who they are.
    pub caller: Caller,
}

impl Asker {
    /// The name given, else the token's, else `anonymous`.
    pub fn author(&self) -> &str {
        let named = self.given.as_deref().or_else(|| self.caller.holder().map(|holder| holder.name.as_str()));
        named.unwrap_or("anonymous")
    }

    /// The particulars of an event, with who did it: the name given, and the token and role behind it.
    pub fn sign(&self, mut detail: Value) -> Value {
        detail["author"] = self.author().into();
        detail["by"] = self.by.into();
        if let Some(holder) = self.caller.holder() {
            detail["actor"] = holder.actor();
        }
        detail
    }
}

/// `Ada`, or `Ada (front desk, game master)` where there are tokens.
impl fmt::Display for Asker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.caller.holder() {
            Some(holder) if holder.name == self.author() => {
                write!(f, "{} ({})", holder.name, holder.role.in_words())
            }
            Some(holder) => write!(f, "{} ({}, {})", self.author(), holder.name, holder.role.in_words()),
            None => f.write_str(self.author()),
        }
    }
}

impl App {
    /// Put a request to the machine, record it with its author, and wait until that is stored.
    pub async fn request(
        &self,
        asker: &Asker,
        kind: RequestKind,
        reason: Option<String>,
    ) -> Result<Answer, NotDelivered> {
        let name = request_name(kind);
        let detail = json!({ "request": name, "reason": reason });
        if kind == RequestKind::Arm
            && let Some(why) = self.why_not_armed()
        {
            self.record_asked(asker, name, Outcome::Refused, &why, detail);
            return Err(NotDelivered::NotAsked(Box::new(why)));
        }
        self.ask_recorded(asker, name, Request::Machine(kind, reason), detail).await
    }

    /// A game master says that the person stands on the floor mark.
    pub async fn confirm_origin(&self, asker: &Asker, person: PersonId) -> Result<Answer, NotDelivered> {
        self.ask_about(asker, "confirm_origin", person, Request::ConfirmOrigin(person)).await
    }

    /// A game master saw that this person, whose headset is lost, has left.
    pub async fn confirm_left(&self, asker: &Asker, person: PersonId) -> Result<Answer, NotDelivered> {
        let answer = self.ask_about(asker, "confirm_left", person, Request::ConfirmLeft(person)).await?;
        if answer.outcome == Outcome::Accepted {
            self.persons.leave(person);
        }
        Ok(answer)
    }

    /// Somebody looked: nobody is in the arena.
    pub async fn confirm_clear(&self, asker: &Asker) -> Result<Answer, NotDelivered> {
        let detail = json!({ "request": "confirm_clear" });
        self.ask_recorded(asker, "confirm_clear", Request::ConfirmClear, detail).await
    }

    /// A moving column may touch this visitor, for so long at most (R14).
    pub async fn arm_contact(
        &self,
        asker: &Asker,
        person: PersonId,
        lasts: Span,
    ) -> Result<Answer, NotDelivered> {
        let detail =
            json!({ "request": "arm_contact", "person": self.persons.name(person), "secs": lasts.secs() });
        self.ask_recorded(asker, "arm_contact", Request::ArmContact(person, lasts), detail).await
    }

    /// Nobody may be touched by a moving column any more.
    pub async fn disarm_contact(&self, asker: &Asker) -> Result<Answer, NotDelivered> {
        let detail = json!({ "request": "disarm_contact" });
        self.ask_recorded(asker, "disarm_contact", Request::DisarmContact, detail).await
    }

    /// Somebody looked: nobody leans on the column or rides it.
    pub async fn confirm_free(&self, asker: &Asker) -> Result<Answer, NotDelivered> {
        let detail = json!({ "request": "confirm_free" });
        self.ask_recorded(asker, "confirm_free", Request::ConfirmFree, detail).await
    }

    /// The answer to an order to jog. Who takes the column into their hand is recorded; the orders that follow are not.
    pub async fn jogged(&self, asker: &Asker, ordered: Ordered) -> Result<Answer, NotDelivered> {
        let answer = ordered.answer.await.map_err(|_| NotDelivered::NotRunning)?;
        if ordered.taken {
            self.record_answer(asker, "jog", &answer, json!({ "request": "jog" }));
        }
        Ok(answer)
    }

    /// Why a real machine is not armed: it was not commissioned as it is, or a connected client was calibrated on other hardware.
    pub fn why_not_armed(&self) -> Option<Reason> {
        let now = self.calibrations.hardware(&self.control.published());
        if let Some(why) = self.commissionings.why_not_armed(&now) {
            return Some(why);
        }
        let clients = self.clients.list();
        clients.iter().find_map(|client| self.calibrations.outdated(&client.name, &client.convention, &now))
    }

    /// A game master gives the scenario a cue.
    pub async fn cue(&self, asker: &Asker, name: String) -> Result<Answer, NotDelivered> {
        let detail = json!({ "request": "cue", "cue": name });
        self.ask_recorded(asker, &format!("cue {name}"), Request::Cue(name.clone()), detail).await
    }

    /// A game master skips to a state of the scenario.
    pub async fn skip_to(
        &self,
        asker: &Asker,
        state: String,
        reason: String,
    ) -> Result<Answer, NotDelivered> {
        let detail = json!({ "request": "skip_to", "state": state, "reason": reason });
        let name = format!("skip to {state}");
        self.ask_recorded(asker, &name, Request::SkipTo(state, reason), detail).await
    }

    /// A game master goes back in the scenario.
    pub async fn rewind(&self, asker: &Asker, reason: String) -> Result<Answer, NotDelivered> {
        let detail = json!({ "request": "rewind", "reason": reason });
        self.ask_recorded(asker, "rewind", Request::Rewind(reason), detail).await
    }

    /// The reason of an answer, with what the clients call the persons.
    pub fn reason(&self, answer: &Answer) -> Reason {
        Reason::new(&answer.reason, &self.persons.names())
    }

    /// Press the software stop; the time from `received_at` to the braking command at the drive. It is
    /// recorded before this returns, or given up after [`LONGEST_RECORDING`]: stopping does not wait for a disk.
    pub async fn stop(
        &self,
        asker: &Asker,
        lane: StopLaneName,
        reason: Option<String>,
        received_at: Instant,
    ) -> Result<Duration, NotReached> {
        let reached = self.control.stop(lane, reason.clone().unwrap_or_default(), received_at).await;
        meters::stop_pressed(lane.name(), reached.as_ref().ok().copied());
        let micros = reached.as_ref().ok().map(|d| d.as_micros() as u64);
        let summary = match micros {
            Some(micros) => format!("{asker} pressed stop; at the drive after {micros} us"),
            None => format!("{asker} pressed stop; the drive did not acknowledge"),
        };
        self.recorder.record(
            "stop_pressed",
            summary,
            asker.sign(json!({ "reason": reason, "to_drive_micros": micros })),
        );
        if tokio::time::timeout(LONGEST_RECORDING, self.recorder.settled()).await != Ok(Settled::Stored) {
            tracing::error!("a stop could not be stored; it will not survive a restart");
        }
        reached
    }

    /// Look into the database for tokens that were made or taken back, and record them.
    pub async fn follow_tokens(&self) {
        match self.roster.refresh().await {
            Ok(()) => {}
            // Who was known stays known: the machine can be run without the database.
            Err(error) => tracing::warn!(%error, "the tokens cannot be looked at"),
        }
        self.roster.take_changes().iter().for_each(|change| self.record_token(change));
    }

    fn record_token(&self, change: &Change) {
        let (kind, word, token) = match change {
            Change::Made(token) => ("token_made", "made", token),
            Change::Revoked(token) => ("token_revoked", "taken back", token),
        };
        let summary = format!("the token {} ({}) was {word}", token.name, token.role.in_words());
        let detail = json!({ "token": token.name, "token_id": token.id, "role": token.role });
        self.recorder.record(kind, summary, detail);
    }

    async fn ask_about(
        &self,
        asker: &Asker,
        request: &str,
        person: PersonId,
        asked: Request,
    ) -> Result<Answer, NotDelivered> {
        let name = self.persons.name(person);
        let detail = json!({ "request": request, "person": person.0, "name": name });
        self.ask_recorded(asker, &format!("{request} of {name}"), asked, detail).await
    }

    /// `detail` is what the record has of the request.
    async fn ask_recorded(
        &self,
        asker: &Asker,
        name: &str,
        request: Request,
        detail: Value,
    ) -> Result<Answer, NotDelivered> {
        let answer = self.control.ask(request).await?;
        self.record_answer(asker, name, &answer, detail);
        if self.recorder.settled().await == Settled::Lost {
            tracing::error!(request = name, "an accepted request could not be stored");
        }
        Ok(answer)
    }

    fn record_answer(&self, asker: &Asker, name: &str, answer: &Answer, detail: Value) {
        self.record_asked(asker, name, answer.outcome, &self.reason(answer), detail);
    }

    fn record_asked(&self, asker: &Asker, name: &str, outcome: Outcome, why: &Reason, mut detail: Value) {
        let (kind, outcome) = match outcome {
            Outcome::Refused => ("request_refused", "refused"),
            Outcome::Accepted | Outcome::AlreadySo => ("request_accepted", "accepted"),
        };
        detail["detail"] = why.to_string().into();
        detail["why"] = json!(why);
        self.recorder.record(kind, format!("{name} by {asker}: {outcome}: {why}"), asker.sign(detail));
    }
}

/// Longest wait for the record of a stop before it is acknowledged all the same.
const LONGEST_RECORDING: Duration = Duration::from_millis(500);
