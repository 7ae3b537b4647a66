//! The dialog in which files are chosen: to open, to save as, to import.

use std::path::{Path, PathBuf};

use egui::{Key, RichText};

use super::App;
use crate::document::Document;
use crate::theme::QUIET;

/// Purpose of a file that is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A weather file or a model is opened.
    Open,
    /// The weather is saved under another name.
    SaveAs,
    /// A model or a sky map is taken into the weather.
    Import,
}

impl Purpose {
    /// The heading, and what the button says.
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Open => ("Open a weather file or a model", "Open"),
            Self::SaveAs => ("Save as", "Save"),
            Self::Import => ("Import a model or a sky map", "Import"),
        }
    }

    /// Ends of the names of files that are listed.
    fn ends(self) -> &'static [&'static str] {
        match self {
            Self::Open => &["toml", "glb", "gltf"],
            Self::SaveAs => &["toml"],
            Self::Import => &["glb", "gltf", "hdr", "exr"],
        }
    }
}

/// The dialog: a folder, and the name that is written or chosen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picker {
    purpose: Purpose,
    folder: PathBuf,
    name: String,
    /// Folders and files to choose from, read when the folder was entered.
    listed: Listed,
    /// The file that the next press of the button replaces: it was said that it exists.
    replaces: Option<PathBuf>,
    /// The field of the name takes the keys when the dialog is drawn first.
    is_new: bool,
}

/// Names in a folder.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Listed {
    folders: Vec<String>,
    files: Vec<String>,
    error: Option<String>,
}

impl Listed {
    /// The folders and the files with some ends, in alphabetical order, without those that begin with a dot.
    fn of(folder: &Path, ends: &[&str]) -> Self {
        let mut listed = Self::default();
        let entries = match std::fs::read_dir(folder) {
            Ok(entries) => entries,
            Err(error) => {
                listed.error = Some(format!("{}: {error}", folder.display()));
                return listed;
            }
        };
        for entry in entries.flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            let path = entry.path();
            let end = path.extension().map(|end| end.to_string_lossy().to_lowercase()).unwrap_or_default();
            if name.starts_with('.') {
                continue;
            }
            if path.is_dir() {
                listed.folders.push(name);
            } else if ends.contains(&end.as_str()) {
                listed.files.push(name);
            }
        }
        listed.folders.sort_by_key(|name| name.to_lowercase());
        listed.files.sort_by_key(|name| name.to_lowercase());
        listed
    }
}

impl Picker {
    /// A dialog in the folder of a document.
    pub(super) fn new(purpose: Purpose, document: &Document) -> Self {
        let place = document.place();
        let folder = place.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = std::path::absolute(folder.unwrap_or(Path::new("."))).unwrap_or_default();
        let name = match purpose {
            Purpose::SaveAs => place.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            Purpose::Open | Purpose::Import => String::new(),
        };
        let listed = Listed::of(&folder, purpose.ends());
        Self { purpose, folder, name, listed, replaces: None, is_new: true }
    }

    /// Shows another folder.
    fn enter(&mut self, folder: PathBuf) {
        self.listed = Listed::of(&folder, self.purpose.ends());
        self.folder = folder;
        if self.purpose != Purpose::SaveAs {
            self.name.clear();
        }
    }

    /// The path that is written or chosen.
    fn path(&self) -> PathBuf {
        self.folder.join(self.name.trim())
    }
}

impl App {
    /// Draws the dialog. False once it is done.
    pub(super) fn choose_file(&mut self, ui: &mut egui::Ui, picker: &mut Picker) -> bool {
        let (heading, button) = picker.purpose.words();
        ui.heading(heading);
        ui.horizontal(|ui| {
            let up = picker.folder.parent().map(Path::to_owned);
            if ui
                .add_enabled(up.is_some(), egui::Button::new("Up"))
                .on_hover_text("the folder above")
                .clicked()
                && let Some(up) = up
            {
                picker.enter(up);
            }
            let folder = RichText::new(picker.folder.display().to_string()).small().color(QUIET);
            ui.add(egui::Label::new(folder).truncate());
        });
        let mut is_taken = self.listed(ui, picker);
        let label = ui.label(
            RichText::new(format!("name or path (.{})", picker.purpose.ends().join(", ."))).color(QUIET),
        );
        let edit = egui::TextEdit::singleline(&mut picker.name).desired_width(f32::INFINITY);
        let edit = ui.add(edit).labelled_by(label.id);
        if std::mem::take(&mut picker.is_new) {
            edit.request_focus();
        }
        is_taken |= edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let replaces = picker.replaces.as_ref().is_some_and(|known| *known == picker.path());
        if replaces {
            ui.label(format!("{} exists.", picker.name.trim()));
        }
        let mut is_open = true;
        ui.horizontal(|ui| {
            is_taken |= ui.button(if replaces { "Replace" } else { button }).clicked();
            is_open = !ui.button("Cancel").clicked();
        });
        if is_taken && is_open {
            is_open = self.take_picked(picker, replaces);
            if is_open {
                edit.request_focus();
            }
        }
        self.last_error(ui);
        is_open
    }

    /// Draws what is in the folder. True if a file was chosen by a double click.
    fn listed(&self, ui: &mut egui::Ui, picker: &mut Picker) -> bool {
        let mut entered = None;
        let mut is_taken = false;
        let height = 260.0;
        let list =
            egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height).auto_shrink(false);
        egui::Frame::group(ui.style()).show(ui, |ui| {
            list.show(ui, |ui| {
                for name in &picker.listed.folders {
                    if ui.selectable_label(false, format!("{name}/")).clicked() {
                        entered = Some(picker.folder.join(name));
                    }
                }
                for name in &picker.listed.files {
                    let entry = ui.selectable_label(picker.name == *name, name);
                    if entry.clicked() {
                        picker.name.clone_from(name);
                    }
                    is_taken |= entry.double_clicked();
                }
                if let Some(error) = &picker.listed.error {
                    ui.label(RichText::new(error).color(ui.visuals().error_fg_color));
                } else if picker.listed.files.is_empty() && picker.listed.folders.is_empty() {
                    ui.label(RichText::new("nothing here that could be chosen").color(QUIET));
                }
            });
        });
        if let Some(folder) = entered {
            picker.enter(folder);
        }
        is_taken
    }

    /// Does what the file was chosen for; a folder is entered. `replaces`: it was said that the file exists. True if the dialog goes on.
    fn take_picked(&mut self, picker: &mut Picker, replaces: bool) -> bool {
        let path = picker.path();
        if path.is_dir() {
            picker.enter(path);
            return true;
        }
        match picker.purpose {
            Purpose::Open | Purpose::Import => {
                self.message = None;
                if picker.purpose == Purpose::Open {
                    self.open(&path);
                } else {
                    self.drop_file(&path);
                }
                // Refused: the message says why, in the dialog, where another name can be given.
                matches!(self.message, Some((_, true)))
            }
            Purpose::SaveAs => {
                let own = self.document.path().and_then(|own| std::path::absolute(own).ok());
                if path.exists() && !replaces && own.as_ref() != Some(&path) {
                    picker.replaces = Some(path);
                    return true;
                }
                let result = self.document.save_as(&path);
                if self.noted(result).is_none() {
                    return true;
                }
                self.say(format!("saved {}", self.document.title()));
                false
            }
        }
    }
}
