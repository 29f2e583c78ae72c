//! Which motions the separation rule forbids, as shapes on the floor: from which places a given step may not begin.
//!
//! Only the end of the braking path is looked at. With v_h at least the speed of the column that is the whole rule:
//! d changes no faster than the column moves, so `d(c(s)) - r - v_h s` cannot rise with s. With a slower v_h it asks
//! less than the rule.

use covr_engine::frames::{Floor, Planar};

use super::lattice::{AxisLattice, AxisMove};
use super::walk::Walk;
use crate::checker::Rectangle;

/// The rule for one walk.
#[derive(Debug)]
pub(super) struct Separation<'a> {
    pub walk: &'a Walk,
    pub footprint: &'a [Rectangle],
    pub v_h_mps: f64,
    pub sharpness: Sharpness,
}

/// To which side roundings go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Sharpness {
    /// Looked at several times a step, with this much to spare, m. Nothing is allowed that the rule allows by exception.
    Strict { spare_m: f64 },
    /// Looked at once a step, and everything in favour of the column: as if it stood `blur_m` farther off and were
    /// slower by one quantum; retreats in any direction that leads away; r as it was until `comply_secs` ago.
    Lenient { blur_m: f64, comply_secs: f64 },
}

/// Places of the column at the beginning of a step from which the step is forbidden.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shadow {
    /// Its middle, room frame.
    centre: Floor,
    /// Half the size of the rectangle about which it is rounded, m.
    half: Planar,
    /// The rounding, m.
    radius_m: f64,
    /// Only places before the line through this point, seen along this direction.
    before: Option<(Floor, Planar)>,
}

impl Separation<'_> {
    /// The shadows of a step that begins so many seconds into the walk.
    pub fn shadows(
        &self,
        axes: &[AxisLattice; 2],
        [x, y]: [AxisMove; 2],
        begins_secs: f64,
        step_secs: f64,
        shadows: &mut Vec<Shadow>,
    ) {
        shadows.clear();
        if x.rests() && y.rests() {
            return;
        }
        match self.sharpness {
            Sharpness::Strict { spare_m } => {
                for share in [0.25, 0.5, 0.75, 1.0] {
                    let brakes = [axes[0].brake(x, share), axes[1].brake(y, share)];
                    let speed_mps = brakes[0].speed_mps.hypot(brakes[1].speed_mps);
                    if speed_mps == 0.0 {
                        continue;
                    }
                    let footing = self.walk.at(begins_secs + share * step_secs);
                    let walked_m = self.v_h_mps * brakes[0].secs.max(brakes[1].secs);
                    let radius_m = footing.zone.radius_m(speed_mps) + walked_m + spare_m;
                    let rests = Planar::new(brakes[0].rests_m, brakes[1].rests_m);
                    self.cast(footing.head, rests, radius_m, None, shadows);
                }
            }
            Sharpness::Lenient { blur_m, comply_secs } => {
                self.lenient(axes, [x, y], begins_secs + step_secs, blur_m, comply_secs, shadows);
            }
        }
    }

    fn lenient(
        &self,
        axes: &[AxisLattice; 2],
        [x, y]: [AxisMove; 2],
        ends_secs: f64,
        blur_m: f64,
        comply_secs: f64,
        shadows: &mut Vec<Shadow>,
    ) {
        // At rest, and a person who has just come: anything.
        if (x.to == 0 && y.to == 0) || ends_secs <= comply_secs {
            return;
        }
        let brakes = [axes[0].brake(x, 1.0), axes[1].brake(y, 1.0)];
        let quantum = axes[0].quantum_mps().max(axes[1].quantum_mps());
        let slower = |speed: f64| (speed - quantum).max(0.0);
        let speed_mps = slower(brakes[0].speed_mps).hypot(slower(brakes[1].speed_mps));
        let zone = self.walk.mildest_zone(ends_secs, comply_secs);
        let head = self.walk.at(ends_secs).head;
        let braking_mps2 = |axis: usize| brakes[axis].speed_mps / brakes[axis].secs.max(1e-9);
        let lost_m = |axis: usize| {
            let (fast, slow) = (brakes[axis].speed_mps, slower(brakes[axis].speed_mps));
            if fast > 0.0 { (fast * fast - slow * slow) / (2.0 * braking_mps2(axis)) } else { 0.0 }
        };
        let secs = |axis: usize| {
            if brakes[axis].secs > 0.0 { slower(brakes[axis].speed_mps) / braking_mps2(axis) } else { 0.0 }
        };
        let walked_m = self.v_h_mps * secs(0).max(secs(1));
        let radius_m = zone.radius_m(speed_mps) + walked_m - blur_m - lost_m(0).hypot(lost_m(1));
        let rests = Planar::new(brakes[0].rests_m, brakes[1].rests_m);
        if speed_mps > RETREAT_MPS {
            return self.cast(head, rests, radius_m, None, shadows);
        }
        let way = Planar::new(
            axes[0].place_m(x.covers()) - axes[0].place_m(0),
            axes[1].place_m(y.covers()) - axes[1].place_m(0),
        );
        self.cast(head, rests, radius_m, Some((head - way, way)), shadows);
        self.cast(head, way, RETREAT_LEAST_M.min(zone.radius_m(0.0)) - blur_m, None, shadows);
    }

    /// A shadow for each rectangle of the footprint.
    fn cast(
        &self,
        head: Floor,
        moved: Planar,
        radius_m: f64,
        before: Option<(Floor, Planar)>,
        shadows: &mut Vec<Shadow>,
    ) {
        if radius_m <= 0.0 {
            return;
        }
        shadows.extend(self.footprint.iter().map(|rectangle| Shadow {
            centre: head - moved - rectangle.offset,
            half: rectangle.size_m * 0.5,
            radius_m,
            before,
        }));
    }
}

impl Shadow {
    /// From where to where it covers the line of this x, m; none where it does not.
    pub fn on_line(&self, x_m: f64) -> Option<[f64; 2]> {
        let beside_m = ((x_m - self.centre.x).abs() - self.half.x).max(0.0);
        if beside_m > self.radius_m {
            return None;
        }
        let reach_m = (self.radius_m * self.radius_m - beside_m * beside_m).sqrt() + self.half.y;
        let [mut least, mut most] = [self.centre.y - reach_m, self.centre.y + reach_m];
        if let Some((point, way)) = self.before {
            let along_x = way.x * (x_m - point.x);
            if way.y > 1e-12 {
                most = most.min(point.y - along_x / way.y);
            } else if way.y < -1e-12 {
                least = least.max(point.y - along_x / way.y);
            } else if along_x >= 0.0 {
                return None;
            }
        }
        (least <= most).then_some([least, most])
    }

    /// Whether it covers a place.
    pub fn covers(&self, place: Floor) -> bool {
        self.on_line(place.x).is_some_and(|[least, most]| (least..=most).contains(&place.y))
    }
}

/// Greatest speed of a retreat, m/s.
const RETREAT_MPS: f64 = 0.3;
/// Nearer than this nothing moves, m.
const RETREAT_LEAST_M: f64 = 0.35;

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::machine::Limits;
    use proptest::prelude::*;

    proptest! {
        /// Why only the end of the braking path is looked at.
        #[test]
        fn the_slack_falls_along_the_braking_path_when_a_person_is_as_fast_as_the_column(
            vx in -1.1..1.1f64, vy in -1.1..1.1f64, hx in -3.0..3.0f64, hy in -3.0..3.0f64, faster in 0.0..1.0f64,
        ) {
            let v_h = vx.hypot(vy) + faster;
            let covered = |v: f64, s: f64| {
                let s = s.min(v.abs() / 2.5);
                v * s - 1.25f64.copysign(v) * s * s
            };
            let slack = |s: f64| {
                let (x, y) = (covered(vx, s) - hx, covered(vy, s) - hy);
                (x.abs() - 0.075).max(0.0).hypot((y.abs() - 0.075).max(0.0)) - v_h * s
            };
            let ends = vx.abs().max(vy.abs()) / 2.5;
            for k in 0..50 {
                let [early, late] = [k, k + 1].map(|k| slack(ends * f64::from(k) / 50.0));
                prop_assert!(late <= early + 1e-12, "{early} then {late}");
            }
        }
    }

    #[test]
    fn a_shadow_is_a_rounded_rectangle_cut_by_its_line() {
        let round =
            Shadow { centre: Floor::new(1.0, 1.0), half: Planar::new(0.1, 0.2), radius_m: 0.5, before: None };
        assert_eq!(round.on_line(1.7), None);
        let [least, most] = round.on_line(1.5).unwrap();
        assert!((least - (0.8 - 0.3)).abs() < 1e-9 && (most - (1.2 + 0.3)).abs() < 1e-9, "{least} {most}");
        // Going up from below the line through the centre is forbidden; from above it leads away.
        let cut = Shadow { before: Some((Floor::new(1.0, 1.0), Planar::new(0.0, 0.1))), ..round };
        assert!(cut.covers(Floor::new(1.0, 0.9)) && !cut.covers(Floor::new(1.0, 1.1)));
        let aside = Shadow { before: Some((Floor::new(1.0, 1.0), Planar::new(0.1, 0.0))), ..round };
        assert!(aside.covers(Floor::new(0.9, 1.0)) && !aside.covers(Floor::new(1.1, 1.0)));
    }

    #[test]
    fn the_papers_axes_need_no_second_look() {
        let fastest = Limits::PAPER.x.speed_mps.hypot(Limits::PAPER.y.speed_mps);
        assert!(fastest <= 1.6);
    }
}
