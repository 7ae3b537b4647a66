//! Where the files of a clip go.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::frames::Frames;
use super::journal;
use super::outputs::{Format, check_tables, extension, keep, refused};
use crate::commands::pattern::Pattern;
use crate::failure::{FILES, Failure, INPUT, shown};
use crate::output::{Place, folder_of};

/// The places of all files of a clip.
#[derive(Debug)]
pub(super) struct Places {
    /// The format of the frames.
    pub(super) format: Format,
    /// The frames, one file each.
    pub(super) pictures: Pattern,
    /// What has been done.
    pub(super) journal: PathBuf,
    pub(super) video: Option<Video>,
    pub(super) stats: Option<Place>,
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

impl Places {
    /// Looks at the names before any work is done.
    ///
    /// # Errors
    /// Exit code 2 for a name that says another format or has no place for a number; 5 for a folder that is none.
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
            journal: journal::place(pictures.whole()),
            pictures,
            video,
            stats: stats.map(|path| Place::new(path, overwrite)).transpose()?,
            drops,
            stats_path: stats.map(Path::to_owned),
            overwrite,
        })
    }

    /// Refuses frames that exist where nothing was begun, before any work is done.
    ///
    /// # Errors
    /// Exit code 5, with the name.
    pub(super) fn check_free(&self, frames: Frames) -> Result<(), Failure> {
        if fs::symlink_metadata(&self.journal).is_ok_and(|found| found.is_file()) {
            // What it knows of is looked at when it is read.
            return Ok(());
        }
        self.film(self.overwrite)?;
        for number in frames.numbers() {
            if self.video.is_none() {
                self.picture(number, self.overwrite)?;
            }
            self.list(number, self.overwrite)?;
        }
        Ok(())
    }

    /// Refuses to write over what the clip is made of.
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

    /// The place of a frame. `ours`: what is there may be replaced.
    ///
    /// # Errors
    /// As [`Place::new`].
    pub(super) fn picture(&self, number: u32, ours: bool) -> Result<Place, Failure> {
        Place::new(&self.pictures.path(number), ours)
    }

    /// The place of a frame's list of drops.
    ///
    /// # Errors
    /// As [`Place::new`].
    pub(super) fn list(&self, number: u32, ours: bool) -> Result<Option<Place>, Failure> {
        let place = |drops: &Pattern| Place::new(&drops.path(number), ours);
        self.drops.as_ref().map(place).transpose()
    }

    /// The place of the video.
    ///
    /// # Errors
    /// As [`Place::new`].
    pub(super) fn film(&self, ours: bool) -> Result<Option<Place>, Failure> {
        self.video.as_ref().map(|video| Place::new(&video.path, ours)).transpose()
    }

    /// Makes the folder of a video's frames.
    ///
    /// # Errors
    /// Exit code 5: the name is taken by something else, or the system does not let us.
    pub(super) fn make_folder(&self) -> Result<(), Failure> {
        let Some(Video { folder, .. }) = &self.video else { return Ok(()) };
        match fs::create_dir(folder) {
            Ok(()) => Ok(()),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                // A link would lead us to remove what is not ours.
                if fs::symlink_metadata(folder).is_ok_and(|found| found.is_dir()) {
                    return Ok(());
                }
                let found = format!("{} is not a folder", shown(folder));
                Err(Failure::new(FILES, format!("{found}; allowed: a name that is free, for the frames")))
            }
            Err(error) => Err(Failure::file(folder, &error)),
        }
    }

    /// Removes the folder of a video's frames if nothing is in it.
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
