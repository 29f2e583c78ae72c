use super::*;
use crate::evaluate::course::seed;
use crate::evaluate::plan::MachineKind;
use crate::evaluate::{explain, terminal};
use crate::replay::TrackingNoise;
use covr_engine::frames::Floor;
use covr_engine::intention::RuleName;
use covr_engine::time::Span;
use std::fmt::Write;
use std::path::Path;

/// Two reaches of one person: to A in a file of two lines, then to B.
fn subjects(folder: &Path) -> Subjects {
    let mut text = String::new();
    for (trial, goal, x) in [("one", "A", 1.0), ("two", "B", 3.0)] {
        let frames: Vec<String> = (0..=180)
            .map(|i| {
                let t = f64::from(i) / 30.0;
                let s = ((t - 3.0) / 3.0).clamp(0.0, 1.0);
                let at = 2000.0 + (x - 2.0) * 1000.0 * s;
                let yaw = if x > 2.0 { 0 } else { 3142 };
                format!("[{},{},700,1600,{yaw},-200]", (t * 1000.0) as i64, at as i64)
            })
            .collect();
        writeln!(
            text,
            r#"{{"dataset":"made","trial":"{trial}","user":"u","mode":"fixed","arena":{{"x":[0,4],"y":[0,4]}},"goal":"{goal}","targets":[{{"id":"A","x":0.4,"y":2,"z":1.1,"r":0.1}},{{"id":"B","x":3.6,"y":2,"z":1.1,"r":0.1}}],"events":{{"preview_end":2.0,"reach":6.0}},"cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],"frames":[{}]}}"#,
            frames.join(",")
        )
        .unwrap();
    }
    let file = folder.join("made_reach.jsonl");
    std::fs::write(&file, text).unwrap();
    Subjects::read(&[file]).unwrap()
}

fn plan(threads: usize) -> Plan {
    Plan {
        rules: vec![RuleChoice::Rule(RuleName::PaperBest), RuleChoice::Told],
        motions: vec![MotionName::Proxy],
        objects: vec![Objects::Count(1), Objects::All],
        priors: Prior::ALL.to_vec(),
        machine: MachineKind::Ideal,
        threads,
        ..Plan::new(RuleName::PaperBest, MotionName::Proxy)
    }
}

#[test]
fn the_table_is_the_same_for_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let subjects = subjects(folder.path());
    let one = evaluate(&subjects, &plan(1), &|_, _| ()).unwrap();
    assert_eq!(one, evaluate(&subjects, &plan(3), &|_, _| ()).unwrap());
    assert!(one.pooled.iter().all(|row| row.objects == 0 && row.trials == 2), "{:?}", one.pooled);
    // Prior by prior, two counts for the rule less the lone goal with a prior; two counts told.
    assert_eq!(one.rows.len(), 4 + 2);
    let told = one.rows.iter().find(|row| row.rule == "told" && row.objects == 0).unwrap();
    assert_eq!((told.trials, told.violations, told.success), (2, 0, 1.0));
    assert_eq!(told.top1["0.0"], 1.0);
    assert!(told.in_place["0.0"] == told.success && told.in_place["3.0"] <= told.in_place["1.0"], "{told:?}");
    // Whoever is told is sure, and right.
    assert_eq!((told.reliability.len(), told.calibration_error), (1, Some(0.0)));
    assert_eq!((told.said_late["0.5"], told.in_time_came_true["0.5"]), (0.0, 1.0));
    assert!(told.in_time_brier["0.5"] < 0.05 && told.late_came_true.is_empty(), "{told:?}");
    assert!(one.rows.iter().filter(|row| row.default).all(|row| row.rule == "paper-best"));
}

#[test]
fn the_column_begins_at_the_goal_before() {
    let folder = tempfile::tempdir().unwrap();
    let subjects = subjects(folder.path());
    assert_eq!(subjects.reaches[0].column, Floor::new(3.0, 3.0));
    assert_eq!(subjects.reaches[1].column, Floor::new(0.4, 2.0));
}

#[test]
fn people_who_are_not_there_are_said_to_be_missing() {
    let folder = tempfile::tempdir().unwrap();
    let subjects = subjects(folder.path());
    let nobody = Plan { people: vec!["x".into()], ..plan(1) };
    assert!(matches!(evaluate(&subjects, &nobody, &|_, _| ()), Err(EvaluationProblem::Nothing)));
}

#[test]
fn every_failure_has_a_cause_and_every_cause_is_counted() {
    let folder = tempfile::tempdir().unwrap();
    let subjects = subjects(folder.path());
    // So slow a machine is nowhere in time.
    let conditions = Conditions { acceleration_share: 0.02, ..Conditions::AS_RECORDED };
    let blamed = evaluate(&subjects, &Plan { blames: true, conditions, ..plan(1) }, &|_, _| ()).unwrap();
    for row in &blamed.rows {
        assert_eq!(row.blame.values().sum::<u64>(), (row.trials - row.successes) as u64, "{row:?}");
    }
    let told = blamed.rows.iter().find(|row| row.rule == "told").unwrap();
    assert!(told.blame.contains_key("acceleration"), "{:?}", told.blame);
}

#[test]
fn without_the_separation_rule_its_breaches_are_counted_apart() {
    let folder = tempfile::tempdir().unwrap();
    let subjects = subjects(folder.path());
    let separations = vec![SeparationChoice::On, SeparationChoice::Off];
    let both = evaluate(&subjects, &Plan { separations, ..plan(1) }, &|_, _| ()).unwrap();
    let of = |name: &str| both.rows.iter().filter(|row| row.separation == name).collect::<Vec<_>>();
    assert_eq!(of("on").len(), of("off").len());
    assert!(of("on").iter().all(|row| row.separation_breaches == 0));
    assert!(both.rows.iter().all(|row| row.violations == 0));
}

/// One person who goes to B and then to A in one recording, unseen for a while on the way back.
fn session(folder: &Path) -> Subjects {
    let frames: Vec<String> = (0..=480)
        .filter(|i| !(205..240).contains(i))
        .map(|i| {
            let t = f64::from(i) / 30.0;
            let to_b = ((t - 3.0) / 3.0).clamp(0.0, 1.0);
            let to_a = ((t - 7.0) / 6.0).clamp(0.0, 1.0);
            let x = 2000.0 + 1000.0 * to_b - 2000.0 * to_a;
            let yaw = if t < 6.5 { 0 } else { 3142 };
            format!("[{},{},700,1600,{yaw},-200]", (t * 1000.0) as i64, x as i64)
        })
        .collect();
    let text = format!(
        r#"{{"dataset":"made","trial":"u/session","user":"u","mode":"fixed","arena":{{"x":[0,4],"y":[0,4]}},"targets":[{{"id":"A","x":0.4,"y":2,"z":1.1,"r":0.1}},{{"id":"B","x":3.6,"y":2,"z":1.1,"r":0.1}}],"visits":[{{"goal":"B","valid":true,"preview_start":1.0,"reach":6.0}},{{"goal":"A","valid":true,"preview_start":9.0,"reach":15.0}},{{"goal":"A","valid":false,"preview_start":15.2,"reach":16.0}}],"cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],"frames":[{}]}}"#,
        frames.join(",")
    );
    let file = folder.join("made_sessions.jsonl");
    std::fs::write(&file, text).unwrap();
    Subjects::read(&[file]).unwrap()
}

#[test]
fn a_session_runs_on_from_visit_to_visit_and_its_gap_is_lost_tracking() {
    let folder = tempfile::tempdir().unwrap();
    let subjects = session(folder.path());
    let one = evaluate(&subjects, &plan(1), &|_, _| ()).unwrap();
    assert_eq!(one, evaluate(&subjects, &plan(2), &|_, _| ()).unwrap());
    let told = one.rows.iter().find(|row| row.rule == "told" && row.objects == 0).unwrap();
    // The third visit is not valid. More than half a second without poses is a stop, and the column goes on after it.
    assert_eq!((told.trials, told.successes, told.stops, told.violations), (2, 2, 1, 0), "{told:?}");
}

#[test]
fn a_late_trial_is_explained_in_words_and_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let subjects = subjects(folder.path());
    let conditions = Conditions { acceleration_share: 0.02, ..Conditions::AS_RECORDED };
    let explanation = explain(&subjects, &Plan { conditions, ..plan(1) }, "two").unwrap();
    let words = &explanation.words;
    for said in ["Trial two: person u, task fixed, goal B", "late.", "Cause: ", "0 violations"] {
        assert!(words.contains(said), "{said:?} is not in {words}");
    }
    let svg = &explanation.svg;
    for drawn in ["class=\"person\"", "class=\"column\"", "class=\"late\"", "-1 s</text>", "</svg>"] {
        assert!(svg.contains(drawn), "{drawn:?} is not in {svg}");
    }
    let unknown = explain(&subjects, &plan(1), "three").unwrap_err().to_string();
    assert!(unknown.contains("`three`") && unknown.contains("`one`"), "{unknown}");
}

#[test]
fn the_made_up_visitor_stands_in_where_there_are_no_recordings() {
    let made_up = Plan { objects: vec![Objects::Count(2)], priors: vec![Prior::None], ..plan(2) };
    let one = evaluate(&Subjects::synthetic(10), &made_up, &|_, _| ()).unwrap();
    assert!(one.rows.iter().all(|row| row.trials == 10 && row.file == "synthetic" && row.violations == 0));
}

#[test]
fn the_limit_is_a_row_of_its_own_with_what_could_not_be_excluded() {
    let folder = tempfile::tempdir().unwrap();
    let subjects = subjects(folder.path());
    let asked = Plan {
        rules: vec![RuleChoice::Told, RuleChoice::Bound],
        objects: vec![Objects::Count(1)],
        ..plan(2)
    };
    let both = evaluate(&subjects, &asked, &|_, _| ()).unwrap();
    let [told, bound] = &both.rows[..] else { panic!("{:?}", both.rows) };
    assert_eq!((told.not_excluded, bound.rule, bound.motion, bound.prior), (None, "bound", "any", "none"));
    assert_eq!((bound.trials, bound.successes, bound.not_excluded, bound.violations), (2, 2, Some(2), 0));
    assert!(bound.least_separation_moving_m.unwrap() > 0.35, "{bound:?}");
    let words = terminal(&both);
    for said in
        ["bound made_reach fixed hash: from 100.0 % (2 motions", "goal reached: made_reach fixed told proxy"]
    {
        assert!(words.contains(said), "{said:?} is not in {words}");
    }
    // So slow a machine cannot come, whatever it knows.
    let conditions = Conditions { acceleration_share: 0.02, ..Conditions::AS_RECORDED };
    let slow = evaluate(&subjects, &Plan { conditions, ..asked }, &|_, _| ()).unwrap();
    assert!(slow.rows.iter().all(|row| row.successes == 0), "{:?}", slow.rows);
    assert_eq!(slow.rows[1].not_excluded, Some(0));
}

#[test]
fn the_limit_of_what_has_none_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let bound = Plan { rules: vec![RuleChoice::Bound], ..plan(1) };
    let apart = Plan { separations: vec![SeparationChoice::Off], ..bound.clone() };
    let refused = evaluate(&subjects(folder.path()), &apart, &|_, _| ()).unwrap_err().to_string();
    assert!(refused.starts_with("rule bound: found separation off, expected on"), "{refused}");
    let refused = explain(&subjects(folder.path()), &bound, "two").unwrap_err().to_string();
    assert!(refused.contains("rule bound: found a trial to explain"), "{refused}");
    let sessions = session(folder.path());
    let refused = evaluate(&sessions, &bound, &|_, _| ()).unwrap_err().to_string();
    assert!(refused.contains("found whole sessions alone, expected recorded reaches"), "{refused}");
    // Beside another rule it has no row there, and that is said.
    let beside = Plan { rules: vec![RuleChoice::Told, RuleChoice::Bound], ..bound };
    let one = evaluate(&sessions, &beside, &|_, _| ()).unwrap();
    assert!(one.rows.iter().all(|row| row.rule == "told") && one.left_out[0].recordings == 1, "{one:?}");
}

#[test]
fn every_trial_has_losses_and_noise_of_its_own_and_the_same_each_time() {
    let folder = tempfile::tempdir().unwrap();
    let subjects = subjects(folder.path());
    let seeds: std::collections::BTreeSet<u64> = subjects
        .reaches
        .iter()
        .flat_map(|reach| ["noise", "link"].map(|of| seed(&reach.recording, of)))
        .collect();
    assert_eq!(seeds.len(), 4);
    // printf 'one/noise' | sha256sum
    assert_eq!(seed(&subjects.reaches[0].recording, "noise"), 0xcd82eb958ef4a0f2);
    let noise = TrackingNoise { position_m: 0.02, rotation_rad: 0.035 };
    let conditions =
        Conditions { loss: 0.05, noise, latency: Span::from_millis(100), ..Conditions::AS_RECORDED };
    let harder = Plan { conditions, ..plan(1) };
    let one = evaluate(&subjects, &harder, &|_, _| ()).unwrap();
    assert_eq!(one, evaluate(&subjects, &Plan { threads: 2, ..harder }, &|_, _| ()).unwrap());
    assert_ne!(one.rows, evaluate(&subjects, &plan(1), &|_, _| ()).unwrap().rows);
    assert!(terminal(&one).contains("not as recorded: latency_s 0.1000, loss 0.0500, noise_m 0.0200"));
    assert!(one.rows.iter().all(|row| row.violations == 0), "{:?}", one.rows);
}

#[test]
fn a_sweep_is_what_one_value_after_the_other_would_give() {
    let folder = tempfile::tempdir().unwrap();
    let subjects = subjects(folder.path());
    let w = crate::fit::Parameter::named("paper.distance_share").unwrap();
    let base = Plan { rules: vec![RuleChoice::Rule(RuleName::Paper)], ..plan(2) };
    let (values, intentions): (Vec<f64>, Vec<_>) = w.swept(&base.intention, 3).into_iter().unzip();
    assert_eq!(values, [0.0, 0.5, 1.0]);
    let all = sweep(&subjects, &base, &intentions, &|_, _| ()).unwrap();
    for (intention, evaluation) in intentions.iter().zip(&all) {
        let alone = Plan { intention: intention.clone(), ..base.clone() };
        assert_eq!(*evaluation, evaluate(&subjects, &alone, &|_, _| ()).unwrap());
    }
    let rows = all[0].rows.len();
    let one = Evaluation::of_sweep(w.name, values.into_iter().zip(all).collect()).unwrap();
    assert_eq!(
        (one.rows.len(), one.rows[rows].value, one.rows[rows].parameter),
        (3 * rows, Some(0.5), Some(w.name))
    );
    assert!(terminal(&one).contains("paper* 0.500") || terminal(&one).contains("paper 0.500"));
}

#[test]
fn a_person_may_have_numbers_of_their_own_and_others_have_the_plans() {
    let subjects = Subjects::synthetic(20);
    let mut far = IntentionParameters::default();
    far.paper.distance_share = 1.0;
    let plan =
        Plan { objects: vec![Objects::Count(4)], rules: vec![RuleChoice::Rule(RuleName::Paper)], ..plan(0) };
    let own = [("synthetic 2".to_owned(), far.clone())].into();
    let mixed = evaluate_by_person(&subjects, &plan, &own, &|_, _| ()).unwrap();
    let of = |person: &str, intention: &IntentionParameters| {
        let plan = Plan { people: vec![person.into()], intention: intention.clone(), ..plan.clone() };
        evaluate(&subjects, &plan, &|_, _| ()).unwrap().rows.iter().map(|row| row.successes).sum::<usize>()
    };
    let (default, both) =
        (IntentionParameters::default(), mixed.rows.iter().map(|row| row.successes).sum::<usize>());
    assert_eq!(both, of("synthetic 1", &default) + of("synthetic 2", &far));
    assert_ne!(of("synthetic 2", &default), of("synthetic 2", &far), "else the test shows nothing");
}
