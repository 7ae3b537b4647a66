//! The front door: weather files in, frames out, errors as values.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod model;

use std::path::PathBuf;

use downpour::scene::Budget;
use downpour::scene::SceneError;
use downpour::shower::{MovingScenery, Shower};
use downpour::sim::field::VisibleDrops;
use downpour::trace::frame_scene::FrameScene;
use downpour::weather::{CameraPath, CameraPose};
use downpour::wind::Keyed;
use downpour::{Backend, Device, Renderer, RendererError, RendererOptions, Source};
use glam::DVec3;

/// A sky and nothing else.
const OPEN: &str = "
[rain]
rate_mm_h = 60
[sky]
zenith_color = [0.4, 0.45, 0.5]
[camera]
position_m = [0, 1.6, 0]
fov_deg = 30
[output]
size = [48, 32]
";

/// A window in the rain.
const WINDOW: &str = "
[glass]
distance_m = 0.4
size_m = [0.4, 0.3]
cell_mm = 5
speed_m_s = 5
before_s = 2
";

/// A weather file in a folder of its own.
fn file(text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

fn opened(text: &str) -> Renderer {
    let (_folder, path) = file(text);
    Renderer::open(path, Backend::Cpu).unwrap()
}

/// Bits of a frame.
fn bits(renderer: &mut Renderer, time_s: f64) -> Vec<[u32; 3]> {
    renderer.frame(time_s).unwrap().radiance().iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

/// Frames that are finished late, on another thread and in another order, are those that are made one by one; the first one, which
/// sets the exposure, is there at once.
#[test]
fn frames_may_be_finished_while_others_are_begun() {
    let times = [0.0, 0.04, 0.08];
    let mut one_by_one = opened(OPEN);
    let expected = times.map(|time_s| bits(&mut one_by_one, time_s));
    let mut renderer = opened(OPEN);
    let begun = times.map(|time_s| renderer.begin_frame(time_s).unwrap());
    assert_eq!(renderer.exposure(), one_by_one.exposure());
    let finish = |frame: downpour::PendingFrame| {
        let frame = frame.finish().unwrap();
        let radiance: Vec<[u32; 3]> = frame.radiance().iter().map(|pixel| pixel.map(f32::to_bits)).collect();
        (frame.time_s, frame.exposure, radiance)
    };
    let mut finished: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = begun.into_iter().rev().map(|frame| scope.spawn(|| finish(frame))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    finished.reverse();
    for ((frame, time_s), expected) in finished.into_iter().zip(times).zip(expected) {
        assert_eq!((frame.0, Some(frame.1)), (time_s, one_by_one.exposure()));
        assert!(frame.2 == expected, "frame of {time_s} s");
    }
    assert!(renderer.begin_frame(f64::NAN).is_err());
}

#[test]
fn a_weather_file_becomes_a_picture() {
    let mut renderer = opened(OPEN);
    let frame = renderer.frame(1.5).unwrap();
    assert_eq!((frame.size(), frame.time_s), ([48, 32], 1.5));
    assert!(frame.drops.simulated > 100 && frame.medium.extinction() > 0.0);
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.png", "a.exr"] {
        frame.save(folder.path().join(name)).unwrap();
        assert!(std::fs::metadata(folder.path().join(name)).unwrap().len() > 100);
    }
    let error = frame.save(folder.path().join("a.gif")).unwrap_err();
    assert!(error.to_string().contains("allowed: .png or .exr"), "{error}");
    let error = frame.save(folder.path().join("none/a.png")).unwrap_err();
    assert!(matches!(error, RendererError::Write { .. }), "{error}");
}

/// Names in a folder, sorted.
fn names(folder: &std::path::Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// A clip that ends in the middle: frames that were begun and are dropped write nothing, and those that were saved are whole.
#[test]
fn a_clip_that_is_dropped_leaves_nothing_half_written() {
    let folder = tempfile::tempdir().unwrap();
    let begin = || {
        let mut renderer = opened(OPEN);
        let frames = [0.0, 0.04, 0.08].map(|time_s| renderer.begin_frame(time_s).unwrap());
        (renderer, frames)
    };
    let (renderer, [first, second, third]) = begin();
    drop(second);
    drop(renderer);
    drop((first, third));
    assert!(names(folder.path()).is_empty());

    let (renderer, [first, second, third]) = begin();
    drop(renderer);
    let saved = first.finish().unwrap();
    let path = folder.path().join("0000.png");
    saved.save(&path).unwrap();
    drop((second, third));
    assert_eq!(names(folder.path()), ["0000.png"]);
    assert_eq!(std::fs::read(&path).unwrap(), saved.png().unwrap());
}

/// A frame is written beside its name and renamed: whoever reads the old file reads all of it, and a name that cannot be had costs nothing.
#[test]
fn a_file_is_replaced_whole() {
    let frame = opened(OPEN).frame(0.0).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    std::fs::write(&path, "of before").unwrap();
    let mut reader = std::fs::File::open(&path).unwrap();
    frame.save(&path).unwrap();
    let mut read = String::new();
    std::io::Read::read_to_string(&mut reader, &mut read).unwrap();
    assert_eq!(read, "of before");
    assert_eq!(std::fs::read(&path).unwrap(), frame.png().unwrap());
    std::fs::create_dir(folder.path().join("folder.png")).unwrap();
    let error = frame.save(folder.path().join("folder.png")).unwrap_err();
    assert!(matches!(error, RendererError::Write { .. }), "{error}");
    #[cfg(unix)]
    {
        let link = folder.path().join("link.png");
        std::os::unix::fs::symlink(&path, &link).unwrap();
        std::fs::write(&path, "of before").unwrap();
        frame.save(&link).unwrap();
        assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(std::fs::read(&path).unwrap(), frame.png().unwrap());
        std::fs::remove_file(&link).unwrap();
    }
    assert_eq!(names(folder.path()), ["a.png", "folder.png"]);
}

/// A device that is lost between frames, or while a frame is on it.
#[cfg(feature = "wgpu")]
#[test]
fn a_lost_device_is_an_error() {
    use downpour::gpu::{AdapterChoice, Gpu};
    if std::env::var("DOWNPOUR_GPU_TESTS").is_ok_and(|value| value == "no") {
        return;
    }
    let (_folder, path) = file(OPEN);
    let gpu = Gpu::open(&AdapterChoice::Auto).unwrap();
    let source = Source::read(&path, &[], &mut Budget::default()).unwrap();
    // A device that is lost is not one for which the frame is too much: the CPU does not go on.
    let device = Device::gpu(gpu.clone(), true);
    let mut renderer =
        Renderer::new(source.weather, source.loaded, RendererOptions::default(), device).unwrap();
    renderer.frame(0.0).unwrap();
    let pending = renderer.begin_frame(0.04).unwrap();
    gpu.device().destroy();
    let lost = |error: &RendererError| {
        assert!(error.gpu().is_some() && !error.is_too_much_for_gpu(), "{error:?}");
    };
    // The frame that was on its way may be done already.
    let _ = pending.finish().map_err(|error| lost(&error));
    for time_s in [0.08, 0.12] {
        lost(&renderer.frame(time_s).map(|_| ()).unwrap_err());
    }
    lost(&renderer.begin_display(0.2).map(|_| ()).unwrap_err());
}

/// The picture of a time is the same whatever was asked before, with water that holds what it was rained on too.
#[test]
fn frames_do_not_depend_on_those_before() {
    for text in [OPEN.to_owned(), format!("{OPEN}{WINDOW}")] {
        let mut renderer = opened(&text);
        let [late, early] = [0.4, 0.1].map(|time| bits(&mut renderer, time));
        let mut fresh = opened(&text);
        assert!(bits(&mut fresh, 0.1) == early && bits(&mut fresh, 0.4) == late);
        assert!(early != late);
        let mut passing = opened(&text);
        passing.pass(0.1).unwrap();
        assert!(bits(&mut passing, 0.4) == late);
    }
}

/// Surfaces that stand still before a still eye get wet as the rain goes on: a later frame of a clip is the frame of its time alone.
#[test]
fn surfaces_get_wetter_in_a_clip() {
    let text = OPEN
        .replace("[0, 1.6, 0]", "[0, 1.6, 0]\npitch_deg = -20")
        .replace("[sky]", "[wetness]\nrained_mm = 0\n[sky]");
    let (folder, path) = file(&format!("{text}[[model]]\nfile = 'floor.gltf'\n"));
    floor(&folder);
    let clean = |times: &[f64]| {
        let mut renderer = Renderer::open(&path, Backend::Cpu).unwrap();
        let at = |&time| renderer.frame(time).unwrap().picture.clean[48 * 31 + 24];
        times.iter().map(at).last().unwrap()
    };
    let [dry, wet] = [0.0, 600.0].map(|time| clean(&[time]));
    assert!(dry != wet && clean(&[0.0, 600.0]) == wet);
}

/// Rain that goes step by step shows at a time the same drops whatever the frame rate, the frames before it, and the first frame: its
/// steps count from time 0, and what it holds is asked of the camera at time 0.
#[test]
fn stepped_rain_is_that_of_the_time_at_any_frame_rate() {
    let text = OPEN
        .replace("[rain]", "[rain]\nvolume = \"view\"")
        .replace("60", "300")
        .replace("[48, 32]", "[96, 64]");
    is_that_of_the_time("calm air", |times| {
        let mut renderer = opened(&text);
        times.iter().map(|&time| renderer.frame(time).unwrap().drops).last().unwrap()
    });
}

/// So it is in turbulence, over a floor from which droplets rebound, and before an eye that moves and turns.
#[test]
fn stepped_rain_of_a_scene_is_that_of_the_time() {
    let text = OPEN
        .replace("[rain]", "[rain]\nvolume = \"view\"")
        .replace("60", "300")
        .replace("[48, 32]", "[144, 96]");
    let turbulence = format!(
        "{text}[turbulence]\nspeed_m_s = 1.5\nlength_m = 2\n[wind_field]\nsize = [20, 20, 20]\nbox_m = [20, 20, 20]\n"
    );
    let keys = "position_m = [[0, [0, 1.6, 0]], [2, [4, 1.6, -6]]]\nyaw_deg = [[0, 0], [2, 120]]";
    let moving = text.replace("position_m = [0, 1.6, 0]", keys);
    let low = text.replace("position_m = [0, 1.6, 0]", "position_m = [0, 0.4, 0]\npitch_deg = -15");
    let low = format!("{low}[[model]]\nfile = 'floor.gltf'\n");
    for (name, text) in [("turbulence", turbulence), ("a moving eye", moving), ("a floor", low)] {
        let (folder, path) = file(&text);
        floor(&folder);
        let source = Source::read(&path, &[], &mut Budget::default()).unwrap();
        let first = FrameScene::new(&source.weather, &source.loaded, 0.0).unwrap();
        let scenery = MovingScenery { frame_scene: &first, weather: &source.weather, loaded: &source.loaded };
        is_that_of_the_time(name, |times| {
            let mut shower = Shower::new(&source.weather).unwrap();
            let mut at = |time_s: f64| {
                let frame_scene = FrameScene::new(&source.weather, &source.loaded, time_s).unwrap();
                shower.at(&scenery, &frame_scene, time_s, &mut |_, _| ()).unwrap()
            };
            times.iter().map(|&time| at(time)).last().unwrap()
        });
    }
}

/// A floor of 40 x 40 m at height 0 as a model beside a weather file.
fn floor(folder: &tempfile::TempDir) {
    let corners = [[-20.0, 0.0, -20.0], [-20.0, 0.0, 20.0], [20.0, 0.0, 20.0], [20.0, 0.0, -20.0]];
    model::write(folder.path(), &corners, &[0, 1, 2, 0, 2, 3]).unwrap();
}

/// Checks the drops of the last of some times that a function finds.
fn is_that_of_the_time(name: &str, found: impl Fn(&[f64]) -> VisibleDrops) {
    let drops = |times: &[f64]| {
        let VisibleDrops { mut drops, resolved, .. } = found(times);
        drops.sort_by_key(|drop| drop.id);
        (resolved, drops)
    };
    let alone = drops(&[0.5]);
    println!("{name}: {} drops", alone.1.len());
    assert!(alone.1.len() > 10, "{name}: {} drops", alone.1.len());
    for rate in [8.0, 24.0, 50.0] {
        let clip: Vec<f64> = (0..=(0.5 * rate) as u32).map(|frame| f64::from(frame) / rate).collect();
        assert!(drops(&clip) == alone, "{name}, {rate} frames a second");
    }
    assert!(drops(&[0.9, 0.5]) == alone, "{name}, back");
    assert!(drops(&[0.48]) != alone, "{name}, control");
}

/// All frames have the exposure of the first, unless it is set.
#[test]
fn one_exposure_for_all_frames() {
    let mut renderer = opened(OPEN);
    assert_eq!(renderer.exposure(), None);
    let first = renderer.frame(0.0).unwrap().exposure;
    assert_eq!(renderer.frame(1.0).unwrap().exposure.to_bits(), first.to_bits());
    renderer.set_exposure(Some(2.0 * first));
    assert_eq!(renderer.frame(1.0).unwrap().exposure.to_bits(), (2.0 * first).to_bits());
}

#[test]
fn what_cannot_be_is_an_error() {
    let error = Renderer::open("there/is/none.toml", Backend::Cpu).unwrap_err();
    assert!(matches!(error, RendererError::Scene(SceneError::Unreadable(_))), "{error}");
    let error = Renderer::open("a.txt", Backend::Cpu).unwrap_err();
    assert!(matches!(error, RendererError::Name { .. }), "{error}");
    let (_folder, path) = file(OPEN);
    let with_size = |size: [u32; 2]| {
        let mut source = Source::read(&path, &[], &mut Budget::default()).unwrap();
        source.weather.size = size;
        Renderer::new(source.weather, source.loaded, RendererOptions::default(), Device::cpu())
    };
    for size in [[0, 32], [48, 16_385], [u32::MAX, u32::MAX]] {
        let error = with_size(size).unwrap_err();
        assert!(error.to_string().contains("allowed"), "{error}");
    }
    let mut renderer = with_size([16, 16]).unwrap();
    for time in [f64::NAN, f64::INFINITY, -2.0e6, 2.0e6] {
        assert!(matches!(renderer.frame(time).unwrap_err(), RendererError::Time { .. }));
        assert!(matches!(renderer.pass(time).unwrap_err(), RendererError::Time { .. }));
    }
    // Nothing is lost by an error.
    assert_eq!(renderer.frame(0.0).unwrap().size(), [16, 16]);
    let atlas = format!("{OPEN}\n[streaks]\ncolor = \"atlas\"\n");
    let (_folder, path) = file(&atlas);
    assert!(matches!(Renderer::open(path, Backend::Cpu).unwrap_err(), RendererError::NoAtlas));
}

/// A camera that is set from code is where a weather file would have it.
#[test]
fn a_camera_moves() {
    let keys = "position_m = [[0, [0, 1.6, 0]], [2, [4, 1.6, 0]]]\nlook_at_m = [0, 2, -30]";
    let mut of_file = opened(&OPEN.replace("position_m = [0, 1.6, 0]", keys));
    let mut of_code = opened(OPEN);
    let way = [(0.0, DVec3::new(0.0, 1.6, 0.0)), (2.0, DVec3::new(4.0, 1.6, 0.0))];
    let path = CameraPath::looking_at(Keyed::new(way.to_vec()).unwrap(), DVec3::new(0.0, 2.0, -30.0));
    of_code.set_camera(path.clone()).unwrap();
    for time in [0.0, 1.0] {
        assert!(bits(&mut of_file, time) == bits(&mut of_code, time), "{time}");
    }
    assert_eq!(path.at(1.0).position, DVec3::new(2.0, 1.6, 0.0));
    // The rain passes by the eye, 2 m/s.
    let standing = CameraPath::from(path.at(1.0));
    let mut still = opened(OPEN);
    still.set_camera(standing).unwrap();
    assert!(bits(&mut still, 1.0) != bits(&mut of_code, 1.0));
    let far = CameraPose { position: DVec3::new(5000.0, 0.0, 0.0), forward: DVec3::X };
    let error = of_code.set_camera(far).unwrap_err();
    assert!(error.to_string().contains("5000 m from where the scene was set"), "{error}");
    assert!(bits(&mut of_file, 0.5) == bits(&mut of_code, 0.5), "the camera is the one before");
}
