//! What serde says of a refused value, taken apart into what was found and what was expected.

/// A refused value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Complaint {
    /// In what way it is wrong.
    pub fault: Fault,
    /// The key of a missing field, below the path that serde gives.
    pub key: Option<String>,
    /// What was found.
    pub found: String,
    /// What was expected.
    pub expected: String,
}

/// In what way a value is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// A field that must be there is not.
    Missing,
    /// A field that nobody knows, or the same one twice.
    UnknownField,
    /// Another type of value.
    WrongType,
    /// The right type, a value that cannot be.
    OutOfRange,
    /// Not the format at all.
    Malformed,
}

impl Complaint {
    /// Take apart one message of serde. `format` names what the text should have been: "JSON".
    pub fn parse(message: &str, format: &str) -> Self {
        let message = without_place(message);
        if let Some(rest) = message.strip_prefix("missing field `") {
            let key = rest.split('`').next().unwrap_or_default();
            let expected = rest.split_once("`, expected ").map_or("a value", |(_, expected)| expected);
            return Self::new(Fault::Missing, Some(key), "nothing", expected);
        }
        if let Some(rest) = message.strip_prefix("duplicate field `") {
            return Self::new(
                Fault::UnknownField,
                None,
                &format!("`{}` twice", rest.trim_end_matches('`')),
                "it once",
            );
        }
        let (found, expected) = match message.rfind(", expected ") {
            Some(at) => (&message[..at], &message[at + ", expected ".len()..]),
            None => (message, ""),
        };
        if found.starts_with("unknown field `") {
            let found = found.strip_suffix(", there are no fields").unwrap_or(found);
            return Self::new(
                Fault::UnknownField,
                None,
                found,
                if expected.is_empty() { "no fields" } else { expected },
            );
        }
        if let Some(found) = found.strip_prefix("unknown variant ") {
            return Self::new(Fault::OutOfRange, None, found, expected);
        }
        if let Some(found) = found.strip_prefix("invalid type: ") {
            return Self::new(Fault::WrongType, None, found, in_words(expected));
        }
        if let Some(found) = found.strip_prefix("invalid value: ") {
            return Self::new(Fault::OutOfRange, None, found, in_words(expected));
        }
        if found.starts_with("invalid length ") {
            let found = found.trim_start_matches("invalid ");
            return Self::new(Fault::WrongType, None, found, in_words(expected));
        }
        let expected = if expected.is_empty() { format!("well-formed {format}") } else { expected.into() };
        Self::new(Fault::Malformed, None, found, &expected)
    }

    fn new(fault: Fault, key: Option<&str>, found: &str, expected: &str) -> Self {
        Self { fault, key: key.map(Into::into), found: shortened(found), expected: expected.into() }
    }
}

/// A text of at most 120 characters, for an error that quotes what a stranger sent.
pub(crate) fn shortened(text: &str) -> String {
    match text.char_indices().nth(MOST_QUOTED_CHARS) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.into(),
    }
}

/// serde_json ends its messages with the place, which we carry apart.
fn without_place(message: &str) -> &str {
    match message.rfind(" at line ") {
        Some(at) if message[at..].contains(" column ") => &message[..at],
        _ => message,
    }
}

/// serde names Rust types; people know numbers.
fn in_words(expected: &str) -> &str {
    match expected {
        "f64" | "f32" => "a number",
        "u8" => "a whole number from 0 to 255",
        "u32" => "a whole number from 0 to 4294967295",
        "u64" | "usize" => "a whole number, 0 or more",
        "i64" => "a whole number",
        "a boolean" => "true or false",
        "an array of length 2" => "2 numbers",
        "an array of length 3" => "3 numbers",
        "an array of length 4" => "4 numbers",
        "a sequence" => "a list",
        "option" => "a value",
        other if other.starts_with("struct ") => "an object with fields",
        other => other,
    }
}

const MOST_QUOTED_CHARS: usize = 120;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_type_is_taken_apart() {
        let complaint = Complaint::parse(
            "invalid type: string \"1, expected 2\", expected f64 at line 1 column 9",
            "JSON",
        );
        assert_eq!(complaint.fault, Fault::WrongType);
        assert_eq!(complaint.found, "string \"1, expected 2\"");
        assert_eq!(complaint.expected, "a number");
    }

    #[test]
    fn a_missing_field_names_its_key() {
        let complaint = Complaint::parse("missing field `radius`", "JSON");
        assert_eq!((complaint.fault, complaint.key.as_deref()), (Fault::Missing, Some("radius")));
    }

    #[test]
    fn an_unknown_field_lists_the_known_ones() {
        let complaint = Complaint::parse("unknown field `x`, expected one of `a`, `b`", "JSON");
        assert_eq!(complaint.fault, Fault::UnknownField);
        assert_eq!(complaint.found, "unknown field `x`");
        assert_eq!(complaint.expected, "one of `a`, `b`");
    }

    #[test]
    fn a_syntax_error_says_what_the_text_should_be() {
        let complaint = Complaint::parse("EOF while parsing a value at line 3 column 0", "JSON");
        assert_eq!(complaint.fault, Fault::Malformed);
        assert_eq!(complaint.found, "EOF while parsing a value");
        assert_eq!(complaint.expected, "well-formed JSON");
    }

    #[test]
    fn a_long_quotation_is_cut() {
        let complaint =
            Complaint::parse(&format!("invalid type: string \"{}\", expected f64", "é".repeat(500)), "JSON");
        assert_eq!(complaint.found.chars().count(), MOST_QUOTED_CHARS + 1);
    }
}
