//! Each switch of the emulator: what the driver makes of it.

use covr_engine::machine::Trouble;

use super::*;
use crate::roboclaw::packet::Command;

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
        ("lose 0.002", "lose 0"),
        ("flip 0.002", "flip 0"),
        ("missing 0.02", "missing 0"),
        ("gap 0.02 40", "gap 0 0"),
        ("late 0.02 40", "late 0 0"),
    ] {
        let mut bench = Bench::homed(USUAL);
        let (at, _) = bench.truth();
        bench.give(order);
        let (whole, lost) = stand(&mut bench, 8.0);
        println!("{order}: {whole} whole cycles, {lost} lost, {:?}", bench.session.tally());
        assert!(whole > 50 && bench.session.tally().lost > 0, "{order}: {whole} whole, {lost} lost");
        assert!(bench.truth().0.distance_m(at) < 0.005, "{order}");
        assert_eq!(bench.session.report().homing, Homing::Homed, "{order}");
        bench.give(mended);
        let (_, lost) = stand(&mut bench, 2.0);
        assert!(lost <= 1, "{order}: the line is well again, and {lost} cycles were lost");
    }
}

#[test]
fn an_unknown_firmware_is_refused_by_its_words() {
    let kind = Kind { firmware: "unknown", ..USUAL };
    let port = Bench::world(kind, Floor::new(1.0, 1.0));
    match Bench::try_new(kind, &port) {
        Err(Refused::UnknownFirmware { address: 0x80, found }) => assert!(!found.is_empty()),
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("it was taken"),
    }
}

#[test]
fn the_emergency_stop_pin_is_told_within_two_cycles_on_both_firmwares() {
    for firmware in ["older", "newer"] {
        let mut bench = Bench::homed(Kind { firmware, ..USUAL });
        bench.give("press");
        let at = bench.session.report().position;
        for _ in 0..2 {
            bench.cycle(setpoint(at, Planar::ZERO, Planar::ZERO)).unwrap();
        }
        assert_eq!(bench.session.report().trouble, Some(Trouble::EmergencyStop), "{firmware}");
    }
}

#[test]
fn a_jammed_axis_shows_its_current() {
    let mut bench = Bench::homed(USUAL);
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
fn a_brown_out_loses_the_home_however_much_the_board_has_kept() {
    let mut bench = Bench::homed(USUAL);
    bench.give("brown-out 200");
    let at = bench.session.report().position;
    let begun = bench.port.time();
    while (bench.port.time() - begun).secs() < 4.0 {
        // What is lost while it is dark is what the link thread opens the port anew for.
        let _ = bench.cycle(setpoint(at, Planar::ZERO, Planar::ZERO));
    }
    assert_eq!(bench.session.report().homing, Homing::NotHomed);
}

#[test]
fn a_board_whose_switches_were_not_set_up_is_driven_only_after_it_was_off() {
    let machine = MachineParameters::paper(travel());
    let setup = Setup { baud: 460_800, firmware: "4.1.34".parse().unwrap(), ..Setup::paper(machine) };
    let emulator = Emulator::new(setup).unwrap();
    let port = VirtualPort::new(emulator);
    assert!(matches!(Bench::try_new(USUAL, &port), Err(Refused::SwitchOffAndOn { address: 0x80 })));
    Bench::switch_off_and_on(&port);
    let mut bench = Bench::try_new(USUAL, &port).unwrap();
    assert_eq!(bench.home(), Homing::Homed);
}

#[test]
fn a_stop_while_it_homes_goes_out_before_anything_else() {
    let mut bench = Bench::new(USUAL, Floor::new(2.0, 2.0));
    for _ in 0..100 {
        bench.cycle(Action::Home).unwrap();
    }
    for (action, command) in [(Action::Hold, Command::SpeedAccelBoth), (Action::Release, Command::DutyBoth)] {
        bench.port.with(|world| world.sent.clear());
        bench.cycle(action).unwrap();
        assert_eq!(bench.port.with(|world| world.sent[0][1]), command as u8, "{action:?}");
        for _ in 0..100 {
            bench.cycle(Action::Home).unwrap();
        }
    }
}

#[test]
fn a_board_that_restarts_while_it_homes_has_lost_its_place() {
    for firmware in ["older", "newer"] {
        let mut bench = Bench::new(Kind { firmware, ..USUAL }, Floor::new(0.4, 0.3));
        while bench.session.report().position.x > 0.9 {
            bench.cycle(Action::Home).unwrap();
        }
        let before = bench.session.report().position;
        bench.give("brown-out 50");
        for _ in 0..300 {
            // What is lost while it is dark is what the link thread opens the port anew for.
            let _ = bench.cycle(Action::Home);
        }
        let report = bench.session.report();
        assert_eq!(report.homing, Homing::NotHomed, "{firmware}: it went on homing from {before:?}");
        assert_eq!(report.trouble, Some(Trouble::Restarted), "{firmware}");
        assert!(bench.truth().1.norm() < 0.005, "{firmware}: it moves");
    }
}
