//! Against the simulated motors: winding, mass, friction, counts and current steps, behind a velocity loop and a delayed link.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use covr_engine::frames::Floor;
use covr_engine::machine::Travel;
use proptest::prelude::*;

use super::super::delays;
use super::*;
use crate::sim::faults::AxisFaults;
use crate::sim::parameters::{AxisParameters, MachineParameters};
use crate::sim::plant::Plant;

/// How a run is recorded.
struct Rig {
    axis: AxisParameters,
    /// One way of the link, ms.
    link_millis: usize,
    /// Between two samples, ms.
    every_millis: usize,
    is_signed: bool,
}

/// Steps both ways, then a chirp from 0.2 to 2 Hz, m/s.
fn command(at_secs: f64) -> f64 {
    let steps = [0.0, 0.3, 0.0, -0.3, 0.0, 0.7, 0.3, -0.3, -0.8, 0.0];
    let step = (at_secs / 0.8) as usize;
    if step < steps.len() {
        return steps[step];
    }
    let t = at_secs - 0.8 * steps.len() as f64;
    let (low, high, length) = (0.2, 2.0, 8.0);
    0.5 * (TAU * (low * t + (high - low) * t * t / (2.0 * length))).sin()
}

impl Rig {
    fn record(&self) -> Vec<Sample> {
        let travel = Travel { min: Floor::new(-50.0, -50.0), max: Floor::new(50.0, 50.0) };
        let machine = MachineParameters { current_limit_amps: 20.0, ..MachineParameters::paper(travel) };
        let mut plant = Plant::new(&self.axis, &machine, (-50.0, 50.0), 0.0);
        let faults = AxisFaults::default();
        let count_m = self.axis.metres_per_count();
        let force = self.axis.force_per_amp();
        let to_volts = self.axis.effective_mass_kg() * self.axis.motor.resistance_ohm / force;
        let (mut integral, mut ramp, mut counts) = (0.0, 0.0_f64, VecDeque::from([0_i64; 9]));
        let mut commands: VecDeque<f64> = vec![0.0; self.link_millis].into();
        let mut answers: VecDeque<(f64, f64)> = vec![(0.0, 0.0); self.link_millis].into();
        let mut samples = Vec::new();
        for milli in 0..16_000_usize {
            let at_secs = milli as f64 * 1e-3;
            commands.push_back(command(at_secs));
            let asked = commands.pop_front().unwrap_or_default();
            // A board ramps: a step of speed would only find its current limit.
            ramp += (asked - ramp).clamp(-0.003, 0.003);
            counts.push_back(plant.counts());
            let oldest = counts.pop_front().unwrap_or_default();
            let measured = (plant.counts() - oldest) as f64 * count_m / 0.008;
            let error = ramp - measured;
            integral += error * 1e-3;
            let volts = force * ramp + to_volts * (60.0 * error + 900.0 * integral);
            for _ in 0..2 {
                plant.step(Some(volts.clamp(-24.0, 24.0)), &faults);
            }
            let amps = (plant.amps() / 0.01).round() * 0.01;
            answers
                .push_back((plant.counts() as f64 * count_m, if self.is_signed { amps } else { amps.abs() }));
            let (position_m, current_amps) = answers.pop_front().unwrap_or_default();
            if milli % self.every_millis == 0 {
                samples.push(Sample { at_secs, command_mps: command(at_secs), position_m, current_amps });
            }
        }
        samples
    }
}

fn any_axis() -> impl Strategy<Value = AxisParameters> {
    (any::<bool>(), 8.0..40.0_f64, 4.0..25.0_f64, 1.0..1.5_f64, 2.0..30.0_f64).prop_map(
        |(is_x, moving_mass_kg, coulomb_n, stick, viscous_n_s_per_m)| {
            let axis = if is_x { AxisParameters::PAPER_X } else { AxisParameters::PAPER_Y };
            AxisParameters {
                moving_mass_kg,
                coulomb_n,
                stiction_n: coulomb_n * stick,
                viscous_n_s_per_m,
                ..axis
            }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn the_simulated_motors_are_found_again(
        axis in any_axis(),
        every_millis in prop::sample::select(vec![4_usize, 8, 11]),
        is_signed in any::<bool>(),
    ) {
        let samples = Rig { axis, link_millis: 3, every_millis, is_signed }.record();
        let found = identify(&samples).unwrap();
        let force = axis.force_per_amp();
        let truth = [axis.effective_mass_kg() / force, axis.viscous_n_s_per_m / force, axis.coulomb_n / force];
        prop_assert!((found.inertia / truth[0] - 1.0).abs() < 0.05, "{found:?}, truth {truth:?}");
        // In amperes at 1 m/s, and at any speed.
        prop_assert!((found.viscous - truth[1]).abs() < 0.05, "{found:?}, truth {truth:?}");
        prop_assert!((found.coulomb_amps - truth[2]).abs() < 0.05, "{found:?}, truth {truth:?}");
        let limit = (5.0 * force - axis.coulomb_n) / axis.effective_mass_kg();
        prop_assert!((found.acceleration_mps2(5.0, 0.0) / limit - 1.0).abs() < 0.06);
    }

    /// The loop's own lag is in it; what a longer link adds is what comes out more.
    #[test]
    fn a_longer_link_is_found_to_the_millisecond(link_millis in 1_usize..40) {
        let run = |link_millis| {
            let axis = AxisParameters::PAPER_X;
            delays(&Rig { axis, link_millis, every_millis: 4, is_signed: true }.record())
        };
        let (short, long) = (run(0), run(link_millis));
        let both_ways = 2.0 * link_millis as f64 * 1e-3;
        let more = long.command_to_motion_secs.unwrap() - short.command_to_motion_secs.unwrap();
        prop_assert!((more - both_ways).abs() < 0.002, "{more} s, not {both_ways}");
        let more = long.command_to_current_secs.unwrap() - short.command_to_current_secs.unwrap();
        prop_assert!((more - both_ways).abs() < 0.0045, "{more} s, not {both_ways}");
        prop_assert!(long.steps >= 5);
    }
}

fn run() -> Vec<Sample> {
    Rig { axis: AxisParameters::PAPER_X, link_millis: 3, every_millis: 4, is_signed: true }.record()
}

#[test]
fn runs_that_tell_too_little_are_refused() {
    let all = run();
    assert!(matches!(identify(&all[..200]), Err(NotIdentified::TooShort { .. })));
    assert!(matches!(identify(&[]), Err(NotIdentified::TooShort { .. })));
    let still: Vec<Sample> = all.iter().map(|sample| Sample { position_m: 1.0, ..*sample }).collect();
    assert!(matches!(identify(&still), Err(NotIdentified::TooLittleMotion { found: 0, .. })));
    let mut back = all.clone();
    back[100].at_secs = back[99].at_secs;
    assert_eq!(identify(&back), Err(NotIdentified::BadSample { number: 101 }));
    let mut odd = all;
    odd[7].current_amps = f64::NAN;
    assert_eq!(identify(&odd), Err(NotIdentified::BadSample { number: 8 }));
}

#[test]
fn one_speed_alone_does_not_tell_the_frictions_apart() {
    let steady: Vec<Sample> = (0..1_000)
        .map(|n| {
            let at_secs = f64::from(n) * 0.004;
            Sample {
                at_secs,
                command_mps: 0.3,
                position_m: 0.3 * at_secs,
                current_amps: 1.0 + 0.1 * f64::from(n % 2),
            }
        })
        .collect();
    assert!(matches!(identify(&steady), Err(NotIdentified::NotExcited { part: "inertia", .. })));
    // Up and down about one speed tells the inertia, and no more.
    let about_one: Vec<Sample> = (0..2_000)
        .map(|n| {
            let at_secs = f64::from(n) * 0.004;
            let (w, size) = (TAU * 1.5, 0.02);
            Sample {
                at_secs,
                command_mps: 0.3,
                position_m: 0.3 * at_secs - size / w * (w * at_secs).cos(),
                current_amps: 1.0 + 0.9 * size * w * (w * at_secs).cos(),
            }
        })
        .collect();
    let refused = identify(&about_one).unwrap_err();
    assert!(matches!(refused, NotIdentified::NotExcited { part: "viscous friction", .. }), "{refused:?}");
}

#[test]
fn the_current_of_another_axis_is_refused() {
    let all = run();
    let mixed: Vec<Sample> = (0..all.len())
        .map(|n| Sample { current_amps: all[(n * 37 + 11) % all.len()].current_amps, ..all[n] })
        .collect();
    let refused = identify(&mixed).unwrap_err();
    assert!(
        matches!(
            refused,
            NotIdentified::PoorFit { .. }
                | NotIdentified::NotExcited { .. }
                | NotIdentified::Impossible { .. }
        ),
        "{refused:?}"
    );
}
