//! The board by itself, from the maker's description: no driver here.

use crate::sim::parameters::MachineParameters;
use covr_engine::frames::Floor;
use covr_engine::machine::Travel;

use super::*;

struct Desk {
    emulator: Emulator,
    now: Time,
}

impl Desk {
    fn new() -> Self {
        let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        let emulator = Emulator::new(Setup::paper(MachineParameters::paper(travel))).unwrap();
        Self { emulator, now: Time::from_micros(1_000_000) }
    }

    fn say(&mut self, lines: &str) -> String {
        self.emulator.receive(self.now, lines.as_bytes());
        self.pass(0.005);
        String::from_utf8(self.emulator.poll(self.now)).unwrap()
    }

    fn pass(&mut self, secs: f64) {
        self.now += Span::from_secs(secs);
    }

    fn on(&mut self) {
        assert_eq!(self.say("w axis0.config.watchdog_timeout 0.5\nw axis0.requested_state 8\n"), "");
        assert_eq!(self.say("r axis0.current_state\n"), "8\r\n");
    }

    fn x(&self) -> AxisTruth {
        self.emulator.truth(Axis::X)
    }
}

/// Turns a metre of the long rail.
const TURNS: f64 = 5.0 / 0.11;

#[test]
fn it_answers_questions_and_nothing_else() {
    let mut desk = Desk::new();
    assert_eq!(desk.say("r vbus_voltage\n"), "24.000000\r\n");
    assert_eq!(desk.say("r vbus_voltage *93\n"), "24.000000*31\r\n".replace("31", &word("24.000000")));
    assert_eq!(desk.say("r vbus_voltage *94\n"), "");
    assert_eq!(desk.say("r no_such\n"), "invalid property\r\n");
    assert_eq!(desk.say("f 2\n"), "invalid motor 2\r\n");
    assert_eq!(desk.say("t 0\n"), "invalid command format\r\n");
    assert_eq!(desk.say("zap\n"), "unknown command\r\n");
    assert_eq!(desk.say("w test_property 123456\nr test_property\n"), "123456\r\n");
    assert_eq!(desk.say("w fw_version_major 9\n"), "not implemented\r\n");
}

fn word(text: &str) -> String {
    text.bytes().fold(0, |all, byte| all ^ byte).to_string()
}

#[test]
fn an_answer_has_nine_characters_at_most() {
    let mut desk = Desk::new();
    assert_eq!(
        desk.say("w axis0.controller.input_pos -123.456789\nr axis0.controller.input_pos\n"),
        "-123.4567\r\n"
    );
}

#[test]
fn a_trajectory_goes_to_its_place_and_stays_there_without_a_word_more() {
    let mut desk = Desk::new();
    desk.on();
    desk.say("w axis0.trap_traj.config.vel_limit 20\nw axis0.trap_traj.config.accel_limit 100\n");
    desk.say("w axis0.trap_traj.config.decel_limit 100\nw axis0.controller.config.vel_limit 60\n");
    desk.say(&format!("t 0 {:.6}\n", 0.5 * TURNS));
    desk.pass(4.0);
    desk.say("");
    assert!((desk.x().position_m - 2.5).abs() < 0.003, "{}", desk.x().position_m);
    assert!(desk.x().speed_mps.abs() < 0.001);
}

#[test]
fn with_its_watchdog_expired_it_lets_go_and_coasts() {
    let mut desk = Desk::new();
    desk.on();
    desk.say("w axis0.controller.config.vel_limit 60\nw axis0.config.enable_watchdog 1\nu 0\n");
    desk.say("w axis0.controller.config.input_mode 1\nv 0 30.0 0\n");
    desk.pass(0.45);
    desk.say("");
    let speed = desk.x().speed_mps;
    assert!(speed > 0.5, "{speed}");
    desk.pass(0.1);
    assert_eq!(desk.say("r axis0.current_state\nr axis0.error\n"), "1\r\n2048\r\n");
    let from = desk.x().position_m;
    desk.pass(5.0);
    desk.say("");
    assert!(desk.x().position_m - from > 0.15, "it coasts: {}", desk.x().position_m - from);
    // Not before its error is cleared does it come on again.
    desk.say("w axis0.requested_state 8\n");
    assert_eq!(desk.say("r axis0.current_state\n"), "1\r\n");
    desk.say("u 0\nsc\nw axis0.requested_state 8\n");
    assert_eq!(desk.say("r axis0.current_state\n"), "8\r\n");
}

#[test]
fn a_brown_out_forgets_what_was_not_saved() {
    let mut desk = Desk::new();
    desk.say("w axis0.config.watchdog_timeout 0.5\nw test_property 7\n");
    desk.emulator.give(desk.now, "brown-out 100".parse().unwrap());
    desk.pass(0.3);
    assert_eq!(desk.say("r test_property\n"), "");
    desk.pass(0.5);
    assert_eq!(desk.say("r test_property\nr axis0.config.watchdog_timeout\n"), "0\r\n0.000000\r\n");
}

#[test]
fn an_overspeed_a_low_supply_and_heat_let_the_motors_go() {
    for order in ["supply 7", "temperature 130", "error x encoder"] {
        let mut desk = Desk::new();
        desk.on();
        desk.emulator.give(desk.now, order.parse().unwrap());
        desk.pass(0.01);
        assert_eq!(desk.say("r axis0.current_state\n"), "1\r\n", "{order}");
    }
    let mut desk = Desk::new();
    desk.on();
    desk.emulator.give(desk.now, "push x 400".parse().unwrap());
    desk.pass(0.5);
    assert_eq!(desk.say("r axis0.error\n"), "512\r\n");
}
