//! Scripts of the window: the same documents, panels and handles, without a display.
//!
//! A script is text with a step on each line; `#` begins a comment. Paths are those of the process.
//!
//! | step | does |
//! |---|---|
//! | `open FILE` | opens a weather file or a model |
//! | `add KIND [X Y Z]` | adds an object at a place, or where the view looks, and selects it |
//! | `select LIST[INDEX] ...` | selects objects, such as `wind[0]`; without arguments none |
//! | `drag x|y|z METERS`, `drag radius|width|length|strength FACTOR`, `drag turn DEGREES` | drags a handle of the selection in the picture |
//! | `set KEY VALUE`, `reset KEY` | sets a key at the time of the clock to a value as TOML writes it; takes its default |
//! | `key KEY TIME VALUE`, `unkey KEY TIME` | sets or deletes a keyframe |
//! | `name TEXT` | names the selected object |
//! | `command NAME` | a command of the menus by its label, such as `command Duplicate` |
//! | `press KEYS` | presses a key, such as `Ctrl+Z` |
//! | `time SECONDS` | sets the clock |
//! | `slice HEIGHT`, `tracers` | shows the wind |
//! | `paint X Z RADIUS [X Z RADIUS ...]` | paints a puddle on the ground |
//! | `save`, `save-as FILE` | saves |
//! | `close` | closes; refused while changes are not saved |
//! | `wait N` | draws N more pictures of the present state |
//! | `measure N` | draws N pictures of a running clock, and tells how fast they come and at what scale |
//! | `type TEXT` | writes text into the field that has the focus |
//! | `screenshot FILE.png` | writes the window, once its picture shows the present state |
//! | `drops FILE.csv` | writes the drops of the picture |
//! | `quit` | ends the script |

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::{Key, Modifiers, Pos2};
use glam::DVec3;

use crate::app::{App, AppOptions, Command, HandleKind, Wish};
use crate::document::{Document, write_whole};
use crate::key_path::KeyPath;
use crate::objects::{LISTS, ObjectId};
use crate::offscreen::Offscreen;
use crate::plain::Plain;

/// Time between two passes of a window on a display.
const REFRESH: Duration = Duration::from_micros(16_667);

/// Time after which a measurement ends with the pictures that it has.
const MEASURE_MAX: Duration = Duration::from_secs(120);

/// Step of a script that did not work.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}: line {line}: {message}")]
pub struct ScriptError {
    /// The script.
    pub file: String,
    /// Number of the line, from 1.
    pub line: usize,
    /// The error.
    pub message: String,
}

/// Options of a script.
#[derive(Clone, Debug)]
pub struct ScriptOptions {
    /// Size of the window, in pixels.
    pub size: [u32; 2],
    /// Options of the application.
    pub app: AppOptions,
}

/// Words of a line; quotes hold a word together.
fn words(line: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = line.trim();
    while !rest.is_empty() && !rest.starts_with('#') {
        let (word, after) = match rest.strip_prefix('\'') {
            Some(quoted) => quoted.split_once('\'').unwrap_or((quoted, "")),
            None => rest.split_at(rest.find(char::is_whitespace).unwrap_or(rest.len())),
        };
        words.push(word);
        rest = after.trim_start();
    }
    words
}

/// Runs a script over a document. What it says goes to `told`.
///
/// # Errors
/// [`ScriptError`] of the first step that does not work.
pub fn run(
    file: &str,
    script: &str,
    document: Document,
    options: &ScriptOptions,
    told: &mut dyn FnMut(&str),
) -> Result<(), ScriptError> {
    let failed = |line: usize, message: String| ScriptError { file: file.to_owned(), line, message };
    let app = App::new(document, options.app.clone()).map_err(|error| failed(0, error.to_string()))?;
    let mut session = Session { app, window: Offscreen::new(options.size), is_closed: false };
    for (index, line) in script.lines().enumerate() {
        let words = words(line);
        let Some((&step, arguments)) = words.split_first() else { continue };
        if step == "quit" {
            break;
        }
        let done = session.step(step, arguments, line, told);
        done.map_err(|message| failed(index + 1, message))?;
    }
    session.app.document_mut().discard_recovery();
    Ok(())
}

struct Session {
    app: App,
    window: Offscreen,
    is_closed: bool,
}

fn number(words: &[&str], index: usize, what: &str) -> Result<f64, String> {
    let word = words.get(index).ok_or_else(|| format!("no {what}; allowed: a number"))?;
    let value: f64 = word.parse().map_err(|_| format!("{what} is \"{word}\"; allowed: a number"))?;
    if value.is_finite() { Ok(value) } else { Err(format!("{what} is {word}; allowed: a finite number")) }
}

fn word<'a>(words: &[&'a str], index: usize, what: &str) -> Result<&'a str, String> {
    words.get(index).copied().ok_or_else(|| format!("no {what}"))
}

fn path(words: &[&str], index: usize) -> Result<PathBuf, String> {
    word(words, index, "file").map(PathBuf::from)
}

fn key(words: &[&str]) -> Result<KeyPath, String> {
    KeyPath::parse(word(words, 0, "key")?).map_err(|error| error.to_string())
}

/// The rest of a line after some words, which is a value.
fn value(line: &str, skipped: usize) -> Result<Plain, String> {
    let mut rest = line.trim();
    for _ in 0..skipped {
        rest = rest.split_once(char::is_whitespace).map_or("", |(_, after)| after.trim_start());
    }
    Plain::parse(rest)
}

/// An object by its entry, such as `wind[0]`.
fn object(text: &str) -> Result<ObjectId, String> {
    let bad = || format!("object \"{text}\"; allowed: such as wind[0], in {}", LISTS.join(", "));
    let (list, index) = text.strip_suffix(']').and_then(|text| text.split_once('[')).ok_or_else(bad)?;
    let list = LISTS.into_iter().find(|known| *known == list).ok_or_else(bad)?;
    Ok(ObjectId { list, index: index.parse().map_err(|_| bad())? })
}

/// A key with what is held with it.
fn keys(text: &str) -> Result<(Modifiers, Key), String> {
    let mut modifiers = Modifiers::NONE;
    let mut parts: Vec<&str> = text.split('+').collect();
    let last = parts.pop().unwrap_or_default();
    for part in parts {
        modifiers = modifiers.plus(match part {
            "Ctrl" => Modifiers::COMMAND.plus(Modifiers::CTRL),
            "Shift" => Modifiers::SHIFT,
            "Alt" => Modifiers::ALT,
            _ => return Err(format!("key \"{text}\"; allowed: with Ctrl, Shift, Alt, such as Ctrl+Z")),
        });
    }
    let key =
        Key::from_name(last).ok_or_else(|| format!("key \"{last}\"; allowed: such as Z, F1, Delete"))?;
    Ok((modifiers, key))
}

impl Session {
    fn step(
        &mut self,
        step: &str,
        words: &[&str],
        line: &str,
        told: &mut dyn FnMut(&str),
    ) -> Result<(), String> {
        if self.is_closed && step != "open" {
            return Err(format!("{step} after close; allowed: open"));
        }
        let edited =
            |result: Result<(), crate::document::DocumentError>| result.map_err(|error| error.to_string());
        match step {
            "open" => {
                let document = Document::open(&path(words, 0)?).map_err(|error| error.to_string())?;
                self.is_closed = false;
                self.app.show(document);
            }
            "add" => {
                let at = match words.len() {
                    1 => {
                        self.settle()?;
                        None
                    }
                    _ => Some(DVec3::new(
                        number(words, 1, "x")?,
                        number(words, 2, "y")?,
                        number(words, 3, "z")?,
                    )),
                };
                if self.app.add(word(words, 0, "kind")?, at).is_none() {
                    return self.complaint();
                }
            }
            "select" => {
                let ids = words.iter().map(|text| object(text)).collect::<Result<Vec<_>, _>>()?;
                self.app.select(ids);
            }
            "drag" => self.drag(word(words, 0, "handle")?, number(words, 1, "length")?)?,
            "set" => {
                let path = key(words)?;
                let value = value(line, 2)?;
                edited(self.app.set(&path, value))?;
            }
            "reset" => edited(self.app.document_mut().remove(&key(words)?))?,
            "key" => {
                let (path, time) = (key(words)?, number(words, 1, "time")?);
                edited(self.app.set_key(&path, time, value(line, 3)?))?;
            }
            "unkey" => {
                self.app.delete_key(&key(words)?, number(words, 1, "time")?);
                return self.complaint();
            }
            "name" => edited(self.app.rename(&words.join(" ")))?,
            "command" => {
                let label = words.join(" ");
                let known =
                    Command::ALL.into_iter().find(|command| command.label().trim_end_matches('…') == label);
                let labels = || Command::ALL.map(|command| command.label().trim_end_matches('…')).join(", ");
                self.app.run(known.ok_or_else(|| format!("command \"{label}\"; allowed: {}", labels()))?);
                let wishes = self.window.pass(&mut self.app, Vec::new());
                self.grant(wishes)?;
            }
            "press" => {
                let (modifiers, key) = keys(word(words, 0, "key")?)?;
                let wishes = self.window.key(&mut self.app, modifiers, key);
                self.grant(wishes)?;
            }
            "type" => {
                let text = egui::Event::Text(words.join(" "));
                let wishes = self.window.pass(&mut self.app, vec![text]);
                self.grant(wishes)?;
            }
            "time" => self.app.clock_mut().time_s = number(words, 0, "time")?.max(0.0),
            "slice" => {
                let height = number(words, 0, "height")?;
                let overlay = self.app.overlay_mut();
                (overlay.has_slice, overlay.slice_m) = (true, height);
            }
            "tracers" => self.app.overlay_mut().has_tracers = true,
            "paint" => self.paint(words)?,
            "save" => edited(self.app.document_mut().save())?,
            "save-as" => edited(self.app.document_mut().save_as(&path(words, 0)?))?,
            "close" => self.close()?,
            "measure" => {
                let count = number(words, 0, "number of pictures")?.clamp(1.0, 1000.0) as usize;
                told(&self.measure(count)?);
            }
            "wait" => {
                for _ in 0..number(words, 0, "number of pictures")?.clamp(0.0, 1000.0) as u32 {
                    self.app.draw_again();
                    self.settle()?;
                }
            }
            "screenshot" => {
                let path = path(words, 0)?;
                self.screenshot(&path)?;
                told(&format!("wrote {}", path.display()));
            }
            "drops" => {
                self.app.list_drops();
                self.settle()?;
                let path = path(words, 0)?;
                let listed = self.app.drawn().and_then(|drawn| drawn.drops_csv());
                let text = listed.ok_or("there is no picture")?;
                write_whole(&path, text.as_bytes()).map_err(|error| error.to_string())?;
                told(&format!("wrote {}", path.display()));
            }
            _ => return Err(format!("step \"{step}\"; allowed: {STEPS}")),
        }
        Ok(())
    }

    fn close(&mut self) -> Result<(), String> {
        if !self.app.is_discarded() && !self.app.may_close() {
            self.app.dismiss();
            return Err("changes are not saved; allowed: save before close".to_owned());
        }
        self.is_closed = true;
        Ok(())
    }

    /// Writes the window once its picture shows the present state.
    fn screenshot(&mut self, path: &Path) -> Result<(), String> {
        self.window.rest(&mut self.app);
        self.settle()?;
        self.window.screenshot(path)
    }

    /// Does what the application wishes of the window around it.
    fn grant(&mut self, wishes: Vec<Wish>) -> Result<(), String> {
        for wish in wishes {
            match wish {
                Wish::Close => self.close()?,
                Wish::FullScreen => return Err("without a display there is no screen to fill".to_owned()),
                Wish::Screenshot => self.screenshot(&self.app.screenshot_place())?,
            }
        }
        Ok(())
    }

    /// Draws pictures of a running clock, with passes of the window 60 times a second as on a display. Returns what was measured over the
    /// second half of the pictures: the first ones find the scale.
    fn measure(&mut self, count: usize) -> Result<String, String> {
        let begin = Instant::now();
        let is_playing = std::mem::replace(&mut self.app.clock_mut().is_playing, true);
        let (mut shown, mut last) = (Vec::with_capacity(count), None);
        while shown.len() < count {
            let pass = Instant::now();
            self.window.pass(&mut self.app, Vec::new());
            let newest = self.app.drawn().filter(|drawn| last != Some(drawn.number));
            if let Some(drawn) = newest {
                last = Some(drawn.number);
                shown.push((begin.elapsed(), drawn.frame_ms));
            }
            if begin.elapsed() > MEASURE_MAX {
                break;
            }
            std::thread::sleep(REFRESH.saturating_sub(pass.elapsed()));
        }
        self.app.clock_mut().is_playing = is_playing;
        self.complaint()?;
        let drawn = self.app.drawn().ok_or("there is no picture")?;
        let late = shown.split_off(shown.len() / 2);
        let (Some((first, _)), Some((end, _))) = (late.first(), late.last()) else {
            return Err("too few pictures; allowed: measure N with more".to_owned());
        };
        let per_second = (late.len() - 1) as f64 / (*end - *first).as_secs_f64().max(1.0e-6);
        let mut frames_ms: Vec<f64> = late.iter().map(|(_, ms)| *ms).collect();
        frames_ms.sort_by(f64::total_cmp);
        let median = frames_ms.get(frames_ms.len() / 2).copied().unwrap_or_default();
        let ([width, height], [across, down]) = (drawn.size, self.app.window_size());
        let long = drawn.passes.iter().filter(|(_, ms)| *ms >= 0.05);
        let passes: Vec<String> = long.map(|(name, ms)| format!("{name} {ms:.1} ms")).collect();
        Ok(format!(
            "{per_second:.1} pictures per second of {width} x {height} in a window of {across} x {down}, {median:.1} ms each ({:.1} ms until it is on its way), {} drops, {}; {}",
            drawn.begin_ms,
            drawn.drops_drawn,
            drawn.adapter,
            passes.join(", "),
        ))
    }

    /// Draws until the picture shows the present state.
    fn settle(&mut self) -> Result<(), String> {
        if !self.window.settle(&mut self.app) {
            return Err("no picture within ten minutes".to_owned());
        }
        let is_shown = self.app.drawn().is_some_and(|drawn| drawn.revision == self.app.document().revision());
        if is_shown { Ok(()) } else { self.complaint() }
    }

    fn complaint(&self) -> Result<(), String> {
        match self.app.message() {
            Some((text, true)) => Err(text.clone()),
            _ => Ok(()),
        }
    }

    /// Drags a handle with the pointer, from where it is to where it is to be.
    fn drag(&mut self, handle: &str, by: f64) -> Result<(), String> {
        self.settle()?;
        let axis = ["x", "y", "z"].iter().position(|name| *name == handle);
        let kind = match (handle, axis) {
            (_, Some(axis)) => HandleKind::Axis(axis),
            ("radius", _) => HandleKind::Radius,
            ("width", _) => HandleKind::Edge(0),
            ("length", _) => HandleKind::Edge(1),
            ("turn", _) => HandleKind::Direction,
            ("strength", _) => HandleKind::Strength,
            _ => {
                return Err(format!(
                    "handle \"{handle}\"; allowed: x, y, z, radius, width, length, turn, strength"
                ));
            }
        };
        let known = self.app.handles().iter().find(|known| known.kind == kind).copied();
        let known = known.ok_or_else(|| format!("the selection has no handle {handle} in the picture"))?;
        let to =
            self.app.dragged_place(&known, by).ok_or_else(|| format!("{by} is not within the picture"))?;
        let from: Pos2 = known.at;
        self.window.drag(&mut self.app, from, to);
        self.complaint()
    }

    /// Paints spots on the ground under them.
    fn paint(&mut self, words: &[&str]) -> Result<(), String> {
        self.settle()?;
        let drawn = self.app.drawn().cloned().ok_or("there is no picture")?;
        if words.is_empty() || !words.len().is_multiple_of(3) {
            return Err("allowed: paint X Z RADIUS, once or more".to_owned());
        }
        for spot in 0..words.len() / 3 {
            let [x, z, radius] = [0, 1, 2].map(|k| number(words, 3 * spot + k, "X, Z or RADIUS"));
            let (x, z) = (x?, z?);
            let ground = drawn.ground_below(DVec3::new(x, drawn.view.eye.y, z));
            let at = ground.ok_or_else(|| format!("no ground at x {x}, z {z}"))?;
            self.app.set_brush_radius(radius?);
            self.app.paint_at(at);
        }
        self.app.end_painting();
        self.complaint()
    }
}

/// Steps of a script.
const STEPS: &str = "open, add, select, drag, set, reset, key, unkey, name, command, press, type, time, slice, tracers, paint, \
                     save, save-as, close, wait, measure, screenshot, drops, quit";

/// Reads a script.
///
/// # Errors
/// Message of the system.
pub fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_words_and_values() {
        assert_eq!(words("  set rain.rate_mm_h 5 # more"), ["set", "rain.rate_mm_h", "5"]);
        assert_eq!(words("open 'a b.toml'"), ["open", "a b.toml"]);
        assert!(words("# all").is_empty());
        assert_eq!(value("set a.b [1, 2]", 2), Ok(Plain::of_numbers(&[1.0, 2.0])));
        assert!(value("set a.b", 2).is_err());
        assert_eq!(object("wind[3]"), Ok(ObjectId { list: "wind", index: 3 }));
        assert!(object("rain[0]").is_err() && object("wind").is_err() && object("wind[x]").is_err());
        assert_eq!(keys("Ctrl+Shift+Z").unwrap().1, Key::Z);
        assert!(keys("Hyper+Z").is_err());
    }
}
