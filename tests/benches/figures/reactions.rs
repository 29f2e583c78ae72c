//! From each cause of a stop to the first braking command. The lanes are measured through the real server under load;
//! the rules on virtual time, where the cause comes at a random moment of a control period and steps begin in time.

mod lanes;
mod rules;

use crate::Effort;
use crate::samples::Samples;
use crate::table::Row;

/// Every row.
pub async fn measure(effort: Effort) -> Vec<Row> {
    let mut rows = lanes::measure(effort).await;
    rows.extend(rules::measure(effort));
    rows
}

/// One row: samples in microseconds, and what the cause's own rule allows.
fn row(cause: &str, took: &Samples, limit_micros: f64, limit: &str, how: String) -> Row {
    let [median, p999, greatest] = [0.5, 0.999, 1.0].map(|share| took.percentile(share));
    Row {
        what: format!("reaction to {cause}"),
        figure: format!("median {median:.0} us, 99.9th percentile {p999:.0} us, greatest {greatest:.0} us"),
        beside: String::new(),
        ratio: format!("{:.2} of the limit", p999 / limit_micros),
        limit: format!("99.9th percentile within {limit} = {limit_micros:.0} us"),
        met: Some(p999 <= limit_micros),
        how,
    }
}
