//! Every function-level and kernel-level case on the machine's adapter, each followed by its negative controls.
//!
//! No adapter is a failure, reported in one line; `DOWNPOUR_GPU_TESTS=no` shows the cases as ignored. The worst error of each case is
//! written to `target/parity/<adapter>.csv`.

use std::process::ExitCode;
use std::sync::Arc;

use downpour_gpu::{Gpu, GpuError};
use downpour_tests::broken::{BROKEN, BROKEN_KERNELS, Broken};
use downpour_tests::function::Run;
use downpour_tests::relay::Relay;
use downpour_tests::report::{self, Report};
use downpour_tests::{KernelCase, Tol, adapter, cases, control};
use libtest_mimic::{Arguments, Failed, Trial};

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let off = adapter::switched_off();
    let gpu = if off || arguments.list { None } else { Some(adapter::open()) };
    if let Some(Err(error)) = &gpu {
        eprintln!("{}", adapter::missing(error));
        return ExitCode::FAILURE;
    }
    // Cases share what they compile, and are seen to dispatch the kernel that they are about.
    let relay = gpu.as_ref().and_then(|gpu| gpu.as_ref().ok()).map(Relay::before);
    let (relay, gpu) = match relay {
        Some((relay, gpu)) => (relay, Some(Ok(gpu))),
        None => (Relay::default(), gpu),
    };
    let gpu = Arc::new(gpu);
    let report = Arc::new(Report::default());

    let mut trials = vec![{
        let gpu = Arc::clone(&gpu);
        Trial::test("adapter", move || open(&gpu).map(|_| ())).with_ignored_flag(off)
    }];
    for case in cases::functions() {
        let (gpu, report) = (Arc::clone(&gpu), Arc::clone(&report));
        let name = format!("function::{}", case.function);
        let label = case.function;
        trials.push(
            Trial::test(name, move || judge(label, open(&gpu)?, &case.tol, &report, |gpu| case.run(gpu)))
                .with_ignored_flag(off),
        );
    }
    for case in cases::kernels() {
        let (gpu, report, relay) = (Arc::clone(&gpu), Arc::clone(&report), relay.clone());
        trials.push(
            Trial::test(format!("kernel::{}", case.name), move || {
                drop(relay.take_dispatched());
                judge(case.name, open(&gpu)?, &case.tol, &report, case.run)?;
                must_dispatch(&case, &relay)
            })
            .with_ignored_flag(off),
        );
    }

    for broken in BROKEN {
        let gpu = Arc::clone(&gpu);
        let name = format!("control::{} with {}", broken.function, broken.wrong);
        trials.push(Trial::test(name, move || must_fail(broken, open(&gpu)?)).with_ignored_flag(off));
    }

    for (name, broken) in BROKEN_KERNELS {
        let gpu = Arc::clone(&gpu);
        let label = format!("control::{} with {}", broken.function, broken.wrong);
        trials
            .push(Trial::test(label, move || must_fail_in(name, broken, open(&gpu)?)).with_ignored_flag(off));
    }

    let conclusion = libtest_mimic::run(&arguments, trials);
    if let Some(Ok(gpu)) = gpu.as_ref() {
        match report.write(&gpu.adapter().name) {
            Ok(Some(path)) => println!("worst errors on \"{}\": {}", gpu.adapter().name, path.display()),
            Ok(None) => {}
            Err(error) => eprintln!("the report was not written: {error}"),
        }
    }
    conclusion.exit_code()
}

fn open(gpu: &Option<Result<Gpu, GpuError>>) -> Result<&Gpu, Failed> {
    match gpu {
        Some(Ok(gpu)) => Ok(gpu),
        Some(Err(error)) => Err(error.to_string().into()),
        None => Err("no adapter was asked for".into()),
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
