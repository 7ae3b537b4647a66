//! Every WGSL function has a Rust function of its name, and every Rust function that is named after a WGSL file a WGSL function, but for
//! those that are listed here.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use downpour_tests::signature::all_functions;
use downpour_tests::sources::rust_files;

/// WGSL functions whose work a Rust function of another name does, and where. Kernel-level cases compare the results.
const ELSEWHERE: [(&[&str], &str); 14] = [
    (&["spacing_place"], "which invocation has which pixel; the CPU traces rows"),
    (
        &[
            "puddle_is_finite",
            "puddle_normal_found",
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
        &[
            "field_beyond",
            "field_carried",
            "field_chain",
            "field_column",
            "field_drop",
            "field_list",
            "field_meets",
            "field_product",
            "field_shows",
            "field_touches",
        ],
        "the CPU computes in f64 and in wide integers, in the world (downpour_sim::field, drift and view)",
    ),
    (
        &[
            "drip_add",
            "drip_draw",
            "drip_falls",
            "drip_first",
            "drip_hangs",
            "drip_largest",
            "drip_last",
            "drip_leaves",
            "drip_meets",
            "drip_point",
        ],
        "the CPU computes in f64, in the world (downpour_sim::drips, its points, and downpour_sim::view)",
    ),
    (&["bounce_row", "shelter_carried"], "downpour_sim::drift"),
    (
        &["bounce_find_chain", "bounce_find_parts"],
        "the CPU looks where surfaces are, in the world (downpour_sim::impacts and places)",
    ),
    (
        &["bounce_hit_part", "bounce_listed", "bounce_outside", "bounce_shows"],
        "the CPU lists droplets in f64, in the world (the loop of RainField::bounced, FallingDrop::beyond, View::shows)",
    ),
    (&["step_list_add"], "the CPU collects drops in a list (downpour_sim::step_list)"),
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

/// Functions of twins that have no WGSL function of their name, and why.
const HOST_ONLY: [(&[&str], &str); 9] = [
    (
        &["bvh_bounds", "bvh_bounds_within"],
        "questions of the CPU alone: the box of a mesh, and what of it lies in another box",
    ),
    (
        &[
            "packing_pack_half",
            "packing_pack_snorm",
            "packing_pack_unorm",
            "packing_unpack_half",
            "packing_unpack_snorm",
            "packing_unpack_unorm",
        ],
        "WGSL has them built in",
    ),
    (&["pyramid_append", "pyramid_levels"], "the host's loop over levels, with a dispatch for each"),
    (
        &["drop_light_rows", "motion_diameter_bits", "motion_table", "project_frequencies"],
        "tables that the host makes",
    ),
    (&["refine_shift"], "the host shifts the camera of a frame"),
    (
        &["tone_automatic_exposure", "tone_number", "tone_picture"],
        "the exposure is found on the CPU; the loop over pixels",
    ),
    (&["step_bounces"], "the host decides whether drops rebound"),
    (&["specimen_light"], "the loop of main_specimen over the reflections"),
    (
        &["path_light", "surface_emission"],
        "path_light: turns 1 and on of the loop of path_trace. WGSL has one loop for the surface and for the rays that look for its \
         light, so that the hierarchy's walk and the materials stand in the kernel once: software drivers inline each call and compile it \
         again. surface_emission: a part of surface_at",
    ),
];

/// Functions outside of tests in a text, that begin with a stem.
fn named_after(text: &str, stem: &str) -> BTreeSet<String> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    let names = code.split("fn ").skip(1).map(|rest| rest.chars().take_while(|&c| is_name(c)).collect());
    names.filter(|name: &String| name.strip_prefix(stem).is_some_and(|rest| rest.starts_with('_'))).collect()
}

/// Stems of the WGSL files whose twin a file says that it is.
fn twin_of(text: &str) -> Vec<String> {
    let documentation: String =
        text.lines().filter_map(|line| line.strip_prefix("//!")).collect::<Vec<_>>().join("");
    if !documentation.contains("win of") {
        return Vec::new();
    }
    let files = documentation.split('`').filter_map(|word| word.strip_suffix(".wgsl"));
    files.filter_map(|path| path.rsplit('/').next()).map(str::to_owned).collect()
}

/// A stage of a kernel that only the CPU has is a kernel written in another way.
#[test]
fn every_function_of_a_twin_is_one_of_the_shader() {
    let shaders: BTreeSet<String> = all_functions().into_iter().collect();
    let listed: BTreeSet<&str> = HOST_ONLY.iter().flat_map(|(names, _)| names.iter().copied()).collect();
    let (mut without, mut used) = (BTreeSet::new(), BTreeSet::new());
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    for path in rust_files(&crates).unwrap() {
        let text = fs::read_to_string(&path).unwrap();
        let mut stems = twin_of(&text);
        // Parts of a twin in files of their own.
        stems.extend(
            path.parent()
                .and_then(Path::file_name)
                .map(|folder| folder.to_string_lossy().into_owned())
                .filter(|folder| {
                    fs::read_to_string(path.with_file_name("..").join(format!("{folder}.rs")))
                        .is_ok_and(|text| twin_of(&text).contains(folder))
                }),
        );
        for name in
            stems.iter().flat_map(|stem| named_after(&text, stem)).filter(|name| !shaders.contains(name))
        {
            match listed.get(name.as_str()) {
                Some(name) => used.insert(*name),
                None => without.insert(format!("{}: {name}", path.display())),
            };
        }
    }
    assert!(without.is_empty(), "no WGSL function of this name: {without:#?}");
    assert_eq!(used, listed, "listed for nothing");
}
