//! Calibrations in force, and the one in the making.
//!
//! A client's tracking space is calibrated under the client's name; a client without a calibration is where the configuration
//! says. The one in the making is kept in memory alone: nothing is in force before somebody accepts it.

mod bench;

use std::collections::BTreeMap;
use std::sync::Arc;

use covr_engine::frames::RigidMap;
use covr_engine::mode::Mode;
use covr_wire::calibration::{
    Calibration, CalibrationSummary, Hardware, HardwareChange, HardwarePart, RoomFromTracking,
};
use covr_wire::client::Convention;
use covr_wire::convention::ClientFrame;
use covr_wire::reason::Reason;
use tokio::sync::{Mutex, watch};

pub use bench::Bench;

use crate::config::{Config, MachineKind};
use crate::control::Published;
use crate::store::{NewCalibration, Store, StoreError};

/// The map of each calibrated client, by its name.
#[derive(Debug, Default)]
pub struct Rooms(BTreeMap<String, Room>);

#[derive(Debug)]
struct Room {
    version: i64,
    convention: Convention,
    map: RoomFromTracking,
    hardware: Hardware,
}

/// Calibrations.
#[derive(Debug)]
pub struct Calibrations {
    rooms: watch::Sender<Arc<Rooms>>,
    /// Where a client without a calibration is.
    configured: RoomFromTracking,
    /// Of what nobody can change while the server runs.
    hardware: Hardware,
    is_simulated: bool,
    changing: Mutex<()>,
    /// The one in the making.
    pub bench: Bench,
}

impl Calibrations {
    /// Those that the store has in force.
    pub async fn open(config: &Config, store: &Store) -> Result<Self, StoreError> {
        let clients = &config.clients;
        let rooms = Rooms::read(store).await?;
        Ok(Self {
            rooms: watch::Sender::new(Arc::new(rooms)),
            configured: RigidMap::from_yaw(clients.tracking_yaw_rad, clients.tracking_origin_m.into()),
            hardware: hardware(config),
            is_simulated: config.machine.kind.is_simulated(),
            changing: Mutex::default(),
            bench: Bench::default(),
        })
    }

    /// Where a client is: by its calibration in force, where it still declares what it declared then; else by the configuration.
    pub fn frame(&self, client: &str, convention: Convention) -> ClientFrame {
        let rooms = self.rooms.borrow();
        let calibrated = rooms.0.get(client).filter(|room| room.convention == convention);
        ClientFrame::new(convention, calibrated.map_or(self.configured, |room| room.map))
    }

    /// The map of a client that is calibrated.
    pub fn map(&self, client: &str, convention: Convention) -> Option<RoomFromTracking> {
        let rooms = self.rooms.borrow();
        rooms.0.get(client).filter(|room| room.convention == convention).map(|room| room.map)
    }

    /// Which version of a client's calibration is used; none: it is where the configuration says.
    pub fn version(&self, client: &str, convention: Convention) -> Option<i64> {
        let rooms = self.rooms.borrow();
        rooms.0.get(client).filter(|room| room.convention == convention).map(|room| room.version)
    }

    /// Where a client without a calibration is.
    pub const fn configured(&self) -> RoomFromTracking {
        self.configured
    }

    /// To see when another is put in force.
    pub fn watch(&self) -> watch::Receiver<Arc<Rooms>> {
        self.rooms.subscribe()
    }

    /// The hardware now.
    pub fn hardware(&self, published: &Published) -> Hardware {
        let firmware = published.machine_health.as_ref().and_then(|health| health.firmware.clone());
        Hardware { firmware, ..self.hardware.clone() }
    }

    /// Why a real machine is not armed for this client: its calibration in force was made on other hardware. A simulated
    /// machine moves nothing, so it is armed all the same.
    pub fn outdated(&self, client: &str, convention: &str, now: &Hardware) -> Option<Reason> {
        if self.is_simulated {
            return None;
        }
        let rooms = self.rooms.borrow();
        let room = rooms.0.get(client)?;
        let HardwareChange { part, was, is } =
            changes(&room.hardware, now, Some((room.convention.name(), convention))).into_iter().next()?;
        Some(Reason::CalibrationOutdated { client: client.into(), version: room.version, part, was, is })
    }

    /// Store a calibration and put it in force.
    pub async fn accept(&self, store: &Store, new: &NewCalibration) -> Result<i64, StoreError> {
        let _one_at_a_time = self.changing.lock().await;
        let id = store.add_calibration(new).await?;
        self.rooms.send_replace(Arc::new(Rooms::read(store).await?));
        Ok(id)
    }

    /// Put a stored calibration in force, or out of it.
    pub async fn choose(
        &self,
        store: &Store,
        summary: &CalibrationSummary,
        is_in_force: bool,
        author: &str,
    ) -> Result<(), StoreError> {
        let _one_at_a_time = self.changing.lock().await;
        store.choose_calibration(summary, is_in_force, author).await?;
        self.rooms.send_replace(Arc::new(Rooms::read(store).await?));
        Ok(())
    }

    /// A stored calibration with what has changed since.
    pub fn shown(&self, mut calibration: Calibration, published: &Published) -> Calibration {
        calibration.summary.changed = changes(&calibration.hardware, &self.hardware(published), None);
        calibration
    }
}

impl Rooms {
    async fn read(store: &Store) -> Result<Self, StoreError> {
        let mut rooms = BTreeMap::new();
        for Calibration { summary, hardware, .. } in store.calibrations().await? {
            if summary.in_force
                && let Some((convention, map)) = summary.result.room()
            {
                rooms.insert(summary.subject, Room { version: summary.version, convention, map, hardware });
            }
        }
        Ok(Self(rooms))
    }
}

/// Nothing is measured or put in force while the machine may move by itself.
pub const fn moves(mode: Mode) -> bool {
    matches!(mode, Mode::Homing | Mode::Following | Mode::ProtectiveStop)
}

fn changes(then: &Hardware, now: &Hardware, declared: Option<(&str, &str)>) -> Vec<HardwareChange> {
    let mut changes = then.changes(now);
    if let Some((was, is)) = declared
        && was != is
    {
        changes.push(HardwareChange { part: HardwarePart::Convention, was: was.into(), is: is.into() });
    }
    changes
}

fn hardware(config: &Config) -> Hardware {
    let travel = config.machine.travel();
    let (roboclaw, odrive) = (&config.machine.roboclaw, &config.machine.odrive);
    let board = match config.machine.kind {
        MachineKind::Simulated => None,
        MachineKind::RoboClaw => {
            Some((&roboclaw.port, [roboclaw.x.counts_per_metre, roboclaw.y.counts_per_metre]))
        }
        MachineKind::Odrive => Some((&odrive.port, [odrive.x.turns_per_metre, odrive.y.turns_per_metre])),
    };
    Hardware {
        machine: config.machine.kind.name().into(),
        travel_m: [[travel.min.x, travel.min.y], [travel.max.x, travel.max.y]],
        controller: board.map(|(port, _)| port.display().to_string()),
        firmware: None,
        counts_per_metre: board.map(|(_, counts_per_metre)| counts_per_metre),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with_room(config: &Config, made_on: Hardware) -> Calibrations {
        let map = RigidMap::from_yaw(1.0, [1.0, 2.0, 0.0].into());
        let room = Room { version: 3, convention: Convention::Openxr, map, hardware: made_on };
        Calibrations {
            rooms: watch::Sender::new(Arc::new(Rooms([("headset 1".to_owned(), room)].into()))),
            configured: RigidMap::from_yaw(0.0, [0.0; 3].into()),
            hardware: hardware(config),
            is_simulated: config.machine.kind.is_simulated(),
            changing: Mutex::default(),
            bench: Bench::default(),
        }
    }

    fn real() -> Config {
        let mut config = Config::default();
        config.machine.kind = MachineKind::RoboClaw;
        config
    }

    #[test]
    fn a_real_machine_is_not_armed_for_a_client_calibrated_on_other_hardware() {
        let config = real();
        let now = hardware(&config);
        let same = with_room(&config, now.clone());
        assert_eq!(same.outdated("headset 1", "openxr", &now), None);
        assert_eq!(same.outdated("headset 2", "openxr", &now), None, "it relies on no calibration");
        let other = Hardware { controller: Some("/dev/another".into()), ..now.clone() };
        let why = with_room(&config, other).outdated("headset 1", "openxr", &now).unwrap();
        assert!(why.to_string().contains("motor controller was /dev/another"), "{why}");
        let why = same.outdated("headset 1", "unity", &now).unwrap();
        assert!(why.to_string().contains("client's convention was openxr and is unity"), "{why}");
    }

    #[test]
    fn the_hardware_of_each_machine_is_its_own_controller_and_encoders() {
        let mut config = real();
        let roboclaw = hardware(&config);
        config.machine.kind = MachineKind::Odrive;
        let odrive = hardware(&config);
        assert_eq!((odrive.machine.as_str(), odrive.controller.as_deref()), ("odrive", Some("/dev/odrive")));
        assert_eq!(odrive.counts_per_metre, Some([45.454_545, 46.666_667]));
        let parts: Vec<_> = roboclaw.changes(&odrive).into_iter().map(|change| change.part).collect();
        assert!(
            parts.contains(&HardwarePart::Machine) && parts.contains(&HardwarePart::Controller),
            "{parts:?}"
        );
    }

    #[test]
    fn a_simulated_machine_is_armed_all_the_same() {
        let config = Config::default();
        let other = Hardware { machine: "roboclaw".into(), ..hardware(&config) };
        assert_eq!(with_room(&config, other).outdated("headset 1", "openxr", &hardware(&config)), None);
    }

    #[test]
    fn a_client_that_declares_other_axes_is_not_calibrated() {
        let config = Config::default();
        let calibrations = with_room(&config, hardware(&config));
        assert!(calibrations.map("headset 1", Convention::Unity).is_none());
        let configured = ClientFrame::new(Convention::Unity, calibrations.configured);
        assert_eq!(calibrations.frame("headset 1", Convention::Unity), configured);
        assert_ne!(
            calibrations.frame("headset 1", Convention::Openxr).client_from_room(),
            configured.client_from_room()
        );
    }
}
