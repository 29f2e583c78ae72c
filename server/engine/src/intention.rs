//! Which object will the visitor touch next? Rules, each by name, behind one trait.
//!
//! A rule sees distances, angles and priors of one visitor; it never sees the column, and it moves nothing.

mod bayes;
mod gaze;
mod nearest;
mod paper;
mod velocity;

use crate::frames::{Floor, Planar, Pose, Room};
use crate::motion::standing::StandingName;
use crate::observation::Hands;
use crate::scene::Scene;
use crate::time::Time;
pub use bayes::BayesParameters;
pub use paper::PaperParameters;

/// One object as the visitor has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// From the head to the nearest surface, m; 0 inside.
    pub distance_m: f64,
    /// Angle between the view axis and the object, rad; 0 when the view ray hits it.
    pub angle_rad: f64,
    /// From the head axis to the object's place, over the floor, m.
    pub offset: Planar,
    /// From the head up to the object's place, m.
    pub rise_m: f64,
    /// The scenario prior P, 0 to 1.
    pub prior: f64,
    /// It can be served now.
    pub enabled: bool,
}

/// One visitor at the moment of a pose: all that a rule may know.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View<'a> {
    /// When the pose was taken.
    pub taken_at: Time,
    /// The head, room frame.
    pub head: Pose<Room>,
    /// Velocity of the head over the floor, smoothed, m/s.
    pub velocity: Planar,
    /// The hands, each where the client sends it.
    pub hands: Hands,
    /// The objects, in the scene's order.
    pub sights: &'a [Sight],
}

/// What a rule makes of it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Belief {
    /// W of each object, prior included; 0 for a disabled one.
    pub weights: Vec<f64>,
    /// The share of each object in the command position; sums to 1, or all 0 when nothing can be served.
    pub shares: Vec<f64>,
    /// Of "none of them", where a rule knows it; else 0.
    pub none: f64,
    /// The object that the rule is committed to.
    pub committed: Option<usize>,
}

/// An intention rule.
pub trait Rule: std::fmt::Debug + Send + Sync {
    /// Weigh the objects of one visitor; `belief` is reused from pose to pose. To weigh the same view again changes
    /// neither the rule nor the belief.
    fn weigh(&mut self, view: &View<'_>, belief: &mut Belief);

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
    /// The smallest angle from the view axis.
    Gaze,
    /// The nearest to where the head will be if it goes on as it does.
    ConstantVelocity,
    /// A recursive Bayesian filter over the objects and none of them.
    Bayes,
}

/// The numbers of the rules.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IntentionParameters {
    /// Of the paper's rule, in all its readings.
    pub paper: PaperParameters,
    /// Of the Bayesian filter.
    pub bayes: BayesParameters,
}

impl RuleName {
    /// Every rule.
    pub const ALL: [Self; 8] = [
        Self::Paper,
        Self::PaperLiteral,
        Self::PaperBest,
        Self::PaperHeld,
        Self::Nearest,
        Self::Gaze,
        Self::ConstantVelocity,
        Self::Bayes,
    ];

    /// Its name in configuration, tables and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::PaperLiteral => "paper-literal",
            Self::PaperBest => "paper-best",
            Self::PaperHeld => "paper-held",
            Self::Nearest => "nearest",
            Self::Gaze => "gaze",
            Self::ConstantVelocity => "constant-velocity",
            Self::Bayes => "bayes",
        }
    }

    /// The rule of this name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|rule| rule.name() == name)
    }

    /// Where the column stands by what this rule believes, unless something else is asked: the paper's rules name a mean.
    pub const fn standing(self) -> StandingName {
        match self {
            Self::Bayes => StandingName::InTime,
            _ => StandingName::Mean,
        }
    }

    /// A fresh rule for one visitor.
    pub fn rule(self, parameters: &IntentionParameters) -> Box<dyn Rule> {
        let paper = |commitment| Box::new(paper::Paper::new(commitment, parameters.paper));
        match self {
            Self::Paper => paper(paper::Commitment::Mean),
            Self::PaperLiteral => paper(paper::Commitment::Literal),
            Self::PaperBest => paper(paper::Commitment::Best),
            Self::PaperHeld => paper(paper::Commitment::Held),
            Self::Nearest => Box::new(nearest::Nearest),
            Self::Gaze => Box::new(gaze::Gaze),
            Self::ConstantVelocity => Box::new(velocity::ConstantVelocity),
            Self::Bayes => Box::new(bayes::Bayes::new(parameters.bayes)),
        }
    }
}

/// The objects as a head has them, into a reused buffer.
pub fn sights(scene: &Scene, priors: &[f64], enabled: &[bool], head: &Pose<Room>, out: &mut Vec<Sight>) {
    out.clear();
    let objects = scene.objects().iter().zip(&scene.spec().objects);
    out.extend(objects.zip(priors.iter().zip(enabled)).map(|((object, spec), (prior, enabled))| Sight {
        distance_m: object.distance_m(&head.position),
        angle_rad: object.angle_rad(head),
        offset: spec.position.floor() - head.position.floor(),
        rise_m: spec.position.z() - head.position.z(),
        prior: *prior,
        enabled: *enabled,
    }));
}

/// When a hand could be at an object, s from now: the way left at the pace kept, and a start if the visitor stands.
/// Medians of recorded reaches.
pub fn touch_secs(sight: &Sight, velocity: Planar) -> f64 {
    let closing = sight.offset.unit().map_or(0.0, |way| velocity.dot(way));
    let onset = STARTS_AFTER_SECS * (1.0 - closing / UNDER_WAY_MPS).clamp(0.0, 1.0);
    (sight.offset.norm() - ARM_M).max(0.0) / closing.max(PACE_MPS) + onset
}

/// The head is this far from an object, over the floor, when the hand is at it, m.
const ARM_M: f64 = 0.65;
/// A reach is no slower than this, m/s.
const PACE_MPS: f64 = 0.55;
/// Somebody who stands starts after so long, s.
const STARTS_AFTER_SECS: f64 = 1.2;
/// Somebody who comes nearer so fast is under way, m/s.
const UNDER_WAY_MPS: f64 = 0.2;

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
        self.weights.iter().sum::<f64>() + self.none
    }

    /// The object of the greatest weight, among equals the first of the scene; none without any weight.
    pub fn best(&self) -> Option<usize> {
        let best = (0..self.weights.len()).rev().max_by(|a, b| self.weights[*a].total_cmp(&self.weights[*b]));
        best.filter(|i| self.weights[*i] > 0.0)
    }

    /// Commit to the object of the greatest weight alone, among equals to the first of the scene; to none without any
    /// weight.
    fn commit_to_best(&mut self) {
        self.committed = self.best();
        let count = self.weights.len();
        let committed = self.committed;
        self.share_by(count, |i| if committed == Some(i) { 1.0 } else { 0.0 });
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
    use crate::frames::Point;
    use proptest::prelude::*;

    /// A head at (2, 2) that walks along +x.
    pub(super) fn view(at_millis: i64, sights: &[Sight]) -> View<'_> {
        let position = Point::new(2.0, 2.0, 1.6);
        View {
            taken_at: Time::from_micros(at_millis * 1000),
            head: Pose { position, orientation: nalgebra::UnitQuaternion::identity() },
            velocity: Planar::new(0.8, 0.0),
            hands: Hands::UNKNOWN,
            sights,
        }
    }

    /// An object this far away and this far off the view axis.
    pub(super) fn sight(distance_m: f64, angle_deg: f64, prior: f64) -> Sight {
        let angle_rad = f64::to_radians(angle_deg);
        let offset = Planar::new(distance_m, 0.0).turned(angle_rad);
        Sight { distance_m, angle_rad, offset, rise_m: 0.0, prior, enabled: true }
    }

    fn sights(count: usize) -> impl Strategy<Value = Vec<Sight>> {
        let sight = (0.0..3.0f64, 0.0..1.2f64, 0.0..1.0f64, prop::bool::weighted(0.9));
        let sight = sight.prop_map(|(distance_m, angle_rad, prior, enabled)| Sight {
            distance_m,
            angle_rad,
            offset: Planar::new(distance_m, 0.0).turned(angle_rad),
            rise_m: 0.0,
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
            let parameters = IntentionParameters::default();
            for name in RuleName::ALL {
                let (mut once, mut often) = (name.rule(&parameters), name.rule(&parameters));
                let (mut belief, mut of_often) = (Belief::default(), Belief::default());
                for (k, sights) in seen.iter().enumerate() {
                    let view = view(k as i64 * 13, sights);
                    once.weigh(&view, &mut belief);
                    for _ in 0..3 {
                        often.weigh(&view, &mut of_often);
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
