//! Scratch.
use downpour_render::picture::PictureOptions;
use downpour_render::scene::SceneView;
use downpour_render::stage::Stage;
use downpour_render::file::write_exr;
use downpour_scene::weather::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let grid: u32 = args.get(3).map_or(2, |t| t.parse().unwrap());
    let rays: u32 = args.get(4).map_or(1, |t| t.parse().unwrap());
    let seed: u64 = args.get(5).map_or(0, |t| t.parse().unwrap());
    let path = std::path::Path::new(&args[1]);
    let mut budget = downpour_scene::Budget::default();
    let weather = Weather::read(path, &mut budget).unwrap();
    let files = Roots::open(path, &[std::path::Path::new("/")]).unwrap();
    let loaded = load(&weather, &files, &mut budget).unwrap();
    let stage = Stage::new(&weather, &loaded, 0.0).unwrap();
    let o = PictureOptions { size: stage.size, grid, sky_rays: rays, seed, ..Default::default() };
    let frame = stage.viewpoint.frame(&stage.data, o.size, o.grid, o.sky_rays, o.seed).unwrap();
    let t = std::time::Instant::now();
    let picture = SceneView { data: &stage.data, frame: &frame }.picture();
    println!("{}", t.elapsed().as_millis());
    let rgb: Vec<[f32; 3]> = picture.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
    std::fs::write(&args[2], write_exr(o.size[0], o.size[1], &rgb).unwrap()).unwrap();
    let mut depth = std::fs::File::create(format!("{}.depth", args[2])).unwrap();
    use std::io::Write;
    for p in &picture { depth.write_all(&p[3].to_le_bytes()).unwrap(); }
}
