//! The server's two clocks: microseconds since its start for decisions, the wall clock for the record.

use std::time::{Duration, Instant, SystemTime};

use covr_engine::time::Time;

/// The server's monotonic clock.
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    started: Instant,
    started_wall: SystemTime,
}

impl Clock {
    /// A clock that starts now.
    pub fn started_now() -> Self {
        Self { started: Instant::now(), started_wall: SystemTime::now() }
    }

    /// The present moment.
    pub fn now(&self) -> Time {
        self.time_of(Instant::now())
    }

    /// A moment of the operating system's monotonic clock.
    pub fn time_of(&self, instant: Instant) -> Time {
        Time::from_micros(instant.saturating_duration_since(self.started).as_micros() as i64)
    }

    /// A moment on the operating system's monotonic clock; what was before the start becomes the start.
    pub fn instant_of(&self, time: Time) -> Instant {
        self.started + Duration::from_micros(time.micros().max(0) as u64)
    }

    /// The wall clock at a moment, RFC 3339.
    pub fn wall_text(&self, time: Time) -> String {
        let since = Duration::from_micros(time.micros().max(0) as u64);
        humantime::format_rfc3339_micros(self.started_wall + since).to_string()
    }
}

/// A time as in RFC 3339 the way that [`wall_now`] writes it, so that text sorts as time; none for what is no time.
pub fn wall_time(text: &str) -> Option<String> {
    humantime::parse_rfc3339(text).ok().map(|time| humantime::format_rfc3339_micros(time).to_string())
}

/// The wall clock now, RFC 3339.
pub fn wall_now() -> String {
    humantime::format_rfc3339_micros(SystemTime::now()).to_string()
}
