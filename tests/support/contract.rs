//! The OpenAPI document as a judge: whatever the tests of the API hear is held against it.

use serde_json::Value;

/// The document of a server.
pub struct Contract(pub Value);

impl Contract {
    /// Panics when an answer is not what the document says of it. What is asked at no documented operation is not judged.
    pub fn judge(&self, method: &str, path: &str, status: u16, body: &Value) {
        let Some(operation) = self.operation(method, path) else { return };
        let answer = &operation["responses"][status.to_string()];
        assert!(answer.is_object(), "{method} {path}: {status} is not documented: {body}");
        let content = answer["content"].as_object();
        let json = content.into_iter().flatten().find(|(kind, _)| kind.ends_with("json"));
        let Some((_, documented)) = json else { return };
        if let Some(complaint) = self.complaint(&documented["schema"], body) {
            panic!("{method} {path}: {status}: {complaint}: {body}");
        }
    }

    /// What is wrong with a value of a schema.
    pub fn complaint(&self, schema: &Value, value: &Value) -> Option<String> {
        if !schema.is_object() {
            return None;
        }
        let mut whole = schema.clone();
        whole["components"] = self.0["components"].clone();
        let validator = jsonschema::draft202012::new(&whole).unwrap_or_else(|why| panic!("{why}: {schema}"));
        let complaint = validator.iter_errors(value).next()?;
        Some(format!("{complaint} at {}", complaint.instance_path()))
    }

    /// The documented operation of a path; one without parameters goes before one with them.
    fn operation(&self, method: &str, path: &str) -> Option<&Value> {
        let path = path.split('?').next()?;
        let paths = self.0["paths"].as_object()?;
        let fits = |template: &str| {
            let (wanted, found): (Vec<_>, Vec<_>) =
                (template.split('/').collect(), path.split('/').collect());
            wanted.len() == found.len()
                && wanted.iter().zip(found).all(|(w, f)| *w == f || w.starts_with('{'))
        };
        let item = paths.get(path).or_else(|| paths.iter().find(|(t, _)| fits(t)).map(|(_, item)| item))?;
        item.get(method.to_lowercase())
    }
}
