//! One line of a trace, parsed into a [`Recording`] or refused with the path of the first field that is wrong.
//! Keys that the format does not need are ignored: every data set carries some of its own.

use covr_engine::frames::Point;
use covr_engine::time::Time;
use serde_json::{Map, Value};

use super::{Arena, Frame, Heights, Moments, Recording, Target, Visit};

/// What is wrong with a line.
#[derive(Debug, PartialEq)]
pub(super) struct BadField {
    pub(super) field: String,
    pub(super) found: String,
    pub(super) expected: String,
}

/// Parse one line.
pub(super) fn recording(line: &str) -> Result<Recording, BadField> {
    let value: Value = serde_json::from_str(line).map_err(|error| BadField {
        field: format!("column {}", error.column()),
        found: error.to_string(),
        expected: "one JSON object".into(),
    })?;
    let root = Field { path: String::new(), value: &value };
    let fields = root.object()?;
    let text = |key: &str| fields.needed(key)?.text();
    let dataset = text("dataset")?;
    let targets = match fields.optional("targets") {
        Some(list) => list.items()?.iter().map(target).collect::<Result<Vec<_>, _>>()?,
        None => Vec::new(),
    };
    let columns = Columns::from_names(&fields.needed("cols")?)?;
    let heights = match (columns.z, dataset.as_str()) {
        (None, _) => Heights::Missing,
        (Some(_), "pearl") => Heights::UnknownOffset,
        (Some(_), _) => Heights::AboveFloor,
    };
    Ok(Recording {
        trial: text("trial")?,
        user: text("user")?,
        mode: fields.optional("mode").or_else(|| fields.optional("task")).map(|f| f.text()).transpose()?,
        arena: fields.optional("arena").map(|field| arena(&field)).transpose()?,
        goal: fields.optional("goal").map(|field| goal(&field, &targets)).transpose()?,
        events: fields.optional("events").map(|field| moments(&field)).transpose()?.unwrap_or_default(),
        visits: match fields.optional("visits") {
            Some(list) => list.items()?.iter().map(|v| visit(v, &targets)).collect::<Result<_, _>>()?,
            None => Vec::new(),
        },
        frames: frames(&fields.needed("frames")?, &columns)?,
        dataset,
        targets,
        heights,
    })
}

/// A JSON value and where it stands in the line.
struct Field<'a> {
    path: String,
    value: &'a Value,
}

struct Object<'a> {
    path: String,
    members: &'a Map<String, Value>,
}

/// At which index of a row each quantity stands.
struct Columns {
    count: usize,
    t: usize,
    x: usize,
    y: usize,
    z: Option<usize>,
    yaw: Option<usize>,
    pitch: Option<usize>,
    /// x, y and z of the left and of the right hand.
    hands: [Option<[usize; 3]>; 2],
}

impl<'a> Field<'a> {
    fn bad(&self, expected: impl Into<String>) -> BadField {
        let field = if self.path.is_empty() { "the line".into() } else { self.path.clone() };
        BadField { field, found: shown(self.value), expected: expected.into() }
    }

    fn object(&self) -> Result<Object<'a>, BadField> {
        let members = self.value.as_object().ok_or_else(|| self.bad("an object"))?;
        Ok(Object { path: self.path.clone(), members })
    }

    fn items(&self) -> Result<Vec<Field<'a>>, BadField> {
        let items = self.value.as_array().ok_or_else(|| self.bad("a list"))?;
        Ok((0..).zip(items).map(|(i, value)| Field { path: format!("{}[{i}]", self.path), value }).collect())
    }

    fn text(&self) -> Result<String, BadField> {
        self.value.as_str().map(str::to_owned).ok_or_else(|| self.bad("a string"))
    }

    fn number(&self) -> Result<f64, BadField> {
        self.value.as_f64().filter(|n| n.is_finite()).ok_or_else(|| self.bad("a finite number"))
    }
}

impl<'a> Object<'a> {
    fn path_of(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    fn needed(&self, key: &str) -> Result<Field<'a>, BadField> {
        let value = self.members.get(key).ok_or_else(|| BadField {
            field: self.path_of(key),
            found: "nothing".into(),
            expected: "this key".into(),
        })?;
        Ok(Field { path: self.path_of(key), value })
    }

    fn optional(&self, key: &str) -> Option<Field<'a>> {
        let value = self.members.get(key).filter(|value| !value.is_null())?;
        Some(Field { path: self.path_of(key), value })
    }
}

impl Columns {
    fn from_names(list: &Field<'_>) -> Result<Self, BadField> {
        let names = list.items()?.iter().map(Field::text).collect::<Result<Vec<_>, _>>()?;
        let at = |name: &str| names.iter().position(|n| n == name);
        let needed = |name: &str| at(name).ok_or_else(|| list.bad(format!("`{name}` among the columns")));
        let hand = |[x, y, z]: [&str; 3]| {
            let is_there = [x, y, z].iter().any(|name| at(name).is_some());
            is_there.then(|| Ok([needed(x)?, needed(y)?, needed(z)?])).transpose()
        };
        Ok(Self {
            count: names.len(),
            t: needed("t_ms")?,
            x: needed("x_mm")?,
            y: needed("y_mm")?,
            z: at("z_mm"),
            yaw: at("yaw_mrad"),
            pitch: at("pitch_mrad"),
            hands: [
                hand(["left_x_mm", "left_y_mm", "left_z_mm"])?,
                hand(["right_x_mm", "right_y_mm", "right_z_mm"])?,
            ],
        })
    }
}

fn frames(list: &Field<'_>, columns: &Columns) -> Result<Vec<Frame>, BadField> {
    let rows = list.value.as_array().ok_or_else(|| list.bad("a list"))?;
    if rows.is_empty() {
        return Err(list.bad("at least one frame"));
    }
    let mut frames: Vec<Frame> = Vec::with_capacity(rows.len());
    for (i, value) in rows.iter().enumerate() {
        let row = || Field { path: format!("{}[{i}]", list.path), value };
        let cells = value
            .as_array()
            .filter(|cells| cells.len() == columns.count)
            .ok_or_else(|| row().bad(format!("a row of {} numbers, as `cols` says", columns.count)))?;
        let milli = |column: usize| {
            let cell = &cells[column];
            let field = || Field { path: format!("{}[{i}][{column}]", list.path), value: cell };
            cell.as_f64()
                .filter(|n| n.is_finite())
                .map(|n| n * 1e-3)
                .ok_or_else(|| field().bad("a finite number"))
        };
        // A hand that is not tracked has no place: null in all three.
        let hand = |columns: [usize; 3]| {
            if columns.iter().all(|column| cells[*column].is_null()) {
                return Ok(None);
            }
            let [x, y, z] = columns.map(milli);
            Ok(Some(Point::new(x?, y?, z?)))
        };
        let place = |columns: Option<[usize; 3]>| columns.map_or(Ok(None), hand);
        let at = moment(milli(columns.t)?);
        if let Some(before) = frames.last().filter(|before| at <= before.at) {
            return Err(row().bad(format!("a time after {} ms", before.at.micros() / 1000)));
        }
        frames.push(Frame {
            at,
            x_m: milli(columns.x)?,
            y_m: milli(columns.y)?,
            z_m: columns.z.map(milli).transpose()?,
            yaw_rad: columns.yaw.map(milli).transpose()?,
            pitch_rad: columns.pitch.map(milli).transpose()?,
            hands: [place(columns.hands[0])?, place(columns.hands[1])?],
        });
    }
    Ok(frames)
}

fn arena(field: &Field<'_>) -> Result<Arena, BadField> {
    let sides = field.object()?;
    let side = |key: &str| {
        let list = sides.needed(key)?;
        let ends = list.items()?.iter().map(Field::number).collect::<Result<Vec<_>, _>>()?;
        match ends[..] {
            [least, most] if least < most => Ok([least, most]),
            _ => Err(list.bad("two numbers in rising order")),
        }
    };
    Ok(Arena { x_m: side("x")?, y_m: side("y")? })
}

fn target(field: &Field<'_>) -> Result<Target, BadField> {
    let fields = field.object()?;
    let number = |key: &str| fields.needed(key)?.number();
    let radius = fields.needed("r")?;
    let radius_m = radius.number()?;
    if radius_m < 0.0 {
        return Err(radius.bad("a radius of 0 or more"));
    }
    Ok(Target {
        id: fields.needed("id")?.text()?,
        label: fields.optional("label").map(|label| label.text()).transpose()?.unwrap_or_default(),
        position: Point::new(number("x")?, number("y")?, number("z")?),
        radius_m,
        view_deg: fields.optional("view_deg").map(|view| view.number()).transpose()?,
    })
}

fn goal(field: &Field<'_>, targets: &[Target]) -> Result<usize, BadField> {
    let id = field.text()?;
    targets.iter().position(|target| target.id == id).ok_or_else(|| field.bad("the id of one of `targets`"))
}

fn visit(field: &Field<'_>, targets: &[Target]) -> Result<Visit, BadField> {
    let fields = field.object()?;
    let valid = match fields.optional("valid") {
        Some(word) => word.value.as_bool().ok_or_else(|| word.bad("true or false"))?,
        None => true,
    };
    Ok(Visit { goal: goal(&fields.needed("goal")?, targets)?, valid, moments: moments(field)? })
}

fn moments(field: &Field<'_>) -> Result<Moments, BadField> {
    let fields = field.object()?;
    let at = |key: &str| fields.optional(key).map(|when| when.number().map(moment)).transpose();
    let either = |key: &str, other: &str| Ok(at(key)?.or(at(other)?));
    Ok(Moments {
        trial_start: at("trial_start")?,
        at_home: at("at_home")?,
        preview_start: at("preview_start")?,
        preview_end: at("preview_end")?,
        response_start: at("response_start")?,
        leave: either("leave", "t_leave")?,
        reach: either("reach", "t_reach")?,
        response_end: at("response_end")?,
    })
}

fn moment(secs: f64) -> Time {
    Time::from_micros((secs * 1e6).round() as i64)
}

/// A value as an error shows it: short.
fn shown(value: &Value) -> String {
    let text = match value {
        Value::Array(items) => return format!("a list of {}", items.len()),
        Value::Object(_) => return "an object".into(),
        other => other.to_string(),
    };
    if text.chars().count() > MOST_SHOWN {
        text.chars().take(MOST_SHOWN).chain("...".chars()).collect()
    } else {
        text
    }
}

/// Characters of a found value that an error repeats.
const MOST_SHOWN: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;

    const REACH: &str = r#"{"dataset":"jov2023","trial":"kitchen/1/T1","user":"1","mode":"fixed",
        "arena":{"x":[-2.5,2.5],"y":[-2.0,2.0]},
        "targets":[{"id":"A","label":"cup","x":1.0,"y":-1.0,"z":0.9,"r":0.1,"view_deg":0},{"id":"B","x":0,"y":1,"z":1,"r":0.2}],
        "goal":"B","events":{"preview_start":-2.348,"preview_end":2.0,"response_start":4.01,"reach":12.529},
        "hz":30,"cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],
        "frames":[[0,-58,123,1588,2084,-455],[33,-57,121,1591,2094,-428]]}"#;

    #[test]
    fn a_reach_is_read_whole() {
        let recording = recording(REACH).unwrap();
        assert_eq!((recording.dataset.as_str(), recording.mode.as_deref()), ("jov2023", Some("fixed")));
        assert_eq!(recording.goal, Some(1));
        assert_eq!(recording.arena, Some(Arena { x_m: [-2.5, 2.5], y_m: [-2.0, 2.0] }));
        assert_eq!(recording.targets[0].label, "cup");
        assert_eq!(recording.events.preview_start, Some(Time::from_micros(-2_348_000)));
        assert_eq!(recording.events.reach, Some(Time::from_micros(12_529_000)));
        assert_eq!(recording.events.leave, None);
        assert_eq!(recording.heights, Heights::AboveFloor);
        let last = recording.frames[1];
        assert_eq!(last.at, Time::from_micros(33_000));
        assert!((last.x_m + 0.057).abs() < 1e-12 && (last.yaw_rad.unwrap() - 2.094).abs() < 1e-12);
        // The head at (-0.057, 0.121, 1.591) is at (2.443, 2.121, 1.591) of a room that starts at the arena's corner.
        let head = recording.room_from_trace().point(&Point::new(last.x_m, last.y_m, last.z_m.unwrap()));
        assert!(head.distance_m(&Point::new(2.443, 2.121, 1.591)) < 1e-9, "{head:?}");
    }

    #[test]
    fn sessions_of_both_kinds_have_visits() {
        let jov = r#"{"dataset":"jov2023","trial":"s","user":"1","targets":[{"id":"A","x":0,"y":0,"z":1,"r":0.1}],
            "visits":[{"goal":"A","valid":false,"trial_start":0.0,"at_home":11.084,"reach":27.977}],
            "cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],"frames":[[0,0,0,1600,0,0]]}"#;
        let visit = recording(jov).unwrap().visits[0];
        assert_eq!((visit.goal, visit.valid), (0, false));
        assert_eq!(visit.moments.at_home, Some(Time::from_micros(11_084_000)));

        let pearl = r#"{"dataset":"pearl","trial":"s","user":"1","targets":[{"id":"G","x":0,"y":0,"z":-0.33,"r":0.35}],
            "visits":[{"goal":"G","t_reach":0.5,"t_leave":3.814}],
            "cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],"frames":[[0,0,0,19,0,0],[33,0,0,21,0,0],[66,0,0,30,0,0]]}"#;
        let pearl = recording(pearl).unwrap();
        assert_eq!(pearl.visits[0].moments.reach, Some(Time::from_micros(500_000)));
        assert_eq!(pearl.visits[0].moments.leave, Some(Time::from_micros(3_814_000)));
        assert_eq!(pearl.heights, Heights::UnknownOffset);
        // The median head, 0.021 m, is taken to be at 1.6 m; targets move with it.
        let target = pearl.room_from_trace().point(&pearl.targets[0].position);
        assert!((target.z() - (1.6 - 0.021 - 0.33)).abs() < 1e-9);
    }

    #[test]
    fn a_walk_needs_no_height_no_view_and_no_arena() {
        let walk = r#"{"dataset":"openrdw","trial":"w","user":"u","task":"Props","hz":20,
            "cols":["t_ms","x_mm","y_mm"],"frames":[[0,-12,-106]]}"#;
        let walk = recording(walk).unwrap();
        assert_eq!((walk.mode.as_deref(), walk.heights, walk.arena), (Some("Props"), Heights::Missing, None));
        assert_eq!((walk.frames[0].z_m, walk.frames[0].yaw_rad), (None, None));
    }

    /// A row with the columns of the right hand alone, tracked in the first frame.
    const WITH_HAND: &str = r#"{"dataset":"lab","trial":"w","user":"u","cols":["t_ms","x_mm","y_mm","right_x_mm","right_y_mm","right_z_mm"],
        "frames":[[0,0,0,300,-200,1100],[10,0,0,310,-200,1100],[20,0,0,null,null,null]]}"#;

    #[test]
    fn hands_are_read_where_they_were_tracked_and_resampled_between_two_frames_that_have_them() {
        let walk = recording(WITH_HAND).unwrap();
        let rights: Vec<_> = walk.frames.iter().map(|frame| frame.hands[1].map(|hand| hand.x())).collect();
        assert_eq!(rights, [Some(0.3), Some(0.31), None]);
        assert!(walk.frames.iter().all(|frame| frame.hands[0].is_none()));
        let samples: Vec<_> =
            walk.resampled(200.0).map(|sample| sample.hands[1].map(|hand| hand.x())).collect();
        assert!((samples[1].unwrap() - 0.305).abs() < 1e-12 && samples[3].is_none(), "{samples:?}");
        let room = walk.resampled(200.0).next().unwrap().hands_in(&walk.room_from_trace());
        assert!(room.left.is_none() && (room.right.unwrap().z() - 1.1).abs() < 1e-12);
    }

    #[test]
    fn half_a_hand_is_refused() {
        for (from, to, field, expected) in [
            ("null,null,null", "1,null,null", "frames[2][4]", "a finite number"),
            (r#""right_z_mm""#, r#""other""#, "cols", "`right_z_mm` among the columns"),
        ] {
            let bad = recording(&WITH_HAND.replacen(from, to, 1)).unwrap_err();
            assert_eq!((bad.field.as_str(), bad.expected.as_str()), (field, expected));
        }
    }

    #[test]
    fn each_wrong_field_is_named_with_what_was_found_and_expected() {
        let cases = [
            (r#""trial":"kitchen/1/T1","#, "", "trial", "nothing", "this key"),
            (r#""user":"1""#, r#""user":1"#, "user", "1", "a string"),
            (r#""goal":"B""#, r#""goal":"Z""#, "goal", "\"Z\"", "the id of one of `targets`"),
            ("[-2.5,2.5]", "[2.5,-2.5]", "arena.x", "a list of 2", "two numbers in rising order"),
            (r#""r":0.2"#, r#""r":-0.2"#, "targets[1].r", "-0.2", "a radius of 0 or more"),
            (r#""reach":12.529"#, r#""reach":"late""#, "events.reach", "\"late\"", "a finite number"),
            ("[33,", "[0,", "frames[1]", "a list of 6", "a time after 0 ms"),
            ("[33,-57,", "[33,", "frames[1]", "a list of 5", "a row of 6 numbers, as `cols` says"),
            ("2094", "null", "frames[1][4]", "null", "a finite number"),
            (r#""y_mm","#, r#""w_mm","#, "cols", "a list of 6", "`y_mm` among the columns"),
        ];
        for (from, to, field, found, expected) in cases {
            let broken = REACH.replacen(from, to, 1);
            assert_ne!(broken, REACH, "{from} is not in the line");
            let bad = recording(&broken).unwrap_err();
            assert_eq!(
                (bad.field.as_str(), bad.found.as_str(), bad.expected.as_str()),
                (field, found, expected)
            );
        }
        let bad = recording("{\"dataset\":").unwrap_err();
        assert_eq!(bad.expected, "one JSON object");
        assert_eq!(recording("[]").unwrap_err().field, "the line");
    }
}
