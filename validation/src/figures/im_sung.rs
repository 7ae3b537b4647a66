//! `cargo xtask figures im-sung`: section IV of Im & Sung 2022 ("Efficient Rain Simulation based on Constrained View
//! Frustum") reproduced. Their model, the two that they compare with, and ours rain on one street, each with the same
//! number of drops, while the camera rests, moves 9 m ahead within a second, turns about in half a second, and rests.
//!
//! Everything is under `target/figures/im-sung`: `im-sung.md` with the numbers, CSV beside it, and the sheets. Each sheet
//! has the pictures above and, below, the same drops as bright streaks, as the papers draw them.
//!
//! Aim (P8): in every frame of the path, at least 95 % of our drops are on screen.

mod blocks;
mod options;
mod report;
mod scene;
mod sheet;
mod stats;
mod streaks;
mod table;
mod walk;
mod weather;

use std::path::{Path, PathBuf};

use image::RgbImage;

pub(crate) use options::Options;
use table::Run;
use weather::{Model, Rain};
use xtask::run;

/// The file of street and camera.
const SCENE: &str = "street.gltf";

/// Samples along an edge of a pixel: only the drops matter.
const SAMPLES: &str = "1";

/// Drops of figures 6, 8, 9 and 10.
const MAX_DROPS: u32 = 10_000;

/// Numbers of drops of figures 7 and 11.
const NUMBERS: [u32; 5] = [1_000, 5_000, 10_000, 20_000, 40_000];

/// Rain of the path, mm/h: above [`MAX_DROPS`] drops in each of the volumes, in ours from 480 x 270 pixels on.
const RATE_MM_H: f64 = 300.0;

/// Rain rate of the comparison of numbers, mm/h: as many drops as the largest of [`NUMBERS`], in ours from 640 x 360 pixels on.
const NUMBERS_RATE_MM_H: f64 = 500.0;

/// Frames of each run of the comparison of numbers.
const NUMBERS_FRAMES: u32 = 2;

/// Fields of view of the zoom, degrees.
const ZOOM_DEG: [f64; 3] = [12.0, 18.0, 30.0];

/// Makes the runs, the sheets and the tables; reports runs of our rain below its aim.
pub(crate) fn run(options: &Options) -> Result<(), String> {
    let maker = Maker::ready(options)?;
    let runs = plan(options)
        .into_iter()
        .map(|(set, name, rain, frames)| maker.make(set, name, rain, frames))
        .collect::<Result<Vec<Run>, String>>()?;
    maker.sheets()?;
    let text = report::text(&runs, options);
    println!("{text}");
    maker.write("im-sung.md", text.as_bytes())?;
    maker.write("im-sung.csv", table::csv(&runs).as_bytes())?;
    maker.write("frames.csv", table::frames_csv(&runs, options.fps).as_bytes())?;
    let ours = runs.iter().filter(|run| run.set == "path" && run.rain.model == Model::View);
    let misses: Vec<String> = ours.filter_map(Run::miss).collect();
    if options.check && !misses.is_empty() {
        return Err(format!("below the aim:\n  {}", misses.join("\n  ")));
    }
    Ok(())
}

/// All runs: set, name, rain, number of frames.
fn plan(options: &Options) -> Vec<(&'static str, String, Rain, u32)> {
    let mut runs = Vec::new();
    let mut add = |set, name: String, rain: Rain, frames| runs.push((set, name, rain, frames));
    for model in Model::ALL {
        let rain = Rain { model, rate_mm_h: RATE_MM_H, max_drops: MAX_DROPS, fov_deg: None };
        add("path", format!("path-{}", model.key()), rain, walk::frames(options.fps));
    }
    for fov in ZOOM_DEG {
        for model in [Model::ImSung, Model::View] {
            let rain = Rain { model, rate_mm_h: RATE_MM_H, max_drops: MAX_DROPS, fov_deg: Some(fov) };
            add("zoom", format!("zoom-{}-{fov}", model.key()), rain, 1);
        }
    }
    let numbers: &[u32] = if options.quick { &[] } else { &NUMBERS };
    for model in Model::ALL {
        for &max_drops in numbers {
            let rain = Rain { model, rate_mm_h: NUMBERS_RATE_MM_H, max_drops, fov_deg: None };
            add("number", format!("number-{}-{max_drops}", model.key()), rain, NUMBERS_FRAMES);
        }
    }
    runs
}

/// Runner of the clips.
struct Maker<'a> {
    options: &'a Options,
    program: PathBuf,
    folder: PathBuf,
}

impl<'a> Maker<'a> {
    fn ready(options: &'a Options) -> Result<Self, String> {
        let folder = run::root().join("target/figures/im-sung");
        create(&folder)?;
        let maker = Self { options, program: run::downpour(options.command.as_deref())?, folder };
        let (gltf, buffer) = scene::gltf(options.fps, "street.bin");
        maker.write(SCENE, gltf.as_bytes())?;
        maker.write("street.bin", &buffer)?;
        Ok(maker)
    }

    fn make(&self, set: &'static str, name: String, rain: Rain, frames: u32) -> Result<Run, String> {
        let weather = format!("{name}.toml");
        self.write(&weather, weather::text(&rain, SCENE).as_bytes())?;
        let clip = self.folder.join(&name);
        create(&clip)?;
        let [width, height] = self.options.size;
        let stats = clip.join("stats.json");
        let mut call = run::command(&self.program.display().to_string(), &["render", "--quiet"]);
        call.arg(self.folder.join(&weather))
            .args(["--samples", SAMPLES, "--sky-rays", "0", "--backend", &self.options.backend])
            .args(["--frames", &format!("0..{frames}"), "--fps", &self.options.fps.to_string()])
            .args(["--size", &format!("{width}x{height}"), "--output"])
            .arg(clip.join("%04d.png"))
            .arg("--dump-drops")
            .arg(clip.join("%04d.csv"))
            .arg("--stats")
            .arg(&stats);
        if !self.options.go_on {
            call.arg("--overwrite");
        } else if stats.exists() {
            // Written again, from old frames and new ones.
            std::fs::remove_file(&stats).map_err(|error| in_file(&stats, error))?;
        }
        let status = call.status();
        let status = status.map_err(|error| format!("{} did not start: {error}", self.program.display()))?;
        if !status.success() {
            return Err(format!("{name}: downpour render failed ({status})"));
        }
        let frames = stats::read(&read(&stats)?).map_err(|message| in_file(&stats, message))?;
        let run = Run { set, name, rain, frames };
        let [mean, least] = run.fraction();
        eprintln!("{}: {:.1} % on screen, least {:.1} %", run.name, 100.0 * mean, 100.0 * least);
        Ok(run)
    }

    /// A frame of a run as it is, and with streaks.
    fn pair(&self, name: &str, frame: u32, fov_deg: f64) -> Result<[RgbImage; 2], String> {
        let file = |extension: &str| self.folder.join(name).join(format!("{frame:04}.{extension}"));
        let (png, csv) = (file("png"), file("csv"));
        let picture = image::open(&png).map_err(|error| in_file(&png, error.to_string()))?.to_rgb8();
        let drops = streaks::read(&read(&csv)?).map_err(|message| in_file(&csv, message))?;
        let eye = walk::eye(f64::from(frame) / f64::from(self.options.fps));
        let marked = streaks::draw(&picture, &eye, fov_deg, &drops);
        Ok([picture, marked])
    }

    /// Pictures in a row, and the same with streaks below.
    fn sheet(&self, file: &str, frames: &[(String, u32, f64)]) -> Result<(), String> {
        let pairs = frames.iter().map(|(name, frame, fov)| self.pair(name, *frame, *fov));
        let (pictures, marked) = pairs
            .map(|pair| pair.map(|[picture, marked]| (picture, marked)))
            .collect::<Result<(Vec<_>, Vec<_>), _>>()?;
        self.save(file, &sheet::sheet(&[pictures, marked])?)
    }

    fn save(&self, file: &str, picture: &RgbImage) -> Result<(), String> {
        let file = self.folder.join(file);
        picture.save(&file).map_err(|error| in_file(&file, error.to_string()))
    }

    fn sheets(&self) -> Result<(), String> {
        let fps = self.options.fps;
        let path = |model: Model| format!("path-{}", model.key());
        let at = |moment: usize| walk::frame_at(walk::MOMENTS[moment].1, fps);
        let of_path = |model: Model, moment: usize| (path(model), at(moment), walk::FOV_DEG);
        self.sheet("fig06-same-number.png", &Model::ALL.map(|model| of_path(model, 0)))?;
        for (file, model) in [
            ("fig08-tariq.png", Model::Tariq),
            ("fig09-creus-patow.png", Model::CreusPatow),
            ("fig10-im-sung.png", Model::ImSung),
            ("fig10-ours.png", Model::View),
        ] {
            self.sheet(file, &[0, 2, 4].map(|moment| of_path(model, moment)))?;
        }
        for model in [Model::ImSung, Model::View] {
            let zoom = ZOOM_DEG.map(|fov| (format!("zoom-{}-{fov}", model.key()), 0, fov));
            self.sheet(&format!("fig10-zoom-{}.png", model.key()), &zoom)?;
        }
        if !self.options.quick {
            let ours = |most| (format!("number-{}-{most}", Model::View.key()), 0, walk::FOV_DEG);
            self.sheet("fig11-numbers.png", &NUMBERS.map(ours))?;
        }
        let moments = 0..walk::MOMENTS.len();
        let row = |model: Model| -> Result<Vec<RgbImage>, String> {
            let marked = |moment| {
                let (name, frame, fov) = of_path(model, moment);
                self.pair(&name, frame, fov).map(|[_, marked]| sheet::halved(&marked))
            };
            moments.clone().map(marked).collect()
        };
        let rows = Model::ALL.into_iter().map(row).collect::<Result<Vec<_>, String>>()?;
        self.save("path.png", &sheet::sheet(&rows)?)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), String> {
        let file = self.folder.join(name);
        std::fs::write(&file, bytes).map_err(|error| in_file(&file, error.to_string()))
    }
}

fn in_file(file: &Path, message: impl std::fmt::Display) -> String {
    format!("{}: {message}", file.display())
}

fn read(file: &Path) -> Result<String, String> {
    std::fs::read_to_string(file).map_err(|error| in_file(file, error.to_string()))
}

fn create(folder: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|error| in_file(folder, error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each number of drops once for each model, no name twice, and the path as long as it is.
    #[test]
    fn the_plan_is_whole() {
        let options = crate::read::<Options>(&[]).expect("no arguments");
        let runs = plan(&options);
        let names: std::collections::BTreeSet<&str> = runs.iter().map(|run| run.1.as_str()).collect();
        assert_eq!(names.len(), runs.len());
        let count = |set| runs.iter().filter(|run| run.0 == set).count();
        assert_eq!((count("path"), count("zoom"), count("number")), (4, 6, 20));
        assert!(runs.iter().filter(|run| run.0 == "path").all(|run| run.3 == 24));
        let quick = plan(&crate::read::<Options>(&["--quick"]).expect("quick"));
        assert_eq!(quick, runs.into_iter().filter(|run| run.0 != "number").collect::<Vec<_>>());
    }
}
