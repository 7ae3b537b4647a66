//! Whole scenes: the light of a picture of `downpour render`, without rain, compared with Mitsuba's path tracer.
//!
//! Aim: on surfaces, a mean luminance within 5 % and a mean FLIP of at most 0.10. The scenes are generated: a street of boxes, a shed
//! that is open on one side, an arcade, metal and glossy spheres on the ground, a courtyard, and the project's own street; under a low
//! sun, an overcast sky, and lamps at night. Mitsuba reads the same glTF file with a separate reader and has glTF's reflection model
//! (`truth/gltf_bsdf.py`), so that only the light differs.
//!
//! Two more, `wet-sign`, are of a sign that shines over ground that rain has made wet, porous and smooth, under a dim even sky. Theirs is
//! Mitsuba's rough interface of water over a diffuse base (`truth/wet.py`, with the film's alpha by our law and a base that is not fitted).
//! Aim, besides: height and width, at half the maximum and by second moments, of what the ground mirrors of the sign within 15 %. The
//! ground is red, the sky gray, and the sign has no green, so that in both pictures blue less green is that light.

mod models;
mod own_street;
mod skies;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use own_street::OwnStreet;

use super::mitsuba::Mitsuba;
use super::{Options, create, run, write};

/// Mean FLIP on surfaces.
const MAX_FLIP: f64 = 0.10;
/// Relative error of the mean luminance on surfaces.
const MAX_LUMINANCE: f64 = 0.05;
/// Columns and rows.
const SIZE: [u32; 2] = [480, 270];
/// Relative error of the height and the width of a sign's image in wet ground.
const MAX_EXTENT: f64 = 0.15;
/// Columns and rows of pictures of wet ground.
const WET_SIZE: [u32; 2] = [256, 256];
/// Samples of Mitsuba's pictures of it, at least: with fewer, half of the FLIP is their noise.
const WET_PATH_SAMPLES: u32 = 512;

/// A picture to compare.
#[derive(Clone, Debug)]
struct Scene {
    name: String,
    model: PathBuf,
    sky: PathBuf,
    /// Factor of the sky map.
    scale: f64,
    /// Point lamps: position in meters, intensity in the map's unit.
    lamps: Vec<([f64; 3], [f64; 3])>,
    eye: [f64; 3],
    at: [f64; 3],
    fov_deg: f64,
    /// True if the rain has made all of it wet.
    is_wet: bool,
}

/// Compares all scenes; returns the table, and the values above the aim.
pub(super) fn compare(
    options: &Options,
    program: &Path,
    folder: &Path,
    mitsuba: &Mitsuba,
) -> Result<(String, Vec<String>), String> {
    let folder = folder.join("scenes");
    create(&folder)?;
    let (mut rows, mut misses) = (Vec::new(), Vec::new());
    for scene in scenes(options, &folder)? {
        let values = scene.compare(options, program, &folder, mitsuba)?;
        let (row, above) = judge(&scene.name, scene.is_wet, &values)?;
        eprintln!("{row}");
        rows.push(row);
        misses.extend(above);
    }
    let [[width, height], [wet_width, wet_height]] = [SIZE, WET_SIZE];
    let rays = options.sky_rays.map_or(String::new(), |rays| format!(" --sky-rays {rays}"));
    let samples = options.scene_samples.map_or(String::new(), |samples| format!(" --samples {samples}"));
    let text = format!(
        "# Scenes and Mitsuba\n\n`downpour render --rate 0{rays}{samples}` at {width} x {height}, of wet ground at {wet_width} x \
         {wet_height}, against Mitsuba's path tracer, on \
         surfaces. `noise`: FLIP between two halves of Mitsuba's own samples. `mirrored`: our picture the wrong way round, which \
         has to be seen. `image`: what wet ground mirrors of a sign, its height and width (at half the \
         maximum or by second moments, what differs more) and its light.\n\n\
         | scene | surfaces | mean FLIP | luminance | noise | FLIP mirrored | image height | width | light |\n\
         |---|---|---|---|---|---|---|---|---|\n{}\n",
        rows.join("\n")
    );
    Ok((text, misses))
}

/// Row of the table, and the values above the aim.
fn judge(name: &str, is_wet: bool, values: &BTreeMap<String, f64>) -> Result<(String, Vec<String>), String> {
    let value = |key: &str| {
        values.get(key).copied().ok_or_else(|| format!("{name}: the comparison did not say \"{key}\""))
    };
    let (flip, luminance, mirrored) = (value("flip")?, value("luminance")?, value("mirrored")?);
    let mut row = format!(
        "| {name} | {:.2} | {flip:.4} | {:+.2} % | {:.4} | {mirrored:.4} |",
        value("share")?,
        100.0 * luminance,
        value("noise")?,
    );
    let image = if is_wet {
        let [height, width] = [value("image_height")?, value("image_width")?];
        let _ = write!(
            row,
            " {:+.1} % | {:+.1} % | {:+.1} % |",
            100.0 * height,
            100.0 * width,
            100.0 * value("image_light")?
        );
        Some([("image height", height), ("image width", width)])
    } else {
        row += " | | |";
        None
    };
    let mut misses = Vec::new();
    let mut check = |what: &str, found: f64, most: f64| {
        if found.is_nan() || found.abs() > most {
            misses.push(format!("{name}: {what} {found:.4}, allowed {most:.4}"));
        }
    };
    check("mean FLIP", flip, MAX_FLIP);
    check("luminance", luminance, MAX_LUMINANCE);
    for (what, found) in image.into_iter().flatten() {
        check(what, found, MAX_EXTENT);
    }
    if mirrored.is_nan() || mirrored <= MAX_FLIP {
        misses.push(format!("{name}: mirrored, mean FLIP is only {mirrored:.4}: this case cannot fail"));
    }
    Ok((row, misses))
}

/// All scenes of the set, their files written under a folder.
fn scenes(options: &Options, folder: &Path) -> Result<Vec<Scene>, String> {
    let mut skies = Vec::new();
    for (name, bytes, scale) in skies::all() {
        let file = folder.join(format!("{name}.hdr"));
        write(&file, &bytes)?;
        skies.push((name.to_owned(), file, scale));
    }
    for map in &options.maps {
        let file = std::path::absolute(map).map_err(|error| format!("{}: {error}", map.display()))?;
        let name = file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        skies.push((name, file, 1.0));
    }
    let fits = |sky: &str, of_night: bool, is_wet: bool| {
        let (is_night, is_even) = (sky == "night", sky == skies::EVEN);
        is_night == of_night
            && is_even == is_wet
            && (!options.quick || is_night || is_even || sky == "low-sun")
    };
    let mut found = Vec::new();
    for model in models::all() {
        let file = folder.join(format!("{}.gltf", model.name));
        model.write(&file)?;
        for (sky, map, scale) in &skies {
            if !fits(sky, model.of_night, model.is_wet) {
                continue;
            }
            found.push(Scene {
                name: format!("{}-{sky}", model.name),
                model: file.clone(),
                sky: map.clone(),
                scale: *scale,
                lamps: if model.of_night { model.lamps.clone() } else { Vec::new() },
                eye: model.eye,
                at: model.at,
                fov_deg: model.fov_deg,
                is_wet: model.is_wet,
            });
        }
    }
    // In a folder of its own: a model of boxes has the name of its buffer, too.
    let own = folder.join("own-street");
    for of_night in [false, true] {
        let street = OwnStreet::write(&own, of_night)?;
        for (sky, map, scale) in &skies {
            if !fits(sky, of_night, false) {
                continue;
            }
            found.push(Scene {
                name: format!("own-street-{sky}"),
                model: street.file.clone(),
                sky: map.clone(),
                scale: *scale,
                lamps: street.lamps.clone(),
                eye: own_street::EYE,
                at: own_street::AT,
                fov_deg: own_street::FOV_DEG,
                is_wet: false,
            });
        }
    }
    found.retain(|scene| options.scene.as_ref().is_none_or(|wanted| scene.name.contains(wanted)));
    Ok(found)
}

impl Scene {
    fn compare(
        &self,
        options: &Options,
        program: &Path,
        folder: &Path,
        mitsuba: &Mitsuba,
    ) -> Result<BTreeMap<String, f64>, String> {
        let weather = folder.join(format!("{}.toml", self.name));
        write(&weather, self.weather(folder)?.as_bytes())?;
        let ours = folder.join(format!("{}.ours.exr", self.name));
        let mut command = run::command(&program.display().to_string(), &["render", "--backend", "cpu"]);
        let status = command
            .args(["--quiet", "--overwrite", "--asset-root", "/"])
            .args(options.sky_rays.map(|rays| format!("--sky-rays={rays}")))
            .args(options.scene_samples.map(|samples| format!("--samples={samples}")))
            .arg(&weather)
            .arg("--output")
            .arg(&ours)
            .status()
            .map_err(|error| format!("{} did not start: {error}", program.display()))?;
        if !status.success() {
            return Err(format!("{}: downpour render failed ({status})", self.name));
        }
        let lamps: Vec<String> = self
            .lamps
            .iter()
            .map(|(position, color)| {
                position.iter().chain(color).map(f64::to_string).collect::<Vec<_>>().join(",")
            })
            .collect();
        let files = [
            ("scene", self.model.clone()),
            ("sky", self.sky.clone()),
            ("ours", ours),
            ("beside", folder.join(format!("{}.png", self.name))),
            ("reference", folder.join(format!("{}.mitsuba.exr", self.name))),
            ("lamps", PathBuf::from(lamps.join(";"))),
            ("bsdf", PathBuf::from(if self.is_wet { "wet" } else { "gltf" })),
        ];
        let [width, height] = self.size().map(f64::from);
        let mut values = vec![("fov", self.fov_deg), ("scale", self.scale)];
        values.extend([("width", width), ("height", height)]);
        let least = if self.is_wet { WET_PATH_SAMPLES } else { 1 };
        values.push(("path-samples", options.path_samples.max(least).into()));
        values.push(("keep", if options.keep { 1.0 } else { 0.0 }));
        for (names, position) in
            [(["eye-x", "eye-y", "eye-z"], self.eye), (["at-x", "at-y", "at-z"], self.at)]
        {
            values.extend(names.into_iter().zip(position));
        }
        mitsuba.values(&self.name, "scene.py", &files, &values)
    }

    /// Columns and rows.
    fn size(&self) -> [u32; 2] {
        if self.is_wet { WET_SIZE } else { SIZE }
    }

    /// The weather file: no rain, a lens that scatters nothing, as Mitsuba's, this sky, these lamps, this eye; and whether all is wet.
    fn weather(&self, folder: &Path) -> Result<String, String> {
        let relative = |file: &Path| {
            file.strip_prefix(folder)
                .unwrap_or(file)
                .to_str()
                .map(str::to_owned)
                .ok_or("a path that is no text")
        };
        let mut text = format!(
            "model = [{{ file = {:?} }}]\n[glow]\nglare = 0\n[rain]\nrate_mm_h = 0\n[sky]\nfile = {:?}\nintensity = {}\n[camera]\nposition_m = {:?}\n\
             look_at_m = {:?}\nfov_deg = {:?}\n[output]\nsize = {:?}\n",
            relative(&self.model)?,
            relative(&self.sky)?,
            self.scale,
            self.eye,
            self.at,
            self.fov_deg,
            self.size(),
        );
        if self.is_wet {
            text += "[wetness]\nwetness = 1\n";
        }
        for (position, color) in &self.lamps {
            let most = color.iter().copied().fold(0.0, f64::max);
            let tint = color.map(|c| c / most);
            let _ = writeln!(
                text,
                "[[light]]\npoint = {{ position_m = {position:?}, color = {tint:?}, intensity_cd = {most:?} }}"
            );
        }
        Ok(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_aim_can_be_missed() {
        let good = [("flip", 0.05), ("luminance", -0.01), ("noise", 0.01), ("mirrored", 0.4), ("share", 0.8)];
        let with = |key: &str, value: f64| -> BTreeMap<String, f64> {
            good.iter().map(|&(k, v)| (k.to_owned(), if k == key { value } else { v })).collect()
        };
        assert_eq!(judge("a", false, &with("none", 0.0)).expect("whole").1, Vec::<String>::new());
        for (key, bad) in [("flip", 0.11), ("luminance", 0.06), ("luminance", -0.06), ("mirrored", 0.05)] {
            assert_eq!(judge("a", false, &with(key, bad)).expect("whole").1.len(), 1, "{key}");
        }
        assert!(judge("a", false, &BTreeMap::new()).is_err());
        // Of wet ground the image of the sign is asked, too.
        assert!(judge("a", true, &with("none", 0.0)).is_err());
        let image = [("image_height", 0.1), ("image_width", -0.1), ("image_light", 0.5)];
        let wet = |key: &str, value: f64| {
            let mut values = with("none", 0.0);
            values.extend(image.map(|(k, v)| (k.to_owned(), if k == key { value } else { v })));
            values
        };
        assert_eq!(judge("a", true, &wet("none", 0.0)).expect("whole").1, Vec::<String>::new());
        for (key, bad) in [("image_height", 0.16), ("image_height", -0.16), ("image_width", f64::NAN)] {
            assert_eq!(judge("a", true, &wet(key, bad)).expect("whole").1.len(), 1, "{key}");
        }
    }
}
