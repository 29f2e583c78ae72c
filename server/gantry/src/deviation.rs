//! How far each axis is from a setpoint: what the position loop of every host here begins with.

use covr_engine::machine::MachineReport;
use covr_engine::safety::vetted::Setpoint;
use covr_engine::time::Time;

/// One axis at this moment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Deviation {
    /// The setpoint's velocity, m/s.
    pub velocity_mps: f64,
    /// The setpoint's acceleration, m/s2.
    pub acceleration_mps2: f64,
    /// The measured velocity, m/s.
    pub measured_mps: f64,
    /// From the measured place to the setpoint's, both carried on to now, m.
    pub error_m: f64,
    /// How old the setpoint is, s; at most as long as it is valid.
    pub since_vetted_secs: f64,
}

/// Of x and y at `now`, for a setpoint vetted at `vetted_at`.
pub(crate) fn deviations(
    now: Time,
    vetted_at: Time,
    setpoint: &Setpoint,
    report: &MachineReport,
) -> [Deviation; 2] {
    let valid_secs = setpoint.valid_for.secs().max(0.0);
    let since_vetted_secs = (now - vetted_at).secs().clamp(0.0, valid_secs);
    let since_report_secs = (now - report.answered_at).secs().clamp(0.0, valid_secs);
    let axes = [
        (setpoint.position.x, setpoint.velocity.x, setpoint.acceleration.x),
        (setpoint.position.y, setpoint.velocity.y, setpoint.acceleration.y),
    ];
    let measured = [(report.position.x, report.velocity.x), (report.position.y, report.velocity.y)];
    [0, 1].map(|i| {
        let (position_m, velocity_mps, acceleration_mps2) = axes[i];
        let (measured_m, measured_mps) = measured[i];
        let reference_m =
            position_m + (velocity_mps + 0.5 * acceleration_mps2 * since_vetted_secs) * since_vetted_secs;
        let error_m = reference_m - (measured_m + measured_mps * since_report_secs);
        Deviation { velocity_mps, acceleration_mps2, measured_mps, error_m, since_vetted_secs }
    })
}
