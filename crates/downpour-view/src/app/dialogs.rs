//! Questions to the user, and the list of shortcuts.

use std::path::PathBuf;

use downpour::ClipLight;
use egui::{Id, Modal, RichText};

use super::{App, Clock, Command, Picker, Wish};
use crate::document::{Document, Recovery};
use crate::job::{Job, JobSettings};
use crate::theme::QUIET;

/// A question that waits for its answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Dialog {
    /// The list of shortcuts.
    Help,
    /// The file to open, to save as or to import.
    Pick(Picker),
    /// Changes are not saved: at close, or before another file is opened.
    Unsaved {
        /// File to open then; `None` closes the window.
        then: Option<PathBuf>,
    },
    /// Another program has changed the file.
    ChangedOnDisk,
    /// An earlier window did not save.
    Recover(Recovery),
    /// The picture or clip to render.
    Render(JobSettings),
}

impl Dialog {
    /// A question about a clip of the range of the clock.
    pub(super) fn render(document: &Document, clock: &Clock) -> Self {
        let place = document.place();
        let stem = place.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let output = place.with_file_name(format!("{stem}.png")).display().to_string();
        let (is_clip, range_s, fps) = (false, clock.range_s, 24.0);
        let light_frames = ClipLight::FRAMES;
        Self::Render(JobSettings { output, is_clip, range_s, fps, samples: 2, light_frames })
    }
}

/// Keys that are no commands.
const OTHER_KEYS: [(&str, &str); 12] = [
    ("Drag", "orbit"),
    ("Shift drag, middle drag", "pan"),
    ("Right drag", "look around"),
    ("Wheel", "nearer, farther"),
    ("W A S D Q E", "fly; with Shift fast, with Alt on level ground"),
    ("Click, Shift click", "select one, or more"),
    ("Drag a handle", "move, turn, size, strength"),
    ("Backspace", "delete the selected keyframe"),
    ("X", "ease from the selected keyframe to the next"),
    ("Double click a track", "add a keyframe"),
    ("Tab, Shift Tab", "next and previous control"),
    ("Space or Enter, arrows", "press a control, change a number"),
];

impl App {
    /// Asks to close: what is not saved is asked about. True if the window may close.
    pub fn may_close(&mut self) -> bool {
        let is_new = self.document.is_dirty() && self.document.undo_label().is_some();
        if is_new {
            self.dialog = Some(Dialog::Unsaved { then: None });
        }
        !is_new
    }

    /// The question that waits.
    #[must_use]
    pub fn dialog(&self) -> Option<&Dialog> {
        self.dialog.as_ref()
    }

    /// Drops the question that waits.
    pub fn dismiss(&mut self) {
        self.dialog = None;
    }

    /// Draws the question, if there is one.
    pub(super) fn dialogs(&mut self, ui: &egui::Ui) {
        let Some(mut dialog) = self.dialog.take() else { return };
        let context = ui.ctx().clone();
        let mut is_open = true;
        let response = Modal::new(Id::unique("dialog")).show(&context, |ui| {
            ui.set_width(440.0);
            is_open = match &mut dialog {
                Dialog::Help => help(ui),
                Dialog::Pick(picker) => self.choose_file(ui, picker),
                Dialog::Unsaved { then } => self.unsaved(ui, then.clone()),
                Dialog::ChangedOnDisk => self.changed(ui),
                Dialog::Recover(recovery) => self.recover(ui, recovery),
                Dialog::Render(settings) => self.render(ui, settings),
            };
        });
        if is_open && !response.should_close() && self.dialog.is_none() {
            self.dialog = Some(dialog);
        }
    }

    fn unsaved(&mut self, ui: &mut egui::Ui, then: Option<PathBuf>) -> bool {
        ui.heading("Changes are not saved");
        ui.label(format!("{} has changes that no file has.", self.document.title()));
        let mut is_open = true;
        let mut goes_on = false;
        ui.horizontal(|ui| {
            if ui.button("Save").clicked() {
                let result = self.document.save();
                goes_on = self.noted(result).is_some();
            }
            if ui.button("Discard").clicked() {
                self.document.discard_recovery();
                self.is_discarded = then.is_none();
                goes_on = true;
            }
            is_open = !ui.button("Cancel").clicked();
        });
        self.last_error(ui);
        if goes_on {
            is_open = false;
            match then {
                Some(path) => match Document::open(&path) {
                    Ok(document) => self.show(document),
                    Err(error) => self.complain(error),
                },
                None => self.wishes.push(Wish::Close),
            }
        }
        is_open
    }

    fn changed(&mut self, ui: &mut egui::Ui) -> bool {
        ui.heading("Changed on disk");
        ui.label(format!("Another program has changed or deleted {}.", self.document.title()));
        let mut is_open = true;
        ui.horizontal(|ui| {
            if ui.button("Reload").on_hover_text("take what is on disk; undo brings this one back").clicked()
            {
                let result = self.document.reload();
                is_open = self.noted(result).is_none();
            }
            if ui.button("Keep mine").on_hover_text("the next save replaces what is on disk").clicked() {
                self.document.keep_mine();
                is_open = false;
            }
        });
        self.last_error(ui);
        is_open
    }

    fn recover(&mut self, ui: &mut egui::Ui, recovery: &Recovery) -> bool {
        ui.heading("Changes of an earlier session");
        ui.label("The window ended before these changes were saved.");
        ui.label(RichText::new(recovery.path.display().to_string()).small().color(QUIET));
        let mut is_open = true;
        ui.horizontal(|ui| {
            if ui.button("Recover").clicked() {
                let result = self.document.recover(recovery);
                is_open = self.noted(result).is_none();
            }
            if ui.button("Discard").clicked() {
                self.document.discard_recovery();
                is_open = false;
            }
        });
        self.last_error(ui);
        is_open
    }

    fn render(&mut self, ui: &mut egui::Ui, settings: &mut JobSettings) -> bool {
        ui.heading("Render");
        let [width, height] = self.document.weather().size;
        ui.label(RichText::new(format!("{width} x {height}, by output.size")).color(QUIET));
        ui.horizontal(|ui| {
            ui.radio_value(&mut settings.is_clip, false, format!("still at {:.2} s", self.clock.time_s));
            ui.radio_value(&mut settings.is_clip, true, "clip of the range");
        });
        let label =
            ui.label(RichText::new("file: .png or .exr; of a clip the frame's number is added").color(QUIET));
        ui.add(egui::TextEdit::singleline(&mut settings.output).desired_width(f32::INFINITY))
            .labelled_by(label.id);
        ui.horizontal(|ui| {
            let label = ui.label("samples along a pixel's edge");
            ui.add(egui::DragValue::new(&mut settings.samples).range(1..=8)).labelled_by(label.id);
            if settings.is_clip {
                let label = ui.label("frames per second");
                ui.add(egui::DragValue::new(&mut settings.fps).range(1.0..=120.0)).labelled_by(label.id);
                let label = ui.label("frames that share their light");
                ui.add(egui::DragValue::new(&mut settings.light_frames).range(1..=ClipLight::MAX_FRAMES))
                    .labelled_by(label.id);
            }
        });
        let mut is_open = true;
        ui.horizontal(|ui| {
            if ui.button("Render").clicked() {
                if !settings.is_clip {
                    settings.range_s = [self.clock.time_s; 2];
                }
                let request = self.request([width, height]);
                match Job::start(settings, request, self.options.device.clone()) {
                    Ok(job) => self.job = Some(job),
                    Err(error) => self.complain(error),
                }
                is_open = false;
            }
            is_open &= !ui.button("Cancel").clicked();
        });
        is_open
    }

    pub(super) fn last_error(&self, ui: &mut egui::Ui) {
        if let Some((text, true)) = &self.message {
            ui.label(RichText::new(text).color(ui.visuals().error_fg_color));
        }
    }
}

fn help(ui: &mut egui::Ui) -> bool {
    ui.heading("Shortcuts");
    egui::ScrollArea::vertical().max_height(430.0).show(ui, |ui| {
        egui::Grid::new("shortcuts").num_columns(2).striped(true).spacing([24.0, 3.0]).show(ui, |ui| {
            for command in Command::ALL {
                ui.label(RichText::new(ui.ctx().format_shortcut(&command.shortcut())).monospace());
                ui.label(command.label());
                ui.end_row();
            }
            for (keys, meaning) in OTHER_KEYS {
                ui.label(RichText::new(keys).monospace());
                ui.label(meaning);
                ui.end_row();
            }
        });
    });
    ui.add_space(6.0);
    !ui.button("Close").clicked()
}
