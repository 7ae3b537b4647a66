//! The panel on the right: every key of the weather file, made from its schema.

use std::sync::Arc;

use egui::{RichText, ScrollArea};

use super::App;
use super::icons::{self, Icon};
use crate::key_path::KeyPath;
use crate::objects::{set_at, significant};
use crate::plain::Plain;
use crate::schema::{Field, Kind};
use crate::theme::{QUIET, okabe_ito};

/// Width of the names.
const LABEL: f32 = 108.0;

/// An edit that the panel asks for.
enum Edit {
    Set(KeyPath, Plain),
    Remove(KeyPath),
    Add(KeyPath, Plain),
    RemoveEntry(KeyPath, usize),
    /// Makes a constant value a keyframe, or adds one at the time of the clock.
    Key(KeyPath, Plain),
    Refused(String),
}

/// Parts of the window that the panel needs.
struct Panel<'a> {
    time_s: f64,
    filter: &'a str,
    edits: Vec<Edit>,
}

impl App {
    /// The panel.
    pub(super) fn inspector(&mut self, ui: &mut egui::Ui) {
        let schema = Arc::clone(&self.schema);
        let file = self.document.plain().clone();
        egui::Panel::right("keys").default_size(320.0).size_range(240.0..=520.0).show(ui, |ui| {
            ui.add_space(6.0);
            let label = ui.strong("Weather");
            let search = egui::TextEdit::singleline(&mut self.filter)
                .hint_text("find a key")
                .desired_width(f32::INFINITY);
            ui.add(search).labelled_by(label.id);
            ui.add_space(4.0);
            let filter = self.filter.trim().to_lowercase();
            let mut panel = Panel { time_s: self.clock.time_s, filter: &filter, edits: Vec::new() };
            ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
                self.selection(ui, &schema, &file, &mut panel);
                for field in schema.iter() {
                    panel.section(ui, field, file.get(&field.key));
                }
                ui.add_space(20.0);
            });
            for edit in panel.edits {
                self.apply(edit);
            }
        });
    }

    /// Keys of what is selected, on top.
    fn selection(&mut self, ui: &mut egui::Ui, schema: &[Field], file: &Plain, panel: &mut Panel<'_>) {
        let objects = self.objects();
        for object in objects.iter().filter(|object| self.selected.contains(&object.id)) {
            let Some(field) = crate::schema::find(schema, object.id.list) else { continue };
            let entry = file.get(object.id.list).and_then(|list| list.list().get(object.id.index));
            let (Some(entry), path) = (entry, KeyPath::of(object.id.list).entry(object.id.index)) else {
                continue;
            };
            let fields = match &field.kind {
                Kind::Variants(kinds) => {
                    match crate::schema::find(kinds, &object.kind).map(|kind| &kind.kind) {
                        Some(Kind::Table(fields)) => fields,
                        _ => continue,
                    }
                }
                Kind::List(fields) => fields,
                _ => continue,
            };
            let (table, path) = match &field.kind {
                Kind::Variants(_) => (entry.get(&object.kind), path.key(&object.kind)),
                _ => (Some(entry), path),
            };
            let color = crate::theme::kind_color(&object.kind);
            ui.label(RichText::new(self.object_name(object)).strong().color(color));
            ui.push_id(path.to_string(), |ui| panel.table(ui, fields, table, &path));
            ui.separator();
        }
    }

    fn apply(&mut self, edit: Edit) {
        let result = match edit {
            Edit::Set(path, value) => {
                let stroke = Some(self.stroke);
                self.document.set(&path, &value, stroke)
            }
            Edit::Remove(path) => self.document.remove(&path),
            Edit::Add(list, entry) => self.document.add_entry(&list, &entry).map(|_| ()),
            Edit::RemoveEntry(list, index) => self.document.remove_entries(&list, &[index]),
            Edit::Key(path, value) => {
                let keys = self.document.get(&path).and_then(Plain::keys).unwrap_or_default();
                let keys = crate::objects::with_key(&keys, self.clock.time_s, value);
                self.document.set(&path, &keys, None)
            }
            Edit::Refused(message) => {
                self.complain(message);
                return;
            }
        };
        self.noted(result);
    }
}

/// Name of a table for people.
fn title(key: &str) -> String {
    let words = key.replace('_', " ");
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

impl Panel<'_> {
    fn is_shown(&self, field: &Field, table: &str) -> bool {
        self.filter.is_empty()
            || field.key.contains(self.filter)
            || field.label().contains(self.filter)
            || table.contains(self.filter)
    }

    /// A table of the root.
    fn section(&mut self, ui: &mut egui::Ui, field: &Field, value: Option<&Plain>) {
        let path = KeyPath::of(&field.key);
        match &field.kind {
            Kind::Table(fields) => {
                if !fields.iter().any(|inner| self.is_shown(inner, &field.key)) {
                    return;
                }
                let is_set = value.is_some();
                let name = RichText::new(title(&field.key));
                let name = if is_set { name.strong() } else { name.color(QUIET) };
                let open = (!self.filter.is_empty()).then_some(true);
                let header = egui::CollapsingHeader::new(name).id_salt(&field.key).open(open);
                let response = header.show(ui, |ui| self.table(ui, fields, value, &path));
                if !field.about.is_empty() {
                    response.header_response.on_hover_text(&field.about);
                }
            }
            Kind::List(fields) => self.list(ui, field, fields, value, &path, false),
            Kind::Variants(kinds) => self.list(ui, field, kinds, value, &path, true),
            _ if self.is_shown(field, "") => self.row(ui, field, value, &path),
            _ => {}
        }
    }

    /// A list of tables.
    fn list(
        &mut self,
        ui: &mut egui::Ui,
        field: &Field,
        fields: &[Field],
        value: Option<&Plain>,
        path: &KeyPath,
        has_kinds: bool,
    ) {
        let entries = value.map(Plain::list).unwrap_or_default();
        let is_found =
            field.key.contains(self.filter) || fields.iter().any(|inner| self.is_shown(inner, &field.key));
        if !is_found {
            return;
        }
        let name = RichText::new(format!("{} ({})", title(&field.key), entries.len()));
        let name = if entries.is_empty() { name.color(QUIET) } else { name.strong() };
        egui::CollapsingHeader::new(name).id_salt(path.to_string()).show(ui, |ui| {
            for (index, entry) in entries.iter().enumerate() {
                let kind = entry.entries().first().map(|(kind, _)| kind.as_str()).unwrap_or_default();
                let shown = if has_kinds {
                    format!("{kind} {}", index + 1)
                } else {
                    entry_title(entry, &field.key, index)
                };
                let at = path.entry(index);
                ui.horizontal(|ui| {
                    let button = ui.small_button("x").on_hover_text("delete this entry");
                    if button.accessible_name(format!("delete {} {}", field.key, index + 1)).clicked() {
                        self.edits.push(Edit::RemoveEntry(path.clone(), index));
                    }
                    ui.label(RichText::new(shown).color(okabe_ito::SKY));
                });
                let of_kind = fields.iter().find(|inner| has_kinds && inner.key == kind);
                ui.push_id(index, |ui| match of_kind {
                    Some(Field { kind: Kind::Table(inner), .. }) => {
                        self.table(ui, inner, entry.get(kind), &at.key(kind));
                    }
                    _ => self.table(ui, fields, Some(entry), &at),
                });
                ui.separator();
            }
            if let Some(entry) = minimal(&field.key)
                && ui.button(format!("Add {}", field.key)).clicked()
            {
                self.edits.push(Edit::Add(path.clone(), entry));
            }
        });
    }

    /// Keys of a table.
    fn table(&mut self, ui: &mut egui::Ui, fields: &[Field], table: Option<&Plain>, path: &KeyPath) {
        for field in fields {
            let value = table.and_then(|table| table.get(&field.key));
            let inner = path.key(&field.key);
            match &field.kind {
                Kind::Table(fields) => {
                    egui::CollapsingHeader::new(field.label()).id_salt(inner.to_string()).show(ui, |ui| {
                        self.table(ui, fields, value, &inner);
                    });
                }
                Kind::List(fields) => self.list(ui, field, fields, value, &inner, false),
                Kind::Variants(kinds) => self.list(ui, field, kinds, value, &inner, true),
                _ if self.is_shown(field, path.name()) => self.row(ui, field, value, &inner),
                _ => {}
            }
        }
    }

    /// A key with its value.
    fn row(&mut self, ui: &mut egui::Ui, field: &Field, value: Option<&Plain>, path: &KeyPath) {
        ui.horizontal(|ui| {
            let name = RichText::new(field.label());
            let name = if value.is_some() { name } else { name.color(QUIET) };
            let label = egui::Label::new(name).truncate().selectable(false);
            let layout = egui::Layout::left_to_right(egui::Align::Center);
            let name = ui.allocate_ui_with_layout(egui::vec2(LABEL, 20.0), layout, |ui| {
                ui.set_min_width(LABEL);
                ui.add(label)
            });
            let response = name.inner;
            let default = if field.default.is_empty() { "none" } else { &field.default };
            response.on_hover_text(format!("{}\n\n{}\ndefault: {default}", path, field.about));
            self.value(ui, field, value, path);
            let has_keys = value.is_some_and(|value| field.is_keyed && value.keys().is_some());
            if field.is_keyed && value.is_some() {
                let (icon, color) =
                    if has_keys { (Icon::Key, okabe_ito::YELLOW) } else { (Icon::NoKey, QUIET) };
                let button = icons::button(ui, icon, color, &format!("key {path}"));
                if button.on_hover_text("keyframe at the time of the clock").clicked()
                    && let Some(value) = value
                {
                    self.edits.push(Edit::Key(path.clone(), value.at(self.time_s)));
                }
            }
            if value.is_some() {
                let button = icons::button(ui, Icon::Reset, QUIET, &format!("reset {path}"));
                if button.on_hover_text(format!("back to the default: {default}")).clicked() {
                    self.edits.push(Edit::Remove(path.clone()));
                }
            }
        });
    }

    /// Sets a value at the time of the clock.
    fn set(&mut self, path: &KeyPath, old: Option<&Plain>, value: Plain) {
        self.edits.push(Edit::Set(path.clone(), set_at(old, self.time_s, value)));
    }

    fn value(&mut self, ui: &mut egui::Ui, field: &Field, value: Option<&Plain>, path: &KeyPath) {
        let now = value.map(|value| if field.is_keyed { value.at(self.time_s) } else { value.clone() });
        match &field.kind {
            Kind::Number { min, max, is_whole } => {
                let shown = now.as_ref().and_then(Plain::number).or_else(|| field.default_number());
                match shown {
                    Some(mut number) => {
                        let before = number;
                        let drag = drag(&mut number, *min, *max, *is_whole).suffix(suffix(field));
                        let response = quiet(ui, value.is_none(), |ui| ui.add(drag));
                        let response = response.accessible_name(path.to_string());
                        if response.changed() && number != before {
                            let number = if *is_whole { number.round() } else { significant(number) };
                            self.set(path, value, Plain::Number(number));
                        }
                    }
                    None => self.unset(ui, field, path, Plain::Number(1.0_f64.clamp(*min, *max))),
                }
            }
            Kind::Bool => {
                let mut truth = match &now {
                    Some(Plain::Bool(truth)) => *truth,
                    _ => field.default.starts_with("true"),
                };
                let response = ui.checkbox(&mut truth, "").accessible_name(path.to_string());
                if response.changed() {
                    self.set(path, None, Plain::Bool(truth));
                }
            }
            Kind::Words(words) => {
                let shown = now.as_ref().and_then(Plain::text).map(str::to_owned);
                let text = shown.clone().unwrap_or_else(|| field.default.trim_matches('`').to_owned());
                let text =
                    if shown.is_none() { RichText::new(text).color(QUIET) } else { RichText::new(text) };
                let combo = egui::ComboBox::from_id_salt(path.to_string()).selected_text(text).width(150.0);
                let response = combo.show_ui(ui, |ui| {
                    for word in words {
                        if ui.selectable_label(shown.as_deref() == Some(word), word).clicked() {
                            self.set(path, None, Plain::Text(word.clone()));
                        }
                    }
                });
                response.response.accessible_name(path.to_string());
            }
            Kind::Vector { count, min, max } => {
                self.vector(ui, field, value, path, now.as_ref(), *count, [*min, *max]);
            }
            Kind::Text | Kind::Raw => self.raw(ui, field, value, path),
            Kind::Table(_) | Kind::List(_) | Kind::Variants(_) => {}
        }
    }

    /// Some numbers, or a color.
    #[expect(clippy::too_many_arguments, reason = "parts of one row")]
    fn vector(
        &mut self,
        ui: &mut egui::Ui,
        field: &Field,
        value: Option<&Plain>,
        path: &KeyPath,
        now: Option<&Plain>,
        count: usize,
        [min, max]: [f64; 2],
    ) {
        let shown = now.and_then(Plain::numbers).or_else(|| field.default_vector());
        let Some(mut numbers) = shown.filter(|numbers| numbers.len() == count) else {
            self.unset(ui, field, path, Plain::of_numbers(&vec![1.0_f64.clamp(min, max); count]));
            return;
        };
        let before = numbers.clone();
        quiet(ui, value.is_none(), |ui| {
            ui.spacing_mut().item_spacing.x = 3.0;
            if field.is_color() && max <= 1.0 {
                let mut color: [f32; 3] = std::array::from_fn(|k| numbers.get(k).map_or(0.0, |&n| n as f32));
                if ui.color_edit_button_rgb(&mut color).changed() {
                    numbers = color.iter().map(|&part| significant(f64::from(part))).collect();
                }
            }
            for (k, number) in numbers.iter_mut().enumerate() {
                let drag = drag(number, min, max, false);
                let name = format!("{path}[{k}]");
                ui.add_sized([48.0, 20.0], drag).accessible_name(name);
            }
            ui.label(RichText::new(field.unit()).small().color(QUIET));
        });
        if numbers != before {
            let numbers: Vec<f64> = numbers.into_iter().map(significant).collect();
            self.set(path, value, Plain::of_numbers(&numbers));
        }
    }

    /// A value as it is written in the file.
    fn raw(&mut self, ui: &mut egui::Ui, field: &Field, value: Option<&Plain>, path: &KeyPath) {
        let is_text = field.kind == Kind::Text;
        let written = match value {
            Some(Plain::Text(text)) if is_text => text.clone(),
            Some(value) => value.to_value().to_string().trim().to_owned(),
            None => String::new(),
        };
        let id = ui.make_persistent_id(("raw", path.to_string()));
        let mut text = ui.data_mut(|data| data.get_temp::<String>(id)).unwrap_or_else(|| written.clone());
        let hint = field.default.replace('`', "");
        let edit = egui::TextEdit::singleline(&mut text).hint_text(hint).desired_width(150.0);
        let response = ui.add(edit).accessible_name(path.to_string());
        if response.has_focus() {
            ui.data_mut(|data| data.insert_temp(id, text.clone()));
        }
        if response.lost_focus() {
            ui.data_mut(|data| data.remove::<String>(id));
            if text != written && !text.is_empty() {
                let parsed = if is_text { Ok(Plain::Text(text)) } else { Plain::parse(&text) };
                self.edits.push(match parsed {
                    Ok(value) => Edit::Set(path.clone(), value),
                    Err(message) => Edit::Refused(format!("{path}: {message}")),
                });
            }
        }
    }

    /// A value that is not given, and whose default is no number.
    fn unset(&mut self, ui: &mut egui::Ui, field: &Field, path: &KeyPath, value: Plain) {
        let text = if field.default.is_empty() { "not set" } else { &field.default };
        let text = RichText::new(text.replace('`', "")).color(QUIET).small();
        let button = egui::Button::new(text).truncate();
        let response = ui.add_sized([150.0, 20.0], button).on_hover_text("set a value");
        if response.accessible_name(format!("set {path}")).clicked() {
            self.set(path, None, value);
        }
    }
}

/// Draws a default in a quiet color.
fn quiet<R>(ui: &mut egui::Ui, is_quiet: bool, draw: impl FnOnce(&mut egui::Ui) -> R) -> R {
    ui.scope(|ui| {
        if is_quiet {
            ui.visuals_mut().override_text_color = Some(QUIET);
        }
        draw(ui)
    })
    .inner
}

/// A number to drag or to type; drags go by a part of the number.
fn drag(number: &mut f64, min: f64, max: f64, is_whole: bool) -> egui::DragValue<'_> {
    let span = max - min;
    let speed = if is_whole {
        0.2
    } else {
        (number.abs() * 0.01).clamp(span.min(1.0) * 1.0e-3, span.max(1.0e-6) * 0.01)
    };
    egui::DragValue::new(number)
        .range(min..=max)
        .speed(speed)
        .clamp_existing_to_range(false)
        .custom_formatter(move |number, _| short(number))
}

/// A number with the digits that it has, four decimals at most where it is not small.
fn short(number: f64) -> String {
    if number != 0.0 && number.abs() < 1.0e-2 {
        return format!("{number}");
    }
    let text = format!("{number:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn suffix(field: &Field) -> String {
    match field.unit() {
        "" => String::new(),
        "°" => "°".to_owned(),
        unit => format!(" {unit}"),
    }
}

/// Name of an entry, by its file if it has one.
fn entry_title(entry: &Plain, list: &str, index: usize) -> String {
    match entry.get("file").and_then(Plain::text) {
        Some(file) => file.rsplit('/').next().unwrap_or(file).to_owned(),
        None => format!("{} {}", title(list), index + 1),
    }
}

/// An entry of a list with the keys that it must have; `None` for those that the menu of objects adds.
fn minimal(list: &str) -> Option<Plain> {
    let numbers = |values: &[f64]| Plain::of_numbers(values);
    let entries: Vec<(&str, Plain)> = match list {
        // Any glass of the scene.
        "pane" => Vec::new(),
        "flash" => vec![("time_s", Plain::Number(1.0)), ("azimuth_deg", Plain::Number(0.0))],
        "wiper" => vec![
            ("pivot_m", numbers(&[0.3, 0.38])),
            ("length_m", Plain::Number(0.33)),
            ("from_deg", Plain::Number(12.0)),
            ("to_deg", Plain::Number(168.0)),
            ("period_s", Plain::Number(1.5)),
        ],
        "worn" => vec![("from_m", Plain::Number(0.1)), ("to_m", Plain::Number(0.12))],
        _ => return None,
    };
    Some(Plain::Table(entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()))
}
