//! The AsyncAPI document of both WebSockets: every variant of the wire's four message enums, with its schema from the type
//! itself and serialised values as examples. A new variant is in the document by being in the enum.

use covr_wire::client::{
    FromClient, JSON_SUBPROTOCOL, MAX_FRAME_BYTES, MOST_POSES_PER_SEC, MSGPACK_SUBPROTOCOL,
    OTHER_MESSAGES_PER_SEC, POSE_RATE_HZ, ToClient,
};
use covr_wire::dashboard::{FromDashboard, ToDashboard};
use covr_wire::examples;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::openapi::Document;
use crate::access::{Who, table};
use crate::config::Config;
use crate::ws::client::MOST_READ_BYTES;
use crate::ws::dashboard::MOST_MESSAGE_BYTES;

/// The document for a server of this configuration.
pub fn document(config: &Config) -> Document {
    let mut settings = SchemaSettings::draft07();
    settings.definitions_path = "/components/schemas".into();
    let mut schemas = settings.into_generator();
    let directions = [
        Direction::new::<FromClient>(&mut schemas, "client", &examples::from_client()),
        Direction::new::<ToClient>(&mut schemas, "client", &examples::to_client()),
        Direction::new::<FromDashboard>(&mut schemas, "dashboard", &examples::from_dashboard()),
        Direction::new::<ToDashboard>(&mut schemas, "dashboard", &examples::to_dashboard()),
    ];
    let mut schemas = schemas.take_definitions(true);
    let mut messages = Map::new();
    let mut channels = channels(config);
    let mut told = Vec::new();
    for direction in directions {
        let mut refs = Vec::new();
        for (name, message) in direction.messages(&mut schemas) {
            let id = format!("{}.{name}", direction.channel);
            messages.insert(id.clone(), message);
            channels[direction.channel]["messages"][&name] = reference(&["components", "messages", &id]);
            refs.push(reference(&["channels", direction.channel, "messages", &name]));
        }
        told.push(refs);
    }
    let [from_client, to_client, from_dashboard, to_dashboard] = &told[..] else { unreachable!("four") };
    json!({
        "asyncapi": "3.0.0",
        "info": {
            "title": "CoVR: WebSockets",
            "version": env!("CARGO_PKG_VERSION"),
            "description": ABOUT,
        },
        "defaultContentType": JSON,
        "servers": {
            "here": {
                "host": config.server.bind.to_string(),
                "protocol": if config.server.is_encrypted() { "wss" } else { "ws" },
                "protocolVersion": "13",
                "description": "This server, at the address that it was told to listen on. A browser's page must come from this server \
                    too, or from an origin that `clients.allowed_origins` names, else the upgrade is answered 403. Programs send no `Origin`.",
            },
        },
        "channels": channels,
        "operations": {
            "clientSays": operation("receive", "client", from_client, "What a VR client says",
                "`hello` first; a `clock_ping` alone may come before it. A refused message changes nothing and is answered by `error`."),
            "clientHears": operation("send", "client", to_client, "What a VR client hears",
                "After `welcome`: `column` with each published state, `prediction` about ten times a second while somebody is \
                 served, `stop` and `scene` as they change, `clock_pong` to each ping, `error` to what was refused."),
            "dashboardSays": with_reply(operation("receive", "dashboard", from_dashboard, "What a dashboard says",
                "Each is answered by one `answer` with its `request_id`; what cannot be understood is answered as refused.")),
            "dashboardHears": operation("send", "dashboard", to_dashboard, "What a dashboard hears",
                "`welcome`, `scene` and a `snapshot` at once; then whole snapshots (a slow reader skips some), every event, and answers."),
        },
        "components": { "messages": messages, "schemas": schemas },
    })
    .into()
}

/// All messages that go one way over one channel.
struct Direction {
    channel: &'static str,
    /// The enum's name among the schemas.
    name: String,
    examples: Vec<Value>,
}

impl Direction {
    fn new<M: JsonSchema + Serialize>(
        schemas: &mut SchemaGenerator,
        channel: &'static str,
        examples: &[M],
    ) -> Self {
        schemas.subschema_for::<M>();
        let examples = examples.iter().filter_map(|example| serde_json::to_value(example).ok()).collect();
        Self { channel, name: M::schema_name().into_owned(), examples }
    }

    /// Every message by its `type`; takes the enum itself out of the schemas, since nothing else speaks of it.
    fn messages(&self, schemas: &mut Map<String, Value>) -> Vec<(String, Value)> {
        let union = schemas.remove(&self.name).unwrap_or_default();
        let variants = union["oneOf"].as_array().cloned().unwrap_or_default();
        variants.into_iter().map(|payload| self.message(payload)).collect()
    }

    fn message(&self, payload: Value) -> (String, Value) {
        let name = payload["properties"]["type"]["const"].as_str().unwrap_or_default().to_owned();
        let words = payload["description"].as_str().unwrap_or_default().to_owned();
        let examples: Vec<Value> = self
            .examples
            .iter()
            .filter(|example| example["type"] == name.as_str())
            .enumerate()
            .map(|(index, example)| json!({ "name": format!("{name}-{}", index + 1), "payload": example }))
            .collect();
        let who = table::who_may(&format!("{} {name}", self.channel));
        let mut message = json!({
            "name": name,
            "title": name,
            "summary": words,
            "contentType": JSON,
            "payload": payload,
            "examples": examples,
        });
        // A dashboard's requests differ in who may: the channel's description has them.
        if let Some(Who::Roles(roles)) = who {
            message["x-covr-roles"] = roles.iter().map(|role| role.name()).collect();
        }
        (name, message)
    }
}

fn channels(config: &Config) -> Value {
    let persons = config.clients.persons_each;
    let rate = MOST_POSES_PER_SEC * persons as f64 + OTHER_MESSAGES_PER_SEC;
    let hello = config.clients.hello_timeout_secs;
    let silence = config.clients.silence_timeout_secs;
    let [least, most] = POSE_RATE_HZ;
    let refusals = |others: Value| {
        let mut all = vec![
            json!({ "status": 401, "when": "a token is shown that is not in force; on `/ws/v1/dashboard` also: none is shown, on a server that has tokens" }),
            json!({ "status": 403, "when": "the token's role may not connect here, the page comes from another site, or the host is not this machine" }),
            json!({ "status": 429, "when": "the address asks more often than `server.requests_per_sec`" }),
            json!({ "status": 503, "when": "as many are connected as the server takes" }),
        ];
        all.extend(others.as_array().cloned().unwrap_or_default());
        all
    };
    json!({
        "client": {
            "address": "/ws/v1/client",
            "title": "VR clients",
            "description": format!("{CLIENTS}\n\n### Rates and sizes\n\n\
                - Poses: {least} to {most} a second and person; at most {persons} persons a connection.\n\
                - Messages: {rate} a second on average; as many in a burst are warned of by `too_many_messages` and dropped, four seconds' worth closes.\n\
                - Refused messages: 10 in a burst, forgiven at 2 a second; at 50 the connection is closed.\n\
                - A frame is at most {MAX_FRAME_BYTES} bytes; longer ones are refused by `frame_too_large`, and from {MOST_READ_BYTES} bytes on end the connection.\n\
                - `hello` within {hello} s; something at least every {silence} s after it.\n\n\
                {CLIENT_ROLES}\n\n{CLIENT_CLOSES}"),
            "servers": [{ "$ref": "#/servers/here" }],
            "messages": {},
            "bindings": { "ws": {
                "method": "GET",
                "headers": { "type": "object", "properties": { "Sec-WebSocket-Protocol": {
                    "type": "string",
                    "enum": [JSON_SUBPROTOCOL, MSGPACK_SUBPROTOCOL],
                    "default": JSON_SUBPROTOCOL,
                    "description": "JSON text frames, or MessagePack binary frames of the same messages. The first offer that the server \
                        speaks is taken; without any offer it is JSON; offers of others alone are answered 400.",
                } } },
                "bindingVersion": "0.1.0",
            } },
            "x-content-types": { JSON_SUBPROTOCOL: JSON, MSGPACK_SUBPROTOCOL: "application/vnd.msgpack" },
            "x-close-codes": [
                { "code": 1000, "when": "the client has closed, or reads nothing" },
                { "code": 1001, "when": "the server shuts down; the reason says why" },
                { "code": 1008, "when": "after an `error` with `fatal`; the reason is its message. So when the token was taken back" },
            ],
            "x-upgrade-refusals": refusals(json!([{ "status": 400, "when": "no offered subprotocol is spoken here" }])),
        },
        "dashboard": {
            "address": "/ws/v1/dashboard",
            "title": "Dashboards",
            "description": format!("{DASHBOARDS}\n\n{DASHBOARD_ROLES}\n\nA message is at most {MOST_MESSAGE_BYTES} bytes; a longer one ends the connection.\n\n{DASHBOARD_CLOSES}"),
            "servers": [{ "$ref": "#/servers/here" }],
            "messages": {},
            "bindings": { "ws": { "method": "GET", "bindingVersion": "0.1.0" } },
            "x-content-types": { "": JSON },
            "x-close-codes": [
                { "code": 1001, "when": "the server shuts down; the reason says why" },
                { "code": 1008, "when": "the token was taken back, or its holder has signed out" },
                { "code": 1013, "when": "too many events behind; connect again and start from a whole snapshot" },
            ],
            "x-upgrade-refusals": refusals(json!([])),
        },
    })
}

fn operation(action: &str, channel: &str, messages: &[Value], title: &str, words: &str) -> Value {
    json!({
        "action": action,
        "channel": reference(&["channels", channel]),
        "title": title,
        "description": words,
        "messages": messages,
    })
}

fn with_reply(mut operation: Value) -> Value {
    let answer = reference(&["channels", "dashboard", "messages", "answer"]);
    operation["reply"] = json!({ "channel": operation["channel"], "messages": [answer] });
    operation
}

fn reference(path: &[&str]) -> Value {
    json!({ "$ref": format!("#/{}", path.join("/")) })
}

const JSON: &str = "application/json";

const ABOUT: &str = "\
Control server for room-scale encountered-type haptic robots: a gantry carries a column with real props through a VR arena.

HTTP is described apart, by OpenAPI: `/api/v1/openapi.json`.

VR clients send where heads are and hear where the column is; dashboards show the whole state and may ask of the machine.
Every message is an object with a `type`; a field that a message does not have is refused by its name.

**Time** is whole microseconds (`_micros`): `client_time_micros` on the client's clock, every other on the server's, from its start.
**The room frame** is right-handed, in metres, +z up, its origin on the floor under the home corner, +x along the long rail. Dashboards
see everything in it; VR clients see the scene's document in it, and everything else in the convention of their `hello`.
**Units** are SI and at the end of a name (`_m`, `_mps`, `_rad`, `_secs`); what has none is in the client's own.";

const CLIENTS: &str = "\
One connection speaks for one or a few persons with headsets. It says `hello`, `enter` for each person, then poses; `leave` when
somebody takes the headset off for good. If it is lost, its persons stay in the arena and the column stops until they are back or a
game master says that they have left.

### Conventions

| `convention` | handedness | up, forward | unit |
|---|---|---|---|
| `openxr` (WebXR), `godot`, `steamvr` | right | +Y, -Z | m |
| `unity` | left | +Y, +Z | m |
| `unreal` | left | +Z, +X | cm |
| `ros` | right | +Z, +X | m |

An orientation is a unit quaternion x, y, z, w; the identity looks along the convention's forward axis.

### Clock

Send a `clock_ping` every second or two. The answer, `clock_pong`, has the server's times of receiving and sending. The next ping says in
`previous` when that pong came: so the server knows all four times of an exchange, and with them the age of each pose. Until the
first exchange has closed, 20 ms are added to every age. The older a pose, the farther the column keeps away; `max_pose_age_secs` of
the `welcome` is where it stops.";

const CLIENT_ROLES: &str = "\
### Tokens

Where the server has tokens, a VR client needs one of role `client` (or `game_master`, `administrator`): as `token` of its `hello`, which every
engine and every page can do, or as `Authorization: Bearer` of the upgrade, or by a one-time `?ticket=` of `POST /api/v1/tickets`. Without one the `hello` is answered by `unauthorized`.
A visit is not cut off when the token ends by itself; it is when the token is taken back.";

const DASHBOARD_ROLES: &str = "\
### Roles

Where the server has tokens, the upgrade needs one as `Authorization: Bearer`, the cookie of a page that is signed in, or a one-time `?ticket=` of
`POST /api/v1/tickets`. `observer`, `designer`, `game_master` and `administrator` may look on, and
each of them may `stop`, also when the token has ended meanwhile. Every `request` is for `game_master` and `administrator`: to others it is
answered as refused.";

const CLIENT_CLOSES: &str = "\
### Errors and close codes

An `error` names the field, what was found, what was expected. With `fatal` the connection is closed after it: 1008. When the server shuts down:
1001, with why.";

const DASHBOARDS: &str = "\
JSON text frames, no subprotocol. State is always whole: nothing is ever patched, and whoever connects again starts from a whole snapshot.
`stop` waits for nothing that was sent before it; its answer says how long it took to the drive. The same stop is `POST /api/v1/stop`.";

const DASHBOARD_CLOSES: &str = "\
### Errors and close codes

What is not understood is answered by an `answer` that is refused, with `request_id` 0 where it had none. Who falls behind with events is closed
with 1013; when the server shuts down: 1001, with why.";
