//! What all operations have in common, added to the document in one place: what the layers around the handlers answer, who
//! asks, names that are unique, and an example of every body, serialised from the types themselves.

use covr_wire::reason::Reason;
use serde_json::{Map, Value, json};

use super::super::STOP_PATH;
use super::super::access::LOGIN_COOKIE;
use super::super::problem::{PROBLEM_JSON, Problem};
use super::samples;
use crate::access::{Who, table};

/// Complete a document that has the handlers' own words.
pub fn complete(document: &mut Value) {
    let schemas = document["components"]["schemas"].clone();
    if let Some(paths) = document["paths"].as_object_mut() {
        paths.extend(by_hand());
        for (path, item) in paths {
            for method in METHODS {
                if let Some(operation) = item.get_mut(method) {
                    Operation { path, method, schemas: &schemas }.complete(operation);
                }
            }
        }
    }
    // The generator fills it from an empty package field; no licence is chosen yet.
    if let Some(info) = document["info"].as_object_mut() {
        info.remove("license");
    }
    document["components"]["securitySchemes"] = json!({
        "token": {
            "type": "http",
            "scheme": "bearer",
            "bearerFormat": "covr_<id>_<secret>",
            "description": "A token that `covr token create` made. A server without any token asks nobody.",
        },
        "login": {
            "type": "apiKey",
            "in": "cookie",
            "name": LOGIN_COOKIE,
            "description": "Set by `POST /api/v1/login`; no script can read it.",
        },
        "csrf": {
            "type": "apiKey",
            "in": "header",
            "name": "X-Covr-Csrf",
            "description": "With the cookie, for everything that is no GET: `csrf` of `GET /api/v1/me`.",
        },
    });
    document["components"]["parameters"]["Author"] = json!({
        "name": "X-Covr-Author",
        "in": "header",
        "required": false,
        "description": "Who asks, for the record: 1 to 64 printable characters, percent-encoded where they are not plain ASCII. \
            `anonymous` when not given.",
        "schema": { "type": "string", "minLength": 1 },
        "example": "J%C3%BCrgen",
    });
}

/// Routes that have no handler of the documented kind.
fn by_hand() -> Map<String, Value> {
    let document = |what: &str| {
        json!({ "get": {
            "tags": ["contract"],
            "summary": what,
            "responses": { "200": {
                "description": "The document",
                "content": { "application/json": { "schema": { "type": "object" } } },
            } },
        } })
    };
    let socket = |what: &str, refused: &str| {
        json!({ "get": {
            "tags": ["contract"],
            "summary": what,
            "description": "A WebSocket; its messages are described at `/api/v1/asyncapi.json`.",
            "parameters": [{
                "name": "ticket",
                "in": "query",
                "required": false,
                "description": "From `POST /api/v1/tickets`, for those who can send no header and no cookie. Good once, for 30 s.",
                "schema": { "type": "string" },
            }],
            "responses": {
                "101": { "description": "The connection is a WebSocket now" },
                "400": { "description": refused },
                "503": { "description": "As many are connected as the server takes" },
            },
        } })
    };
    let paths = [
        ("/api/v1/openapi.json", document("This document.")),
        ("/api/v1/asyncapi.json", document("The WebSockets, as AsyncAPI 3.0.")),
        (
            "/ws/v1/client",
            socket("VR clients.", "No upgrade, or none of the offered subprotocols is spoken here"),
        ),
        ("/ws/v1/dashboard", socket("Dashboards.", "No upgrade")),
    ];
    paths.into_iter().map(|(path, item)| (path.to_owned(), item)).collect()
}

struct Operation<'a> {
    path: &'a str,
    method: &'a str,
    schemas: &'a Value,
}

impl Operation<'_> {
    fn complete(&self, operation: &mut Value) {
        operation["operationId"] = self.id().into();
        if self.takes_author() {
            let author = json!({ "$ref": "#/components/parameters/Author" });
            match operation["parameters"].as_array_mut() {
                Some(parameters) => parameters.push(author),
                None => operation["parameters"] = json!([author]),
            }
        }
        self.add_roles(operation);
        for (status, words) in self.around(operation) {
            let answers = &mut operation["responses"];
            if answers.get(status).is_none() {
                answers[status] = json!({
                    "description": words,
                    "content": { PROBLEM_JSON: { "schema": { "$ref": PROBLEM_SCHEMA } } },
                });
            }
        }
        if let Some(body) = operation.get_mut("requestBody") {
            body["required"] = (body["description"] != MAY_BE_EMPTY).into();
            self.add_examples(&mut body["content"], None);
        }
        if let Some(answers) = operation["responses"].as_object_mut() {
            for (status, answer) in answers {
                if answer.get("description").is_none_or(|words| words == "") {
                    answer["description"] = self.what_it_is(answer).into();
                }
                let words = answer["description"].as_str().unwrap_or_default().to_owned();
                if let Some(content) = answer.get_mut("content") {
                    self.add_examples(content, status.parse().ok().map(|status| (status, words)));
                }
            }
        }
    }

    /// `get_scenes_id_versions`: method and path, so it is unique and stays while they do.
    fn id(&self) -> String {
        let path = self.path.trim_start_matches("/api/v1").trim_start_matches('/');
        let words = path.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
        std::iter::once(self.method).chain(words).collect::<Vec<_>>().join("_")
    }

    /// Whatever changes something says who did it.
    fn takes_author(&self) -> bool {
        self.method != "get" && !READ_ONLY.contains(&self.path)
    }

    /// Who may ask: what the table says, for people and for programs.
    fn add_roles(&self, operation: &mut Value) {
        match self.who() {
            Some(Who::Roles(roles)) => {
                operation["security"] = json!([{ "token": [] }, { "login": [], "csrf": [] }]);
                operation["x-covr-roles"] = roles.iter().map(|role| role.name()).collect();
            }
            Some(Who::Anybody) | None => operation["security"] = json!([]),
        }
    }

    fn who(&self) -> Option<Who> {
        table::who_may(&format!("{} {}", self.method.to_uppercase(), self.path))
    }

    /// What the layers and extractors answer.
    fn around(&self, operation: &Value) -> Vec<(&'static str, &'static str)> {
        let is_stop = self.path == STOP_PATH;
        let in_api = self.path.starts_with("/api/");
        let mut answers = Vec::new();
        if !is_stop {
            answers.push((
                "403",
                "Not for this role, from a page of another site, or by a host name that is not this machine",
            ));
        }
        if self.path == "/ws/v1/client" {
            answers.push(("401", "With a token or a ticket that is not in force"));
        } else if let Some(Who::Roles(_)) = self.who() {
            answers.push(("401", "Without a token that is in force, on a server that has tokens"));
            answers.push(("503", "The database did not answer, which was asked about a token that is new"));
        }
        if !is_stop {
            answers.push(("429", "This address asks more often than `server.requests_per_sec`, or has shown many tokens that are not known; `Retry-After` says when to go on"));
        }
        if in_api {
            answers.push(("408", "It took longer than `server.request_timeout_secs`"));
            answers.push(("500", "The server failed; its log says why"));
        }
        if operation.get("requestBody").is_some() && !is_stop {
            answers.push(("400", "Not JSON, or not the fields that are due"));
            answers.push(("413", "The body is larger than 4 MiB"));
        }
        if in_api
            && operation["parameters"]
                .as_array()
                .is_some_and(|all| all.iter().any(|one| one["in"] == "query"))
        {
            answers.push(("400", "A query parameter is not of its type"));
        }
        if self.takes_author() && !is_stop {
            answers.push(("422", "The author is not 1 to 64 printable characters"));
        }
        let stored = ["scenes", "priors", "record"].iter().any(|tag| operation["tags"][0] == *tag);
        if stored && !["/api/v1/scenes/check", "/api/v1/scene.schema.json"].contains(&self.path) {
            answers.push(("503", "The database or the control loop did not answer"));
        }
        answers
    }

    /// Problems go under their own media type; every body gets an example that it does not have yet.
    fn add_examples(&self, content: &mut Value, answer: Option<(u16, String)>) {
        let is_problem = content["application/json"]["schema"]["$ref"] == PROBLEM_SCHEMA;
        if is_problem
            && let Some(problem) = content.as_object_mut().and_then(|c| c.remove("application/json"))
        {
            content[PROBLEM_JSON] = problem;
        }
        let Some(content) = content.as_object_mut() else { return };
        for (kind, body) in content {
            if body.get("example").is_some() || body.get("examples").is_some() {
                continue;
            }
            let example = match &answer {
                Some((status, words)) if kind == PROBLEM_JSON => self.problem(*status, words),
                _ => self.sample(&body["schema"]),
            };
            if let Some(example) = example {
                body["example"] = example;
            }
        }
    }

    /// The words of the body's own type.
    fn what_it_is(&self, answer: &Value) -> String {
        let body = answer["content"].as_object().and_then(|content| content.values().next());
        let name =
            body.and_then(|body| body["schema"]["$ref"].as_str()?.rsplit('/').next().map(str::to_owned));
        let words = name.and_then(|name| self.schemas[name]["description"].as_str().map(str::to_owned));
        words.unwrap_or_else(|| "Done".into())
    }

    fn sample(&self, schema: &Value) -> Option<Value> {
        if let Some(name) = schema["$ref"].as_str().and_then(|path| path.rsplit('/').next()) {
            let items = &self.schemas[name]["items"];
            return samples::of(name).or_else(|| Some(json!([self.sample(items)?])));
        }
        match schema["type"].as_str()? {
            "array" => Some(json!([self.sample(&schema["items"])?])),
            "object" if schema.get("additionalProperties").is_some() => samples::of("Priors"),
            _ => None,
        }
    }

    fn problem(&self, status: u16, words: &str) -> Option<Value> {
        let kind = match status {
            400 => Problem::malformed(words, Vec::new()),
            401 => Problem::unauthorized(words),
            403 => Problem::forbidden(words),
            404 => Problem::not_found(missing(self.path)),
            409 => Problem::refused(Reason::WaitForHoming),
            422 => Problem::invalid(words, vec![samples::problem_item()]),
            429 => Problem::too_many(words),
            503 => Problem::unavailable(Reason::Busy),
            other => Problem::of_status(axum::http::StatusCode::from_u16(other).ok()?),
        };
        let instance = self.path.replace("{id}", "1").into();
        serde_json::to_value(Problem { instance, ..kind }).ok()
    }
}

/// What an example of an operation could not find.
fn missing(path: &str) -> Reason {
    let number = || "1".to_owned();
    match path.split('/').nth(3) {
        Some("scenes") => Reason::NoScene { scene: number() },
        Some("sessions") => Reason::NoSession { session: number() },
        _ => Reason::PersonNotInside { person: number() },
    }
}

const METHODS: [&str; 5] = ["get", "put", "post", "patch", "delete"];
/// They are no GET because they have a body, or give something away.
const READ_ONLY: [&str; 3] = ["/api/v1/scenes/check", "/api/v1/priors/preview", "/api/v1/tickets"];
/// What the handlers say of a body that need not be there.
const MAY_BE_EMPTY: &str = "May be empty";
const PROBLEM_SCHEMA: &str = "#/components/schemas/Problem";
