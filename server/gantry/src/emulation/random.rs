//! Chance for the faults: SplitMix64 (Steele, Lea and Flood 2014), named by its seed.

/// A stream of numbers that its seed determines.
#[derive(Debug, Clone)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// True with this probability; draws nothing when it cannot be.
    pub(crate) fn chance(&mut self, probability: f64) -> bool {
        // 53 bits: every value is a double of its own.
        probability > 0.0 && ((self.draw() >> 11) as f64) * 2f64.powi(-53) < probability
    }

    /// A whole number below `bound`, which is at least 1 and far below 2^64.
    pub(crate) fn below(&mut self, bound: usize) -> usize {
        (self.draw() % bound.max(1) as u64) as usize
    }

    const fn draw(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chance_comes_as_often_as_it_says_and_the_same_every_time() {
        let count = |seed| {
            let mut random = Random::new(seed);
            (0..10_000).filter(|_| random.chance(0.25)).count()
        };
        assert_eq!(count(7), count(7));
        assert!((2_300..2_700).contains(&count(7)));
        assert_ne!(count(7), count(8));
        assert!(!Random::new(1).chance(0.0));
        assert!(Random::new(1).chance(1.0));
    }
}
