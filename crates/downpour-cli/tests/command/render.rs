//! `downpour render` on the CPU: pictures, layers, statistics and drops.

use std::collections::HashMap;
use std::io::Cursor;

use downpour::drop::air::Air;
use downpour::drop::fall_speed::{FallSpeedModel, terminal_speed};
use downpour::math::ops::f64 as ops;
use downpour::scene::Budget;
use downpour::scene::picture::{Picture, Pixels};

use crate::child::{Downpour, Ended};
use crate::gltf_file::{gltf, tetrahedron};
use crate::scene_files::{NO_SPLASHES, SIZE, model, storm, weather};

/// All channels of an OpenEXR file by their names.
fn channels(bytes: &[u8]) -> HashMap<String, Vec<f32>> {
    use exr::prelude::*;
    let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let image = image.all_attributes().from_buffered(Cursor::new(bytes)).unwrap();
    let size = image.layer_data.size;
    assert_eq!([size.0, size.1], SIZE.map(|edge| edge as usize));
    let list = image.layer_data.channel_data.list;
    list.iter().map(|c| (c.name.to_string(), c.sample_data.values_as_f32().collect())).collect()
}

/// A row of `--dump-drops`.
#[derive(Debug)]
struct Row {
    position: [f64; 3],
    velocity: [f64; 3],
    diameter_mm: f64,
    is_splash: bool,
}

fn rows(ended: &Ended) -> HashMap<u64, Row> {
    let text = String::from_utf8(ended.file("drops.csv")).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("id,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,diameter_mm,kind"));
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let [id, x, y, z, vx, vy, vz, mm, kind] = fields[..] else { panic!("{line}") };
        assert!(matches!(kind, "falling" | "splash"), "{kind}");
        let number = |text: &str| text.parse::<f64>().unwrap();
        let row = Row {
            position: [x, y, z].map(number),
            velocity: [vx, vy, vz].map(number),
            diameter_mm: number(mm),
            is_splash: kind == "splash",
        };
        (id.parse().unwrap(), row)
    };
    let all: Vec<(u64, Row)> = lines.map(row).collect();
    let count = all.len();
    let map: HashMap<u64, Row> = all.into_iter().collect();
    assert_eq!(map.len(), count, "each drop has a separate id");
    map
}

#[test]
fn the_papers_form_of_refraction_is_another_picture() {
    let picture = |form: &str| {
        let arguments = ["render", "-o", "rain.exr", "--layers", "--refraction", form];
        channels(&storm(&arguments).run().succeeded().file("rain.exr"))
    };
    let (ours, theirs) = (picture("direction"), picture("rousseau-2006"));
    assert_eq!(ours["clean.G"], theirs["clean.G"]);
    assert_eq!(ours["transmittance.Y"], theirs["transmittance.Y"]);
    assert_ne!(ours["rain.G"], theirs["rain.G"]);
}

#[test]
fn a_picture_is_written_and_told_of() {
    let ended = storm(&["render", "-o", "rain.png"]).run().succeeded();
    assert!(ended.file("rain.png").starts_with(b"\x89PNG"));
    assert_eq!(ended.stdout, "");
    assert!(ended.stderr.contains("downpour: rain: 400 mm/h, "), "{}", ended.stderr);
    assert!(ended.stderr.ends_with("downpour: wrote rain.png: 64 x 36\n"), "{}", ended.stderr);
    ended.left(&["floor.gltf", "rain.png", "storm.toml"]);
    let quiet = storm(&["render", "-q", "-o", "rain.exr"]).run().succeeded();
    assert_eq!((quiet.stdout.as_str(), quiet.stderr.as_str()), ("", ""));
    let names: Vec<String> = {
        let mut names: Vec<String> = channels(&quiet.file("rain.exr")).into_keys().collect();
        names.sort();
        names
    };
    assert_eq!(names, ["B", "G", "R"]);
}

/// Whole numbers of a channel.
fn whole(bytes: &[u8], name: &str) -> Vec<u32> {
    use exr::prelude::*;
    let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let image = image.all_attributes().from_buffered(Cursor::new(bytes)).unwrap();
    let channel =
        image.layer_data.channel_data.list.into_iter().find(|channel| channel.name.to_string() == name);
    match channel.map(|channel| channel.sample_data) {
        Some(FlatSamples::U32(numbers)) => numbers,
        other => panic!("{name}: {other:?}"),
    }
}

/// The drop that a pixel shows most of is one of the list, as large as there and as far from the eye, and takes as much light as it
/// covers. The floor is wet and under water where it should be.
#[test]
fn the_truth_about_a_pixel_is_that_of_its_drop() {
    // Splashes have an oval of their area for their alpha.
    let keys = "[splashes]\nenabled = false\n[wetness]\nwetness = 0.75\n[[puddle]]\nposition_m = [0, 0, 0]\nsize_m = [1, 1]\nmask = 'deep.png'\ndepth_mm = 20\n";
    let mut mask = Cursor::new(Vec::new());
    image::GrayImage::from_pixel(4, 4, image::Luma([255]))
        .write_to(&mut mask, image::ImageFormat::Png)
        .unwrap();
    let run = storm(&["render", "--layers", "-o", "rain.exr", "--dump-drops", "drops.csv"]);
    // Only drops that are drawn have a truth.
    let text = weather(keys).replace("seed = 7", "seed = 7\nunresolved = 'even'");
    let run = run.with_file("storm.toml", text).with_file("deep.png", mask.into_inner());
    let ended = run.run().succeeded();
    let (drops, bytes) = (rows(&ended), ended.file("rain.exr"));
    let layers = channels(&bytes);
    let (low, high) = (whole(&bytes, "drop.id_low"), whole(&bytes, "drop.id_high"));
    let (alpha, through) = (&layers["drop.alpha"], &layers["transmittance.Y"]);
    let shown: Vec<usize> = (0..alpha.len()).filter(|&k| alpha[k] > 0.0).collect();
    assert!(shown.len() > 100, "{}", shown.len());
    for &k in &shown {
        let drop = &drops[&(u64::from(high[k]) << 32 | u64::from(low[k]))];
        assert!((f64::from(layers["drop.diameter_mm"][k]) - drop.diameter_mm).abs() < 1.0e-4);
        let [x, y, z] = drop.position;
        let away = (x * x + (y - 1.2) * (y - 1.2) + (z - 6.0) * (z - 6.0)).sqrt();
        let distance = f64::from(layers["drop.distance_m"][k]);
        // It falls 0.15 m while the shutter is open.
        assert!((distance - away).abs() < 0.02 * away + 0.08, "{distance} of {away} m");
        assert!(alpha[k] < 1.05 - through[k], "{k}: {} of {}", alpha[k], through[k]);
    }
    let [wetness, water, depth] = ["wetness.Y", "water.depth_mm", "depth.Z"].map(|name| &layers[name]);
    // Of neighbors before the same ground, the one whose drop takes more light lets less through.
    let is_alike = |k: &usize| (depth[*k] / depth[k + 1] - 1.0).abs() < 0.02;
    let is_apart = |k: &usize| (alpha[*k] - alpha[k + 1]).abs() > 0.006;
    let pairs: Vec<usize> = (0..alpha.len() - 1).filter(is_alike).filter(is_apart).collect();
    let agrees = |&&k: &&usize| (alpha[k] > alpha[k + 1]) == (through[k] < through[k + 1]);
    let agreeing = pairs.iter().filter(agrees).count();
    assert!(pairs.len() > 100 && agreeing * 10 > pairs.len() * 9, "{agreeing} of {}", pairs.len());
    for k in 0..wetness.len() {
        assert!((0.0..=1.0).contains(&wetness[k]) && (depth[k] < 1.0e30 || wetness[k] + water[k] == 0.0));
    }
    // Smooth floor stores a quarter of what porous ground does: it is wetter than that.
    assert!(wetness.iter().any(|&w| w > 0.9));
    assert!(water.iter().any(|&w| (w - 20.0).abs() < 0.1));
    assert!(layers["motion.X"].iter().chain(&layers["motion.Y"]).all(|&pace| pace == 0.0));
}

/// The picture is the sum of its layers; the rain absorbs and emits light; the floor is at its depth.
#[test]
fn layers_add_up_to_the_picture() {
    let ended = storm(&["render", "--layers", "-o", "rain.exr"]).run().succeeded();
    let layers = channels(&ended.file("rain.exr"));
    let mut names: Vec<&str> = layers.keys().map(String::as_str).collect();
    names.sort_unstable();
    let expected = [
        "B",
        "G",
        "R",
        "clean.B",
        "clean.G",
        "clean.R",
        "depth.Z",
        "drop.alpha",
        "drop.diameter_mm",
        "drop.distance_m",
        "drop.id_high",
        "drop.id_low",
        "glow.B",
        "glow.G",
        "glow.R",
        "motion.X",
        "motion.Y",
        "rain.B",
        "rain.G",
        "rain.R",
        "transmittance.Y",
        "water.depth_mm",
        "wetness.Y",
    ];
    assert_eq!(names, expected);
    let through = &layers["transmittance.Y"];
    for name in ["R", "G", "B"] {
        let [clean, rain, glow] = ["clean", "rain", "glow"].map(|layer| &layers[&format!("{layer}.{name}")]);
        for (k, shown) in layers[name].iter().enumerate() {
            let sum = clean[k] * through[k] + rain[k] + glow[k];
            assert!((shown - sum).abs() <= 1.0e-5 * sum.abs(), "{name} of pixel {k}: {shown} is not {sum}");
            assert!(clean[k] >= 0.0 && rain[k] >= 0.0, "{name} of pixel {k}");
        }
    }
    assert!(through.iter().all(|t| (0.0..=1.0).contains(t)));
    // Unresolved rain is in front of every pixel, a drop in front of some.
    let mut sorted = through.clone();
    sorted.sort_by(f32::total_cmp);
    let most = sorted[sorted.len() / 10 * 9];
    assert!(most > 0.5 && most < 1.0, "{most}");
    let touched = through.iter().filter(|t| **t < most - 0.01).count();
    assert!(touched > 20 && touched < through.len() * 9 / 10, "{touched} pixels with drops");
    let shown = |rate: &str, keys: &str| {
        let run = storm(&["render", "--layers", "--rate", rate, "-o", "rain.exr"]);
        channels(&run.with_file("storm.toml", weather(keys)).run().succeeded().file("rain.exr"))
    };
    let dry = shown("0", "");
    let kept_dry = shown("100", "[wetness]\nenabled = false\n");
    assert!(
        dry["clean.G"] == kept_dry["clean.G"],
        "the scene behind does not depend on the rain but for its wetness"
    );
    assert!(dry["clean.G"] != layers["clean.G"], "the ground is wet");
    // Left of the tetrahedron, in the last row, the ray hits the floor.
    let depth = &layers["depth.Z"];
    let [width, height] = SIZE.map(|edge| edge as usize);
    let half_height = ops::tan(6.0f64.to_radians());
    let right = half_height * 64.0 / 36.0 * (2.0 * 8.5 / 64.0 - 1.0);
    let up = -half_height * 35.0 / 36.0;
    // The camera looks down by 0.6 in 6.
    let length = (0.1f64 * 0.1 + 1.0).sqrt();
    let downward = (0.1 - up) / length / (1.0 + right * right + up * up).sqrt();
    let found = f64::from(depth[(height - 1) * width + 8]);
    assert!((found - 1.2 / downward).abs() < 0.01, "{found} m, by geometry {}", 1.2 / downward);
    assert_eq!(depth[0], 1.0e30, "the sky is far");
}

/// A box of 100 m holds far more drops than are simulated: small ones are unresolved, and what the statistics say of the two
/// is all of the rain. The rate above the least diameter is that of Marshall and Palmer with the fall speeds of Beard.
#[test]
fn a_large_box_has_all_of_its_rain() {
    let rain = "distribution = 'marshall-palmer'\nvolume = 'box'\nbox_m = 100\nmax_drops = 30000\nseed = 7\n";
    let weather = weather("").replace("rate_mm_h = 400\nseed = 7\n", &format!("rate_mm_h = 10\n{rain}"));
    let ended = storm(&["render", "-o", "rain.png", "--stats", "stats.json"])
        .with_file("storm.toml", weather)
        .run()
        .succeeded();
    let stats: serde_json::Value = serde_json::from_slice(&ended.file("stats.json")).unwrap();
    let number = |key: &str| stats[key].as_f64().unwrap_or_else(|| panic!("{key} of {stats}"));
    let speed = |mm: f64| terminal_speed(FallSpeedModel::Beard1976, mm * 1.0e-3, &Air::standard()).unwrap();
    let flux = |mm: f64| ops::exp(-4.1 * ops::pow(10.0, -0.21) * mm) * mm * mm * mm * speed(mm);
    let rate = |from: f64| {
        let step = (8.0 - from) / 4000.0;
        (0..4000).map(|k| flux(from + (f64::from(k) + 0.5) * step)).sum::<f64>() * step
    };
    let from_mm = number("resolved_from_mm");
    let small = 10.0 * (1.0 - rate(from_mm) / rate(0.1));
    let drops = number("drops_simulated");
    println!(
        "{drops} drops from {from_mm} mm: {} and {} mm/h",
        number("measured_rate_mm_h"),
        number("unresolved_rate_mm_h")
    );
    assert!((20_000.0..=31_000.0).contains(&drops) && from_mm > 1.0, "{stats}");
    assert!(
        (number("unresolved_rate_mm_h") / small - 1.0).abs() < 0.005,
        "{small} mm/h are of small drops, {stats}"
    );
    let all = number("measured_rate_mm_h") + number("unresolved_rate_mm_h");
    // As many large drops scatter by 1 %, of a quarter of the rate.
    assert!((all / 10.0 - 1.0).abs() < 0.01, "{all} mm/h in all, {stats}");
    assert!(
        (0.5..1.0).contains(&number("unresolved_fraction")) && number("resolved_to_m") == 50.0,
        "{stats}"
    );
}

/// As documented for `--stats` and `--dump-drops`. The rate that the drops carry is the requested one.
#[test]
fn statistics_and_drops_agree() {
    let files = ["--stats", "stats.json", "--dump-drops", "drops.csv", "--time", "2.5"];
    let ended = storm(&[&["render", "-o", "rain.png"], &files[..]].concat()).run().succeeded();
    let stats: serde_json::Value = serde_json::from_slice(&ended.file("stats.json")).unwrap();
    let rows = rows(&ended);
    let number = |key: &str| stats[key].as_f64().unwrap_or_else(|| panic!("{key} of {stats}"));
    assert_eq!((stats["adapter"].as_str(), stats["backend"].as_str()), (Some("CPU"), Some("cpu")));
    assert_eq!([number("width"), number("height")], SIZE.map(f64::from));
    assert_eq!((number("asked_rate_mm_h"), number("time_s"), number("seed")), (400.0, 2.5, 7.0));
    assert!((number("measured_rate_mm_h") / 400.0 - 1.0).abs() < 0.1, "{stats}");
    assert_eq!(number("drops_drawn"), rows.len() as f64);
    assert!(rows.len() > 10, "{} drops", rows.len());
    assert!(number("drops_drawn") <= number("drops_on_screen"), "{stats}");
    assert!(number("drops_on_screen") <= number("drops_simulated"), "{stats}");
    let passes: f64 = stats["passes"].as_object().unwrap().values().map(|ms| ms.as_f64().unwrap()).sum();
    assert!(passes > 0.0 && passes <= number("frame_ms") * 1.0001, "{stats}");
    for (id, row) in rows.iter().filter(|(_, row)| !row.is_splash) {
        let speed =
            terminal_speed(FallSpeedModel::Beard1976, row.diameter_mm * 1.0e-3, &Air::standard()).unwrap();
        assert!((row.velocity[1] + speed).abs() < 1.0e-3 * speed, "{id}: {row:?} falls with {speed} m/s");
        assert_eq!([row.velocity[0], row.velocity[2]], [0.0, 0.0]);
        // In front of the eye at (0, 1.2, 6), within 12 degrees of height and 21 of width, some time while the shutter is
        // open.
        let [x, y, z] = row.position;
        let path = 0.5 / 60.0 * speed;
        assert!(z < 6.0 && ops::hypot(x, y - 1.2) < 0.35 * (6.0 - z) + 0.02 + path, "{id}: {row:?}");
    }
}

/// A drop is the same drop a moment later, and has fallen by its speed.
#[test]
fn time_lets_drops_fall() {
    let at = |time: &str| {
        let arguments = ["render", "-o", "rain.png", "--dump-drops", "drops.csv", "--time", time];
        rows(&storm(&arguments).run().succeeded())
    };
    let (before, after) = (at("10"), at("10.008"));
    let mut both = 0;
    for (id, earlier) in before.iter().filter(|(_, row)| !row.is_splash) {
        let Some(later) = after.get(id) else { continue };
        both += 1;
        assert_eq!(earlier.diameter_mm, later.diameter_mm);
        for k in 0..3 {
            let moved = later.position[k] - earlier.position[k];
            assert!((moved - earlier.velocity[k] * 0.008).abs() < 1.0e-6, "{id}: {earlier:?} {later:?}");
        }
    }
    assert!(both > 5, "{both} drops are in both pictures");
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let run = |arguments: &[&str]| {
        let fixed = ["render", "--layers", "-o", "rain.exr", "--dump-drops", "drops.csv"];
        let ended = storm(&[&fixed, arguments].concat()).run().succeeded();
        (ended.file("rain.exr"), ended.file("drops.csv"))
    };
    let first = run(&[]);
    assert_eq!(first, run(&[]));
    assert_eq!(first, run(&["--seed", "7", "--time", "0", "--rate", "400", "--size", "64x36"]));
    let other = run(&["--seed", "18446744073709551615"]);
    assert_ne!(first.0, other.0);
    assert_ne!(first.1, other.1);
    assert_ne!(first.1, run(&["--time", "1"]).1);
}

/// More samples alone leave the noise of a single ray on what all of them show.
#[test]
fn more_samples_have_more_rays() {
    let run = |arguments: &[&str]| {
        let fixed = ["render", "storm.toml", "--backend", "cpu", "-o", "rain.exr", "--size", "32x18"];
        let run = Downpour::new(&[&fixed, arguments].concat()).with_file("floor.gltf", model());
        run.with_file("storm.toml", weather(NO_SPLASHES)).run().succeeded().file("rain.exr")
    };
    let followed = run(&["--samples", "3"]);
    assert!(followed == run(&["--samples", "3", "--sky-rays", "2"]));
    assert!(followed != run(&["--samples", "3", "--sky-rays", "1"]));
    assert!(run(&["--samples", "1"]) == run(&["--samples", "1", "--sky-rays", "1"]));
}

#[test]
fn rate_0_is_a_dry_picture() {
    let files = ["--stats", "stats.json", "--dump-drops", "drops.csv"];
    let ended = storm(&[&["render", "--rate", "0", "--layers", "-o", "rain.exr"], &files[..]].concat())
        .run()
        .succeeded();
    let layers = channels(&ended.file("rain.exr"));
    assert!(layers["transmittance.Y"].iter().all(|t| *t == 1.0));
    for name in ["R", "G", "B"] {
        assert!(layers[&format!("rain.{name}")].iter().all(|v| *v == 0.0));
        let [clean, glow] = ["clean", "glow"].map(|layer| &layers[&format!("{layer}.{name}")]);
        let sum: Vec<f32> = clean.iter().zip(glow).map(|(clean, glow)| clean + glow).collect();
        for (shown, sum) in layers[name].iter().zip(sum) {
            assert!((shown - sum).abs() <= 1.0e-5 * sum, "{name}: {shown} is not {sum}");
        }
    }
    assert!(rows(&ended).is_empty());
    let stats: serde_json::Value = serde_json::from_slice(&ended.file("stats.json")).unwrap();
    for key in ["asked_rate_mm_h", "measured_rate_mm_h", "drops_drawn", "drops_on_screen", "drops_simulated"]
    {
        assert_eq!(stats[key].as_f64(), Some(0.0), "{key} of {stats}");
    }
    // In a file as on the command line.
    let dry = storm(&["render", "--layers", "-o", "rain.exr"]);
    let dry = dry.with_file("storm.toml", weather("").replace("rate_mm_h = 400", "rate_mm_h = 0"));
    assert_eq!(dry.run().succeeded().file("rain.exr"), ended.file("rain.exr"));
}

/// A bare model is shown in a shower, all of it in the picture.
#[test]
fn a_bare_model_is_framed() {
    let (positions, triangles) = tetrahedron();
    let arguments = ["render", "drop.gltf", "--backend", "cpu", "--samples=1", "--size=64x36", "--layers"];
    let run = Downpour::new(&[&arguments[..], &["-o", "a.exr", "--stats", "a.json"]].concat());
    let ended = run.with_file("drop.gltf", gltf(&positions, &triangles)).run().succeeded();
    let depth = &channels(&ended.file("a.exr"))["depth.Z"];
    let near = |x: usize, y: usize| depth[y * 64 + x] < 1.0e6;
    assert!(near(32, 18), "the model is in the middle");
    assert!((0..64).all(|x| !near(x, 0) && !near(x, 35)) && (0..36).all(|y| !near(0, y) && !near(63, y)));
    let rows = (0..36).filter(|&y| (0..64).any(|x| near(x, y))).count();
    assert!(rows > 20, "it fills {rows} of 36 rows");
    let stats: serde_json::Value = serde_json::from_slice(&ended.file("a.json")).unwrap();
    assert_eq!((stats["asked_rate_mm_h"].as_f64(), stats["triangles"].as_u64()), (Some(50.0), Some(4)));
}

/// Green of each pixel, 0 to 1.
fn greens(picture: &Picture) -> Vec<f32> {
    let Pixels::Rgba8(pixels) = &picture.pixels else { panic!("not 8 bits") };
    pixels.iter().map(|pixel| f32::from(pixel[1]) / 255.0).collect()
}

/// Pixels that are brighter by more than a twentieth of full white than the mean of those up to 4 columns away.
fn standing_out(greens: &[f32], width: usize) -> Vec<bool> {
    let stands_out = |i: usize| {
        let inside = (4..width - 4).contains(&(i % width));
        let around = || &greens[i - 4..=i + 4];
        inside && greens[i] - around().iter().sum::<f32>() / 9.0 > 0.05
    };
    (0..greens.len()).map(stands_out).collect()
}

/// The first picture of a new user shows rain: streaks with a contrast of more than a twentieth of full white, against the dry
/// picture and against what is beside them.
#[test]
fn the_picture_of_a_bare_model_shows_rain() {
    let (positions, triangles) = tetrahedron();
    let picture = |rate: &[&str]| {
        let arguments =
            ["render", "drop.gltf", "--backend=cpu", "--samples=1", "--size=320x180", "-o", "a.png"];
        let run = Downpour::new(&[&arguments[..], rate].concat());
        let ended = run.with_file("drop.gltf", gltf(&positions, &triangles)).run().succeeded();
        let bytes = ended.file("a.png");
        let picture = downpour::scene::picture::decode("a.png", &bytes, &mut Budget::default());
        picture.expect("a picture")
    };
    let (wet, dry) = (picture(&[]), picture(&["--rate", "0"]));
    let width = wet.width as usize;
    let (wet, dry) = (greens(&wet), greens(&dry));
    let edges = standing_out(&dry, width);
    let more = |greens: &[f32]| {
        standing_out(greens, width)
            .iter()
            .zip(&edges)
            .filter(|(of_rain, of_scene)| **of_rain && !**of_scene)
            .count()
    };
    let (of_rain, of_none) = (more(&wet), more(&greens(&picture(&["--rate", "0", "--seed", "5"]))));
    println!("{of_rain} of {} pixels stand out in rain, {of_none} without", wet.len());
    assert!(of_rain * 1000 > 3 * wet.len(), "{of_rain} of {} pixels stand out", wet.len());
    assert!(of_none * 3 < of_rain, "control: {of_none} of {} pixels stand out without rain", wet.len());
    let brighter = wet.iter().zip(&dry).filter(|(wet, dry)| *wet - *dry > 0.05).count();
    println!("{brighter} of {} pixels", wet.len());
    assert!(brighter * 100 > wet.len(), "{brighter} of {} pixels", wet.len());
}

/// A scene far from the world's origin looks as near it, and drops are listed at their positions.
#[test]
fn ten_thousand_kilometers_away_nothing_is_lost() {
    let far = weather("").replace("look_at_m = [0, 0.6, 0]", "look_at_m = [8388608, 0.6, 0]");
    let far = far.replace("position_m = [0, 1.2, 6]", "position_m = [8388608, 1.2, 6]");
    let far = far.replace("'floor.gltf'", "'floor.gltf'\ntranslation_m = [8388608, 0, 0]");
    let arguments = ["render", "--layers", "-o", "rain.exr", "--dump-drops", "drops.csv"];
    let ended = storm(&arguments).with_file("storm.toml", far).run().succeeded();
    let here = storm(&arguments).run().succeeded();
    let (there, here) = (channels(&ended.file("rain.exr")), channels(&here.file("rain.exr")));
    for (name, least) in [("depth.Z", 2150), ("clean.G", 2150)] {
        let close = |a: f32, b: f32| (a - b).abs() <= 2.0e-2 * a.abs();
        let same = there[name].iter().zip(&here[name]).filter(|(a, b)| close(**a, **b)).count();
        assert!(same > least, "{name}: {same} of 2304 pixels are the same");
    }
    let rows = rows(&ended);
    assert!(rows.len() > 10 && rows.values().all(|row| (row.position[0] - 8_388_608.0).abs() < 3.0));
    // Not on the raster of single precision, which is 1 m there.
    assert!(rows.values().any(|row| row.position[0].fract() != 0.0));
}

#[test]
fn what_exists_is_kept_and_nothing_is_written_twice() {
    for taken in ["rain.png", "stats.json", "drops.csv"] {
        let arguments = ["render", "-o", "rain.png", "--stats", "stats.json", "--dump-drops", "drops.csv"];
        let ended = storm(&arguments).with_file(taken, "precious").run();
        let ended = ended.failed(5, &[taken, "exists", "--overwrite"]).with_one_line();
        assert_eq!(ended.file(taken), b"precious");
        let mut names = ["floor.gltf", "storm.toml", taken];
        names.sort_unstable();
        ended.left(&names);
    }
    let replaced = storm(&["render", "-o", "rain.png", "--overwrite"]).with_file("rain.png", "old").run();
    assert!(replaced.succeeded().file("rain.png").starts_with(b"\x89PNG"));
}

/// A sky that would be overwritten by the picture made of it.
#[test]
fn an_input_is_not_an_output() {
    let sky = downpour::render::file::write_exr(2, 1, &[[1.0; 3]; 2]).unwrap();
    let text = weather("").replace("zenith_color = [2, 3, 4]", "file = 'sky.exr'");
    for name in ["sky.exr", "./sky.exr"] {
        let run = storm(&["render", "-o", name, "--overwrite"]).with_file("sky.exr", &sky);
        let ended = run.with_file("storm.toml", &text).run();
        let ended = ended.failed(2, &["sky.exr is an input", "allowed: another name"]).with_one_line();
        assert_eq!(ended.file("sky.exr"), sky);
    }
}
