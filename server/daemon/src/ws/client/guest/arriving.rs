//! Who a client is, where its tracking space is, and the persons that it brings in.

use covr_engine::observation::Observation;
use covr_engine::safety::parameters::Parameters;
use covr_engine::time::Time;
use covr_wire::client::{ActiveScene, ClientError, ClientHello, ClientLimits, ErrorCode, Sequencer, Welcome};
use covr_wire::link::Link;
use serde_json::json;

use super::{Greeted, Guest, Place, Present, Reply, busy, unauthorized};
use crate::access::Caller;
use crate::calibrations::moves;
use crate::http::{Problem, address};
use crate::persons::Entry;

impl Guest {
    pub(super) fn greet(&mut self, hello: ClientHello, received: Time) -> Result<Reply, ClientError> {
        if self.greeted.is_some() {
            return Err(ClientError::plain(ErrorCode::AlreadyGreeted, "hello was said already"));
        }
        if let Place::Doorstep { .. } = &self.who.place {
            let seat = self.app.clients.take_seat().ok_or_else(|| {
                ClientError::plain(ErrorCode::Full, "as many VR clients as the server takes are connected")
                    .fatal()
            })?;
            self.who.place = Place::Seat(seat);
        }
        self.rooms.mark_unchanged();
        let frame = self.app.calibrations.frame(&hello.name, hello.convention);
        let active = self.app.stage.active();
        let rules = Parameters::new(self.app.config.people.v_h_mps);
        let welcome = Welcome {
            server_version: env!("CARGO_PKG_VERSION").into(),
            session_id: self.app.recorder.session_id(),
            convention: hello.convention,
            limits: ClientLimits::new(&self.app.config.machine.limits(), rules.pose_age.secs()),
            scene: Some(ActiveScene::new(active.id, active.version, active.document.clone(), &frame)),
        };
        tracing::info!(client = hello.name, convention = hello.convention.name(), "VR client connected");
        let calibration = self.app.calibrations.version(&hello.name, hello.convention);
        let detail = json!({ "client": hello.name, "convention": hello.convention.name(), "calibration": calibration });
        self.record("client_connected", format!("client {} connected", hello.name), detail);
        self.greeted = Some(Greeted { hello: hello.clone(), frame });
        self.show(received);
        Ok(Reply::Welcome(Box::new(hello), frame, Box::new(welcome)))
    }

    /// Who it is, by the token in its hello.
    pub(super) async fn introduce(&mut self, token: &str) -> Result<(), ClientError> {
        if self.app.roster.asks() && self.greeted.is_none() {
            if self.app.roster.at_once(token).is_none() {
                let tried = self.app.limits.try_token(address(self.who.peer));
                tried.map_err(|_| {
                    unauthorized("this address has shown too many tokens that are not known".into())
                })?;
            }
            let holder = self.app.roster.by_token(token).await;
            self.who.caller =
                holder.map(Caller::Known).map_err(|why| unauthorized(Problem::from(why).detail.into()))?;
        }
        Ok(())
    }

    pub(super) fn enter(&mut self, person: &str) -> Result<(), ClientError> {
        let Some(greeted) = &self.greeted else { return Ok(()) };
        if self.persons.contains_key(person) {
            let words = format!("{person} has entered already");
            return Err(ClientError::plain(ErrorCode::AlreadyEntered, words));
        }
        let published = self.app.control.published();
        if moves(published.snapshot.mode) {
            let now = self.app.calibrations.hardware(&published);
            let (name, convention) = (&greeted.hello.name, greeted.hello.convention.name());
            if let Some(why) = self.app.calibrations.outdated(name, convention, &now) {
                return Err(ClientError::plain(ErrorCode::NotCalibrated, why.to_string()));
            }
        }
        let most = self.app.config.clients.persons_each;
        if self.persons.len() >= most {
            let words = format!("a client speaks for at most {most} persons");
            return Err(ClientError::plain(ErrorCode::Full, words));
        }
        let entry = self
            .app
            .persons
            .enter(&greeted.hello.name, person)
            .map_err(|taken| ClientError::plain(ErrorCode::AlreadyEntered, taken.to_string()))?;
        let (id, seen) = match entry {
            Entry::New(id) => (id, Observation::PersonEntered(id)),
            Entry::Back(id) => (id, Observation::ClientBack(id)),
        };
        let told = self.tell(seen).and_then(|()| self.app.control.connect_headset(id).map_err(busy));
        match told {
            Ok(slot) => {
                let (sequencer, link) = (Sequencer::default(), Link::default());
                self.persons.insert(person.to_owned(), Present { id, slot, sequencer, link });
                Ok(())
            }
            Err(error) => {
                self.app.persons.disconnect(id);
                Err(error)
            }
        }
    }
}
