//! The driver against motors that do at once what they are told, between stops.

use covr_engine::frames::Planar;
use covr_engine::machine::{Drive as DriveState, Homing, Limits, Travel, Trouble};
use covr_engine::safety::vetted::{Action, Setpoint};
use proptest::prelude::*;

use super::*;
use crate::homing::{HomeBy, HomingParameters};
use crate::linked::axes::Status;
use crate::roboclaw::settings::{AxisSettings, Boards};

const COUNTS: [f64; 2] = [46_545.0, 47_787.0];
const PERIOD: Span = Span::from_millis(8);
/// The switches trip here, the stops are met here; m, room frame.
const SWITCH_M: f64 = -0.01;
const STOP_M: f64 = -0.03;

fn settings(home_by: HomeBy, reversed: bool) -> Settings {
    let axis = |i: usize| AxisSettings { counts_per_metre: COUNTS[i], reversed, velocity_pid: None };
    Settings {
        port: "none".into(),
        baud: 460_800,
        boards: Boards::One(0x80),
        axes: [axis(0), axis(1)],
        limits: Limits::PAPER,
        travel: Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) },
        parked: Floor::new(1.0, 1.0),
        current_limit_amps: 5.0,
        homing_current_amps: 3.0,
        serial_timeout: Span::from_millis(200),
        period: PERIOD,
        homing: HomingParameters {
            creep_mps: 0.1,
            approach_mps: 0.02,
            switch_outside_m: if home_by == HomeBy::Switches { -SWITCH_M } else { -STOP_M },
            rest_inside_m: 0.05,
        },
        home_by,
        position_gain_per_s: 8.0,
    }
}

/// True places and what the boards say of them.
struct Bench {
    driver: Driver,
    settings: Settings,
    place_m: [f64; 2],
    power_on_m: [f64; 2],
    speed_mps: [f64; 2],
    status: Status,
    amps: [f64; 2],
    now: Time,
    told: Option<Tell>,
}

impl Bench {
    fn new(settings: Settings, place_m: [f64; 2]) -> Self {
        let mut bench = Self {
            driver: Driver::new(&settings, settings.parked),
            settings,
            place_m,
            power_on_m: place_m,
            speed_mps: [0.0; 2],
            status: Status::default(),
            amps: [0.0; 2],
            now: Time::from_micros(1_000_000),
            told: None,
        };
        bench.see();
        bench
    }

    fn counts(&self, i: usize, metres: f64) -> f64 {
        metres * COUNTS[i] * if self.settings.axes[i].reversed { -1.0 } else { 1.0 }
    }

    fn look(&self) -> Look {
        let counts = [0, 1].map(|i| self.counts(i, self.place_m[i] - self.power_on_m[i]).round() as i32);
        let speeds = [0, 1].map(|i| self.counts(i, self.speed_mps[i]).round() as i32);
        let at_switch = self.place_m.map(|place_m| place_m <= SWITCH_M);
        Look { counts, speeds, amps: self.amps, status: Status { at_switch, ..self.status } }
    }

    fn see(&mut self) {
        let look = self.look();
        self.driver.see(&look, self.now);
    }

    /// One period under this action, told now.
    fn step(&mut self, action: Action) {
        self.step_with(Order { vetted_at: self.now, action });
    }

    fn step_with(&mut self, order: Order) {
        let tell = self.driver.next(self.now, &order, PERIOD);
        self.told = Some(tell);
        let counts = match tell {
            Tell::Release | Tell::Brake(_) => [0; 2],
            Tell::Go(motion) => motion.speed,
        };
        for (i, counts) in counts.into_iter().enumerate() {
            let mps = f64::from(counts) / self.counts(i, 1.0);
            let next = (self.place_m[i] + mps * PERIOD.secs()).max(STOP_M);
            self.speed_mps[i] = (next - self.place_m[i]) / PERIOD.secs();
            self.place_m[i] = next;
        }
        self.now += PERIOD;
        self.see();
    }

    fn home(&mut self) -> Homing {
        for _ in 0..20_000 {
            self.step(Action::Home);
            if self.driver.report().homing != Homing::Running {
                break;
            }
        }
        self.driver.report().homing
    }

    fn error_m(&self) -> f64 {
        self.driver.report().position.distance_m(Floor::new(self.place_m[0], self.place_m[1]))
    }
}

fn track(x: f64, y: f64) -> Action {
    Action::Track(Setpoint {
        position: Floor::new(x, y),
        velocity: Planar::ZERO,
        acceleration: Planar::ZERO,
        valid_for: Span::from_millis(50),
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn homing_finds_the_room_from_anywhere_by_switches_and_by_stops(
        x in -0.02..3.9_f64, y in -0.02..3.9_f64, stops: bool, reversed: bool,
    ) {
        let home_by = if stops { HomeBy::Stops } else { HomeBy::Switches };
        let mut bench = Bench::new(settings(home_by, reversed), [x, y]);
        prop_assert_eq!(bench.home(), Homing::Homed);
        prop_assert!(bench.error_m() < 0.002, "{} m off", bench.error_m());
        prop_assert!((bench.place_m[0] - 0.05).abs() < 0.005 && (bench.place_m[1] - 0.05).abs() < 0.005);
    }

    #[test]
    fn a_count_that_jumps_loses_the_home_and_never_the_place(jump in 5_000_i32..2_000_000) {
        let mut bench = Bench::new(settings(HomeBy::Switches, false), [0.5, 0.5]);
        prop_assert_eq!(bench.home(), Homing::Homed);
        let before = bench.driver.report().position;
        bench.power_on_m[0] += f64::from(jump) / COUNTS[0];
        bench.step(track(before.x, before.y));
        let report = bench.driver.report();
        prop_assert_eq!(report.homing, Homing::NotHomed);
        prop_assert_eq!(report.trouble, Some(Trouble::Restarted));
        prop_assert!(report.position.distance_m(before) < 0.005);
        // Nothing moves it any more; let go, it is to be configured anew.
        for action in [Action::Home, track(1.0, 1.0)] {
            bench.step(action);
            prop_assert!(matches!(bench.told, Some(Tell::Brake(_))), "{:?}", bench.told);
        }
        prop_assert!(!bench.driver.is_over());
        bench.step(Action::Release);
        prop_assert!(bench.driver.is_over());
    }
}

#[test]
fn a_setpoint_is_reached_and_kept() {
    let mut bench = Bench::new(settings(HomeBy::Switches, false), [0.5, 0.5]);
    assert_eq!(bench.home(), Homing::Homed);
    for _ in 0..500 {
        bench.step(track(0.5, 0.3));
        assert_eq!(bench.driver.report().trouble, None);
    }
    assert!(bench.driver.report().position.distance_m(Floor::new(0.5, 0.3)) < 1e-3);
    assert!(matches!(bench.told, Some(Tell::Brake(_))), "at rest it is told to rest: {:?}", bench.told);
}

#[test]
fn an_old_order_is_a_hold() {
    let mut bench = Bench::new(settings(HomeBy::Switches, false), [0.5, 0.5]);
    assert_eq!(bench.home(), Homing::Homed);
    let order = Order { vetted_at: bench.now, action: track(3.0, 3.0) };
    bench.step_with(order);
    assert!(matches!(bench.told, Some(Tell::Go(_))));
    for _ in 0..10 {
        bench.step_with(order);
    }
    assert!(matches!(bench.told, Some(Tell::Brake(_))), "{:?}", bench.told);
    assert!(bench.place_m[0] < 0.1);
}

#[test]
fn before_homing_a_setpoint_moves_nothing() {
    let mut bench = Bench::new(settings(HomeBy::Switches, false), [0.5, 0.5]);
    bench.step(track(3.0, 3.0));
    assert!(matches!(bench.told, Some(Tell::Brake(_))));
    assert_eq!(bench.driver.report().position, Floor::new(1.0, 1.0), "where it was parked");
}

#[test]
fn with_something_in_the_way_homing_fails_and_lets_go() {
    let mut blocked = Bench::new(settings(HomeBy::Switches, false), [0.5, 0.5]);
    for _ in 0..2_000 {
        blocked.step(Action::Home);
        blocked.place_m[0] = 0.5;
        blocked.speed_mps[0] = 0.0;
    }
    assert_eq!(blocked.driver.report().homing, Homing::Failed);
    assert_eq!(blocked.told, Some(Tell::Release));
}

#[test]
fn a_board_that_limits_a_current_counts_as_over_it_but_while_homing() {
    let mut bench = Bench::new(settings(HomeBy::Switches, false), [0.5, 0.5]);
    bench.status.current_limited = [true, false];
    bench.amps = [4.2, 4.2];
    bench.see();
    let amps = bench.driver.report().current_amps;
    assert!(amps[0] > 5.0 && amps[1] < 5.0, "{amps:?}");
    bench.step(Action::Home);
    assert!(bench.driver.pushes_gently());
    assert_eq!(bench.driver.report().current_amps, [4.2, 4.2]);
}

#[test]
fn what_keeps_a_board_from_driving_is_said() {
    for (status, trouble) in [
        (Status { emergency_stop: true, ..Status::default() }, Trouble::EmergencyStop),
        (Status { driver_fault: true, ..Status::default() }, Trouble::DriverFault),
        (Status { too_hot: true, ..Status::default() }, Trouble::TooHot),
        (Status { bad_supply: true, ..Status::default() }, Trouble::BadSupply),
    ] {
        let mut bench = Bench::new(settings(HomeBy::Switches, false), [0.5, 0.5]);
        assert_eq!(bench.driver.report().trouble, None);
        bench.status = status;
        bench.see();
        assert_eq!(bench.driver.report().trouble, Some(trouble));
        assert_eq!(bench.driver.report().drive, DriveState::Released);
    }
}

#[test]
fn a_hold_keeps_the_place_against_a_push() {
    let mut bench = Bench::new(settings(HomeBy::Switches, false), [0.5, 0.5]);
    for _ in 0..10 {
        bench.step(Action::Hold);
    }
    bench.place_m[0] += 0.01;
    for _ in 0..300 {
        bench.step(Action::Hold);
    }
    assert!((bench.place_m[0] - 0.5).abs() < 1.5e-3, "{}", bench.place_m[0]);
}
