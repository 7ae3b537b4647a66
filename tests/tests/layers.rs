//! Dependencies point downwards: crates by their layer, and modules of a crate without circles.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use downpour_tests::sources::rust_files;

/// The layer of each crate, as in ARCHITECTURE.md: a crate names those of lower layers alone.
const LAYERS: [(&str, u32); 20] = [
    ("downpour-shaders", 0),
    ("downpour-math", 1),
    ("downpour-gpu", 2),
    ("downpour-bvh", 2),
    ("downpour-drop", 2),
    ("downpour-lattice", 3),
    ("downpour-mask", 3),
    ("downpour-wind", 3),
    ("downpour-atlas", 4),
    ("downpour-scene", 4),
    ("downpour-sim", 4),
    ("downpour-street", 4),
    ("downpour-weather", 5),
    ("downpour-render", 6),
    ("downpour-trace", 7),
    ("downpour-specimen", 8),
    ("downpour", 9),
    ("downpour-view", 10),
    ("downpour-cli", 11),
    ("downpour-tests", 11),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn folder(name: &str) -> PathBuf {
    match name {
        "downpour-shaders" => root().join("shaders"),
        "downpour-tests" => root().join("tests"),
        _ => root().join("crates").join(name),
    }
}

/// The crates of the workspace that a manifest names outside of its tests.
fn named(manifest: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut counts = false;
    for line in manifest.lines() {
        if line.starts_with('[') {
            counts = line.contains("dependencies") && !line.contains("dev-dependencies");
        } else if counts && line.starts_with("downpour") {
            names.insert(line.split(['.', ' ', '=']).next().unwrap_or_default().to_owned());
        }
    }
    names
}

#[test]
fn no_crate_names_one_above_it_or_beside_it() {
    let layers = BTreeMap::from(LAYERS);
    let crates = fs::read_dir(root().join("crates")).unwrap().map(|entry| entry.unwrap().file_name());
    for name in crates {
        assert!(layers.contains_key(&*name.to_string_lossy()), "{} has no layer", name.display());
    }
    let mut wrong = Vec::new();
    for (name, layer) in LAYERS {
        let manifest = fs::read_to_string(folder(name).join("Cargo.toml")).unwrap();
        for other in named(&manifest) {
            if layers.get(other.as_str()).is_none_or(|&below| below >= layer) {
                wrong
                    .push(format!("{name} (layer {layer}) names {other} ({:?})", layers.get(other.as_str())));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Rain is drawn on a plate, wherever it comes from.
#[test]
fn rain_names_no_triangle_and_no_material() {
    let manifest = fs::read_to_string(folder("downpour-render").join("Cargo.toml")).unwrap();
    for scene in ["downpour-bvh", "downpour-scene", "downpour-trace"] {
        assert!(!named(&manifest).contains(scene), "downpour-render names {scene}");
    }
    for path in rust_files(&folder("downpour-render").join("src")).unwrap() {
        // The atlas finds a direction of light among triangles of directions.
        if path.ends_with("rain/light/atlas.rs") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap().to_lowercase();
        for word in ["triangle", "material"] {
            assert!(!text.contains(word), "{}: {word}", path.display());
        }
    }
}

/// The diagram of ARCHITECTURE.md is this table.
#[test]
fn the_architecture_shows_the_layers() {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let mut rows: BTreeMap<u32, Vec<&str>> = BTreeMap::new();
    for (name, layer) in LAYERS {
        rows.entry(layer).or_default().push(name);
    }
    for (layer, names) in rows {
        let row = format!("{layer}  {}", names.join("  "));
        assert!(text.contains(&row), "ARCHITECTURE.md has no row \"{row}\"");
    }
}

/// Modules that each module at the root of a crate names, tests and documentation left out.
fn imports(source: &Path) -> BTreeMap<String, BTreeSet<String>> {
    let all = rust_files(source).unwrap();
    let top = |path: &Path| -> String {
        let relative = path.strip_prefix(source).unwrap();
        let first = relative.components().next().unwrap().as_os_str().to_string_lossy().into_owned();
        first.trim_end_matches(".rs").to_owned()
    };
    let modules: BTreeSet<String> = all.iter().map(|path| top(path)).collect();
    let mut imports: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for path in &all {
        let module = top(path);
        let is_test = path.components().any(|part| part.as_os_str() == "tests");
        if module == "lib" || module == "main" || is_test || path.ends_with("tests.rs") {
            continue;
        }
        let text = fs::read_to_string(path).unwrap();
        let text = text.split("#[cfg(test)]").next().unwrap_or_default();
        let code: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
        let of_root = path.parent() == Some(source);
        for found in names_after(&code.join("\n"), "crate::").into_iter().chain(if of_root {
            names_after(&code.join("\n"), "super::")
        } else {
            Vec::new()
        }) {
            if modules.contains(&found) && found != module {
                imports.entry(module.clone()).or_default().insert(found);
            }
        }
    }
    imports
}

/// The first names of paths that begin with a word, those in braces too.
fn names_after(code: &str, begin: &str) -> Vec<String> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let first = |text: &str| text.trim_start().chars().take_while(|&c| is_name(c)).collect::<String>();
    let mut names = Vec::new();
    for (at, _) in code.match_indices(begin) {
        if code[..at].ends_with(is_name) {
            continue;
        }
        let rest = &code[at + begin.len()..];
        match rest.strip_prefix('{') {
            Some(list) => names.extend(list.split('}').next().unwrap_or_default().split(',').map(first)),
            None => names.push(first(rest)),
        }
    }
    names
}

/// A way from a module back to itself, if there is one.
fn circle(imports: &BTreeMap<String, BTreeSet<String>>) -> Option<Vec<String>> {
    fn walk(
        imports: &BTreeMap<String, BTreeSet<String>>,
        way: &mut Vec<String>,
        done: &mut BTreeSet<String>,
    ) -> Option<Vec<String>> {
        let here = way.last()?.clone();
        for next in imports.get(&here).into_iter().flatten() {
            if let Some(begin) = way.iter().position(|module| module == next) {
                return Some(way[begin..].iter().chain([next]).cloned().collect());
            }
            if !done.contains(next) {
                way.push(next.clone());
                if let Some(found) = walk(imports, way, done) {
                    return Some(found);
                }
                way.pop();
            }
        }
        done.insert(here);
        None
    }
    let mut done = BTreeSet::new();
    imports.keys().find_map(|module| walk(imports, &mut vec![module.clone()], &mut done))
}

#[test]
fn no_modules_of_a_crate_name_each_other_in_a_circle() {
    let mut wrong = Vec::new();
    for (name, _) in LAYERS {
        let found = imports(&folder(name).join("src"));
        if let Some(way) = circle(&found) {
            wrong.push(format!("{name}: {}", way.join(" -> ")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The search can find: a circle of three is one.
#[test]
fn a_circle_is_found() {
    let imports = |pairs: &[(&str, &str)]| {
        let mut imports: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (from, to) in pairs {
            imports.entry((*from).to_owned()).or_default().insert((*to).to_owned());
        }
        imports
    };
    assert!(circle(&imports(&[("a", "b"), ("b", "c"), ("c", "a"), ("c", "d")])).is_some());
    assert!(circle(&imports(&[("a", "b"), ("b", "c"), ("a", "c"), ("c", "d")])).is_none());
    assert_eq!(names_after("use crate::{a::B, c}; x(crate::d::E)", "crate::"), ["a", "c", "d"]);
}

/// The files that ARCHITECTURE.md says an effect goes to are there, and the numbered ones are fewer than fifteen.
#[test]
fn an_effect_goes_to_files_that_are_there() {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let section = text.split("\n## ").find(|section| section.starts_with("Where an effect goes")).unwrap();
    let paths = |text: &str| -> BTreeSet<String> {
        let quoted = text.split('`').skip(1).step_by(2);
        quoted.filter(|word| word.contains('/')).map(str::to_owned).collect()
    };
    for path in paths(section) {
        assert!(root().join(&path).is_file(), "{path} is not there");
    }
    let is_numbered = |line: &&str| line.starts_with(|c: char| c.is_ascii_digit());
    let lines: Vec<&str> = section.lines().filter(is_numbered).collect();
    let listed = paths(&lines.join("\n"));
    assert!(listed.len() == lines.len() && (1..15).contains(&listed.len()), "{} files", listed.len());
    for path in &listed {
        let text = fs::read_to_string(root().join(path)).unwrap().to_lowercase();
        assert!(path.ends_with("goldens.rs") || text.contains("splash"), "{path} has nothing of splashes");
    }
}

/// Names at the root of a crate: modules and what it exports, without what only parity needs.
fn root_names(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut is_hidden = false;
    let mut rest = text;
    while let Some((line, after)) = rest.split_once('\n') {
        let mut statement = line.to_owned();
        rest = after;
        if line.starts_with("pub use") {
            while !statement.contains(';') {
                let Some((more, after)) = rest.split_once('\n') else { break };
                statement += more;
                rest = after;
            }
            let inside = statement.split_once('{').map_or_else(
                || statement.rsplit("::").next().unwrap_or_default(),
                |(_, inside)| inside.split('}').next().unwrap_or_default(),
            );
            let found = inside.split(',').map(|name| name.trim().trim_end_matches(';').to_owned());
            names.extend(found.filter(|name| !name.is_empty() && !is_hidden));
        } else if line.starts_with("pub ") && !is_hidden {
            let name = line.split([' ', '(', '<', ':', ';', '{']).nth(2).unwrap_or_default();
            names.push(name.to_owned());
        }
        is_hidden = line.contains("doc(hidden)") || is_hidden && line.starts_with("#[");
    }
    names
}

/// A reader of the documentation sees few names first.
#[test]
fn roots_have_few_names() {
    for name in ["downpour-render", "downpour-specimen", "downpour-trace"] {
        let names = root_names(&fs::read_to_string(folder(name).join("src/lib.rs")).unwrap());
        assert!((5..=60).contains(&names.len()), "{name}: {} names: {names:?}", names.len());
    }
    let text = "pub mod a;\nmod b;\n#[doc(hidden)]\npub mod c;\npub use a::{D,\n    E};\npub use a::F;\npub fn g() {}\n";
    assert_eq!(root_names(text), ["a", "D", "E", "F", "g"]);
}

/// What is hidden from the documentation of the renderer's crates is behind the feature `parity`.
#[test]
fn hidden_modules_are_behind_the_feature_parity() {
    for name in ["downpour-render", "downpour-specimen", "downpour-trace"] {
        for path in rust_files(&folder(name).join("src")).unwrap() {
            let text = fs::read_to_string(&path).unwrap();
            let lines: Vec<&str> = text.lines().map(str::trim).collect();
            for (k, pair) in lines.windows(2).enumerate() {
                if pair[0] == "#[doc(hidden)]" && pair[1].starts_with("pub mod") {
                    let before = k.checked_sub(1).and_then(|k| lines.get(k)).copied().unwrap_or_default();
                    assert_eq!(before, "#[cfg(feature = \"parity\")]", "{}: {}", path.display(), pair[1]);
                }
            }
        }
    }
}
