//! Test cases: diameters, views and sky maps.

use std::path::{Path, PathBuf};

use downpour_drop::DropShape;

use super::{Options, run, sky, write};

/// The picture is this much higher and wider than the drop.
const FRAME: f64 = 1.2;

/// Position of a camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) name: &'static str,
    pub(super) distance_m: f64,
    pub(super) yaw_deg: f64,
    pub(super) pitch_deg: f64,
}

/// Level, from above, and from below at a distance so short that the view differs from that from afar.
const VIEWS: [View; 3] = [
    View { name: "level", distance_m: 0.1, yaw_deg: 0.0, pitch_deg: 0.0 },
    View { name: "above", distance_m: 0.1, yaw_deg: 130.0, pitch_deg: 35.0 },
    View { name: "below-near", distance_m: 0.02, yaw_deg: 250.0, pitch_deg: -50.0 },
];

/// A sky map, and the name that its cases carry.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Map {
    pub(super) name: String,
    pub(super) file: PathBuf,
}

/// One picture to compare.
#[derive(Clone, Debug)]
pub(super) struct Case<'a> {
    pub(super) diameter_mm: f64,
    pub(super) view: View,
    pub(super) fov_deg: f64,
    pub(super) map: &'a Map,
}

impl Case<'_> {
    /// The name of its files.
    pub(super) fn name(&self) -> String {
        format!("{}-{}mm-{}", self.map.name, self.diameter_mm, self.view.name)
    }
}

/// The maps of the set, and the requested ones. The generated one is written under `folder`.
pub(super) fn maps(options: &Options, folder: &Path) -> Result<Vec<Map>, String> {
    let mut maps = Vec::new();
    if !options.only {
        maps.push(named(run::root().join("assets/skies/street_low_sun.hdr"))?);
        let made = folder.join("checkerboard.hdr");
        write(&made, &sky::checkerboard())?;
        maps.push(named(made)?);
    }
    for file in &options.maps {
        // Children run in the root of the workspace; the argument is relative to the caller's folder.
        let file = std::path::absolute(file).map_err(|error| format!("{}: {error}", file.display()))?;
        let map = named(file)?;
        if maps.iter().any(|other: &Map| other.name == map.name) {
            return Err(format!(
                "two sky maps are called {}; their files would overwrite each other",
                map.name
            ));
        }
        maps.push(map);
    }
    Ok(maps)
}

fn named(file: PathBuf) -> Result<Map, String> {
    if !file.is_file() {
        return Err(format!("no sky map {}", file.display()));
    }
    let name = file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(Map { name, file })
}

/// Every case of one diameter.
pub(super) fn cases<'a>(
    shape: &DropShape,
    diameter_mm: f64,
    maps: &'a [Map],
    options: &Options,
) -> Vec<Case<'a>> {
    let views = if options.quick { &VIEWS[..1] } else { &VIEWS[..] };
    let reach = shape.max_half_width().max(shape.extent_up()).max(shape.extent_down());
    let case = |map, &view: &View| {
        let fov_deg = (2.0 * FRAME * reach / view.distance_m).to_degrees();
        Case { diameter_mm, view, fov_deg, map }
    };
    maps.iter().flat_map(|map| views.iter().map(move |view| case(map, view))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_has_a_name_of_its_own() {
        let maps = ["a", "b"].map(|name| Map { name: name.to_owned(), file: PathBuf::new() });
        let options = crate::read::<Options>(&[]).expect("no arguments");
        let mut names = Vec::new();
        for &d in &options.diameters_mm() {
            let shape = DropShape::new(d * 1.0e-3).expect("in range");
            names.extend(cases(&shape, d, &maps, &options).iter().map(Case::name));
        }
        assert_eq!(names.len(), 4 * 3 * 2);
        assert!(names.contains(&"b-5mm-below-near".to_owned()), "{names:?}");
        names.sort();
        names.dedup();
        assert_eq!(names.len(), 4 * 3 * 2);
    }

    #[test]
    fn two_maps_of_one_name_are_refused() {
        let here = run::root().join("assets/skies/street_low_sun.hdr").display().to_string();
        let options = crate::read::<Options>(&["--only", "--map", &here, "--map", &here]).expect("right");
        let error = maps(&options, Path::new("unused")).expect_err("twice the same");
        assert!(error.contains("street_low_sun"), "{error}");
        let options = crate::read::<Options>(&["--only", "--map", "no such.hdr"]).expect("right");
        assert!(maps(&options, Path::new("unused")).expect_err("missing").starts_with("no sky map "));
    }
}
