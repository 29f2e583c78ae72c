//! What the simulated machine is made of. Every number says where it comes from:
//!
//! - *paper*: printed in the CoVR paper (motor and gearbox types, their torque, controller, encoder type).
//! - *part*: what the named part is known for; the board's and the encoder's manuals.
//! - *class*: typical of 24 V brushed motors of that frame size; the winding used is not printed in the paper.
//! - *chosen*: nowhere printed; the reasoning stands beside it. Identification on a real machine replaces it.

use std::f64::consts::TAU;

use covr_engine::frames::Floor;
use covr_engine::machine::{AxisLimits, Limits, Travel};
use covr_engine::time::Span;

use crate::homing::HomingParameters;

/// A brushed DC motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorParameters {
    /// Winding resistance with brushes, ohm.
    pub resistance_ohm: f64,
    /// Winding inductance, H.
    pub inductance_h: f64,
    /// Torque constant, N m/A; the same number is the back-EMF constant, V s/rad.
    pub torque_constant: f64,
    /// Rotor inertia, kg m2.
    pub rotor_inertia_kgm2: f64,
}

/// One axis: motor, gearbox, belt, what they move, and what resists. The belt is stiff in this model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisParameters {
    /// The motor.
    pub motor: MotorParameters,
    /// Motor turns a pulley turn.
    pub gear_ratio: f64,
    /// Belt travel a pulley turn, m.
    pub pulley_circumference_m: f64,
    /// Greatest torque at the gearbox's output, N m. Not enforced: a test holds normal motion below it.
    pub gearbox_torque_nm: f64,
    /// What moves along this axis, without the rotor, kg.
    pub moving_mass_kg: f64,
    /// Friction while moving, gearbox losses included, N at the belt.
    pub coulomb_n: f64,
    /// Friction to break loose from rest, N at the belt.
    pub stiction_n: f64,
    /// Friction that grows with speed, N s/m.
    pub viscous_n_s_per_m: f64,
    /// Encoder counts a motor turn, after quadrature.
    pub counts_per_turn: f64,
}

/// How the position and velocity loops are tuned; gains follow from these and the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tuning {
    /// Bandwidth of the velocity loop, rad/s.
    pub velocity_bandwidth_rad_per_s: f64,
    /// Integral over proportional gain of the velocity loop, 1/s.
    pub integral_rate_per_s: f64,
    /// Proportional gain of the position loop, 1/s.
    pub position_gain_per_s: f64,
}

/// A whole simulated machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineParameters {
    /// The long rail.
    pub x: AxisParameters,
    /// The cross rail.
    pub y: AxisParameters,
    /// What hangs on the column beyond the moving masses, kg; the tuning does not know of it.
    pub load_kg: f64,
    /// Supply voltage, V.
    pub supply_volts: f64,
    /// Above this the controller cuts the motor current, A. Above the 5 A of R5, so that R5 can see a jam.
    pub current_limit_amps: f64,
    /// The loops.
    pub tuning: Tuning,
    /// Homing.
    pub homing: HomingParameters,
    /// How far outside the travel the spring stops begin, m.
    pub stop_outside_m: f64,
    /// Stiffness of the spring stops, N/m.
    pub stop_stiffness_n_per_m: f64,
    /// With no packet for this long the controller brakes to rest and holds. RoboClaw sets it in steps of 0.1 s.
    pub serial_timeout: Span,
    /// What each axis may do.
    pub limits: Limits,
    /// Where the column's centre can stand, room frame.
    pub travel: Travel,
    /// Where the column truly stands when the power comes on, room frame.
    pub start: Floor,
    /// Where it is told that it was parked: what it reports counts from there until it is homed, room frame.
    pub parked: Floor,
}

/// A parameter that no machine can have.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{what}: found {found}, expected {expected}")]
pub struct ParameterProblem {
    /// The parameter.
    pub what: &'static str,
    /// Its value.
    pub found: f64,
    /// What it should be.
    pub expected: &'static str,
}

impl MotorParameters {
    /// Dunkermotoren GR 55x30 (paper), as a 24 V winding of that size (class): about 4000 rpm without load.
    pub const GR_55X30: Self = Self {
        resistance_ohm: 1.1,
        inductance_h: 1.5e-3,
        torque_constant: 0.058,
        rotor_inertia_kgm2: 2.5e-5,
    };

    /// Dunkermotoren GR 63x55 (paper), as a 24 V winding of that size (class): about 3800 rpm without load.
    pub const GR_63X55: Self = Self {
        resistance_ohm: 0.45,
        inductance_h: 0.9e-3,
        torque_constant: 0.060,
        rotor_inertia_kgm2: 7.5e-5,
    };
}

impl AxisParameters {
    /// X: GR 55x30 with KPL43, 1.81 N m (paper).
    ///
    /// Ratio and pulley (chosen): 5 and 22 teeth of 5 mm, so that 1.1 m/s is 3000 rpm, the rated region of the motor
    /// at 24 V. Moving mass (chosen): a 15 cm square, 2 m high skeleton of light aluminium profile 8 kg, carriage with
    /// bearings 3 kg, one panel 3 kg. The 80 kg of the paper are a load on top: at 5 A this axis gives 83 N, so a
    /// loaded column needs gentler limits. Friction (chosen): 7 % of the weight, as plastic or lightly preloaded roller
    /// guides have, with gearbox and belt; 30 % more to break loose. Encoder: AEAT-601B-F06 (paper), 256 cycles a turn
    /// (part), on the motor shaft: one count is 21 micrometres.
    pub const PAPER_X: Self = Self {
        motor: MotorParameters::GR_55X30,
        gear_ratio: 5.0,
        pulley_circumference_m: 0.110,
        gearbox_torque_nm: 1.81,
        moving_mass_kg: 14.0,
        coulomb_n: 10.0,
        stiction_n: 13.0,
        viscous_n_s_per_m: 6.0,
        counts_per_turn: 1024.0,
    };

    /// Y: GR 63x55 with KPL57, 9.75 N m (paper).
    ///
    /// Ratio and pulley (chosen): 7 and 30 teeth of 5 mm: 1.1 m/s is 3080 rpm. Moving mass (chosen): what X moves and
    /// a 4 m beam of 2.25 kg/m with the X drive, 3 kg. At 1.25 m/s2 and 1.1 m/s it takes about 3.7 A, braking at
    /// 2.5 m/s2 about 3.8 A, in simulation with peaks of 4.2 A at changes of acceleration: below the 5 A of R5. Friction
    /// and encoder as for X.
    pub const PAPER_Y: Self = Self {
        motor: MotorParameters::GR_63X55,
        gear_ratio: 7.0,
        pulley_circumference_m: 0.150,
        gearbox_torque_nm: 9.75,
        moving_mass_kg: 26.0,
        coulomb_n: 14.0,
        stiction_n: 18.0,
        viscous_n_s_per_m: 10.0,
        counts_per_turn: 1024.0,
    };

    /// Motor angle a metre of belt, rad/m.
    pub fn motor_rad_per_m(&self) -> f64 {
        TAU * self.gear_ratio / self.pulley_circumference_m
    }

    /// Force at the belt an ampere, N/A; the same number is the back-EMF, V s/m.
    pub fn force_per_amp(&self) -> f64 {
        self.motor.torque_constant * self.motor_rad_per_m()
    }

    /// Moving mass and the rotor's inertia as seen at the belt, kg.
    pub fn effective_mass_kg(&self) -> f64 {
        self.moving_mass_kg + self.motor.rotor_inertia_kgm2 * self.motor_rad_per_m().powi(2)
    }

    /// Belt travel a count, m.
    pub fn metres_per_count(&self) -> f64 {
        self.pulley_circumference_m / (self.gear_ratio * self.counts_per_turn)
    }

    /// Torque at the gearbox's output for a force at the belt, N m.
    pub fn gearbox_torque_at(&self, belt_force_n: f64) -> f64 {
        belt_force_n * self.pulley_circumference_m / TAU
    }
}

impl MachineParameters {
    /// The paper's machine over `travel`, standing in the middle when the power comes on.
    ///
    /// Supply 24 V (chosen: the motors' rated voltage; the RoboClaw 2x30A V5E takes up to 34 V). Tuning (chosen): a
    /// velocity bandwidth that 6 ms of encoder window, winding and sampling delay allow, position a tenth of it.
    pub fn paper(travel: Travel) -> Self {
        Self {
            x: AxisParameters::PAPER_X,
            y: AxisParameters::PAPER_Y,
            load_kg: 0.0,
            supply_volts: 24.0,
            current_limit_amps: 7.0,
            tuning: Tuning {
                velocity_bandwidth_rad_per_s: 100.0,
                integral_rate_per_s: 20.0,
                position_gain_per_s: 10.0,
            },
            homing: HomingParameters {
                creep_mps: 0.1,
                approach_mps: 0.02,
                switch_outside_m: 0.01,
                rest_inside_m: 0.05,
            },
            stop_outside_m: 0.03,
            stop_stiffness_n_per_m: 40_000.0,
            serial_timeout: Span::from_millis(200),
            limits: Limits::PAPER,
            travel,
            start: travel.centre(),
            parked: travel.centre(),
        }
    }

    /// The first thing that no machine can have.
    pub(crate) fn check(&self) -> Result<(), ParameterProblem> {
        let axis = |a: &AxisParameters, l: &AxisLimits| {
            positive("resistance_ohm", a.motor.resistance_ohm)?;
            positive("inductance_h", a.motor.inductance_h)?;
            positive("torque_constant", a.motor.torque_constant)?;
            positive("gear_ratio", a.gear_ratio)?;
            positive("pulley_circumference_m", a.pulley_circumference_m)?;
            positive("moving_mass_kg", a.moving_mass_kg)?;
            positive("counts_per_turn", a.counts_per_turn)?;
            positive("speed_mps", l.speed_mps)?;
            positive("acceleration_mps2", l.acceleration_mps2)?;
            positive("braking_mps2", l.braking_mps2)?;
            positive("jerk_mps3", l.jerk_mps3)?;
            not_negative("rotor_inertia_kgm2", a.motor.rotor_inertia_kgm2)?;
            not_negative("coulomb_n", a.coulomb_n)?;
            not_negative("stiction_n less coulomb_n", a.stiction_n - a.coulomb_n)?;
            not_negative("viscous_n_s_per_m", a.viscous_n_s_per_m)
        };
        axis(&self.x, &self.limits.x)?;
        axis(&self.y, &self.limits.y)?;
        not_negative("load_kg", self.load_kg)?;
        positive("supply_volts", self.supply_volts)?;
        positive("current_limit_amps", self.current_limit_amps)?;
        positive("velocity_bandwidth_rad_per_s", self.tuning.velocity_bandwidth_rad_per_s)?;
        not_negative("integral_rate_per_s", self.tuning.integral_rate_per_s)?;
        positive("position_gain_per_s", self.tuning.position_gain_per_s)?;
        positive("creep_mps", self.homing.creep_mps)?;
        positive("approach_mps", self.homing.approach_mps)?;
        positive("stop_outside_m less switch_outside_m", self.stop_outside_m - self.homing.switch_outside_m)?;
        not_negative("rest_inside_m", self.homing.rest_inside_m)?;
        positive("stop_stiffness_n_per_m", self.stop_stiffness_n_per_m)?;
        positive("serial_timeout", self.serial_timeout.secs())?;
        positive("travel along x", self.travel.max.x - self.travel.min.x)?;
        positive("travel along y", self.travel.max.y - self.travel.min.y)?;
        // Axis by axis: a depth over both would let an undefined number pass.
        not_negative("start.x above the travel's low end", self.start.x - self.travel.min.x)?;
        not_negative("start.y above the travel's low end", self.start.y - self.travel.min.y)?;
        not_negative("start.x below the travel's high end", self.travel.max.x - self.start.x)?;
        not_negative("start.y below the travel's high end", self.travel.max.y - self.start.y)
    }
}

fn positive(what: &'static str, found: f64) -> Result<(), ParameterProblem> {
    let is_right = found > 0.0 && found.is_finite();
    if is_right { Ok(()) } else { Err(ParameterProblem { what, found, expected: "a number above 0" }) }
}

fn not_negative(what: &'static str, found: f64) -> Result<(), ParameterProblem> {
    let is_right = found >= 0.0 && found.is_finite();
    if is_right { Ok(()) } else { Err(ParameterProblem { what, found, expected: "a number of at least 0" }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn room() -> Travel {
        Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) }
    }

    #[test]
    fn the_top_speed_leaves_voltage_for_acceleration() {
        let machine = MachineParameters::paper(room());
        for (axis, limits) in [(machine.x, machine.limits.x), (machine.y, machine.limits.y)] {
            let force = axis.effective_mass_kg() * limits.acceleration_mps2
                + axis.coulomb_n
                + axis.viscous_n_s_per_m * limits.speed_mps;
            let amps = force / axis.force_per_amp();
            let volts = axis.force_per_amp() * limits.speed_mps + amps * axis.motor.resistance_ohm;
            assert!(amps < 4.0, "{amps} A");
            assert!(volts < 0.95 * machine.supply_volts, "{volts} V");
            assert!(axis.gearbox_torque_at(force) < axis.gearbox_torque_nm);
        }
    }

    #[test]
    fn a_machine_that_cannot_be_is_refused_by_name() {
        let mut machine = MachineParameters::paper(room());
        machine.x.moving_mass_kg = 0.0;
        assert_eq!(machine.check().unwrap_err().what, "moving_mass_kg");
        let mut machine = MachineParameters::paper(room());
        machine.start = Floor::new(f64::NAN, 1.0);
        assert_eq!(machine.check().unwrap_err().what, "start.x above the travel's low end");
    }
}
