//! What the control thread takes in: requests, facts about people, and each headset's newest pose.

use std::collections::BTreeMap;
use std::sync::mpsc::Receiver;

use covr_engine::observation::{Observation, PersonId, PoseSample};
use covr_engine::time::Time;
use covr_engine::{Answer, Engine, Request};
use tokio::sync::oneshot;

/// A request and where its answer goes.
pub struct Ask {
    pub request: Request,
    pub reply: oneshot::Sender<Answer>,
}

/// A fact about a person.
pub enum Fact {
    Seen(Observation),
    Headset(PersonId, triple_buffer::Output<Option<PoseSample>>),
}

/// The control thread's ends of the queues.
pub struct Inbox {
    pub asks: Receiver<Ask>,
    pub facts: Receiver<Fact>,
    headsets: BTreeMap<PersonId, triple_buffer::Output<Option<PoseSample>>>,
}

impl Inbox {
    pub fn new(asks: Receiver<Ask>, facts: Receiver<Fact>) -> Self {
        Self { asks, facts, headsets: BTreeMap::new() }
    }

    /// Tell the engine every waiting fact, then each headset's newest pose.
    pub fn tell(&mut self, engine: &mut Engine, now: Time) {
        for fact in self.facts.try_iter().take(MOST_PER_TICK) {
            match fact {
                Fact::Headset(person, output) => {
                    self.headsets.insert(person, output);
                }
                Fact::Seen(observation) => {
                    if let Observation::PersonLeft(person) = observation {
                        self.headsets.remove(&person);
                    }
                    engine.observe(now, observation);
                }
            }
        }
        for (person, slot) in &mut self.headsets {
            if slot.update()
                && let Some(pose) = *slot.output_buffer()
            {
                engine.observe(now, Observation::Pose(*person, pose));
            }
        }
    }

    /// Ask the engine every waiting request; the answers, to be sent once their effect is written and published.
    pub fn ask(
        &mut self,
        engine: &mut Engine,
        now: Time,
        answers: &mut Vec<(oneshot::Sender<Answer>, Answer)>,
    ) {
        for Ask { request, reply } in self.asks.try_iter().take(MOST_PER_TICK) {
            answers.push((reply, engine.request(now, request)));
        }
    }
}

/// A flood is spread over ticks rather than delaying one.
const MOST_PER_TICK: usize = 64;
