//! What an answer about a recording is made of.

use std::io::Write;
use std::sync::Arc;

use anyhow::Context;
use covr_wire::records::{RecordedFrame, RecordedPerson, SessionDetail};
use serde::Serialize;
use serde_json::json;

use super::stream::{Frames, Pieces, Stretch};
use crate::app::App;

/// `{"frames": [...]}`.
pub async fn frames(app: Arc<App>, session: i64, stretch: Stretch, pieces: Pieces) -> anyhow::Result<()> {
    pieces.give("{\"frames\":").await?;
    give_frames(&app, session, stretch, &pieces).await?;
    pieces.give("}").await?;
    Ok(())
}

/// `[...]`, oldest first.
pub async fn events(app: Arc<App>, session: i64, pieces: Pieces) -> anyhow::Result<()> {
    give_events(&app, session, &pieces).await
}

/// Everything in one document.
pub async fn json(app: Arc<App>, session: SessionDetail, pieces: Pieces) -> anyhow::Result<()> {
    pieces.give(format!("{{\"session\":{},\"scenes\":[", serde_json::to_string(&session)?)).await?;
    for (i, scene) in session.scenes.iter().enumerate() {
        let stored = app.store.scene(scene.id, Some(scene.version)).await?;
        let stored = stored.with_context(|| format!("scene {} version {}", scene.id, scene.version))?;
        let told = json!({ "id": scene.id, "version": scene.version, "from_secs": scene.from_secs,
            "document": stored.document });
        pieces.give(format!("{}{told}", comma(i))).await?;
    }
    pieces.give("],\"events\":").await?;
    give_events(&app, session.session.id, &pieces).await?;
    pieces.give(",\"frames\":").await?;
    give_frames(&app, session.session.id, Stretch::ALL, &pieces).await?;
    pieces.give("}\n").await?;
    Ok(())
}

/// One row per frame and person.
pub async fn csv(app: Arc<App>, session: SessionDetail, pieces: Pieces) -> anyhow::Result<()> {
    pieces.give(format!("{HEADER}\r\n")).await?;
    let start = session.first_micros.unwrap_or(0);
    let mut recording = Frames::new(app.store.clone(), session.session.id, Stretch::ALL);
    let rows = move |frames: Vec<RecordedFrame>| {
        let mut rows = Vec::new();
        for frame in &frames {
            if frame.persons.is_empty() {
                write_row(&mut rows, frame, None, start)?;
            }
            for person in &frame.persons {
                write_row(&mut rows, frame, Some(person), start)?;
            }
        }
        Ok(rows)
    };
    while let Some(rows) = recording.next(rows).await? {
        pieces.give(rows).await?;
    }
    Ok(())
}

async fn give_events(app: &App, session: i64, pieces: &Pieces) -> anyhow::Result<()> {
    pieces.give("[").await?;
    let mut after = 0;
    let mut given = 0;
    loop {
        let page = app.store.session_events(session, after, EVENTS_AT_ONCE).await?;
        let Some((last, _)) = page.last() else { break };
        after = *last;
        let mut text = Vec::new();
        write_list(&mut text, page.iter().map(|(_, event)| event), &mut given)?;
        pieces.give(text).await?;
    }
    pieces.give("]").await?;
    Ok(())
}

async fn give_frames(app: &App, session: i64, stretch: Stretch, pieces: &Pieces) -> anyhow::Result<()> {
    pieces.give("[").await?;
    let mut recording = Frames::new(app.store.clone(), session, stretch);
    let mut given = 0;
    loop {
        let before = given;
        let text = move |frames: Vec<RecordedFrame>| {
            let (mut text, mut given) = (Vec::new(), before);
            write_list(&mut text, frames.iter(), &mut given)?;
            Ok((text, given))
        };
        let Some((text, so_far)) = recording.next(text).await? else { break };
        given = so_far;
        if !text.is_empty() {
            pieces.give(text).await?;
        }
    }
    pieces.give("]").await?;
    Ok(())
}

/// Items of a JSON list of which `given` were written before.
fn write_list<'a, T: Serialize + 'a>(
    text: &mut Vec<u8>,
    items: impl Iterator<Item = &'a T>,
    given: &mut usize,
) -> anyhow::Result<()> {
    for item in items {
        text.write_all(comma(*given).as_bytes())?;
        serde_json::to_writer(&mut *text, item)?;
        *given += 1;
    }
    Ok(())
}

fn comma(before: usize) -> &'static str {
    if before == 0 { "" } else { "," }
}

/// A row in the order of [`HEADER`].
fn write_row(
    rows: &mut Vec<u8>,
    frame: &RecordedFrame,
    person: Option<&RecordedPerson>,
    start_micros: i64,
) -> anyhow::Result<()> {
    let column = &frame.column;
    let likeliest = frame.objects.iter().max_by(|a, b| a.probability.total_cmp(&b.probability));
    let likeliest = likeliest.filter(|object| object.probability > 0.0);
    let pair =
        |at: Option<[f64; 2]>| at.map_or([String::new(), String::new()], |at| at.map(|v| v.to_string()));
    let mut cells = vec![
        format!("{:.6}", (frame.at_micros - start_micros) as f64 * 1e-6),
        frame.at_micros.to_string(),
        name(&frame.mode)?,
        name(&column.activity)?,
    ];
    let places = [column.position_m, column.velocity_mps, column.commanded_m, column.proxy_m].map(Some);
    cells.extend(places.into_iter().chain([column.target_m]).flat_map(pair));
    cells.extend([
        column.serves.map(|id| id.to_string()).unwrap_or_default(),
        text(column.committed.as_deref().unwrap_or_default()),
        text(likeliest.map_or("", |object| &object.id)),
        likeliest.map(|object| object.probability.to_string()).unwrap_or_default(),
    ]);
    match person {
        None => cells.extend(std::iter::repeat_n(String::new(), PERSON_CELLS)),
        Some(person) => {
            let head = person.head_m.map_or([const { String::new() }; 3], |at| at.map(|v| v.to_string()));
            cells.extend([person.id.to_string(), text(&person.name)].into_iter().chain(head));
            let numbers = [person.yaw_rad, person.pitch_rad];
            cells.extend(numbers.map(|v| v.to_string()));
            cells.push(person.tracked.to_string());
            let numbers = [person.separation_radius_m, person.distance_m, person.required_m];
            cells.extend(numbers.map(|v| v.to_string()));
        }
    }
    write!(rows, "{}\r\n", cells.join(","))?;
    Ok(())
}

/// The name of a mode or activity, as JSON has it.
fn name(value: &impl Serialize) -> anyhow::Result<String> {
    let value = serde_json::to_value(value)?;
    Ok(value.as_str().context("a name")?.to_owned())
}

/// A text cell: quoted where due, and with an apostrophe before what a spreadsheet would run as a formula.
fn text(words: &str) -> String {
    let formula = words.starts_with(['=', '+', '-', '@', '\t', '\r']);
    let words = if formula { format!("'{words}") } else { words.to_owned() };
    if words.contains(['"', ',', '\n', '\r']) || words.starts_with(' ') || words.ends_with(' ') {
        format!("\"{}\"", words.replace('"', "\"\""))
    } else {
        words
    }
}

const HEADER: &str = "time_s,at_micros,mode,activity,column_x_m,column_y_m,column_vx_mps,column_vy_mps,\
commanded_x_m,commanded_y_m,proxy_x_m,proxy_y_m,target_x_m,target_y_m,serves_person,committed_object,\
likeliest_object,likeliest_probability,person,person_name,head_x_m,head_y_m,head_z_m,yaw_rad,pitch_rad,tracked,\
separation_radius_m,distance_m,required_m";
/// Cells of a row that are about a person.
const PERSON_CELLS: usize = 11;
const EVENTS_AT_ONCE: u32 = 500;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::chunk::tests::frame;

    #[test]
    fn every_row_has_the_headers_columns() {
        let columns = HEADER.split(',').count();
        let mut rows = Vec::new();
        let with = frame(3, 2, 4);
        write_row(&mut rows, &with, Some(&with.persons[1]), 5_000_000).unwrap();
        write_row(&mut rows, &frame(0, 0, 0), None, 5_000_000).unwrap();
        let rows = String::from_utf8(rows).unwrap();
        for row in rows.trim_end().split("\r\n") {
            assert_eq!(row.split(',').count(), columns, "{row}");
        }
        assert!(rows.starts_with("0.099999,5099999,following,approaching,"), "{rows}");
    }

    #[test]
    fn text_is_quoted_where_due_and_no_formula() {
        assert_eq!(text("lamp"), "lamp");
        assert_eq!(text("lamp, \"big\""), "\"lamp, \"\"big\"\"\"");
        assert_eq!(text("=1+1"), "'=1+1");
        assert_eq!(text("@a,b"), "\"'@a,b\"");
    }
}
