//! Files that are no files, links that lead away, and paths that cannot be.

mod document;
mod exit_code;

use document::{check_message, data_uri, floats, spoiled, triangle, triangle_of};
use downpour_scene::gltf::{MAX_FILE, read_triangles, read_triangles_from_bytes};
use downpour_scene::sandbox::{Files, NoFiles, OpenFile, RelativePath};
use downpour_scene::{Budget, SceneError};
use exit_code::ExitCode as _;
use serde_json::json;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Time limit for a file on a busy machine, after which it counts as hanging.
const PATIENCE: Duration = Duration::from_secs(600);

fn read(path: &Path) -> Result<usize, SceneError> {
    let (send, receive) = std::sync::mpsc::channel();
    let owned = path.to_owned();
    std::thread::spawn(move || {
        let result = read_triangles(&owned, &mut Budget::default()).map(|model| model.indices.len());
        // The test has ended if nobody receives.
        let _ = send.send(result);
    });
    receive.recv_timeout(PATIENCE).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn refused(path: &Path, code: u8, words: &str) {
    let error = read(path).expect_err(words);
    let message = error.to_string();
    assert!(error.exit_code() == code && message.contains(words), "wanted {code} {words}, got {message}");
    check_message(&message);
}

/// A scene folder whose triangle has its buffer in another file.
fn scene(folder: &Path, uri: &str) -> PathBuf {
    let path = folder.join("scene.gltf");
    fs::write(&path, spoiled(&[("/buffers/0/uri", json!(uri))]).to_string()).expect("a scene can be written");
    path
}

fn buffer() -> Vec<u8> {
    let mut bytes = floats(&[0.0; 18]);
    bytes.extend([0, 0, 1, 0, 2, 0, 0, 0]);
    bytes
}

#[test]
fn a_buffer_beside_the_scene_is_read() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("sub")).expect("a folder");
    fs::write(folder.path().join("sub/my mesh.bin"), buffer()).expect("a buffer");
    let path = scene(folder.path(), "./sub/my%20mesh.bin");
    assert_eq!(read(&path).expect("valid"), 1);
    fs::write(folder.path().join("sub/my mesh.bin"), &buffer()[..79]).expect("a buffer");
    refused(&path, 2, "buffers[0].uri: byteLength 80, but the file has 79 bytes");
    fs::remove_file(folder.path().join("sub/my mesh.bin")).expect("removed");
    refused(&path, 5, "buffers[0].uri: \"sub/my mesh.bin\" cannot be read");
    fs::create_dir(folder.path().join("sub/my mesh.bin")).expect("a folder");
    refused(&path, 2, "buffers[0].uri: \"sub/my mesh.bin\" is a folder, not a regular file");
}

/// G7 and G9, and links out of the folder.
#[test]
#[cfg(unix)]
fn fifos_devices_and_links() {
    use rustix::fs::{CWD, FileType, Mode, mknodat};
    use std::os::unix::fs::symlink;
    let outside = tempfile::tempdir().expect("a folder");
    fs::write(outside.path().join("secret.bin"), buffer()).expect("a file");
    let folder = tempfile::tempdir().expect("a folder");
    let inside = folder.path();
    mknodat(CWD, inside.join("fifo.bin"), FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).expect("a FIFO");
    refused(&scene(inside, "fifo.bin"), 2, "buffers[0].uri: \"fifo.bin\" is a FIFO, not a regular file");
    refused(&inside.join("fifo.bin"), 2, "is a FIFO, not a regular file");
    for (name, target) in [("a.bin", outside.path().join("secret.bin")), ("b.bin", "/dev/zero".into())] {
        symlink(target, inside.join(name)).expect("a link");
        refused(&scene(inside, name), 2, &format!("\"{name}\" leaves the scene folder through a link"));
    }
    symlink(outside.path(), inside.join("way")).expect("a link");
    refused(&scene(inside, "way/secret.bin"), 2, "leaves the scene folder through a link");
    symlink("loop.bin", inside.join("loop.bin")).expect("a link");
    refused(&scene(inside, "loop.bin"), 2, "leaves the scene folder through a link");
    symlink("/proc/self/fd/0", inside.join("magic.bin")).expect("a link");
    refused(&scene(inside, "magic.bin"), 2, "leaves the scene folder through a link");
    fs::write(inside.join("real.bin"), buffer()).expect("a file");
    symlink("real.bin", inside.join("near.bin")).expect("a link");
    assert_eq!(read(&scene(inside, "near.bin")).expect("a link that stays inside"), 1);
    refused(Path::new("/dev/zero"), 2, "/dev/zero: is a device, not a regular file");
    // The user's path may be a link to any file.
    let link = outside.path().join("link.gltf");
    fs::write(inside.join("whole.gltf"), triangle().to_string()).expect("a file");
    symlink(inside.join("whole.gltf"), &link).expect("a link");
    assert_eq!(read(&link).expect("the user said so"), 1);
}

/// T12 and T13 as they concern glTF.
#[test]
fn paths_that_are_no_files() {
    let folder = tempfile::tempdir().expect("a folder");
    refused(folder.path(), 2, "is a folder, not a regular file");
    refused(&folder.path().join("missing.glb"), 5, "missing.glb: cannot be read");
    refused(&folder.path().join("missing/a.glb"), 5, "a.glb: cannot be read");
    fs::write(folder.path().join("empty.glb"), b"").expect("a file");
    refused(&folder.path().join("empty.glb"), 2, "empty.glb: an empty file");
    refused(&folder.path().join("x".repeat(70_000)), 2, "cannot be read");
    refused(Path::new("a\0b.glb"), 2, "a\\0b.glb: cannot be read");
    let huge = folder.path().join("huge.glb");
    File::create(&huge).and_then(|file| file.set_len(MAX_FILE + 1)).expect("a sparse file");
    refused(&huge, 3, "huge.glb: a file of 268435457 bytes; allowed: at most 268435456 bytes (256 MiB)");
}

#[test]
fn a_scene_in_memory() {
    let document = spoiled(&[("/buffers/0/uri", json!("a/b.bin"))]).to_string();
    let mut files = BTreeMap::new();
    let read = |files: &BTreeMap<String, Vec<u8>>| {
        read_triangles_from_bytes("web.gltf", document.as_bytes(), files, &mut Budget::default())
    };
    assert_eq!(read(&files).expect_err("no file").exit_code(), 5);
    files.insert("a/b.bin".to_owned(), buffer());
    assert_eq!(read(&files).expect("valid").indices, [[0, 1, 2]]);
    let alone = read_triangles_from_bytes("web.gltf", document.as_bytes(), &NoFiles, &mut Budget::default());
    let message = alone.expect_err("no files at all").to_string();
    assert!(message.starts_with("web.gltf: buffers[0].uri: \"a/b.bin\" is another file"), "{message}");
}

/// Files with a count of their openings.
struct Counted(BTreeMap<String, Vec<u8>>, Cell<u32>);

impl Files for Counted {
    fn open(&self, path: &RelativePath) -> Result<OpenFile, SceneError> {
        self.1.set(self.1.get() + 1);
        self.0.open(path)
    }
}

/// Two buffers in one file: it is read once, as far as the longer one needs.
#[test]
fn a_file_is_read_once() {
    let mut document = spoiled(&[("/buffers/0", json!({"byteLength": 36, "uri": "a.bin"}))]);
    document["buffers"].as_array_mut().expect("an array").push(json!({"byteLength": 80, "uri": "./a.bin"}));
    for view in [1, 2] {
        document["bufferViews"][view]["buffer"] = json!(1);
    }
    let files = Counted(BTreeMap::from([("a.bin".to_owned(), buffer())]), Cell::new(0));
    let text = document.to_string();
    let model =
        read_triangles_from_bytes("x", text.as_bytes(), &files, &mut Budget::default()).expect("valid");
    assert_eq!((model.positions.len(), files.1.get()), (3, 1));
    // The guard rejects before any file is opened.
    let spoiled = document::with(document, &[("/accessors/0/count", json!(4))]).to_string();
    read_triangles_from_bytes("x", spoiled.as_bytes(), &files, &mut Budget::default()).expect_err("too long");
    assert_eq!(files.1.get(), 1);
}

/// Over a budget is exit 3, and a rejected file costs nothing.
#[test]
fn budgets_are_kept() {
    let document = triangle().to_string();
    let read = |budget: &mut Budget| read_triangles_from_bytes("x", document.as_bytes(), &NoFiles, budget);
    let whole = Budget::default();
    for (budget, words) in [
        (Budget { bytes: 10_000, ..whole }, "needed; allowed:"),
        (Budget { vertices: 2, ..whole }, "meshes: 3 vertices; allowed: 2 vertices left in the budget"),
        (Budget { nodes: 0, ..whole }, "nodes: 1 nodes; allowed: 0 nodes left in the budget"),
    ] {
        let mut left = budget;
        let error = read(&mut left).expect_err(words);
        assert!(error.exit_code() == 3 && error.to_string().contains(words), "{error}");
        assert_eq!(left, budget);
    }
    let images = spoiled(&[("/images", json!([{"uri": "a.png"}, {"uri": "b.png"}]))]).to_string();
    let error =
        read_triangles_from_bytes("x", images.as_bytes(), &NoFiles, &mut Budget { textures: 1, ..whole })
            .expect_err("two");
    assert_eq!(error.exit_code(), 3);
    let mut left = whole;
    read(&mut left).expect("valid");
    assert_eq!(
        left,
        Budget { bytes: whole.bytes - 7 * 12, vertices: whole.vertices - 3, nodes: whole.nodes - 1, ..whole }
    );
    let data = data_uri(&buffer());
    assert!(triangle_of(&buffer()).to_string().contains(&data));
}
