//! A pane keeps the rain outside: no drop of a picture is on the eye's side of it at any time of the exposure.

use std::error::Error;

use downpour::math::ops::f64 as ops;
use downpour::scene::Budget;
use downpour::scene::sandbox::NoFiles;
use downpour::shower::{MovingScenery, Shower};
use downpour::sim::field::FallingDrop;
use downpour::trace::frame_scene::FrameScene;
use downpour::weather::{Weather, load};
use glam::DVec3;

const EYE: DVec3 = DVec3::new(0.3, 1.5, -0.2);
const SHUTTER_S: f64 = 1.0 / 30.0;
const PANE_M: f64 = 1.2;
const TILT_DEG: f64 = 60.0;

/// Rain before an eye that looks along -z and moves at `speed_m_s` that way, behind a tilted pane if there is one.
fn weather(volume: &str, speed_m_s: f64, pane: bool) -> String {
    let far = EYE.z - speed_m_s;
    let glass = format!(
        "[glass]\ndistance_m = {PANE_M}\ntilt_deg = {TILT_DEG}\nsize_m = [0.2, 0.2]\ncell_mm = 5\nspeed_m_s = 4\nbefore_s = 0\n"
    );
    format!(
        "[rain]\nrate_mm_h = 200\nseed = 3\nvolume = \"{volume}\"\n[sky]\nzenith_color = [0.4, 0.45, 0.5]\n[camera]\n\
         position_m = [[0, [{x}, {y}, {z}]], [1, [{x}, {y}, {far}]]]\npitch_deg = 0\nfov_deg = 60\nshutter_s = {SHUTTER_S}\n\
         [output]\nsize = [960, 540]\n{pane}",
        x = EYE.x,
        y = EYE.y,
        z = EYE.z,
        pane = if pane { &glass } else { "" },
    )
}

fn drops(text: &str, time_s: f64) -> Result<Vec<FallingDrop>, Box<dyn Error>> {
    let weather = Weather::parse("w.toml", text)?;
    let loaded = load(&weather, &NoFiles, &mut Budget::default())?;
    let frame_scene = FrameScene::new(&weather, &loaded, time_s)?;
    let scenery = MovingScenery { frame_scene: &frame_scene, weather: &weather, loaded: &loaded };
    Ok(Shower::new(&weather)?.at(&scenery, &frame_scene, time_s, &mut |_, _| ())?.drops)
}

/// Distances beyond the plane of the pane, m, at both ends of the part of the exposure in which a drop is there.
fn beyond(drop: &FallingDrop, speed_m_s: f64, time_s: f64) -> [f64; 2] {
    let tilt = TILT_DEG.to_radians();
    // Away from the eye and up; a vertical pane has a tilt of 90 degrees.
    let outward = DVec3::new(0.0, ops::cos(tilt), -ops::sin(tilt));
    let through = DVec3::new(0.0, 0.0, -PANE_M);
    let motion = DVec3::new(0.0, 0.0, -speed_m_s);
    let velocity = DVec3::from(drop.velocity.map(f64::from));
    let half = 0.5 * SHUTTER_S;
    drop.present_s.map(|time| {
        let time = f64::from(time).clamp(-half, half);
        let at = drop.position + velocity * (time - f64::from(drop.seen_s()));
        let eye = EYE + motion * (time_s + time);
        (at - eye - through).dot(outward)
    })
}

#[test]
fn no_drop_is_on_the_eyes_side_of_a_pane() -> Result<(), Box<dyn Error>> {
    let time_s = 0.4;
    for volume in ["closed-form", "view"] {
        for speed_m_s in [0.0, 12.0] {
            let outside = drops(&weather(volume, speed_m_s, true), time_s)?;
            let open = drops(&weather(volume, speed_m_s, false), time_s)?;
            let all = |drops: &[FallingDrop], which: fn([f64; 2]) -> bool| {
                drops.iter().filter(|drop| which(beyond(drop, speed_m_s, time_s))).count()
            };
            let inside = all(&open, |[begin, end]| begin < 0.0 && end < 0.0);
            let crossing = all(&open, |[begin, end]| (begin < 0.0) != (end < 0.0));
            let ended = outside.iter().filter(|drop| drop.present_s != FallingDrop::ALWAYS).count();
            println!(
                "{volume}, {speed_m_s} m/s: {} drops of {}; {inside} inside, {crossing} cross, {ended} end at the pane",
                outside.len(),
                open.len()
            );
            let nearest =
                outside.iter().flat_map(|drop| beyond(drop, speed_m_s, time_s)).fold(f64::MAX, f64::min);
            assert!(nearest > -1.0e-5, "{volume}, {speed_m_s} m/s: {nearest} m beyond the pane");
            // The control: without a pane there are drops at the eye's side, and nothing else is missing behind it.
            assert!(inside > 50 && crossing > 10, "{inside} inside, {crossing} cross of {}", open.len());
            assert_eq!(outside.len() + inside, open.len(), "{volume}, {speed_m_s} m/s");
            assert_eq!(ended, crossing, "{volume}, {speed_m_s} m/s");
        }
    }
    Ok(())
}
