//! `covr identify`: an axis's inertia, friction and delays from a recorded run.

use std::fmt::Write;
use std::path::PathBuf;

use anyhow::{Context, bail};
use clap::Args;
use covr_gantry::identify::{AxisModel, Delays, Sample, delays, identify};
use serde_json::json;

/// Identify an axis: inertia, friction, limits and delays from a recorded run of steps and chirps of its speed.
#[derive(Debug, Clone, Args)]
pub struct Identify {
    /// The run of one axis: CSV with the columns t_secs, command_mps, position_m and current_amps, in any order.
    pub file: PathBuf,
    /// Current limit that the limits are worked out for, A.
    #[arg(long, default_value_t = 5.0, value_parser = amps)]
    pub current_limit: f64,
    /// Say it as JSON.
    #[arg(long)]
    pub json: bool,
}

/// What was found, in words or as JSON.
pub fn run(options: &Identify) -> anyhow::Result<String> {
    let name = options.file.display();
    let text = std::fs::read_to_string(&options.file).with_context(|| name.to_string())?;
    let samples = read(&text).with_context(|| name.to_string())?;
    let model = identify(&samples).with_context(|| name.to_string())?;
    let delays = delays(&samples);
    Ok(if options.json {
        as_json(&model, &delays, options.current_limit)
    } else {
        in_words(&model, &delays, options.current_limit)
    })
}

/// Lines of a run; a refusal names line, column, what was found and what was expected.
fn read(text: &str) -> anyhow::Result<Vec<Sample>> {
    let mut lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
    let Some((_, header)) = lines.next() else {
        bail!("found nothing, expected a line with the columns {}", COLUMNS.join(", "));
    };
    let names: Vec<&str> = header.split(',').map(|name| name.trim().trim_matches('"')).collect();
    let mut places = [0; COLUMNS.len()];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        *place = names
            .iter()
            .position(|name| *name == column)
            .with_context(|| format!("line 1: found the columns {header}, expected {column} among them"))?;
    }
    let mut samples = Vec::new();
    for (number, line) in lines {
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        let mut values = [0.0; COLUMNS.len()];
        for ((value, place), column) in values.iter_mut().zip(places).zip(COLUMNS) {
            let found = fields.get(place).copied().unwrap_or_default();
            let read = found.parse::<f64>().ok().filter(|number| number.is_finite());
            *value = read
                .with_context(|| format!("line {number}, {column}: found \"{found}\", expected a number"))?;
        }
        let [at_secs, command_mps, position_m, current_amps] = values;
        if let Some(Sample { at_secs: before, .. }) = samples.last()
            && at_secs <= *before
        {
            bail!("line {number}, t_secs: found {at_secs}, expected more than {before} of the line before");
        }
        samples.push(Sample { at_secs, command_mps, position_m, current_amps });
    }
    Ok(samples)
}

fn in_words(model: &AxisModel, delays: &Delays, limit_amps: f64) -> String {
    let [inertia_sd, viscous_sd, coulomb_sd] = model.sd;
    let fast = model.fastest_mps;
    let mut words = String::new();
    let mut say = |line: String| {
        let _ = writeln!(words, "{line}");
    };
    say(format!("inertia            {:.4} ± {inertia_sd:.4} A/(m/s²)", model.inertia));
    say(format!("viscous friction   {:.4} ± {viscous_sd:.4} A/(m/s)", model.viscous));
    say(format!("Coulomb friction   {:.4} ± {coulomb_sd:.4} A", model.coulomb_amps));
    say(format!(
        "left by the model  {:.3} A rms, over {} windows up to {fast:.2} m/s",
        model.rms_amps, model.windows
    ));
    say(format!("at {limit_amps} A"));
    say(format!(
        "  acceleration     {:.2} m/s² from rest, {:.2} at {fast:.2} m/s",
        model.acceleration_mps2(limit_amps, 0.0),
        model.acceleration_mps2(limit_amps, fast)
    ));
    say(format!(
        "  braking          {:.2} m/s² near rest, {:.2} at {fast:.2} m/s, friction helping",
        model.braking_mps2(limit_amps, 0.0),
        model.braking_mps2(limit_amps, fast)
    ));
    say(format!(
        "  speed            {:.2} m/s, where friction takes all of it; the supply may end it sooner",
        model.speed_limit_mps(limit_amps)
    ));
    let millis =
        |secs: Option<f64>| secs.map_or("not seen in this run".into(), |s| format!("{:.1} ms", s * 1e3));
    say(format!(
        "command to current {} (link both ways and board; {} steps)",
        millis(delays.command_to_current_secs),
        delays.steps
    ));
    say(format!(
        "command to motion  {} (with the board's ramp and the axis's lag; likeness {:.3})",
        millis(delays.command_to_motion_secs),
        delays.likeness
    ));
    words
}

fn as_json(model: &AxisModel, delays: &Delays, limit_amps: f64) -> String {
    let finite = |number: f64| number.is_finite().then_some(number);
    let found = json!({
        "inertia_amps_per_mps2": model.inertia,
        "viscous_amps_per_mps": model.viscous,
        "coulomb_amps": model.coulomb_amps,
        "sd": model.sd,
        "rms_amps": model.rms_amps,
        "windows": model.windows,
        "fastest_mps": model.fastest_mps,
        "current_limit_amps": limit_amps,
        "acceleration_mps2": model.acceleration_mps2(limit_amps, 0.0),
        "braking_mps2": model.braking_mps2(limit_amps, 0.0),
        "speed_limit_mps": finite(model.speed_limit_mps(limit_amps)),
        "command_to_current_secs": delays.command_to_current_secs,
        "command_to_motion_secs": delays.command_to_motion_secs,
        "likeness": delays.likeness,
    });
    format!("{found:#}\n")
}

fn amps(text: &str) -> Result<f64, String> {
    let limit: f64 = text.parse().map_err(|_| "expected a number".to_owned())?;
    if limit > 0.0 && limit <= 100.0 { Ok(limit) } else { Err("expected more than 0 A, at most 100".into()) }
}

const COLUMNS: [&str; 4] = ["t_secs", "command_mps", "position_m", "current_amps"];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_come_in_any_order_and_others_are_passed_over() {
        let text =
            "position_m, t_secs,note,current_amps,command_mps\n0.5,0.1,x,1.25,0.3\n\n0.6,0.2,y,1.5,0.3\n";
        let samples = read(text).unwrap();
        assert_eq!(samples.len(), 2);
        assert_eq!(
            samples[0],
            Sample { at_secs: 0.1, command_mps: 0.3, position_m: 0.5, current_amps: 1.25 }
        );
    }

    #[test]
    fn what_is_wrong_is_named_by_line_and_column() {
        let head = "t_secs,command_mps,position_m,current_amps\n";
        let why = |text: &str| read(text).unwrap_err().to_string();
        assert!(why("").contains("expected a line with the columns"));
        assert!(why("t_secs,command_mps\n").contains("expected position_m among them"));
        assert_eq!(
            why(&format!("{head}0.1,0,0,0\n0.2,0,fast,0\n")),
            "line 3, position_m: found \"fast\", expected a number"
        );
        assert!(why(&format!("{head}0.1,0,0\n")).contains("line 2, current_amps: found \"\""));
        assert!(why(&format!("{head}0.1,0,0,0\n0.1,0,0,0\n")).contains("line 3, t_secs: found 0.1"));
    }

    #[test]
    fn a_run_of_a_known_axis_is_told_in_words_and_as_json() {
        // 0.9 A/(m/s2), 0.2 A/(m/s), 0.7 A; the axis follows its command exactly.
        let mut text = "t_secs,command_mps,position_m,current_amps\n".to_owned();
        for n in 0..2_000 {
            let t = f64::from(n) * 0.005;
            let (w, a) = (std::f64::consts::TAU * 0.4, 0.5);
            let (v, acc, x) = (a * (w * t).sin(), a * w * (w * t).cos(), -a / w * (w * t).cos());
            let amps: f64 = 0.9 * acc + 0.2 * v + 0.7 * v.signum();
            let _ = writeln!(text, "{t},{v},{x},{amps}");
        }
        let samples = read(&text).unwrap();
        let model = identify(&samples).unwrap();
        let words = in_words(&model, &delays(&samples), 5.0);
        assert!(
            words.contains("inertia            0.9") || words.contains("inertia            0.89"),
            "{words}"
        );
        assert!(words.contains("acceleration     4.7"), "{words}");
        let found: serde_json::Value =
            serde_json::from_str(&as_json(&model, &delays(&samples), 5.0)).unwrap();
        assert!((found["coulomb_amps"].as_f64().unwrap() - 0.7).abs() < 0.01, "{found}");
        assert!(found["command_to_motion_secs"].as_f64().unwrap().abs() < 0.004, "{found}");
    }
}
