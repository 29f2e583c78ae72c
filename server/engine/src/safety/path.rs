//! Jerk-limited velocity changes of one axis, in closed form: the brake, and the limiter's next step.
//!
//! From (v, a) to (v_target, 0) in least time with |jerk| <= J and a bound on acceleration: ramp to a peak, hold it,
//! ramp to zero. The peak follows from the wanted change of velocity (the usual three-phase profile; compare Kröger,
//! "On-Line Trajectory Generation in Robotic Systems", 2010).

use crate::frames::{Floor, Planar};
use crate::machine::{AxisLimits, Limits};

/// One axis at one moment: m, m/s, m/s2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisState {
    /// Position, m.
    pub p: f64,
    /// Velocity, m/s.
    pub v: f64,
    /// Acceleration, m/s2.
    pub a: f64,
}

/// Both axes at one moment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct State {
    /// The long rail.
    pub x: AxisState,
    /// The cross rail.
    pub y: AxisState,
}

/// How one axis moves for a while: pieces of constant jerk, then at rest or at constant velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisPath {
    pieces: [Piece; 4],
    end: AxisState,
    duration_secs: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Piece {
    start: AxisState,
    jerk: f64,
    from_secs: f64,
}

/// A change of velocity: ramp to a peak of acceleration, hold it, ramp to none. Jerks in m/s3, times in s.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ramps {
    jerk_in: f64,
    ramp_in: f64,
    hold: f64,
    jerk_out: f64,
    ramp_out: f64,
}

/// How the column moves when it is told to brake: the worst of it, reaction included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrakePath {
    x: AxisPath,
    y: AxisPath,
}

impl AxisState {
    /// On at the same acceleration: the same as after no jerk.
    fn carried(self, t: f64) -> Self {
        Self { p: self.p + t * (self.v + t * (0.5 * self.a)), v: self.v + t * self.a, a: self.a }
    }

    fn after(self, jerk: f64, t: f64) -> Self {
        Self {
            p: self.p + t * (self.v + t * (0.5 * self.a + t * jerk / 6.0)),
            v: self.v + t * (self.a + 0.5 * t * jerk),
            a: self.a + t * jerk,
        }
    }

    /// Where the axis is when nothing is commanded for `secs`: on at its acceleration, no faster than it may and not past rest.
    pub fn carried_on(self, secs: f64, limits: &AxisLimits) -> Self {
        let slows = self.v * self.a < 0.0;
        let rests_after = if slows { -self.v / self.a } else { f64::INFINITY };
        let t = secs.min(rests_after);
        let v = (self.v + self.a * t).clamp(-limits.speed_mps, limits.speed_mps);
        // An acceleration that could not be ramped out before top speed or rest has ended by itself.
        let ramped_out = v + self.a * self.a.abs() / (2.0 * limits.jerk_mps3);
        let goes_on = ramped_out.abs() <= limits.speed_mps && ramped_out * v > 0.0;
        Self { p: self.p + 0.5 * (self.v + v) * t, v, a: if goes_on { self.a } else { 0.0 } }
    }
}

impl State {
    /// The greatest speed before a brake bites that comes `reaction_secs` from now, m/s: on at its acceleration, which is then
    /// ramped out.
    pub fn speed_before_brake_mps(&self, limits: &Limits, reaction_secs: f64) -> f64 {
        let fastest = |axis: AxisState, own: &AxisLimits| {
            let AxisState { v, a, .. } = axis.carried_on(reaction_secs, own);
            v + a * a.abs() / (2.0 * own.jerk_mps3)
        };
        let then = Planar::new(fastest(self.x, &limits.x), fastest(self.y, &limits.y));
        self.velocity().norm().max(then.norm())
    }

    /// At rest at a place.
    pub fn at_rest(place: Floor) -> Self {
        let axis = |p| AxisState { p, v: 0.0, a: 0.0 };
        Self { x: axis(place.x), y: axis(place.y) }
    }

    /// Moving uniformly.
    pub fn moving(place: Floor, velocity: Planar) -> Self {
        let axis = |p, v| AxisState { p, v, a: 0.0 };
        Self { x: axis(place.x, velocity.x), y: axis(place.y, velocity.y) }
    }

    /// Position.
    pub fn position(&self) -> Floor {
        Floor::new(self.x.p, self.y.p)
    }

    /// Velocity, m/s.
    pub fn velocity(&self) -> Planar {
        Planar::new(self.x.v, self.y.v)
    }

    /// Acceleration, m/s2.
    pub fn acceleration(&self) -> Planar {
        Planar::new(self.x.a, self.y.a)
    }
}

impl AxisPath {
    /// To `v_target` and no acceleration, in least time within the limits. A reversal brakes to rest first, so that
    /// no braking is carried through zero into speeding up.
    pub fn to_velocity(start: AxisState, v_target: f64, limits: &AxisLimits) -> Self {
        let (v_target, most) = target_and_most(start, v_target, limits);
        Self::build(start, 0.0, v_target, most, limits.jerk_mps3)
    }

    /// Where the path to `v_target` is after `secs`: the same as asking the whole path.
    pub fn towards_velocity(start: AxisState, v_target: f64, limits: &AxisLimits, secs: f64) -> AxisState {
        let (v_target, most) = target_and_most(start, v_target, limits);
        let ramps = Ramps::of(start, v_target, most, limits.jerk_mps3);
        // On the first ramp, where a period mostly ends, the rest of the path need not be known.
        if secs < ramps.ramp_in {
            start.after(ramps.jerk_in, secs)
        } else {
            Self::of_ramps(start, 0.0, ramps, v_target).at(secs)
        }
    }

    /// To rest as fast as the axis may.
    pub fn brake(start: AxisState, limits: &AxisLimits) -> Self {
        Self::build(start, 0.0, 0.0, limits.braking_mps2, limits.jerk_mps3)
    }

    /// To rest with this share of the axis' braking and jerk, so that two axes come to rest together; with all of it
    /// where the share could no longer stop without running back, or would first get faster than it need.
    pub fn brake_with_share(start: AxisState, limits: &AxisLimits, share: f64) -> Self {
        let ramp_out_mps = start.a * start.a / (2.0 * limits.jerk_mps3 * share);
        let speeds_up = start.a * start.v > 0.0;
        let would_run_back = start.a * start.v < 0.0 && ramp_out_mps > start.v.abs();
        if speeds_up || would_run_back || start.a.abs() > limits.braking_mps2 * share {
            return Self::brake(start, limits);
        }
        Self::build(start, 0.0, 0.0, limits.braking_mps2 * share, limits.jerk_mps3 * share)
    }

    /// The brake of an axis that, for `reaction_secs` more, accelerates as hard as it may in its direction.
    pub fn worst_brake(start: AxisState, limits: &AxisLimits, reaction_secs: f64) -> Self {
        let heading = if start.v.abs() > STILL_MPS { start.v } else { start.a };
        let room = ((limits.speed_mps - start.v.abs()) / reaction_secs).max(0.0);
        let push = if heading == 0.0 { 0.0 } else { limits.acceleration_mps2.min(room).copysign(heading) };
        let start = AxisState { a: push, ..start };
        Self::build(start, reaction_secs, 0.0, limits.braking_mps2, limits.jerk_mps3)
    }

    /// On at the start's acceleration for `reaction_secs`; then to the target.
    fn build(start: AxisState, reaction_secs: f64, v_target: f64, most: f64, jerk: f64) -> Self {
        let ramps = Ramps::of(start.carried(reaction_secs), v_target, most, jerk);
        Self::of_ramps(start, reaction_secs, ramps, v_target)
    }

    fn of_ramps(start: AxisState, reaction_secs: f64, ramps: Ramps, v_target: f64) -> Self {
        let Ramps { jerk_in, ramp_in, hold, jerk_out, ramp_out } = ramps;
        let reacted = start.carried(reaction_secs);
        let at_peak = reacted.after(jerk_in, ramp_in);
        let held = at_peak.carried(hold);
        let [peaks, leaves] = [reaction_secs + ramp_in, reaction_secs + ramp_in + hold];
        Self {
            pieces: [
                Piece { start, jerk: 0.0, from_secs: 0.0 },
                Piece { start: reacted, jerk: jerk_in, from_secs: reaction_secs },
                Piece { start: at_peak, jerk: 0.0, from_secs: peaks },
                Piece { start: held, jerk: jerk_out, from_secs: leaves },
            ],
            end: AxisState { p: held.after(jerk_out, ramp_out).p, v: v_target, a: 0.0 },
            duration_secs: leaves + ramp_out,
        }
    }

    /// The state `t` seconds from the start.
    pub fn at(&self, t: f64) -> AxisState {
        if t >= self.duration_secs {
            return AxisState { p: self.end.p + self.end.v * (t - self.duration_secs), ..self.end };
        }
        let piece = self.pieces.iter().rev().find(|piece| piece.from_secs <= t).unwrap_or(&self.pieces[0]);
        piece.start.after(piece.jerk, t - piece.from_secs)
    }

    /// How long until the target velocity.
    pub fn duration_secs(&self) -> f64 {
        self.duration_secs
    }

    /// Least and greatest position on the way, m.
    pub fn extent_m(&self) -> (f64, f64) {
        let mut extent = (self.end.p, self.end.p);
        let mut include = |p: f64| extent = (extent.0.min(p), extent.1.max(p));
        for (i, piece) in self.pieces.iter().enumerate() {
            include(piece.start.p);
            let until = self.pieces.get(i + 1).map_or(self.duration_secs, |next| next.from_secs);
            for t in turning_times(piece) {
                if t > 0.0 && t < until - piece.from_secs {
                    include(piece.start.after(piece.jerk, t).p);
                }
            }
        }
        extent
    }
}

/// The velocity to go to first, and the greatest acceleration on the way.
fn target_and_most(start: AxisState, v_target: f64, limits: &AxisLimits) -> (f64, f64) {
    let reverses = start.v * v_target < 0.0 && start.v.abs() > REVERSES_BELOW_MPS;
    let v_target = if reverses { 0.0 } else { v_target };
    let slows = start.v * (v_target - start.v) < 0.0 && start.v * v_target >= 0.0;
    (v_target, if slows { limits.braking_mps2 } else { limits.acceleration_mps2 })
}

impl Ramps {
    fn of(from: AxisState, v_target: f64, most: f64, jerk: f64) -> Self {
        let AxisState { v, a, .. } = from;
        // Where the velocity would end if the acceleration ramped to zero from here.
        let v_ramped_out = v + a * a.abs() / (2.0 * jerk);
        let way = if v_target >= v_ramped_out { 1.0 } else { -1.0 };
        let (a, dv) = (a * way, (v_target - v) * way);
        let unbounded = (jerk * dv + 0.5 * a * a).max(0.0).sqrt();
        let peak = unbounded.min(most);
        let ramp_in = (peak - a).abs() / jerk;
        let ramp_out = peak / jerk;
        let hold = if unbounded > most {
            ((dv - 0.5 * (a + peak) * ramp_in - 0.5 * peak * ramp_out) / peak).max(0.0)
        } else {
            0.0
        };
        Self { jerk_in: (peak - a).signum() * way * jerk, ramp_in, hold, jerk_out: -way * jerk, ramp_out }
    }
}

/// When a piece's velocity is zero, s from its start.
fn turning_times(piece: &Piece) -> [f64; 2] {
    let AxisState { v, a, .. } = piece.start;
    if piece.jerk == 0.0 {
        return if a == 0.0 { [-1.0; 2] } else { [-v / a; 2] };
    }
    let discriminant = a * a - 2.0 * piece.jerk * v;
    if discriminant < 0.0 {
        return [-1.0; 2];
    }
    let root = discriminant.sqrt();
    [(-a + root) / piece.jerk, (-a - root) / piece.jerk]
}

impl BrakePath {
    /// The worst brake from `state`: both axes accelerate on for the reaction time, then brake at their limits.
    pub fn worst(state: &State, limits: &Limits, reaction_secs: f64) -> Self {
        Self {
            x: AxisPath::worst_brake(state.x, &limits.x, reaction_secs),
            y: AxisPath::worst_brake(state.y, &limits.y, reaction_secs),
        }
    }

    /// The brake at the limits, begun now.
    pub fn now(state: &State, limits: &Limits) -> Self {
        Self { x: AxisPath::brake(state.x, &limits.x), y: AxisPath::brake(state.y, &limits.y) }
    }

    /// The brake at the limits, begun now, with no bound on jerk: as hard as it may.
    pub fn abrupt(state: &State, limits: &Limits) -> Self {
        let axis = |start: AxisState, limits: &AxisLimits| {
            let start = AxisState { a: 0.0, ..start };
            AxisPath::build(start, 0.0, 0.0, limits.braking_mps2, ABRUPT_MPS3)
        };
        Self { x: axis(state.x, &limits.x), y: axis(state.y, &limits.y) }
    }

    /// The centre `s` seconds from now.
    pub fn centre(&self, s: f64) -> Floor {
        Floor::new(self.x.at(s).p, self.y.at(s).p)
    }

    /// The whole state `s` seconds from now.
    pub fn at(&self, s: f64) -> State {
        State { x: self.x.at(s), y: self.y.at(s) }
    }

    /// Until both axes rest.
    pub fn duration_secs(&self) -> f64 {
        self.x.duration_secs.max(self.y.duration_secs)
    }

    /// The corners of the smallest floor rectangle that holds the whole path.
    pub fn extent(&self) -> (Floor, Floor) {
        let ((x0, x1), (y0, y1)) = (self.x.extent_m(), self.y.extent_m());
        (Floor::new(x0, y0), Floor::new(x1, y1))
    }

    /// No centre of the path moves faster, m/s.
    pub fn greatest_speed_mps(&self) -> f64 {
        let most =
            |axis: &AxisPath| axis.pieces.iter().map(|p| p.start.v.abs()).fold(0.0, f64::max) + RAMP_GAIN_MPS;
        most(&self.x).hypot(most(&self.y))
    }
}

/// So much jerk is as good as none bounded, m/s3.
const ABRUPT_MPS3: f64 = 1e6;
/// Slower than this an axis has no heading of its own, m/s.
const STILL_MPS: f64 = 1e-4;
/// So slow, an axis may take up the other direction at once, m/s.
const REVERSES_BELOW_MPS: f64 = 1e-3;
/// Between the starts of two pieces a velocity exceeds both by less than this, m/s (a_max^2 / 2 J of any sane machine).
const RAMP_GAIN_MPS: f64 = 0.05;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LIMITS: AxisLimits = AxisLimits::PAPER;

    #[test]
    fn braking_from_full_speed_takes_what_the_formula_says() {
        let path = AxisPath::brake(AxisState { p: 0.0, v: 1.1, a: 0.0 }, &LIMITS);
        // v / a + a / J, and v/2 of that as distance: a symmetrical trapezoid of deceleration.
        let duration = 1.1 / 2.5 + 2.5 / 80.0;
        assert!((path.duration_secs() - duration).abs() < 1e-12);
        assert!((path.at(9.0).p - 1.1 * duration / 2.0).abs() < 1e-9);
    }

    #[test]
    fn braking_is_not_carried_through_zero() {
        // Braking hard at the moment when the other direction is wanted.
        let mut state = AxisState { p: 0.0, v: 0.052, a: -2.5 };
        for _ in 0..50 {
            state = AxisPath::to_velocity(state, -0.5, &LIMITS).at(0.004);
            assert!(state.v > -1e-3 || state.a >= -LIMITS.acceleration_mps2 - 1e-9, "{state:?}");
        }
    }

    #[test]
    fn a_shared_brake_never_runs_back() {
        let path = AxisPath::brake_with_share(AxisState { p: 0.0, v: 0.06, a: -2.5 }, &LIMITS, 0.1);
        assert!(path.extent_m().0 > -1e-9 && path.at(9.0).p < 0.01, "{path:?}");
    }

    /// The profile as it is told in words, a piece after the other, from where the last one ended.
    fn piece_by_piece(start: AxisState, reaction_secs: f64, v_target: f64, most: f64, jerk: f64) -> AxisPath {
        let mut pieces = Vec::new();
        let (mut end, mut duration_secs) = (start, 0.0);
        let mut push = |jerk: f64, secs: f64| {
            pieces.push(Piece { start: end, jerk, from_secs: duration_secs });
            end = end.after(jerk, secs);
            duration_secs += secs;
            end
        };
        let AxisState { v, a, .. } = push(0.0, reaction_secs);
        let way = if v_target >= v + a * a.abs() / (2.0 * jerk) { 1.0 } else { -1.0 };
        let (a, dv) = (a * way, (v_target - v) * way);
        let unbounded = (jerk * dv + 0.5 * a * a).max(0.0).sqrt();
        let peak = unbounded.min(most);
        let (ramp_in, ramp_out) = ((peak - a).abs() / jerk, peak / jerk);
        let hold = (dv - 0.5 * (a + peak) * ramp_in - 0.5 * peak * ramp_out) / peak;
        push((peak - a).signum() * way * jerk, ramp_in);
        push(0.0, if unbounded > most { hold.max(0.0) } else { 0.0 });
        push(-way * jerk, ramp_out);
        let pieces = [pieces[0], pieces[1], pieces[2], pieces[3]];
        AxisPath { pieces, end: AxisState { v: v_target, a: 0.0, ..end }, duration_secs }
    }

    proptest! {
        /// Bit for bit: what is certified and what is driven may not come to depend on how it is written down.
        #[test]
        fn a_path_is_its_pieces_one_after_the_other(
            (p, v, a) in (-4.0..4.0f64, -1.6..1.6f64, -3.0..3.0f64), target in -1.6..1.6f64,
            reaction_secs in prop_oneof![Just(0.0), 0.0..0.2f64], most in 0.1..3.0f64,
            jerk in prop_oneof![Just(80.0), 1.0..200.0f64, Just(ABRUPT_MPS3)],
        ) {
            let start = AxisState { p, v, a };
            let path = AxisPath::build(start, reaction_secs, target, most, jerk);
            let expected = piece_by_piece(start, reaction_secs, target, most, jerk);
            prop_assert_eq!(path, expected);
        }

        /// Bit for bit, whichever piece it ends in.
        #[test]
        fn a_step_along_a_path_is_where_the_whole_path_is(
            (p, v, a) in (-4.0..4.0f64, -1.2..1.2f64, -2.5..2.5f64), target in -1.2..1.2f64,
            secs in prop_oneof![Just(0.0), Just(0.004), Just(0.013_334), 0.0..1.5f64],
        ) {
            let start = AxisState { p, v, a };
            let step = AxisPath::towards_velocity(start, target, &LIMITS, secs);
            let whole = AxisPath::to_velocity(start, target, &LIMITS).at(secs);
            prop_assert_eq!([step.p, step.v, step.a].map(f64::to_bits), [whole.p, whole.v, whole.a].map(f64::to_bits));
        }

        #[test]
        fn every_path_ends_at_its_target_within_limits(
            v in -1.1..1.1f64, a in -2.5..2.5f64, target in -1.1..1.1f64,
        ) {
            prop_assume!(v * target >= 0.0);
            let path = AxisPath::to_velocity(AxisState { p: 0.3, v, a }, target, &LIMITS);
            let end = path.at(path.duration_secs() - 1e-9);
            prop_assert!((end.v - target).abs() < 1e-6 && end.a.abs() < 1e-5, "ends at {end:?}");
            let (mut t, step) = (0.0, 1e-3);
            let mut before = path.at(0.0);
            let bound = LIMITS.braking_mps2.max(a.abs());
            while t < path.duration_secs() {
                t += step;
                let now = path.at(t);
                prop_assert!(now.a.abs() <= bound + 1e-9);
                prop_assert!((now.a - before.a).abs() <= LIMITS.jerk_mps3 * step + 1e-9);
                prop_assert!((now.v - before.v - 0.5 * (now.a + before.a) * step).abs() < 1e-4);
                before = now;
            }
        }

        #[test]
        fn the_extent_holds_the_whole_path(v in -1.1..1.1f64, a in -2.5..2.5f64) {
            let path = AxisPath::worst_brake(AxisState { p: 0.0, v, a }, &LIMITS, 0.05);
            let (low, high) = path.extent_m();
            for k in 0..=200 {
                let p = path.at(f64::from(k) / 200.0 * path.duration_secs()).p;
                prop_assert!(p >= low - 1e-12 && p <= high + 1e-12);
            }
        }

        #[test]
        fn following_a_path_step_by_step_is_following_the_path(v in 0.0..1.0f64, target in 0.0..1.0f64) {
            let whole = AxisPath::to_velocity(AxisState { p: 0.0, v, a: 0.0 }, target, &LIMITS);
            let mut state = AxisState { p: 0.0, v, a: 0.0 };
            let mut t = 0.0;
            while t < whole.duration_secs() + 0.1 {
                state = AxisPath::to_velocity(state, target, &LIMITS).at(0.004);
                t += 0.004;
            }
            prop_assert!((state.v - target).abs() < 1e-6 && (state.p - whole.at(t).p).abs() < 5e-3);
        }
    }
}
