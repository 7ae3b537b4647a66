//! Files from other sources: samples, the test files of the Khronos validator, files that break careless loaders, photographs of
//! skies. They are not part of the repository: they are read from the folder in `DOWNPOUR_DATA`, else from `shared/data` beside
//! it. If a folder is missing, its tests are shown as ignored.

#[path = "../document/mod.rs"]
mod document;
#[path = "../exit_code/mod.rs"]
mod exit_code;
mod samples;
mod skies;
mod validator;

use downpour_scene::Budget;
use downpour_scene::gltf::{read_scene, read_triangles};
use libtest_mimic::{Arguments, Failed, Trial};
use std::path::PathBuf;
use std::process::ExitCode;

/// A folder of the data.
fn folder(name: &str) -> PathBuf {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data"));
    std::env::var_os("DOWNPOUR_DATA").map_or_else(beside, PathBuf::from).join(name)
}

/// Every file that breaks careless loaders: never a panic, a message of one line.
fn bad_inputs() {
    let mut count = 0;
    for entry in std::fs::read_dir(folder("bad_inputs")).expect("the folder") {
        let path = entry.expect("readable").path();
        count += 1;
        match read_triangles(&path, &mut Budget::default()) {
            Ok(model) => document::check(&model),
            Err(error) => document::check_message(&error.to_string()),
        }
        match read_scene(&path, &mut Budget::default()) {
            Ok(scene) => document::check_scene(&scene),
            Err(error) => document::check_message(&error.to_string()),
        }
    }
    assert!(count > 30, "{count} files");
}

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let tests: [(&str, &str, fn()); 12] = [
        ("bad_inputs", "bad_inputs", bad_inputs),
        ("the_validators_files", "gltf_invalid/validator", validator::files),
        ("the_validators_files_as_scenes", "gltf_invalid/validator", validator::files_as_scenes),
        ("models_are_read_whole", "gltf", samples::models_are_read_whole),
        ("the_toy_car_has_glass_and_eyes", "gltf/ToyCar", samples::the_toy_car_has_glass_and_eyes),
        (
            "lamps_stand_where_the_file_says",
            "gltf/LightsPunctualLamp",
            samples::lamps_stand_where_the_file_says,
        ),
        ("strengths_and_cutoffs", "gltf/EmissiveStrengthTest", samples::strengths_and_cutoffs),
        ("cubes_move_in_nine_ways", "gltf/InterpolationTest", samples::cubes_move_in_nine_ways),
        ("wheels_turn", "gltf/CesiumMilkTruck", samples::wheels_turn),
        (
            "recursive_skeletons_stay_finite",
            "gltf/RecursiveSkeletons",
            samples::recursive_skeletons_stay_finite,
        ),
        ("negative_scales_are_known", "gltf/NegativeScaleTest", samples::negative_scales_are_known),
        ("photographs_of_skies", "hdr", skies::photographs_of_skies),
    ];
    let trials = tests.map(|(name, needs, run)| {
        let is_missing = !folder(needs).is_dir();
        if is_missing && !arguments.list {
            eprintln!("{name} is ignored: no folder {}", folder(needs).display());
        }
        let body = move || -> Result<(), Failed> {
            run();
            Ok(())
        };
        Trial::test(name, body).with_ignored_flag(is_missing)
    });
    libtest_mimic::run(&arguments, trials.into()).exit_code()
}
