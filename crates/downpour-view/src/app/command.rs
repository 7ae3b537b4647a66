//! Commands of the window, each with its shortcut: menus, keys and scripts use the same.

use egui::{Key, KeyboardShortcut, Modifiers};
use glam::DVec3;

use super::dialogs::Dialog;
use super::{App, Picker, Purpose, Wish};
use crate::document::DocumentError;
use crate::key_path::KeyPath;
use crate::objects::{ObjectId, new_entry, rounded};
use crate::plain::Plain;

/// A command without arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Open a weather file or a model.
    Open,
    /// Save the file.
    Save,
    /// Save as another file.
    SaveAs,
    /// Take a model or a sky map into the weather.
    Import,
    /// Take back the last step.
    Undo,
    /// Do again what was taken back.
    Redo,
    /// Copy what is selected.
    Duplicate,
    /// Delete what is selected.
    Delete,
    /// Hide what is selected, or show it again.
    Hide,
    /// Select all objects.
    SelectAll,
    /// Select nothing.
    SelectNone,
    /// Look at what is selected.
    FrameSelection,
    /// Play or pause.
    Play,
    /// One frame on.
    StepForward,
    /// One frame back.
    StepBack,
    /// Show the weather's camera.
    FileCamera,
    /// Make the view the weather's camera.
    SetCamera,
    /// Record the flight as the path of the camera, or end that.
    Record,
    /// Meter the exposure of the view.
    Meter,
    /// Show or hide the slice of the wind.
    Slice,
    /// Show or hide tracers in the wind.
    Tracers,
    /// Handles in steps.
    Snap,
    /// Paint a puddle, or end that.
    Brush,
    /// Fill the screen.
    FullScreen,
    /// Save the picture of the scene.
    SavePicture,
    /// Save the window as a picture.
    Screenshot,
    /// Render a still or a clip.
    Render,
    /// List the shortcuts.
    Help,
}

impl Command {
    /// All of them, as the help lists them.
    pub const ALL: [Self; 28] = [
        Self::Open,
        Self::Save,
        Self::SaveAs,
        Self::Import,
        Self::Undo,
        Self::Redo,
        Self::Duplicate,
        Self::Delete,
        Self::Hide,
        Self::SelectAll,
        Self::SelectNone,
        Self::FrameSelection,
        Self::Play,
        Self::StepForward,
        Self::StepBack,
        Self::FileCamera,
        Self::SetCamera,
        Self::Record,
        Self::Meter,
        Self::Slice,
        Self::Tracers,
        Self::Snap,
        Self::Brush,
        Self::FullScreen,
        Self::SavePicture,
        Self::Screenshot,
        Self::Render,
        Self::Help,
    ];

    /// Its name in menus.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::Open => "Open…",
            Self::Save => "Save",
            Self::SaveAs => "Save as…",
            Self::Import => "Import…",
            Self::Undo => "Undo",
            Self::Redo => "Redo",
            Self::Duplicate => "Duplicate",
            Self::Delete => "Delete",
            Self::Hide => "Hide or show",
            Self::SelectAll => "Select all",
            Self::SelectNone => "Select nothing",
            Self::FrameSelection => "Frame selection",
            Self::Play => "Play or pause",
            Self::StepForward => "Next frame",
            Self::StepBack => "Previous frame",
            Self::FileCamera => "Camera of the file",
            Self::SetCamera => "Set camera to view",
            Self::Record => "Record camera path",
            Self::Meter => "Meter exposure",
            Self::Slice => "Wind slice",
            Self::Tracers => "Wind tracers",
            Self::Snap => "Snap to steps",
            Self::Brush => "Paint puddle",
            Self::FullScreen => "Full screen",
            Self::SavePicture => "Save picture",
            Self::Screenshot => "Save screenshot",
            Self::Render => "Render…",
            Self::Help => "Shortcuts",
        }
    }

    /// Its keys.
    #[must_use]
    pub fn shortcut(self) -> KeyboardShortcut {
        let (modifiers, key) = match self {
            Self::Open => (Modifiers::COMMAND, Key::O),
            Self::Save => (Modifiers::COMMAND, Key::S),
            Self::SaveAs => (Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S),
            Self::Import => (Modifiers::COMMAND, Key::I),
            Self::Undo => (Modifiers::COMMAND, Key::Z),
            Self::Redo => (Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z),
            Self::Duplicate => (Modifiers::COMMAND, Key::D),
            Self::Delete => (Modifiers::NONE, Key::Delete),
            Self::Hide => (Modifiers::NONE, Key::H),
            Self::SelectAll => (Modifiers::COMMAND, Key::A),
            Self::SelectNone => (Modifiers::NONE, Key::Escape),
            Self::FrameSelection => (Modifiers::NONE, Key::F),
            Self::Play => (Modifiers::NONE, Key::Space),
            Self::StepForward => (Modifiers::NONE, Key::Period),
            Self::StepBack => (Modifiers::NONE, Key::Comma),
            Self::FileCamera => (Modifiers::NONE, Key::C),
            Self::SetCamera => (Modifiers::SHIFT, Key::C),
            Self::Record => (Modifiers::NONE, Key::R),
            Self::Meter => (Modifiers::NONE, Key::M),
            Self::Slice => (Modifiers::NONE, Key::L),
            Self::Tracers => (Modifiers::NONE, Key::T),
            Self::Snap => (Modifiers::NONE, Key::G),
            Self::Brush => (Modifiers::NONE, Key::B),
            Self::FullScreen => (Modifiers::NONE, Key::F11),
            Self::SavePicture => (Modifiers::NONE, Key::F12),
            Self::Screenshot => (Modifiers::SHIFT, Key::F12),
            Self::Render => (Modifiers::COMMAND, Key::R),
            Self::Help => (Modifiers::NONE, Key::F1),
        };
        KeyboardShortcut::new(modifiers, key)
    }
}

impl App {
    /// Runs the commands whose keys are pressed.
    pub(super) fn shortcuts(&mut self, ui: &egui::Ui) {
        // Letters go to a field of text; a dialog takes all keys but those of text.
        let types = ui.ctx().egui_wants_keyboard_input();
        if self.dialog.is_some() {
            return;
        }
        // Longer shortcuts first, so that Shift is not lost.
        let mut all = Command::ALL;
        all.sort_by_key(|command| !command.shortcut().modifiers.shift);
        for command in all {
            let shortcut = command.shortcut();
            let is_letter =
                !shortcut.modifiers.command && !matches!(shortcut.logical_key, Key::F1 | Key::F11 | Key::F12);
            // The space bar presses the button that has the focus.
            let has_focus = ui.ctx().memory(|memory| memory.focused().is_some());
            if (types && is_letter) || (has_focus && shortcut.logical_key == Key::Space) {
                continue;
            }
            if ui.ctx().input_mut(|input| input.consume_shortcut(&shortcut)) {
                self.run(command);
            }
        }
    }

    /// Runs a command.
    pub fn run(&mut self, command: Command) {
        match command {
            Command::Save => self.save(),
            Command::Open => self.pick_for(Purpose::Open),
            Command::SaveAs => self.pick_for(Purpose::SaveAs),
            Command::Import => self.pick_for(Purpose::Import),
            Command::Undo => match self.document.undo() {
                Some(label) => self.say(format!("undone: {label}")),
                None => self.say("nothing to undo"),
            },
            Command::Redo => match self.document.redo() {
                Some(label) => self.say(format!("done again: {label}")),
                None => self.say("nothing to do again"),
            },
            Command::Duplicate => self.duplicate(),
            Command::Delete => self.delete(),
            Command::Hide => {
                let all_hidden = self.selected.iter().all(|id| self.hidden.contains(id));
                for id in self.selected.clone() {
                    if all_hidden {
                        self.hidden.remove(&id);
                    } else {
                        self.hidden.insert(id);
                    }
                }
            }
            Command::SelectAll => {
                self.selected = self.objects().into_iter().map(|object| object.id).collect();
            }
            Command::SelectNone => {
                self.selected.clear();
                self.brush.is_on = false;
            }
            Command::FrameSelection => self.frame_selection(),
            Command::Play => self.clock.is_playing = !self.clock.is_playing,
            Command::StepForward => self.clock.step(1.0),
            Command::StepBack => self.clock.step(-1.0),
            Command::FileCamera => self.eye = None,
            Command::SetCamera => self.set_camera(),
            Command::Record => self.record(),
            Command::Meter => {
                self.meters = true;
                self.asked = None;
            }
            Command::Slice => self.overlay.has_slice = !self.overlay.has_slice,
            Command::Tracers => self.overlay.has_tracers = !self.overlay.has_tracers,
            Command::Snap => self.overlay.snaps = !self.overlay.snaps,
            Command::Brush => self.brush.is_on = !self.brush.is_on,
            Command::FullScreen => self.wishes.push(Wish::FullScreen),
            Command::SavePicture => self.save_picture(&self.screenshot_place()),
            Command::Screenshot => self.wishes.push(Wish::Screenshot),
            Command::Render => self.dialog = Some(Dialog::render(&self.document, &self.clock)),
            Command::Help => self.dialog = Some(Dialog::Help),
        }
    }

    fn pick_for(&mut self, purpose: Purpose) {
        self.message = None;
        self.dialog = Some(Dialog::Pick(Picker::new(purpose, &self.document)));
    }

    /// Saves the file, or asks for its name.
    pub(super) fn save(&mut self) {
        match self.document.save() {
            Ok(()) => self.say(format!("saved {}", self.document.title())),
            Err(DocumentError::NoFile) => self.run(Command::SaveAs),
            Err(DocumentError::ChangedOnDisk { .. }) => self.dialog = Some(Dialog::ChangedOnDisk),
            Err(error) => self.complain(error),
        }
    }

    /// Adds an object where the view looks, or at a place. Returns its id.
    pub fn add(&mut self, kind: &str, at: Option<DVec3>) -> Option<ObjectId> {
        let at = at.unwrap_or_else(|| self.place_for(kind));
        let Some((list, entry)) = new_entry(kind, at) else {
            let kinds = crate::objects::NEW_KINDS.join(", ");
            self.complain(format!("object \"{kind}\"; allowed: {kinds}"));
            return None;
        };
        let result = self.document.add_entry(&KeyPath::of(list), &entry);
        let id = ObjectId { list, index: self.noted(result)? };
        self.selected = [id.clone()].into();
        self.say(format!("added {kind}"));
        Some(id)
    }

    /// Names the object that is selected alone.
    ///
    /// # Errors
    /// As [`crate::document::Document::set`].
    pub fn rename(&mut self, name: &str) -> Result<(), DocumentError> {
        let mut chosen = self.selected.iter().cloned();
        let (Some(id), None) = (chosen.next(), chosen.next()) else {
            return Err(DocumentError::Absent { path: "the selection of one object".to_owned() });
        };
        self.document.set_entry_name(&KeyPath::of(id.list), id.index, name)
    }

    /// A place in the middle of the view, on the ground; lamps and drips above it.
    fn place_for(&self, kind: &str) -> DVec3 {
        let Some(drawn) = &self.drawn else { return DVec3::ZERO };
        let view = &drawn.view;
        let mut ahead = view.forward;
        ahead.y = ahead.y.min(-0.12);
        let ahead = ahead.normalize();
        let ground = drawn
            .distance(ahead)
            .map_or(view.eye + ahead * 8.0, |distance| view.eye + ahead * distance.min(30.0));
        let above = match kind {
            "point" | "spot" | "drip" => 3.0,
            "source" | "sink" | "vortex" => 1.5,
            _ => 0.0,
        };
        (ground + DVec3::Y * above).to_array().map(|edge| (edge * 10.0).round() / 10.0).into()
    }

    fn duplicate(&mut self) {
        let mut copies = Vec::new();
        for list in crate::objects::LISTS {
            let indices = self.selected_of(list);
            if indices.is_empty() {
                continue;
            }
            let result = self.document.duplicate_entries(&KeyPath::of(list), &indices);
            let made = self.noted(result).unwrap_or_default();
            copies.extend(made.into_iter().map(|index| ObjectId { list, index }));
        }
        if copies.is_empty() {
            self.say("nothing is selected");
            return;
        }
        self.say(format!("{} copied", copies.len()));
        self.selected = copies.into_iter().collect();
        self.hidden.clear();
    }

    fn delete(&mut self) {
        let count = self.selected.len();
        for list in crate::objects::LISTS {
            let indices = self.selected_of(list);
            if !indices.is_empty() {
                let result = self.document.remove_entries(&KeyPath::of(list), &indices);
                self.noted(result);
            }
        }
        self.selected.clear();
        self.hidden.clear();
        self.say(if count == 0 { "nothing is selected".to_owned() } else { format!("{count} deleted") });
    }

    fn selected_of(&self, list: &str) -> Vec<usize> {
        self.selected.iter().filter(|id| id.list == list).map(|id| id.index).collect()
    }

    fn frame_selection(&mut self) {
        let Some(drawn) = self.drawn.clone() else { return };
        let objects = self.objects();
        let places: Vec<(DVec3, f64)> = objects
            .iter()
            .filter(|object| self.selected.contains(&object.id))
            .filter_map(|object| {
                let radius = object.radius.as_ref().map_or(1.0, |(_, radius)| *radius);
                Some((object.position.as_ref()?.1, radius.max(object.height.unwrap_or(0.0) * 0.5)))
            })
            .collect();
        let (center, radius) = if places.is_empty() {
            let (low, high) = drawn.bounds();
            ((low + high) * 0.5, ((high - low).length() * 0.5).clamp(1.0, 100.0))
        } else {
            let center = places.iter().map(|(place, _)| *place).sum::<DVec3>() / places.len() as f64;
            let reach = places.iter().map(|(place, radius)| (*place - center).length() + radius);
            (center, reach.fold(1.0, f64::max))
        };
        let mut eye = self.free_eye(&drawn);
        eye.frame(center, radius, &drawn.view);
        self.eye = Some(eye);
    }

    /// The view as keys of the file's camera.
    fn set_camera(&mut self) {
        let Some(drawn) = self.drawn.clone() else { return };
        let eye = self.free_eye(&drawn);
        let key = |name: &str| KeyPath::of("camera").key(name);
        let degrees = |radians: f64| Plain::Number((radians.to_degrees() * 100.0).round() / 100.0);
        let mut yaw = eye.yaw.to_degrees().rem_euclid(360.0);
        if yaw > 180.0 {
            yaw -= 360.0;
        }
        let values = [
            (key("position_m"), Plain::of_numbers(&eye.position.to_array().map(rounded))),
            (key("yaw_deg"), Plain::Number((yaw * 100.0).round() / 100.0)),
            (key("pitch_deg"), degrees(eye.pitch)),
        ];
        let result = self.document.set_and_remove("set camera", &values, &[key("look_at_m")]);
        if self.noted(result).is_some() {
            self.eye = None;
            self.say("the view is the camera of the file");
        }
    }

    /// Begins or ends the record of a flight.
    fn record(&mut self) {
        if let Some(flight) = self.timeline.flight.take() {
            self.clock.is_playing = false;
            let keys = flight.keys();
            let result = self.document.set_and_remove(
                "record camera",
                &keys,
                &[KeyPath::of("camera").key("look_at_m")],
            );
            if self.noted(result).is_some() {
                self.eye = None;
                self.say(format!("recorded {} keys of the camera", flight.len()));
            }
            return;
        }
        let Some(drawn) = self.drawn.clone() else { return };
        self.eye = Some(self.free_eye(&drawn));
        self.timeline.flight = Some(super::timeline::Flight::default());
        self.clock.is_playing = true;
        self.say("recording: fly, then R again");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_command_has_keys_of_its_own() {
        let keys: HashSet<String> =
            Command::ALL.iter().map(|command| format!("{:?}", command.shortcut())).collect();
        assert_eq!(keys.len(), Command::ALL.len());
    }
}
