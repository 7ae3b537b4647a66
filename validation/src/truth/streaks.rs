//! Streaks: the mean of a drop that falls and oscillates, compared with the mean of Mitsuba's pictures of its instants.
//!
//! Each instant is a mesh of `downpour_drop`, at a random time in its part of the exposure: 32 parts for each
//! diameter of fall, 64 at least. A streak of 1/60 s covers a pixel for 2 % of the time, and any wrong one would pass as
//! a picture; so the streak is compared alone as well, divided by the fraction of the time in which it covers a pixel. Its negative
//! control is the sky instead of it.
//!
//! Lamps are disks of some degrees, at infinity, before a uniform dusk: no ray of either renderer would hit a point. Their images
//! on a drop are glints of a thousandth of its area, and both sides need more samples for the same noise. They are not
//! visible directly.

use std::collections::BTreeMap;
use std::path::Path;

use downpour_drop::DropShape;
use downpour_drop::air::Air;
use downpour_drop::fall_speed::{FallSpeedModel, terminal_speed};
use downpour_drop::mesh::DropMesh;
use downpour_drop::oscillation::{Amplitudes, Fluids, FrequencyLaw, OscillatingDrop, Oscillation};
use downpour_math::rng::{rng_draw, rng_unit};

use super::cases::Map;
use super::mesh::{UNITS_PER_METER, moved_ply};
use super::mitsuba::Mitsuba;
use super::{Options, create, run, write};

const EXPOSURES: [(&str, f64); 2] = [("1-500", 1.0 / 500.0), ("1-60", 1.0 / 60.0)];
const DISTANCE_M: f64 = 0.4;
const PHASE: [f64; 2] = [0.1, 0.3];
/// Instants of the reference per diameter of fall, and at least.
const PER_DIAMETER: f64 = 32.0;
const MIN_INSTANTS: u32 = 64;
/// Instants of ours for each sample.
const OURS: u32 = 16;
/// Pixels of a diameter, in short and in long streaks.
const PIXELS: [f64; 2] = [24.0, 8.0];
const SUBDIVISIONS: u32 = 4;
const PATH_SAMPLES: u32 = 32;

const MAX_FLIP: f64 = 0.03;
const MAX_LUMINANCE: f64 = 0.02;

/// A lamp, as in `downpour specimen --light`: degrees.
#[derive(Clone, Copy, Debug)]
struct Lamp {
    name: &'static str,
    yaw_deg: f64,
    pitch_deg: f64,
    radius_deg: f64,
    radiance: [f64; 3],
}

/// Background of a streak.
#[derive(Clone, Copy, Debug)]
struct Before<'a> {
    map: &'a Map,
    lamp: Option<&'a Lamp>,
}

/// 20 degrees from the axis behind the drop, and beside it, where a drop is fainter. The irradiance of each is that of the
/// sky of dusk if it were 2 and 55 times as bright.
const LAMPS: [Lamp; 2] = [
    Lamp {
        name: "behind",
        yaw_deg: 163.0,
        pitch_deg: 10.6,
        radius_deg: 2.0,
        radiance: [250.0, 200.0, 130.0],
    },
    Lamp {
        name: "beside",
        yaw_deg: 95.0,
        pitch_deg: 12.0,
        radius_deg: 4.0,
        radiance: [1500.0, 1400.0, 1200.0],
    },
];
/// Our instants, and Mitsuba's samples, with a lamp.
const OURS_LIT: u32 = 512;
const PATH_SAMPLES_LIT: u32 = 512;

/// Compares all streaks; returns the table, and the values above the aim.
pub(super) fn compare(
    options: &Options,
    maps: &[Map],
    program: &Path,
    folder: &Path,
    mitsuba: &Mitsuba,
) -> Result<(String, Vec<String>), String> {
    let (mut rows, mut misses) = (Vec::new(), Vec::new());
    let (exposures, maps, lamps) = if options.quick {
        (&EXPOSURES[..1], &maps[..1], &LAMPS[..1])
    } else {
        (&EXPOSURES[..], maps, &LAMPS[..])
    };
    let dusk = Map { name: "lamp".to_owned(), file: folder.join("dusk.hdr") };
    write(&dusk.file, &super::sky::dusk())?;
    for &diameter_mm in &options.diameters_mm() {
        for (&exposure, pixels) in exposures.iter().zip(PIXELS) {
            let streak = Streak::new(diameter_mm, exposure, pixels)?;
            let meshes = folder.join("instants");
            streak.write_meshes(&meshes)?;
            let lit = lamps.iter().map(|lamp| Before { map: &dusk, lamp: Some(lamp) });
            for before in maps.iter().map(|map| Before { map, lamp: None }).chain(lit) {
                let of_lamp = before.lamp.map_or_else(String::new, |lamp| format!("-{}", lamp.name));
                let name = format!("{}{of_lamp}-{diameter_mm}mm-streak-{}", before.map.name, exposure.0);
                let values = streak.compare(&name, before, program, folder, &meshes, mitsuba)?;
                let (row, above) = judge(&name, &values)?;
                eprintln!("{row}");
                rows.push(row);
                misses.extend(above);
            }
            std::fs::remove_dir_all(&meshes).map_err(|error| format!("{}: {error}", meshes.display()))?;
        }
    }
    let text = format!(
        "# Streaks and Mitsuba\n\n`downpour specimen --exposure S --oscillation 0.2,0.1 --samples {OURS}` against the mean of instants by \
         Mitsuba's path tracer (`scalar_rgb`, {PATH_SAMPLES} samples per pixel each; with a lamp {OURS_LIT} and {PATH_SAMPLES_LIT}). `alone`: the streak divided by the fraction of the \
         exposure in which it covers a pixel; `absent`: the sky instead of it.\n\n\
         | streak | instants | cover | mean FLIP | luminance | FLIP alone | luminance alone | FLIP absent | sky outside |\n\
         |---|---|---|---|---|---|---|---|---|\n{}\n",
        rows.join("\n")
    );
    Ok((text, misses))
}

/// Row of the table, and the values above the aim.
fn judge(name: &str, values: &BTreeMap<String, f64>) -> Result<(String, Vec<String>), String> {
    let value = |key: &str| {
        values.get(key).copied().ok_or_else(|| format!("{name}: the comparison did not say \"{key}\""))
    };
    let row = format!(
        "| {name} | {} | {:.3} | {:.4} | {:+.3} % | {:.4} | {:+.3} % | {:.4} | {:.3} % |",
        value("instants")?,
        value("cover")?,
        value("flip")?,
        100.0 * value("luminance")?,
        value("alone_flip")?,
        100.0 * value("alone")?,
        value("absent")?,
        100.0 * value("sky")?,
    );
    let mut misses = Vec::new();
    for (key, most) in
        [("flip", MAX_FLIP), ("luminance", MAX_LUMINANCE), ("alone", MAX_LUMINANCE), ("sky", MAX_FLIP)]
    {
        let found = value(key)?;
        if found.is_nan() || found.abs() > most {
            misses.push(format!("{name}: {key} {found:.4}, allowed {most:.4}"));
        }
    }
    let (alone, absent) = (value("alone_flip")?, value("absent")?);
    if alone.is_nan() || absent.is_nan() || alone > 0.5 * absent {
        misses
            .push(format!("{name}: FLIP alone {alone:.4}, not half of the {absent:.4} of no streak at all"));
    }
    Ok((row, misses))
}

struct Streak {
    diameter_mm: f64,
    exposure_s: f64,
    drop: OscillatingDrop,
    speed: f64,
    instants: u32,
    fov_deg: f64,
    reach_m: f64,
    size: [u32; 2],
}

impl Streak {
    fn new(diameter_mm: f64, (_, exposure_s): (&str, f64), pixels: f64) -> Result<Self, String> {
        let to_error = |error: downpour_drop::DropError| error.to_string();
        let diameter = diameter_mm * 1.0e-3;
        let shape = DropShape::new(diameter).map_err(to_error)?;
        let law = FrequencyLaw::default();
        let oscillation = Oscillation::new(diameter, Amplitudes::GARG_NAYAR_OBLATE, &Fluids::AT_20_C, law)
            .map_err(to_error)?
            .with_phases(PHASE);
        let speed =
            terminal_speed(FallSpeedModel::Beard1976, diameter, &Air::standard()).map_err(to_error)?;
        let fall = speed * exposure_s;
        let high = fall + 2.0 * diameter;
        let height = (high / diameter * pixels).ceil();
        Ok(Self {
            diameter_mm,
            exposure_s,
            drop: OscillatingDrop::new(shape, oscillation),
            speed,
            instants: ((fall / diameter * PER_DIAMETER).ceil() as u32).max(MIN_INSTANTS),
            fov_deg: (2.0 * downpour_math::ops::f64::atan(0.5 * high / DISTANCE_M)).to_degrees(),
            reach_m: diameter,
            size: [(2.0 * pixels) as u32, height as u32],
        })
    }

    /// A mesh for each instant, at the drop's position then.
    fn write_meshes(&self, folder: &Path) -> Result<(), String> {
        if folder.exists() {
            std::fs::remove_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        }
        create(folder)?;
        for i in 0..self.instants {
            let offset = f64::from(rng_unit(rng_draw([1, 2], i, 0, 0)[0]));
            let seconds = self.exposure_s * ((f64::from(i) + offset) / f64::from(self.instants) - 0.5);
            let mesh = DropMesh::icosphere(&self.drop.at(seconds, 0.0), SUBDIVISIONS)
                .map_err(|error| error.to_string())?;
            write(&folder.join(format!("{i:05}.ply")), &moved_ply(&mesh, -self.speed * seconds))?;
        }
        Ok(())
    }

    fn compare(
        &self,
        name: &str,
        Before { map, lamp }: Before<'_>,
        program: &Path,
        folder: &Path,
        meshes: &Path,
        mitsuba: &Mitsuba,
    ) -> Result<BTreeMap<String, f64>, String> {
        let ours = folder.join(format!("{name}.ours.exr"));
        let [width, height] = self.size;
        let (instants, path_samples) =
            if lamp.is_some() { (OURS_LIT, PATH_SAMPLES_LIT) } else { (OURS, PATH_SAMPLES) };
        let light = lamp.map(|lamp| {
            let [r, g, b] = lamp.radiance;
            format!("{},{},{},{r},{g},{b}", lamp.yaw_deg, lamp.pitch_deg, lamp.radius_deg)
        });
        let status =
            run::command(&program.display().to_string(), &["specimen", "--backend", "cpu", "--quiet"])
                .args(["--overwrite", "--diameter", &self.diameter_mm.to_string()])
                .args(["--distance", &DISTANCE_M.to_string(), "--fov", &self.fov_deg.to_string()])
                .args([
                    "--exposure",
                    &self.exposure_s.to_string(),
                    "--samples",
                    &instants.to_string(),
                    "--oscillation",
                    "0.2,0.1",
                ])
                .args(["--phase", &format!("{},{}", PHASE[0], PHASE[1])])
                .args(["--size", &format!("{width}x{height}"), "--environment"])
                .arg(&map.file)
                .args(light.iter().flat_map(|light| ["--light", light]))
                .arg("--output")
                .arg(&ours)
                .status()
                .map_err(|error| format!("{} did not start: {error}", program.display()))?;
        if !status.success() {
            return Err(format!("{name}: downpour specimen failed ({status})"));
        }
        let files = [
            ("ours", ours),
            ("meshes", meshes.to_owned()),
            ("sky", map.file.clone()),
            ("beside", folder.join(format!("{name}.png"))),
            ("reference", folder.join(format!("{name}.mitsuba.exr"))),
        ];
        let mut values = vec![
            ("index", downpour_drop::optics::WATER_INDEX),
            ("distance", DISTANCE_M * UNITS_PER_METER),
            ("reach", self.reach_m * UNITS_PER_METER),
            ("fov", self.fov_deg),
            ("width", width.into()),
            ("height", height.into()),
            ("path-samples", path_samples.into()),
        ];
        if let Some(lamp) = lamp {
            let [red, green, blue] = lamp.radiance;
            values.extend([("lamp-yaw", lamp.yaw_deg), ("lamp-pitch", lamp.pitch_deg)]);
            values.extend([("lamp-radius", lamp.radius_deg), ("lamp-red", red)]);
            values.extend([("lamp-green", green), ("lamp-blue", blue)]);
        }
        mitsuba.values(name, "streak.py", &files, &values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_aim_can_be_missed() {
        let good = [
            ("instants", 64.0),
            ("cover", 0.1),
            ("flip", 0.01),
            ("luminance", 0.001),
            ("alone_flip", 0.03),
            ("alone", -0.01),
            ("absent", 0.3),
            ("sky", 0.001),
        ];
        let with = |key: &str, value: f64| -> BTreeMap<String, f64> {
            good.iter().map(|&(k, v)| (k.to_owned(), if k == key { value } else { v })).collect()
        };
        assert_eq!(judge("a", &with("none", 0.0)).expect("whole").1, Vec::<String>::new());
        for (key, bad) in [
            ("flip", 0.031),
            ("luminance", -0.021),
            ("alone", 0.021),
            ("sky", 0.5),
            ("absent", 0.05),
            ("alone_flip", f64::NAN),
        ] {
            assert_eq!(judge("a", &with(key, bad)).expect("whole").1.len(), 1, "{key}");
        }
        assert!(judge("a", &BTreeMap::new()).is_err());
    }
}
