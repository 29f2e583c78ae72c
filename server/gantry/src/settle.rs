//! The dead band of a position loop at rest.
//!
//! An integral velocity loop with stiction hunts for ever around a place between two counts. Once the axis rests near
//! enough, nothing is asked of it until it is clearly pushed away.

/// Whether the axis counts as settled.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Settler {
    is_settled: bool,
}

impl Settler {
    /// Whether to leave the axis alone, given the speed that the reference and the encoder have and the distance
    /// between them.
    pub(crate) fn is_settled(&mut self, reference_mps: f64, measured_mps: f64, error_m: f64) -> bool {
        let is_resting = reference_mps.abs() < STILL_MPS;
        self.is_settled = if self.is_settled {
            is_resting && error_m.abs() < LEAVE_M
        } else {
            is_resting && measured_mps.abs() < STILL_MPS && error_m.abs() < ENTER_M
        };
        self.is_settled
    }

    /// Whether it was when last asked.
    pub(crate) const fn was_settled(self) -> bool {
        self.is_settled
    }
}

/// Below this a reference or an axis rests, m/s.
const STILL_MPS: f64 = 1e-3;
/// Near enough to be left alone, m.
const ENTER_M: f64 = 0.4e-3;
/// Far enough to be corrected again, m.
const LEAVE_M: f64 = 0.9e-3;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_settles_near_and_wakes_only_when_far() {
        let mut settler = Settler::default();
        assert!(!settler.is_settled(0.0, 0.0, 0.6e-3), "too far to settle");
        assert!(!settler.is_settled(0.0, 0.05, 0.1e-3), "still moving");
        assert!(settler.is_settled(0.0, 0.0, 0.1e-3));
        assert!(settler.is_settled(0.0, 0.0, -0.6e-3), "not far enough to wake");
        assert!(!settler.is_settled(0.0, 0.0, 1.0e-3));
        assert!(settler.is_settled(0.0, 0.0, 0.1e-3));
        assert!(!settler.is_settled(0.01, 0.0, 0.1e-3), "the reference moves");
    }
}
