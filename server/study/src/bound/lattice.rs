//! Motions of one axis on a lattice: the acceleration is constant for a step, so that speeds are whole multiples of a
//! quantum, and places whole multiples of half a quantum times the step.

use covr_engine::machine::AxisLimits;

/// The lattice of one axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AxisLattice {
    /// Between neighbouring speeds, m/s.
    quantum_mps: f64,
    /// Between neighbouring places, m.
    unit_m: f64,
    /// The place of index 0, m.
    origin_m: f64,
    /// How many places there are.
    places: i32,
    /// Index of the start.
    start: i32,
    /// The greatest speed, in quanta.
    fastest: i32,
    /// The greatest loss of speed in a step, in quanta.
    brakes: i32,
    /// Braking for the separation rule, m/s2.
    braking_mps2: f64,
}

/// One step of an axis, its speeds in quanta.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct AxisMove {
    pub from: i32,
    pub to: i32,
}

/// Where an axis would rest if it braked from some moment of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Brake {
    /// From the place where the step began to where it rests, m.
    pub rests_m: f64,
    /// Speed at the moment, m/s.
    pub speed_mps: f64,
    /// Time until rest, s.
    pub secs: f64,
}

impl AxisLattice {
    /// Steps of `step_secs` from `start_m` inside `[least_m, most_m]`, with `haste` times the acceleration.
    pub fn new(limits: &AxisLimits, haste: f64, step_secs: f64, within_m: [f64; 2], start_m: f64) -> Self {
        let quantum_mps = limits.acceleration_mps2 * haste * step_secs;
        let unit_m = 0.5 * quantum_mps * step_secs;
        let whole = |quanta: f64| if haste > 1.0 { quanta.ceil() } else { (quanta + 1e-9).floor() } as i32;
        let start = ((start_m - within_m[0]).max(0.0) / unit_m + 1e-9).floor() as i32;
        let beyond = ((within_m[1] - start_m).max(0.0) / unit_m + 1e-9).floor() as i32;
        Self {
            quantum_mps,
            unit_m,
            origin_m: start_m - f64::from(start) * unit_m,
            places: start + beyond + 1,
            start,
            fastest: whole(limits.speed_mps / quantum_mps),
            brakes: whole(limits.braking_mps2 / limits.acceleration_mps2).max(1),
            braking_mps2: limits.braking_mps2,
        }
    }

    /// How many places there are.
    pub fn places(&self) -> i32 {
        self.places
    }

    /// How many speeds there are, from the fastest one way to the fastest the other.
    pub fn speeds(&self) -> i32 {
        2 * self.fastest + 1
    }

    /// The greatest speed, in quanta.
    pub fn fastest(&self) -> i32 {
        self.fastest
    }

    /// Index of the start.
    pub fn start(&self) -> i32 {
        self.start
    }

    /// Between neighbouring speeds, m/s.
    pub fn quantum_mps(&self) -> f64 {
        self.quantum_mps
    }

    /// The place of an index, m.
    pub fn place_m(&self, index: i32) -> f64 {
        self.origin_m + f64::from(index) * self.unit_m
    }

    /// Place in units of the lattice, from index 0.
    pub fn index_of(&self, place_m: f64) -> f64 {
        (place_m - self.origin_m) / self.unit_m
    }

    /// What an axis may do in a step, from any speed.
    pub fn moves(&self) -> Vec<AxisMove> {
        let speeds = -self.fastest..=self.fastest;
        speeds
            .flat_map(|from| {
                speeds_after(from, self.brakes, self.fastest).map(move |to| AxisMove { from, to })
            })
            .collect()
    }

    /// How an axis would brake at `share` of a step.
    pub fn brake(&self, step: AxisMove, share: f64) -> Brake {
        let (from, gained) = (f64::from(step.from), f64::from(step.to - step.from));
        let velocity = self.quantum_mps * (from + gained * share);
        let way_m = 2.0 * self.unit_m * (from * share + 0.5 * gained * share * share);
        Brake {
            rests_m: way_m + velocity * velocity.abs() / (2.0 * self.braking_mps2),
            speed_mps: velocity.abs(),
            secs: velocity.abs() / self.braking_mps2,
        }
    }
}

impl AxisMove {
    /// Units of the lattice that it covers.
    pub fn covers(self) -> i32 {
        self.from + self.to
    }

    /// It rests throughout.
    pub fn rests(self) -> bool {
        self.from == 0 && self.to == 0
    }
}

/// Speeds one step later: the same, one quantum faster, or slower by up to `brakes` without turning round.
fn speeds_after(from: i32, brakes: i32, fastest: i32) -> impl Iterator<Item = i32> {
    (-fastest..=fastest).filter(move |to| {
        if from == 0 {
            return to.abs() <= 1;
        }
        let along = to * from.signum();
        (from.abs() - brakes..=from.abs() + 1).contains(&along) && along >= 0
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::machine::Limits;

    fn lattice(levels: f64) -> AxisLattice {
        let step_secs = Limits::PAPER.x.speed_mps / (Limits::PAPER.x.acceleration_mps2 * levels);
        AxisLattice::new(&Limits::PAPER.x, 1.0, step_secs, [0.0, 4.0], 1.0)
    }

    #[test]
    fn the_papers_limits_fall_on_the_lattice() {
        let lattice = lattice(5.0);
        assert_eq!((lattice.fastest(), lattice.brakes), (5, 2));
        assert!((lattice.quantum_mps() - 0.22).abs() < 1e-12);
        assert!((lattice.place_m(lattice.start()) - 1.0).abs() < 1e-12);
        assert!(lattice.place_m(0) >= -1e-9 && lattice.place_m(lattice.places() - 1) <= 4.0 + 1e-9);
    }

    #[test]
    fn a_step_covers_what_constant_acceleration_covers() {
        let lattice = lattice(8.0);
        for step in lattice.moves() {
            let rested = lattice.brake(step, 1.0);
            let velocity = lattice.quantum_mps() * f64::from(step.to);
            let braked_m = velocity * velocity.abs() / 5.0;
            let covered = f64::from(step.covers()) * lattice.unit_m;
            assert!((rested.rests_m - braked_m - covered).abs() < 1e-12, "{step:?}");
            assert!((rested.secs - velocity.abs() / 2.5).abs() < 1e-12);
        }
    }

    #[test]
    fn speeds_rise_by_one_fall_by_two_and_turn_only_at_rest() {
        let after = |from| speeds_after(from, 2, 5).collect::<Vec<_>>();
        assert_eq!(after(0), [-1, 0, 1]);
        assert_eq!(after(1), [0, 1, 2]);
        assert_eq!(after(4), [2, 3, 4, 5]);
        assert_eq!(after(5), [3, 4, 5]);
        assert_eq!(after(-3), [-4, -3, -2, -1]);
    }
}
