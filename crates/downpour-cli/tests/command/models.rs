//! Models that are not drops: code 2 or 3, one line, no panic, no hang, nothing written.

use std::fs;
use std::path::Path;

use crate::broken::bad_inputs;
use crate::child::{Downpour, Ended};
use crate::gltf_file::{empty, gltf, tetrahedron};

/// 4 GiB of memory, if a shell can limit it.
fn mask_of(model: &Path) -> Ended {
    let arguments: [&std::ffi::OsStr; 7] = [
        "mask".as_ref(),
        "--model".as_ref(),
        model.as_os_str(),
        "--size=16".as_ref(),
        "--backend=cpu".as_ref(),
        "-o".as_ref(),
        "m.exr".as_ref(),
    ];
    #[cfg(unix)]
    return Downpour::limited(&["-v 4194304"], &arguments).run();
    #[cfg(not(unix))]
    Downpour::new(&arguments).run()
}

/// Some of these files are good glTF: but none is a closed drop. One names a buffer that is not there: code 5.
#[test]
fn every_bad_input_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let found = bad_inputs(folder.path());
    assert!(found.len() > 100, "{} files", found.len());
    for path in found {
        let ended = mask_of(&path);
        let name = path.file_name().unwrap().to_string_lossy();
        let code = ended.code.unwrap_or_else(|| panic!("{name}: a signal: {}", ended.stderr));
        let expected = if name == "not_found.gltf" { [5, 5] } else { [2, 3] };
        assert!(expected.contains(&code), "{name}: {code} {}", ended.stderr);
        ended.failed(code, &[&name, "allowed: "]).with_one_line().left(&[]);
    }
}

/// A drop model in a separate folder, and the text of its error.
#[track_caller]
fn refused(text: &str, words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drop.gltf");
    fs::write(&path, text).unwrap();
    mask_of(&path).failed(2, &["drop.gltf", "allowed: "]).failed(2, words).with_one_line().left(&[]);
}

#[test]
fn a_mesh_that_is_no_closed_drop_is_refused_with_the_reason() {
    let (positions, triangles) = tetrahedron();
    refused(&empty(), &["no"]);
    refused(&gltf(&positions, &triangles[..3]), &["it is open", "3 edges"]);
    let inside_out: Vec<[u32; 3]> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    refused(&gltf(&positions, &inside_out), &["inside out"]);
    let one_turned = [triangles[0], triangles[1], triangles[2], [1, 3, 2]];
    refused(&gltf(&positions, &one_turned), &["the same direction in 2 triangles"]);
    let twice = [&triangles[..], &triangles[..]].concat();
    refused(&gltf(&positions, &twice), &["the same direction in 2 triangles"]);
    let flat: Vec<[f32; 3]> = positions.iter().map(|p| [p[0], p[1], 0.0]).collect();
    refused(&gltf(&flat, &triangles), &["degenerate"]);
    refused(&gltf(&[[1.0; 3]; 4], &triangles), &["degenerate"]);
    refused(&gltf(&positions, &[[0, 1, 2], [0, 1, 9], [0, 2, 3], [1, 2, 3]]), &["9"]);
    let far: Vec<[f32; 3]> = positions.iter().map(|p| p.map(|c| c * 1.0e38)).collect();
    refused(&gltf(&far, &triangles), &["allowed"]);
}

#[test]
fn what_is_no_model_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("empty.glb"), "").unwrap();
    fs::write(at("text.glb"), "a drop").unwrap();
    fs::write(at("picture.glb"), b"\x89PNG\r\n\x1a\n0000").unwrap();
    fs::write(at("deep.gltf"), "[".repeat(200_000)).unwrap();
    fs::create_dir(at("folder.glb")).unwrap();
    for name in ["empty.glb", "text.glb", "picture.glb", "deep.gltf", "folder.glb"] {
        mask_of(&at(name)).failed(2, &[name]).with_one_line().left(&[]);
    }
    mask_of(&at("missing.glb")).failed(5, &["missing.glb", "No such file"]).with_one_line().left(&[]);
    if cfg!(target_os = "linux") {
        mask_of(Path::new("/dev/zero")).failed(2, &["/dev/zero"]).with_one_line().left(&[]);
        mask_of(Path::new("/proc/self/mem")).with_one_line().left(&[]);
    }
}
