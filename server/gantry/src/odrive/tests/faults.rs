//! Each switch of the emulator: what the driver makes of it.

use covr_engine::machine::{Drive, Trouble};

use super::*;
use crate::emulation::{Axis, Emulated as _};

/// Cycle under a setpoint that stays, for so long; how many cycles were lost.
fn stand(bench: &mut Bench, secs: f64) -> (u32, u32) {
    let at = bench.session.report().position;
    let begun = bench.port.time();
    let (mut whole, mut lost) = (0, 0);
    while (bench.port.time() - begun).secs() < secs {
        match bench.cycle(setpoint(at, Planar::ZERO, Planar::ZERO)) {
            Ok(true) => whole += 1,
            Ok(false) | Err(Refused::Lost(_)) => lost += 1,
            Err(other) => panic!("{other}"),
        }
    }
    (whole, lost)
}

#[test]
fn lost_bytes_flipped_bits_gaps_and_missing_answers_cost_cycles_and_move_nothing() {
    for (order, mended) in [
        ("lose 0.0002", "lose 0"),
        ("flip 0.0002", "flip 0"),
        ("missing 0.01", "missing 0"),
        ("gap 0.01 40", "gap 0 0"),
        ("late 0.01 40", "late 0 0"),
    ] {
        let mut bench = Bench::homed();
        let (at, _) = bench.truth();
        bench.give(order);
        let (whole, lost) = stand(&mut bench, 8.0);
        println!("{order}: {whole} whole cycles, {lost} lost, {:?}", bench.session.tally());
        assert!(whole > 50 && bench.session.tally().lost > 0, "{order}: {whole} whole, {lost} lost");
        assert!(bench.truth().0.distance_m(at) < 0.005, "{order}");
        assert_eq!(bench.session.report().homing, Homing::Homed, "{order}");
        bench.give(mended);
        let (_, lost) = stand(&mut bench, 2.0);
        assert!(lost <= 2, "{order}: the line is well again, and {lost} cycles were lost");
    }
}

#[test]
fn an_unknown_firmware_is_refused_by_its_words() {
    for firmware in ["0.5.1", "unknown"] {
        let firmware = firmware.parse().unwrap();
        let port = Bench::world(|setup| Setup { firmware, ..setup }, Floor::new(1.0, 1.0));
        match Bench::try_new(&paper(travel()), &port) {
            Err(refused @ Refused::UnknownFirmware { .. }) => {
                assert!(refused.to_string().contains("known are 0.5.4"), "{refused}");
            }
            Err(other) => panic!("{other}"),
            Ok(_) => panic!("it was taken"),
        }
    }
}

#[test]
fn a_board_that_was_never_calibrated_is_refused_and_nothing_turns() {
    let port = Bench::world(|setup| Setup { is_calibrated: false, ..setup }, Floor::new(1.0, 1.0));
    let refused = Bench::try_new(&paper(travel()), &port).err().unwrap().to_string();
    assert!(refused.contains("axis0.motor.is_calibrated is 0, expected 1"), "{refused}");
    assert_eq!(port.with(|world| world.emulator.truth(Axis::X).position_m), 1.0);
}

#[test]
fn an_error_of_an_axis_is_told_and_it_is_switched_on_again_only_after_it_was_let_go() {
    for (order, trouble) in [
        ("error x encoder", Trouble::DriverFault),
        ("error y estop", Trouble::DriverFault),
        ("supply 7", Trouble::BadSupply),
    ] {
        let mut bench = Bench::homed();
        bench.give(order);
        let at = bench.session.report().position;
        for _ in 0..3 {
            bench.cycle(setpoint(at, Planar::ZERO, Planar::ZERO)).unwrap();
        }
        let report = bench.session.report();
        assert_eq!((report.trouble, report.drive), (Some(trouble), Drive::Released), "{order}");
        for _ in 0..100 {
            bench.cycle(Action::Hold).unwrap();
        }
        let flags = bench.port.with(|world| world.emulator.flags());
        assert!(flags.iter().any(|(_, is_on)| !is_on), "{order}: {flags:?}");
        for _ in 0..10 {
            bench.cycle(Action::Release).unwrap();
        }
        assert!(bench.session.is_over(), "{order}: let go, it is configured anew");
    }
}

#[test]
fn configured_anew_an_error_is_cleared_and_a_supply_that_stays_low_is_refused() {
    let mut bench = Bench::homed();
    bench.give("error x encoder");
    for _ in 0..20 {
        bench.cycle(Action::Release).unwrap();
    }
    assert!(Bench::try_new(&paper(travel()), &bench.port).is_ok());
    bench.give("supply 7");
    bench.port.wait(Span::from_millis(10));
    let refused = Bench::try_new(&paper(travel()), &bench.port).err().unwrap();
    assert!(matches!(refused, Refused::BadSupply { errors: 2 }), "{refused}");
}

#[test]
fn a_jammed_axis_shows_its_current() {
    let mut bench = Bench::homed();
    bench.give("jam x on");
    let at = bench.session.report().position;
    let mut most = 0.0_f64;
    for _ in 0..150 {
        bench.cycle(setpoint(at + Planar::new(0.5, 0.0), Planar::ZERO, Planar::ZERO)).unwrap();
        most = most.max(bench.session.report().current_amps[0]);
    }
    assert!(most > 5.0, "{most} A");
}

#[test]
fn a_brown_out_loses_the_home_and_nothing_moves() {
    let mut bench = Bench::homed();
    bench.give("brown-out 200");
    let at = bench.session.report().position;
    let begun = bench.port.time();
    while (bench.port.time() - begun).secs() < 4.0 {
        // What is lost while it is dark is what the link thread opens the port anew for.
        let _ = bench.cycle(setpoint(at, Planar::ZERO, Planar::ZERO));
    }
    let report = bench.session.report();
    assert_eq!(report.homing, Homing::NotHomed);
    assert!(report.trouble.is_some());
    assert_eq!(bench.port.with(|world| world.emulator.flags()), [("is_x_on", false), ("is_y_on", false)]);
}

#[test]
fn against_something_in_the_way_homing_pushes_gently() {
    let mut bench = Bench::new(Floor::new(2.0, 2.0));
    for _ in 0..100 {
        bench.cycle(Action::Home).unwrap();
    }
    bench.give("jam x on");
    let mut most = 0.0_f64;
    for _ in 0..300 {
        bench.cycle(Action::Home).unwrap();
        most = most.max(bench.session.report().current_amps[0]);
    }
    assert!(most > 1.0 && most < 3.2, "{most} A");
}
