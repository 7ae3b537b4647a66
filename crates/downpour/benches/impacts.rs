//! Crowns of splashes and droplets that rebound of a picture of the street at 1920x1080: what the CPU does ahead of a device that finds
//! them, and `alone`, what it takes to find all drops without one.

use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use downpour::Source;
use downpour::scene::Budget;
use downpour::shower::{Shower, Still};
use downpour::trace::frame_scene::FrameScene;

fn impacts(c: &mut Criterion) {
    for name in ["day", "storm"] {
        let file = format!("../../assets/scenes/street/{name}.toml");
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        // Where the program was carried without the sources, from the project's folder.
        let path = if path.exists() { path } else { format!("assets/scenes/street/{name}.toml").into() };
        let mut source = Source::read(&path, &[], &mut Budget::default()).expect("a weather");
        source.weather.size = [1920, 1080];
        let frame_scene = FrameScene::new(&source.weather, &source.loaded, 0.0).expect("a frame's scene");
        let mut group = c.benchmark_group(format!("impacts {name}"));
        group.sample_size(10);
        let mut time_s = 0.0;
        let mut next_s = || {
            time_s += 1.0 / 60.0;
            time_s
        };
        for part in ["none", "splashes", "droplets", "both"] {
            let mut weather = source.weather.clone();
            weather.splashes.is_enabled = matches!(part, "splashes" | "both");
            if matches!(part, "none" | "splashes") {
                weather.rain.bounce.fraction = 0.0;
            }
            let shower = Shower::new(&weather).expect("a rain");
            let found =
                shower.view_at(&frame_scene, next_s(), 1 << 22).expect("a view").expect("closed form");
            println!("{name}, {part}: {} drops", found.droplets.len());
            group.bench_function(part, |b| b.iter(|| shower.view_at(&frame_scene, next_s(), 1 << 22)));
            if part == "both" {
                let mut alone = shower.clone();
                group.bench_function("alone", |b| {
                    b.iter(|| alone.at(&Still(&frame_scene), &frame_scene, next_s(), &mut |_, _| ()));
                });
            }
        }
        group.finish();
    }
}

criterion_group!(benches, impacts);
criterion_main!(benches);
