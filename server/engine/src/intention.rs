//! Which object will the visitor touch next? Rules, each by name, behind one trait.
//!
//! A rule sees distances, angles and priors of one visitor; it never sees the column, and it moves nothing.

mod nearest;
mod paper;

use crate::frames::{Floor, Planar, Pose, Room};
use crate::scene::Scene;

/// One object as the visitor has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// From the head to the nearest surface, m; 0 inside.
    pub distance_m: f64,
    /// Angle between the view axis and the object, rad; 0 when the view ray hits it.
    pub angle_rad: f64,
    /// The scenario prior P, 0 to 1.
    pub prior: f64,
    /// It can be served now.
    pub enabled: bool,
}

/// What a rule makes of it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Belief {
    /// W of each object, prior included; 0 for a disabled one.
    pub weights: Vec<f64>,
    /// The share of each object in the command position; sums to 1, or all 0 when nothing can be served.
    pub shares: Vec<f64>,
    /// The object that the rule is committed to.
    pub committed: Option<usize>,
}

/// An intention rule.
pub trait Rule: std::fmt::Debug + Send + Sync {
    /// Weigh the objects of one visitor; `belief` is reused from pose to pose. To weigh the same sights again changes
    /// neither the rule nor the belief: time passes for people, who move, and not for rules.
    fn weigh(&mut self, sights: &[Sight], belief: &mut Belief);

    /// A copy with what it remembers.
    fn boxed(&self) -> Box<dyn Rule>;
}

impl Clone for Box<dyn Rule> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}

/// The rules that can be chosen, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RuleName {
    /// Commit, mean: once any W > 0.8, the mean over those alone. Reproduces the paper's figures.
    Paper,
    /// To the letter: W > 0.8 becomes 1, the rest keep their weights.
    PaperLiteral,
    /// Once any W > 0.8, the largest unrounded W alone.
    PaperBest,
    /// The same, held until its W falls to 0.8.
    PaperHeld,
    /// The nearest surface.
    Nearest,
}

impl RuleName {
    /// Every rule.
    pub const ALL: [Self; 5] =
        [Self::Paper, Self::PaperLiteral, Self::PaperBest, Self::PaperHeld, Self::Nearest];

    /// Its name in configuration, tables and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::PaperLiteral => "paper-literal",
            Self::PaperBest => "paper-best",
            Self::PaperHeld => "paper-held",
            Self::Nearest => "nearest",
        }
    }

    /// The rule of this name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|rule| rule.name() == name)
    }

    /// A fresh rule for one visitor.
    pub fn rule(self) -> Box<dyn Rule> {
        match self {
            Self::Paper => Box::new(paper::Paper::new(paper::Commitment::Mean)),
            Self::PaperLiteral => Box::new(paper::Paper::new(paper::Commitment::Literal)),
            Self::PaperBest => Box::new(paper::Paper::new(paper::Commitment::Best)),
            Self::PaperHeld => Box::new(paper::Paper::new(paper::Commitment::Held)),
            Self::Nearest => Box::new(nearest::Nearest),
        }
    }
}

/// The objects as a head has them, into a reused buffer.
pub fn sights(scene: &Scene, priors: &[f64], head: &Pose<Room>, out: &mut Vec<Sight>) {
    out.clear();
    out.extend(scene.objects().iter().zip(&scene.spec().objects).zip(priors).map(
        |((object, spec), prior)| Sight {
            distance_m: object.distance_m(&head.position),
            angle_rad: object.angle_rad(head),
            prior: *prior,
            enabled: spec.enabled,
        },
    ));
}

/// The command position (eq. 1): the mean of the objects' column places by their shares; none without any share.
pub fn command_position(scene: &Scene, belief: &Belief) -> Option<Floor> {
    let mut sum = Planar::ZERO;
    let mut total = 0.0;
    for (object, share) in scene.objects().iter().zip(&belief.shares) {
        sum += (object.column_place() - Floor::new(0.0, 0.0)) * *share;
        total += share;
    }
    (total > 0.0).then(|| Floor::new(0.0, 0.0) + sum * (1.0 / total))
}

impl Belief {
    /// The sum of the weights, which a probability is a share of.
    pub fn total(&self) -> f64 {
        self.weights.iter().sum()
    }

    /// Give every object the share `share(i)`, scaled to sum to 1.
    fn share_by(&mut self, count: usize, share: impl Fn(usize) -> f64) {
        self.shares.clear();
        self.shares.extend((0..count).map(share));
        let total: f64 = self.shares.iter().sum();
        if total > 0.0 {
            self.shares.iter_mut().for_each(|s| *s /= total);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sights(count: usize) -> impl Strategy<Value = Vec<Sight>> {
        let sight = (0.0..3.0f64, 0.0..1.2f64, 0.0..1.0f64, prop::bool::weighted(0.9));
        let sight = sight.prop_map(|(distance_m, angle_rad, prior, enabled)| Sight {
            distance_m,
            angle_rad,
            prior,
            enabled,
        });
        prop::collection::vec(sight, count)
    }

    proptest! {
        #[test]
        fn a_rule_that_sees_the_same_again_finds_the_same(
            seen in (1..12usize).prop_flat_map(|count| prop::collection::vec(sights(count), 1..6)),
        ) {
            for name in RuleName::ALL {
                let (mut once, mut often) = (name.rule(), name.rule());
                let (mut belief, mut of_often) = (Belief::default(), Belief::default());
                for sights in &seen {
                    once.weigh(sights, &mut belief);
                    for _ in 0..3 {
                        often.weigh(sights, &mut of_often);
                    }
                    prop_assert_eq!(&belief, &of_often, "{}", name.name());
                }
            }
        }
    }

    #[test]
    fn every_rule_has_a_name_of_its_own_and_answers_to_it() {
        for rule in RuleName::ALL {
            assert_eq!(RuleName::parse(rule.name()), Some(rule));
        }
        assert_eq!(RuleName::parse("Paper"), None);
    }
}
