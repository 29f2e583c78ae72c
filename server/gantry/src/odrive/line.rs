//! One exchange at a time: lines out, the answers to those that ask in before a deadline, each with a check word.
//!
//! A board answers nothing to what sets or moves, and its answers do not say to what. So each exchange begins by writing a number of its
//! own into a property that the firmware keeps for tests (`test_property`), asks for it first and last, and must get as many answers as
//! it asked for: what lies between the two belongs to this exchange, in order, and all that was sent before them has been read.
//!
//! Each line ends in ` *N`, the exclusive or of all before the asterisk; the board ignores a line whose word is wrong, and gives its answers
//! one too. A space stands before the asterisk and every number has its decimals, so that a lost asterisk changes no number. What the
//! word cannot catch is a bit that makes a character the end of a line or the beginning of a comment: the board then obeys what stands before it,
//! unchecked. On USB, which checks every packet itself, no such bit comes through; the goals are read back in every exchange all the same.

use std::fmt::{self, Write};
use std::io;
use std::time::{Duration, Instant};

use crate::linked::figures::Tally;
use crate::linked::port::Port;

/// Why an exchange failed.
#[derive(Debug, thiserror::Error)]
pub enum Lost {
    /// Not all answers in time.
    #[error("{got} of {expected} answers came within {} ms", .within.as_millis())]
    Silent { got: usize, expected: usize, within: Duration },
    /// An answer that is none, or not to this exchange.
    #[error("an answer is garbled: {0:?}")]
    Garbled(String),
    /// The port is gone.
    #[error("the port: {0}")]
    Port(#[from] io::Error),
}

/// What goes out together.
#[derive(Debug, Default)]
pub struct Batch {
    lines: String,
    questions: usize,
}

impl Batch {
    /// A line that the board does not answer.
    pub fn tell(&mut self, line: fmt::Arguments<'_>) {
        let start = self.lines.len();
        // Writing into a string cannot fail.
        let _ = write!(self.lines, "{line} ");
        let word = check_word(&self.lines.as_bytes()[start..]);
        let _ = writeln!(self.lines, "*{word}");
    }

    /// A line that the board answers by one line.
    pub fn ask(&mut self, line: fmt::Arguments<'_>) {
        self.tell(line);
        self.questions += 1;
    }
}

/// The line and what is known of it.
pub struct Line<P> {
    port: P,
    is_clean: bool,
    number: u32,
    pub tally: Tally,
}

impl<P: Port> Line<P> {
    /// A line of which nothing is known.
    pub fn new(port: P) -> Self {
        Self { port, is_clean: false, number: 0, tally: Tally::default() }
    }

    /// Send the batch and wait for its answers. Not repeated: what it asks may be old by then.
    pub fn exchange(&mut self, batch: &Batch) -> Result<Vec<String>, Lost> {
        if !self.is_clean {
            self.clean()?;
        }
        self.is_clean = false;
        // The board writes nine figures at most.
        self.number = self.number % 999_999_999 + 1;
        let mut framed = Batch::default();
        framed.tell(format_args!("w test_property {}", self.number));
        framed.ask(format_args!("r test_property"));
        framed.lines.push_str(&batch.lines);
        framed.ask(format_args!("r test_property"));
        let expected = batch.questions + framed.questions;
        self.port.send(framed.lines.as_bytes())?;
        self.tally.bytes += framed.lines.len() as u64;
        let answers = self.answers(expected).inspect_err(|_| self.tally.lost += 1)?;
        self.tally.answered += 1;
        self.is_clean = true;
        Ok(answers)
    }

    /// The same, up to three times: for what may be sent twice without harm.
    pub fn exchange_again(&mut self, batch: &Batch) -> Result<Vec<String>, Lost> {
        for _ in 1..TRIES {
            match self.exchange(batch) {
                Err(Lost::Silent { .. } | Lost::Garbled(_)) => self.tally.repeated += 1,
                outcome => return outcome,
            }
        }
        self.exchange(batch)
    }

    fn answers(&mut self, expected: usize) -> Result<Vec<String>, Lost> {
        let deadline = self.port.now() + WITHIN;
        let mut came = Vec::with_capacity(MOST_ANSWERS);
        let count = |came: &[u8]| came.iter().filter(|byte| **byte == b'\n').count();
        while count(&came) < expected {
            let mut bytes = [0; MOST_ANSWERS];
            let got = self.receive(&mut bytes, deadline)?;
            if got == 0 {
                return Err(Lost::Silent { got: count(&came), expected, within: WITHIN });
            }
            came.extend_from_slice(&bytes[..got]);
            if came.len() > MOST_ANSWERS {
                return Err(Lost::Garbled(String::from_utf8_lossy(&came[..64]).into_owned()));
            }
        }
        let text = String::from_utf8_lossy(&came);
        let garbled = |line: &str| Lost::Garbled(line.to_owned());
        let Some(lines) = text.strip_suffix('\n') else { return Err(garbled(&text)) };
        let answers: Result<Vec<_>, _> =
            lines.split('\n').map(|line| checked(line).ok_or_else(|| garbled(line))).collect();
        let answers = answers?;
        let number = self.number.to_string();
        match &answers[..] {
            [first, between @ .., last]
                if answers.len() == expected && *first == number && *last == number =>
            {
                Ok(between.iter().map(|answer| (*answer).to_owned()).collect())
            }
            _ => Err(garbled(lines)),
        }
    }

    /// Some bytes, or none once the deadline is past.
    fn receive(&mut self, into: &mut [u8], deadline: Instant) -> Result<usize, Lost> {
        loop {
            let count = self.port.receive(into, deadline)?;
            if count > 0 || self.port.now() >= deadline {
                self.tally.bytes += count as u64;
                return Ok(count);
            }
        }
    }

    /// Wait until nothing has come for a while: what was late is thrown away.
    fn clean(&mut self) -> Result<(), Lost> {
        let give_up = self.port.now() + LONGEST_CLEANING;
        let mut quiet_at = self.port.now() + QUIET;
        let mut rubbish = [0; MOST_ANSWERS];
        while self.port.now() < quiet_at && self.port.now() < give_up {
            if self.port.receive(&mut rubbish, quiet_at)? > 0 {
                quiet_at = self.port.now() + QUIET;
            }
        }
        self.is_clean = true;
        Ok(())
    }
}

/// An answer without its check word, when that is right.
fn checked(line: &str) -> Option<&str> {
    let (answer, word) = line.strip_suffix('\r')?.rsplit_once('*')?;
    (word.parse() == Ok(check_word(answer.as_bytes()))).then_some(answer)
}

fn check_word(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |word, byte| word ^ byte)
}

/// For a whole exchange. *Unverified* on a board: USB has a frame each millisecond, and reading a line takes the firmware some
/// tens of microseconds. With [`QUIET`] it is less than a command is good for, so that one lost exchange does not make the board brake.
const WITHIN: Duration = Duration::from_millis(15);
/// How often a safe exchange is tried.
const TRIES: u32 = 3;
/// Some frames of USB.
const QUIET: Duration = Duration::from_millis(5);
/// A line that never is quiet is given up on.
const LONGEST_CLEANING: Duration = Duration::from_millis(200);
/// The board's own buffer for answers has 512 bytes.
const MOST_ANSWERS: usize = 1_024;

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;

    use super::*;

    /// Answers each exchange with what was prepared.
    #[derive(Default)]
    struct Script {
        sent: Vec<String>,
        answers: VecDeque<Vec<String>>,
        on_line: VecDeque<Vec<u8>>,
    }

    impl Port for Script {
        fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
            self.sent.push(String::from_utf8(bytes.to_vec()).unwrap());
            self.on_line
                .extend(self.answers.pop_front().unwrap_or_default().into_iter().map(String::into_bytes));
            Ok(())
        }

        fn receive(&mut self, into: &mut [u8], deadline: Instant) -> io::Result<usize> {
            let Some(chunk) = self.on_line.pop_front() else {
                // A line with nothing on it: the time until the deadline passes.
                std::thread::sleep(deadline.saturating_duration_since(Instant::now()));
                return Ok(0);
            };
            into[..chunk.len()].copy_from_slice(&chunk);
            Ok(chunk.len())
        }
    }

    fn line<const N: usize>(answers: [&[&str]; N]) -> Line<Script> {
        let answers = answers.iter().map(|answers| answers.iter().map(|answer| sealed(answer)).collect());
        Line::new(Script { answers: answers.collect(), ..Script::default() })
    }

    fn sealed(answer: &str) -> String {
        if answer.contains('*') {
            return answer.to_owned();
        }
        format!("{answer}*{}\r\n", check_word(answer.as_bytes()))
    }

    fn volts() -> Batch {
        let mut batch = Batch::default();
        batch.ask(format_args!("r vbus_voltage"));
        batch
    }

    #[test]
    fn the_check_word_is_the_makers() {
        // The example of the maker's description.
        assert_eq!(volts().lines, "r vbus_voltage *93\n");
    }

    #[test]
    fn an_answer_between_the_two_numbers_is_the_answer() {
        let mut line = line([&["1", "24.087744", "1"]]);
        assert_eq!(line.exchange(&volts()).unwrap(), ["24.087744"]);
        assert!(line.port.sent[0].starts_with("w test_property 1 *"), "{}", line.port.sent[0]);
        assert_eq!((line.tally.answered, line.tally.lost), (1, 0));
    }

    #[test]
    fn an_answer_that_is_missing_late_or_garbled_is_none() {
        for answers in [
            // One was lost.
            &["1", "1"][..],
            // One of an exchange before, one lost.
            &["9", "24.0", "1"],
            &["1", "24.0", "9"],
            // One too many.
            &["1", "24.0", "24.0", "1"],
            // A wrong check word, and none.
            &["1", "24.0*1\r\n", "1"],
            &["1", "24.0\r\n*", "1"],
        ] {
            let mut line = line([answers]);
            assert!(
                matches!(line.exchange(&volts()), Err(Lost::Silent { .. } | Lost::Garbled(_))),
                "{answers:?}"
            );
            assert_eq!((line.tally.answered, line.tally.lost), (0, 1));
        }
    }

    #[test]
    fn what_may_be_sent_twice_is_sent_up_to_three_times_each_with_a_number_of_its_own() {
        let mut line = line([&["1"], &["1", "24.0", "1"], &["3", "24.5", "3"]]);
        assert_eq!(line.exchange_again(&volts()).unwrap(), ["24.5"]);
        assert_eq!(line.tally, Tally { answered: 1, lost: 2, repeated: 2, bytes: line.tally.bytes });
        assert_eq!(line.port.sent.len(), 3);
    }

    #[test]
    fn a_lost_asterisk_changes_no_number() {
        let mut batch = Batch::default();
        batch.tell(format_args!("t 0 {:.6}", -12.5));
        let without = batch.lines.replace('*', "");
        assert_eq!(without.split_whitespace().nth(2), Some("-12.500000"));
    }
}
