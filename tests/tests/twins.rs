//! Every WGSL function has a Rust function of its name, but for those that are listed here.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use downpour_tests::signature::all_functions;
use downpour_tests::sources::rust_files;

/// WGSL functions whose work a Rust function of another name does, and where. Kernel-level cases compare the results.
const ELSEWHERE: [(&[&str], &str); 10] = [
    (
        &[
            "puddle_is_finite",
            "puddle_normal_quad",
            "puddle_normal_row",
            "puddle_state_load",
            "puddle_state_words",
            "puddle_step_at",
            "puddle_step_coefficient",
            "puddle_step_direct",
            "puddle_step_direct_row",
            "puddle_step_direct_side",
            "puddle_step_direct_straight",
            "puddle_step_keep",
            "puddle_step_row",
            "puddle_step_settle",
            "puddle_step_fraction",
            "puddle_step_shift",
            "puddle_step_sums",
        ],
        "the GPU steps tiles with a halo in workgroup memory, the CPU rows in lanes (downpour_lattice::puddle::step)",
    ),
    (
        &["field_beyond", "field_carried", "field_chain", "field_meets", "field_product", "field_shows"],
        "the CPU computes in f64 and in wide integers, in the world (downpour_sim::field, drift and view)",
    ),
    (&["shelter_carried"], "downpour_sim::drift"),
    (&["bvh_hit"], "downpour_bvh::bvh_nearest returns an option in place of a distance below 0"),
    (&["enter_find", "enter_region"], "downpour_sim::region has the boxes as values, the GPU as rows"),
    (&["mask_model_sample"], "part of mask_model_texel in downpour_mask::model"),
    (&["path_nothing"], "the constant ViewPath::NOTHING"),
    (&["specimen_pixel"], "the loop of downpour_specimen::render"),
    (&["step_catch", "step_note"], "methods of the step's events in downpour_sim::step"),
    (&["streak_rays_ray"], "the loop of downpour_render::rain::streak_rays"),
];

/// The names of the functions of the crates.
fn rust_functions() -> BTreeSet<String> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let named = |path: PathBuf| {
        let text = fs::read_to_string(path).unwrap();
        let begins = text.split("fn ").skip(1);
        begins.map(|rest| rest.chars().take_while(|&c| is_name(c)).collect::<String>()).collect::<Vec<_>>()
    };
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    rust_files(&crates).unwrap().into_iter().flat_map(named).collect()
}

#[test]
fn every_shader_function_has_a_twin_of_its_name() {
    let twins = rust_functions();
    let listed: BTreeSet<&str> = ELSEWHERE.iter().flat_map(|(names, _)| names.iter().copied()).collect();
    // Entry points have no twin.
    let all: BTreeSet<String> =
        all_functions().into_iter().filter(|name| !name.starts_with("main_")).collect();
    let without = all.iter().filter(|name| !twins.contains(*name) && !listed.contains(name.as_str()));
    assert_eq!(without.collect::<Vec<_>>(), Vec::<&String>::new(), "no Rust function of this name");
    for name in listed {
        assert!(all.contains(name) && !twins.contains(name), "{name} is listed for nothing");
    }
}
