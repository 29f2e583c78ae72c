//! The commissioning that counts, and why a real machine is not armed without one.

use std::sync::{Mutex, PoisonError};

use covr_wire::calibration::{Hardware, HardwareChange};
use covr_wire::commissioning::{Commissioning, RailAxis};
use covr_wire::reason::Reason;

use crate::config::Config;
use crate::store::{Store, StoreError};

/// Commissionings.
#[derive(Debug)]
pub struct Commissionings {
    last: Mutex<Option<Commissioning>>,
    /// Nothing moves that could hurt anybody.
    is_harmless: bool,
    /// What separation relies on, m/s2.
    braking_mps2: [f64; 2],
}

impl Commissionings {
    /// Those that the store has.
    pub async fn open(config: &Config, store: &Store) -> Result<Self, StoreError> {
        let last = store.commissionings().await?.into_iter().next();
        Ok(Self::new(config, last))
    }

    fn new(config: &Config, last: Option<Commissioning>) -> Self {
        let (machine, limits) = (&config.machine, config.machine.limits());
        Self {
            last: Mutex::new(last),
            is_harmless: machine.is_harmless(),
            braking_mps2: [limits.x.braking_mps2, limits.y.braking_mps2],
        }
    }

    /// Store one; it counts from now on.
    pub async fn add(&self, store: &Store, mut new: Commissioning) -> Result<Commissioning, StoreError> {
        new.id = store.add_commissioning(&new).await?;
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = Some(new.clone());
        Ok(new)
    }

    /// Why a real machine is not armed: it was not commissioned, not as it is now, or its limits say more than its brake did.
    pub fn why_not_armed(&self, now: &Hardware) -> Option<Reason> {
        if self.is_harmless {
            return None;
        }
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(last) = last.as_ref() else { return Some(Reason::NotCommissioned) };
        if let Some(HardwareChange { part, was, is }) = last.hardware.changes(now).into_iter().next() {
            return Some(Reason::CommissioningOutdated { part, was, is });
        }
        RailAxis::BOTH.into_iter().find_map(|axis| {
            let (measured_mps2, needed_mps2) =
                (last.braking_mps2[axis as usize], self.braking_mps2[axis as usize]);
            // What was good to a few percent then is so now.
            let worse = measured_mps2 < 0.95 * needed_mps2;
            worse.then_some(Reason::BrakesWorse { axis, measured_mps2, needed_mps2 })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::MachineKind;

    fn hardware(controller: &str) -> Hardware {
        Hardware {
            machine: "roboclaw".into(),
            travel_m: [[0.0, 0.0], [4.0, 4.0]],
            controller: Some(controller.into()),
            firmware: Some("USB Roboclaw 2x15a v4.3.6".into()),
            counts_per_metre: Some([46_545.0; 2]),
        }
    }

    fn with(kind: MachineKind, emulated: bool, last: Option<[f64; 2]>) -> Commissionings {
        let mut config = Config::default();
        config.machine.kind = kind;
        config.machine.roboclaw.emulated = emulated;
        let last = last.map(|braking_mps2| Commissioning {
            id: 1,
            author: "Ada".into(),
            created_at: "2026-01-01T00:00:00Z".into(),
            load_kg: 12.0,
            braking_mps2,
            runs: Vec::new(),
            hardware: hardware("/dev/roboclaw"),
            changed: Vec::new(),
        });
        Commissionings::new(&config, last)
    }

    #[test]
    fn a_real_machine_is_armed_only_as_it_was_commissioned() {
        let same = hardware("/dev/roboclaw");
        let none = with(MachineKind::RoboClaw, false, None).why_not_armed(&same);
        assert_eq!(none, Some(Reason::NotCommissioned));
        let good = with(MachineKind::RoboClaw, false, Some([2.6, 2.5]));
        assert_eq!(good.why_not_armed(&same), None);
        let other = good.why_not_armed(&hardware("/dev/another"));
        assert!(matches!(other, Some(Reason::CommissioningOutdated { .. })), "{other:?}");
        let weak = with(MachineKind::RoboClaw, false, Some([2.6, 2.0])).why_not_armed(&same);
        assert!(matches!(weak, Some(Reason::BrakesWorse { axis: RailAxis::Y, .. })), "{weak:?}");
    }

    #[test]
    fn what_cannot_hurt_anybody_is_armed_without() {
        let anything = hardware("/dev/roboclaw");
        assert_eq!(with(MachineKind::Simulated, false, None).why_not_armed(&anything), None);
        assert_eq!(with(MachineKind::RoboClaw, true, None).why_not_armed(&anything), None);
        // Boards of another machine being emulated ones says nothing of this one's.
        assert_eq!(
            with(MachineKind::Odrive, true, None).why_not_armed(&anything),
            Some(Reason::NotCommissioned)
        );
    }
}
