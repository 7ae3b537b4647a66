//! Broken files through `check` and `render`: a code of the contract, one line with the reason, nothing written; the same code
//! from both.

use std::fs;
use std::path::PathBuf;

use crate::broken::bad_inputs;
use crate::child::{Downpour, Ended};

/// 4 GiB of memory, if a shell can limit it.
fn limited(arguments: &[&str]) -> Downpour {
    #[cfg(unix)]
    return Downpour::limited(&["-v 4194304"], arguments);
    #[cfg(not(unix))]
    Downpour::new(arguments)
}

fn render(input: &str) -> Downpour {
    let small = ["--backend=cpu", "--size=4x4", "--samples=1", "--sky-rays=0", "-q", "-o", "a.png"];
    limited(&[&["render", input], &small[..]].concat())
}

/// Exit code of a run, checked.
#[track_caller]
fn code(name: &str, ended: Ended, written: &[&str]) -> i32 {
    let code = ended.code.unwrap_or_else(|| panic!("{name}: a signal: {}", ended.stderr));
    match code {
        0 => drop(ended.left(written)),
        2 | 3 | 5 => {
            let kept: Vec<&str> = written.iter().copied().filter(|name| *name != "a.png").collect();
            ended.failed(code, &["allowed: "]).left(&kept);
        }
        _ => panic!("{name}: {code} {}", ended.stderr),
    }
    code
}

#[test]
fn models_are_read_or_refused() {
    let is_model = |path: &PathBuf| path.extension().is_some_and(|e| e == "gltf" || e == "glb");
    let folder = tempfile::tempdir().unwrap();
    let found: Vec<PathBuf> = bad_inputs(folder.path()).into_iter().filter(is_model).collect();
    assert!(found.len() > 100, "{} files", found.len());
    // As many at once as the machine has threads.
    let next = std::sync::atomic::AtomicUsize::new(0);
    let counts = std::sync::Mutex::new([0usize; 2]);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(path) = found.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)) {
                    let name = path.to_str().unwrap();
                    let checked = code(name, limited(&["check", name]).run(), &[]);
                    let done = code(name, render(name).run(), &["a.png"]);
                    assert_eq!(checked, done, "{name}: what check says and what render does");
                    counts.lock().unwrap()[usize::from(checked != 0)] += 1;
                }
            });
        }
    });
    let [read, refused] = counts.into_inner().unwrap();
    assert!(read > 10 && refused > 40, "{read} read, {refused} refused");
}

/// Files of other kinds as skies, and as inputs of all sorts.
#[test]
fn what_is_no_sky_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let kinds = ["exr", "hdr", "ktx2", "png", "jpg", "bin", "tsv"];
    let others = bad_inputs(folder.path())
        .into_iter()
        .filter(|path| path.extension().is_some_and(|e| kinds.iter().any(|o| e == *o)));
    let mut count = 0;
    for path in others {
        let name = path.file_name().unwrap().to_str().unwrap();
        let sky = format!("sky{}", &name[name.rfind('.').unwrap()..]);
        let text = format!("[sky]\nfile = '{sky}'\n");
        let run = render("a.toml").with_file("a.toml", text).with_file(&sky, fs::read(&path).unwrap());
        let mut written = ["a.png", "a.toml", &sky];
        written.sort_unstable();
        let result = code(name, run.run(), &written);
        assert!(result != 0, "{name} is a sky");
        code(name, limited(&["check", path.to_str().unwrap()]).run(), &[]);
        count += 1;
    }
    assert!(count > 5, "{count} files");
}
