//! Figures of papers as weather files, and drop appearances by name.

use std::path::{Path, PathBuf};

use crate::child::Downpour;
use crate::scene_files::{model, weather};

fn assets(folder: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets").join(folder)
}

#[test]
fn the_figures_of_papers_are_weather_files() {
    let files = std::fs::read_dir(assets("papers")).unwrap().map(|entry| entry.unwrap().path());
    let files: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    let names: Vec<String> =
        files.iter().map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).collect();
    for figure in [
        "rousseau_2006_fig_06",
        "rousseau_2006_fig_09",
        "rousseau_2006_fig_11",
        "rousseau_2006_fig_12",
        "rousseau_2006_fig_13",
        "rousseau_2006_fig_14",
        "rousseau_2006_fig_15",
        "rousseau_2006_fig_16",
        "rousseau_2008_fig_06",
        "rousseau_2008_fig_07",
        "tatarchuk_2006_fig_02",
        "tatarchuk_2006_fig_06",
        "tatarchuk_2006_fig_07",
        "im_sung_2022_fig_06",
        "im_sung_2022_fig_08",
        "im_sung_2022_fig_09",
        "im_sung_2022_fig_10",
        "im_sung_2022_fig_11",
    ] {
        assert!(names.iter().any(|name| name.starts_with(figure)), "{figure}: {names:?}");
    }
    // Streets take a second to load, and all files have one of a few: each of those once, with a file that has it, and all files
    // before a floor.
    let mut streets: Vec<String> = Vec::new();
    let root = assets("scenes/plain");
    for file in &files {
        let text = std::fs::read_to_string(file).unwrap();
        let run = Downpour::new(&["check", "w.toml", "--json"]).with_file("floor.gltf", model());
        let (floor, models) = before_a_floor(&text);
        let json = run.with_file("w.toml", floor).run().succeeded().json();
        let expected = u64::from(!models.is_empty());
        assert_eq!(json["instances"].as_u64(), Some(expected), "{}: {json}", file.display());
        if models.is_empty() || streets.iter().any(|street| street == models) {
            continue;
        }
        streets.push(models.to_owned());
        let arguments = ["check", file.to_str().unwrap(), "--asset-root", root.to_str().unwrap(), "--json"];
        let json = Downpour::new(&arguments).run().succeeded().json();
        assert!(json["triangles"].as_u64().unwrap() > 10_000, "{}: {json}", file.display());
    }
    assert!(streets.len() <= 3, "{} streets: a load of each takes a second", streets.len());
}

/// A weather with a floor instead of its models, and the text of these; empty if it has none.
fn before_a_floor(text: &str) -> (String, &str) {
    let Some(begin) = text.find("model = [") else {
        assert!(!text.contains("model"), "models in another form: {text}");
        return (text.to_owned(), "");
    };
    let length = text[begin..].find("\n]\n").expect("an end of the models");
    let models = &text[begin..begin + length + 3];
    (text.replace(models, "model = [{ file = \"floor.gltf\" }]\n"), models)
}

/// A weather of [`weather`] with more keys of its rain.
fn raining(more: &str) -> String {
    weather("").replace("seed = 7\n", &format!("seed = 7\n{more}\n"))
}

fn picture(weather: &str, options: &[&str]) -> Vec<u8> {
    let render = ["render", "w.toml", "--backend=cpu", "--samples=1", "--sky-rays=1", "-q", "-o", "a.exr"];
    let run = Downpour::new(&[&render[..], &["--shutter", "0"], options].concat());
    let ended = run.with_file("w.toml", weather).with_file("floor.gltf", model()).run().succeeded();
    std::fs::read(ended.folder.path().join("a.exr")).unwrap()
}

#[test]
fn refraction_comes_from_the_weather_or_before_it() {
    let paper = raining("refraction = 'rousseau-2006'");
    let of_weather = picture(&paper, &[]);
    assert_eq!(of_weather, picture(&weather(""), &["--refraction", "rousseau-2006"]));
    assert_eq!(picture(&weather(""), &[]), picture(&paper, &["--refraction", "direction"]));
    assert_ne!(of_weather, picture(&weather(""), &[]));
}

/// An eye sees other streaks than a camera whose shutter is open for as long; with `--shutter` it is such a camera.
#[test]
fn an_eye_is_no_shutter() {
    let seen = |keys: &str, options: &[&str]| {
        let weather = weather("").replace("[camera]\n", &format!("[camera]\n{keys}\n"));
        assert!(weather.contains(keys), "{weather}");
        let render =
            ["render", "w.toml", "--backend=cpu", "--samples=1", "--sky-rays=1", "-q", "-o", "a.exr"];
        let run = Downpour::new(&[&render[..], options].concat());
        let ended = run.with_file("w.toml", weather).with_file("floor.gltf", model()).run().succeeded();
        std::fs::read(ended.folder.path().join("a.exr")).unwrap()
    };
    let [eye, camera] = ["observer = 'eye'", "shutter_s = 0.075"].map(|keys| seen(keys, &[]));
    assert_ne!(eye, camera);
    assert_eq!(seen("observer = 'eye'\npersistence_s = 0.06", &["--shutter", "0.075"]), camera);
}

/// The model of the scene is a floor, not a drop.
#[test]
fn check_and_render_refuse_a_drop_that_is_open() {
    let bad = raining("mask_model = 'floor.gltf'") + "[streaks]\nsamples = 4\n";
    for arguments in [&["check", "w.toml"][..], &["render", "w.toml", "--backend=cpu", "-o", "a.png"]] {
        let run = Downpour::new(arguments).with_file("w.toml", &bad).with_file("floor.gltf", model()).run();
        run.failed(2, &["w.toml: rain.mask_model: floor.gltf", "closed surface", "allowed: "]);
    }
}
