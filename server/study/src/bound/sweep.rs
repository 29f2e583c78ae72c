//! Everything that can be reached, step by step: one bit for each place and speed of both axes.

use covr_engine::frames::Floor;

use super::lattice::{AxisLattice, AxisMove};
use super::separation::{Separation, Shadow};

/// What is swept.
#[derive(Debug)]
pub(super) struct Sweep<'a> {
    pub axes: [AxisLattice; 2],
    /// The rule.
    pub separation: Separation<'a>,
    /// Length of a step, s.
    pub step_secs: f64,
    /// When the first step begins, into the walk, s.
    pub begins_secs: f64,
    /// How many steps there are.
    pub steps: usize,
    /// Where the column has to stand at the end, and how near.
    pub goal: Floor,
    /// How near its centre has to be, m.
    pub within_m: f64,
    /// The greatest speed at the end, in quanta.
    pub at_rest: i32,
    /// Where the braking path must end: least and greatest of each axis, m.
    pub within_travel_m: [[f64; 2]; 2],
}

/// Place and speed of both axes: indices and quanta.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct State {
    pub place: [i32; 2],
    pub speed: [i32; 2],
}

/// Which states are reached after some step. Rows of bits along y, by speeds and x.
#[derive(Debug, Clone)]
struct Layer {
    bits: Vec<u64>,
    /// By speeds: the first x with a state and the one after the last.
    spans: Vec<[i32; 2]>,
}

impl Sweep<'_> {
    /// Whether the goal can be reached.
    pub fn reaches_goal(&self) -> bool {
        let mut layer = self.first();
        for step in 0..self.steps {
            layer = self.after(&layer, step);
        }
        self.arrived(&layer).is_some()
    }

    /// A motion to the goal: the states between the steps, the start first.
    pub fn path(&self) -> Option<Vec<State>> {
        let mut layers = vec![self.first()];
        for step in 0..self.steps {
            layers.push(self.after(&layers[step], step));
        }
        let mut path = vec![self.arrived(&layers[self.steps])?];
        for step in (0..self.steps).rev() {
            path.push(self.before(&layers[step], step, path[path.len() - 1])?);
        }
        path.reverse();
        Some(path)
    }

    fn first(&self) -> Layer {
        let mut layer = self.empty();
        let start = State { place: [self.axes[0].start(), self.axes[1].start()], speed: [0, 0] };
        self.set(&mut layer, start);
        layer
    }

    fn empty(&self) -> Layer {
        let speeds = (self.axes[0].speeds() * self.axes[1].speeds()) as usize;
        Layer {
            bits: vec![0; speeds * self.axes[0].places() as usize * self.words()],
            spans: vec![[i32::MAX, 0]; speeds],
        }
    }

    /// Everything that one more step leads to.
    fn after(&self, layer: &Layer, step: usize) -> Layer {
        let mut next = self.empty();
        let (words, width) = (self.words(), self.axes[0].places());
        let begins_secs = self.begins_secs + step as f64 * self.step_secs;
        let mut shadows = Vec::new();
        let mut row = vec![0u64; words];
        for x in self.axes[0].moves() {
            for y in self.axes[1].moves() {
                let (source, target) = (self.speeds([x.from, y.from]), self.speeds([x.to, y.to]));
                let [first, end] = layer.spans[source];
                if first >= end {
                    continue;
                }
                self.separation.shadows(&self.axes, [x, y], begins_secs, self.step_secs, &mut shadows);
                let along_y = self.within_travel(1, y);
                for from in first.max(-x.covers())..end.min(width - x.covers()) {
                    let bits = &layer.bits[self.row(source, from)..][..words];
                    if bits.iter().all(|word| *word == 0) || !self.within_travel(0, x).contains(&from) {
                        continue;
                    }
                    row.copy_from_slice(bits);
                    clear(&mut row, 0, *along_y.start());
                    clear(&mut row, *along_y.end() + 1, self.axes[1].places());
                    self.shade(&mut row, from, &shadows);
                    if row.iter().all(|word| *word == 0) {
                        continue;
                    }
                    let to = from + x.covers();
                    let begin = self.row(target, to);
                    shift_into(&row, y.covers(), &mut next.bits[begin..begin + words]);
                    let span = &mut next.spans[target];
                    *span = [span[0].min(to), span[1].max(to + 1)];
                }
            }
        }
        next
    }

    /// Clear what lies in the shadows.
    fn shade(&self, row: &mut [u64], x: i32, shadows: &[Shadow]) {
        let x_m = self.axes[0].place_m(x);
        for shadow in shadows {
            if let Some([least, most]) = shadow.on_line(x_m) {
                let from = self.axes[1].index_of(least).ceil().max(0.0) as i32;
                let to = self.axes[1].index_of(most).floor().min(f64::from(self.axes[1].places() - 1)) as i32;
                clear(row, from, to + 1);
            }
        }
    }

    /// A state of the layer from which this step leads to `state`.
    fn before(&self, layer: &Layer, step: usize, state: State) -> Option<State> {
        let begins_secs = self.begins_secs + step as f64 * self.step_secs;
        let mut shadows = Vec::new();
        let [along_x, along_y] = [0, 1].map(|axis: usize| {
            self.axes[axis].moves().into_iter().filter(move |step| step.to == state.speed[axis])
        });
        let along_y: Vec<AxisMove> = along_y.collect();
        for x in along_x {
            for &y in &along_y {
                let place = [state.place[0] - x.covers(), state.place[1] - y.covers()];
                let earlier = State { place, speed: [x.from, y.from] };
                let inside = self.within_travel(0, x).contains(&place[0])
                    && self.within_travel(1, y).contains(&place[1]);
                if !inside || !self.has(layer, earlier) {
                    continue;
                }
                self.separation.shadows(&self.axes, [x, y], begins_secs, self.step_secs, &mut shadows);
                let column = self.column(earlier);
                if !shadows.iter().any(|shadow| shadow.covers(column)) {
                    return Some(earlier);
                }
            }
        }
        None
    }

    /// A state of the layer that counts as arrived, the nearest to the goal.
    fn arrived(&self, layer: &Layer) -> Option<State> {
        let slow = -self.at_rest..=self.at_rest;
        let mut best: Option<(f64, State)> = None;
        for speed in slow.clone().flat_map(|x| slow.clone().map(move |y| [x, y])) {
            let [first, end] = layer.spans[self.speeds(speed)];
            for x in first..end {
                for y in 0..self.axes[1].places() {
                    let state = State { place: [x, y], speed };
                    let distance_m = self.column(state).distance_m(self.goal);
                    let nearer = best.is_none_or(|(least, _)| distance_m < least);
                    if nearer && distance_m <= self.within_m && self.has(layer, state) {
                        best = Some((distance_m, state));
                    }
                }
            }
        }
        best.map(|(_, state)| state)
    }

    fn column(&self, state: State) -> Floor {
        Floor::new(self.axes[0].place_m(state.place[0]), self.axes[1].place_m(state.place[1]))
    }

    /// From which places of an axis a step ends where braking keeps within the travel.
    fn within_travel(&self, axis: usize, step: AxisMove) -> std::ops::RangeInclusive<i32> {
        let places = self.axes[axis].places();
        if step.rests() {
            return 0..=places - 1;
        }
        let rests_m = self.axes[axis].brake(step, 1.0).rests_m;
        let [least, most] = self.within_travel_m[axis].map(|edge| self.axes[axis].index_of(edge - rests_m));
        let (least, most) = (least.ceil() as i32, most.floor() as i32);
        least.max(0).max(-step.covers())..=most.min(places - 1).min(places - 1 - step.covers())
    }

    fn words(&self) -> usize {
        (self.axes[1].places() as usize).div_ceil(64)
    }

    fn speeds(&self, [x, y]: [i32; 2]) -> usize {
        let (x, y) = (x + self.axes[0].fastest(), y + self.axes[1].fastest());
        (x * self.axes[1].speeds() + y) as usize
    }

    fn row(&self, speeds: usize, x: i32) -> usize {
        (speeds * self.axes[0].places() as usize + x as usize) * self.words()
    }

    fn has(&self, layer: &Layer, state: State) -> bool {
        let fits = (0..2).all(|axis| {
            (0..self.axes[axis].places()).contains(&state.place[axis])
                && state.speed[axis].abs() <= self.axes[axis].fastest()
        });
        fits && {
            let row = self.row(self.speeds(state.speed), state.place[0]);
            layer.bits[row + state.place[1] as usize / 64] >> (state.place[1] % 64) & 1 == 1
        }
    }

    fn set(&self, layer: &mut Layer, state: State) {
        let speeds = self.speeds(state.speed);
        let row = self.row(speeds, state.place[0]);
        layer.bits[row + state.place[1] as usize / 64] |= 1 << (state.place[1] % 64);
        let span = &mut layer.spans[speeds];
        *span = [span[0].min(state.place[0]), span[1].max(state.place[0] + 1)];
    }
}

/// Clear the bits `from..end`.
fn clear(row: &mut [u64], from: i32, end: i32) {
    let (from, end) = (from.max(0) as usize, (end.max(0) as usize).min(row.len() * 64));
    if from >= end {
        return;
    }
    let (first, last) = (from / 64, (end - 1) / 64);
    let head = u64::MAX << (from % 64);
    let tail = u64::MAX >> (63 - (end - 1) % 64);
    if first == last {
        row[first] &= !(head & tail);
        return;
    }
    row[first] &= !head;
    row[first + 1..last].fill(0);
    row[last] &= !tail;
}

/// Add the bits of `row`, moved up by `by` (or down), to `target`.
fn shift_into(row: &[u64], by: i32, target: &mut [u64]) {
    let (words, bits) = ((by.unsigned_abs() / 64) as usize, by.unsigned_abs() % 64);
    let count = row.len();
    for (index, out) in target.iter_mut().enumerate() {
        let at = |offset: usize| -> u64 {
            let source =
                if by >= 0 { index.checked_sub(words + offset) } else { Some(index + words + offset) };
            source.filter(|source| *source < count).map_or(0, |source| row[source])
        };
        let (near, far) = (at(0), at(1));
        *out |= match (by >= 0, bits) {
            (_, 0) => near,
            (true, bits) => near << bits | far >> (64 - bits),
            (false, bits) => near >> bits | far << (64 - bits),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn bits(row: &[u64]) -> Vec<i32> {
        (0..row.len() as i32 * 64).filter(|i| row[*i as usize / 64] >> (i % 64) & 1 == 1).collect()
    }

    proptest! {
        #[test]
        fn rows_are_shifted_and_cleared_bit_by_bit(
            row in prop::collection::vec(any::<u64>(), 1..5), by in -300..300i32, from in -10..300i32, length in 0..200i32,
        ) {
            let end = row.len() as i32 * 64;
            let mut shifted = vec![0; row.len()];
            shift_into(&row, by, &mut shifted);
            let expected: Vec<i32> = bits(&row).iter().map(|i| i + by).filter(|i| (0..end).contains(i)).collect();
            prop_assert_eq!(bits(&shifted), expected);
            let mut cleared = row.clone();
            clear(&mut cleared, from, from + length);
            let expected: Vec<i32> = bits(&row).into_iter().filter(|i| !(from..from + length).contains(i)).collect();
            prop_assert_eq!(bits(&cleared), expected);
        }
    }
}
