//! Every function-level and kernel-level case on the machine's adapter, each followed by its negative controls.
//!
//! No adapter is a failure, reported in one line; `DOWNPOUR_GPU_TESTS=no` shows the cases as ignored. The worst error of each case is
//! written to `target/parity/<adapter>.csv`.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::num::NonZero;
use std::process::ExitCode;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};

use downpour_gpu::{Gpu, GpuError};
use downpour_tests::broken::{BROKEN, BROKEN_KERNELS, Broken};
use downpour_tests::function::Run;
use downpour_tests::relay::Relay;
use downpour_tests::report::{self, Report};
use downpour_tests::{KernelCase, Tol, adapter, cases, control};
use libtest_mimic::{Arguments, Failed, Trial};

/// The most devices that cases run on beside each other.
const MAX_DEVICES: usize = 4;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let off = adapter::switched_off();
    let count = if off || arguments.list { 0 } else { device_count(&arguments) };
    let devices = match Devices::open(count) {
        Ok(devices) => Arc::new(devices),
        Err(error) => {
            eprintln!("{}", adapter::missing(&error));
            return ExitCode::FAILURE;
        }
    };
    let report = Arc::new(Report::default());

    let mut trials = vec![{
        let devices = Arc::clone(&devices);
        Trial::test("adapter", move || devices.take().map(|_| ())).with_ignored_flag(off)
    }];
    for case in cases::functions() {
        let (devices, report) = (Arc::clone(&devices), Arc::clone(&report));
        let name = format!("function::{}", case.function);
        let label = case.function;
        trials.push(
            Trial::test(name, move || {
                let device = devices.take()?;
                judge(label, &device.gpu, &case.tol, &report, |gpu| case.run(gpu))
            })
            .with_ignored_flag(off),
        );
    }
    for case in cases::kernels() {
        let (devices, report) = (Arc::clone(&devices), Arc::clone(&report));
        trials.push(
            Trial::test(format!("kernel::{}", case.name), move || {
                let device = devices.take()?;
                drop(device.relay.take_dispatched());
                judge(case.name, &device.gpu, &case.tol, &report, case.run)?;
                must_dispatch(&case, &device.relay)
            })
            .with_ignored_flag(off),
        );
    }

    for broken in BROKEN {
        let devices = Arc::clone(&devices);
        let name = format!("control::{} with {}", broken.function, broken.wrong);
        let control = move || must_fail(broken, &devices.take()?.gpu);
        trials.push(Trial::test(name, control).with_ignored_flag(off));
    }

    for (name, broken) in BROKEN_KERNELS {
        let devices = Arc::clone(&devices);
        let label = format!("control::{} with {}", broken.function, broken.wrong);
        let control = move || must_fail_in(name, broken, &devices.take()?.gpu);
        trials.push(Trial::test(label, control).with_ignored_flag(off));
    }

    // Cases of one kernel apart from each other: at the same time two devices would both compile it.
    trials.sort_by_key(|trial| hash_of(trial.name()));
    let conclusion = libtest_mimic::run(&arguments, trials);
    if let Some(name) = devices.adapter() {
        match report.write(&name) {
            Ok(Some(path)) => println!("worst errors on \"{name}\": {}", path.display()),
            Ok(None) => {}
            Err(error) => eprintln!("the report was not written: {error}"),
        }
    }
    conclusion.exit_code()
}

/// A number that is the same for the same text.
fn hash_of(text: &str) -> u64 {
    let mut hasher = DefaultHasher::new();
    text.hash(&mut hasher);
    hasher.finish()
}

/// As many devices as cases run beside each other: those of one device wait for each other.
fn device_count(arguments: &Arguments) -> usize {
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    arguments.test_threads.unwrap_or(cores).clamp(1, MAX_DEVICES)
}

/// A device of the adapter. Cases share what they compile, and are seen to dispatch the kernel that they are about.
struct Device {
    relay: Relay,
    gpu: Gpu,
}

/// The devices that cases run on, each for one case at a time.
struct Devices(Vec<Mutex<Device>>);

impl Devices {
    fn open(count: usize) -> Result<Self, GpuError> {
        let open = |_| {
            let (relay, gpu) = Relay::before(&adapter::open()?);
            Ok(Mutex::new(Device { relay, gpu }))
        };
        (0..count).map(open).collect::<Result<_, _>>().map(Self)
    }

    /// One that is free.
    fn take(&self) -> Result<MutexGuard<'_, Device>, Failed> {
        let free = self.0.iter().find_map(|device| match device.try_lock() {
            Ok(device) => Some(device),
            // A case that has panicked leaves its device as good as it was.
            Err(TryLockError::Poisoned(device)) => Some(device.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        });
        // More threads than devices wait for the first.
        let device = free
            .or_else(|| self.0.first().map(|device| device.lock().unwrap_or_else(PoisonError::into_inner)));
        device.ok_or_else(|| "no adapter was asked for".into())
    }

    /// Name of their adapter.
    fn adapter(&self) -> Option<String> {
        let device = self.0.first()?.lock().unwrap_or_else(PoisonError::into_inner);
        Some(device.gpu.adapter().name.clone())
    }
}

/// A broken shader has to be seen.
fn must_fail(broken: &Broken, gpu: &Gpu) -> Result<(), Failed> {
    let (case, wrong) = broken.shader(&cases::functions());
    match case.run_source(gpu, &wrong)?.compare(&case.tol).failure {
        Some(_) => Ok(()),
        None => Err(format!("{} passed with \"{}\"", broken.function, broken.wrong).into()),
    }
}

/// A broken function has to be seen by the kernel-level case of this name.
fn must_fail_in(name: &str, broken: &Broken, gpu: &Gpu) -> Result<(), Failed> {
    let case = cases::kernels().into_iter().find(|case| case.name == name).ok_or("there is no such case")?;
    if !case.kernel.source().contains(broken.right) {
        return Err(format!("\"{}\" is not in {}", broken.right, case.kernel.entry).into());
    }
    // A separate relay: other cases run beside this one.
    let (relay, gpu) = Relay::before(gpu);
    relay.swap(Some(broken.swap()));
    match (case.run)(&gpu)?.compare(&case.tol).failure {
        Some(_) => Ok(()),
        None => Err(format!("{name} passed with \"{}\"", broken.wrong).into()),
    }
}

/// The kernel that a case is about has to have run, with the constants that the case names.
fn must_dispatch(case: &KernelCase, relay: &Relay) -> Result<(), Failed> {
    let dispatched = relay.take_dispatched();
    if case.is_among(&dispatched) {
        return Ok(());
    }
    Err(format!("{} with {:?} was not dispatched, but {dispatched:?}", case.entry(), case.overrides).into())
}

fn judge(
    name: &str,
    gpu: &Gpu,
    tol: &Tol,
    report: &Report,
    run: impl Fn(&Gpu) -> Result<Run, GpuError>,
) -> Result<(), Failed> {
    let run = run(gpu)?;
    let comparison = run.compare(tol);
    report.note(name, &comparison, tol);
    if let Some(failure) = &comparison.failure {
        let details = match report::write_failure(name, &run) {
            Ok(path) => path.display().to_string(),
            Err(error) => format!("not written: {error}"),
        };
        let input = run.describe_call(comparison.worst_at);
        return Err(format!("{failure}\nworst at input {input}\nboth sides: {details}").into());
    }
    control::must_go_red(&run, tol).map_err(|error| format!("negative control: {error}").into())
}
