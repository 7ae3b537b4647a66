//! A weather file, rendered to a picture: `cargo run -p downpour --features wgpu --example render_weather -- IN.toml OUT.png`.

use downpour::{Backend, Renderer};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let input = arguments.next().unwrap_or("assets/scenes/street/night.toml".into());
    let output = arguments.next().unwrap_or("rain.png".into());
    let mut renderer = Renderer::open(input, Backend::Auto)?;
    let frame = renderer.frame(2.5)?;
    frame.save(output)?;
    println!("{} drops on {}", frame.picture.drawn.len(), renderer.computer().adapter);
    Ok(())
}
