//! The hard stop as a switch: an axis that is told to go down the rail and does not go.

/// Whether an axis stands against its stop.
#[derive(Debug, Clone, Copy, Default)]
pub struct Contact {
    is_against: bool,
    begun_at_m: f64,
    secs: f64,
    asked_m: f64,
}

impl Contact {
    /// Look again: the place, m, what the axis was told since the last look, m/s, and how long ago that was, s.
    ///
    /// It is against the stop once it went less than a quarter of what it was told over a window, and stays so until it is told
    /// to go up the rail.
    pub fn look(&mut self, here_m: f64, told_mps: f64, since_last_secs: f64) -> bool {
        if told_mps > 0.0 {
            *self = Self { begun_at_m: here_m, ..Self::default() };
            return false;
        }
        if told_mps == 0.0 {
            *self = Self { is_against: self.is_against, begun_at_m: here_m, ..Self::default() };
            return self.is_against;
        }
        if self.secs == 0.0 {
            self.begun_at_m = here_m;
        }
        self.secs += since_last_secs;
        self.asked_m += told_mps.abs() * since_last_secs;
        if self.secs >= WINDOW_SECS {
            self.is_against |= (here_m - self.begun_at_m).abs() < LEAST_PART * self.asked_m;
            *self = Self { is_against: self.is_against, begun_at_m: here_m, ..Self::default() };
        }
        self.is_against
    }
}

/// Long enough for the ramp at the beginning of a motion, short beside the time after which homing gives up.
const WINDOW_SECS: f64 = 0.25;
const LEAST_PART: f64 = 0.25;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_against_the_stop_when_it_does_not_go_until_it_is_told_up() {
        let mut contact = Contact::default();
        let mut here_m = 0.0;
        for _ in 0..100 {
            here_m -= 0.1 * 0.01;
            assert!(!contact.look(here_m, -0.1, 0.01), "it goes");
        }
        let looks = (0..100).position(|_| contact.look(here_m, -0.1, 0.01));
        assert!(looks.is_some_and(|looks| looks < 60), "{looks:?}");
        assert!(contact.look(here_m, 0.0, 0.01), "it rests against it");
        assert!(!contact.look(here_m, 0.1, 0.01));
    }

    #[test]
    fn the_ramp_at_the_beginning_is_no_stop() {
        let mut contact = Contact::default();
        let (mut here_m, mut speed): (f64, f64) = (0.0, 0.0);
        for _ in 0..100 {
            speed = (speed + 0.01).min(0.1);
            here_m -= speed * 0.01;
            assert!(!contact.look(here_m, -0.1, 0.01));
        }
    }
}
