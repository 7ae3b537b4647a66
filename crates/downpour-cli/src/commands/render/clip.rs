//! A clip: many pictures, each published as soon as it is made.
//!
//! Frames that an earlier run has made are not made again if its journal knows them and they are as they were. The exposure
//! of all frames is that of the first one: what each frame would choose for itself flickers.

mod finish;

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fs;
use std::time::Instant;

use downpour::render::picture::Picture;
use downpour::render::shower::{MovingScenery, Scenery, Still};
use downpour::render::stage::{LATEST_S, Stage};
use serde_json::Value;

use super::frames::Frames;
use super::ground::Puddles;
use super::job::{Job, atlas_digest, digest, moves, scene_digest};
use super::journal::{Journal, Record};
use super::outputs::Format;
use super::painter::{PaintError, Painter, with_painter};
use super::pane::Pane;
use super::places::Places;
use super::report::{self, Told};
use super::shower::{Ask, Showers};
use super::{RenderArguments, reserve};
use crate::commands::input::Input;
use crate::failure::{Failure, INPUT};
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
    let places = Places::new(&arguments.output, stats, drops, arguments.overwrite)?;
    arguments.check_layers(if places.video.is_some() { Format::Png } else { places.format })?;
    let last_s = time_s(arguments.input.time, frames.last(), fps);
    if last_s > LATEST_S {
        let found = format!("frame {} is at {last_s} s", frames.last());
        return Err(Failure::new(INPUT, format!("{found}; allowed: frames up to {LATEST_S} s")));
    }
    places.check_free(frames)?;
    let mut input =
        doing("reading", arguments.quiet, || arguments.input.read(&mut downpour::scene::Budget::default()))?;
    places.keep(frames, &input.files)?;
    #[cfg(feature = "video")]
    if places.video.is_some() {
        super::video::check_size(input.weather.size)?;
    }
    reserve(input.weather.size)?;
    let atlas = arguments.streaks.read(&input.weather)?.atlas()?;
    let first = arguments.stage(&input, time_s(arguments.input.time, frames.first, fps))?;
    input.say_warnings(&first, |text| arguments.say(text));
    let scene = scene_digest(&input.weather, &input.loaded, &first);
    let moving = moves(&input.loaded);
    if !moving {
        // The files have become buffers.
        input.loaded = downpour::scene::weather::Loaded { scene: Default::default(), ..input.loaded };
    }
    let clip = Clip { arguments, frames, fps, places, input, atlas, first, scene, moving, interrupt };
    let rain = &clip.input.weather.rain;
    arguments.say(&format!("rain: {} mm/h, {} frames", rain.rate_mm_h, frames.count()));
    let (journal, made) = with_painter(
        &arguments.backend,
        interrupt,
        |text| arguments.say(text),
        |painter| clip.make(painter),
    )?;
    clip.finish(journal, made)
}

/// When a frame is taken, in seconds.
fn time_s(begin: f64, number: u32, fps: f64) -> f64 {
    begin + f64::from(number) / fps
}

/// A clip whose arguments have been read.
struct Clip<'a> {
    arguments: &'a RenderArguments,
    frames: Frames,
    fps: f64,
    places: Places,
    input: Input,
    /// The streaks of lamps, if the weather takes them from an atlas.
    atlas: Option<downpour::mask::atlas::StreakAtlas>,
    /// The scene at the first frame.
    first: Stage,
    /// The digest of the scene.
    scene: String,
    /// Whether the scene differs from frame to frame.
    moving: bool,
    interrupt: &'a Interrupt,
}

/// What holds water, from frame to frame.
struct Surfaces {
    pane: Pane,
    puddles: Puddles,
}

impl Clip<'_> {
    /// Makes the frames that are not there. Returns how many those were.
    fn make(&self, painter: &Painter) -> Result<(Journal, u32), PaintError> {
        self.places.make_folder()?;
        let anew = self.arguments.overwrite;
        let job = self.job(painter);
        let opened = Journal::open(&self.places.journal, &job, anew, self.interrupt);
        let mut journal = opened.inspect_err(|_| self.places.remove_empty_folder())?;
        match self.make_missing(painter, &mut journal) {
            Ok(made) => Ok((journal, made)),
            Err(error) => {
                journal.close();
                self.places.remove_empty_folder();
                Err(error)
            }
        }
    }

    fn make_missing(&self, painter: &Painter, journal: &mut Journal) -> Result<u32, PaintError> {
        if self.is_published(journal) {
            return Ok(0);
        }
        self.places.film(journal.overwrites())?;
        let kept = self.kept(journal)?;
        let missing = self.frames.count() - kept.len() as u32;
        if !kept.is_empty() {
            self.arguments.say(&format!("{} frames are there, {missing} are missing", kept.len()));
        }
        remove_leftovers(self.places.pictures.folder());
        if let Some(drops) = &self.places.drops {
            remove_leftovers(drops.folder());
        }
        let quiet = self.arguments.quiet;
        let showers = &mut Showers::new(&self.input.weather, &self.input.loaded, self.atlas.as_ref(), quiet)?;
        let (weather, loaded) = (&self.input.weather, &self.input.loaded);
        let first_s = time_s(self.arguments.input.time, self.frames.first, self.fps);
        let surfaces = &mut Surfaces {
            pane: Pane::new(weather, &self.first, first_s, self.arguments.quiet)?,
            puddles: Puddles::new(weather, loaded, &self.first, first_s)?,
        };
        let mut progress = Progress::new("frame", missing, self.arguments.quiet);
        for number in self.frames.numbers() {
            if !kept.contains(&number) {
                let made = self.make_frame(number, painter, showers, surfaces, journal);
                made.inspect_err(|_| self.say_how_to_go_on(journal))?;
                progress.step();
            } else {
                // What comes later begins where this frame ends.
                surfaces.puddles.pass(time_s(self.arguments.input.time, number, self.fps))?;
                if !showers.can_seek() {
                    self.pass_frame(number, showers)?;
                }
            }
        }
        Ok(missing)
    }

    fn say_how_to_go_on(&self, journal: &Journal) {
        if let made @ 1.. = journal.numbers().len() {
            let how = if self.arguments.overwrite { "without --overwrite" } else { "with the same command" };
            self.arguments.say(&format!("{made} frames are made: the clip goes on {how}"));
        }
    }

    /// The frames that are there and as they were made. Names that are taken by something else are an error.
    fn kept(&self, journal: &Journal) -> Result<BTreeSet<u32>, Failure> {
        let mut kept = BTreeSet::new();
        let exposed = self.places.format == Format::Exr || journal.exposure().is_some();
        for number in self.frames.numbers() {
            let record = journal.frame(number);
            let listed = record.is_some_and(|record| record.drops.is_some());
            self.places.picture(number, journal.overwrites() || record.is_some())?;
            self.places.list(number, journal.overwrites() || listed)?;
            let Some(record) = record.filter(|_| exposed) else { continue };
            let told = self.places.stats.is_none() || !record.stats["measured_rate_mm_h"].is_null();
            let picture = fs::read(self.places.pictures.path(number));
            let whole = picture.is_ok_and(|bytes| digest(&bytes) == record.picture);
            let listed = self.places.drops.as_ref().is_none_or(|drops| {
                fs::read(drops.path(number)).is_ok_and(|bytes| record.drops == Some(digest(&bytes)))
            });
            if told && whole && listed {
                kept.insert(number);
            }
        }
        Ok(kept)
    }

    fn make_frame(
        &self,
        number: u32,
        painter: &Painter,
        showers: &mut Showers,
        Surfaces { pane, puddles }: &mut Surfaces,
        journal: &mut Journal,
    ) -> Result<(), PaintError> {
        let begin = Instant::now();
        let rain = &self.input.weather.rain;
        let time_s = time_s(self.arguments.input.time, number, self.fps);
        let stage = puddles.lay(self.stage(number, time_s)?, time_s)?;
        let stage = &*pane.hang(stage, time_s)?;
        let shower = showers.at(self.scenery().as_ref(), stage, time_s, &self.ask(true))?;
        let options = self.arguments.options(stage, &self.input.weather, time_s, shower.medium);
        let mut picture = painter.paint(stage, &shower.visible.drops, &showers.masks, &options)?;
        let through = pane.before(stage, &picture, &options)?;
        painter.look(&mut picture, through)?;
        let told = Told {
            computer: painter.computer(),
            rain: &shower.visible,
            asked_rate_mm_h: rain.rate_mm_h,
            measured_rate_mm_h: shower.measured_rate_mm_h,
            medium: &shower.medium,
            time_s,
            seed: rain.seed,
            triangles: stage.triangles,
            frame_ms: begin.elapsed().as_secs_f64() * 1.0e3,
        };
        let stats = report::stats(&picture, &told);
        let list = self.places.drops.is_some().then(|| report::drops(&picture.drawn, &shower.visible.drops));
        drop(shower);
        let exposure = self.exposure(stage, &picture, journal)?;
        let bytes = self.arguments.encode(self.places.format, picture, exposure)?;
        self.publish(number, &bytes, list.as_deref(), stats, journal)?;
        Ok(())
    }

    /// Lets the rain go on past a frame that is there.
    fn pass_frame(&self, number: u32, showers: &mut Showers) -> Result<(), Failure> {
        let time_s = time_s(self.arguments.input.time, number, self.fps);
        let stage = self.stage(number, time_s)?;
        showers.at(self.scenery().as_ref(), &stage, time_s, &self.ask(false)).map(|_| ())
    }

    fn ask(&self, made: bool) -> Ask {
        Ask { measure: made && self.places.stats.is_some(), quiet: self.arguments.quiet }
    }

    /// The scene over time, as the rain asks for it between frames.
    fn scenery(&self) -> Box<dyn Scenery + '_> {
        if !self.moving {
            return Box::new(Still(&self.first));
        }
        let Input { weather, loaded, .. } = &self.input;
        Box::new(MovingScenery { weather, loaded })
    }

    /// The scene at a frame.
    fn stage(&self, number: u32, time_s: f64) -> Result<Cow<'_, Stage>, Failure> {
        if !self.moving || number == self.frames.first {
            return Ok(Cow::Borrowed(&self.first));
        }
        Ok(Cow::Owned(Stage::new(&self.input.weather, &self.input.loaded, time_s)?))
    }

    /// The exposure of the whole clip. Linear radiance is not exposed.
    fn exposure(&self, stage: &Stage, picture: &Picture, journal: &mut Journal) -> Result<f32, Failure> {
        if self.places.format == Format::Exr {
            return Ok(1.0);
        }
        if let Some(exposure) = journal.exposure() {
            return Ok(exposure);
        }
        let exposure = stage.exposure(&picture.clean);
        journal.expose(exposure, self.interrupt)?;
        Ok(exposure)
    }

    /// Publishes a frame: the journal first, so that whatever has the frame's name is known there; the picture last.
    fn publish(
        &self,
        number: u32,
        picture: &[u8],
        list: Option<&str>,
        stats: Value,
        journal: &mut Journal,
    ) -> Result<(), Failure> {
        let known = journal.frame(number);
        let listed = known.is_some_and(|record| record.drops.is_some());
        let place = self.places.picture(number, journal.overwrites() || known.is_some())?;
        let list_place = self.places.list(number, journal.overwrites() || listed)?;
        // A list that this run is not asked for stays known.
        let before = known.and_then(|record| record.drops.clone());
        let drops = list.map(|list| digest(list.as_bytes())).or(before);
        journal.record(number, Record { picture: digest(picture), drops, stats }, self.interrupt)?;
        if let (Some(place), Some(list)) = (list_place, list) {
            place.publish_among_many(list.as_bytes(), self.interrupt)?;
        }
        place.publish_among_many(picture, self.interrupt)
    }

    /// What the frames depend on. Not how many they are: a clip can be made longer.
    fn job(&self, painter: &Painter) -> Job {
        let (arguments, weather) = (self.arguments, &self.input.weather);
        let computer = painter.computer();
        let [width, height] = weather.size;
        Job(vec![
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("backend", computer.backend.to_owned()),
            ("adapter", computer.adapter.clone()),
            ("driver", computer.driver.clone()),
            ("rate", weather.rain.rate_mm_h.to_string()),
            ("seed", weather.rain.seed.to_string()),
            ("size", format!("{width}x{height}")),
            ("time", arguments.input.time.to_string()),
            ("fps", self.fps.to_string()),
            ("first frame", self.frames.first.to_string()),
            ("samples", arguments.samples.to_string()),
            ("sky rays", arguments.sky_rays.to_string()),
            ("refraction", format!("{:?}", arguments.refraction(weather))),
            ("layers", arguments.layers.to_string()),
            ("streak atlas", self.atlas.as_ref().map_or_else(|| "none".to_owned(), atlas_digest)),
            ("scene", self.scene.clone()),
        ])
    }
}
