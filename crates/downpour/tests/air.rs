//! Temperature and pressure of a weather reach the drops: their fall and their oscillation.

use std::error::Error;
use std::f64::consts::PI;

use downpour::drop::oscillation::FrequencyLaw;
use downpour::render::camera::EyeMotion;
use downpour::render::rain::Exposure;
use downpour::scene::Budget;
use downpour::scene::sandbox::NoFiles;
use downpour::shower::{Shower, Still};
use downpour::trace::frame_scene::FrameScene;
use downpour::weather::{Weather, load};

fn weather(volume: &str, temperature_c: f64, pressure_hpa: f64) -> Result<Weather, Box<dyn Error>> {
    Ok(Weather::parse(
        "w.toml",
        &format!(
            "[rain]\nrate_mm_h = 300\nvolume = '{volume}'\ntemperature_c = {temperature_c}\npressure_hpa = {pressure_hpa}\n\
             [camera]\nposition_m = [0, 1, 0]\n[output]\nsize = [1280, 720]\n"
        ),
    )?)
}

/// Temperature, degrees C, pressure, hPa, and speeds by diameter, mm.
type OfAir = (f64, f64, [(f64, f64); 3]);

/// Speeds of drops of some diameters, mm, by K. Beard 1976, in m/s: computed apart from this project.
const SPEEDS: [OfAir; 2] = [
    (20.0, 1013.25, [(1.0, 4.005), (2.0, 6.506), (4.0, 8.811)]),
    (10.0, 700.0, [(1.0, 4.567), (2.0, 7.497), (4.0, 10.353)]),
];

#[test]
fn drops_fall_at_the_speed_of_the_weathers_air() -> Result<(), Box<dyn Error>> {
    for volume in ["closed-form", "view"] {
        for (temperature_c, pressure_hpa, speeds) in SPEEDS {
            let weather = weather(volume, temperature_c, pressure_hpa)?;
            let loaded = load(&weather, &NoFiles, &mut Budget::default())?;
            let frame_scene = FrameScene::new(&weather, &loaded, 0.5)?;
            let drops =
                Shower::new(&weather)?.at(&Still(&frame_scene), &frame_scene, 0.5, &mut |_, _| ())?.drops;
            for (mm, expected) in speeds {
                let of_size =
                    drops.iter().filter(|drop| (f64::from(drop.diameter) * 1.0e3 / mm - 1.0).abs() < 0.02);
                let found: Vec<f64> = of_size.map(|drop| -f64::from(drop.velocity[1])).collect();
                let mean = found.iter().sum::<f64>() / found.len() as f64;
                println!(
                    "{volume}, {temperature_c} C, {pressure_hpa} hPa, {mm} mm: {mean:.3} m/s of {expected}"
                );
                assert!(found.len() > 10, "{} drops of {mm} mm", found.len());
                // A drop that is 2 % larger is up to 1.7 % faster.
                assert!(
                    found.iter().all(|speed| (speed / expected - 1.0).abs() < 0.02),
                    "{mm} mm: {found:?}"
                );
                assert!((mean / expected - 1.0).abs() < 0.006, "{mm} mm: {mean}, not {expected}");
            }
        }
    }
    Ok(())
}

/// Rayleigh's frequency of the mode (2, 0), with surface tension and density of water of IAPWS.
#[test]
fn drops_oscillate_as_water_of_the_weathers_temperature() -> Result<(), Box<dyn Error>> {
    for (temperature_c, tension, density) in
        [(0.0, 0.075_65, 999.84), (20.0, 0.072_74, 998.21), (30.0, 0.071_19, 995.65)]
    {
        let exposure =
            Exposure::of_weather(&weather("auto", temperature_c, 900.0)?, EyeMotion::default(), 0.0);
        for mm in [1.0, 3.0, 5.0] {
            let radius: f64 = 0.5e-3 * mm;
            let expected = (8.0 * tension / (density * radius * radius * radius)).sqrt() / (2.0 * PI);
            let found = FrequencyLaw::Rayleigh1879.frequency(2, 1.0e-3 * mm, &exposure.fluids)?;
            println!("{temperature_c} C, {mm} mm: {found:.2} Hz of {expected:.2}");
            assert!(
                (found / expected - 1.0).abs() < 5.0e-4,
                "{temperature_c} C, {mm} mm: {found}, not {expected}"
            );
        }
    }
    Ok(())
}
