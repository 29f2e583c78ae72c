//! HTTP as the OpenAPI document has it: every operation is asked as documented, and answers as documented.

use std::collections::BTreeSet;

use covr_tests::contract::Contract;
use covr_tests::server::{TestServer, problem};
use reqwest::Client;
use serde_json::{Value, json};

/// One documented operation.
pub struct Operation {
    /// In capitals.
    pub method: String,
    /// With its parameters in braces.
    pub path: String,
    /// What the document says.
    pub about: Value,
}

impl Operation {
    /// Its path with each parameter's example in place, `1` where there is none.
    pub fn address(&self) -> String {
        let mut path = self.path.clone();
        for parameter in self.parameters("path") {
            path = path.replace(&format!("{{{}}}", parameter["name"].as_str().unwrap()), "1");
        }
        let required = self.parameters("query").into_iter().filter(|parameter| parameter["required"] == true);
        let query: Vec<String> = required
            .map(|parameter| {
                let example = [&parameter["example"], &parameter["schema"]["example"]]
                    .into_iter()
                    .find_map(Value::as_str)
                    .unwrap_or_else(|| {
                        panic!("{path}: {} is required and has no example", parameter["name"])
                    });
                format!("{}={example}", parameter["name"].as_str().unwrap())
            })
            .collect();
        if query.is_empty() { path } else { format!("{path}?{}", query.join("&")) }
    }

    fn parameters(&self, place: &str) -> Vec<&Value> {
        let all = self.about["parameters"].as_array();
        all.into_iter().flatten().filter(|parameter| parameter["in"] == place).collect()
    }

    /// The example of its body.
    pub fn body(&self) -> Option<String> {
        let body = self.about.get("requestBody")?;
        Some(body["content"]["application/json"]["example"].to_string())
    }

    /// It becomes a WebSocket.
    pub fn is_socket(&self) -> bool {
        self.path.starts_with("/ws/")
    }
}

/// Every documented operation.
pub fn operations(contract: &Contract) -> Vec<Operation> {
    let paths = contract.0["paths"].as_object().unwrap();
    let all = paths.iter().flat_map(|(path, item)| {
        let methods = item.as_object().unwrap().iter().filter(|(_, about)| about.get("responses").is_some());
        methods.map(|(method, about)| Operation {
            method: method.to_uppercase(),
            path: path.clone(),
            about: about.clone(),
        })
    });
    all.collect()
}

#[tokio::test]
async fn every_operation_has_a_name_a_tag_a_summary_and_examples_that_are_what_they_stand_for() {
    let server = TestServer::start().await;
    let contract = server.contract().await;
    assert!(contract.0["info"].get("license").is_none(), "no licence is chosen");
    let mut names = BTreeSet::new();
    for operation in operations(contract) {
        let (about, at) = (&operation.about, format!("{} {}", operation.method, operation.path));
        assert!(names.insert(about["operationId"].as_str().unwrap().to_owned()), "{at}: its name is taken");
        assert!(about["tags"][0].is_string() && about["summary"].is_string(), "{at}");
        let tags = contract.0["tags"].as_array().unwrap();
        assert!(
            tags.iter().any(|tag| tag["name"] == about["tags"][0]),
            "{at}: {} is not among the tags",
            about["tags"][0]
        );
        let answers = about["responses"].as_object().unwrap();
        let mut bodies: Vec<(String, &Value)> = answers
            .iter()
            .flat_map(|(status, answer)| {
                assert!(
                    answer["description"].as_str().is_some_and(|words| !words.is_empty()),
                    "{at}: {status}"
                );
                let content = answer["content"].as_object().into_iter().flatten();
                content.map(move |(kind, body)| (format!("{status} {kind}"), body))
            })
            .collect();
        if about.get("requestBody").is_some() {
            bodies.push((
                "request application/json".into(),
                &about["requestBody"]["content"]["application/json"],
            ));
        }
        for (what, body) in bodies {
            let is_document = about["tags"][0] == "contract" || body["schema"].is_null();
            if !what.ends_with("json") || is_document {
                continue;
            }
            let example =
                body.get("example").unwrap_or_else(|| panic!("{at}: {what} has no example: {body}"));
            if let Some(complaint) = contract.complaint(&body["schema"], example) {
                panic!("{at}: {what}: the example: {complaint}");
            }
        }
    }
    assert!(names.len() > 25, "{names:?}");
}

#[tokio::test]
async fn every_operation_answers_its_own_example_as_documented() {
    let server = TestServer::start().await;
    server.arm().await;
    let contract = server.contract().await;
    let mut good = 0;
    for operation in operations(contract) {
        if operation.is_socket() {
            continue;
        }
        let at = format!("{} {}", operation.method, operation.address());
        let body = operation.body();
        let response =
            server.call_as(Some("Ada"), &operation.method, &operation.address(), body.as_deref()).await;
        let status = response.status();
        let kind = response.headers()["content-type"].to_str().unwrap().split(';').next().unwrap().to_owned();
        let text = response.text().await.unwrap();
        let answer = &operation.about["responses"][status.as_str()];
        assert!(answer.is_object(), "{at}: {status} is not documented: {text}");
        let documented =
            answer["content"].as_object().unwrap_or_else(|| panic!("{at}: {status} has no content"));
        let body =
            documented.get(&kind).unwrap_or_else(|| panic!("{at}: {status}: {kind} is not documented"));
        good += usize::from(status.is_success());
        if kind.ends_with("json") && body["schema"].is_object() {
            let value: Value =
                serde_json::from_str(&text).unwrap_or_else(|why| panic!("{at}: {why}: {text}"));
            if let Some(complaint) = contract.complaint(&body["schema"], &value) {
                panic!("{at}: {status}: {complaint}: {text}");
            }
        }
    }
    assert!(good > 20, "{good} examples were accepted");
}

#[tokio::test]
async fn every_operation_refuses_as_documented() {
    let server = TestServer::start().await;
    let contract = server.contract().await;
    let large = format!("{{\"x\": \"{}\"}}", "x".repeat(4 * 1024 * 1024));
    for operation in operations(contract) {
        let (address, answers) = (operation.address(), &operation.about["responses"]);
        let path = address.split('?').next().unwrap();
        let documented = |status: &str| answers.get(status).is_some();
        let elsewhere = Client::new()
            .request(operation.method.parse().unwrap(), format!("http://{}{address}", server.host))
            .header("Origin", "http://elsewhere.example");
        let status = elsewhere.send().await.unwrap().status();
        assert_eq!(status == 403, documented("403"), "{address} from elsewhere: {status}");
        if operation.is_socket() || !path.starts_with("/api/") {
            continue;
        }
        problem(405, path, server.call("PROPFIND", path, None).await).await;
        if operation.body().is_some() && path != STOP {
            server.refused(400, &operation.method, &address, Some("{ nonsense")).await;
            server.refused(413, &operation.method, &address, Some(&large)).await;
        }
        // What only looks asks for no author.
        let only_looks = ["/api/v1/scenes/check", "/api/v1/priors/preview"].contains(&path);
        if operation.method != "GET" && documented("422") && !only_looks {
            let response =
                server.call_as(Some("%00"), &operation.method, &address, operation.body().as_deref()).await;
            problem(422, path, response).await;
        }
        if address.contains("/1") && documented("404") {
            let nobody = address.replace("/1", "/987654");
            server.refused(404, &operation.method, &nobody, operation.body().as_deref()).await;
        }
        for parameter in operation.parameters("query") {
            let kinds = &parameter["schema"]["type"];
            if kinds == &json!("string") || kinds[0] == "string" || parameter["schema"]["enum"].is_array() {
                continue;
            }
            let wrong = format!("{path}?{}=many", parameter["name"].as_str().unwrap());
            server.refused(400, &operation.method, &wrong, operation.body().as_deref()).await;
        }
    }
}

#[tokio::test]
async fn every_route_is_documented() {
    let server = TestServer::start().await;
    let contract = server.contract().await;
    // What the dashboard and the other tests ask for, whatever the document says.
    for asked in [
        "GET /api/v1/state",
        "POST /api/v1/stop",
        "POST /api/v1/home",
        "POST /api/v1/arm",
        "POST /api/v1/disarm",
        "POST /api/v1/reset",
        "POST /api/v1/persons/{id}/confirm",
        "POST /api/v1/persons/{id}/left",
        "POST /api/v1/arena/clear",
        "GET /api/v1/commissionings",
        "POST /api/v1/commissionings",
        "GET /api/v1/scenes",
        "POST /api/v1/scenes",
        "POST /api/v1/scenes/check",
        "GET /api/v1/scenes/{id}",
        "PUT /api/v1/scenes/{id}",
        "GET /api/v1/scenes/{id}/versions",
        "PUT /api/v1/scenes/{id}/activate",
        "GET /api/v1/scene.schema.json",
        "PATCH /api/v1/priors",
        "GET /api/v1/priors/changes",
        "GET /api/v1/sessions",
        "GET /api/v1/events",
        "GET /api/v1/config",
        "GET /api/v1/openapi.json",
        "GET /api/v1/asyncapi.json",
        "GET /ws/v1/client",
        "GET /ws/v1/dashboard",
        "GET /healthz",
        "GET /readyz",
        "GET /metrics",
    ] {
        let is_there = operations(contract).iter().any(|o| format!("{} {}", o.method, o.path) == asked);
        assert!(is_there, "{asked} is not documented");
    }
}

const STOP: &str = "/api/v1/stop";
