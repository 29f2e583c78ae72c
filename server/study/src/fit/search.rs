//! The least loss over named parameters: a pattern search (Hooke and Jeeves 1961) in shares of their ranges. It needs no
//! derivative, never leaves the ranges, and is the same each time.

/// Where the search ended.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Found {
    /// Share of each parameter's range, 0 to 1.
    pub shares: Vec<f64>,
    /// The loss there.
    pub loss: f64,
}

/// Search from `start`. The first steps are a quarter of each range, and are halved until they are finer than a hundredth.
pub(super) fn least<E>(start: &[f64], mut loss: impl FnMut(&[f64]) -> Result<f64, E>) -> Result<Found, E> {
    let mut found = Found { shares: start.to_vec(), loss: loss(start)? };
    let mut step = FIRST_STEP;
    while step >= LAST_STEP {
        let base = found.clone();
        explore(&mut found, step, &mut loss)?;
        if found.loss >= base.loss {
            step *= 0.5;
            continue;
        }
        // As far again the same way; kept only if exploring from there finds less.
        let beyond: Vec<f64> = found
            .shares
            .iter()
            .zip(&base.shares)
            .map(|(now, before)| (2.0 * now - before).clamp(0.0, 1.0))
            .collect();
        let mut leap = Found { loss: loss(&beyond)?, shares: beyond };
        explore(&mut leap, step, &mut loss)?;
        if leap.loss < found.loss {
            found = leap;
        }
    }
    Ok(found)
}

/// One step up and down along each parameter in turn, keeping what is less.
fn explore<E>(
    found: &mut Found,
    step: f64,
    loss: &mut impl FnMut(&[f64]) -> Result<f64, E>,
) -> Result<(), E> {
    for axis in 0..found.shares.len() {
        for way in [step, -step] {
            let mut shares = found.shares.clone();
            shares[axis] = (shares[axis] + way).clamp(0.0, 1.0);
            if shares == found.shares {
                continue;
            }
            let there = loss(&shares)?;
            if there < found.loss {
                *found = Found { shares, loss: there };
                break;
            }
        }
    }
    Ok(())
}

const FIRST_STEP: f64 = 0.25;
const LAST_STEP: f64 = 0.01;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bottom_of_a_bent_valley_is_found() {
        // Rosenbrock's valley on a unit square, its bottom at (0.75, 0.6).
        let valley = |p: &[f64]| {
            let (x, y) = (1.0 + (p[0] - 0.75), 1.0 + (p[1] - 0.6));
            Ok::<_, ()>((1.0 - x).powi(2) + 10.0 * (y - x * x).powi(2))
        };
        let found = least(&[0.1, 0.9], valley);
        assert!(found.as_ref().is_ok_and(|found| found.loss < 1e-3), "{found:?}");
        assert_eq!(found, least(&[0.1, 0.9], valley));
    }

    #[test]
    fn an_optimum_at_an_edge_is_reached_and_not_passed() {
        let found = least(&[0.5, 0.5], |p| {
            assert!(p.iter().all(|share| (0.0..=1.0).contains(share)));
            Ok::<_, ()>(p[0] - p[1])
        });
        assert_eq!(found.unwrap().shares, [0.0, 1.0]);
    }

    #[test]
    fn a_loss_that_cannot_be_told_ends_the_search() {
        let mut asked = 0;
        let ended = least(&[0.5], |_| {
            asked += 1;
            if asked < 3 { Ok(1.0) } else { Err("no more") }
        });
        assert_eq!((ended, asked), (Err("no more"), 3));
    }
}
