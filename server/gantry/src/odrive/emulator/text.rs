//! Lines as the board reads and writes them (maker's description of the ASCII protocol, "Command Format").
//!
//! A line ends at a line feed, a carriage return or an exclamation mark. What follows a semicolon is a comment. A line with an asterisk is
//! obeyed only if the number behind it is the exclusive or of all characters before it; then its answer has such a number too.
//! A line without one is obeyed as it is.

/// Bytes that come, until they are a line.
#[derive(Debug, Clone, Default)]
pub struct Reader {
    bytes: Vec<u8>,
    /// The line is longer than the board has room for: the rest of it is nothing.
    is_too_long: bool,
}

/// A line to be obeyed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Heard {
    /// Without comment and check word.
    pub words: String,
    /// Its answer is to have a check word.
    pub is_checked: bool,
}

impl Reader {
    /// One byte more; a line when it ends one that is to be obeyed.
    pub fn push(&mut self, byte: u8) -> Option<Heard> {
        if !matches!(byte, b'\n' | b'\r' | b'!') {
            if self.bytes.len() == MOST_BYTES {
                self.bytes.clear();
                self.is_too_long = true;
            }
            self.bytes.push(byte);
            return None;
        }
        let bytes = std::mem::take(&mut self.bytes);
        if std::mem::take(&mut self.is_too_long) {
            return None;
        }
        heard(&bytes)
    }

    /// What has come of a line is gone.
    pub fn forget(&mut self) {
        *self = Self::default();
    }
}

/// An answer as it goes over the line.
pub fn sealed(answer: &str, is_checked: bool) -> Vec<u8> {
    if is_checked {
        format!("{answer}*{}\r\n", exclusive_or(answer.as_bytes())).into_bytes()
    } else {
        format!("{answer}\r\n").into_bytes()
    }
}

fn heard(bytes: &[u8]) -> Option<Heard> {
    let line = bytes.split(|byte| *byte == b';').next().unwrap_or_default();
    let Some(asterisk) = line.iter().position(|byte| *byte == b'*') else {
        return Some(Heard { words: String::from_utf8_lossy(line).into_owned(), is_checked: false });
    };
    let (words, told) = (&line[..asterisk], String::from_utf8_lossy(&line[asterisk + 1..]).into_owned());
    let told = leading_digits(told.trim_start())?;
    (told == u32::from(exclusive_or(words)))
        .then(|| Heard { words: String::from_utf8_lossy(words).into_owned(), is_checked: true })
}

/// A whole number at the beginning, whatever comes behind it.
fn leading_digits(text: &str) -> Option<u32> {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    text[..end].parse().ok()
}

/// A number at the beginning, whatever comes behind it: as the board's library reads one.
pub fn leading_number(text: &str) -> Option<f32> {
    (1..=text.len()).rev().filter_map(|end| text.get(..end)).find_map(|start| start.parse().ok())
}

fn exclusive_or(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |all, byte| all ^ byte)
}

/// *Unverified* beyond the source's name of it.
const MOST_BYTES: usize = 256;

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<Heard> {
        let mut reader = Reader::default();
        text.bytes().filter_map(|byte| reader.push(byte)).collect()
    }

    #[test]
    fn a_line_is_obeyed_when_its_check_word_is_right_or_it_has_none() {
        let words = "r vbus_voltage ".to_owned();
        assert_eq!(read("r vbus_voltage *93\n"), [Heard { words, is_checked: true }]);
        assert_eq!(read("r vbus_voltage *92\n"), []);
        assert_eq!(read("r vbus_voltage *\n"), []);
        assert_eq!(read("f 0 ; feedback\n"), [Heard { words: "f 0 ".into(), is_checked: false }]);
    }

    #[test]
    fn a_character_that_becomes_an_end_lets_the_rest_through_unchecked() {
        assert_eq!(read("t 0 1!2345 *1\n")[0], Heard { words: "t 0 1".into(), is_checked: false });
        assert_eq!(read("t 0 1;2345 *1\n"), [Heard { words: "t 0 1".into(), is_checked: false }]);
    }

    #[test]
    fn a_line_that_is_too_long_is_nothing() {
        assert_eq!(read(&format!("{}\nf 0\n", "x".repeat(300))).len(), 1);
    }

    #[test]
    fn numbers_end_where_they_end() {
        assert_eq!(leading_number("1.5x"), Some(1.5));
        assert_eq!(leading_number("-2"), Some(-2.0));
        assert_eq!(leading_number("x"), None);
        assert_eq!(sealed("24.0", true), b"24.0*24\r\n");
    }
}
