//! The table: who may do what, all of it. What is not here is answered to nobody.
//!
//! A key is a route of HTTP (`GET /api/v1/state`) or a message of a socket (`dashboard arm`, `client pose`).
//! The stop is open to everybody, whoever they are: to stop is always the safest act.

use covr_wire::client::FromClient;
use covr_wire::dashboard::{FromDashboard, MachineRequest};

use super::Role;
use super::Role::{Administrator, Client, Designer, GameMaster, Observer};

/// Who may.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Who {
    /// Everybody who reaches the server.
    Anybody,
    /// Whoever has a token of one of these roles.
    Roles(&'static [Role]),
}

impl Who {
    /// Whether this role may; none: somebody without a token.
    pub fn includes(self, role: Option<Role>) -> bool {
        match self {
            Self::Anybody => true,
            Self::Roles(roles) => role.is_some_and(|role| roles.contains(&role)),
        }
    }
}

/// Who may do what this key names; none: there is no such key.
pub fn who_may(key: &str) -> Option<Who> {
    TABLE.iter().find(|(known, _)| *known == key).map(|(_, who)| *who)
}

/// Every key that this role may use.
pub fn allowed(role: Option<Role>) -> impl Iterator<Item = &'static str> {
    TABLE.iter().filter(move |(_, who)| who.includes(role)).map(|(key, _)| *key)
}

/// Every key.
pub fn keys() -> impl Iterator<Item = &'static str> {
    TABLE.iter().map(|(key, _)| *key)
}

/// The key of a dashboard's message.
pub const fn dashboard_key(message: &FromDashboard) -> &'static str {
    match message {
        FromDashboard::Stop { .. } => "dashboard stop",
        FromDashboard::Jog { .. } => "dashboard jog",
        FromDashboard::Request { request, .. } => match request {
            MachineRequest::Home => "dashboard home",
            MachineRequest::Arm => "dashboard arm",
            MachineRequest::Disarm => "dashboard disarm",
            MachineRequest::Reset => "dashboard reset",
            MachineRequest::ConfirmOrigin(_) => "dashboard confirm_origin",
            MachineRequest::ConfirmLeft(_) => "dashboard confirm_left",
            MachineRequest::ConfirmClear => "dashboard confirm_clear",
            MachineRequest::Cue(_) => "dashboard cue",
            MachineRequest::SkipTo(_) => "dashboard skip_to",
            MachineRequest::Rewind => "dashboard rewind",
            MachineRequest::ArmContact { .. } => "dashboard arm_contact",
            MachineRequest::DisarmContact => "dashboard disarm_contact",
            MachineRequest::ConfirmFree => "dashboard confirm_free",
        },
    }
}

/// The key of a VR client's message.
pub const fn client_key(message: &FromClient) -> &'static str {
    match message {
        FromClient::Hello(_) => "client hello",
        FromClient::Enter(_) => "client enter",
        FromClient::Leave(_) => "client leave",
        FromClient::Pose(_) => "client pose",
        FromClient::OriginChanged(_) => "client origin_changed",
        FromClient::TouchBegan(_) => "client touch_began",
        FromClient::TouchEnded(_) => "client touch_ended",
        FromClient::SceneEvent(_) => "client scene_event",
        FromClient::ClockPing(_) => "client clock_ping",
    }
}

/// Whoever may see. They may stop on every lane.
const SEE: Who = Who::Roles(&[Observer, Client, Designer, GameMaster, Administrator]);
/// Whoever may look into the record of other people's visits. A headset has no business there.
const LOOK_BACK: Who = Who::Roles(&[Observer, Designer, GameMaster, Administrator]);
/// Whoever may speak for people with headsets.
const SPEAK_FOR_VISITORS: Who = Who::Roles(&[Client, GameMaster, Administrator]);
/// Whoever may make scenes. The machine does nothing new by that.
const DESIGN: Who = Who::Roles(&[Designer, GameMaster, Administrator]);
/// Whoever may change what the machine does.
const RUN: Who = Who::Roles(&[GameMaster, Administrator]);

/// Whoever may say who may.
const ADMINISTER: Who = Who::Roles(&[Administrator]);

const TABLE: &[(&str, Who)] = &[
    ("POST /api/v1/stop", Who::Anybody),
    ("dashboard stop", Who::Anybody),
    ("GET /healthz", Who::Anybody),
    ("GET /readyz", Who::Anybody),
    ("GET /api/docs", Who::Anybody),
    ("GET /api/v1/openapi.json", Who::Anybody),
    ("GET /api/v1/asyncapi.json", Who::Anybody),
    ("GET /api/v1/scene.schema.json", Who::Anybody),
    ("GET /api/v1/me", Who::Anybody),
    ("POST /api/v1/login", Who::Anybody),
    ("POST /api/v1/logout", Who::Anybody),
    ("POST /api/v1/tickets", SEE),
    ("GET /api/v1/state", SEE),
    ("GET /api/v1/scenes", SEE),
    ("GET /api/v1/scenes/{id}", SEE),
    ("GET /ws/v1/dashboard", LOOK_BACK),
    ("GET /api/v1/scenes/{id}/versions", LOOK_BACK),
    ("GET /api/v1/priors/changes", LOOK_BACK),
    ("POST /api/v1/priors/preview", LOOK_BACK),
    ("GET /api/v1/sessions", LOOK_BACK),
    ("GET /api/v1/sessions/{id}", LOOK_BACK),
    ("GET /api/v1/sessions/{id}/frames", LOOK_BACK),
    ("GET /api/v1/sessions/{id}/events", LOOK_BACK),
    ("GET /api/v1/sessions/{id}/export", LOOK_BACK),
    ("GET /api/v1/events", LOOK_BACK),
    ("GET /api/v1/config", LOOK_BACK),
    ("GET /api/v1/commissionings", LOOK_BACK),
    ("POST /api/v1/commissionings", RUN),
    ("GET /api/v1/calibrations", LOOK_BACK),
    ("GET /api/v1/calibrations/{id}", LOOK_BACK),
    ("GET /api/v1/calibrations/draft", LOOK_BACK),
    ("GET /metrics", LOOK_BACK),
    ("GET /ws/v1/client", Who::Anybody),
    // A hello may bring the token itself: the page of another site, or an engine, can send no header.
    ("client hello", SPEAK_FOR_VISITORS),
    ("client enter", SPEAK_FOR_VISITORS),
    ("client leave", SPEAK_FOR_VISITORS),
    ("client pose", SPEAK_FOR_VISITORS),
    ("client origin_changed", SPEAK_FOR_VISITORS),
    ("client touch_began", SPEAK_FOR_VISITORS),
    ("client touch_ended", SPEAK_FOR_VISITORS),
    ("client scene_event", SPEAK_FOR_VISITORS),
    ("client clock_ping", Who::Anybody),
    ("POST /api/v1/scenes/check", DESIGN),
    ("POST /api/v1/scenes", DESIGN),
    ("PUT /api/v1/scenes/{id}", DESIGN),
    ("PUT /api/v1/scenes/{id}/activate", RUN),
    ("PATCH /api/v1/priors", RUN),
    ("POST /api/v1/home", RUN),
    ("POST /api/v1/arm", RUN),
    ("POST /api/v1/disarm", RUN),
    ("POST /api/v1/reset", RUN),
    ("POST /api/v1/persons/{id}/confirm", RUN),
    ("POST /api/v1/persons/{id}/left", RUN),
    ("POST /api/v1/arena/clear", RUN),
    // Where people are taken to be, so for those who may arm; and headsets lose their place between two sessions.
    ("PUT /api/v1/calibrations/draft", RUN),
    ("DELETE /api/v1/calibrations/draft", RUN),
    ("POST /api/v1/calibrations/draft/points", RUN),
    ("DELETE /api/v1/calibrations/draft/points/{number}", RUN),
    ("POST /api/v1/calibrations", RUN),
    ("PUT /api/v1/calibrations/{id}/activate", RUN),
    ("PUT /api/v1/calibrations/{id}/retire", RUN),
    ("POST /api/v1/calibrations/{id}/scene", RUN),
    ("GET /api/v1/tokens", ADMINISTER),
    ("DELETE /api/v1/tokens/{id}", ADMINISTER),
    ("dashboard jog", RUN),
    ("dashboard home", RUN),
    ("dashboard arm", RUN),
    ("dashboard disarm", RUN),
    ("dashboard reset", RUN),
    ("dashboard confirm_origin", RUN),
    ("dashboard confirm_left", RUN),
    ("dashboard confirm_clear", RUN),
    ("POST /api/v1/scenario/cue", RUN),
    ("POST /api/v1/scenario/skip", RUN),
    ("POST /api/v1/scenario/rewind", RUN),
    ("POST /api/v1/notes", DESIGN),
    ("GET /api/v1/checklist", LOOK_BACK),
    ("PUT /api/v1/checklist/{item}", RUN),
    ("dashboard cue", RUN),
    ("dashboard skip_to", RUN),
    ("dashboard rewind", RUN),
    ("POST /api/v1/contact/arm", RUN),
    ("POST /api/v1/contact/disarm", RUN),
    ("POST /api/v1/contact/free", RUN),
    ("dashboard arm_contact", RUN),
    ("dashboard disarm_contact", RUN),
    ("dashboard confirm_free", RUN),
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn no_key_is_there_twice() {
        assert_eq!(keys().collect::<BTreeSet<_>>().len(), TABLE.len());
    }

    #[test]
    fn everybody_may_stop_and_only_game_masters_and_administrators_may_move() {
        let roles = || Role::ALL.into_iter().map(Some).chain([None]);
        for key in ["POST /api/v1/stop", "dashboard stop"] {
            assert!(roles().all(|role| who_may(key).unwrap().includes(role)), "{key}");
        }
        let moves = ["home", "arm", "disarm", "reset"];
        for key in moves.iter().flat_map(|act| [format!("POST /api/v1/{act}"), format!("dashboard {act}")]) {
            let may: Vec<_> = roles().filter(|role| who_may(&key).unwrap().includes(*role)).collect();
            assert_eq!(may, [Some(GameMaster), Some(Administrator)], "{key}");
        }
    }
}
