//! Real-time scheduling and locked memory, where permitted, and what came of it.

use covr_wire::reason::Reason;
use nix::sys::mman::{MlockAllFlags, mlockall};
use nix::sys::resource::{RLIM_INFINITY, Resource, getrlimit};
use thread_priority::{
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
    set_thread_priority_and_policy, thread_native_id,
};

/// Ask for both for the calling thread.
pub fn ask(priority: Option<u8>) -> Vec<Reason> {
    let Some(priority) = priority else {
        return vec![Reason::RealTimeNotAsked];
    };
    let scheduling = match fifo(priority) {
        Ok(()) => Reason::RealTime { priority },
        Err(said) => Reason::RealTimeRefused { said },
    };
    vec![scheduling, locked_memory()]
}

/// Future memory is locked only without a limit: with one, a later allocation would fail for being over it.
fn locked_memory() -> Reason {
    let unlimited = getrlimit(Resource::RLIMIT_MEMLOCK).is_ok_and(|(soft, _)| soft == RLIM_INFINITY);
    let flags = if unlimited {
        MlockAllFlags::MCL_CURRENT | MlockAllFlags::MCL_FUTURE
    } else {
        MlockAllFlags::MCL_CURRENT
    };
    match mlockall(flags) {
        Ok(()) if unlimited => Reason::MemoryLocked,
        Ok(()) => Reason::MemoryLockedForNow,
        Err(why) => Reason::MemoryNotLocked { said: why.desc().into() },
    }
}

fn fifo(priority: u8) -> Result<(), String> {
    let value = ThreadPriorityValue::try_from(priority).map_err(|why| format!("{why:?}"))?;
    set_thread_priority_and_policy(
        thread_native_id(),
        ThreadPriority::Crossplatform(value),
        ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo),
    )
    .map_err(|why| format!("{why:?}"))
}
