//! Somebody at the dashboard and somebody's hand: contacts are armed, taken back and run out; people take hold, sit down, are carried, let
//! go, step off, hold on and run.

use covr_engine::engine::Request;
use covr_engine::frames::{Floor, Planar};
use covr_engine::observation::{Observation, PersonId};
use covr_engine::scenario::{Course, Interaction, ScenarioSpec, StateSpec, Transition, Trigger};
use covr_engine::scene::SceneSpec;
use covr_engine::time::{Span, Time};

use crate::random::Random;
use crate::replay::{ClosedLoop, TrueHead};

/// The two of them.
pub struct Playmate {
    random: Random,
    next_act: Time,
    gathering: Option<Gathering>,
    hold: Option<Hold>,
}

/// Everybody makes room for the column at an object, so that it comes there.
#[derive(Debug, Clone, Copy)]
struct Gathering {
    object: usize,
    until: Time,
}

/// Somebody goes to an object, and takes hold of it there.
#[derive(Debug, Clone, Copy)]
struct Hold {
    person: PersonId,
    object: usize,
    holds: bool,
    /// Goes along with the column until then; after it the person does what people at their worst do, hand on it or not.
    goes_along_until: Time,
    lets_go_at: Time,
}

/// Where a person is drawn to.
#[derive(Debug, Clone, Copy)]
pub struct Lure {
    /// Who; none: everybody.
    pub person: Option<PersonId>,
    /// Where to.
    pub place: Floor,
}

impl Playmate {
    /// From `now` on.
    pub fn new(random: Random, now: Time) -> Self {
        Self { random, next_act: now, gathering: None, hold: None }
    }

    /// One control period, with the column truly here.
    pub fn step(&mut self, control: &mut ClosedLoop, heads: &[TrueHead], column: Floor) -> Option<Lure> {
        let now = control.now();
        let Some(hold) = self.hold else {
            if now >= self.next_act {
                self.next_act = now + Span::from_secs(self.random.between(0.05, 0.8));
                self.act(control, heads, column);
            }
            let place = control.engine().scene().objects().get(self.gathering?.object)?.column_place();
            return Some(Lure { person: None, place: farthest_corner(control, place) });
        };
        let head = heads.iter().find(|head| head.person == hold.person);
        let Some(head) = head.filter(|_| now < hold.lets_go_at) else {
            self.touch(control, hold, false);
            self.hold = None;
            return None;
        };
        let lure = lure(control, hold, head.pose.position.floor(), column)?;
        if !hold.holds && head.pose.position.floor().distance_m(lure.place) < ARRIVED_M {
            self.hold = Some(Hold { holds: true, ..hold });
            if self.random.chance(0.9) {
                let lasts = Span::from_secs(self.random.between(1.0, 30.0));
                control.request(Request::ArmContact(head.person, lasts));
            }
            self.touch(control, hold, true);
        }
        (now < hold.goes_along_until).then_some(lure)
    }

    fn act(&mut self, control: &mut ClosedLoop, heads: &[TrueHead], column: Floor) {
        let now = control.now();
        match self.random.below(40) {
            0 => drop(control.request(Request::DisarmContact)),
            1 => drop(control.request(Request::ConfirmFree)),
            2 => drop(control.request(Request::Cue("on".into()))),
            _ => {}
        }
        let scene = control.engine().scene();
        let objects = scene.objects().len();
        let in_place = scene.objects().iter().position(|o| o.column_place().distance_m(column) < IN_PLACE_M);
        let Some((object, head)) = in_place.zip(heads.get(self.random.below(heads.len().max(1)))) else {
            let gathering =
                self.gathering.filter(|gathering| now < gathering.until && gathering.object < objects);
            let gathers = gathering.is_none() && self.random.chance(0.3);
            self.gathering = gathering.or(gathers.then(|| Gathering {
                object: self.random.below(objects),
                until: now + Span::from_secs(self.random.between(3.0, 12.0)),
            }));
            if let Some(Gathering { object, .. }) = self.gathering {
                let alone = (0..objects).map(|of| (of, if of == object { 1.0 } else { 0.0 })).collect();
                control.request(Request::SetPriors(alone));
            }
            return;
        };
        self.gathering = None;
        let goes_along_until = now + Span::from_secs(self.random.between(2.0, 20.0));
        let lets_go_at = now + Span::from_secs(self.random.between(2.0, 20.0));
        self.hold = Some(Hold { person: head.person, object, holds: false, goes_along_until, lets_go_at });
    }

    fn touch(&self, control: &mut ClosedLoop, hold: Hold, began: bool) {
        let objects = &control.engine().scene().spec().objects;
        let Some(id) = objects.get(hold.object).map(|object| object.id.as_str().into()) else { return };
        control.observe(if began {
            Observation::TouchBegan(hold.person, id)
        } else {
            Observation::TouchEnded(hold.person, id)
        });
    }
}

/// On the seat of what carries, at arm's length of everything else.
fn lure(control: &ClosedLoop, hold: Hold, head: Floor, column: Floor) -> Option<Lure> {
    let scene = control.engine().scene();
    let spec = scene.spec();
    let prop = spec.objects.get(hold.object)?.prop;
    let offset = prop.map_or(Planar::ZERO, |prop| spec.props[prop].offset);
    let states = scene.scenario()?.states().iter();
    let mut here = states.filter_map(|state| state.interactions().get(hold.object)?.as_ref());
    let carries = here.any(|interaction| matches!(interaction, Interaction::Transport(_)));
    let seat = column + offset;
    let aside = (head - seat).unit().unwrap_or(Planar::new(1.0, 0.0)) * ARM_M;
    Some(Lure { person: Some(hold.person), place: if carries { seat } else { seat + aside } })
}

/// Where people are least in the way of a column that goes to this place.
fn farthest_corner(control: &ClosedLoop, place: Floor) -> Floor {
    let arena = control.engine().scene().spec().arena;
    let (a, b) = (arena.min, arena.max);
    let corners = [a, Floor::new(b.x, a.y), b, Floor::new(a.x, b.y)];
    let far = |corner: &Floor| corner.distance_m(place);
    corners.into_iter().max_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(b)
}

/// A scenario of two states, with interactions drawn for the objects of the first.
pub fn scenario(random: &mut Random, scene: &SceneSpec) -> ScenarioSpec {
    let ids: Vec<String> = scene.objects.iter().map(|object| object.id.clone()).collect();
    let interactions = ids.iter().filter_map(|id| Some((id.clone(), interaction(random, scene)?))).collect();
    let again = ids.iter().filter_map(|id| Some((id.clone(), interaction(random, scene)?))).collect();
    let way = |to: &str| Transition {
        on: vec![Trigger::Cue("on".into()), Trigger::InteractionDone(ids[0].clone())],
        when: None,
        to: Some(to.into()),
        acts: Vec::new(),
    };
    let state = |id: &str, interactions, to| StateSpec {
        id: id.into(),
        enabled: ids.clone(),
        priors: Vec::new(),
        interactions,
        entry: Vec::new(),
        transitions: vec![way(to)],
        is_final: false,
    };
    let states = vec![state("first", interactions, "second"), state("second", again, "first")];
    ScenarioSpec { initial: "first".into(), variables: Vec::new(), states, anywhere: Vec::new() }
}

fn interaction(random: &mut Random, scene: &SceneSpec) -> Option<Interaction> {
    let kind = random.below(9);
    let (a, b) = (scene.arena.min, scene.arena.max);
    let path = (0..3).map(|_| Floor::new(random.between(a.x, b.x), random.between(a.y, b.y))).collect();
    let course = Course { path, speed_mps: random.between(0.05, 0.6) };
    Some(match kind {
        0 => Interaction::Hold,
        1 => Interaction::StepBack { distance_m: random.between(0.05, 1.0) },
        2 | 3 => Interaction::Lead(course),
        4 | 5 => Interaction::Transport(course),
        6 | 7 => Interaction::Brush { speed_mps: random.between(0.05, 0.3), secs: random.between(0.0, 3.0) },
        _ => return None,
    })
}

/// Nearer than this somebody is where they are drawn to, m.
const ARRIVED_M: f64 = 0.15;
/// The column is in place, m.
const IN_PLACE_M: f64 = 0.1;
/// From the prop to who holds on to it, m.
const ARM_M: f64 = 0.6;
