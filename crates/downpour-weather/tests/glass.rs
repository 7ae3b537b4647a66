//! The pane of a weather file: every key, and rejected values.

#[path = "../../downpour-scene/tests/exit_code/mod.rs"]
mod exit_code;
use downpour_lattice::glass::{GlassTexture, GlassWiperMotion, GlassWornBand};
use downpour_weather::{PaneFocus, PaneFresnel, PaneShadow, Weather};
use exit_code::ExitCode as _;

const ALL: &str = r#"
[rain]
rate_mm_h = 25
seed = 9
[glass]
distance_m = 0.7
tilt_deg = 30
size_m = [1.2, 0.6]
cell_mm = 0.5
speed_m_s = [[0, 10], [20, 30]]
before_s = 12
focus = "glass"
aperture_mm = 8
interior_ambient = 0.2
fresnel = "tatarchuk-2006"
highlight_mm = 2.5
shadows = "tatarchuk-2006"
advancing_deg = 70
receding_deg = 30
film_um = 20
drying_mm_h = 0.5
affinity_pull = 2
wet_s = 5
wet_ease = 0.2
wet_pull = 3
trail_mm = 4
bead_mm = 0.3
[[glass.wiper]]
pivot_m = [0.6, 0.62]
length_m = 0.55
from_deg = 10
to_deg = 170
period_s = 1.4
worn = [{ from_m = 0.2, to_m = 0.22, leaves = 0.7 }]
film_um = 3
[[glass.wiper]]
pivot_m = [0.1, 0.62]
length_m = 0.4
inner_m = 0.1
is_drawn = false
angle_deg = [[-2, 0], [0, 90], [3, 0]]
"#;

fn says(text: &str, code: u8, message: &str) {
    let error = Weather::parse("w.toml", text).expect_err(text);
    assert_eq!((error.exit_code(), error.to_string()), (code, format!("w.toml: {message}")));
}

#[test]
fn every_key_arrives() {
    let pane = Weather::parse("w.toml", ALL).unwrap().glass.unwrap();
    assert_eq!((pane.distance, pane.size, pane.cell), (0.7, Some([1.2, 0.6]), 0.5e-3));
    assert_eq!((pane.focus, pane.fresnel, pane.seed), (PaneFocus::Glass, PaneFresnel::Tatarchuk2006, 9));
    assert_eq!(
        (pane.before, pane.aperture, pane.interior_ambient, pane.film),
        (12.0, 8.0e-3, 0.2, 20.0 * 1.0e-6)
    );
    assert_eq!((pane.highlight, pane.shadows), (2.5e-3, PaneShadow::Tatarchuk2006));
    assert_eq!((pane.speed.as_ref().unwrap().at(10.0), pane.drying_mm_h), (20.0, 0.5));
    assert!((pane.tilt.to_degrees() - 30.0).abs() < 1.0e-9);
    assert!((pane.contact.advancing_rad.to_degrees() - 70.0).abs() < 1.0e-9);
    let [one, two] = &pane.wipers[..] else { panic!("{} wipers", pane.wipers.len()) };
    assert!(matches!(one.motion, GlassWiperMotion::Sweep { period_s: 1.4, .. }));
    assert_eq!(one.worn, [GlassWornBand { from_m: 0.2, to_m: 0.22, leaves: 0.7 }]);
    assert_eq!((one.film_m, two.film_m), (3.0 * 1.0e-6, 0.2 * 1.0e-6));
    assert_eq!((one.outer_m, two.inner_m), (0.55, 0.1));
    assert_eq!(pane.wipers_drawn, [true, false]);
    let (wet, trail) = (pane.wetting, pane.trail);
    assert_eq!((pane.affinity_pull, wet.life_s, wet.ease, wet.pull), (2.0, 5.0, 0.2, 3.0));
    assert_eq!((trail.spacing_m, trail.bead_m), (4.0 * 1.0e-3, 0.3 * 1.0e-3));
    // The lattice's time starts 12 s earlier: at its 12 s the keyed blade is vertical.
    let weather = Weather::parse("w.toml", ALL).unwrap();
    let options = pane.options([1.2, 0.6], &weather.rain, -12.0);
    // Water runs in from 0.15 m above the visible part.
    assert_eq!(options.size, [2400, 1500]);
    assert!((options.wipers[1].angle(12.0).to_degrees() - 90.0).abs() < 1.0e-9);
    // The tick is made for the fastest air; along the pane flows its parallel part.
    assert_eq!(options.rain.towards_m_s, 30.0);
    assert!((options.air.speed_m_s - 30.0 * 0.75f64.sqrt()).abs() < 1.0e-9);
    options.check().unwrap();
}

#[test]
fn a_pane_of_its_own_size_needs_nothing() {
    assert!(Weather::parse("w.toml", "").unwrap().glass.is_none());
    let pane = Weather::parse("w.toml", "[glass]\n").unwrap().glass.unwrap();
    assert_eq!((pane.size, pane.before, pane.focus), (None, 60.0, PaneFocus::Scene));
    assert_eq!(pane.tilt.to_degrees(), 90.0);
}

#[test]
fn what_cannot_be_is_refused_with_its_key() {
    says("[glass]\ntilt_deg = 5\n", 2, "line 2, column 12: glass.tilt_deg: 5; allowed: 10 to 90 degrees");
    says(
        "[glass]\nfocus = \"lens\"\n",
        2,
        "line 2, column 9: glass.focus: unknown word \"lens\"; allowed: scene, glass",
    );
    says(
        "[glass]\nadvancing_deg = 40\nreceding_deg = 50\n",
        2,
        "line 3, column 1: glass.receding_deg: 50.0000 with an advancing angle of 40.0000; allowed: 0 to the advancing \
         angle",
    );
    says(
        "[glass]\nsize_m = [5, 1]\n",
        3,
        "line 2, column 1: glass.size_m: 8333 x 1667 cells of 0.6 mm; allowed: 8 to 4096 along each edge: another size_m or \
         cell_mm",
    );
    says(
        "[glass]\n[[glass.wiper]]\npivot_m = [0, 0]\nlength_m = 0.3\nangle_deg = 3\n",
        2,
        "line 2, column 9: glass.wiper: without glass.size_m; allowed: with size_m = [width, height], in which wipers \
         are positioned",
    );
    let wiper = |keys: &str| format!("[glass]\nsize_m = [1, 0.5]\n[[glass.wiper]]\n{keys}\n");
    says(
        &wiper("pivot_m = [0.5, 0.9]\nlength_m = 0.3\nfrom_deg = 0\nto_deg = 90\nperiod_s = 2"),
        2,
        "line 4, column 1: glass.wiper[0].pivot_m: (0.5, 0.9): the blade never touches the pane of 1 x 0.5 m; allowed: \
         a position from which the blade reaches the pane",
    );
    says(
        &wiper("pivot_m = [0.5, 0.5]\nlength_m = 0.3\nfrom_deg = 0"),
        2,
        "line 3, column 1: glass.wiper[0]: no movement; allowed: from_deg, to_deg and period_s, or angle_deg with keys",
    );
    says(
        &wiper("pivot_m = [0.5, 0.5]\nlength_m = 0.3\nfrom_deg = -200\nto_deg = 200\nperiod_s = 0.1"),
        2,
        "line 3, column 1: glass.wiper[0]: speed of a blade 219.3245 rad/s; allowed: 0 to 20",
    );
    let told = |text: &str| Weather::parse("w.toml", text).expect_err(text).to_string();
    let drawn = "pivot_m = [0.5, 0.5]\nlength_m = 0.3\nangle_deg = 1\nis_drawn = ";
    assert!(told(&wiper(&format!("{drawn}1"))).contains("glass.wiper[0].is_drawn"));
    let many = |is_drawn: &str| {
        wiper(&format!("{drawn}{is_drawn}")) + &format!("[[glass.wiper]]\n{drawn}true\n").repeat(8)
    };
    assert!(told(&many("true")).contains("glass.wiper: 9 that are drawn; allowed: at most 8"));
    assert!(Weather::parse("w.toml", &many("false")).is_ok());
    says(
        &wiper("pivot_m = [0.5, 0.5]\nangle_deg = 1"),
        2,
        "line 3, column 1: glass.wiper[0]: no length_m; allowed: length_m is needed",
    );
}

/// An eye that moves at 10 m/s into a wind of 4 m/s meets the rain at 14 m/s, with the wind behind it at 6 m/s, and a wind from the side adds
/// nothing; a window in a wind gets its part along the window's normal; from behind no rain comes. The key overrides all.
#[test]
fn the_rain_meets_a_pane_at_the_speed_of_eye_and_wind() {
    let speed = |text: &str, time_s: f64| {
        let weather = Weather::parse("w.toml", text).unwrap();
        weather.pane_speed(time_s, 0.0, glam::DVec3::NEG_Z)
    };
    let drive =
        "[camera]\nposition_m = [[0, [0, 1.5, 0]], [10, [0, 1.5, -100]]]\nlook_at_m = [0, 1.5, -1000]\n";
    let still = "[camera]\nposition_m = [0, 1.5, 0]\n";
    let wind =
        |x: f64, z: f64| format!("[[wind]]\nuniform = {{ speed_m_s = 4, direction = [{x}, 0, {z}] }}\n");
    let near = |text: String, time_s: f64, expected: f64| {
        let found = speed(&text, time_s);
        assert!((found - expected).abs() < 1.0e-3, "{text}at {time_s} s: {found}, not {expected}");
    };
    near(format!("{drive}[glass]\n"), 5.0, 10.0);
    // Before the first picture as at it; at the end of its path the eye stands.
    near(format!("{drive}[glass]\n"), -30.0, 10.0);
    near(format!("{drive}[glass]\n"), 11.0, 0.0);
    near(format!("{drive}{}[glass]\n", wind(0.0, 1.0)), 5.0, 14.0);
    near(format!("{drive}{}[glass]\n", wind(0.0, -1.0)), 5.0, 6.0);
    near(format!("{drive}{}[glass]\n", wind(1.0, 0.0)), 5.0, 10.0);
    near(format!("{still}{}[glass]\n", wind(0.0, 1.0)), 0.0, 4.0);
    near(format!("{still}{}[glass]\n", wind(3.0, 4.0)), 0.0, 3.2);
    near(format!("{still}{}[glass]\n", wind(0.0, -1.0)), 0.0, 0.0);
    near(format!("{drive}{}[glass]\nspeed_m_s = 7\n", wind(0.0, 1.0)), 5.0, 7.0);
    near(format!("{still}[glass]\n"), 0.0, 3.0);
}

/// A pane of 16 x 8 cells, with 8 rows above it.
const MAPPED: &str = r#"
[glass]
size_m = [0.032, 0.016]
cell_mm = 2
above_m = 0.016
affinity = "affinity.png"
friction_map = "friction.png"
obstacles = "obstacles.png"
"#;

/// Writes a gray picture.
fn write(folder: &std::path::Path, name: &str, size: [u32; 2], gray: impl Fn(u32, u32) -> u8) {
    let picture = image::GrayImage::from_fn(size[0], size[1], |x, y| image::Luma([gray(x, y)]));
    picture.save(folder.join(name)).expect("a picture");
}

#[test]
fn pictures_of_the_glass_reach_the_lattice() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    write(at, "affinity.png", [16, 8], |x, _| x as u8 * 17);
    write(at, "friction.png", [1, 2], |_, y| if y == 0 { 0 } else { 255 });
    write(at, "obstacles.png", [16, 8], |x, y| if x == 3 && y == 4 { 255 } else { 0 });
    let file = at.join("w.toml");
    std::fs::write(&file, MAPPED).expect("a file");
    let mut budget = downpour_scene::Budget::default();
    let weather = Weather::read(&file, &mut budget).expect("a weather");
    let roots = downpour_weather::Roots::open(&file, &[]).expect("a folder");
    downpour_weather::load(&weather, &roots, &mut budget).expect("its files");
    let options = weather.glass.as_ref().unwrap().options([0.032, 0.016], &weather.rain, 0.0);
    assert_eq!(options.size, [16, 16]);
    let GlassTexture::Given(affinity) = &options.affinity else { panic!("{:?}", options.affinity) };
    // A column of the picture is a column of cells, from black to white, above the picture too.
    assert_eq!((affinity[0], affinity[15], affinity[16 * 12 + 15]), (0.0, 1.0, 1.0));
    assert!((affinity[16 * 12 + 5] - 5.0 / 15.0).abs() < 1.0e-6);
    let GlassTexture::Given(friction) = &options.friction else { panic!("{:?}", options.friction) };
    assert_eq!((friction[0], friction[16 * 8], friction[16 * 15]), (0.0, 0.0, 1.99));
    let obstacles = options.obstacles.as_ref().unwrap();
    assert_eq!(obstacles.iter().filter(|is| **is).count(), 1);
    assert!(obstacles[16 * 12 + 3], "row 4 of what is seen");
    assert!(options.check().is_ok());

    // Not there, no picture, too large, outside of the folder.
    let fails = |name: &str| {
        let weather = Weather::read(&file, &mut downpour_scene::Budget::default()).expect("a weather");
        let error = downpour_weather::load(&weather, &roots, &mut downpour_scene::Budget::default());
        let error = error.expect_err(name);
        assert!(error.to_string().contains(name), "{error}");
        error
    };
    std::fs::write(at.join("friction.png"), b"no picture").expect("a file");
    assert_eq!(fails("friction.png").exit_code(), 2);
    write(at, "friction.png", [4097, 1], |_, _| 0);
    let error = fails("friction.png");
    assert!(error.to_string().contains("4097 x 1"), "{error}");
    assert_eq!(error.exit_code(), 3);
    std::fs::remove_file(at.join("friction.png")).expect("the file");
    assert_eq!(fails("friction.png").exit_code(), 5);
    let error = Weather::parse("w.toml", "[glass]\nobstacles = \"../a.png\"\n").expect_err("outside");
    assert!(error.to_string().contains("glass.obstacles"), "{error}");
}
