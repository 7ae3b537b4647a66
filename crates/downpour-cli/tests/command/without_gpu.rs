//! A machine whose Vulkan has no driver.

use crate::child::Downpour;
use crate::scene_files::{model, weather};

fn without_driver(arguments: &[&str]) -> Downpour {
    Downpour::new(arguments).env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent")
}

#[test]
fn auto_takes_the_cpu_and_says_why() {
    let arguments = ["mask", "--diameter", "2", "--size", "16", "-o", "m.exr"];
    let ended = without_driver(&arguments).run().succeeded().left(&["m.exr"]);
    let line =
        ended.stderr.lines().find(|line| line.starts_with("downpour: backend: cpu (")).unwrap_or_default();
    assert!(line.contains("no GPU adapter") && line.contains("/nonexistent"), "{}", ended.stderr);
    let quiet = without_driver(&[&arguments[..], &["-q"]].concat()).run().succeeded();
    assert!(!quiet.stderr.contains("downpour:"), "{}", quiet.stderr);
    let cpu = Downpour::new(&[&arguments[..], &["--backend", "cpu"]].concat()).run().succeeded();
    assert_eq!(cpu.file("m.exr"), ended.file("m.exr"));
}

#[test]
fn a_picture_falls_back_to_the_cpu_and_says_why() {
    let of = |backend: &[&str]| {
        let fixed =
            ["render", "storm.toml", "--samples=1", "--sky-rays=1", "-o", "a.exr", "--stats", "a.json"];
        without_driver(&[&fixed, backend].concat())
            .with_file("storm.toml", weather(""))
            .with_file("floor.gltf", model())
            .run()
    };
    let auto = of(&[]).succeeded();
    let line =
        auto.stderr.lines().find(|line| line.starts_with("downpour: backend: cpu (")).unwrap_or_default();
    assert!(line.contains("no GPU adapter") && line.contains("/nonexistent"), "{}", auto.stderr);
    let stats: serde_json::Value = serde_json::from_slice(&auto.file("a.json")).unwrap();
    assert_eq!((stats["backend"].as_str(), stats["adapter"].as_str()), (Some("cpu"), Some("CPU")));
    assert_eq!(auto.file("a.exr"), of(&["--backend", "cpu"]).succeeded().file("a.exr"));
    of(&["--backend", "gpu"])
        .failed(4, &["no GPU adapter", "--backend cpu"])
        .left(&["floor.gltf", "storm.toml"]);
}

#[test]
fn gpu_is_an_error_that_names_what_was_tried() {
    for more in [&[][..], &["--adapter", "llvmpipe"]] {
        without_driver(&[&["mask", "--diameter", "2", "--backend", "gpu", "-o", "m.exr"], more].concat())
            .run()
            .failed(4, &["no GPU adapter", "tried: Vulkan", "/nonexistent", "--backend cpu"])
            .left(&[]);
    }
}

#[test]
fn the_list_of_adapters_is_empty_and_an_error() {
    let ended = without_driver(&["adapters", "--json"]).run().failed(4, &["tried: Vulkan", "/nonexistent"]);
    assert_eq!(ended.stdout, "[]\n");
    assert_eq!(without_driver(&["adapters"]).run().failed(4, &["no GPU adapter"]).stdout, "");
}

#[test]
fn a_lattice_falls_back_to_the_cpu_and_says_why() {
    for kind in [&["glass", "--size", "16x16"][..], &["puddle", "--size", "64x64"]] {
        let arguments = [&["lattice"], kind, &["--steps", "5", "--rate", "50", "--json"]].concat();
        let auto = without_driver(&[&arguments[..], &["--backend", "auto"]].concat()).run().succeeded();
        assert!(auto.stderr.contains("backend: cpu (no GPU adapter"), "{}", auto.stderr);
        let cpu = Downpour::new(&[&arguments[..], &["--backend", "cpu"]].concat()).run().succeeded();
        assert_eq!(cpu.stdout, auto.stdout);
        let gpu = without_driver(&[&arguments[..], &["--backend", "gpu"]].concat()).run();
        assert_eq!(gpu.failed(4, &["no GPU adapter"]).stdout, "");
    }
}
