//! For tests: a driver against an emulated controller, on virtual time. The bytes of one are the other's, and neither knows the
//! other's code.

pub mod moved;

use std::io;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{Homing, Travel};
use covr_engine::safety::vetted::{Action, Setpoint};
use covr_engine::time::{Span, Time};

use super::axes::Order;
use super::link::Session;
use super::port::Port;
use crate::emulation::{Axis, Emulated};

/// A controller and the time that passes for it.
pub struct World<E> {
    pub emulator: E,
    pub now: Time,
    begun: Instant,
    /// What went out.
    pub sent: Vec<Vec<u8>>,
}

/// The line to it; waiting is what makes time pass.
pub struct VirtualPort<E>(Arc<Mutex<World<E>>>);

impl<E> Clone for VirtualPort<E> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<E: Emulated> VirtualPort<E> {
    /// A controller whose power comes on, and a while for it to start.
    pub fn new(emulator: E) -> Self {
        let world =
            World { emulator, now: Time::from_micros(1_000), begun: Instant::now(), sent: Vec::new() };
        let port = Self(Arc::new(Mutex::new(world)));
        port.with(|world| world.emulator.poll(world.now));
        port.wait(Span::from_secs(2.0));
        port
    }

    pub fn with<T>(&self, look: impl FnOnce(&mut World<E>) -> T) -> T {
        look(&mut self.0.lock().unwrap())
    }

    pub fn time(&self) -> Time {
        self.with(|world| world.now)
    }

    pub fn wait(&self, span: Span) {
        self.with(|world| world.now += span);
    }

    pub fn give(&self, order: &str) {
        let order = order.parse().unwrap();
        self.with(|world| world.emulator.give(world.now, order));
    }
}

impl<E: Emulated + Send> Port for VirtualPort<E> {
    fn now(&self) -> Instant {
        self.with(|world| world.begun + Duration::from_micros(world.now.micros() as u64))
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.with(|world| {
            world.sent.push(bytes.to_vec());
            world.emulator.receive(world.now, bytes);
        });
        Ok(())
    }

    fn receive(&mut self, into: &mut [u8], deadline: Instant) -> io::Result<usize> {
        self.with(|world| {
            let last = Time::from_micros((deadline - world.begun).as_micros() as i64 + 1);
            loop {
                let bytes = world.emulator.poll(world.now);
                if !bytes.is_empty() || world.now >= last {
                    assert!(bytes.len() <= into.len(), "more came than was asked for");
                    into[..bytes.len()].copy_from_slice(&bytes);
                    return Ok(bytes.len());
                }
                let due = world.emulator.next_due().unwrap_or(last);
                world.now =
                    due.clamp(world.now + Span::from_micros(10), last.max(world.now + Span::from_micros(10)));
            }
        })
    }
}

/// A driver on its controller.
pub struct Bench<E, S> {
    pub port: VirtualPort<E>,
    pub session: S,
}

impl<E: Emulated, S: Session> Bench<E, S> {
    pub fn give(&self, order: &str) {
        self.port.give(order);
    }

    pub fn truth(&self) -> (Floor, Planar) {
        self.port.with(|world| {
            let [x, y] = Axis::BOTH.map(|axis| world.emulator.truth(axis));
            (Floor::new(x.position_m, y.position_m), Planar::new(x.speed_mps, y.speed_mps))
        })
    }

    /// One cycle under an action that was vetted now; the next begins no sooner than a control period after this.
    pub fn cycle(&mut self, action: Action) -> Result<bool, S::Refused> {
        self.cycle_with(Order { vetted_at: self.port.time(), action })
    }

    pub fn cycle_with(&mut self, order: Order) -> Result<bool, S::Refused> {
        let begun = self.port.time();
        let port = self.port.clone();
        let outcome = self.session.cycle(&order, &move || port.time());
        let next = begun + CONTROL_PERIOD;
        self.port.with(|world| world.now = world.now.max(next));
        outcome
    }

    pub fn home(&mut self) -> Homing {
        let begun = self.port.time();
        while self.port.time() - begun < Span::from_secs(120.0) {
            self.cycle(Action::Home).unwrap();
            let report = self.session.report();
            assert_eq!(report.trouble, None);
            if matches!(report.homing, Homing::Homed | Homing::Failed) {
                break;
            }
        }
        self.session.report().homing
    }
}

/// Greatest deviations on a course, and the last: what R6 looks at.
#[derive(Default)]
pub struct Off {
    pub greatest_m: f64,
    pub greatest_mps: f64,
    pub greatest_amps: f64,
    pub last_m: f64,
}

/// A way of 2 m at the limits of an axis: place, velocity and acceleration after so long. Averaged over the time that the jerk limit
/// gives a change of acceleration.
fn course(t: f64) -> (f64, f64, f64) {
    let parts = 16;
    let at = |part: i32| raw_course(t - RAMP_SECS * f64::from(part) / f64::from(parts));
    let sum = (0..=parts).map(at).fold((0.0, 0.0, 0.0), |sum, of| (sum.0 + of.0, sum.1 + of.1, sum.2 + of.2));
    let count = f64::from(parts + 1);
    (sum.0 / count, sum.1 / count, sum.2 / count)
}

fn raw_course(t: f64) -> (f64, f64, f64) {
    let (speed, up, down, way) = (1.0, 1.25, 2.5, 2.0);
    let (up_secs, down_secs) = (speed / up, speed / down);
    let whole_secs = way / speed + 0.5 * (up_secs + down_secs);
    if t < 0.0 {
        (0.0, 0.0, 0.0)
    } else if t < up_secs {
        (0.5 * up * t * t, up * t, up)
    } else if t < whole_secs - down_secs {
        (speed * (t - 0.5 * up_secs), speed, 0.0)
    } else if t < whole_secs {
        let left = whole_secs - t;
        (way - 0.5 * down * left * left, down * left, -down)
    } else {
        (way, 0.0, 0.0)
    }
}

/// Drive that way along both axes, and stay there.
pub fn drive<E: Emulated, S: Session>(bench: &mut Bench<E, S>) -> Off {
    drive_stuttering(bench, Span::ZERO)
}

/// The same with a host that every tenth cycle is late by so much.
pub fn drive_stuttering<E: Emulated, S: Session>(bench: &mut Bench<E, S>, late: Span) -> Off {
    let from = bench.session.report().position;
    let begun = bench.port.time();
    let both = Planar::new(1.0, 1.0);
    let mut off = Off::default();
    for cycle in 0_u32.. {
        if cycle.is_multiple_of(10) {
            bench.port.wait(late);
        }
        let t = (bench.port.time() - begun).secs();
        let (s, v, a) = course(t);
        bench.cycle(setpoint(from + both * s, both * v, both * a)).unwrap();
        let report = bench.session.report();
        let since = (report.answered_at - begun).secs() - t;
        let [x, y] = report.current_amps;
        off.greatest_amps = off.greatest_amps.max(x).max(y);
        off.greatest_mps = off.greatest_mps.max((report.velocity - both * (v + a * since)).norm());
        let (true_place, _) = bench.truth();
        let since = (bench.port.time() - begun).secs() - t;
        off.greatest_m = off.greatest_m.max((true_place - (from + both * (s + v * since))).norm());
        if t > 4.5 {
            off.last_m = (true_place - (from + both * s)).norm();
            break;
        }
    }
    off
}

/// Speed up along x until this speed is told.
pub fn speed_up<E: Emulated, S: Session>(bench: &mut Bench<E, S>, to_mps: f64) {
    let mut v = 0.0;
    while v < to_mps {
        v += 1.25 * CONTROL_PERIOD.secs();
        let at = bench.session.report().position;
        let ahead = at + Planar::new(v * CONTROL_PERIOD.secs(), 0.0);
        bench.cycle(setpoint(ahead, Planar::new(v, 0.0), Planar::new(1.25, 0.0))).unwrap();
    }
}

pub fn velocity_covers(mps: f64, secs: f64, braking_mps2: f64) -> f64 {
    mps * secs + mps * mps / (2.0 * braking_mps2)
}

pub fn travel() -> Travel {
    Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) }
}

pub fn setpoint(position: Floor, velocity: Planar, acceleration: Planar) -> Action {
    Action::Track(Setpoint { position, velocity, acceleration, valid_for: Span::from_millis(50) })
}

pub const CONTROL_PERIOD: Span = Span::from_millis(4);
/// 2.5 m/s2 at 80 m/s3.
const RAMP_SECS: f64 = 2.5 / 80.0;
