//! Golden pictures: small frames of every kind, rendered by the command on the CPU bit for bit, and on a GPU without a visible
//! difference. They guard against regressions of refactoring.
//!
//! `DOWNPOUR_BLESS=1` writes them and then fails: a new picture counts once a person has reviewed it. Differing pictures are written to
//! `target/goldens`. Without an adapter, or with `DOWNPOUR_GPU_TESTS=no`, see `gpu.rs`.

#[allow(dead_code, reason = "the tests of the command use the rest")]
#[path = "command/child.rs"]
mod child;

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use libtest_mimic::{Arguments, Failed, Trial};

use child::Downpour;

/// A kind of frame.
struct Golden {
    name: &'static str,
    /// The weather file of `tests/goldens/weather`.
    weather: &'static str,
    options: &'static [&'static str],
    /// Output argument of the command.
    output: &'static str,
    /// The frame among it.
    file: &'static str,
}

impl Golden {
    const fn picture(name: &'static str) -> Self {
        Self { name, weather: name, options: &[], output: "a.png", file: "a.png" }
    }
}

/// All of them.
const GOLDENS: [Golden; 19] = [
    Golden::picture("day"),
    Golden {
        name: "day_layers",
        options: &["--layers"],
        output: "a.exr",
        file: "a.exr",
        ..Golden::picture("day")
    },
    Golden::picture("night"),
    Golden { name: "night_frozen", options: &["--shutter", "0"], ..Golden::picture("night") },
    Golden {
        name: "night_clip_frame_7",
        options: &["--frames", "6..8", "--fps", "24"],
        output: "%d.png",
        file: "7.png",
        ..Golden::picture("night")
    },
    Golden::picture("focus"),
    Golden::picture("fog"),
    Golden { options: &["--time", "31"], ..Golden::picture("shower") },
    Golden::picture("drips"),
    Golden::picture("spray"),
    Golden::picture("lightning"),
    Golden::picture("puddles"),
    Golden::picture("windshield"),
    Golden::picture("window"),
    Golden::picture("tornado"),
    Golden::picture("box"),
    Golden::picture("rousseau_2006"),
    Golden::picture("im_sung_2022"),
    Golden::picture("atlas"),
];

/// Mean FLIP between a GPU's picture and the CPU's.
const MAX_FLIP: f32 = 0.02;

/// Mean difference between the layers of a GPU and those of the CPU, as a fraction of the mean of a layer.
const MAX_LAYER_DIFFERENCE: f64 = 0.01;

/// Most bytes of one picture.
const MAX_BYTES: u64 = 640 << 10;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let off = std::env::var("DOWNPOUR_GPU_TESTS").is_ok_and(|value| value == "no");
    let mut trials = vec![Trial::test("goldens_are_small_and_all_used", small_and_used)];
    for golden in &GOLDENS {
        trials.push(Trial::test(format!("cpu::{}", golden.name), || same_on_the_cpu(golden)));
        let is_picture = golden.file.ends_with(".png");
        let alike = if is_picture { alike_on_a_gpu } else { layers_alike_on_a_gpu };
        let trial = Trial::test(format!("gpu::{}", golden.name), move || alike(golden));
        trials.push(trial.with_ignored_flag(off));
    }
    libtest_mimic::run(&arguments, trials).exit_code()
}

fn root(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// Path of a golden picture.
fn kept(golden: &Golden) -> PathBuf {
    let end = golden.file.rsplit('.').next().unwrap_or_default();
    root("tests/goldens/pictures").join(format!("{}.{end}", golden.name))
}

/// The frame as the command makes it.
fn made(golden: &Golden, backend: &[&str]) -> Result<Vec<u8>, Failed> {
    let text = |path: PathBuf| path.to_string_lossy().into_owned();
    let weather = text(root("tests/goldens/weather").join(format!("{}.toml", golden.weather)));
    let (street, atlas) = (text(root("assets/scenes/plain")), text(root("assets/streaks")));
    let fixed = ["render", &weather, "--asset-root", &street, "--streaks", &atlas, "-q", "-o", golden.output];
    let ended = Downpour::new(&[&fixed, golden.options, backend].concat()).run();
    if ended.code == Some(0) { Ok(ended.file(golden.file)) } else { Err(ended.stderr.into()) }
}

/// Writes a differing picture for review, and prints its path.
fn put_aside(golden: &Golden, side: &str, bytes: &[u8]) -> Result<String, Failed> {
    let folder = root("target/goldens");
    fs::create_dir_all(&folder)?;
    let path =
        folder.join(format!("{}.{side}.{}", golden.name, golden.file.rsplit('.').next().unwrap_or_default()));
    fs::write(&path, bytes)?;
    Ok(path.display().to_string())
}

fn same_on_the_cpu(golden: &Golden) -> Result<(), Failed> {
    let bytes = made(golden, &["--backend", "cpu"])?;
    if std::env::var("DOWNPOUR_BLESS").is_ok_and(|value| value == "1") {
        fs::create_dir_all(root("tests/goldens/pictures"))?;
        fs::write(kept(golden), &bytes)?;
        return Err(format!("{} was written: look at it", golden.name).into());
    }
    let wanted = fs::read(kept(golden))?;
    // The pixels matter, not their compression.
    let same = if golden.file.ends_with(".png") {
        pixels(&wanted)? == pixels(&bytes)?
    } else {
        channels(&wanted)? == channels(&bytes)?
    };
    if same { Ok(()) } else { Err(format!("another picture: {}", put_aside(golden, "cpu", &bytes)?).into()) }
}

/// The frame as the command makes it on a GPU.
fn made_on_a_gpu(golden: &Golden) -> Result<Vec<u8>, Failed> {
    let adapter = std::env::var("DOWNPOUR_ADAPTER").unwrap_or_default();
    let named: &[&str] = if adapter.is_empty() { &[] } else { &["--adapter", &adapter] };
    made(golden, &[&["--backend", "gpu"], named].concat())
}

/// Control: of each layer that has something the mirrored one is detected as different.
fn layers_alike_on_a_gpu(golden: &Golden) -> Result<(), Failed> {
    let bytes = made_on_a_gpu(golden)?;
    let (wanted, found) = (channels(&fs::read(kept(golden))?)?, channels(&bytes)?);
    let mut wrong = Vec::new();
    if wanted.iter().map(|(name, _)| name).ne(found.iter().map(|(name, _)| name)) {
        return Err(format!("other layers: {}", put_aside(golden, "gpu", &bytes)?).into());
    }
    for ((name, wanted), (_, found)) in wanted.iter().zip(&found) {
        let difference = layer_difference(wanted, found);
        let mirrored: Vec<u32> = wanted.iter().rev().copied().collect();
        let control = layer_difference(wanted, &mirrored);
        println!("{} {name}: {difference:.5}, the wrong way round {control:.4}", golden.name);
        if difference > MAX_LAYER_DIFFERENCE {
            wrong.push(format!("{name}: {difference}, allowed {MAX_LAYER_DIFFERENCE}"));
        }
        let is_even = wanted.iter().all(|bits| *bits == wanted[0]);
        if !is_even && control < 2.0 * difference {
            wrong.push(format!("{name}: the wrong way round {control}: nothing could be seen"));
        }
    }
    if wrong.is_empty() {
        return Ok(());
    }
    wrong.push(put_aside(golden, "gpu", &bytes)?);
    Err(wrong.join("\n").into())
}

/// Mean difference of two layers, as a fraction of the mean of the first.
fn layer_difference(wanted: &[u32], found: &[u32]) -> f64 {
    // The sky is at 1e30 m.
    let value = |bits: &u32| {
        let value = f64::from(f32::from_bits(*bits));
        if value > 1.0e29 { 1000.0 } else { value }
    };
    let mean = wanted.iter().map(|bits| value(bits).abs()).sum::<f64>().max(1.0e-12);
    wanted.iter().zip(found).map(|(a, b)| (value(a) - value(b)).abs()).sum::<f64>() / mean
}

/// Control: the mirrored picture is detected as different.
fn alike_on_a_gpu(golden: &Golden) -> Result<(), Failed> {
    let bytes = made_on_a_gpu(golden)?;
    let (wanted, found) = (pixels(&fs::read(kept(golden))?)?, pixels(&bytes)?);
    if wanted.dimensions() != found.dimensions() {
        return Err(format!("{:?} pixels for {:?}", found.dimensions(), wanted.dimensions()).into());
    }
    let control = flip(&wanted, &image::imageops::flip_horizontal(&wanted));
    let mean = flip(&wanted, &found);
    println!("{}: FLIP {mean:.4}, the wrong way round {control:.4}", golden.name);
    if control < 2.0 * MAX_FLIP {
        return Err(format!("the wrong way round FLIP is {control}: nothing could be seen").into());
    }
    if mean <= MAX_FLIP {
        return Ok(());
    }
    Err(format!("FLIP {mean}, allowed {MAX_FLIP}: {}", put_aside(golden, "gpu", &bytes)?).into())
}

fn pixels(png: &[u8]) -> Result<image::RgbImage, Failed> {
    Ok(image::load_from_memory(png)?.into_rgb8())
}

/// Mean FLIP of two pictures of one size, at the usual distance of a screen.
fn flip(a: &image::RgbImage, b: &image::RgbImage) -> f32 {
    let [a, b] = [a, b].map(|image| nv_flip::FlipImageRgb8::with_data(image.width(), image.height(), image));
    nv_flip::FlipPool::from_image(&nv_flip::flip(a, b, nv_flip::DEFAULT_PIXELS_PER_DEGREE)).mean()
}

/// Names and bits of all channels.
fn channels(bytes: &[u8]) -> Result<Vec<(String, Vec<u32>)>, Failed> {
    use ::exr::prelude::*;
    let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let image = image.all_attributes().from_buffered(Cursor::new(bytes))?;
    let bits = |c: &AnyChannel<FlatSamples>| c.sample_data.values_as_f32().map(f32::to_bits).collect();
    Ok(image.layer_data.channel_data.list.iter().map(|c| (c.name.to_string(), bits(c))).collect())
}

fn small_and_used() -> Result<(), Failed> {
    let mut wrong = Vec::new();
    for entry in fs::read_dir(root("tests/goldens/pictures"))? {
        let path = entry?.path();
        if !GOLDENS.iter().any(|golden| kept(golden).file_name() == path.file_name()) {
            wrong.push(format!("{} belongs to no test", path.display()));
        }
        if fs::metadata(&path)?.len() > MAX_BYTES {
            wrong.push(format!("{} is too large", path.display()));
        }
    }
    for entry in fs::read_dir(root("tests/goldens/weather"))? {
        let path = entry?.path();
        if !GOLDENS.iter().any(|golden| path.file_stem().is_some_and(|stem| stem == golden.weather)) {
            wrong.push(format!("{} belongs to no picture", path.display()));
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n").into()) }
}
