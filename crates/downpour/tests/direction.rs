//! Keyframes of a weather file in frames: a frame is that of a weather with the values of its time.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod model;

use downpour::scene::Budget;
use downpour::shower::Shower;
use downpour::street::{Car, TimeOfDay};
use downpour::{Backend, Frame, Renderer, RendererOptions, Source};

/// A sky that darkens, a lamp that lights up and moves, a zoom.
fn text(sky: &str, lux: &str, lamp: &str, fov: &str, ev: &str) -> String {
    format!(
        "
[rain]
rate_mm_h = 60
[sky]
zenith_color = [0.4, 0.45, 0.5]
intensity = {sky}
[sun]
azimuth_deg = 250
elevation_deg = 30
illuminance_lux = {lux}
[[light]]
point = {{ position_m = [0.5, 1.6, -4], intensity_cd = {lamp} }}
[camera]
position_m = [0, 1.6, 0]
fov_deg = {fov}
exposure_ev = {ev}
[output]
size = [48, 32]
"
    )
}

fn keyed() -> String {
    text(
        "[[0, 1], [4, 0.5]]",
        "[[0, 3], [4, 1]]",
        "[[0, 1], [4, 9]]",
        "[[0, 30], [4, 50]]",
        "[[0, 0], [4, 2]]",
    )
}

/// The same with the values at 2 s.
fn plain() -> String {
    text("0.75", "2", "5", "40", "0")
}

fn renderer(text: &str, first_s: f64) -> Renderer {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    std::fs::write(&path, text).unwrap();
    let floor = [[-20.0, 0.0, -20.0], [20.0, 0.0, -20.0], [20.0, 0.0, 20.0], [-20.0, 0.0, 20.0]];
    model::write(folder.path(), &floor, &[0, 2, 1, 0, 3, 2]).unwrap();
    std::fs::write(folder.path().join("car.glb"), Car::new(2).unwrap().to_glb(TimeOfDay::Night).unwrap())
        .unwrap();
    let source = Source::read(&path, &[], &mut Budget::default()).unwrap();
    let options = RendererOptions { first_s, ..RendererOptions::default() };
    Renderer::new(source.weather, source.loaded, options, Backend::Cpu.device().unwrap()).unwrap()
}

fn bits(frame: &Frame) -> Vec<[u32; 3]> {
    frame.radiance().iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

#[test]
fn a_frame_alone_is_the_frame_of_a_clip_and_that_of_its_values() {
    let mut clip = renderer(&keyed(), 0.0);
    let frames: Vec<Frame> = [0.0, 1.0, 2.0].map(|time| clip.frame(time).unwrap()).into();
    let exposure = clip.exposure();
    let mut alone = renderer(&keyed(), 2.0);
    alone.set_exposure(exposure);
    let alone = alone.frame(2.0).unwrap();
    assert_eq!(bits(&alone), bits(&frames[2]));
    assert_eq!(alone.png().unwrap(), frames[2].png().unwrap());
    // The same weather without keys: exact but for the exposure, which is one stop more than at time 0.
    let mut values = renderer(&plain(), 2.0);
    values.set_exposure(exposure);
    let values = values.frame(2.0).unwrap();
    assert_eq!(bits(&values), bits(&alone));
    assert!((alone.exposure / values.exposure - 2.0).abs() < 1.0e-6);
    assert_ne!(bits(&frames[0]), bits(&alone));
    // Earlier frames after later ones.
    assert_eq!(bits(&clip.frame(1.0).unwrap()), bits(&frames[1]));
}

/// A car that turns in fog that thickens, in the light of flashes.
fn effects([place, turn, glare, width, fog, brightness]: [&str; 6]) -> String {
    format!(
        "
model = [
    {{ file = \"floor.gltf\" }},
    {{ file = \"car.glb\", animation_speed = 2, translation_m = {place}, rotation_deg = {turn} }},
]
[rain]
rate_mm_h = 30
[sky]
zenith_color = [0.4, 0.45, 0.5]
[camera]
position_m = [0, 1.2, 0]
look_at_m = [0, 0.4, -6]
fov_deg = 50
shutter_s = 0.05
[glow]
glare = {glare}
width = {width}
[fog]
visibility_m = {fog}
[lightning]
limit = false
per_minute = 600
brightness = {brightness}
[output]
size = [32, 20]
"
    )
}

#[test]
fn models_and_effects_move_by_their_keys() {
    let keyed = [
        "[[0, [-4, 0, -6]], [4, [4, 0, -6]]]",
        "[[0, [0, 0, 0]], [4, [0, 180, 0]]]",
        "[[0, 0.02], [4, 0.1]]",
        "[[0, 1], [4, 3]]",
        // The light of a flash is that in the fog of its moment.
        "[[0, 180], [1, 100], [3, 100], [4, 20]]",
        "[[0, 2000], [4, 20000]]",
    ];
    let middle = ["[0, 0, -6]", "[0, 90, 0]", "0.06", "2", "100", "11000"];
    let mut clip = renderer(&effects(keyed), 0.0);
    let frame = |renderer: &mut Renderer| {
        renderer.set_exposure(Some(1.0));
        assert!(renderer.is_in_flash(2.0));
        renderer.frame(2.0).unwrap()
    };
    let own = bits(&frame(&mut clip));
    // Keys that say the same all the time are those of that moment, to the bit.
    let resting = ["[[0, [0, 0, -6]], [4, [0, 0, -6]]]", "[[0, [0, 90, 0]], [4, [0, 90, 0]]]"];
    let [_, _, glare, width, fog, brightness] = middle;
    let resting = [resting[0], resting[1], glare, width, fog, brightness];
    assert!(own == bits(&frame(&mut renderer(&effects(resting), 0.0))));
    let other = bits(&frame(&mut renderer(&effects(middle), 0.0)));
    // Triangles of what may move come last, so that sums over them are in another order.
    let values =
        |bits: &[[u32; 3]]| bits.iter().flatten().map(|&bits| f32::from_bits(bits)).collect::<Vec<_>>();
    let (own, other) = (values(&own), values(&other));
    assert!(own.len() == other.len() && own.iter().all(|value| value.is_finite()));
    let apart = own.iter().zip(&other).map(|(a, b)| (a - b).abs() / a.abs().max(1.0)).fold(0.0, f32::max);
    assert!(apart < 2.0e-3, "{apart}");
}

/// Values of time 0 would give another picture: crowns of splashes from near and the ripples of a puddle, with keys and with the values of their time.
#[test]
fn splashes_and_ripples_grow_by_their_keys() {
    let text = |size: &str, influence: &str| {
        format!(
            "model = [{{ file = \"floor.gltf\" }}]\n[rain]\nrate_mm_h = 200\n[sky]\nzenith_color = [0.4, 0.45, 0.5]\n\
             [camera]\nposition_m = [0, 0.4, 0]\nlook_at_m = [0, 0, -0.2]\nfov_deg = 30\n[splashes]\nsize = {size}\n\
             [[puddle]]\nposition_m = [0, 0, -0.2]\nsize_m = [1, 1]\nrelief_mm = 20\nripple_influence = {influence}\n\
             [output]\nsize = [48, 32]\n"
        )
    };
    let keys = "[[0, 1], [0.4, 3]]";
    let [keyed, middle] = [[keys, keys], ["2", "2"]]
        .map(|[size, influence]| bits(&renderer(&text(size, influence), 0.0).frame(0.2).unwrap()));
    assert!(keyed == middle);
}

/// A shower over a puddle and behind a pane.
fn shower(rate: &str) -> String {
    format!(
        "
[rain]
rate_mm_h = {rate}
[sky]
zenith_color = [0.4, 0.45, 0.5]
[camera]
position_m = [0, 1.6, 0]
fov_deg = 40
[glass]
tilt_deg = 60
before_s = 0.5
cell_mm = 5
[output]
size = [48, 32]
"
    )
}

#[test]
fn a_rate_that_changes_is_that_of_the_time_in_any_order() {
    let text = shower("[[0, 0], [2, 80], [12, 80], [12.5, 0]]");
    let mut clip = renderer(&text, 0.0);
    let times = [0.0, 7.0, 28.0];
    let frames: Vec<Frame> = times.map(|time| clip.frame(time).unwrap()).into();
    // As a disdrometer as high as the columns of a class, up to 30 m above and below the eye: there the rate is that of some seconds
    // before and after.
    let shower = Shower::new(clip.weather()).unwrap();
    let rates = times.map(|time| shower.measured_rate_mm_h(clip.first_scene(), time).unwrap());
    assert!(rates[0] < 20.0 && (rates[1] / 80.0 - 1.0).abs() < 0.1 && rates[2] == 0.0, "{rates:?}");
    let exposure = clip.exposure();
    for (time, frame) in times.into_iter().zip(&frames) {
        let mut alone = renderer(&text, 0.0);
        alone.set_exposure(exposure);
        assert_eq!(bits(&alone.frame(time).unwrap()), bits(frame), "{time} s");
    }
    assert!(frames[1].medium.extinction() > 0.0);
    assert_eq!(frames[2].medium.extinction(), 0.0);
}

#[test]
fn a_rate_whose_keys_are_equal_is_the_rain_of_that_rate() {
    let [mut keyed, mut plain] = ["[[0, 30], [5, 30]]", "30"].map(|rate| renderer(&shower(rate), 0.0));
    for time in [0.0, 0.5] {
        assert_eq!(bits(&keyed.frame(time).unwrap()), bits(&plain.frame(time).unwrap()), "{time} s");
    }
}

#[test]
fn a_rate_that_changes_needs_closed_form() {
    let text = "[rain]\nrate_mm_h = [[0, 5], [1, 50]]\n[turbulence]\nspeed_m_s = 1\n[[wind]]\nvortex = { strength_m2_s = 5, center_m = [0, 0, 0] }";
    let weather = downpour::weather::Weather::parse("w.toml", text);
    let weather = weather.unwrap_or_else(|error| panic!("{error}"));
    let error = Shower::new(&weather).unwrap_err().to_string();
    assert!(error.contains("rain.rate_mm_h has keys"), "{error}");
}

/// A drag without a closed form is refused with `volume = "closed-form"`, and taken step by step else.
#[test]
fn a_drag_without_a_closed_form_is_refused_in_closed_form() {
    let shower = |volume: &str| {
        let text = format!("[rain]\ndrag = 'rousseau-2008'\nvolume = '{volume}'");
        Shower::new(&downpour::weather::Weather::parse("w.toml", &text).unwrap())
    };
    let error = shower("closed-form").unwrap_err();
    assert!(matches!(error, downpour::shower::ShowerError::DragByStep), "{error}");
    let told = error.to_string();
    for part in ["rain.drag is \"rousseau-2008\"", "rain.volume is \"closed-form\"", "allowed: "] {
        assert!(told.contains(part), "{part}: {told}");
    }
    for volume in ["auto", "view", "box"] {
        assert!(!shower(volume).unwrap().is_closed_form(), "{volume}");
    }
}

/// `rain.extinction = "total"` takes out twice what drops cover.
#[test]
fn the_total_extinction_is_twice_that_of_a_camera() {
    let extinction = |extinction: &str| {
        let text = format!("{}\n", shower("60")).replacen(
            "[rain]",
            &format!("[rain]\nextinction = '{extinction}'"),
            1,
        );
        renderer(&text, 0.0).frame(0.0).unwrap().medium.extinction()
    };
    let (camera, total) = (extinction("camera"), extinction("total"));
    assert!(camera > 1.0e-3 && (total / camera - 2.0).abs() < 1.0e-6, "{camera}, {total}");
}

/// A car that drives through a puddle without rain; `influence` is that of waves.
fn driven(influence: &str) -> String {
    format!(
        "
model = [
    {{ file = \"floor.gltf\" }},
    {{ file = \"car.glb\", translation_m = [[0, [-14, 0, -6]], [2, [10, 0, -6]]] }},
]
[rain]
rate_mm_h = 0
[[light]]
point = {{ position_m = [0.5, 3, -10], intensity_cd = 200 }}
[camera]
position_m = [0, 1.5, 0]
look_at_m = [0, 0, -6]
fov_deg = 35
[[puddle]]
position_m = [0, 0, -6]
size_m = [8, 4]
fill = 1
relief_mm = 4
cell_mm = 50
ripple_influence = {influence}
[output]
size = [48, 27]
"
    )
}

/// A car leaves waves in the puddle that it drove through, the same in a frame alone as in a clip.
#[test]
fn a_car_leaves_waves_in_a_puddle() {
    let frames = |text: &str, times: &[f64]| -> Vec<[u32; 3]> {
        let mut renderer = renderer(text, times[0]);
        renderer.set_exposure(Some(1.0));
        times.iter().map(|&time| bits(&renderer.frame(time).unwrap())).last().unwrap()
    };
    // The car is past the picture then.
    let waves = frames(&driven("1"), &[0.0, 0.5, 1.0, 1.5, 1.9]);
    assert!(waves == frames(&driven("1"), &[1.9]));
    let level = frames(&driven("0"), &[1.9]);
    let changed = waves.iter().zip(&level).filter(|(a, b)| a != b).count();
    assert!((10..1200).contains(&changed), "{changed} pixels");
}
