//! Journal of a clip, in a file beside its frames: `.NAME.downpour-job`.
//!
//! The first line is the [`Job`]. Then comes a line for the exposure, and one for each frame *before* the frame gets its
//! name: every file with a frame's name is known by its digest, or is not from this clip. Each line begins with a digest of
//! its remaining text, so that a truncated or edited line counts as not written. The file is locked while a process works on it.

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead, BufReader, Write as _};
use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};

use super::job::{Job, digest};
use crate::failure::{FILES, Failure, INPUT, LIMIT, shown};
use crate::interrupt::Interrupt;

/// The version of the file.
const VERSION: u64 = 1;

/// The longest file that is read, in bytes: a thousand for each frame of the longest clip.
const MAX_BYTES: u64 = 1 << 30;

/// Maximum length of a line, in bytes: longer ones count as not written.
const MAX_LINE: usize = 1 << 20;

/// Digits of a line's digest.
const CHECK_DIGITS: usize = 16;

/// Record of a frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Record {
    /// The digest of the picture's file.
    pub(super) picture: String,
    /// That of the list of drops, if there is one.
    pub(super) drops: Option<String>,
    /// Its entry in `--stats`.
    pub(super) stats: Value,
}

/// The journal of a clip that this process works on.
#[derive(Debug)]
pub(super) struct Journal {
    path: PathBuf,
    file: File,
    content: Content,
}

/// Contents of a journal.
#[derive(Debug, Default)]
struct Content {
    overwrite: bool,
    exposure: Option<f32>,
    frames: BTreeMap<u32, Record>,
    video: Option<String>,
}

/// The journal of files with this name.
pub(super) fn path_of(name: &Path) -> PathBuf {
    let file = name.file_name().unwrap_or_default().to_string_lossy();
    name.with_file_name(format!(".{file}.downpour-job"))
}

impl Journal {
    /// Opens or creates a journal, and locks it. `anew`: existing contents are discarded.
    ///
    /// # Errors
    /// Exit code 2 for the journal of another job, or one that cannot be read; 5 if another process works on it, or for
    /// a path that cannot be written.
    pub(super) fn open(path: &Path, job: &Job, anew: bool, interrupt: &Interrupt) -> Result<Self, Failure> {
        let failed = |error: &io::Error| Failure::file(path, error);
        let file = locked(path)?;
        let mut found = Found::default();
        if !anew {
            if file.metadata().map_err(|error| failed(&error))?.len() > MAX_BYTES {
                let found = format!("{}: more than {MAX_BYTES} bytes", shown(path));
                return Err(Failure::new(
                    LIMIT,
                    format!("{found}; allowed: a journal of downpour, or --overwrite"),
                ));
            }
            found = read(BufReader::new(&file), &header_of(job)).map_err(|error| failed(&error))?;
        }
        let Found { whole, header, content } = found;
        let same = header.as_ref().is_some_and(|header| *header == header_of(job));
        let worked = !content.frames.is_empty();
        if worked && !same {
            return Err(other_job(path, header.as_ref(), job));
        }
        let mut journal = Self { path: path.to_owned(), file, content };
        if worked {
            journal.file.set_len(whole).map_err(|error| failed(&error))?;
        } else {
            journal.content = Content::default();
            journal.file.set_len(0).map_err(|error| failed(&error))?;
            journal.append(&header_of(job), interrupt)?;
            if anew {
                journal.append(&json!({ "overwrite": true }), interrupt)?;
                journal.content.overwrite = true;
            }
        }
        Ok(journal)
    }

    /// True if the clip was started over existing files. It continues so.
    pub(super) fn overwrites(&self) -> bool {
        self.content.overwrite
    }

    /// Exposure of the clip, once it is known.
    pub(super) fn exposure(&self) -> Option<f32> {
        self.content.exposure
    }

    pub(super) fn frame(&self, number: u32) -> Option<&Record> {
        self.content.frames.get(&number)
    }

    /// Digest of the video, if one was about to be published.
    pub(super) fn video(&self) -> Option<&str> {
        self.content.video.as_deref()
    }

    /// # Errors
    /// As [`record`](Self::record).
    pub(super) fn expose(&mut self, exposure: f32, interrupt: &Interrupt) -> Result<(), Failure> {
        self.append(&json!({ "exposure_bits": exposure.to_bits(), "exposure": exposure }), interrupt)?;
        self.content.exposure = Some(exposure);
        Ok(())
    }

    /// Records a frame just before it is published.
    ///
    /// # Errors
    /// Exit code 5, with the error of the system.
    pub(super) fn record(
        &mut self,
        number: u32,
        record: Record,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let Record { picture, drops, stats } = &record;
        let line = json!({ "frame": number, "picture": picture, "drops": drops, "stats": stats });
        self.append(&line, interrupt)?;
        self.content.frames.insert(number, record);
        Ok(())
    }

    /// # Errors
    /// As [`record`](Self::record).
    pub(super) fn record_video(&mut self, digest: String, interrupt: &Interrupt) -> Result<(), Failure> {
        self.append(&json!({ "video": digest }), interrupt)?;
        self.content.video = Some(digest);
        Ok(())
    }

    fn append(&mut self, value: &Value, interrupt: &Interrupt) -> Result<(), Failure> {
        let text = value.to_string();
        let line = format!("{} {text}\n", check(&text));
        // A signal waits until the line is complete.
        let _unfinished = interrupt.unfinished();
        let written = self.file.write_all(line.as_bytes()).and_then(|()| self.file.sync_data());
        written.map_err(|error| Failure::file(&self.path, &error))
    }

    /// The numbers of all frames that were ever written down.
    pub(super) fn numbers(&self) -> Vec<u32> {
        self.content.frames.keys().copied().collect()
    }

    /// Removes the file. The lock is released after it.
    pub(super) fn remove(self) {
        let _ = fs::remove_file(&self.path);
    }

    /// Removes the file if it has nothing to resume from.
    pub(super) fn close(self) {
        if self.content.frames.is_empty() {
            self.remove();
        }
    }
}

/// Opens the file and locks it. A symbolic link is not followed.
fn locked(path: &Path) -> Result<File, Failure> {
    let failed = |error: &io::Error| Failure::file(path, error);
    let plain = |found: io::Result<fs::Metadata>| match found {
        Ok(found) if found.is_file() => Ok(true),
        Ok(_) => {
            Err(Failure::new(FILES, format!("{} is not a plain file; allowed: a plain file", shown(path))))
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(failed(&error)),
    };
    let is_there = plain(fs::symlink_metadata(path))?;
    let mut options = OpenOptions::new();
    options.read(true).append(true);
    let opened = if is_there { options.open(path) } else { options.create_new(true).open(path) };
    let busy = || {
        let found = format!("{}: another downpour works on this clip", shown(path));
        Failure::new(FILES, format!("{found}; allowed: to wait for it, or another name"))
    };
    let file = match opened {
        Ok(file) => file,
        // Another process created it in between.
        Err(error) if !is_there && error.kind() == io::ErrorKind::AlreadyExists => return Err(busy()),
        Err(error) => return Err(failed(&error)),
    };
    match file.try_lock() {
        Err(fs::TryLockError::WouldBlock) => return Err(busy()),
        // A file system without locks does without.
        Ok(()) | Err(fs::TryLockError::Error(_)) => {}
    }
    // The previous owner of the lock may have removed the file.
    if !plain(fs::symlink_metadata(path))? { Err(busy()) } else { Ok(file) }
}

fn header_of(job: &Job) -> Value {
    let job: Map<String, Value> =
        job.0.iter().map(|(key, value)| ((*key).to_owned(), json!(value))).collect();
    json!({ "downpour_job": VERSION, "job": job })
}

/// Contents of a file.
#[derive(Debug, Default)]
struct Found {
    /// Bytes up to the end of the last line that has one: another was being written when its process was killed.
    whole: u64,
    /// The first line.
    header: Option<Value>,
    content: Content,
}

/// Reads a file line by line. Lines that do not hold are as if they were not there; of another job's file no more is kept than that
/// there is a frame.
fn read(mut input: impl BufRead, expected: &Value) -> io::Result<Found> {
    let mut found = Found::default();
    let mut bytes = Vec::new();
    for number in 0u64.. {
        let Some(length) = next_line(&mut input, &mut bytes)? else { break };
        found.whole += length;
        let value = line(&String::from_utf8_lossy(&bytes));
        if number == 0 {
            found.header = value;
        } else if let Some(value) = value {
            found.content.apply(&value);
        }
        if found.header.as_ref() != Some(expected) && !found.content.frames.is_empty() {
            break;
        }
    }
    Ok(found)
}

/// Reads a line without its end, and returns its length with it. `None` if no complete line follows. A line that is too long
/// is returned empty.
fn next_line(input: &mut impl BufRead, bytes: &mut Vec<u8>) -> io::Result<Option<u64>> {
    bytes.clear();
    let mut length = 0;
    loop {
        let part = input.fill_buf()?;
        if part.is_empty() {
            return Ok(None);
        }
        let end = part.iter().position(|byte| *byte == b'\n');
        let text = &part[..end.unwrap_or(part.len())];
        if bytes.len() + text.len() <= MAX_LINE && length as usize == bytes.len() {
            bytes.extend(text);
        } else {
            bytes.clear();
        }
        let taken = text.len() + usize::from(end.is_some());
        length += taken as u64;
        input.consume(taken);
        if end.is_some() {
            return Ok(Some(length));
        }
    }
}

impl Content {
    /// Applies the contents of a line.
    fn apply(&mut self, value: &Value) {
        if let Some(bits) = value["exposure_bits"].as_u64().and_then(|bits| u32::try_from(bits).ok()) {
            self.exposure = Some(f32::from_bits(bits)).filter(|exposure| exposure.is_finite());
        } else if value["overwrite"] == true {
            self.overwrite = true;
        } else if let Some(digest) = value["video"].as_str() {
            self.video = Some(digest.to_owned());
        } else if let Some((number, record)) = record(value) {
            self.frames.insert(number, record);
        }
    }
}

fn record(value: &Value) -> Option<(u32, Record)> {
    let number = u32::try_from(value["frame"].as_u64()?).ok()?;
    let picture = value["picture"].as_str()?.to_owned();
    let drops = value["drops"].as_str().map(str::to_owned);
    Some((number, Record { picture, drops, stats: value["stats"].clone() }))
}

fn line(line: &str) -> Option<Value> {
    let (found, text) = line.split_once(' ')?;
    if found != check(text) {
        return None;
    }
    serde_json::from_str(text).ok()
}

fn check(text: &str) -> String {
    digest(text.as_bytes()).chars().take(CHECK_DIGITS).collect()
}

/// Error that names the parameters in which the job differs.
fn other_job(path: &Path, header: Option<&Value>, job: &Job) -> Failure {
    let allowed = "the same as before to resume, another name, or --overwrite to start again";
    let of = |found: &str| Failure::new(INPUT, format!("{}: {found}; allowed: {allowed}", shown(path)));
    let Some(header) = header else { return of("the first line is damaged") };
    match header["downpour_job"].as_u64() {
        Some(VERSION) => {}
        Some(version) => return of(&format!("a journal of version {version}, this is {VERSION}")),
        None => return of("not a journal of downpour"),
    }
    let was = |key: &str| header["job"][key].as_str().unwrap_or("nothing").to_owned();
    let differing = job.0.iter().find(|(key, value)| was(key) != *value);
    match differing {
        Some((key @ "scene", _)) => of(&format!("the clip was begun with another {key}")),
        Some((key, value)) => {
            of(&format!("the clip was begun with {key} {}, and now it is {value}", was(key)))
        }
        None => of("the clip was begun by another version"),
    }
}
