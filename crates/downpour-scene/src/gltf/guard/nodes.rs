//! Nodes: a forest of bounded depth, with numbers of the right count in its transforms.
//!
//! Each node has at most one parent, so a walk along children meets it at most once; from the roots down, level
//! by level, every node of a forest is met, and what is not met hangs on a circle.

use super::spot::Spot;
use crate::error::SceneError;
use crate::gltf::MAX_DEPTH;
use serde_json::Value;

/// Checks the nodes and the scenes. That indices are in range has been seen to.
pub(super) fn check(document: &Spot<'_>) -> Result<(), SceneError> {
    document.each(&["nodes", "[]"], &mut |node| {
        for (key, count) in [("matrix", 16), ("translation", 3), ("rotation", 4), ("scale", 3)] {
            numbers(node, key, count)?;
        }
        Ok(())
    })?;
    let parents = parents(document)?;
    descend(document, &parents)?;
    scenes(document, &parents)
}

fn numbers(node: &Spot<'_>, key: &str, count: usize) -> Result<(), SceneError> {
    let Some(member) = node.get(key)? else { return Ok(()) };
    let mut found = 0usize;
    for number in member.items()? {
        number.number()?;
        found = found.saturating_add(1);
    }
    if found == count { Ok(()) } else { Err(member.not(format!("{count} numbers"))) }
}

fn children(node: &Value) -> impl Iterator<Item = usize> {
    let list = node.get("children").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    list.iter().filter_map(|child| usize::try_from(child.as_u64()?).ok())
}

fn node_list<'a>(document: &Spot<'a>) -> &'a [Value] {
    document.value.get("nodes").and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// The parent of each node.
fn parents(document: &Spot<'_>) -> Result<Vec<Option<usize>>, SceneError> {
    let nodes = node_list(document);
    let mut parents = vec![None; nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        for (nth, child) in children(node).enumerate() {
            let path = format_args!("nodes[{index}].children[{nth}]");
            if child == index {
                return Err(SceneError::bad(path, format!("{child}, the node itself"), "another node"));
            }
            match parents.get_mut(child) {
                Some(Some(other)) => {
                    let found = format!("{child}, which is a child of nodes[{other}] already");
                    return Err(SceneError::bad(path, found, "one parent for each node"));
                }
                Some(slot) => *slot = Some(index),
                None => {}
            }
        }
    }
    Ok(parents)
}

/// Walks all levels of the forest.
fn descend(document: &Spot<'_>, parents: &[Option<usize>]) -> Result<(), SceneError> {
    let nodes = node_list(document);
    let mut met = vec![false; nodes.len()];
    let mut level: Vec<usize> =
        parents.iter().enumerate().filter(|(_, parent)| parent.is_none()).map(|(index, _)| index).collect();
    for depth in 0u32.. {
        let Some(&first) = level.first() else { break };
        if depth >= MAX_DEPTH {
            let found = format!("nested deeper than {MAX_DEPTH}");
            return Err(SceneError::bad(
                format_args!("nodes[{first}]"),
                found,
                format!("at most {MAX_DEPTH} levels"),
            ));
        }
        let mut next = Vec::new();
        for index in level {
            if let Some(met) = met.get_mut(index) {
                *met = true;
            }
            next.extend(nodes.get(index).into_iter().flat_map(children));
        }
        level = next;
    }
    match met.iter().position(|met| !met) {
        Some(lost) => Err(circle(lost, parents)),
        None => Ok(()),
    }
}

/// Names the circle above a node that no root leads to.
fn circle(lost: usize, parents: &[Option<usize>]) -> SceneError {
    let parent = |node: usize| parents.get(node).copied().flatten().unwrap_or(node);
    // As many steps up as there are nodes end on the circle.
    let start = parents.iter().fold(lost, |node, _| parent(node));
    let mut round = vec![start];
    let mut node = parent(start);
    while node != start && round.len() <= parents.len() {
        round.push(node);
        node = parent(node);
    }
    let count = round.len();
    let mut words: Vec<String> = round.iter().rev().take(6).map(|node| format!("nodes[{node}]")).collect();
    if count > words.len() {
        words.push(format!("… ({count} nodes)"));
    }
    words.extend(round.last().map(|node| format!("nodes[{node}]")));
    let found = format!("a circle of children: {}", words.join(" > "));
    SceneError::bad(format_args!("nodes[{start}]"), found, "a tree without circles")
}

/// Scenes name roots, each once.
fn scenes(document: &Spot<'_>, parents: &[Option<usize>]) -> Result<(), SceneError> {
    let mut last_seen: Vec<Option<usize>> = vec![None; parents.len()];
    let mut scene_number = 0usize;
    document.each(&["scenes", "[]"], &mut |scene| {
        scene.each(&["nodes", "[]"], &mut |root| {
            let node = root.index_into("nodes", parents.len())?;
            if let Some(parent) = parents.get(node).copied().flatten() {
                return Err(
                    root.wrong(format!("{node}, a child of nodes[{parent}]"), "nodes without a parent")
                );
            }
            if let Some(seen) = last_seen.get_mut(node) {
                if *seen == Some(scene_number) {
                    return Err(root.wrong(format!("{node} for the second time"), "each node once"));
                }
                *seen = Some(scene_number);
            }
            Ok(())
        })?;
        scene_number = scene_number.saturating_add(1);
        Ok(())
    })
}
