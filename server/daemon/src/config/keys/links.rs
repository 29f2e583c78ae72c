//! The keys of the link thresholds: each measure has where it is weak and, above that, where it is bad.

use covr_wire::dashboard::{LinkThresholds, Threshold};

use super::{Key, Place};
use crate::config::Config;

/// Every key of the section.
pub fn keys() -> Vec<Key> {
    let millis = 0.1..=10_000.0;
    vec![
        Key::new(
            "links.pose_age_weak_millis",
            "Age of a pose at its reception from which on dashboards show it as weak, ms. The links.* keys colour dashboards; the safety rules have limits of their own.",
            Place::Number(millis.clone(), |c| &mut c.links.pose_age_millis.weak),
        ),
        Key::new(
            "links.pose_age_bad_millis",
            "The same, as bad, ms; above weak.",
            Place::Number(millis.clone(), |c| &mut c.links.pose_age_millis.bad),
        ),
        Key::new(
            "links.jitter_weak_millis",
            "Jitter between poses (RFC 3550) that is shown as weak, ms.",
            Place::Number(millis.clone(), |c| &mut c.links.jitter_millis.weak),
        ),
        Key::new(
            "links.jitter_bad_millis",
            "The same, as bad, ms; above weak.",
            Place::Number(millis.clone(), |c| &mut c.links.jitter_millis.bad),
        ),
        Key::new(
            "links.loss_weak_percent",
            "Poses missing in their sequence that are shown as weak, percent.",
            Place::Number(0.01..=100.0, |c| &mut c.links.loss_percent.weak),
        ),
        Key::new(
            "links.loss_bad_percent",
            "The same, as bad, percent; above weak.",
            Place::Number(0.01..=100.0, |c| &mut c.links.loss_percent.bad),
        ),
        Key::new(
            "links.rtt_weak_millis",
            "Round trip to a client that is shown as weak, ms.",
            Place::Number(millis.clone(), |c| &mut c.links.rtt_millis.weak),
        ),
        Key::new(
            "links.rtt_bad_millis",
            "The same, as bad, ms; above weak.",
            Place::Number(millis, |c| &mut c.links.rtt_millis.bad),
        ),
        Key::new(
            "links.lateness_weak_micros",
            "Lateness of the control loop, its 99th percentile, that is shown as weak, us.",
            Place::Number(1.0..=1_000_000.0, |c| &mut c.links.lateness_micros.weak),
        ),
        Key::new(
            "links.lateness_bad_micros",
            "The same, as bad, us; above weak.",
            Place::Number(1.0..=1_000_000.0, |c| &mut c.links.lateness_micros.bad),
        ),
    ]
}

/// A measure that would be bad before it is weak: both keys and their values.
pub fn out_of_order(config: &Config) -> Option<[(&'static str, f64); 2]> {
    let LinkThresholds { pose_age_millis, jitter_millis, loss_percent, rtt_millis, lateness_micros } =
        config.links;
    [
        ("links.pose_age_weak_millis", "links.pose_age_bad_millis", pose_age_millis),
        ("links.jitter_weak_millis", "links.jitter_bad_millis", jitter_millis),
        ("links.loss_weak_percent", "links.loss_bad_percent", loss_percent),
        ("links.rtt_weak_millis", "links.rtt_bad_millis", rtt_millis),
        ("links.lateness_weak_micros", "links.lateness_bad_micros", lateness_micros),
    ]
    .into_iter()
    .find(|(_, _, Threshold { weak, bad })| weak >= bad)
    .map(|(weak_key, bad_key, Threshold { weak, bad })| [(weak_key, weak), (bad_key, bad)])
}
