//! Bringing a simulated machine to where a trial begins: homed, at rest, at a given place. It is the commissioning
//! course of a machine in an empty arena, not the engine's work.

use covr_engine::frames::Floor;
use covr_engine::machine::Homing;
use covr_engine::safety::vetted::{Action, ArenaConfirmedClear, Setpoint, Vetted};
use covr_engine::time::{Span, Time};
use covr_gantry::contract::Simulated;

/// Why a machine does not stand where it should.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum CannotStand {
    /// Homing did not end.
    #[error("the machine was not homed after {} s", MOST_HOMING.secs())]
    NotHomed,
    /// The place is outside the travel.
    #[error("the start ({:.3}, {:.3}) m is outside the machine's travel", .0.x, .0.y)]
    Outside(Floor),
    /// It came to rest elsewhere.
    #[error("the machine rests at ({:.3}, {:.3}) m, expected ({:.3}, {:.3}) m", rests.x, rests.y, wanted.x, wanted.y)]
    Elsewhere {
        /// Where it rests.
        rests: Floor,
        /// Where it should.
        wanted: Floor,
    },
}

/// Home the machine if it is not, drive it to `place`, let it come to rest. Returns when it does.
pub fn bring_to(machine: &mut dyn Simulated, place: Floor, from: Time) -> Result<Time, CannotStand> {
    let clear = ArenaConfirmedClear::by_a_person_who_looked();
    let (limits, travel) = (machine.limits(), machine.travel());
    let mut now = from;
    let order = |machine: &mut dyn Simulated, now: &mut Time, action: Action| {
        let command = Vetted::on_clear_course(clear, *now, action, &limits, &travel)
            .map_err(|_| CannotStand::Outside(place))?;
        // A command that is not taken shows in where the machine ends.
        let taken = machine.write(*now, &command).is_ok();
        *now += PERIOD;
        Ok((machine.read(*now).report, taken))
    };
    while machine.read(now).report.homing != Homing::Homed {
        order(machine, &mut now, Action::Home)?;
        if now - from > MOST_HOMING {
            return Err(CannotStand::NotHomed);
        }
    }
    let begins = machine.read(now).report.position;
    let way = place - begins;
    let slowest = |x: f64, y: f64| x.min(y);
    let speed_mps = SHARE * slowest(limits.x.speed_mps, limits.y.speed_mps);
    let acceleration_mps2 = SHARE * slowest(limits.x.acceleration_mps2, limits.y.acceleration_mps2);
    // Minimum jerk: the peak speed is 15/8 of the mean, the peak acceleration 10/sqrt(3) D/T2.
    let secs = (1.875 * way.norm() / speed_mps).max((5.774 * way.norm() / acceleration_mps2).sqrt());
    let set_out = now;
    while (now - set_out).secs() < secs + SETTLES_SECS {
        let s = ((now - set_out).secs() / secs).clamp(0.0, 1.0);
        let rest = s >= 1.0 || secs <= 0.0;
        let (p, v, a) = if rest {
            (1.0, 0.0, 0.0)
        } else {
            (
                s.powi(3) * (10.0 + s * (6.0 * s - 15.0)),
                30.0 * (s * (1.0 - s)).powi(2) / secs,
                60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (secs * secs),
            )
        };
        let setpoint = Setpoint {
            position: begins + way * p,
            velocity: way * v,
            acceleration: way * a,
            valid_for: Span::from_millis(50),
        };
        order(machine, &mut now, Action::Track(setpoint))?;
    }
    let truth = machine.truth();
    let stands = truth.position.distance_m(place) < ACCURACY_M && truth.velocity.norm() < 0.01;
    if stands { Ok(now) } else { Err(CannotStand::Elsewhere { rests: truth.position, wanted: place }) }
}

const PERIOD: Span = Span::from_millis(4);
/// From one end of a room to the other at creep speed.
const MOST_HOMING: Span = Span::from_millis(300_000);
/// The course uses this share of what the machine can do.
const SHARE: f64 = 0.7;
/// Time for the position loop to settle, s.
const SETTLES_SECS: f64 = 0.6;
/// The paper's accuracy, m.
const ACCURACY_M: f64 = 0.02;

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::machine::{Limits, Travel};
    use covr_gantry::ideal::IdealMachine;
    use covr_gantry::sim::SimulatedMachine;
    use covr_gantry::sim::parameters::MachineParameters;

    #[test]
    fn both_machines_come_to_stand_where_they_are_told() {
        let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        let place = Floor::new(3.1, 0.8);
        let mut real = SimulatedMachine::new(MachineParameters::paper(travel)).unwrap();
        let mut ideal = IdealMachine::new(Limits::PAPER, travel, travel.centre());
        let machines: [&mut dyn Simulated; 2] = [&mut real, &mut ideal];
        for machine in machines {
            let first = bring_to(machine, place, Time::ZERO).unwrap();
            // Again, from there, without homing.
            let second = bring_to(machine, Floor::new(1.0, 1.0), first).unwrap();
            assert!((second - first).secs() < 10.0, "{}", machine.name());
            assert!(machine.truth().position.distance_m(Floor::new(1.0, 1.0)) < 0.02);
        }
    }

    #[test]
    fn a_place_outside_the_travel_is_refused() {
        let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        let mut ideal = IdealMachine::new(Limits::PAPER, travel, travel.centre());
        let refused = bring_to(&mut ideal, Floor::new(5.0, 1.0), Time::ZERO);
        assert_eq!(refused, Err(CannotStand::Outside(Floor::new(5.0, 1.0))));
    }
}
