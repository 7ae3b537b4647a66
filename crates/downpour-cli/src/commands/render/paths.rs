//! Output files of a clip.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::frames::Frames;
use super::journal;
use super::outputs::{Format, check_tables, extension, keep, refused};
use crate::commands::pattern::Pattern;
use crate::failure::{FILES, Failure, INPUT, shown};
use crate::output::{OutputFile, folder_of};

/// Paths of all files of a clip.
#[derive(Debug)]
pub(super) struct ClipPaths {
    /// The format of the frames.
    pub(super) format: Format,
    /// The frames, one file each.
    pub(super) pictures: Pattern,
    /// Path of the journal.
    pub(super) journal: PathBuf,
    pub(super) video: Option<Video>,
    pub(super) stats: Option<OutputFile>,
    pub(super) drops: Option<Pattern>,
    stats_path: Option<PathBuf>,
    overwrite: bool,
}

/// A video, and the folder beside it in which its frames are until it is there.
#[derive(Debug)]
pub(super) struct Video {
    pub(super) path: PathBuf,
    pub(super) folder: PathBuf,
}

impl ClipPaths {
    /// Checks the names before any work is done.
    ///
    /// # Errors
    /// Exit code 2 for a name of another format or without a placeholder for a number; 5 for a path that is not a folder.
    pub(super) fn new(
        output: &Path,
        stats: Option<&Path>,
        drops: Option<&Path>,
        overwrite: bool,
    ) -> Result<Self, Failure> {
        let mut video = None;
        let (format, pictures) = match extension(output).as_deref() {
            Some("exr") => (Format::Exr, Pattern::parse(output)?),
            Some("png") => (Format::Png, Pattern::parse(output)?),
            Some("mp4") if cfg!(feature = "video") => {
                let name = output.file_name().unwrap_or_default().to_string_lossy();
                let folder = output.with_file_name(format!(".{name}.frames"));
                let pictures = Pattern::parse(&folder.join("%06d.png"))?;
                check_folder(folder_of(output))?;
                video = Some(Video { path: output.to_owned(), folder });
                (Format::Png, pictures)
            }
            Some("mp4") => {
                let found = format!("output {}: this build makes no videos", shown(output));
                let allowed = "numbered .png or .exr, or a build with the feature `video`";
                return Err(Failure::new(INPUT, format!("{found}; allowed: {allowed}")));
            }
            _ => return Err(refused(output, "numbered .exr or .png (frames/%04d.png), or .mp4")),
        };
        check_tables(stats, drops)?;
        let drops = drops.map(Pattern::parse).transpose()?;
        if video.is_none() {
            check_folder(pictures.folder())?;
        }
        if let Some(drops) = &drops {
            check_folder(drops.folder())?;
        }
        Ok(Self {
            format,
            journal: journal::path_of(pictures.whole()),
            pictures,
            video,
            stats: stats.map(|path| OutputFile::new(path, overwrite)).transpose()?,
            drops,
            stats_path: stats.map(Path::to_owned),
            overwrite,
        })
    }

    /// Rejects existing frames of a clip without a journal, before any work is done.
    ///
    /// # Errors
    /// Exit code 5, with the name.
    pub(super) fn check_free(&self, frames: Frames) -> Result<(), Failure> {
        if fs::symlink_metadata(&self.journal).is_ok_and(|found| found.is_file()) {
            // Listed frames are checked when they are read.
            return Ok(());
        }
        self.video_output(self.overwrite)?;
        for number in frames.numbers() {
            if self.video.is_none() {
                self.picture(number, self.overwrite)?;
            }
            self.list(number, self.overwrite)?;
        }
        Ok(())
    }

    /// Refuses to overwrite the inputs of the clip.
    ///
    /// # Errors
    /// Exit code 2, with the name.
    pub(super) fn keep(&self, frames: Frames, inputs: &[PathBuf]) -> Result<(), Failure> {
        let paths = frames.numbers().flat_map(|number| {
            [Some(self.pictures.path(number)), self.drops.as_ref().map(|drops| drops.path(number))]
        });
        let others = [self.video.as_ref().map(|video| video.path.clone()), self.stats_path.clone()];
        keep(paths.chain(others).flatten(), inputs)
    }

    /// Output file of a frame. `ours`: an existing file may be replaced.
    ///
    /// # Errors
    /// As [`OutputFile::new`].
    pub(super) fn picture(&self, number: u32, ours: bool) -> Result<OutputFile, Failure> {
        OutputFile::new(&self.pictures.path(number), ours)
    }

    /// Output file of a frame's list of drops.
    ///
    /// # Errors
    /// As [`OutputFile::new`].
    pub(super) fn list(&self, number: u32, ours: bool) -> Result<Option<OutputFile>, Failure> {
        let file = |drops: &Pattern| OutputFile::new(&drops.path(number), ours);
        self.drops.as_ref().map(file).transpose()
    }

    /// Output file of the video.
    ///
    /// # Errors
    /// As [`OutputFile::new`].
    pub(super) fn video_output(&self, ours: bool) -> Result<Option<OutputFile>, Failure> {
        self.video.as_ref().map(|video| OutputFile::new(&video.path, ours)).transpose()
    }

    /// Makes the folder of a video's frames.
    ///
    /// # Errors
    /// Exit code 5: the name is not a folder, or the system denies access.
    pub(super) fn make_folder(&self) -> Result<(), Failure> {
        let Some(Video { folder, .. }) = &self.video else { return Ok(()) };
        match fs::create_dir(folder) {
            Ok(()) => Ok(()),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                // Behind a link, files of others could be removed.
                if fs::symlink_metadata(folder).is_ok_and(|found| found.is_dir()) {
                    return Ok(());
                }
                let found = format!("{} is not a folder", shown(folder));
                Err(Failure::new(FILES, format!("{found}; allowed: a name that is free, for the frames")))
            }
            Err(error) => Err(Failure::file(folder, &error)),
        }
    }

    /// Removes the folder of a video's frames if it is empty.
    pub(super) fn remove_empty_folder(&self) {
        if let Some(Video { folder, .. }) = &self.video {
            let _ = fs::remove_dir(folder);
        }
    }
}

fn check_folder(folder: &Path) -> Result<(), Failure> {
    match fs::metadata(folder) {
        Ok(found) if found.is_dir() => Ok(()),
        Ok(_) => Err(Failure::new(FILES, format!("{} is not a folder", shown(folder)))),
        Err(error) => Err(Failure::new(FILES, format!("folder {}: {error}", shown(folder)))),
    }
}
