//! Tables 1 and 2 of Rousseau 2008 again: what streaks cost and how far they are from the truth, by samples per streak.
//!
//! `cargo run --release -p downpour --features wgpu --example persistence -- WEATHER.toml [--quick] [--radius MM]`
//!
//! 1024 x 768 pixels, 1/60 s, drops uniform in the picture's pyramid, all of one radius, at their terminal speed. Times are
//! of the device, without the scene (drawn by rays here) and the transfer of the picture; on a software driver those of the
//! clock. A streak of less than 1.5 pixels across takes the mean of its drop from the table whatever the samples, so a
//! second set of drops is near the eye, where streaks are wide. The error is the root mean square of the rain's difference
//! to 512 samples (64 with `--quick` and on a software driver), over that of the rain. `--radius` is the one radius of the second
//! table, where there is not time for all. The light of lamps by the streaks of an atlas is that of `assets/streaks`.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use downpour::atlas::StreakAtlas;
use downpour::drop::air::Air;
use downpour::drop::fall_speed::{FallSpeedModel, TerminalSpeed};
use downpour::drop::oscillation::Amplitudes;
use downpour::gpu::{AdapterChoice, Dispatch, Gpu, wgpu};
use downpour::mask::MaskOptions;
use downpour::math::rng::{rng_draw, rng_unit};
use downpour::render::gpu::{RainOnGpu, RainPipeline};
use downpour::render::rain::light::{DropLightForm, DropLightOptions};
use downpour::render::rain::{DropMasks, Exposure, Rain, RainOptions, StreakColor, StreakSamples};
use downpour::scene::Budget;
use downpour::sim::field::{DropKind, FallingDrop};
use downpour::trace::data::RenderFrame;
use downpour::trace::frame_scene::FrameScene;
use downpour::trace::gpu::{SceneOnGpu, ScenePipeline};
use downpour::trace::scene::SceneView;
use downpour::weather::{Roots, Weather, load};

/// Seconds.
const SHUTTER: f64 = 1.0 / 60.0;

/// Samples that count as the truth.
const TRUTH: u32 = 512;

/// Meters: where drops are in the papers' picture, and where all streaks are wide.
const FAR: [f32; 2] = [0.1, 10.0];
const NEAR: [f32; 2] = [0.2, 1.0];

/// Setup that all pictures share.
struct Bench<'a> {
    gpu: &'a Gpu,
    frame_scene: &'a FrameScene,
    frame: downpour::trace::data::RenderFrame,
    masks: [DropMasks; 2],
    scenes: ScenePipeline,
    rains: RainPipeline,
    scene: SceneOnGpu,
    uploaded: [RainOnGpu; 2],
    clean: wgpu::Buffer,
}

/// Milliseconds of one picture.
struct Cost {
    binning: f64,
    capture: f64,
    table: f64,
    lamps: f64,
    drops: f64,
    layer: Vec<[f32; 4]>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let path = Path::new(arguments.first().ok_or("which weather file?")?);
    let quick = arguments.iter().any(|argument| argument == "--quick");
    let radius = arguments.iter().skip_while(|argument| *argument != "--radius").nth(1);
    let radii_mm = match radius {
        Some(text) => vec![text.parse()?],
        None => vec![0.5, 1.0, 2.0, 5.0],
    };
    let mut budget = Budget::default();
    let weather = Weather::read(path, &mut budget)?;
    let loaded = load(&weather, &Roots::open(path, &[])?, &mut budget)?;
    let frame_scene = FrameScene::new(&weather, &loaded, 0.0)?;
    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    let size = if quick { [320, 240] } else { [1024, 768] };
    println!("adapter: {}; {} x {}, shutter 1/60 s", gpu.adapter().name, size[0], size[1]);

    let masks = DropMasks::trace(MaskOptions::default().refractive_index)?;
    let (scenes, rains) = (ScenePipeline::new(&gpu)?, RainPipeline::new(&gpu)?);
    let frame = RenderFrame::new(&frame_scene.data, &frame_scene.viewpoint, size, 1, 1, 0)?;
    // Without and with the streaks of an atlas.
    let masks = [masks.clone(), masks.with_atlas(&StreakAtlas::load(Path::new("assets/streaks"))?)];
    let scene = scenes.upload(&frame_scene.data)?;
    let uploaded = [rains.upload(&masks[0])?, rains.upload(&masks[1])?];
    let drawn = scenes.prepare(&gpu, &scene, &frame)?;
    println!("scene by rays, one sample, one ray to the sky: {:.3} ms", time(&gpu, &drawn.dispatches())?);
    let clean = drawn.picture().clone();
    let bench =
        Bench { gpu: &gpu, frame_scene: &frame_scene, frame, masks, scenes, rains, scene, uploaded, clean };
    bench.by_count(quick)?;
    bench.by_light(if quick { 1000 } else { 10_000 })?;
    let software = gpu.adapter().is_software();
    let truth = if quick || software { 64 } else { TRUTH };
    bench.by_samples(FAR, if quick { 1000 } else { 10_000 }, truth, &radii_mm)?;
    bench.by_samples(NEAR, if quick || software { 200 } else { 2000 }, truth, &radii_mm)
}

impl Bench<'_> {
    /// Table 1: radius 1 mm, 0 to 40 000 drops.
    fn by_count(&self, quick: bool) -> Result<(), Box<dyn Error>> {
        println!(
            "\n| streaks, r = 1 mm | binning (CPU) ms | capture ms | white ms | still drops ms | table ms | streaks ms | rain, frames/s |"
        );
        println!("|---|---|---|---|---|---|---|---|");
        for count in [0, 5000, 10_000, 20_000, 40_000] {
            let count = if quick { count / 10 } else { count };
            let drops = self.drops(count, 1.0e-3, FAR)?;
            let white = Exposure { color: StreakColor::White, ..exposure(StreakSamples::Table) };
            let white = self.picture(&drops, white)?.drops;
            let still = self.picture(&drops, Exposure::default())?.drops;
            let Cost { binning, capture, table, drops, .. } =
                self.picture(&drops, exposure(StreakSamples::Table))?;
            let rate = 1.0e3 / (capture + table + drops);
            println!(
                "| {count} | {binning:.2} | {capture:.3} | {white:.3} | {still:.3} | {table:.3} | {drops:.3} | {rate:.0} |"
            );
        }
        Ok(())
    }

    /// Cost of lamps: the drops of table 1, without and with them.
    fn by_light(&self, count: u32) -> Result<(), Box<dyn Error>> {
        let drops = self.drops(count, 1.0e-3, FAR)?;
        let of = |form, glints| {
            let light = DropLightOptions { form, glints };
            self.cost(
                &drops,
                &RainOptions { exposure: exposure(StreakSamples::Table), light, ..RainOptions::default() },
            )
        };
        let without = of(DropLightForm::None, 0)?;
        println!(
            "\n{count} streaks, r = 1 mm, {} lamps: {:.3} ms without their light",
            self.frame_scene.lamps, without.drops
        );
        println!("| form | lamps ms | streaks ms | of capture, table and streaks without them |");
        println!("|---|---|---|---|");
        let all = without.capture + without.table + without.drops;
        for (name, form, glints) in [
            ("traced, 4 glints", DropLightForm::Traced, 4),
            ("traced, means", DropLightForm::Traced, 0),
            ("Rousseau 2006", DropLightForm::Rousseau2006, 0),
            ("Im & Sung 2022", DropLightForm::ImSung2022, 0),
            ("atlas, 4 lamps a drop", DropLightForm::Atlas, 12),
        ] {
            let Cost { lamps, drops, .. } = of(form, glints)?;
            let more = 100.0 * (lamps + drops - without.drops) / all;
            println!("| {name} | {lamps:.3} | {drops:.3} | {more:+.1} % |");
        }
        Ok(())
    }

    /// Table 2: by radius and samples.
    fn by_samples(
        &self,
        range: [f32; 2],
        count: u32,
        truth: u32,
        radii_mm: &[f32],
    ) -> Result<(), Box<dyn Error>> {
        println!(
            "\n{count} streaks {} to {} m from the eye: milliseconds of the streaks (error)",
            range[0], range[1]
        );
        println!("| radius mm | 1 | 5 | 10 | 20 | 32 | 50 | table | its making ms |");
        println!("|---|---|---|---|---|---|---|---|---|");
        for &radius_mm in radii_mm {
            let drops = self.drops(count, radius_mm * 1.0e-3, range)?;
            let truth = self.picture(&drops, exposure(StreakSamples::Loop(truth)))?.layer;
            let mut row = format!("| {radius_mm} |");
            for samples in [1, 5, 10, 20, 32, 50] {
                let cost = self.picture(&drops, exposure(StreakSamples::Loop(samples)))?;
                row += &format!(" {:.3} ({:.2} %) |", cost.drops, 100.0 * error(&cost.layer, &truth));
            }
            let cost = self.picture(&drops, exposure(StreakSamples::Table))?;
            let error = 100.0 * error(&cost.layer, &truth);
            println!("{row} {:.3} ({error:.2} %) | {:.3} |", cost.drops, cost.table);
        }
        Ok(())
    }

    fn picture(&self, drops: &[FallingDrop], exposure: Exposure) -> Result<Cost, Box<dyn Error>> {
        self.cost(drops, &RainOptions { exposure, ..RainOptions::default() })
    }

    fn cost(&self, drops: &[FallingDrop], options: &RainOptions) -> Result<Cost, Box<dyn Error>> {
        let start = Instant::now();
        let eye = self.frame_scene.viewpoint.eye.as_dvec3();
        let of_atlas = usize::from(options.light.form == DropLightForm::Atlas);
        let (masks, uploaded) = (&self.masks[of_atlas], &self.uploaded[of_atlas]);
        let rain = Rain::new(&self.frame.camera, eye, drops, masks, options);
        let binning = ms(start.elapsed());
        let view = SceneView { data: &self.frame_scene.data, frame: &self.frame };
        let lights = [rain.lights(&view, masks)?, rain.streak_lights(&view, masks)?];
        let plate = self.scenes.plate(self.gpu, &self.scene, &self.frame, &self.rains, &rain)?;
        let pass = self.rains.prepare(self.gpu, &plate.of(&self.clean), uploaded, &rain, &lights)?;
        let capture = time(self.gpu, &plate.dispatches(&pass))?;
        let lists = time(self.gpu, &pass.binning().concat())?;
        let lamps = time(self.gpu, &pass.lamps())?;
        let streaks: Vec<Dispatch<'_>> = pass.streaks();
        let table = if streaks.is_empty() { 0.0 } else { time(self.gpu, &streaks)? };
        // The drops go over what is not drawn, which is to be there again each time.
        let shown = [vec![pass.open_air()], pass.medium(), pass.drops()].concat();
        let drops = lists + time(self.gpu, &shown)?;
        Ok(Cost { binning, capture, table, lamps, drops, layer: pass.layer()? })
    }

    /// Drops somewhere in the picture, uniform in space, as they fall.
    fn drops(
        &self,
        count: u32,
        radius: f32,
        [near, far]: [f32; 2],
    ) -> Result<Vec<FallingDrop>, Box<dyn Error>> {
        let diameter = 2.0 * radius;
        // The largest of the table is no drop of rain: it falls as fast as the largest that is.
        let speed = TerminalSpeed::new(FallSpeedModel::default(), &Air::standard())
            .at(f64::from(diameter).min(7.0e-3))?;
        let view = &self.frame_scene.viewpoint;
        let forward = view.forward.normalize();
        let right = forward.cross(view.up).normalize();
        let up = right.cross(forward);
        let half = downpour::math::ops::tan(0.5 * view.fov_y);
        let of = |index| {
            let [a, b, c, _] = rng_draw([2008, 0], index, 0, 0).map(rng_unit);
            let across = right * ((2.0 * a - 1.0) * half * 4.0 / 3.0) + up * ((2.0 * b - 1.0) * half);
            // Uniform in a pyramid: the cube of the depth is uniform.
            let cube = near * near * near + (far * far * far - near * near * near) * c;
            let depth = downpour::math::ops::pow(cube, 1.0 / 3.0);
            FallingDrop {
                position: (view.eye + (forward + across) * depth).as_dvec3(),
                velocity: [0.0, -speed as f32, 0.0],
                diameter,
                id: u64::from(index),
                kind: DropKind::Falling,
                present_s: FallingDrop::ALWAYS,
                normal: FallingDrop::LEVEL,
            }
        };
        Ok((0..count).map(of).collect())
    }
}

fn exposure(samples: StreakSamples) -> Exposure {
    Exposure { shutter_s: SHUTTER, samples, oscillation: Amplitudes::GARG_NAYAR_EVEN, ..Exposure::default() }
}

/// Milliseconds of the device, as many runs as a quarter of a second takes; of the clock where a software driver gives no time, once.
fn time(gpu: &Gpu, dispatches: &[Dispatch<'_>]) -> Result<f64, Box<dyn Error>> {
    if gpu.adapter().is_software() {
        // One by one: all of them may take longer than a device may be silent.
        return dispatches
            .iter()
            .try_fold(0.0, |sum, dispatch| Ok(sum + ms(gpu.time(std::slice::from_ref(dispatch), 1)?.wall)));
    }
    let first = ms(gpu.time(dispatches, 1)?.wall);
    let time = gpu.time(dispatches, (250.0 / first).clamp(1.0, 50.0) as u32)?;
    Ok(ms(time.device.unwrap_or(time.wall)))
}

fn ms(time: std::time::Duration) -> f64 {
    time.as_secs_f64() * 1.0e3
}

/// Root mean square of the difference of two rains, over that of the second.
fn error(found: &[[f32; 4]], expected: &[[f32; 4]]) -> f64 {
    let (mut squares, mut all) = (0.0, 0.0);
    for (a, b) in found.iter().zip(expected) {
        for k in 0..3 {
            squares += f64::from(a[k] - b[k]) * f64::from(a[k] - b[k]);
            all += f64::from(b[k]) * f64::from(b[k]);
        }
    }
    (squares / f64::max(all, 1.0e-30)).sqrt()
}
