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
    assert_eq!((drawn.size, drawn.image.pixels.len()), ([32, 18], 32 * 18));
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
    let whole = Machine::new(choice.clone()).draw(0, request.clone()).unwrap();
    let lost_after = |submissions: Option<u64>| {
        Gpu::open_with(&GpuOptions { lose_after_submissions: submissions, ..GpuOptions::default() }).unwrap()
    };
    for submissions in [1, 2, 4] {
        let mut machine = Machine::new(choice.clone());
        machine.set_device(Device::gpu(lost_after(Some(submissions)), false));
        let drawn = machine.draw(1, request.clone()).unwrap();
        assert!(drawn.image == whole.image, "lost after {submissions} submissions");
    }
    let mut machine = Machine::new(choice);
    let gpu = lost_after(None);
    machine.set_device(Device::gpu(gpu.clone(), false));
    assert!(machine.draw(1, request.clone()).unwrap().image == whole.image);
    gpu.device().destroy();
    assert!(machine.draw(2, request.clone()).unwrap().image == whole.image);
    // Two pictures that were under way together lose one device together.
    let mut machine = Machine::new(DeviceChoice { backend: Backend::Gpu, adapter: None });
    machine.set_device(Device::gpu(lost_after(Some(2)), false));
    let [first, second] = [1, 2].map(|number| machine.begin(number, request.clone()));
    assert!(machine.finish(first).unwrap().image == whole.image);
    assert!(machine.finish(second).is_ok());
    assert_eq!(machine.losses(), 1);
    // One that does not come back is the end of pictures: the window saves what was made.
    let adapter = Some("no such".to_owned());
    let mut machine = Machine::new(DeviceChoice { backend: Backend::Gpu, adapter });
    machine.set_device(Device::gpu(lost_after(Some(1)), false));
    let fault = machine.draw(3, request).unwrap_err();
    assert!(fault.is_fatal && fault.message.contains("no such"), "{fault:?}");
}

/// A worker on the CPU with its first picture.
fn worker(first: &Request) -> Worker {
    let machine = Machine::new(DeviceChoice { backend: Backend::Cpu, adapter: None });
    let mut worker = Worker::new(machine);
    assert!(worker.step(Some((1, first.clone()))).1.is_none());
    assert!(worker.step(None).1.unwrap().1.is_ok());
    worker
}

/// Steps after a fast picture; returns the number of the question that was left, and that of the picture.
fn step(worker: &mut Worker, number: u64, request: Request) -> (Option<u64>, Option<u64>) {
    worker.last_ms = Some([2.0, 10.0]);
    let (left, answer) = worker.step(Some((number, request)));
    numbers(left, answer)
}

fn numbers(left: Option<Asked>, answer: Option<(u64, Answer)>) -> (Option<u64>, Option<u64>) {
    let answer = answer.map(|(number, answer)| {
        let drawn = answer.unwrap();
        assert_eq!(drawn.number, number);
        number
    });
    (left.map(|(number, _)| number), answer)
}

/// While only the clock goes on, a picture is begun before the one before it is at hand, and what is shown is the same.
#[test]
fn pictures_of_a_running_clock_overlap() {
    let folder = tempfile::tempdir().unwrap();
    let base = request(RAIN, folder.path(), 1);
    let at = |frame: u64| Request { time_s: frame as f64 / 30.0, ..base.clone() };
    let mut worker = worker(&base);
    assert_eq!(step(&mut worker, 2, at(2)), (None, None));
    assert_eq!(step(&mut worker, 3, at(3)), (None, Some(2)));
    assert_eq!(step(&mut worker, 4, at(4)), (None, Some(3)));
    let (_, answer) = worker.step(None);
    let drawn = answer.unwrap().1.unwrap();
    let mut alone = Machine::new(worker.machine.choice().clone());
    let whole = [0, 2, 3, 4].map(|frame| alone.draw(frame, at(frame)).unwrap());
    let whole = &whole[3];
    assert!(drawn.image == whole.image && drawn.time_s == at(4).time_s);
    // A slow picture is not begun ahead: its time would be gone when it is shown.
    worker.step(Some((5, at(5))));
    worker.last_ms = Some([2.0, 2.0 * MAX_AHEAD_MS]);
    let (left, answer) = worker.step(Some((6, at(6))));
    assert_eq!(numbers(left, answer), (Some(6), Some(5)));
    // Nor is one whose driver draws in the thread that asks.
    worker.step(Some((7, at(7))));
    worker.last_ms = Some([9.0, 10.0]);
    let (left, answer) = worker.step(Some((8, at(8))));
    assert_eq!(numbers(left, answer), (Some(8), Some(7)));
}

/// A change by hand is in the second picture after it at the latest, also if one of the old state was begun ahead.
#[test]
fn a_change_does_not_wait_for_pictures_that_were_begun_ahead() {
    let folder = tempfile::tempdir().unwrap();
    let base = request(RAIN, folder.path(), 1);
    let at = |frame: u64| Request { time_s: frame as f64 / 30.0, ..base.clone() };
    let changed = request(&RAIN.replace("50", "90"), folder.path(), 2);
    let mut worker = worker(&base);
    worker.step(Some((2, at(2))));
    // The change comes here: 2 is shown, 3 is not.
    assert_eq!(step(&mut worker, 3, at(3)), (None, Some(2)));
    assert_eq!(step(&mut worker, 4, changed.clone()), (None, None));
    let (_, answer) = worker.step(Some((5, Request { revision: 3, ..changed })));
    let (number, drawn) = answer.unwrap();
    assert_eq!((number, drawn.unwrap().revision), (4, 2));
}
