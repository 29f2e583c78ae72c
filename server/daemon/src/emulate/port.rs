//! The pseudo-terminal that the boards are on.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Read, Write};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::fs::{OpenOptionsExt, symlink};
use std::path::{Path, PathBuf};

use anyhow::Context;
use nix::fcntl::OFlag;
use nix::libc::O_NOCTTY;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::pty::{PtyMaster, grantpt, posix_openpt, ptsname_r, unlockpt};
use nix::sys::termios::{FlushArg, SetArg, cfmakeraw, tcflush, tcgetattr, tcsetattr};

/// A pseudo-terminal, with the link to it.
#[derive(Debug)]
pub struct Port {
    master: PtyMaster,
    path: PathBuf,
    link: Option<PathBuf>,
    is_open: bool,
}

impl Port {
    /// A new one; `link` points to it while it is there. A link that is left from before is replaced, a file is not.
    pub fn new(link: Option<&Path>) -> anyhow::Result<Self> {
        let master = posix_openpt(OFlag::O_RDWR | OFlag::O_NOCTTY | OFlag::O_NONBLOCK | OFlag::O_CLOEXEC)
            .context("a pseudo-terminal")?;
        grantpt(&master).context("a pseudo-terminal")?;
        unlockpt(&master).context("a pseudo-terminal")?;
        let path = PathBuf::from(ptsname_r(&master).context("a pseudo-terminal's name")?);
        make_raw(&path).with_context(|| path.display().to_string())?;
        if let Some(link) = link {
            point(link, &path).with_context(|| format!("--link {}", link.display()))?;
        }
        Ok(Self { master, path, link: link.map(Path::to_owned), is_open: false })
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether somebody has it open now. What nobody has read is gone when the last one closes it, as on a real port.
    pub fn look(&mut self) -> std::io::Result<bool> {
        let mut looks = [PollFd::new(self.master.as_fd(), PollFlags::empty())];
        poll(&mut looks, PollTimeout::ZERO)?;
        let is_hung_up = looks[0].revents().is_some_and(|events| events.contains(PollFlags::POLLHUP));
        if self.is_open && is_hung_up {
            tcflush(&self.master, FlushArg::TCIOFLUSH)?;
        }
        self.is_open = !is_hung_up;
        Ok(self.is_open)
    }

    /// To wait on.
    pub fn fd(&self) -> BorrowedFd<'_> {
        self.master.as_fd()
    }

    /// What the other side has written.
    pub fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        or_nothing(self.master.read(bytes))
    }

    /// For the other side; what it has no room for is lost, as on a port without flow control.
    pub fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        or_nothing(self.master.write(bytes))
    }
}

impl Drop for Port {
    fn drop(&mut self) {
        if let Some(link) = &self.link
            && std::fs::read_link(link).is_ok_and(|target| target == self.path)
        {
            // Somebody may have taken it away.
            let _ = std::fs::remove_file(link);
        }
    }
}

/// The other side is not there, or has nothing: that is no error.
fn or_nothing(done: std::io::Result<usize>) -> std::io::Result<usize> {
    match done {
        Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => Ok(0),
        // EIO: nobody has it open.
        Err(error) if error.raw_os_error() == Some(nix::libc::EIO) => Ok(0),
        done => done,
    }
}

/// No echo and no lines, for hosts that do not say so themselves: like a serial port that a driver has set up.
fn make_raw(path: &Path) -> std::io::Result<()> {
    let other_side = OpenOptions::new().read(true).write(true).custom_flags(O_NOCTTY).open(path)?;
    let mut settings = tcgetattr(&other_side)?;
    cfmakeraw(&mut settings);
    tcsetattr(&other_side, SetArg::TCSANOW, &settings)?;
    Ok(())
}

fn point(link: &Path, to: &Path) -> std::io::Result<()> {
    match std::fs::symlink_metadata(link) {
        Ok(there) if there.is_symlink() => std::fs::remove_file(link)?,
        Ok(_) => {
            return Err(std::io::Error::new(
                ErrorKind::AlreadyExists,
                "found a file, expected a link or nothing",
            ));
        }
        Err(_) => {}
    }
    symlink(to, link)
}
