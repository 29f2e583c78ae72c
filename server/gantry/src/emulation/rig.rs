//! What a controller drives: the motors of the simulated machine, their encoders and end switches, and the supply.

use crate::sim::faults::AxisFaults;
use crate::sim::parameters::MachineParameters;
use crate::sim::plant::{Plant, STEP_MICROS};

use super::{Axis, AxisTruth};

/// Which ends of an axis have a switch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EndSwitches {
    /// None: hard stops alone.
    None,
    /// The low end.
    Low,
    /// Both, on one pin.
    Both,
}

/// Both axes.
#[derive(Debug, Clone)]
pub(crate) struct Rig {
    pub(crate) faults: [AxisFaults; 2],
    pub(crate) supply_volts: f64,
    /// End switches that are stuck at active, or not.
    pub(crate) stuck_switches: [Option<bool>; 2],
    plants: [Plant; 2],
    volts: [Option<f64>; 2],
    /// Below the first and above the second the switch is active, m.
    switches_m: [(f64, f64); 2],
}

impl Rig {
    pub(crate) fn new(machine: &MachineParameters, end_switches: EndSwitches) -> Self {
        let MachineParameters { travel, start, .. } = machine;
        let outside_m = machine.homing.switch_outside_m;
        let places = |low_m: f64, high_m: f64| match end_switches {
            EndSwitches::None => (f64::NEG_INFINITY, f64::INFINITY),
            EndSwitches::Low => (low_m - outside_m, f64::INFINITY),
            EndSwitches::Both => (low_m - outside_m, high_m + outside_m),
        };
        Self {
            faults: [AxisFaults::default(); 2],
            supply_volts: machine.supply_volts,
            stuck_switches: [None; 2],
            plants: [
                Plant::new(&machine.x, machine, (travel.min.x, travel.max.x), start.x),
                Plant::new(&machine.y, machine, (travel.min.y, travel.max.y), start.y),
            ],
            volts: [None; 2],
            switches_m: [places(travel.min.x, travel.max.x), places(travel.min.y, travel.max.y)],
        }
    }

    /// This share of the supply on a motor from now on, or its bridge open.
    pub(crate) fn apply(&mut self, axis: Axis, duty: Option<f64>, maximum_amps: f64) {
        let index = axis.index();
        self.plants[index].limit_current(maximum_amps);
        self.volts[index] = match (duty, self.faults[index].runaway) {
            (Some(_), Some(direction)) => Some(direction.sign() * self.supply_volts),
            (duty, _) => duty.map(|duty| duty * self.supply_volts),
        };
    }

    /// A force from outside, N.
    pub(crate) const fn push(&mut self, axis: Axis, force_n: f64) {
        self.plants[axis.index()].push_n = force_n;
    }

    /// A millisecond.
    pub(crate) fn tick(&mut self) {
        for ((plant, volts), faults) in self.plants.iter_mut().zip(self.volts).zip(&self.faults) {
            for _ in 0..STEPS_A_TICK {
                plant.step(volts, faults);
            }
        }
    }

    pub(crate) fn truth(&self, axis: Axis) -> AxisTruth {
        AxisTruth {
            position_m: self.position_m(axis),
            speed_mps: self.speed_mps(axis),
            amps: self.amps(axis),
            counts: self.counts(axis),
            is_switch_active: self.is_switch_active(axis),
        }
    }

    pub(crate) fn counts(&self, axis: Axis) -> i64 {
        self.plants[axis.index()].counts()
    }

    pub(crate) const fn amps(&self, axis: Axis) -> f64 {
        self.plants[axis.index()].amps()
    }

    pub(crate) const fn position_m(&self, axis: Axis) -> f64 {
        self.plants[axis.index()].position_m()
    }

    pub(crate) const fn speed_mps(&self, axis: Axis) -> f64 {
        self.plants[axis.index()].speed_mps()
    }

    pub(crate) fn is_switch_active(&self, axis: Axis) -> bool {
        let (low_m, high_m) = self.switches_m[axis.index()];
        let at_m = self.position_m(axis);
        self.stuck_switches[axis.index()].unwrap_or(at_m <= low_m || at_m >= high_m)
    }
}

/// The controller's period.
pub(crate) const TICK_MICROS: i64 = 1_000;
const STEPS_A_TICK: i64 = TICK_MICROS / STEP_MICROS;
