//! One exchange at a time: a packet out, its answer in before a deadline, its CRC looked at; and a quiet line after
//! whatever went wrong.
//!
//! A board discards a packet that it does not understand and says nothing. It also discards what it has of a packet when
//! 10 ms pass without a byte. So after a lost exchange the line is left alone for longer than that and emptied: the next packet
//! begins on a clean line, and a late answer to the lost one cannot be taken for its own.

use std::io;
use std::time::{Duration, Instant};

use super::packet::{crc16, crc16_on};
use crate::linked::figures::Tally;
use crate::linked::port::Port;

/// Why an exchange failed.
#[derive(Debug, thiserror::Error)]
pub enum Lost {
    /// No whole answer in time.
    #[error("command {command}: {got} of {expected} bytes came within {} ms", .within.as_millis())]
    Silent { command: u8, got: usize, expected: usize, within: Duration },
    /// An answer that is none.
    #[error("command {command}: the answer is garbled")]
    Garbled { command: u8 },
    /// The port is gone.
    #[error("the port: {0}")]
    Port(#[from] io::Error),
}

/// The line and what is known of it.
pub struct Line<P> {
    port: P,
    byte_time: Duration,
    is_clean: bool,
    pub tally: Tally,
}

impl<P: Port> Line<P> {
    /// A line at this rate, 10 bits a byte. Nothing is known of what is on it.
    pub fn new(port: P, baud: u32) -> Self {
        let byte_time = Duration::from_secs_f64(10.0 / f64::from(baud.max(1)));
        Self { port, byte_time, is_clean: false, tally: Tally::default() }
    }

    /// Send a command that sets something; its answer is 0xFF. Not repeated: what it asks may be old by then.
    pub fn tell(&mut self, packet: &[u8]) -> Result<(), Lost> {
        let mut answer = [0];
        self.exchange(packet, &mut answer)?;
        self.judge(packet[1], answer[0] == ACKNOWLEDGED)
    }

    /// The same for a command that may be sent twice without harm: it sets what it sets.
    pub fn tell_again(&mut self, packet: &[u8]) -> Result<(), Lost> {
        self.again(|line| line.tell(packet))
    }

    /// Ask; the answer is `N` bytes and their CRC. Repeated when it is lost: asking changes nothing.
    pub fn ask<const N: usize>(&mut self, question: [u8; 2]) -> Result<[u8; N], Lost> {
        self.again(|line| line.ask_once(question))
    }

    /// Ask once: for what can wait for its next turn, and must not keep a command waiting meanwhile.
    pub fn ask_if_well<const N: usize>(&mut self, question: [u8; 2]) -> Result<[u8; N], Lost> {
        self.ask_once(question)
    }

    /// Ask for a text that ends in a zero byte.
    pub fn ask_text(&mut self, question: [u8; 2]) -> Result<String, Lost> {
        self.again(|line| line.ask_text_once(question))
    }

    fn again<T>(&mut self, mut exchange: impl FnMut(&mut Self) -> Result<T, Lost>) -> Result<T, Lost> {
        for _ in 1..TRIES {
            match exchange(self) {
                Err(Lost::Silent { .. } | Lost::Garbled { .. }) => self.tally.repeated += 1,
                outcome => return outcome,
            }
        }
        exchange(self)
    }

    fn ask_once<const N: usize>(&mut self, question: [u8; 2]) -> Result<[u8; N], Lost> {
        let mut answer = [0; MOST_ANSWER];
        let answer = &mut answer[..N + CRC_BYTES];
        self.exchange(&question, answer)?;
        self.judge(question[1], is_whole(question, answer))?;
        let mut data = [0; N];
        data.copy_from_slice(&answer[..N]);
        Ok(data)
    }

    fn ask_text_once(&mut self, question: [u8; 2]) -> Result<String, Lost> {
        self.begin(&question)?;
        let deadline = self.deadline(question.len() + MOST_TEXT);
        let mut answer = Vec::with_capacity(MOST_TEXT);
        let end = loop {
            if let Some(zero) = answer.iter().position(|byte| *byte == 0)
                && answer.len() >= zero + 1 + CRC_BYTES
            {
                break zero + 1 + CRC_BYTES;
            }
            let mut bytes = [0; MOST_TEXT];
            let room = MOST_TEXT - answer.len();
            match self.receive(&mut bytes[..room], deadline)? {
                0 => return Err(self.silent(question[1], answer.len(), MOST_TEXT)),
                count => answer.extend_from_slice(&bytes[..count]),
            }
        };
        self.judge(question[1], end == answer.len() && is_whole(question, &answer))?;
        Ok(String::from_utf8_lossy(&answer[..end - CRC_BYTES - 1]).trim().to_owned())
    }

    /// Fill the answer, or leave the line to be cleaned.
    fn exchange(&mut self, packet: &[u8], answer: &mut [u8]) -> Result<(), Lost> {
        self.begin(packet)?;
        let deadline = self.deadline(packet.len() + answer.len());
        let mut got = 0;
        while got < answer.len() {
            match self.receive(&mut answer[got..], deadline)? {
                0 => return Err(self.silent(packet[1], got, answer.len())),
                count => got += count,
            }
        }
        Ok(())
    }

    fn begin(&mut self, packet: &[u8]) -> Result<(), Lost> {
        if !self.is_clean {
            self.clean()?;
        }
        self.is_clean = false;
        self.port.send(packet)?;
        self.tally.bytes += packet.len() as u64;
        Ok(())
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

    /// Wait until nothing has come for longer than the board keeps half a packet.
    fn clean(&mut self) -> Result<(), Lost> {
        let give_up = self.port.now() + LONGEST_CLEANING;
        let mut quiet_at = self.port.now() + QUIET;
        let mut rubbish = [0; 256];
        while self.port.now() < quiet_at && self.port.now() < give_up {
            if self.port.receive(&mut rubbish, quiet_at)? > 0 {
                quiet_at = self.port.now() + QUIET;
            }
        }
        self.is_clean = true;
        Ok(())
    }

    fn deadline(&self, bytes: usize) -> Instant {
        self.port.now() + self.byte_time * bytes as u32 + TURNAROUND
    }

    fn judge(&mut self, command: u8, is_good: bool) -> Result<(), Lost> {
        self.is_clean = is_good;
        if is_good {
            self.tally.answered += 1;
            return Ok(());
        }
        self.tally.lost += 1;
        Err(Lost::Garbled { command })
    }

    fn silent(&mut self, command: u8, got: usize, expected: usize) -> Lost {
        self.tally.lost += 1;
        let within = self.byte_time * expected as u32 + TURNAROUND;
        Lost::Silent { command, got, expected, within }
    }
}

/// Whether an answer ends in the CRC of question and data.
fn is_whole(question: [u8; 2], answer: &[u8]) -> bool {
    let (data, crc) = answer.split_at(answer.len() - CRC_BYTES);
    crc16_on(crc16(&question), data).to_be_bytes() == crc
}

const ACKNOWLEDGED: u8 = 0xFF;
const CRC_BYTES: usize = 2;
/// A firmware text has at most 48 bytes (manual, command 21).
const MOST_TEXT: usize = 48 + CRC_BYTES;
const MOST_ANSWER: usize = 16 + CRC_BYTES;
/// How often a safe exchange is tried.
const TRIES: u32 = 3;
/// Beyond the time that the bytes take on the line: the board's own, and the adapter's (a USB converter holds bytes back for up to 16 ms
/// unless it is told otherwise; the README says how).
const TURNAROUND: Duration = Duration::from_millis(20);
/// Longer than the 10 ms after which a board forgets half a packet.
const QUIET: Duration = Duration::from_millis(12);
/// A line that never is quiet is given up on.
const LONGEST_CLEANING: Duration = Duration::from_millis(200);

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;

    use super::*;
    use crate::roboclaw::packet::{Command, Packet};

    /// Answers each packet with what was prepared, in chunks as they were prepared.
    #[derive(Default)]
    struct Script {
        sent: Vec<Vec<u8>>,
        answers: VecDeque<Vec<Vec<u8>>>,
        on_line: VecDeque<Vec<u8>>,
    }

    impl Port for Script {
        fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
            self.sent.push(bytes.to_vec());
            self.on_line.extend(self.answers.pop_front().unwrap_or_default());
            Ok(())
        }

        fn receive(&mut self, into: &mut [u8], deadline: Instant) -> io::Result<usize> {
            let Some(mut chunk) = self.on_line.pop_front() else {
                // A line with nothing on it: the time until the deadline passes.
                std::thread::sleep(deadline.saturating_duration_since(Instant::now()));
                return Ok(0);
            };
            let count = chunk.len().min(into.len());
            into[..count].copy_from_slice(&chunk[..count]);
            let rest = chunk.split_off(count);
            if !rest.is_empty() {
                self.on_line.push_front(rest);
            }
            Ok(count)
        }
    }

    fn line(answers: impl IntoIterator<Item = Vec<Vec<u8>>>) -> Line<Script> {
        Line::new(Script { answers: answers.into_iter().collect(), ..Script::default() }, 460_800)
    }

    fn answer(question: [u8; 2], data: &[u8]) -> Vec<u8> {
        let mut whole = data.to_vec();
        whole.extend(crc16_on(crc16(&question), data).to_be_bytes());
        whole
    }

    fn volts() -> [u8; 2] {
        Packet::to(0x80, Command::ReadMainVolts).question()
    }

    #[test]
    fn an_answer_in_pieces_is_one_answer() {
        let whole = answer(volts(), &[0, 240]);
        let mut line = line([whole.iter().map(|byte| vec![*byte]).collect()]);
        assert_eq!(line.ask::<2>(volts()).unwrap(), [0, 240]);
        assert_eq!(line.tally, Tally { answered: 1, bytes: 2 + 4, ..Tally::default() });
    }

    #[test]
    fn a_lost_or_garbled_answer_is_asked_for_again_and_a_late_one_is_thrown_away() {
        let mut garbled = answer(volts(), &[0, 240]);
        garbled[1] ^= 4;
        let late = answer(volts(), &[0, 111]);
        let mut line = line([vec![garbled, late], vec![answer(volts(), &[0, 241])]]);
        assert_eq!(line.ask::<2>(volts()).unwrap(), [0, 241]);
        assert_eq!(line.tally, Tally { answered: 1, lost: 1, repeated: 1, bytes: 2 * (2 + 4) });
    }

    #[test]
    fn a_motion_is_sent_once_and_a_setting_until_it_is_acknowledged() {
        let packet = Packet::to(0x80, Command::SpeedAccelM1).long(1).signed(1).sealed();
        let mut once = line([vec![]]);
        assert!(matches!(once.tell(&packet), Err(Lost::Silent { command: 38, got: 0, .. })));
        assert_eq!(once.port.sent.len(), 1);
        let mut twice = line([vec![], vec![vec![0xFF]]]);
        twice.tell_again(&packet).unwrap();
        assert_eq!(twice.port.sent.len(), 2);
    }

    #[test]
    fn after_three_tries_it_says_so() {
        let mut line = line([]);
        assert!(matches!(line.ask::<2>(volts()), Err(Lost::Silent { command: 24, .. })));
        assert_eq!(line.tally, Tally { answered: 0, lost: 3, repeated: 2, bytes: 3 * 2 });
    }

    #[test]
    fn a_text_ends_in_zero_and_has_its_crc() {
        let question = Packet::to(0x80, Command::ReadFirmware).question();
        let mut line = line([vec![answer(question, b"USB Roboclaw 2x30a v4.1.34\n\0")]]);
        assert_eq!(line.ask_text(question).unwrap(), "USB Roboclaw 2x30a v4.1.34");
    }
}
