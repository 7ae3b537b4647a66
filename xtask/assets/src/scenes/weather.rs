//! The weather files of the street: by day and by night, eleven looks.

use downpour_street::Street;

use super::water::{far, near, water};

/// A weather file on its way to disk.
pub(super) struct WeatherFile {
    pub(super) name: &'static str,
    pub(super) text: String,
}

const HEAD: &str = "# Written by `cargo xtask scenes`; where everything comes from: ../SOURCE.md.\n\n";
const SIZE: &str = "\n[output]\nsize = [800, 450]\n";
const DAY_SKY: &str = "\n[sky]\nzenith_color = [2300, 2450, 2650]\n";
const DUSK_SKY: &str = "\n[sky]\nzenith_color = [3.2, 4.1, 6.4]\n";
/// Clouds over a city that lights them from below.
const NIGHT_SKY: &str = "\n[sky]\nzenith_color = [0.036, 0.034, 0.033]\n";
/// Exposure at night, stops: black stays black, and lit windows keep their color.
const NIGHT_EV: f32 = -1.7;
/// The most hollows with a puddle.
const PUDDLES: usize = 12;
const STORM_SKY: &str = "\n[sky]\nzenith_color = [420, 470, 540]\n";
/// Near and strong flashes: by day the light of a common stroke hardly shows. The first one, of three strokes, is at 0.53 s.
const LIGHTNING: &str =
    "\n[lightning]\nper_minute = 20\nseed = 14\ndistance_m = [500, 1500]\nbrightness = 20\n";
/// Water that runs off awnings, ledges and leaves.
const DRIPS: &str = "\n[drips]\nenabled = true\n";
/// Mist of a cloudburst over road and cars.
const SPRAY: &str = "\n[spray]\nenabled = true\n";
/// A sun at 24 degrees, below the edge of the clouds and across the street: 127.5 klx exp(-0.21 / sin h) is 76 klx, and a veil of thin
/// cloud leaves 60.
const LOW_SUN: &str = "\n[sky]\nzenith_color = [900, 1000, 1180]\n\n[sun]\nazimuth_deg = 62\nelevation_deg = 24\n\
                       illuminance_lux = 60000\ncolor = [1, 0.84, 0.62]\n";

fn model(is_night: bool, more: &str) -> String {
    let night = if is_night { "_night" } else { "" };
    format!("model = [\n    {{ file = \"models/street{night}.gltf\" }},\n{more}]\n")
}

fn rain(rate_mm_h: u32) -> String {
    format!("\n[rain]\nrate_mm_h = {rate_mm_h}\nseed = 49\n")
}

fn camera(position: [f32; 3], target: [f32; 3], fov_deg: f32, exposure_ev: f32) -> String {
    format!(
        "\n[camera]\nposition_m = {position:?}\nlook_at_m = {target:?}\nfov_deg = {fov_deg}\nshutter_s = 0.0167\n\
         exposure_ev = {exposure_ev}\n"
    )
}

/// The view along the street from the pavement's edge.
fn along(exposure_ev: f32) -> String {
    camera([-1.2, 1.6, -6.0], [0.6, 2.5, -30.0], 50.0, exposure_ev)
}

/// A walk of 24 m at 1.2 m/s in the middle of the street.
fn walk(exposure_ev: f32) -> String {
    format!(
        "\n[camera]\n# Keys: time, s, and place, m.\nposition_m = [[0, [-1.2, 1.6, -6]], [10, [-0.9, 1.62, -18]], [20, [-0.5, 1.6, -30]]]\n\
         look_at_m = [[0, [0.6, 2.5, -30]], [10, [0.9, 2.3, -42]], [20, [0.2, 2.4, -54]]]\nfov_deg = 50\nshutter_s = 0.0167\n\
         exposure_ev = {exposure_ev}\n"
    )
}

/// Speed of the car that drives, m/s: 30 km/h.
const CAR_M_S: f32 = 8.33;
/// Its lane, and where it is at time 0 and at the last key.
const CAR_X_M: f32 = -0.95;
const CAR_Z_M: [f32; 2] = [-50.0, 12.0];
/// Half the distances of its wheels from each other.
const WHEELS_M: [f32; 2] = [0.765, 1.275];

/// The street at night, and a car that comes along it.
fn traffic(street: &Street) -> String {
    let [first, last] = CAR_Z_M;
    let steps = ((last - first) / 2.0) as usize;
    let keys = (0..=steps).map(|step| {
        let z = first + 2.0 * step as f32;
        let wheels = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
        let height =
            |(a, b): (f32, f32)| street.road_height_m(CAR_X_M + a * WHEELS_M[0], z + b * WHEELS_M[1]);
        let mean = wheels.map(height).iter().sum::<f32>() / 4.0;
        format!("[{:.3}, [{CAR_X_M}, {mean:.3}, {z}]]", (z - first) / CAR_M_S)
    });
    let keys: Vec<String> = keys.collect();
    let rows: Vec<String> = keys.chunks(4).map(|row| row.join(", ")).collect();
    let car = format!(
        "[[model]]\nfile = \"models/car_night.gltf\"\n# Its wheels turn as at 1 m/s.\nanimation_speed = {CAR_M_S}\n\
         # Keys: time, s, and place, m.\ntranslation_m = [\n    {},\n]\n",
        rows.join(",\n    ")
    );
    format!("[[model]]\nfile = \"models/street_night.gltf\"\n\n{car}")
}

/// Puddles in the hollows of the street beyond a place along it, the nearest first, and one painted on the pavement.
fn puddles(street: &Street, from_z: f32) -> String {
    let mut text = String::from("\n# The hollows of the model; the relief is that of even setts.\n");
    let ahead = street.hollows().iter().filter(|hollow| hollow.center_m[1] < from_z);
    for (seed, hollow) in ahead.take(PUDDLES).enumerate() {
        let ([x, z], [a, b]) = (hollow.center_m, hollow.radii_m.map(|radius| 2.8 * radius));
        text += &format!(
            "[[puddle]]\nposition_m = [{x:.2}, 0.05, {z:.2}]\nsize_m = [{a:.2}, {b:.2}]\nfill = 0.9\nrelief_mm = 1.2\n\
             seed = {seed}\ncell_mm = 25\n\n"
        );
    }
    text + "[[puddle]]\nposition_m = [4.4, 0.15, -24]\nsize_m = [1.3, 4]\nmask = \"pavement_puddle.png\"\ndepth_mm = 12\n"
}

/// Makes all of them.
pub(super) fn make(street: &Street) -> Vec<WeatherFile> {
    let file = |name, title: &str, model: String, rest: &[&str]| WeatherFile {
        name,
        text: format!("# {title}\n{HEAD}{model}{}", rest.concat()),
    };
    let night = model(true, "");
    // Before the camera of `along`, along the whole of a walk, and before a camera that looks toward z = 0.
    let ahead = water(street, &[near(-8.0, -32.0), far(-32.0, -82.0)]);
    let walked = water(street, &[near(-8.0, -32.0), near(-32.0, -54.0), far(-54.0, -82.0)]);
    let back = water(street, &[near(-28.0, -50.0), far(2.0, -28.0)]);
    vec![
        file(
            "day.toml",
            "An old street on an overcast day in heavy rain.",
            model(false, ""),
            &[&rain(60), DAY_SKY, &along(-0.2), SIZE, &ahead],
        ),
        file(
            "night.toml",
            "An old street at night in heavy rain: lanterns, lit windows, shops.",
            night.clone(),
            &[&rain(60), NIGHT_SKY, &along(NIGHT_EV), SIZE, &ahead],
        ),
        file(
            "walk.toml",
            "A walk through the street at night, 20 s, for clips: render --frames.",
            night.clone(),
            &[&rain(60), NIGHT_SKY, &walk(NIGHT_EV), SIZE, &walked],
        ),
        file(
            "walk_day.toml",
            "A walk through the street on an overcast day, 20 s, for clips: render --frames.",
            model(false, ""),
            &[&rain(60), DAY_SKY, &walk(-0.2), SIZE, &walked],
        ),
        file(
            "drive.toml",
            "A car that drives through the street at night, 7 s, for clips: render --frames.",
            traffic(street),
            &[
                &rain(40),
                SPRAY,
                NIGHT_SKY,
                &camera([-2.9, 1.5, -4.0], [-0.9, 1.15, -24.0], 50.0, NIGHT_EV),
                SIZE,
                // Hollows lie before its wheels.
                &ahead,
            ],
        ),
        file(
            "dusk.toml",
            "The street at dusk in rain: windows and lanterns are lit, the sky is still blue.",
            night.clone(),
            &[&rain(30), DRIPS, DUSK_SKY, &along(-1.3), SIZE, &ahead],
        ),
        file(
            "storm.toml",
            "The street in a storm: a dark sky, a cloudburst that a wind drives along it to its left, lightning.",
            model(false, ""),
            &[
                &rain(150),
                DRIPS,
                SPRAY,
                STORM_SKY,
                "\n[[wind]]\nuniform = { speed_m_s = 9, towards_deg = 97 }\n",
                LIGHTNING,
                &along(-0.9),
                SIZE,
                &ahead,
            ],
        ),
        file(
            "rain-shadow.toml",
            "Rain before a low sun below clouds: drops shine against houses in the shade.",
            model(false, ""),
            &[
                &rain(40),
                DRIPS,
                LOW_SUN,
                &camera([1.6, 1.5, -52.0], [-0.6, 2.6, -30.0], 45.0, -0.6),
                SIZE,
                &back,
            ],
        ),
        file(
            "puddles.toml",
            "The street at night: puddles in the hollows of the road, and one painted on the pavement.",
            night.clone(),
            &[
                &rain(25),
                DRIPS,
                NIGHT_SKY,
                &camera([-1.0, 1.15, -16.0], [0.4, 0.3, -27.0], 46.0, NIGHT_EV),
                SIZE,
                &puddles(street, -17.0),
            ],
        ),
        file(
            "window.toml",
            "The street at night out of a window: rain that a wind drives against it, the shadows of its drops on the sill.",
            model(
                true,
                "    # The window that the eye looks out of.\n    { file = \"models/window.gltf\", translation_m = [-5.0, 2.6, -22], \
                 rotation_deg = [0, -90, 0] },\n",
            ),
            &[
                &rain(25),
                NIGHT_SKY,
                &camera([-5.67, 2.82, -22.0], [-5.0, 2.62, -22.0], 58.0, NIGHT_EV),
                SIZE,
                "\n[glass]\ndistance_m = 0.6992\nsize_m = [1.16, 0.72]\ncell_mm = 1.2\nspeed_m_s = 4\nbefore_s = 40\n\
                 focus = \"glass\"\naperture_mm = 4\n",
            ],
        ),
        file(
            "windshield.toml",
            "The street at night through the windshield of a car: rain for a minute, a wiper with a worn part.",
            night,
            &[
                &rain(25),
                NIGHT_SKY,
                &camera([-0.3, 1.2, -5.0], [0.1, 1.6, -34.0], 42.0, NIGHT_EV),
                SIZE,
                "\n[glass]\ndistance_m = 0.34\ntilt_deg = 60\nsize_m = [0.5, 0.37]\ncell_mm = 0.85\nspeed_m_s = 8\n\
                 focus = \"glass\"\naperture_mm = 6\nbefore_s = 60.45\n[[glass.wiper]]\npivot_m = [0.25, 0.41]\nlength_m = 0.36\n\
                 from_deg = 10\nto_deg = 170\nperiod_s = 3\nworn = [{ from_m = 0.24, to_m = 0.249 }]\n",
            ],
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_scene::Budget;
    use downpour_street::StreetSettings;
    use downpour_weather::Weather;

    /// Vertical fields of view that show near rain as an eye sees it, degrees; on a picture of 16:9 that is 66 to 90 degrees across.
    const EYE_DEG: std::ops::RangeInclusive<f64> = 40.0..=60.0;

    #[test]
    fn every_file_is_a_weather_with_the_lens_of_an_eye() {
        let folder = tempfile::tempdir().expect("a folder");
        let street = Street::generate(&StreetSettings::default()).expect("a street");
        let files = make(&street);
        assert_eq!(files.len(), 11);
        std::fs::write(
            folder.path().join("pavement_puddle.png"),
            downpour_street::puddle_mask().expect("a mask"),
        )
        .expect("written");
        for file in files {
            let path = folder.path().join(file.name);
            std::fs::write(&path, &file.text).expect("written");
            let weather = Weather::read(&path, &mut Budget::default());
            let weather = weather.unwrap_or_else(|error| panic!("{error}"));
            assert!(!weather.models.is_empty(), "{}", file.name);
            let fov_deg = weather.camera.fov.map(f64::to_degrees);
            assert!(fov_deg.is_some_and(|deg| EYE_DEG.contains(&deg)), "{}: {fov_deg:?}", file.name);
        }
    }
}
