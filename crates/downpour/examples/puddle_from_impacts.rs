//! A puddle that ripples where the drops of a simulated rain meet it, beside one that is seeded by the law of that
//! rain.
//!
//! ```sh
//! cargo run --release -p downpour --example puddle_from_impacts -- 25
//! ```
//! 25 mm/h in a box of air 3 m wide over a floor with a square meter of water 5 mm deep, for 3 s.

use std::error::Error;

use downpour::bvh::Bvh;
use downpour::drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour::lattice::puddle::{Impact, Puddle, PuddleBorder, PuddleOptions, PuddleRain};
use downpour::sim::collision::{CollisionMap, CollisionOptions};
use downpour::sim::simulation::{SimVolume, Simulation, SimulationOptions, StepInput};
use downpour::sim::step::StepEvent;
use downpour::sim::view::View;
use glam::{DVec3, Vec3};

/// The water: its corner and edge, m, and its height.
const CORNER: [f32; 2] = [-0.5, -0.5];
const EDGE: f32 = 1.0;
const HEIGHT: f32 = -1.0;

const FRAMES: u64 = 180;
const DT_S: f32 = 1.0 / 60.0;

fn main() -> Result<(), Box<dyn Error>> {
    let rate_mm_h: f64 = std::env::args().nth(1).map_or(Ok(25.0), |text| text.parse())?;
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, rate_mm_h)?;
    let floor = level(HEIGHT);
    let map_options = CollisionOptions::covering(
        Vec3::new(-1.6, HEIGHT - 0.5, -1.6),
        Vec3::new(1.6, 2.0, 1.6),
        Vec3::NEG_Y,
        [64, 64],
    )?;
    let map = CollisionMap::new(&map_options, &Bvh::new(&floor))?;
    // Every drop counts, however small it is on a picture.
    let view = View { least_pixels: 1.0e-3, ..View::default() };
    let moment = StepInput { map: Some(&map), ..StepInput::new(&view, DVec3::ZERO, Vec3::ZERO) };
    let volume = SimVolume::Box { size_m: [3.0; 3] };
    let options = SimulationOptions { volume, seed: 4, ..SimulationOptions::default() };
    let mut simulation = Simulation::new(&rain, &options, &moment)?;

    let cell_m = EDGE / 512.0;
    let options =
        PuddleOptions { size: [512; 2], cell_m, border: PuddleBorder::Open, ..PuddleOptions::default() };
    let (mut simulated, mut by_law) = (Puddle::new(&options)?, Puddle::new(&options)?);
    let law = PuddleRain::new(&rain, 4);
    let mut counts = [0, 0];
    for frame in 0..FRAMES {
        let happened = simulation.advance(f64::from(DT_S), &moment)?;
        let impacts: Vec<Impact> = happened.events.iter().filter_map(on_water).collect();
        let drawn = law.impacts(by_law.extent_m(), frame, DT_S)?;
        for (k, (puddle, impacts)) in
            [(&mut simulated, impacts), (&mut by_law, drawn)].into_iter().enumerate()
        {
            counts[k] += impacts.len();
            puddle.seed(&impacts)?;
            puddle.step(DT_S)?;
        }
    }
    for (name, puddle, count) in
        [("the simulated drops", &simulated, counts[0]), ("the law of the rain", &by_law, counts[1])]
    {
        let heights = puddle.heights();
        let mean = heights.iter().map(|&h| f64::from(h * h)).sum::<f64>() / heights.len() as f64;
        println!("{name}: {count} impacts, ripples of {:.4} mm rms", 1.0e3 * mean.sqrt());
    }
    println!("drops below {:.2} mm are not in the box", 1.0e3 * simulation.min_diameter());
    Ok(())
}

/// Impact on the water; `None` if it was elsewhere.
fn on_water(event: &StepEvent) -> Option<Impact> {
    let [x, y, z] = event.position;
    let position_m = [x - CORNER[0], z - CORNER[1]];
    let within = position_m.iter().all(|at| (0.0..EDGE).contains(at)) && (y - HEIGHT).abs() < 0.05;
    let speed_m_s = Vec3::from(event.velocity).length();
    within.then_some(Impact { position_m, speed_m_s, diameter_m: event.diameter })
}

/// A level floor.
fn level(height: f32) -> [[[f32; 3]; 3]; 2] {
    let at = |x: f32, z: f32| [x, height, z];
    [[at(-4.0, -4.0), at(-4.0, 4.0), at(4.0, 4.0)], [at(-4.0, -4.0), at(4.0, 4.0), at(4.0, -4.0)]]
}
