//! Where in a text a JSON path is: so that an error found after reading can still say its line.

/// Looks for paths in a text that is known to be JSON.
pub(super) struct Finder<'a> {
    text: &'a [u8],
}

impl<'a> Finder<'a> {
    /// For a text that has been read as JSON.
    pub(super) const fn new(text: &'a [u8]) -> Self {
        Self { text }
    }

    /// Line and column, from 1, of the value at `path` (`$.objects[3].id`); of the innermost part that is there, if
    /// the value itself is not written out.
    pub(super) fn find(&self, path: &str) -> Option<(usize, usize)> {
        let mut cursor = Cursor { text: self.text, at: 0 };
        cursor.blanks();
        for step in steps(path.strip_prefix('$')?) {
            let parent = cursor.at;
            if !cursor.enter(&step) {
                cursor.at = parent;
                break;
            }
        }
        let before = self.text.get(..cursor.at)?;
        let line_start = before.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        Some((line, cursor.at - line_start + 1))
    }
}

#[derive(Debug, PartialEq)]
enum Step<'a> {
    Key(&'a str),
    Index(usize),
}

fn steps(path: &str) -> impl Iterator<Item = Step<'_>> {
    path.split(['.', '[']).filter(|part| !part.is_empty()).map(|part| match part.strip_suffix(']') {
        Some(index) => Step::Index(index.parse().unwrap_or(usize::MAX)),
        None => Step::Key(part),
    })
}

struct Cursor<'a> {
    text: &'a [u8],
    at: usize,
}

impl Cursor<'_> {
    /// From the start of a container to the start of the value that the step names; false if it is not there.
    fn enter(&mut self, step: &Step<'_>) -> bool {
        let opens = self.byte();
        self.at += 1;
        let mut index = 0;
        loop {
            self.blanks();
            match (self.byte(), step) {
                (Some(b'}' | b']') | None, _) => return false,
                (Some(b','), _) => {
                    self.at += 1;
                    continue;
                }
                (Some(b'"'), Step::Key(name)) if opens == Some(b'{') => {
                    let key_start = self.at;
                    self.skip_value();
                    let key = &self.text[key_start + 1..self.at - 1];
                    self.blanks();
                    self.at += 1;
                    self.blanks();
                    if key == name.as_bytes() {
                        return true;
                    }
                }
                (Some(_), Step::Index(wanted)) if opens == Some(b'[') => {
                    if index == *wanted {
                        return true;
                    }
                    index += 1;
                }
                _ => return false,
            }
            self.skip_value();
        }
    }

    /// Past the value that starts here.
    fn skip_value(&mut self) {
        let mut depth = 0_usize;
        loop {
            match self.byte() {
                None => return,
                Some(b'"') => self.skip_string(),
                Some(b'{' | b'[') => {
                    depth += 1;
                    self.at += 1;
                }
                Some(b'}' | b']') => {
                    depth = depth.saturating_sub(1);
                    self.at += 1;
                }
                Some(b',' | b':' | b' ' | b'\t' | b'\n' | b'\r') => self.at += 1,
                Some(_) => {
                    while !matches!(
                        self.byte(),
                        None | Some(b',' | b'}' | b']' | b' ' | b'\t' | b'\n' | b'\r')
                    ) {
                        self.at += 1;
                    }
                }
            }
            if depth == 0 {
                return;
            }
        }
    }

    fn skip_string(&mut self) {
        self.at += 1;
        while let Some(byte) = self.byte() {
            self.at += if byte == b'\\' { 2 } else { 1 };
            if byte == b'"' {
                return;
            }
        }
    }

    fn blanks(&mut self) {
        while matches!(self.byte(), Some(b' ' | b'\t' | b'\n' | b'\r')) {
            self.at += 1;
        }
    }

    fn byte(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &[u8] = br#"{
  "a": { "x\"]": [1, {"b": "}"}], "b": [ [ -1.5, true ], {"c" : null} ] },
  "d": 3
}"#;

    #[test]
    fn values_are_found_where_they_start() {
        let finder = Finder::new(TEXT);
        assert_eq!(finder.find("$"), Some((1, 1)));
        let column = |part: &str| String::from_utf8_lossy(TEXT).lines().nth(1).and_then(|l| l.find(part));
        assert_eq!(finder.find("$.a.b[0][1]"), column("true").map(|at| (2, at + 1)));
        assert_eq!(finder.find("$.a.b[1].c"), column("null").map(|at| (2, at + 1)));
        assert_eq!(finder.find("$.d"), Some((3, 8)));
    }

    #[test]
    fn what_is_not_there_is_reported_at_its_parent() {
        let finder = Finder::new(TEXT);
        assert_eq!(finder.find("$.a.b[7].c"), finder.find("$.a.b"));
        assert_eq!(finder.find("$.d.e"), finder.find("$.d"));
        assert_eq!(finder.find("$.nowhere"), Some((1, 1)));
    }
}
