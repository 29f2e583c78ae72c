//! One axis as physics has it: winding, force, friction, stops, and what the encoder sees of it.
//!
//! It knows nothing of rooms, commands or links. Positions are metres along the axis in the room frame.

use super::faults::AxisFaults;
use super::parameters::{AxisParameters, MachineParameters};

/// The true state of one axis.
#[derive(Debug, Clone)]
pub(crate) struct Plant {
    position_m: f64,
    speed_mps: f64,
    amps: f64,
    /// Where the encoder believes to be, counted from power-on, m.
    encoded_m: f64,
    /// Force from outside, N.
    pub(crate) push_n: f64,
    constants: Constants,
}

#[derive(Debug, Clone)]
struct Constants {
    force_per_amp: f64,
    siemens: f64,
    winding_share: f64,
    current_limit_amps: f64,
    per_mass: f64,
    coulomb_n: f64,
    stiction_n: f64,
    viscous_n_s_per_m: f64,
    stop_low_m: f64,
    stop_high_m: f64,
    stop_stiffness_n_per_m: f64,
    stop_damping_n_s_per_m: f64,
    counts_per_m: f64,
}

impl Plant {
    pub(crate) fn new(
        axis: &AxisParameters,
        machine: &MachineParameters,
        (low_m, high_m): (f64, f64),
        start_m: f64,
    ) -> Self {
        let mass = axis.effective_mass_kg() + machine.load_kg;
        let motor = &axis.motor;
        let constants = Constants {
            force_per_amp: axis.force_per_amp(),
            siemens: 1.0 / motor.resistance_ohm,
            // Exact for a step of constant voltage and speed, so that a fast winding cannot make the step unstable.
            winding_share: 1.0 - (-STEP_SECS * motor.resistance_ohm / motor.inductance_h).exp(),
            current_limit_amps: machine.current_limit_amps,
            per_mass: 1.0 / mass,
            coulomb_n: axis.coulomb_n,
            stiction_n: axis.stiction_n,
            viscous_n_s_per_m: axis.viscous_n_s_per_m,
            stop_low_m: low_m - machine.stop_outside_m,
            stop_high_m: high_m + machine.stop_outside_m,
            stop_stiffness_n_per_m: machine.stop_stiffness_n_per_m,
            stop_damping_n_s_per_m: 2.0 * STOP_DAMPING_RATIO * (machine.stop_stiffness_n_per_m * mass).sqrt(),
            counts_per_m: 1.0 / axis.metres_per_count(),
        };
        Self { position_m: start_m, speed_mps: 0.0, amps: 0.0, encoded_m: 0.0, push_n: 0.0, constants }
    }

    /// One step of [`STEP_SECS`] with `volts` on the motor, or with the bridge open.
    pub(crate) fn step(&mut self, volts: Option<f64>, faults: &AxisFaults) {
        let c = &self.constants;
        let before = self.speed_mps;
        self.amps = match volts {
            Some(volts) => {
                let settled = (volts - c.force_per_amp * before) * c.siemens;
                (self.amps + (settled - self.amps) * c.winding_share)
                    .clamp(-c.current_limit_amps, c.current_limit_amps)
            }
            None => 0.0,
        };
        let pull = c.force_per_amp * self.amps - c.viscous_n_s_per_m * before
            + self.stop_force_n(before)
            + self.push_n;
        let jam = if faults.stalled { JAM_N } else { 0.0 };
        let after = if before == 0.0 {
            // Stuck until the pull breaks it loose: no sign of a tiny speed to chatter with.
            if pull.abs() <= c.stiction_n + jam {
                0.0
            } else {
                STEP_SECS * c.per_mass * (pull - pull.signum() * (c.coulomb_n + jam))
            }
        } else {
            let after = before + STEP_SECS * c.per_mass * (pull - before.signum() * (c.coulomb_n + jam));
            // Friction may stop it; only the next step's pull may start it the other way.
            if after * before < 0.0 { 0.0 } else { after }
        };
        let moved = 0.5 * (before + after) * STEP_SECS;
        self.speed_mps = after;
        self.position_m += moved;
        self.encoded_m += moved * (1.0 - faults.encoder_slip);
    }

    /// Cut the current above `amps` from now on.
    pub(crate) const fn limit_current(&mut self, amps: f64) {
        self.constants.current_limit_amps = amps;
    }

    pub(crate) const fn position_m(&self) -> f64 {
        self.position_m
    }

    pub(crate) const fn speed_mps(&self) -> f64 {
        self.speed_mps
    }

    pub(crate) const fn amps(&self) -> f64 {
        self.amps
    }

    /// Encoder counts since power-on.
    pub(crate) fn counts(&self) -> i64 {
        (self.encoded_m * self.constants.counts_per_m).floor() as i64
    }

    fn stop_force_n(&self, speed_mps: f64) -> f64 {
        let c = &self.constants;
        if self.position_m < c.stop_low_m {
            let depth = c.stop_low_m - self.position_m;
            (c.stop_stiffness_n_per_m * depth - c.stop_damping_n_s_per_m * speed_mps).max(0.0)
        } else if self.position_m > c.stop_high_m {
            let depth = c.stop_high_m - self.position_m;
            (c.stop_stiffness_n_per_m * depth - c.stop_damping_n_s_per_m * speed_mps).min(0.0)
        } else {
            0.0
        }
    }
}

/// The inner step.
pub(crate) const STEP_MICROS: i64 = 500;
const STEP_SECS: f64 = STEP_MICROS as f64 * 1e-6;
/// Friction of a jammed carriage: far above what 7 A can pull, low enough that it stops in a real distance.
const JAM_N: f64 = 2_000.0;
/// Rubber-cushioned springs: they give back a third of the speed.
const STOP_DAMPING_RATIO: f64 = 0.35;

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::frames::Floor;
    use covr_engine::machine::Travel;

    fn plant() -> Plant {
        let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        let machine = MachineParameters::paper(travel);
        Plant::new(&machine.x, &machine, (0.0, 4.0), 2.0)
    }

    fn run(plant: &mut Plant, secs: f64, volts: Option<f64>) {
        for _ in 0..(secs / STEP_SECS).round() as usize {
            plant.step(volts, &AxisFaults::default());
        }
    }

    #[test]
    fn a_constant_voltage_ends_at_the_speed_where_back_emf_and_friction_take_it_up() {
        let mut plant = plant();
        run(&mut plant, 1.0, Some(12.0));
        let axis = AxisParameters::PAPER_X;
        let k = axis.force_per_amp();
        let r = axis.motor.resistance_ohm;
        let expected = (k / r * 12.0 - axis.coulomb_n) / (k * k / r + axis.viscous_n_s_per_m);
        assert!((plant.speed_mps() - expected).abs() < 1e-3, "{} {expected}", plant.speed_mps());
    }

    #[test]
    fn stiction_holds_exactly_still_and_lets_go_above_its_force() {
        let mut plant = plant();
        plant.push_n = 12.9;
        run(&mut plant, 1.0, None);
        assert_eq!(plant.speed_mps(), 0.0);
        assert_eq!(plant.position_m(), 2.0);
        plant.push_n = 13.1;
        run(&mut plant, 0.1, None);
        assert!(plant.speed_mps() > 0.0);
    }

    #[test]
    fn a_released_axis_coasts_to_rest_as_energy_and_friction_say() {
        let mut plant = plant();
        plant.speed_mps = 0.5;
        run(&mut plant, 3.0, None);
        let axis = AxisParameters::PAPER_X;
        let (m, b, f) = (axis.effective_mass_kg(), axis.viscous_n_s_per_m, axis.coulomb_n);
        let expected = m / b * (0.5 - f / b * (1.0 + b * 0.5 / f).ln());
        assert_eq!(plant.speed_mps(), 0.0);
        assert!((plant.position_m() - 2.0 - expected).abs() < 1e-3);
    }

    #[test]
    fn a_stop_turns_the_carriage_back_within_centimetres() {
        let mut plant = plant();
        plant.position_m = 3.9;
        plant.speed_mps = 1.1;
        let mut furthest = 0.0_f64;
        for _ in 0..4_000 {
            plant.step(None, &AxisFaults::default());
            furthest = furthest.max(plant.position_m());
        }
        assert!(furthest > 4.03 && furthest < 4.06, "{furthest}");
        assert_eq!(plant.speed_mps(), 0.0);
    }
}
