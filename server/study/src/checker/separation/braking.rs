//! Where the column comes to rest if it brakes from now on, and whether anything is too near on the way.

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::Limits;

use super::super::Motion;

/// Each axis slows at its own braking limit until it rests.
#[derive(Debug, Clone, Copy)]
pub(super) struct Braking {
    from: Floor,
    velocity: Planar,
    deceleration: Planar,
}

/// Where `d(c(s)) > r + v_h s` fails.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct Shortfall {
    /// r, m.
    pub(in super::super) radius_m: f64,
    /// How far into the braking, s.
    pub(in super::super) s_secs: f64,
    /// d(c(s)), m.
    pub(in super::super) distance_m: f64,
    /// r + v_h s, m.
    pub(in super::super) required_m: f64,
}

impl Braking {
    pub(super) fn new(column: Motion, limits: &Limits) -> Self {
        let deceleration = Planar::new(limits.x.braking_mps2, limits.y.braking_mps2);
        Self { from: column.position, velocity: column.velocity, deceleration }
    }

    /// s_end, s.
    pub(super) fn rest_secs(&self) -> f64 {
        (self.velocity.x.abs() / self.deceleration.x).max(self.velocity.y.abs() / self.deceleration.y)
    }

    /// c(s).
    pub(super) fn position(&self, s_secs: f64) -> Floor {
        let covered = |velocity: f64, deceleration: f64| {
            let s = s_secs.min(velocity.abs() / deceleration);
            velocity * s - 0.5 * deceleration.copysign(velocity) * s * s
        };
        self.from
            + Planar::new(
                covered(self.velocity.x, self.deceleration.x),
                covered(self.velocity.y, self.deceleration.y),
            )
    }

    /// A moment of the braking at which the rule fails, if there is one.
    ///
    /// Neither side changes faster than speed + v_h, which bounds what can happen between two moments: intervals are
    /// halved until the bound clears them. Moments closer than [`FINEST_SECS`] are not told apart.
    pub(super) fn shortfall(
        &self,
        distance_m: impl Fn(Floor) -> f64,
        radius_m: f64,
        v_h_mps: f64,
    ) -> Option<Shortfall> {
        let at = |s_secs: f64| {
            let distance_m = distance_m(self.position(s_secs));
            Shortfall { radius_m, s_secs, distance_m, required_m: radius_m + v_h_mps * s_secs }
        };
        let slack = |found: &Shortfall| found.distance_m - found.required_m;
        let steepest = self.velocity.norm() + v_h_mps;
        let (first, last) = (at(0.0), at(self.rest_secs()));
        // Mostly one look is enough: nothing is set aside then.
        let mut aside = Vec::new();
        let mut open = Some((first, last));
        while let Some((early, late)) = open.take().or_else(|| aside.pop()) {
            if let Some(failed) = [early, late].into_iter().find(|end| slack(end) <= 0.0) {
                return Some(failed);
            }
            let width = late.s_secs - early.s_secs;
            let least_between = 0.5 * (slack(&early) + slack(&late) - steepest * width);
            if least_between <= 0.0 && width > FINEST_SECS {
                let middle = at(0.5 * (early.s_secs + late.s_secs));
                aside.push((middle, late));
                open = Some((early, middle));
            }
        }
        None
    }
}

/// Half of it times speed + v_h, at most 0.2 mm, is how much may go unseen between two moments.
const FINEST_SECS: f64 = 1e-4;

#[cfg(test)]
mod tests {
    use super::*;

    fn braking(x: f64, y: f64) -> Braking {
        let column = Motion { position: Floor::new(1.0, 1.0), velocity: Planar::new(x, y) };
        Braking::new(column, &Limits::PAPER)
    }

    #[test]
    fn each_axis_rests_when_its_own_speed_is_gone() {
        // 1 m/s at 2.5 m/s2: 0.4 s and 0.2 m. 0.5 m/s: 0.2 s and 0.05 m.
        let braking = braking(1.0, -0.5);
        assert!((braking.rest_secs() - 0.4).abs() < 1e-12);
        assert!(braking.position(0.4).distance_m(Floor::new(1.2, 0.95)) < 1e-12);
        assert!(braking.position(0.2).distance_m(Floor::new(1.15, 0.95)) < 1e-12);
        assert!(braking.position(9.0).distance_m(Floor::new(1.2, 0.95)) < 1e-12);
    }

    #[test]
    fn a_shortfall_in_the_middle_of_the_braking_is_found() {
        // A thin post beside the path at x = 1.1, passed 0.3 m away after 0.117 s: neither end of the braking fails.
        let post = Floor::new(1.1, 1.3);
        let distance = |centre: Floor| centre.distance_m(post);
        let found = braking(1.0, 0.0).shortfall(distance, 0.3005, 0.0).unwrap();
        assert!(found.s_secs > 0.05 && found.s_secs < 0.2 && found.distance_m < 0.3005, "{found:?}");
        assert_eq!(braking(1.0, 0.0).shortfall(distance, 0.299, 0.0), None);
    }

    #[test]
    fn the_person_walks_on_while_the_column_brakes() {
        // At rest after 0.4 s, 0.8 m away: 0.35 + 1.6 * 0.4 = 0.99 m are required, 0.35 + 1.1 * 0.4 = 0.79 m at 1.1 m/s.
        let wall = |centre: Floor| 2.0 - centre.x;
        let found = braking(1.0, 0.0).shortfall(wall, 0.35, 1.6).unwrap();
        assert!((found.distance_m - 0.8).abs() < 1e-12 && (found.required_m - 0.99).abs() < 1e-12);
        assert_eq!(braking(1.0, 0.0).shortfall(wall, 0.35, 1.1), None);
    }
}
