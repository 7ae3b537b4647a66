//! A clip: many pictures, each published as soon as it is made.
//!
//! Frames of an earlier run are not rendered again if its journal lists them and their digests match. The exposure
//! of all frames is that of the first one: separate exposures would flicker.

mod finish;
mod flight;

use std::collections::BTreeSet;
use std::fs;
use std::sync::mpsc::sync_channel;
use std::thread;

use downpour::trace::frame_scene::LATEST_S;
use downpour::weather::Weather;
use downpour::{Computer, PendingFrame, Renderer};

use self::flight::{Encoded, Flying, most_in_flight, take_off};
use super::frames::Frames;
use super::job::{Job, atlas_digest, digest, scene_digest};
use super::journal::{Journal, Record};
use super::outputs::Format;
use super::paths::ClipPaths;
use super::report;
use super::{RenderArguments, has_room};
use crate::commands::input::rate_text;
use crate::failure::{Failure, INPUT, LIMIT, OTHER};
use crate::interrupt::Interrupt;
use crate::output::remove_leftovers;
use crate::progress::{Progress, doing};

/// Makes a clip.
///
/// # Errors
/// Exit code 2 for arguments that do not go together, or for the clip of another job; 3 over a limit; 4 for the GPU; 5 for
/// files that exist, cannot be written, or are being worked on.
pub(super) fn run(
    arguments: &RenderArguments,
    frames: Frames,
    fps: f64,
    interrupt: &Interrupt,
) -> Result<(), Failure> {
    let (stats, drops) = (arguments.stats.as_deref(), arguments.dump_drops.as_deref());
    let paths = ClipPaths::new(&arguments.output, stats, drops, arguments.overwrite)?;
    arguments.check_layers(if paths.video.is_some() { Format::Png } else { paths.format })?;
    let last_s = time_s(arguments.input.time, frames.last(), fps);
    if last_s > LATEST_S {
        let found = format!("frame {} is at {last_s} s", frames.last());
        return Err(Failure::new(INPUT, format!("{found}; allowed: frames up to {LATEST_S} s")));
    }
    paths.check_free(frames)?;
    let input =
        doing("reading", arguments.quiet, || arguments.input.read(&mut downpour::scene::Budget::default()))?;
    paths.keep(frames, &input.files)?;
    #[cfg(feature = "video")]
    if paths.video.is_some() {
        super::video::check_size(input.weather.size)?;
    }
    // Water has its history from frame 0 on, whichever frames are asked for.
    let mut renderer = arguments.renderer(input, arguments.input.time, paths.stats.is_some())?;
    let atlas = renderer.options().atlas.as_ref().map(atlas_digest);
    let scene = scene_digest(renderer.weather(), renderer.loaded(), renderer.first_scene());
    let weather = renderer.weather().clone();
    let refraction = format!("{:?}", renderer.refraction());
    let clip = Clip { arguments, frames, fps, paths, weather, atlas, refraction, scene, interrupt };
    let rate = rate_text(&clip.weather);
    arguments.say(&format!("rain: {rate} mm/h, {} frames", frames.count()));
    let (journal, made) = clip.make(&mut renderer)?;
    clip.finish(journal, made)
}

/// Time of a frame, in seconds.
fn time_s(begin: f64, number: u32, fps: f64) -> f64 {
    begin + f64::from(number) / fps
}

/// A clip whose arguments have been read.
struct Clip<'a> {
    arguments: &'a RenderArguments,
    frames: Frames,
    fps: f64,
    paths: ClipPaths,
    weather: Weather,
    /// The digest of the streak atlas, if the weather takes the light of lamps from one.
    atlas: Option<String>,
    /// Name of the refraction of drops.
    refraction: String,
    /// The digest of the scene.
    scene: String,
    interrupt: &'a Interrupt,
}

/// Reason why a clip is incomplete.
#[derive(Debug)]
enum Stopped {
    /// Its first frame was too large for the GPU: the CPU continues.
    OnGpu,
    Failed(Failure),
}

impl From<Failure> for Stopped {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}

impl Clip<'_> {
    /// Renders the missing frames. Returns their number.
    fn make(&self, renderer: &mut Renderer) -> Result<(Journal, u32), Failure> {
        self.paths.make_folder()?;
        loop {
            let computer = renderer.computer().clone();
            let mut journal = self.journal(&computer)?;
            match self.make_missing(renderer, &mut journal) {
                Ok(made) => return Ok((journal, made)),
                // Too large for the GPU, which has rendered nothing: the clip restarts on the CPU.
                Err(Stopped::OnGpu) => journal.close(),
                Err(Stopped::Failed(error)) => {
                    journal.close();
                    self.paths.remove_empty_folder();
                    return Err(error);
                }
            }
        }
    }

    /// Journal of the frames that a computer makes.
    fn journal(&self, computer: &Computer) -> Result<Journal, Failure> {
        let (file, anew) = (&self.paths.journal, self.arguments.overwrite);
        let opened = Journal::open(file, &self.job(computer), anew, self.interrupt);
        opened.inspect_err(|_| self.paths.remove_empty_folder())
    }

    fn make_missing(&self, renderer: &mut Renderer, journal: &mut Journal) -> Result<u32, Stopped> {
        if self.is_published(journal) {
            return Ok(0);
        }
        self.paths.video_output(journal.overwrites())?;
        let kept = self.kept(journal)?;
        let missing = self.frames.count() - kept.len() as u32;
        if !kept.is_empty() {
            self.arguments.say(&format!("{} frames are there, {missing} are missing", kept.len()));
        }
        remove_leftovers(self.paths.pictures.folder());
        if let Some(drops) = &self.paths.drops {
            remove_leftovers(drops.folder());
        }
        renderer.set_exposure(self.exposure(journal));
        let made = self.make_frames(renderer, journal, &kept, missing);
        made.inspect_err(|stopped| {
            if matches!(stopped, Stopped::Failed(_)) {
                self.print_resume_hint(journal);
            }
        })?;
        Ok(missing)
    }

    /// Makes the frames that are not `kept`, several at a time, and publishes them in order.
    fn make_frames(
        &self,
        renderer: &mut Renderer,
        journal: &mut Journal,
        kept: &BTreeSet<u32>,
        missing: u32,
    ) -> Result<(), Stopped> {
        let mut progress = Progress::new("frame", missing, self.arguments.quiet);
        let size = self.weather.size;
        let most = most_in_flight(size, rayon::current_num_threads(), |frames| has_room(size, frames));
        let computer = renderer.computer().clone();
        thread::scope(|scope| {
            // Frames land in the order in which they were begun; a frame waits to take off while too many are in flight.
            let (begun, landing) = sync_channel::<(u32, Option<f32>, Flying<'_>)>(most - 1);
            let publish = move || {
                for (number, exposure, flying) in landing {
                    // All frames have the exposure of the first one. Linear radiance is not exposed.
                    if let Some(exposure) = exposure
                        && self.paths.format == Format::Png
                        && journal.exposure().is_none()
                    {
                        journal.expose(exposure, self.interrupt)?;
                    }
                    self.publish(number, flying.land()?, journal)?;
                    progress.step();
                }
                Ok::<_, Failure>(())
            };
            let publisher = thread::Builder::new().name("publisher".to_owned()).spawn_scoped(scope, publish);
            let publisher = publisher.map_err(|error| Failure::new(LIMIT, format!("a thread: {error}")))?;
            let mut stopped = None;
            for number in self.frames.numbers() {
                let frame = if kept.contains(&number) {
                    // The next frame starts from the state after this one.
                    renderer.pass(self.time_s(number)).map(|()| None).map_err(Failure::from)
                } else {
                    self.arguments.begin_frame(renderer, self.time_s(number), self.interrupt).map(Some)
                };
                if renderer.computer().backend != computer.backend {
                    stopped = Some(Stopped::OnGpu);
                    break;
                }
                match frame {
                    Ok(None) => {}
                    Ok(Some(frame)) => {
                        let computer = &computer;
                        let flying = take_off(scope, frame, move |frame| self.encode(frame, computer));
                        // It ends only when the publisher has failed.
                        if begun.send((number, renderer.exposure(), flying)).is_err() {
                            break;
                        }
                    }
                    Err(error) => {
                        stopped = Some(error.into());
                        break;
                    }
                }
            }
            // What was begun is not lost.
            drop(begun);
            match publisher.join() {
                Ok(published) => published?,
                Err(_) => {
                    return Err(Failure::new(OTHER, "the thread that publishes frames has ended").into());
                }
            }
            stopped.map_or(Ok(()), Err)
        })
    }

    /// The files of a frame.
    fn encode(&self, frame: PendingFrame, computer: &Computer) -> Result<Encoded, Failure> {
        let frame = self.arguments.finish_frame(frame, self.interrupt)?;
        let picture = self.arguments.encode(self.paths.format, &frame)?;
        Ok(Encoded {
            digest: digest(&picture),
            picture,
            drops: self.paths.drops.is_some().then(|| report::drops(&frame)),
            stats: report::stats(&frame, computer, &self.weather),
        })
    }

    fn time_s(&self, number: u32) -> f64 {
        time_s(self.arguments.input.time, number, self.fps)
    }

    fn print_resume_hint(&self, journal: &Journal) {
        if let made @ 1.. = journal.numbers().len() {
            let how = if self.arguments.overwrite { "without --overwrite" } else { "with the same command" };
            self.arguments.say(&format!("{made} frames are complete: resume the clip {how}"));
        }
    }

    /// The frames that are there and as they were made. Names that are taken by something else are an error.
    fn kept(&self, journal: &Journal) -> Result<BTreeSet<u32>, Failure> {
        let mut kept = BTreeSet::new();
        let exposed = self.paths.format == Format::Exr || journal.exposure().is_some();
        for number in self.frames.numbers() {
            let record = journal.frame(number);
            let listed = record.is_some_and(|record| record.drops.is_some());
            self.paths.picture(number, journal.overwrites() || record.is_some())?;
            self.paths.list(number, journal.overwrites() || listed)?;
            let Some(record) = record.filter(|_| exposed) else { continue };
            let measured = self.paths.stats.is_none() || !record.stats["measured_rate_mm_h"].is_null();
            let picture = fs::read(self.paths.pictures.path(number));
            let whole = picture.is_ok_and(|bytes| digest(&bytes) == record.picture);
            let listed = self.paths.drops.as_ref().is_none_or(|drops| {
                fs::read(drops.path(number)).is_ok_and(|bytes| record.drops == Some(digest(&bytes)))
            });
            if measured && whole && listed {
                kept.insert(number);
            }
        }
        Ok(kept)
    }

    /// Exposure of the whole clip, once its first frame exists. Linear radiance is not exposed.
    fn exposure(&self, journal: &Journal) -> Option<f32> {
        if self.paths.format == Format::Exr { Some(1.0) } else { journal.exposure() }
    }

    /// Publishes a frame: the journal first, so that every file with a frame's name is listed there; the picture last.
    fn publish(&self, number: u32, encoded: Encoded, journal: &mut Journal) -> Result<(), Failure> {
        let Encoded { picture, digest: of_picture, drops: list, stats } = encoded;
        let known = journal.frame(number);
        let listed = known.is_some_and(|record| record.drops.is_some());
        let file = self.paths.picture(number, journal.overwrites() || known.is_some())?;
        let list_file = self.paths.list(number, journal.overwrites() || listed)?;
        // A list that this run does not write stays listed.
        let before = known.and_then(|record| record.drops.clone());
        let drops = list.as_ref().map(|list| digest(list.as_bytes())).or(before);
        journal.record(number, Record { picture: of_picture, drops, stats }, self.interrupt)?;
        if let (Some(file), Some(list)) = (list_file, list) {
            file.publish_among_many(list.as_bytes(), self.interrupt)?;
        }
        file.publish_among_many(&picture, self.interrupt)
    }

    /// Parameters that the frames depend on. Not their number: a clip can be extended.
    fn job(&self, computer: &Computer) -> Job {
        let (arguments, weather) = (self.arguments, &self.weather);
        let [width, height] = weather.size;
        Job(vec![
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("backend", computer.backend.to_owned()),
            ("adapter", computer.adapter.clone()),
            ("driver", computer.driver.clone()),
            ("rate", rate_text(weather)),
            ("seed", weather.rain.seed.to_string()),
            ("size", format!("{width}x{height}")),
            ("time", arguments.input.time.to_string()),
            ("fps", self.fps.to_string()),
            ("first frame", self.frames.first.to_string()),
            ("samples", arguments.samples.to_string()),
            ("sky rays", arguments.sky_rays().to_string()),
            ("ray spacing", arguments.ray_spacing.to_string()),
            ("light frames", arguments.light_frames.to_string()),
            ("refraction", self.refraction.clone()),
            ("layers", arguments.layers.to_string()),
            ("streak atlas", self.atlas.clone().unwrap_or_else(|| "none".to_owned())),
            ("scene", self.scene.clone()),
        ])
    }
}
