//! The whole loop on virtual time: engine, machine, the link that brings poses, and the checkers of both motions.
//!
//! Everything happens in one order, decided by seeds and inputs alone, so that two runs are the same bit for bit.
//! Time moves when [`ClosedLoop::step`] is called and never otherwise.

mod belief;
mod foretold;
mod headset;
mod link;
mod session;
mod trial;
mod walk;
mod watch;

use std::sync::Arc;

use covr_engine::engine::{Answer, Engine, EngineConfig, Outcome, Request};
use covr_engine::event::Event;
use covr_engine::frames::{Pose, Room};
use covr_engine::machine::{Homing, Limits, MachineReport, Travel};
use covr_engine::mode::{Mode, RequestKind};
use covr_engine::observation::{Observation, PersonId, PoseSample};
use covr_engine::safety::contact::{Contact, ContactKind as Kind};
use covr_engine::safety::vetted::{Action, Vetted};
use covr_engine::scene::{Scene, SceneSpec};
use covr_engine::time::{Span, Time};
use covr_gantry::contract::{Simulated, Truth};
use covr_gantry::sim::faults::Faults;

use crate::checker::{
    Checker, ContactKind, ContactNow, Moment, Motion, PersonNow, Rectangle, Rules, Track, Verdict,
};
use crate::random::Random;
pub use belief::{BeliefThen, BeliefTold, LOOKS_BEFORE_REACH_SECS};
pub use foretold::FORETOLD_BEFORE_REACH_SECS;
pub use link::{LinkProfile, PoseLink};
pub use session::{SessionReplay, VisitPlan};
pub use trial::{Conduct, Glimpse, ReachTrial, TrialOutcome, TrialProblem, WithOffset};
pub use walk::{Pace, TrackingNoise, Walk};

/// Engine, machine, link and checkers, stepping together.
pub struct ClosedLoop {
    engine: Engine,
    machine: Box<dyn Simulated>,
    link: PoseLink,
    checkers: [Checker; 2],
    now: Time,
    persons: Vec<PersonNow>,
    /// Which objects a head counts as near to.
    near: Vec<bool>,
    missed: bool,
}

/// A person's head as it really is now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrueHead {
    /// Who.
    pub person: PersonId,
    /// Where the head is.
    pub pose: Pose<Room>,
}

/// What one step did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stepped {
    /// When.
    pub at: Time,
    /// What the machine said before it.
    pub report: MachineReport,
    /// What the machine is told.
    pub command: Vetted,
    /// The column as it really was when the step began.
    pub truth: Truth,
}

impl ClosedLoop {
    /// A loop about a machine, at `start` on its clock. The configuration's limits and travel are the machine's.
    pub fn new(
        config: EngineConfig,
        scene: Arc<Scene>,
        machine: Box<dyn Simulated>,
        profile: LinkProfile,
        random: Random,
        start: Time,
    ) -> Self {
        let mut rules = rules_of(config.limits, config.travel, scene.spec());
        rules.v_h_mps = config.v_h_mps;
        let checkers = [Checker::new(rules.clone(), Track::True), Checker::new(rules, Track::Commanded)];
        let engine = Engine::new(config, scene);
        Self {
            engine,
            machine,
            link: PoseLink::new(profile, random),
            checkers,
            now: start,
            persons: Vec::new(),
            near: Vec::new(),
            missed: false,
        }
    }

    /// What is wrong with the machine from now on; an ideal one knows no faults.
    pub fn set_faults(&mut self, faults: Faults) {
        self.machine.set_faults(faults);
    }

    /// Ask the engine.
    pub fn request(&mut self, request: Request) -> Answer {
        let activated = match &request {
            Request::ActivateScene(scene) => Some(Arc::clone(scene)),
            _ => None,
        };
        let answer = self.engine.request(self.now, request);
        if let Some(scene) = activated.filter(|_| answer.outcome == Outcome::Accepted) {
            self.near.clear();
            let rules = rules_of(self.engine.config().limits, self.engine.config().travel, scene.spec());
            for checker in &mut self.checkers {
                checker.change_shapes(rules.footprint.clone(), rules.keep_outs.clone());
            }
        }
        answer
    }

    /// Tell the engine something at once, past the link.
    pub fn observe(&mut self, observation: Observation) {
        self.engine.observe(self.now, observation);
    }

    /// A headset sends a pose; the link brings it, later or never.
    pub fn send(&mut self, person: PersonId, sample: PoseSample) {
        self.link.send(self.now, person, sample);
    }

    /// One control period, with these people really there.
    pub fn step(&mut self, heads: &[TrueHead]) -> Stepped {
        let at = self.now;
        for (person, sample) in self.link.due(at) {
            self.engine.observe(at, Observation::Pose(person, sample));
        }
        let report = self.machine.read(at).report;
        self.engine.observe(at, Observation::Machine(report));
        let deadline = if self.missed { Observation::DeadlineMissed } else { Observation::DeadlineMet };
        self.missed = false;
        self.engine.observe(at, deadline);
        let command = self.engine.step(at);
        // A command that the machine does not take is the machine's to report; its dead-man brakes.
        let taken = self.machine.write(at, &command).is_ok();
        let stepped = Stepped { at, report, command, truth: self.machine.truth() };
        // What is not taken is braked for.
        let told = if taken { command.action() } else { Action::Hold };
        self.check(&stepped.report, stepped.truth, Some(told), heads);
        self.now += self.engine.config().period;
        stepped
    }

    /// One control period in which the control thread does not get its turn: the machine goes by what it was told last.
    pub fn miss_step(&mut self, heads: &[TrueHead]) -> Truth {
        let report = self.machine.read(self.now).report;
        let truth = self.machine.truth();
        self.check(&report, truth, None, heads);
        self.missed = true;
        self.now += self.engine.config().period;
        truth
    }

    /// Home and arm, with nobody there; or the mode in which it stuck.
    pub fn bring_up(&mut self, within: Span) -> Result<(), Mode> {
        let until = self.now + within;
        self.request(Request::Machine(RequestKind::Home, None));
        while self.engine.mode() != Mode::Ready {
            if self.now > until {
                return Err(self.engine.mode());
            }
            self.step(&[]);
        }
        self.arm()
    }

    /// Arm a homed machine.
    pub fn arm(&mut self) -> Result<(), Mode> {
        let answer = self.request(Request::Machine(RequestKind::Arm, None));
        if answer.outcome == Outcome::Refused { Err(self.engine.mode()) } else { Ok(()) }
    }

    /// Armed `ago` before now, with nobody there, on a machine that is homed and has stood still since; or the mode in
    /// which it stuck. The steps between are not taken: all that they would do is to hold the machine where it stands,
    /// and let the soft start after arming go by.
    pub fn armed_standing(&mut self, ago: Span) -> Result<(), Mode> {
        let armed_at = self.now - ago;
        let report = MachineReport { answered_at: armed_at, ..self.machine.read(self.now).report };
        self.engine.observe(armed_at, Observation::Machine(report));
        let answer = self.engine.request(armed_at, Request::Machine(RequestKind::Arm, None));
        if answer.outcome == Outcome::Refused { Err(self.engine.mode()) } else { Ok(()) }
    }

    /// What happened since the last call, oldest first.
    pub fn drain_events(&mut self) -> std::vec::Drain<'_, Event> {
        self.engine.drain_events()
    }

    /// The engine, to look at.
    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    /// When the next step will be.
    pub fn now(&self) -> Time {
        self.now
    }

    /// What the checkers found of the true motion.
    pub fn true_verdict(&self) -> &Verdict {
        self.checkers[0].verdict()
    }

    /// What the checkers found of the commanded motion.
    pub fn commanded_verdict(&self) -> &Verdict {
        self.checkers[1].verdict()
    }

    /// What the checkers found of the true and of the commanded motion; they count anew from now on.
    pub fn take_verdicts(&mut self) -> [Verdict; 2] {
        self.checkers.each_mut().map(Checker::take_verdict)
    }

    /// `told`: what the machine goes by from now on; none when it was told nothing in this period.
    fn check(&mut self, report: &MachineReport, truth: Truth, told: Option<Action>, heads: &[TrueHead]) {
        let scene = self.engine.scene();
        // What a scenario switches off while the column moves keeps its near zone until it rests.
        let rests = truth.velocity.norm() < RESTS_MPS
            && !matches!(told, Some(Action::Track(setpoint)) if setpoint.velocity.norm() >= RESTS_MPS);
        self.near.resize(self.engine.enabled().len(), false);
        for (near, enabled) in self.near.iter_mut().zip(self.engine.enabled()) {
            *near = *enabled || *near && !rests;
        }
        let contact =
            self.engine.contact().map(|contact| (contact.person, contact_now(&contact, scene.spec())));
        self.persons.clear();
        self.persons.extend(heads.iter().map(|head| {
            let nearest_m = scene.nearest_object_m(&head.pose.position, &self.near);
            PersonNow {
                id: head.person,
                head: head.pose.position.floor(),
                height_m: head.pose.position.z(),
                to_enabled_object_m: nearest_m.is_finite().then_some(nearest_m),
                contact: contact.filter(|(person, _)| *person == head.person).map(|(_, contact)| contact),
            }
        }));
        let truly = Motion { position: truth.position, velocity: truth.velocity };
        let (commanded, follows_setpoints) = match told {
            Some(Action::Track(setpoint)) => {
                (Motion { position: setpoint.position, velocity: setpoint.velocity }, true)
            }
            _ => (truly, false),
        };
        let moment = Moment {
            at: self.now,
            column: truly,
            follows_setpoints,
            homed: report.homing == Homing::Homed,
            latched: matches!(self.engine.mode(), Mode::LatchedStop | Mode::Faulted),
            persons: &self.persons,
        };
        let [of_truth, of_commands] = &mut self.checkers;
        of_truth.check(&moment);
        if told.is_some() {
            of_commands.check(&Moment { column: commanded, ..moment });
        }
    }
}

/// Slower than this the column rests, m/s.
const RESTS_MPS: f64 = 0.01;

/// A contact as the checker is told of it.
fn contact_now(contact: &Contact, scene: &SceneSpec) -> ContactNow {
    let takes_floor = |prop: &usize| scene.props[*prop].size_m.norm() > 0.0;
    let before = |prop: usize| (0..prop).filter(takes_floor).count();
    ContactNow {
        kind: match contact.kind {
            Kind::Lead => ContactKind::Lead,
            Kind::Transport => ContactKind::Transport,
            Kind::Brush => ContactKind::Brush,
        },
        rectangle: contact.prop.filter(takes_floor).map(|prop| 1 + before(prop)),
        offset: contact.offset,
    }
}

/// The rules of the checker for a machine and a scene, taken from the scene's description alone.
pub fn rules_of(limits: Limits, travel: Travel, scene: &SceneSpec) -> Rules {
    let carriage = Rectangle { offset: Default::default(), size_m: scene.column_size_m };
    let props = scene.props.iter().filter(|prop| prop.size_m.norm() > 0.0);
    let footprint = std::iter::once(carriage)
        .chain(props.map(|prop| Rectangle { offset: prop.offset, size_m: prop.size_m }))
        .collect();
    let keep_outs = scene.keep_outs.iter().map(|keep_out| keep_out.shape.clone()).collect();
    Rules::of(limits, travel, footprint, keep_outs)
}
