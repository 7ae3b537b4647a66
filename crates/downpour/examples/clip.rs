//! A clip with a camera that goes down the street, set from here:
//! `cargo run -p downpour --features wgpu --example clip -- FOLDER [FRAMES [WIDTH]]`.

use downpour::weather::CameraPath;
use downpour::wind::Keyed;
use downpour::{Backend, Renderer, RendererOptions, Source};
use glam::DVec3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = std::path::PathBuf::from(arguments.next().unwrap_or("clip".into()));
    let frames: u32 = arguments.next().map_or(Ok(24), |text| text.parse())?;
    let width: u32 = arguments.next().map_or(Ok(480), |text| text.parse())?;
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/scenes/street/night.toml");

    let mut source = Source::read(scene.as_ref(), &[], &mut Default::default())?;
    source.weather.size = [width, width * 9 / 16];
    source.weather.rain.rate_mm_h = 50.0;
    let device = Backend::Auto.device()?;
    let mut renderer = Renderer::new(source.weather, source.loaded, RendererOptions::default(), device)?;

    // Two meters a second toward the end of the street.
    let way = Keyed::new(vec![(0.0, DVec3::new(0.9, 1.6, 9.0)), (8.0, DVec3::new(0.4, 1.6, -7.0))])?;
    renderer.set_camera(CameraPath::looking_at(way, DVec3::new(-0.4, 2.4, -40.0)))?;

    std::fs::create_dir_all(&folder)?;
    for number in 0..frames {
        renderer.frame(f64::from(number) / 24.0)?.save(folder.join(format!("{number:04}.png")))?;
    }
    println!("{frames} frames in {}", folder.display());
    Ok(())
}
