//! Rain on panes: how much water, where it runs, and what is seen through it.

use downpour_render::camera::Viewpoint;
use downpour_weather::WetnessAt;
use glam::Affine3A;

use super::*;
use crate::builder::{MeshPart, SceneBuilder};
use crate::data::RenderFrame;
use crate::material::MaterialLook;
use crate::sky_light::SkyLight;
use crate::wet::SceneWetness;

const PANE: GlazingPane = GlazingPane {
    material: SCENE_NONE,
    height: 3.0,
    largest: 0.0025,
    seed: 7,
    center: Vec3::ZERO,
    half_width: 0.0,
    across: Vec3::X,
    half_height: 0.0,
    outward: Vec3::Z,
    half_thickness: 0.1,
};

/// A place at a time in s in a rain of 0.004 mm/s that meets the glass.
fn place(at: Vec2, time_s: f32) -> GlazingPlace {
    let met = 0.004 * time_s;
    GlazingPlace { at, across: Vec3::X, down: Vec3::NEG_Y, met, since: met, rate: 0.004, kept: 1.0 }
}

/// In the beginning drops hold their cells' share of the rain: 0.4 of it, in 0.7 of the cells, of three sizes.
#[test]
fn drops_hold_the_rain_that_has_met_them() {
    // So low that nothing runs yet.
    let pane = GlazingPane { height: 0.01, ..PANE };
    for met_mm in [0.002f32, 0.006] {
        let step = 0.2e-3;
        let count: u16 = 500;
        let mut volume = 0.0f64;
        for i in 0..count {
            for j in 0..count {
                let at = Vec2::new(f32::from(i), f32::from(j)) * step;
                let place = GlazingPlace { met: met_mm, since: met_mm, ..place(at, 0.0) };
                let found = glazing_drop(&place, &pane);
                if found.radius > 0.0 {
                    volume += f64::from(glazing_cap(found.offset, found.radius).max(0.0));
                }
            }
        }
        let mean_mm = volume / f64::from(count) / f64::from(count) * 1.0e3;
        let expected = f64::from(met_mm) * 3.0 * 0.4 * 0.7;
        // Drops are longer than round ones; where two lie over each other the higher counts.
        assert!((0.9..1.12).contains(&(mean_mm / expected)), "{met_mm}: {mean_mm}, {expected}");
    }
}

/// Rain that meets a lane of 30 mm over half of the 3 m comes down it in heads of 60 mm^3.
#[test]
fn what_meets_the_glass_runs_off() {
    let at = Vec2::new(0.4, 1.5);
    let runs = |time_s: f32| glazing_lane(&place(at, time_s), at, &PANE).runs;
    let found = runs(160.0) - runs(60.0);
    let expected = 100.0 * 0.004e-3 * 0.03 * 1.5 / 60.0e-9;
    assert!((found / expected - 1.0).abs() < 1.0e-4, "{found}, {expected}");
}

/// A head is where it was, 25 cm further down, a second later; where it was there is no water, and then it grows anew.
#[test]
fn a_run_comes_down_and_sweeps() {
    let lane = 11;
    let middle = (lane as f32 + 0.5) * GLAZING_LANE;
    // The head of some run on its track, by looking down the track.
    let on_track = |height: f32, time_s: f32| {
        let probe = glazing_lane(&place(Vec2::new(middle, height), time_s), Vec2::new(middle, height), &PANE);
        let run = probe.runs.floor() as i32;
        let track = (run as f32 / GLAZING_RUNS as f32).floor() as i32;
        Vec2::new(middle + glazing_track(height, lane, track, PANE.seed), height)
    };
    let is_head = |height: f32, time_s: f32| {
        let at = on_track(height, time_s);
        let found = glazing_runner(&place(at, time_s), &PANE);
        found.radius > 0.0 && found.offset.length() < 0.2e-3
    };
    let heights = |from: f32| (0..4000u16).map(move |k| from + f32::from(k) * 0.5e-4);
    let start = 60.0;
    let head = heights(2.75).find(|&height| is_head(height, start)).expect("a head");
    // A tenth of a second later it is 25 mm below.
    let later = (head + 0.020..head + 0.030, start + 0.1);
    let found = heights(head + 0.015).find(|&height| is_head(height, later.1)).expect("the head");
    assert!(later.0.contains(&found), "{head} {found}");
    // Just above it, the glass has been swept since 4 ms.
    let behind = on_track(head - 1.0e-3, start);
    let swept = |time_s: f32| glazing_age(&place(behind, time_s), behind, &PANE);
    assert!(swept(start) < 0.004 * 0.01, "{}", swept(start));
    let grown = swept(start + 0.05) - swept(start);
    assert!((grown / (0.004 * 0.05) - 1.0).abs() < 0.1, "{grown}");
    // No place has more water than has met it.
    for k in 0..200u8 {
        let at = Vec2::new(f32::from(k) * 1.7e-3, 1.0 + f32::from(k) * 3.1e-3);
        for time_s in [0.0, 1.0, 30.0] {
            assert!(glazing_age(&place(at, time_s), at, &PANE) <= 0.004 * time_s);
        }
    }
}

/// A film of even thickness does not turn a ray; a wedge of water turns it as a thin prism does: by (n - 1) times its angle.
#[test]
fn a_wedge_of_water_is_a_prism() {
    let facet = Vec3::Z;
    let turned = |angle: f32| Vec3::new(ops::sin(angle), 0.0, ops::cos(angle));
    for along in [Vec3::NEG_Z, Vec3::Z, Vec3::new(0.6, 0.0, -0.8), Vec3::new(-0.3, 0.4, 0.866).normalize()] {
        assert!(glazing_through(along, facet, facet).distance(along) < 1.0e-6, "{along}");
    }
    let wedge = 0.05;
    for along in [Vec3::NEG_Z, Vec3::Z] {
        let out = glazing_through(along, turned(wedge), facet);
        let angle = ops::atan2(-out.x * along.z.signum(), out.z.abs());
        // From outside it is turned away from the thick end's side, as from within.
        assert!((angle.abs() - (PUDDLE_WATER_INDEX - 1.0) * wedge).abs() < 1.0e-4, "{along}: {angle}");
    }
    // Within steep water all is reflected: back to where it came from.
    let steep = glazing_through(Vec3::new(0.0, 0.0, 1.0), turned(1.2), facet);
    assert!(steep.z < 0.0, "{steep}");
}

/// A pane in the plane z = 0, toward +z, in rain that comes from there; with a roof over the whole of it or not.
fn glass(has_roof: bool) -> SceneBuilder {
    let mut builder = SceneBuilder::new();
    let clear =
        MaterialLook { transmission: 1.0, roughness: 0.02, base_color: [0.9; 4], ..MaterialLook::default() };
    let clear = builder.add_material(clear);
    let mut square = |material: u32, corners: [[f32; 3]; 4]| {
        builder.add_mesh(&MeshPart::plain(&corners, &[0, 1, 2, 0, 2, 3], material), &Affine3A::IDENTITY);
    };
    square(clear, [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [9.0, 9.0, 0.0], [-9.0, 9.0, 0.0]]);
    if has_roof {
        square(0, [[-9.0, 5.0, -9.0], [-9.0, 5.0, 9.0], [9.0, 5.0, 9.0], [9.0, 5.0, -9.0]]);
    }
    builder
}

/// A picture of it from 0.3 m away.
fn picture(builder: SceneBuilder, rained_mm: Option<f32>, eye: Vec3) -> Vec<[f32; 4]> {
    let mut scene = builder.build(&SkyLight::uniform([1.0; 3]));
    if let Some(rained) = rained_mm {
        let at = WetnessAt { before: 0.0, kept: 1.0, since: 3.0 };
        let towards = Vec3::new(0.0, 1.0, 0.7).normalize();
        scene.set_wetness(Some(&SceneWetness { at, towards, shift: Vec3::ZERO }));
        let rain = RenderGlazing { before: 0.0, kept: 1.0, since: rained, rate: 0.004, count: 1 };
        scene.set_glazing(&pane_rows(&rain, &[PANE]));
    }
    let view = Viewpoint { eye, forward: Vec3::new(0.3, 0.1, 0.0) - eye, up: Vec3::Y, fov_y: 0.5 };
    let frame = RenderFrame::new(&scene, &view, [80, 60], 1, 4, 5).unwrap();
    SceneView { data: &scene, frame: &frame }.picture()
}

/// Under an even sky drops are not seen, from either side: they lose no light and make none.
#[test]
fn drops_lose_no_light() {
    for eye in [Vec3::new(0.25, 0.1, 0.3), Vec3::new(0.5, -0.2, 0.25), Vec3::new(0.25, 0.1, -0.3)] {
        let (dry, wet) = (picture(glass(false), None, eye), picture(glass(false), Some(0.5), eye));
        for (k, (dry, wet)) in dry.iter().zip(&wet).enumerate() {
            assert!((wet[1] / dry[1] - 1.0).abs() < 5.0e-3, "{eye} {k}: {wet:?} {dry:?}");
        }
    }
}

/// Before something that is darker than the sky they are; under a roof there are none.
#[test]
fn drops_are_where_rain_is() {
    let eye = Vec3::new(0.25, 0.1, 0.3);
    let behind = |has_roof: bool| {
        let mut builder = glass(has_roof);
        let wall = builder
            .add_material(MaterialLook { base_color: [0.02, 0.02, 0.02, 1.0], ..MaterialLook::default() });
        let corners = [[-20.0, -9.0, -5.0], [0.3, -9.0, -5.0], [0.3, 9.0, -5.0], [-20.0, 9.0, -5.0]];
        builder.add_mesh(&MeshPart::plain(&corners, &[0, 1, 2, 0, 2, 3], wall), &Affine3A::IDENTITY);
        builder
    };
    let differ = |has_roof: bool| {
        let (dry, wet) = (picture(behind(has_roof), None, eye), picture(behind(has_roof), Some(0.5), eye));
        let count = dry.iter().zip(&wet).filter(|(dry, wet)| (wet[1] - dry[1]).abs() > 0.05).count();
        count as f64 / dry.len() as f64
    };
    let open = differ(false);
    // Those near the edge of the wall, which show what is beyond it.
    assert!((0.008..0.1).contains(&open), "{open}");
    assert_eq!(differ(true), 0.0);
}
