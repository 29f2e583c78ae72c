//! The line to a board, as the driver needs it.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use serial2::SerialPort;

/// Bytes out, bytes in until a deadline.
pub trait Port: Send {
    /// The time that its deadlines are in.
    fn now(&self) -> Instant {
        Instant::now()
    }

    /// Send all of it.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Whatever has come, waiting for the first byte until the deadline at most; 0: nothing came. A line that is gone is an error.
    fn receive(&mut self, into: &mut [u8], deadline: Instant) -> io::Result<usize>;
}

/// A serial port, or a pseudo-terminal.
pub struct Serial {
    port: SerialPort,
}

impl Serial {
    /// Open it raw at this rate.
    pub fn open(path: &Path, baud: u32) -> io::Result<Self> {
        let mut port = SerialPort::open(path, baud)?;
        port.set_write_timeout(LONGEST_SEND)?;
        port.discard_buffers()?;
        Ok(Self { port })
    }
}

impl Port for Serial {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.port.write_all(bytes)
    }

    fn receive(&mut self, into: &mut [u8], deadline: Instant) -> io::Result<usize> {
        let left = deadline.saturating_duration_since(Instant::now()).max(Duration::from_millis(1));
        self.port.set_read_timeout(left)?;
        match self.port.read(into) {
            // A terminal whose other end is gone reads as ended.
            Ok(0) => Err(io::ErrorKind::UnexpectedEof.into()),
            Err(error) if error.kind() == io::ErrorKind::TimedOut => Ok(0),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => Ok(0),
            other => other,
        }
    }
}

/// A port whose buffer stays full for so long is stuck.
const LONGEST_SEND: Duration = Duration::from_millis(50);
