//! The configuration in force.

use std::sync::Arc;

use axum::Json;
use axum::extract::State;
use covr_wire::records::{Built, ConfigInForce, ConfigKey};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::config::{self, Config};

/// The routes.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new().routes(routes!(configuration))
}

/// Every configuration key with its value, its default, its meaning, what it accepts and who set it; and what the server was
/// built of. No key is a secret.
#[utoipa::path(get, path = "/config", tag = "config",
    responses((status = 200, description = "The configuration in force", body = ref("#/components/schemas/ConfigInForce"),
        example = json!({"version": "0.1.0", "built": {"profile": "release", "target": "x86_64-unknown-linux-gnu",
        "rustc": "rustc 1.95.0", "commit": null}, "file": "/etc/covr/covr.toml", "keys": [{"name": "control.rate_hz",
        "value": 250.0, "default": 250.0, "meaning": "Rate of the control loop, Hz.",
        "accepts": "a number from 50 to 1000", "takes": {"kind": "number", "least": 50.0, "most": 1000.0}, "from": "default"}]}))))]
async fn configuration(State(app): State<Arc<App>>) -> Json<ConfigInForce> {
    let default = Config::default();
    let keys = config::keys().into_iter().map(|key| ConfigKey {
        name: key.name.into(),
        value: as_json(key.value(&app.config)),
        default: as_json(key.value(&default)),
        meaning: key.meaning.into(),
        from: app.origins.of(key.name),
        accepts: key.accepts.to_string(),
        takes: key.accepts,
    });
    Json(ConfigInForce {
        version: env!("CARGO_PKG_VERSION").into(),
        built: Built {
            profile: if cfg!(debug_assertions) { "debug" } else { "release" }.into(),
            target: env!("COVR_TARGET").into(),
            rustc: env!("COVR_RUSTC").into(),
            commit: option_env!("COVR_COMMIT").map(Into::into),
        },
        file: app.origins.file().map(|path| path.display().to_string()),
        keys: keys.collect(),
    })
}

/// The kinds of value that a key has: numbers, switches, texts and lists of numbers.
fn as_json(value: toml::Value) -> serde_json::Value {
    match value {
        toml::Value::String(text) => text.into(),
        toml::Value::Integer(number) => number.into(),
        toml::Value::Float(number) => number.into(),
        toml::Value::Boolean(switch) => switch.into(),
        toml::Value::Array(values) => values.into_iter().map(as_json).collect(),
        other => other.to_string().into(),
    }
}
