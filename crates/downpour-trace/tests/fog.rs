//! Fog: what it takes out and what it adds, held against formulas and integrals that are written here.

use downpour_math::ops::f64 as ops;
use downpour_render::camera::Viewpoint;
use downpour_render::picture::{Picture, PictureOptions};
use downpour_render::rain::medium::fog::medium_fog_depth;
use downpour_render::rain::{DropMasks, RainMedium, RainOptions};
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::picture::render_picture;
use downpour_trace::sky_light::SkyLight;
use downpour_weather::{Fog, Weather};
use glam::{Affine3A, Vec3, Vec4};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// A black wall across the view at a distance before an even sky of radiance 1.
fn picture(
    distance: f32,
    fog: Option<&Fog>,
    masks: &DropMasks,
) -> Result<Picture, Box<dyn std::error::Error>> {
    let mut builder = SceneBuilder::new();
    let black =
        downpour_trace::material::MaterialLook { base_color: [0.0, 0.0, 0.0, 1.0], ..Default::default() };
    let material = builder.add_material(black);
    // It takes 0.2 % of the cone from which fog is lit.
    let edge = 0.03 * distance;
    let corners = [
        [-edge, -edge, -distance],
        [edge, -edge, -distance],
        [edge, edge, -distance],
        [-edge, edge, -distance],
    ];
    builder.add_mesh(&MeshPart::plain(&corners, &[0, 1, 2, 0, 2, 3], material), &Affine3A::IDENTITY);
    let scene = builder.build(&SkyLight::uniform([1.0; 3]));
    let view = Viewpoint { eye: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.3 };
    let medium = RainMedium::default().with_fog(fog, 0.0);
    let rain = RainOptions { medium, capture_size: 64, ..RainOptions::default() };
    let options = PictureOptions { size: [9, 9], grid: 1, sky_rays: 0, rain, ..PictureOptions::default() };
    Ok(render_picture(&scene, &view, &[], masks, &options)?)
}

fn fog(text: &str) -> Result<Fog, Box<dyn std::error::Error>> {
    Ok(Weather::parse("fog.toml", &format!("[fog]\n{text}"))?.fog.ok_or("no fog")?)
}

/// The transmittance of the picture at the distance of visibility is the law's contrast, and an even sky stays as it is.
#[test]
fn contrast_at_the_visibility_is_that_of_the_law() -> Outcome {
    let masks = DropMasks::trace(1.333)?;
    for (law, contrast) in [("koschmieder", 0.02), ("wmo", 0.05)] {
        let fog = fog(&format!("visibility_m = 150\nlaw = \"{law}\""))?;
        let picture = picture(150.0, Some(&fog), &masks)?;
        assert!((f64::from(picture.rain[40][3]) - contrast).abs() < 2.0e-4, "{law}: {}", picture.rain[40][3]);
        let [wall, sky] = [40, 4].map(|pixel| f64::from(picture.radiance()[pixel][0]));
        assert!((sky - 1.0).abs() < 5.0e-3, "furnace: {sky}");
        assert!(((sky - wall) / sky - contrast).abs() < 4.0e-3, "{law}: {wall} before {sky}");
    }
    let none = picture(150.0, None, &masks)?;
    assert!(none.rain.iter().all(|pixel| *pixel == [0.0, 0.0, 0.0, 1.0]), "without fog nothing changes");
    Ok(())
}

/// The closed form is the integral of the profile: level rays, rays through the base from both sides, rays to the sky.
#[test]
fn depth_is_the_integral_of_the_profile() {
    for (sigma, scale, eye) in [(0.02, 3.0, 1.6), (0.02, 3.0, -4.0), (0.1, 50.0, 20.0)] {
        for rise in [0.0, 1.0e-6, -1.0e-3, 0.01, -0.2, 0.5, 1.0, -1.0] {
            for distance in [0.5, 20.0, 400.0] {
                let steps = 200_000;
                let width = distance / f64::from(steps);
                let sum: f64 = (0..steps)
                    .map(|k| eye + rise * (f64::from(k) + 0.5) * width)
                    .map(|height| sigma * ops::exp(-height.max(0.0) / scale) * width)
                    .sum();
                let of = Vec4::new(sigma as f32, (1.0 / scale) as f32, eye as f32, 1.0);
                let found = f64::from(medium_fog_depth(of, rise as f32, distance as f32));
                assert!(
                    (found - sum).abs() < 1.0e-4 * sum,
                    "{scale} {eye} {rise} {distance}: {found}, not {sum}"
                );
            }
        }
    }
    // Straight up from the base: sigma times the scale height.
    let up = medium_fog_depth(Vec4::new(0.02, 1.0 / 3.0, 0.0, 1.0), 1.0, 1.0e9);
    assert!((up - 0.06).abs() < 1.0e-6, "{up}");
}
