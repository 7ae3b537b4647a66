//! Pictures and masks on the machine's GPU or software driver, through the command.
//!
//! A missing adapter is a failure, reported in one line; `DOWNPOUR_GPU_TESTS=no` shows the tests as ignored. `DOWNPOUR_ADAPTER` is part of
//! the name of the adapter to use.

#[allow(dead_code, reason = "the tests without a GPU use the rest")]
#[path = "command/child.rs"]
mod child;
#[allow(dead_code, reason = "the tests without a GPU use the rest")]
#[path = "command/gltf_file.rs"]
mod gltf_file;
#[path = "command/on_gpu.rs"]
mod on_gpu;
#[allow(dead_code, reason = "the tests without a GPU use the rest")]
#[path = "command/scene_files.rs"]
mod scene_files;

use std::collections::BTreeMap;
use std::process::ExitCode;

use downpour::drop::DropShape;
use downpour::drop::mesh::DropMesh;
use downpour::mask::Mask;
use downpour::mask::file::{exr, ktx2};
use libtest_mimic::{Arguments, Trial};

use child::{Downpour, Ended, downpour, names_in};
use gltf_file::gltf;
use scene_files::{model, weather};

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let off = std::env::var("DOWNPOUR_GPU_TESTS").is_ok_and(|value| value == "no");
    if !off && !arguments.list && Downpour::new(&["adapters"]).run().code != Some(0) {
        eprintln!(
            "no GPU to test on: run `cargo xtask test`, which installs a software driver where it may, or install one (Debian: \
             apt-get install libvulkan1 mesa-vulkan-drivers), or set DOWNPOUR_GPU_TESTS=no to leave these tests out"
        );
        return ExitCode::FAILURE;
    }
    let tests: [(&str, fn()); 15] = [
        ("adapters_are_listed", adapters_are_listed),
        ("a_mask_is_that_of_the_cpu", a_mask_is_that_of_the_cpu),
        ("an_array_is_that_of_the_cpu", an_array_is_that_of_the_cpu),
        ("a_model_is_that_of_the_cpu", a_model_is_that_of_the_cpu),
        ("a_picture_is_that_of_the_cpu", a_picture_is_that_of_the_cpu),
        ("a_picture_of_a_lost_device_is_not_published", a_picture_of_a_lost_device_is_not_published),
        ("a_clip_of_a_lost_device_goes_on", a_clip_of_a_lost_device_goes_on),
        ("auto_says_what_it_took", auto_says_what_it_took),
        ("an_adapter_is_taken_by_its_name", an_adapter_is_taken_by_its_name),
        ("a_lost_device_publishes_nothing", a_lost_device_publishes_nothing),
        ("a_device_that_hangs_is_left", a_device_that_hangs_is_left),
        ("a_pane_is_that_of_the_cpu", || on_gpu::a_pane_is_that_of_the_cpu(&gpu(&[], &adapter()))),
        ("a_puddle_is_that_of_the_cpu", || on_gpu::a_puddle_is_that_of_the_cpu(&gpu(&[], &adapter()))),
        ("a_lattice_of_a_lost_device_is_not_told_of", || {
            on_gpu::a_lattice_of_a_lost_device_is_not_told_of(&gpu(&[], &adapter()));
        }),
        ("a_streak_by_the_table_is_that_of_the_cpu", || {
            on_gpu::a_streak_by_the_table_is_that_of_the_cpu(&gpu(&[], &adapter()));
        }),
    ];
    let trials = tests.into_iter().map(|(name, test)| {
        Trial::test(name, move || {
            test();
            Ok(())
        })
        .with_ignored_flag(off)
    });
    libtest_mimic::run(&arguments, trials.collect()).exit_code()
}

/// The arguments, on the adapter that was chosen.
fn gpu<'a>(arguments: &[&'a str], adapter: &'a Option<String>) -> Vec<&'a str> {
    let name = adapter.as_deref().map_or(vec![], |name| vec!["--adapter", name]);
    [arguments, &["--backend", "gpu"], &name].concat()
}

fn adapter() -> Option<String> {
    std::env::var("DOWNPOUR_ADAPTER").ok().filter(|name| !name.is_empty())
}

/// The adapters, the best one first.
fn listed() -> serde_json::Value {
    downpour(&["adapters", "--json"]).succeeded().json()
}

fn adapters_are_listed() {
    let ended = downpour(&["adapters", "--json"]).succeeded();
    let list = ended.json();
    let list = list.as_array().expect("an array");
    assert!(!list.is_empty());
    let text = downpour(&["adapters"]).succeeded().stdout;
    for adapter in list {
        let name = adapter["name"].as_str().expect("a name");
        assert!(text.contains(name), "{text}");
        for key in ["driver", "driver_info", "backend", "kind"] {
            assert!(adapter[key].is_string(), "{key} of {adapter}");
        }
        for key in ["software", "timestamps", "float32_filterable", "shader_f16", "subgroups"] {
            assert!(adapter[key].is_boolean(), "{key} of {adapter}");
        }
        for key in ["max_texture_2d", "max_texture_layers", "max_buffer_bytes", "max_storage_binding_bytes"] {
            assert!(adapter[key].as_u64().is_some_and(|value| value > 0), "{key} of {adapter}");
        }
    }
}

/// Number of texels that differ by more than `tolerance`, among those whose light has the same path.
fn differing(a: &Mask, b: &Mask, tolerance: f32) -> usize {
    assert_eq!((a.size, a.texels.len()), (b.size, b.texels.len()));
    let differs = |k: usize| {
        let (a, b) = (&a.texels[k], &b.texels[k]);
        let pairs = a.direction.iter().zip(&b.direction).chain(a.reflected.iter().zip(&b.reflected));
        let pairs = pairs.chain([(&a.coverage, &b.coverage), (&a.transmittance, &b.transmittance)]);
        let far = |difference: f32| difference.is_nan() || difference.abs() > tolerance;
        a.reflections != b.reflections || pairs.into_iter().any(|(a, b)| far(a - b))
    };
    (0..a.texels.len()).filter(|&k| differs(k)).count()
}

/// The same arguments on both sides, with a control: another drop must differ.
fn agree(
    arguments: &[&str],
    files: &[(&str, String)],
    read: fn(&[u8]) -> Mask,
    tolerance: f32,
    fraction: f64,
) {
    let name = arguments.last().copied().expect("an output");
    let adapter = adapter();
    let run = |arguments: &[&str]| {
        let run = files.iter().fold(Downpour::new(arguments), |run, (name, text)| run.with_file(name, text));
        read(&run.run().succeeded().file(name))
    };
    let on_gpu = run(&gpu(arguments, &adapter));
    let on_cpu = run(&[arguments, &["--backend", "cpu"]].concat());
    let most = (fraction * on_cpu.texels.len() as f64) as usize;
    let count = differing(&on_gpu, &on_cpu, tolerance);
    assert!(count <= most, "{arguments:?}: {count} of {} texels differ, allowed {most}", on_cpu.texels.len());
    let other = run(&[arguments, &["--backend", "cpu", "--refractive-index", "1.34"]].concat());
    assert!(differing(&on_gpu, &other, tolerance) > on_cpu.texels.len() / 4, "the control does not differ");
}

fn read_exr(bytes: &[u8]) -> Mask {
    exr::read_exr(bytes).expect("a mask")
}

/// The last mask of an array.
fn read_ktx2(bytes: &[u8]) -> Mask {
    ktx2::read_ktx2(bytes).expect("masks").pop().expect("a mask")
}

/// The tolerances are looser than those of the parity tests of the kernel: the numbers went through a file.
fn a_mask_is_that_of_the_cpu() {
    for (diameter, elevation) in [("0.5", "0"), ("2", "0"), ("5", "0"), ("4", "35"), ("3", "-90")] {
        let arguments =
            ["mask", "--diameter", diameter, "--elevation", elevation, "--size", "128", "-o", "m.exr"];
        agree(&arguments, &[], read_exr, 5.0e-4, 2.0e-3);
    }
}

fn an_array_is_that_of_the_cpu() {
    agree(&["mask", "--diameter", "1,4", "--size", "64", "-o", "m.ktx2"], &[], read_ktx2, 1.5e-3, 2.0e-3);
}

fn a_model_is_that_of_the_cpu() {
    let mesh =
        DropMesh::latitude_longitude(&DropShape::new(3.0e-3).expect("a drop"), 32, 64).expect("a mesh");
    let files = [("drop.gltf", gltf(mesh.positions(), mesh.triangles()))];
    agree(&["mask", "--model", "drop.gltf", "--size", "96", "-o", "m.exr"], &files, read_exr, 1.0e-3, 5.0e-3);
}

/// The storm of the other tests, on a backend.
fn storm(arguments: &[&str]) -> Downpour {
    let fixed = ["render", "storm.toml", "--layers", "-o", "rain.exr", "--samples", "2", "--sky-rays", "2"];
    let run = Downpour::new(&[&fixed, arguments].concat());
    run.with_file("storm.toml", weather("")).with_file("floor.gltf", model())
}

/// All channels of the picture, one after the other, by their names.
fn layers(ended: &Ended) -> Vec<(String, Vec<f32>)> {
    use ::exr::prelude::*;
    let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let bytes = std::io::Cursor::new(ended.file("rain.exr"));
    let image = image.all_attributes().from_buffered(bytes).expect("a picture");
    let list = image.layer_data.channel_data.list;
    list.iter().map(|c| (c.name.to_string(), c.sample_data.values_as_f32().collect())).collect()
}

/// The kind and the numbers of each drop of a list, by id.
fn rows(ended: &Ended) -> BTreeMap<u64, (String, Vec<f64>)> {
    let text = String::from_utf8(ended.file("drops.csv")).expect("text");
    let row = |line: &str| {
        let mut cells = line.split(',');
        let id = cells.next().and_then(|id| id.parse().ok()).expect("an id");
        let mut numbers: Vec<&str> = cells.collect();
        let kind = numbers.pop().expect("a kind").to_owned();
        (id, (kind, numbers.iter().map(|number| number.parse().expect("a number")).collect()))
    };
    text.lines().skip(1).map(row).collect()
}

/// Rays on the two sides may pass an edge on different sides: a few pixels may differ. The control is another seed,
/// which has other drops.
fn a_picture_is_that_of_the_cpu() {
    let adapter = adapter();
    let more = ["--stats", "stats.json", "--dump-drops", "drops.csv"];
    let on_gpu = storm(&gpu(&more, &adapter)).run().succeeded();
    let on_cpu = storm(&[&more[..], &["--backend", "cpu"]].concat()).run().succeeded();
    let other = storm(&["--backend", "cpu", "--seed", "8"]).run().succeeded();
    let (drops, expected) = (rows(&on_gpu), rows(&on_cpu));
    assert!(!expected.is_empty());
    assert!(drops.keys().eq(expected.keys()), "the drops do not depend on the backend");
    for (id, expected) in &expected {
        let (kind, expected) = expected;
        assert_eq!(&drops[id].0, kind);
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 2.0e-4 * b.abs().max(1.0);
        assert!(drops[id].1.iter().zip(expected).all(near), "{id}: {:?} {expected:?}", drops[id].1);
    }
    let stats: serde_json::Value = serde_json::from_slice(&on_gpu.file("stats.json")).expect("JSON");
    assert_eq!(stats["backend"], "gpu");
    assert!(stats["adapter"].as_str().is_some_and(|name| !name.is_empty() && name != "CPU"), "{stats}");
    let differing = |a: &Ended, b: &Ended| -> Vec<(String, usize)> {
        let count = |x: &[f32], y: &[f32]| {
            let differ = |x: f32, y: f32| (x - y).is_nan() || (x - y).abs() > 2.0e-3 * x.abs().max(0.01);
            x.iter().zip(y).filter(|(x, y)| differ(**x, **y)).count()
        };
        let pairs = layers(a).into_iter().zip(layers(b));
        pairs.map(|((name, x), (_, y))| (name, count(&x, &y))).collect()
    };
    for (name, count) in differing(&on_cpu, &on_gpu) {
        assert!(count <= 12, "{name}: {count} of 2304 pixels differ");
    }
    let controls = differing(&on_cpu, &other);
    for name in ["G", "rain.G", "transmittance.Y"] {
        let count = controls.iter().find(|(found, _)| found == name).map_or(0, |(_, count)| *count);
        assert!(count > 100, "{name}: {count} pixels of other drops differ");
    }
}

/// The device may be lost during any pass.
fn a_picture_of_a_lost_device_is_not_published() {
    let adapter = adapter();
    for point in 1..=3 {
        let run = storm(&gpu(&[], &adapter)).env("DOWNPOUR_INJECT", format!("lost@{point}"));
        run.run().failed(4, &["lost"]).left(&["floor.gltf", "storm.toml"]);
    }
}

/// A device that is lost in the middle of a clip costs the frame that it was at. The frames are the same in the end, and
/// never of two backends.
fn a_clip_of_a_lost_device_goes_on() {
    let adapter = adapter();
    let folder = tempfile::tempdir().expect("a folder");
    let run = |frames: &str, end: &str, backend: &[&str]| {
        let output = folder.path().join(end);
        let fixed =
            ["render", "storm.toml", "--samples=1", "--sky-rays=1", "--size=16x16", "--fps=8", "--frames"];
        let arguments = [&fixed[..], &[frames, "-o", output.to_str().expect("a name")], backend].concat();
        Downpour::new(&arguments).with_file("storm.toml", weather("")).with_file("floor.gltf", model())
    };
    let on_gpu = gpu(&[], &adapter);
    let lost = run("0..5", "a%d.png", &on_gpu).env("DOWNPOUR_INJECT", "lost@20").run();
    let lost = lost.failed(4, &["lost"]);
    let made = names_in(folder.path()).iter().filter(|name| name.ends_with(".png")).count();
    assert!((1..5).contains(&made), "{made} frames: {}", lost.stderr);
    assert!(lost.stderr.contains("resume the clip with the same command"), "{}", lost.stderr);
    run("0..5", "a%d.png", &["--backend", "cpu"]).run().failed(2, &["backend gpu, and now it is cpu"]);
    let rest = run("0..5", "a%d.png", &on_gpu).run().succeeded();
    assert_eq!(rest.stderr.matches("backend: gpu").count(), 1, "one device for all frames");
    assert!(rest.stderr.contains(&format!("{made} frames are there")), "{}", rest.stderr);
    run("0..5", "b%d.png", &on_gpu).run().succeeded();
    for frame in 0..5 {
        let read =
            |start: &str| std::fs::read(folder.path().join(format!("{start}{frame}.png"))).expect("a frame");
        assert!(read("a") == read("b"), "frame {frame}");
    }
}

/// The CPU where nothing but a software driver is there, and the driver if it is named.
fn auto_says_what_it_took() {
    let list = listed();
    let list = list.as_array().expect("an array");
    let ended = downpour(&["mask", "--diameter", "2", "--size", "32", "-o", "m.exr"]).succeeded();
    let took = if list.iter().all(|adapter| adapter["software"] == true) {
        "downpour: backend: cpu (there is no GPU but "
    } else {
        "downpour: backend: gpu, "
    };
    assert!(ended.stderr.contains(took), "{}", ended.stderr);
    let quiet = downpour(&["mask", "--diameter", "2", "--size", "32", "-q", "-o", "m.exr"]).succeeded();
    assert!(!quiet.stderr.contains("downpour:"), "{}", quiet.stderr);
}

fn an_adapter_is_taken_by_its_name() {
    let list = listed();
    for adapter in list.as_array().expect("an array") {
        let name = adapter["name"].as_str().expect("a name").to_uppercase();
        let ended = downpour(&["mask", "--diameter", "2", "--size", "32", "--adapter", &name, "-o", "m.exr"])
            .succeeded();
        assert!(ended.stderr.to_uppercase().contains(&format!("BACKEND: GPU, {name}")), "{}", ended.stderr);
    }
    for backend in ["gpu", "auto"] {
        downpour(&[
            "mask",
            "--diameter",
            "2",
            "--backend",
            backend,
            "--adapter",
            "no such thing",
            "-o",
            "m.exr",
        ])
        .failed(4, &["\"no such thing\"", "there are: "])
        .left(&[]);
    }
}

/// A mask is two submissions: the kernel and the readback.
fn a_lost_device_publishes_nothing() {
    let list = listed();
    let name = list[0]["name"].as_str().expect("a name");
    for taken in [["--adapter", name], ["--backend", "gpu"]] {
        for point in ["lost@1", "lost@2"] {
            let fixed = ["mask", "--diameter", "2", "--size", "64", "-o", "m.exr"];
            let arguments = [&fixed[..], &taken].concat();
            Downpour::new(&arguments).env("DOWNPOUR_INJECT", point).run().failed(4, &["lost"]).left(&[]);
            // Existing files stay.
            let run = Downpour::new(&[&arguments[..], &["--overwrite"]].concat()).with_file("m.exr", "old");
            assert_eq!(
                run.env("DOWNPOUR_INJECT", point).run().failed(4, &["lost"]).left(&["m.exr"]).file("m.exr"),
                b"old"
            );
        }
    }
    let arguments = ["mask", "--diameter", "2", "--size", "64", "--backend", "gpu", "-o", "m.exr"];
    Downpour::new(&arguments).env("DOWNPOUR_INJECT", "lost@1000").run().succeeded().left(&["m.exr"]);
    for bad in ["lost@0", "lost@", "lost@-1", "lost", "x"] {
        Downpour::new(&arguments)
            .env("DOWNPOUR_INJECT", bad)
            .run()
            .failed(2, &["DOWNPOUR_INJECT", "lost@K"])
            .left(&[]);
    }
}

fn a_device_that_hangs_is_left() {
    let arguments = ["mask", "--diameter", "2", "--size", "1400", "--backend", "gpu", "-o", "m.exr"];
    let run = Downpour::new(&arguments).env("DOWNPOUR_INJECT", "hang");
    let ended = run.run().failed(4, &["did not finish"]);
    assert!(names_in(ended.folder.path()).is_empty());
}
