//! Real-time scheduling and locked memory, where permitted; in plain words what came of it.

use nix::sys::mman::{MlockAllFlags, mlockall};
use nix::sys::resource::{RLIM_INFINITY, Resource, getrlimit};
use thread_priority::{
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
    set_thread_priority_and_policy, thread_native_id,
};

/// Ask for both for the calling thread.
pub fn ask(priority: Option<u8>) -> String {
    let Some(priority) = priority else {
        return "normal scheduling, memory not locked (control.real_time is false)".into();
    };
    let scheduling = match fifo(priority) {
        Ok(()) => format!("SCHED_FIFO priority {priority}"),
        Err(why) => format!("normal scheduling (SCHED_FIFO not permitted: {why})"),
    };
    format!("{scheduling}, {}", locked_memory())
}

/// Future memory is locked only without a limit: with one, a later allocation would fail for being over it.
fn locked_memory() -> String {
    let unlimited = getrlimit(Resource::RLIMIT_MEMLOCK).is_ok_and(|(soft, _)| soft == RLIM_INFINITY);
    let flags = if unlimited {
        MlockAllFlags::MCL_CURRENT | MlockAllFlags::MCL_FUTURE
    } else {
        MlockAllFlags::MCL_CURRENT
    };
    match mlockall(flags) {
        Ok(()) if unlimited => "memory locked".into(),
        Ok(()) => "present memory locked, future memory not (RLIMIT_MEMLOCK is limited)".into(),
        Err(why) => format!("memory not locked ({})", why.desc()),
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
