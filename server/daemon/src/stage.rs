//! The active scene and its priors: one change at a time, the engine first, then the store, then everybody.

use std::collections::BTreeMap;
use std::sync::Arc;

use covr_engine::reason::Reason;
use covr_engine::scene::Scene;
use covr_engine::{Answer, Outcome, Request};
use covr_wire::scene::{SceneDocument, SceneError, build_scene};
use tokio::sync::{Mutex, watch};

use crate::clock::wall_now;
use crate::control::{Control, NotDelivered};
use crate::store::{PriorChange, SceneVersion, Store, StoreError};

/// The scene that is played.
#[derive(Debug)]
pub struct ActiveScene {
    /// The store's number.
    pub id: i64,
    /// Its version.
    pub version: i64,
    /// As its author wrote it.
    pub document: SceneDocument,
    /// As the engine has it.
    pub scene: Arc<Scene>,
}

/// The active scene, and who may change it when.
#[derive(Debug)]
pub struct Stage {
    active: watch::Sender<Arc<ActiveScene>>,
    /// Priors in force in the order of the objects; held while anything changes.
    priors: Mutex<Vec<f64>>,
}

/// Why priors were not changed.
#[derive(Debug, thiserror::Error)]
pub enum PriorsRefused {
    /// Some are not objects of the scene, or no priors.
    #[error("{} of the priors cannot be set", .0.len())]
    Invalid(Vec<BadPrior>),
    /// The engine refused.
    #[error("the engine refused: {0:?}")]
    Refused(Reason),
    /// The engine was not reached.
    #[error(transparent)]
    NotDelivered(#[from] NotDelivered),
    /// In force, but not stored.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// One prior that cannot be set.
#[derive(Debug, Clone, PartialEq)]
pub struct BadPrior {
    /// As it was named.
    pub object: String,
    /// What was found.
    pub found: String,
    /// What was expected.
    pub expected: String,
}

/// Why a scene was not activated.
#[derive(Debug, thiserror::Error)]
pub enum ActivationRefused {
    /// The document is not a scene any more.
    #[error("the stored scene does not pass today's checks")]
    Invalid(Vec<SceneError>),
    /// The engine refused.
    #[error("the engine refused: {0:?}")]
    Refused(Reason),
    /// The engine was not reached.
    #[error(transparent)]
    NotDelivered(#[from] NotDelivered),
    /// In force, but not stored.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// Priors by object index, as a game master wrote them by object id; else all that cannot be set.
pub fn read_priors(
    wanted: &BTreeMap<String, serde_json::Value>,
    index_of: impl Fn(&str) -> Option<usize>,
) -> Result<Vec<(usize, f64)>, Vec<BadPrior>> {
    let mut bad = Vec::new();
    let mut priors = Vec::new();
    for (object, value) in wanted {
        let refuse = |expected: &str| BadPrior {
            object: object.clone(),
            found: value.to_string(),
            expected: expected.into(),
        };
        match (index_of(object), value.as_f64()) {
            (None, _) => bad.push(refuse("an object of the active scene")),
            (Some(index), Some(prior)) if (0.0..=1.0).contains(&prior) => priors.push((index, prior)),
            (Some(_), _) => bad.push(refuse("a number from 0 to 1")),
        }
    }
    if bad.is_empty() { Ok(priors) } else { Err(bad) }
}

impl ActiveScene {
    /// A stored version, built.
    pub fn build(stored: SceneVersion) -> Result<Self, Vec<SceneError>> {
        let scene = Arc::new(build_scene(&stored.document)?);
        Ok(Self { id: stored.id, version: stored.version, document: stored.document, scene })
    }

    /// Id and version.
    pub fn key(&self) -> (i64, i64) {
        (self.id, self.version)
    }

    fn document_priors(&self) -> Vec<f64> {
        self.document.objects.iter().map(|object| object.prior).collect()
    }

    fn index_of(&self, object: &str) -> Option<usize> {
        self.document.objects.iter().position(|known| known.id == object)
    }
}

impl Stage {
    /// With the scene that is active at start, its priors as in the document.
    pub fn new(active: ActiveScene) -> Self {
        let priors = Mutex::new(active.document_priors());
        Self { active: watch::Sender::new(Arc::new(active)), priors }
    }

    /// The active scene.
    pub fn active(&self) -> Arc<ActiveScene> {
        self.active.borrow().clone()
    }

    /// To wait for another.
    pub fn watch(&self) -> watch::Receiver<Arc<ActiveScene>> {
        self.active.subscribe()
    }

    /// Put the priors of the last run in force again.
    pub async fn restore_priors(
        &self,
        control: &Control,
        stored: &[(String, f64)],
    ) -> Result<(), NotDelivered> {
        let mut priors = self.priors.lock().await;
        let active = self.active();
        if active.scene.scenario().is_some() {
            // They were set against a state of a run that is over.
            return Ok(());
        }
        let known: Vec<(usize, f64)> =
            stored.iter().filter_map(|(object, prior)| Some((active.index_of(object)?, *prior))).collect();
        if known.is_empty() {
            return Ok(());
        }
        let answer = control.ask(Request::SetPriors(known.clone())).await?;
        if answer.outcome != Outcome::Refused {
            for (index, prior) in known {
                priors[index] = prior;
            }
        }
        Ok(())
    }

    /// Change priors, all or none; what changed.
    pub async fn change_priors(
        &self,
        control: &Control,
        store: &Store,
        author: &str,
        wanted: &BTreeMap<String, serde_json::Value>,
    ) -> Result<Vec<PriorChange>, PriorsRefused> {
        let mut priors = self.priors.lock().await;
        let active = self.active();
        let to_set = read_priors(wanted, |object| active.index_of(object)).map_err(PriorsRefused::Invalid)?;
        if active.scene.scenario().is_some() {
            // The scenario changes them too; what was answered last is published.
            let published = control.published();
            if Arc::ptr_eq(&published.scene, &active.scene) {
                *priors = published.outlook.priors().to_vec();
            }
        }
        let Answer { outcome, reason } = control.ask(Request::SetPriors(to_set.clone())).await?;
        if outcome == Outcome::Refused {
            return Err(PriorsRefused::Refused(reason));
        }
        let mut changes = Vec::new();
        for (index, to) in to_set {
            let from = std::mem::replace(&mut priors[index], to);
            if from != to {
                let object = active.document.objects[index].id.clone();
                changes.push(PriorChange { object, from, to });
            }
        }
        store.add_prior_changes(&wall_now(), author, active.key(), &changes).await?;
        Ok(changes)
    }

    /// Play another scene, or another version.
    pub async fn activate(
        &self,
        control: &Control,
        store: &Store,
        stored: SceneVersion,
    ) -> Result<Answer, ActivationRefused> {
        let next = ActiveScene::build(stored).map_err(ActivationRefused::Invalid)?;
        let mut priors = self.priors.lock().await;
        let answer = control.ask(Request::ActivateScene(next.scene.clone())).await?;
        if answer.outcome == Outcome::Refused {
            return Err(ActivationRefused::Refused(answer.reason));
        }
        *priors = next.document_priors();
        let key = next.key();
        self.active.send_replace(Arc::new(next));
        store.set_active_scene(key.0, key.1).await?;
        Ok(answer)
    }
}
