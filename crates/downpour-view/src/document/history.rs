//! Undo and redo.

/// Steps that are kept.
const MAX_STEPS: usize = 1000;

/// State of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct State {
    pub(super) text: String,
}

/// A step, with the state on its other side.
#[derive(Clone, Debug)]
struct Entry {
    label: String,
    stroke: Option<u64>,
    state: State,
}

/// Steps that can be taken back, and those that were.
#[derive(Clone, Debug, Default)]
pub(super) struct History {
    done: Vec<Entry>,
    undone: Vec<Entry>,
}

impl History {
    /// Notes a step with the state before it. One of the same stroke as the last is a part of it.
    pub(super) fn push(&mut self, label: &str, stroke: Option<u64>, before: State) {
        self.undone.clear();
        if stroke.is_some() && self.done.last().is_some_and(|last| last.stroke == stroke) {
            return;
        }
        if self.done.len() == MAX_STEPS {
            self.done.remove(0);
        }
        self.done.push(Entry { label: label.to_owned(), stroke, state: before });
    }

    /// The label of the last step and the state before it.
    pub(super) fn undo(&mut self, now: State) -> Option<(String, State)> {
        let Entry { label, state, .. } = self.done.pop()?;
        self.undone.push(Entry { label: label.clone(), stroke: None, state: now });
        Some((label, state))
    }

    /// The label of the step that was taken back last, and the state after it.
    pub(super) fn redo(&mut self, now: State) -> Option<(String, State)> {
        let Entry { label, state, .. } = self.undone.pop()?;
        self.done.push(Entry { label: label.clone(), stroke: None, state: now });
        Some((label, state))
    }

    pub(super) fn undo_label(&self) -> Option<&str> {
        self.done.last().map(|entry| entry.label.as_str())
    }

    pub(super) fn redo_label(&self) -> Option<&str> {
        self.undone.last().map(|entry| entry.label.as_str())
    }
}
