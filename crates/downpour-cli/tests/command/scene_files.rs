//! A small scene as files: a floor with a tetrahedron on it, a sky that is brighter above, and a weather.

use crate::child::Downpour;
use crate::gltf_file::gltf;

/// Columns and rows of the pictures.
pub(crate) const SIZE: [u32; 2] = [64, 36];

/// A floor of 8 m x 8 m at height 0 and a tetrahedron of about 1 m.
pub(crate) fn model() -> String {
    let positions = [
        [-4.0, 0.0, -4.0],
        [4.0, 0.0, -4.0],
        [4.0, 0.0, 4.0],
        [-4.0, 0.0, 4.0],
        [-0.5, 0.0, 0.5],
        [0.5, 0.0, 0.5],
        [0.0, 0.0, -0.5],
        [0.0, 1.0, 0.0],
    ];
    gltf(&positions, &[[0, 2, 1], [0, 3, 2], [4, 5, 7], [5, 6, 7], [6, 4, 7]])
}

/// A weather of heavy rain for [`model`]; `more` is appended.
pub(crate) fn weather(more: &str) -> String {
    format!(
        "[rain]\nrate_mm_h = 400\nseed = 7\n\
         [sky]\nzenith_color = [2, 3, 4]\n\
         [camera]\nposition_m = [0, 1.2, 6]\nlook_at_m = [0, 0.6, 0]\nfov_deg = 12\n\
         [[model]]\nfile = 'floor.gltf'\n\
         [output]\nsize = [{}, {}]\n{more}",
        SIZE[0], SIZE[1]
    )
}

/// Rain without splashes: a command traces no masks of their crowns, which is half of its time.
pub(crate) const NO_SPLASHES: &str = "[splashes]\nenabled = false\n";

/// The command on `storm.toml`, in a folder with the scene. It renders on the CPU, coarsely, without splashes.
pub(crate) fn storm(arguments: &[&str]) -> Downpour {
    let render: &[&str] = &["--backend", "cpu", "--samples", "1", "--sky-rays", "1"];
    let rest: &[&str] = if arguments.first() == Some(&"render") { render } else { &[] };
    let (command, more) = arguments.split_at(1);
    Downpour::new(&[command, &["storm.toml"], rest, more].concat())
        .with_file("storm.toml", weather(NO_SPLASHES))
        .with_file("floor.gltf", model())
}
