//! Final steps of a clip: statistics of all frames, and the video.

use std::fs;
#[cfg(feature = "video")]
use std::time::Instant;

use serde_json::Value;

use super::super::job::digest;
use super::super::journal::Journal;
use super::super::report::{self, ClipStats};
use super::Clip;
#[cfg(feature = "video")]
use crate::failure::FILES;
use crate::failure::{Failure, shown};
use crate::output::remove_leftovers;
#[cfg(feature = "video")]
use crate::progress::Progress;

impl Clip<'_> {
    /// True if the video of this journal is already published: only the cleanup is missing.
    pub(super) fn is_published(&self, journal: &Journal) -> bool {
        let (Some(video), Some(known)) = (&self.paths.video, journal.video()) else { return false };
        fs::read(&video.path).is_ok_and(|bytes| self.video_digest(&bytes) == known)
    }

    /// The digest of a video of these frames.
    fn video_digest(&self, bytes: &[u8]) -> String {
        format!("{} of {}..{}", digest(bytes), self.frames.first, self.frames.end)
    }

    /// Writes the statistics of all frames, and the video.
    pub(super) fn finish(&self, mut journal: Journal, made: u32) -> Result<(), Failure> {
        let published = self.is_published(&journal);
        let (video, encode_ms) = if published { (None, None) } else { self.encode_video()? };
        if let Some(file) = &self.paths.stats {
            let clip = ClipStats { frames: self.frames, fps: self.fps, made, encode_ms };
            let frames: Vec<(u32, &Value)> = self
                .frames
                .numbers()
                .filter_map(|number| Some((number, &journal.frame(number)?.stats)))
                .collect();
            let text = report::text(&report::clip_stats(&frames, &clip));
            file.publish(text.as_bytes(), self.interrupt)?;
        }
        let output = shown(&self.arguments.output);
        let ([width, height], count) = (self.weather.size, self.frames.count());
        if let Some(video) = &video
            && let Some(file) = self.paths.video_output(journal.overwrites())?
        {
            journal.record_video(self.video_digest(video), self.interrupt)?;
            file.publish(video, self.interrupt)?;
        }
        if self.paths.video.is_some() {
            self.remove_frames(journal);
        }
        self.arguments.say(&format!("wrote {output}: {count} frames of {width} x {height}, {made} made now"));
        Ok(())
    }

    /// The bytes of the video, if there is to be one, and the milliseconds that they took.
    #[cfg(feature = "video")]
    fn encode_video(&self) -> Result<(Option<Vec<u8>>, Option<f64>), Failure> {
        use downpour::scene::picture::{Pixels, decode};
        if self.paths.video.is_none() {
            return Ok((None, None));
        }
        let begin = Instant::now();
        let mut progress = Progress::new("encoding", self.frames.count(), self.arguments.quiet);
        let bytes =
            super::super::video::encode(self.weather.size, self.fps, self.frames.count(), |number| {
                let path = self.paths.pictures.path(self.frames.first + number);
                let bytes = fs::read(&path).map_err(|error| Failure::file(&path, &error))?;
                let picture = decode(&shown(&path), &bytes, &mut downpour::scene::Budget::default())?;
                progress.step();
                match picture.pixels {
                    Pixels::Rgba8(pixels) if [picture.width, picture.height] == self.weather.size => {
                        Ok(pixels)
                    }
                    _ => Err(Failure::new(FILES, format!("{} is not the frame that was made", shown(&path)))),
                }
            })?;
        Ok((Some(bytes), Some(begin.elapsed().as_secs_f64() * 1.0e3)))
    }

    #[cfg(not(feature = "video"))]
    fn encode_video(&self) -> Result<(Option<Vec<u8>>, Option<f64>), Failure> {
        Ok((None, None))
    }

    /// Removes the frames of a video, including those of an earlier clip, and no other files of their folder.
    fn remove_frames(&self, journal: Journal) {
        let folder = self.paths.pictures.folder();
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            let number = name.strip_suffix(".png").unwrap_or_default();
            if !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit()) {
                let _ = fs::remove_file(entry.path());
            }
        }
        remove_leftovers(folder);
        journal.remove();
        self.paths.remove_empty_folder();
    }
}
