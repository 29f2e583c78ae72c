//! Which trials make up which row.

use super::plan::{Objects, Plan, Prior, RuleChoice};
use super::row::{Judged, Row, RowKey};
use super::run::{Case, Cell};

/// A row for each file, task and cell.
pub(super) fn rows(plan: &Plan, cells: &[Cell], cases: &[Case<'_>]) -> Vec<Row> {
    let mut rows = Vec::new();
    for (file, task_name) in groups(cases) {
        for (column, cell) in cells.iter().enumerate() {
            let of_group: Vec<&Judged> = members(cases, file, Some(task_name))
                .filter_map(|case| case.by_cell.get(column)?.as_ref())
                .collect();
            if !of_group.is_empty() {
                rows.push(Row::of(key(plan, cell, file, task_name), &of_group));
            }
        }
    }
    rows
}

/// The same pooled over the numbers of objects up to 5: by task, and over every task of a file with several.
pub(super) fn pooled(plan: &Plan, cells: &[Cell], cases: &[Case<'_>]) -> Vec<Row> {
    let groups = groups(cases);
    let mut pools: Vec<(&str, Option<&str>)> = Vec::new();
    for (number, (file, task_name)) in groups.iter().enumerate() {
        pools.push((file, Some(task_name)));
        let tasks = groups.iter().filter(|(other, _)| other == file).count();
        let is_last = groups[number + 1..].iter().all(|(other, _)| other != file);
        if tasks > 1 && is_last {
            pools.push((file, None));
        }
    }
    let mut alike: Vec<Cell> = Vec::new();
    for cell in cells.iter().filter(|cell| is_pooled(cell)) {
        if !alike.iter().any(|one| is_alike(one, cell)) {
            alike.push(*cell);
        }
    }
    let mut rows = Vec::new();
    for (file, task_name) in pools {
        for one in &alike {
            // A lone goal has no prior, and belongs to every pool all the same.
            let columns: Vec<usize> = (0..cells.len())
                .filter(|&column| {
                    let cell = &cells[column];
                    let alone = cell.objects == Objects::Count(1) && one.prior == Prior::Right;
                    is_pooled(cell)
                        && (is_alike(cell, one)
                            || alone && is_alike(&Cell { prior: one.prior, ..*cell }, one))
                })
                .collect();
            let of_pool: Vec<&Judged> = members(cases, file, task_name)
                .flat_map(|case| columns.iter().filter_map(|&column| case.by_cell[column].as_ref()))
                .collect();
            if !of_pool.is_empty() {
                let key = RowKey { objects: 0, ..key(plan, one, file, task_name.unwrap_or("all")) };
                rows.push(Row::of(key, &of_pool));
            }
        }
    }
    rows
}

/// Files and tasks, in the order in which they come.
fn groups<'a>(cases: &[Case<'a>]) -> Vec<(&'a str, &'a str)> {
    let mut groups = Vec::new();
    for case in cases {
        let group = (case.file, case.task);
        if !groups.contains(&group) {
            groups.push(group);
        }
    }
    groups
}

fn members<'a>(
    cases: &'a [Case<'_>],
    file: &'a str,
    task_name: Option<&'a str>,
) -> impl Iterator<Item = &'a Case<'a>> {
    cases.iter().filter(move |case| case.file == file && task_name.is_none_or(|name| case.task == name))
}

fn key(plan: &Plan, cell: &Cell, file: &str, task_name: &str) -> RowKey {
    RowKey {
        file: file.to_owned(),
        task: task_name.to_owned(),
        rule: cell.rule.name(),
        motion: if cell.rule == RuleChoice::Bound { "any" } else { cell.motion.name() },
        default: cell.rule == RuleChoice::Rule(plan.default_rule) && cell.motion == plan.default_motion,
        prior: cell.prior.name(),
        draw: cell.draw.name(),
        objects: match cell.objects {
            Objects::Count(count) => count,
            Objects::All => 0,
        },
        separation: cell.separation,
        v_h_mps: plan.v_h_mps,
    }
}

fn is_pooled(cell: &Cell) -> bool {
    matches!(cell.objects, Objects::Count(count) if count <= MOST_POOLED)
}

/// The same but for the number of objects.
fn is_alike(a: &Cell, b: &Cell) -> bool {
    Cell { objects: b.objects, ..*a } == *b
}

/// The goals are about 1 to 5 objects.
const MOST_POOLED: usize = 5;
