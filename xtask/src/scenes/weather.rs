//! The weather files of the street: one list of models, five looks.

use super::ground::{HALF_ROAD_M, ZEBRA_M, pavement_height, road_height};

/// A weather file on its way to disk.
pub(super) struct WeatherFile {
    pub(super) name: &'static str,
    pub(super) text: String,
}

/// Distance of posts from the middle of the street.
const POSTS_M: f32 = HALF_ROAD_M + 0.5;
/// Lamps: side and z.
const LAMPS: [[f32; 2]; 6] =
    [[1.0, 13.0], [-1.0, 3.5], [1.0, -7.5], [-1.0, -18.0], [1.0, -28.5], [-1.0, -39.0]];
/// Parked cars: paint, x, z, turn in degrees.
const PARKED: [(&str, f32, f32, f32); 4] = [
    ("blue", 2.32, -3.6, 180.0),
    ("white", 2.30, -20.4, 180.0),
    ("red", -2.32, -26.5, 0.0),
    ("silver", 2.28, -34.6, 181.0),
];
/// The car that comes up the street: x, z.
const DRIVING: [f32; 2] = [-1.45, -20.5];

/// The list of models, by day or by night.
fn models(is_night: bool, more: &str) -> String {
    let night = if is_night { "_night" } else { "" };
    let mut text = String::from("model = [\n    # Ground and houses.\n");
    let mut line = |file: &str, x: f32, y: f32, z: f32, turn: f32, rest: &str| {
        let turn = if turn == 0.0 { String::new() } else { format!(", rotation_deg = [0, {turn}, 0]") };
        let at = if [x, y, z] == [0.0; 3] {
            String::new()
        } else {
            format!(", translation_m = [{x}, {y:.3}, {z}]")
        };
        text.push_str(&format!("    {{ file = \"models/{file}.gltf\"{at}{turn}{rest} }},\n"));
    };
    line(&format!("street{night}"), 0.0, 0.0, 0.0, 0.0, "");
    let curb = pavement_height(POSTS_M);
    for [side, z] in LAMPS {
        line(&format!("lamp{night}"), side * POSTS_M, curb, z, if side > 0.0 { 180.0 } else { 0.0 }, "");
    }
    for (paint, x, z, turn) in PARKED {
        line(&format!("car_{paint}"), x, road_height(x, z).max(0.0), z, turn, "");
    }
    let [x, z] = DRIVING;
    line(&format!("car_silver{night}"), x, road_height(x, z), z, 0.0, "");
    line("tree", -4.3, pavement_height(4.3), -3.0, 0.0, "");
    line("tree", 4.35, pavement_height(4.35), -25.0, 130.0, "");
    line("bench", -5.45, pavement_height(5.45), 1.0, 90.0, "");
    for side in [-1.0, 1.0] {
        let far = ZEBRA_M[1] + 0.35;
        let rest = format!(", repeat = {{ count = [1, 1, 2], step_m = [0, 0, {}] }}", -2.0 * far);
        line("bollard", side * (HALF_ROAD_M + 0.42), curb, ZEBRA_M[0] + far, 0.0, &rest);
    }
    line("bin_and_sign", 4.15, pavement_height(4.15), 0.5, 0.0, "");
    text.push_str(more);
    text.push_str("]\n");
    text
}

const DAY_SKY: &str = "\n[sky]\nzenith_color = [2300, 2450, 2650]\n";
const NIGHT_SKY: &str = "\n[sky]\nzenith_color = [0.06, 0.065, 0.085]\n";

/// The view along the street, from the right lane.
fn along(exposure_ev: f32) -> String {
    format!(
        "\n[camera]\nposition_m = [0.9, 1.6, 9]\nlook_at_m = [-0.4, 2.4, -20]\nfov_deg = 46\nshutter_s = 0.0167\n\
         exposure_ev = {exposure_ev}\n"
    )
}

fn rain(rate_mm_h: u32) -> String {
    format!("\n[rain]\nrate_mm_h = {rate_mm_h}\nseed = 49\n")
}

const SIZE: &str = "\n[output]\nsize = [800, 450]\n";

const HEAD: &str = "# Written by `cargo xtask scenes`; where everything comes from: ../SOURCE.md.\n\n";

/// The street without rain, with a camera and perhaps another sky.
pub(super) fn dry(is_night: bool, sky: Option<&str>, camera: &str, [width, height]: [usize; 2]) -> String {
    let sky = sky.unwrap_or(if is_night { NIGHT_SKY } else { DAY_SKY });
    format!(
        "{}{}{sky}\n[camera]\n{camera}\n[output]\nsize = [{width}, {height}]\n",
        models(is_night, ""),
        rain(0)
    )
}

/// Makes all five.
pub(super) fn make() -> Vec<WeatherFile> {
    let file = |name, title: &str, models: String, rest: &[&str]| WeatherFile {
        name,
        text: format!("# {title}\n{HEAD}{models}{}", rest.concat()),
    };
    let night = models(true, "");
    vec![
        file(
            "day.toml",
            "A street on an overcast day in heavy rain.",
            models(false, ""),
            &[&rain(100), DAY_SKY, &along(-0.3), SIZE],
        ),
        file(
            "night.toml",
            "A street at night in heavy rain: six lamps, lit windows, two shops, a car that comes up the street.",
            night.clone(),
            &[&rain(100), NIGHT_SKY, &along(-1.8), SIZE],
        ),
        file(
            "puddles.toml",
            "The street at night: puddles in the hollows of the road and along the curbs, and one painted on the pavement.",
            night.clone(),
            &[
                &rain(25),
                NIGHT_SKY,
                "\n[camera]\nposition_m = [0.9, 1.15, 4.2]\nlook_at_m = [-0.5, 0.35, -6]\nfov_deg = 44\nshutter_s = 0.0167\n\
                 exposure_ev = -1.8\n",
                SIZE,
                "\n# The road model has hollows; the relief is that of a road of ISO 8608 class B.\n[[puddle]]\n\
                 position_m = [0, 0.05, -9]\nsize_m = [6.7, 26]\nfill = 0.9\nseed = 3\ncell_mm = 30\n\
                 \n[[puddle]]\nposition_m = [4.9, 0.15, -1.6]\nsize_m = [1.3, 4]\nmask = \"pavement_puddle.png\"\ndepth_mm = 12\n",
            ],
        ),
        file(
            "window.toml",
            "The street at night out of a window: rain that a wind drives against it, the shadows of its drops on the sill.",
            models(
                true,
                "    # The window that the eye looks out of.\n    { file = \"models/window.gltf\", translation_m = [-5.2, 2.2, -16.7], \
                 rotation_deg = [0, -90, 0] },\n",
            ),
            &[
                &rain(25),
                NIGHT_SKY,
                "\n[camera]\nposition_m = [-5.87, 2.42, -16.7]\nlook_at_m = [-5.2, 2.22, -16.7]\nfov_deg = 58\nshutter_s = 0.0167\n\
                 exposure_ev = -1.8\n",
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
                "\n[camera]\nposition_m = [1.2, 1.2, 9]\nlook_at_m = [-0.2, 1.5, -20]\nfov_deg = 40\nshutter_s = 0.0167\n\
                 exposure_ev = -1.8\n",
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
    use downpour_weather::Weather;

    #[test]
    fn every_file_is_a_weather() {
        let folder = tempfile::tempdir().expect("a folder");
        for file in make() {
            let path = folder.path().join(file.name);
            std::fs::write(&path, &file.text).expect("written");
            let weather = Weather::read(&path, &mut Budget::default());
            let weather = weather.unwrap_or_else(|error| panic!("{error}"));
            assert!(weather.models.len() > 15, "{}", file.name);
        }
    }
}
