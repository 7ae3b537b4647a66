//! A machine whose Vulkan has no driver.

use crate::child::Downpour;

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
