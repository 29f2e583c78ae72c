//! The published contract: what the server says of itself is what it does.

use covr_tests::server::TestServer;
use covr_wire::client::{Encoding, decode, decode_from_server};
use covr_wire::dashboard::{FromDashboard, ToDashboard};
use serde_json::{Value, json};

/// The types of every message that goes a way, from the enum's own schema.
fn types_of<M: schemars::JsonSchema>() -> Vec<String> {
    let schema = schemars::schema_for!(M).to_value();
    let variants = schema["oneOf"].as_array().unwrap().clone();
    let mut names: Vec<String> = variants
        .iter()
        .map(|variant| variant["properties"]["type"]["const"].as_str().unwrap().to_owned())
        .collect();
    names.sort();
    names
}

/// Every message of an operation: its type, its schema with all that it refers to, its examples.
fn messages(document: &Value, operation: &str) -> Vec<(String, Value, Vec<Value>)> {
    let at = |reference: &Value| {
        let path = reference["$ref"].as_str().unwrap().trim_start_matches('#');
        document.pointer(path).unwrap_or_else(|| panic!("{path} is not in the document")).clone()
    };
    let refs = document["operations"][operation]["messages"].as_array().unwrap().clone();
    let mut found: Vec<_> = refs
        .iter()
        .map(|reference| {
            let message = at(&at(reference));
            let mut schema = message["payload"].clone();
            schema["components"] = document["components"].clone();
            schema["$schema"] = "http://json-schema.org/draft-07/schema#".into();
            let examples = message["examples"].as_array().unwrap();
            let examples = examples.iter().map(|example| example["payload"].clone()).collect();
            (message["name"].as_str().unwrap().to_owned(), schema, examples)
        })
        .collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    found
}

#[tokio::test]
async fn every_message_of_both_sockets_is_in_the_asyncapi_document_with_examples_that_are_such_messages() {
    let server = TestServer::start().await;
    let document = server.good("GET", "/api/v1/asyncapi.json", None).await;
    assert_eq!(document["asyncapi"], "3.0.0");
    type Parses = fn(&str) -> Result<(), String>;
    let directions: [(&str, Vec<String>, Parses); 4] = [
        ("clientSays", types_of::<covr_wire::client::FromClient>(), |text| {
            decode(Encoding::Json, text.as_bytes()).map(drop).map_err(|why| why.to_string())
        }),
        ("clientHears", types_of::<covr_wire::client::ToClient>(), |text| {
            decode_from_server(Encoding::Json, text.as_bytes()).map(drop).map_err(|why| why.to_string())
        }),
        ("dashboardSays", types_of::<FromDashboard>(), |text| {
            serde_json::from_str::<FromDashboard>(text).map(drop).map_err(|why| why.to_string())
        }),
        ("dashboardHears", types_of::<ToDashboard>(), |text| {
            serde_json::from_str::<ToDashboard>(text).map(drop).map_err(|why| why.to_string())
        }),
    ];
    for (operation, types, parses) in directions {
        let messages = messages(&document, operation);
        assert_eq!(messages.iter().map(|(name, ..)| name.clone()).collect::<Vec<_>>(), types, "{operation}");
        for (name, schema, examples) in messages {
            assert!(!examples.is_empty(), "{operation}: {name} has no example");
            let validator = jsonschema::validator_for(&schema).unwrap();
            for example in examples {
                assert_eq!(parses(&example.to_string()), Ok(()), "{operation}: {example}");
                if let Err(error) = validator.validate(&example) {
                    panic!("{operation}: {name}: {error} at {}", error.instance_path());
                }
                let mut other = example.clone();
                other["type"] = json!("nonsense");
                assert!(!validator.is_valid(&other), "{operation}: {name} is told from other messages");
            }
        }
    }
}
