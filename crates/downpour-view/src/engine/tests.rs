//! The thread: newest first, faults as answers, devices that are lost.

use downpour::gpu::{Gpu, GpuOptions};
use downpour::{Backend, Device};

use super::*;

fn request(text: &str, folder: &std::path::Path, revision: u64) -> Request {
    Request {
        weather: Arc::new(Weather::parse("test.toml", text).unwrap()),
        revision,
        place: folder.join("test.toml"),
        asset_roots: Vec::new(),
        eye: None,
        time_s: 0.0,
        size: [32, 18],
        samples: 1,
        meters: false,
        lists_drops: false,
    }
}

const RAIN: &str = "[rain]\nrate_mm_h = 50\n[camera]\nposition_m = [0, 2, 0]\nlook_at_m = [0, 2, -9]\n";

/// From a change to the picture that shows it there are two pictures at most, however many questions there were.
#[test]
fn the_newest_question_is_answered_within_two_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let choice = DeviceChoice { backend: Backend::Cpu, adapter: None };
    let engine = Engine::start(choice).unwrap();
    for revision in 1..=20 {
        engine.ask(request(&RAIN.replace("50", &format!("{}", 10 * revision)), folder.path(), revision));
    }
    let mut seen = Vec::new();
    while seen.last() != Some(&20) {
        assert!(seen.len() < 2, "{seen:?}");
        match engine.take() {
            Some(answer) => seen.push(answer.unwrap().revision),
            None => std::thread::yield_now(),
        }
    }
    assert!(engine.wait(Duration::from_secs(60)) && !engine.is_busy());
}

#[test]
fn faults_are_answers_and_the_next_question_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let choice = DeviceChoice { backend: Backend::Cpu, adapter: None };
    let engine = Engine::start(choice).unwrap();
    let ask = |text: &str| {
        engine.ask(request(text, folder.path(), 1));
        assert!(engine.wait(Duration::from_secs(60)));
        engine.take().unwrap()
    };
    // The scene was deleted while it was open.
    let gone = ask(&format!("{RAIN}[[model]]\nfile = \"gone.glb\"\n")).unwrap_err();
    assert!(gone.message.contains("gone.glb") && !gone.is_fatal, "{}", gone.message);
    let drawn = ask(RAIN).unwrap();
    assert_eq!((drawn.size, drawn.pixels.len()), ([32, 18], 32 * 18));
    assert!((drawn.view.eye.y - 2.0).abs() < 1.0e-9);
    let no_adapter =
        Engine::start(DeviceChoice { backend: Backend::Gpu, adapter: Some("no such".into()) }).unwrap();
    no_adapter.ask(request(RAIN, folder.path(), 1));
    assert!(no_adapter.wait(Duration::from_secs(60)));
    let fault = no_adapter.take().unwrap().unwrap_err();
    assert!(fault.message.contains("no such"), "{}", fault.message);
}

/// A device that is lost between pictures or under one is opened again, and the picture is that of a device which was not lost.
#[test]
fn a_lost_device_is_opened_again() {
    if std::env::var("DOWNPOUR_GPU_TESTS").is_ok_and(|value| value == "no") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let choice = DeviceChoice { backend: Backend::Gpu, adapter: None };
    let request = request(RAIN, folder.path(), 1);
    let whole = Machine::new(choice.clone()).draw(0, &request).unwrap();
    let lost_after = |submissions: Option<u64>| {
        Gpu::open_with(&GpuOptions { lose_after_submissions: submissions, ..GpuOptions::default() }).unwrap()
    };
    for submissions in [1, 2, 4] {
        let mut machine = Machine::new(choice.clone());
        machine.set_device(Device::gpu(lost_after(Some(submissions)), false));
        let drawn = machine.draw(1, &request).unwrap();
        assert!(drawn.pixels == whole.pixels, "lost after {submissions} submissions");
    }
    let mut machine = Machine::new(choice);
    let gpu = lost_after(None);
    machine.set_device(Device::gpu(gpu.clone(), false));
    assert!(machine.draw(1, &request).unwrap().pixels == whole.pixels);
    gpu.device().destroy();
    assert!(machine.draw(2, &request).unwrap().pixels == whole.pixels);
    // One that does not come back is the end of pictures: the window saves what was made.
    let adapter = Some("no such".to_owned());
    let mut machine = Machine::new(DeviceChoice { backend: Backend::Gpu, adapter });
    machine.set_device(Device::gpu(lost_after(Some(1)), false));
    let fault = machine.draw(3, &request).unwrap_err();
    assert!(fault.is_fatal && fault.message.contains("no such"), "{fault:?}");
}
