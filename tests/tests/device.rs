//! Tests of what the GPU layer promises of devices: typed errors, limits checked first, loss seen before anything is
//! handed out, a caller's handlers left alone.

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use downpour_drop::DropShape;
use downpour_gpu::{
    AdapterChoice, BufferPool, BufferSource as _, ComputeKernel, FramePasses, Gpu, GpuError, GpuOptions,
    LimitSet, ReadbackPool, wgpu,
};
use downpour_mask::gpu::{GpuMaskError, GpuTracer};
use downpour_mask::{Mask, MaskOptions};
use downpour_tests::adapter;
use libtest_mimic::{Arguments, Failed, Trial};

type Outcome = Result<(), Failed>;
type Test = (&'static str, fn() -> Outcome);

fn main() -> ExitCode {
    let (arguments, off) = (Arguments::from_args(), adapter::switched_off());
    if !off
        && !arguments.list
        && let Err(error) = adapter::open()
    {
        eprintln!("{}", adapter::missing(&error));
        return ExitCode::FAILURE;
    }
    let tests: [Test; 14] = [
        ("what_is_written_is_read", what_is_written_is_read),
        ("a_readback_is_of_the_time_when_it_began", a_readback_is_of_the_time_when_it_began),
        ("passes_of_a_frame_have_times", passes_of_a_frame_have_times),
        ("a_pool_keeps_buffers_and_bindings", a_pool_keeps_buffers_and_bindings),
        ("limits_are_checked_first", limits_are_checked_first),
        ("a_lost_device_gives_nothing", a_lost_device_gives_nothing),
        ("loss_is_seen_at_any_submission", loss_is_seen_at_any_submission),
        ("a_callers_handlers_stay", a_callers_handlers_stay),
        ("a_callers_lost_device_is_seen", a_callers_lost_device_is_seen),
        ("a_device_that_does_not_finish_is_hung", a_device_that_does_not_finish_is_hung),
        ("threads_share_a_device", threads_share_a_device),
        ("an_unknown_adapter_is_told_with_those_there_are", an_unknown_adapter_is_told_with_those_there_are),
        ("passes_are_timed", passes_are_timed),
        ("webgpu_limits_are_enough", webgpu_limits_are_enough),
    ];
    let trials =
        tests.into_iter().map(|(name, test)| Trial::test(name, test).with_ignored_flag(off)).collect();
    libtest_mimic::run(&arguments, trials).exit_code()
}

fn check(holds: bool, what: impl Into<String>) -> Outcome {
    if holds { Ok(()) } else { Err(what.into().into()) }
}

fn options() -> GpuOptions {
    let adapter = match std::env::var(adapter::ADAPTER) {
        Ok(name) if !name.is_empty() => AdapterChoice::Named(name),
        _ => AdapterChoice::Auto,
    };
    GpuOptions { adapter, ..GpuOptions::default() }
}

fn mask_on(gpu: &Gpu, size: u32) -> Result<Mask, GpuMaskError> {
    let shape = DropShape::new(2.0e-3).expect("2 mm is a drop");
    GpuTracer::new(gpu)?.trace_drop(&shape, &MaskOptions { size, ..MaskOptions::default() })
}

fn what_is_written_is_read() -> Outcome {
    let gpu = adapter::open()?;
    for n in [1usize, 2, 3, 5, 64, 1000] {
        let bytes: Vec<u8> = (0..n).map(|i| i as u8).collect();
        let read = gpu.read::<u8>(&gpu.storage_buffer("bytes", &bytes)?)?;
        check(read[..n] == bytes, format!("{n} bytes"))?;
        check(read.len() == n.next_multiple_of(4) && read[n..].iter().all(|&b| b == 0), "padding is zero")?;
    }
    let empty = gpu.storage_buffer::<f32>("nothing", &[])?;
    check(gpu.read::<f32>(&empty)?.len() == 1, "an empty buffer has the smallest size there is")
}

/// Buffers that are written again after a readback was begun, and staging buffers that are used again, on other threads.
fn a_readback_is_of_the_time_when_it_began() -> Outcome {
    let gpu = adapter::open()?;
    let pool = ReadbackPool::default();
    let (a, b) = (gpu.storage_buffer("a", &[0u32; 1000])?, gpu.storage_buffer("b", &[0u32; 7])?);
    let mut begun = Vec::new();
    for k in 0..5u32 {
        gpu.queue().write_buffer(&a, 0, bytemuck::cast_slice(&[k; 1000]));
        gpu.queue().write_buffer(&b, 0, bytemuck::cast_slice(&[100 + k; 7]));
        begun.push((k, pool.begin(&gpu, &[&a, &b])?));
        if k == 2 {
            let (_, mut first) = begun.remove(0);
            check(first.take::<u32>(0)? == [0; 1000] && first.take::<u32>(1)? == [100; 7], "the first")?;
        }
    }
    let readers = begun.into_iter().map(|(k, mut read)| {
        std::thread::spawn(move || -> Result<(), String> {
            let (b, a) = (read.take::<u32>(1), read.take::<u32>(0));
            let (a, b) = (a.map_err(|error| error.to_string())?, b.map_err(|error| error.to_string())?);
            if a != [k; 1000] || b != [100 + k; 7] {
                return Err(format!("readback {k}: {} and {}", a[0], b[0]));
            }
            match (read.take::<u32>(0), read.take::<u32>(2)) {
                (Err(GpuError::Refused { .. }), Err(GpuError::Refused { .. })) => Ok(()),
                other => Err(format!("{other:?}")),
            }
        })
    });
    for reader in readers.collect::<Vec<_>>() {
        reader.join().map_err(|_| "a reader panicked")??;
    }
    Ok(())
}

/// Each pass has its name and a time, in order, whether the device has a clock or the host waits; passes beyond the room are waited for.
fn passes_of_a_frame_have_times() -> Outcome {
    let gpu = adapter::open()?;
    let kernel = ComputeKernel::from_source(&gpu, "main", COUNT, &[])?;
    let counts = gpu.storage_buffer("counts", &[0u32; 256])?;
    let bound = kernel.bind(&gpu, &[&counts])?;
    let one = kernel.dispatch(&bound, [4, 1, 1]);
    let mut passes = FramePasses::new(&gpu, 2)?;
    passes.host("host", || ());
    passes.run("first", &[one, one])?;
    passes.run_each("each", &vec![one; 300])?;
    passes.run("beyond", &[one])?;
    let (times, ticks) = passes.end()?;
    let ticks = ticks.map(|ticks| gpu.read::<u64>(&ticks)).transpose()?.unwrap_or_default();
    let times = times.read(&ticks);
    let names: Vec<&str> = times.iter().map(|(name, _)| *name).collect();
    check(names == ["host", "first", "each", "beyond"], format!("{names:?}"))?;
    let whole = times.iter().all(|(_, ms)| ms.is_finite() && (0.0..1.0e4).contains(ms));
    check(whole && times[2].1 > 0.0, format!("{times:?}"))?;
    check(gpu.read::<u32>(&counts)? == [303; 256], "each dispatch ran once")
}

/// A pool gives a frame the buffers and the bindings of the frame before, and forgets bindings that no frame has asked for.
fn a_pool_keeps_buffers_and_bindings() -> Outcome {
    let gpu = adapter::open()?;
    let kernel = ComputeKernel::from_source(&gpu, "main", COUNT, &[])?;
    let pool = BufferPool::new(&gpu);
    let frame = |label| -> Result<(wgpu::Buffer, wgpu::BindGroup), GpuError> {
        pool.begin_frame();
        let counts = pool.storage(label, &[0u32; 256])?;
        let bound = kernel.bind(&pool, &[&counts])?;
        Ok((counts, bound))
    };
    let (first, other) = (frame("counts")?, frame("other")?);
    check(first != other, "other buffers have other bindings")?;
    check(frame("counts")? == first, "the frame before last is known")?;
    let anew = ComputeKernel::from_source(&gpu, "main", COUNT, &[])?.bind(&pool, &[&first.0])?;
    check(anew != first.1, "another pipeline has other bindings")?;
    for _ in 0..10 {
        frame("other")?;
    }
    let (counts, bound) = frame("counts")?;
    check(counts == first.0 && bound != first.1, "bindings are kept for some frames")
}

/// Adds 1 to each word.
const COUNT: &str = "@group(0) @binding(0) var<storage, read_write> counts: array<u32>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) { counts[id.x] += 1u; }";

fn limits_are_checked_first() -> Outcome {
    let gpu = adapter::open()?;
    let limit = gpu.device().limits().max_storage_buffer_binding_size;
    match gpu.empty_buffer("too large", limit + 4, wgpu::BufferUsages::STORAGE) {
        Err(error @ GpuError::OverLimit { .. }) => {
            check(matches!(error, GpuError::OverLimit { .. }), "it is an error of its own")?;
            let text = error.to_string();
            check(text.contains("too large") && text.contains("max_storage_buffer_binding_size"), text)?;
        }
        other => return Err(format!("{other:?}").into()),
    }
    // The device is as good as before.
    gpu.check()?;
    let kernel = ComputeKernel::new(&gpu, &downpour_shaders::mask::DROP_KERNEL, &[])?;
    let uniform = gpu.empty_buffer("uniform", 80, wgpu::BufferUsages::UNIFORM)?;
    let texels = gpu.empty_buffer("texels", 4096, wgpu::BufferUsages::STORAGE)?;
    let bindings = kernel.bind(&gpu, &[&uniform, &texels])?;
    let groups = gpu.device().limits().max_compute_workgroups_per_dimension + 1;
    let refused = gpu.submit(&[kernel.dispatch(&bindings, [groups, 1, 1])]);
    check(matches!(refused, Err(GpuError::OverLimit { .. })), format!("{refused:?}"))?;
    // Too few bindings are refused with the kernel's name.
    match kernel.bind(&gpu, &[&uniform]) {
        Err(error @ GpuError::Refused { .. }) => {
            check(error.to_string().contains("main_mask_drop"), error.to_string())
        }
        other => Err(format!("{other:?}").into()),
    }
}

fn a_lost_device_gives_nothing() -> Outcome {
    let gpu = Gpu::open_with(&options())?;
    let buffer = gpu.storage_buffer("numbers", &[1.0f32; 16])?;
    gpu.read::<f32>(&buffer)?;
    gpu.device().destroy();
    let read = gpu.read::<f32>(&buffer);
    check(matches!(read, Err(GpuError::Lost { .. })), format!("{read:?}"))?;
    let made = gpu.storage_buffer("more", &[1.0f32; 16]);
    check(matches!(made, Err(GpuError::Lost { .. })), format!("{made:?}"))?;
    check(matches!(gpu.check(), Err(GpuError::Lost { .. })), "a lost device is an error of its own")
}

fn loss_is_seen_at_any_submission() -> Outcome {
    for k in 1..=3 {
        let gpu = Gpu::open_with(&GpuOptions { lose_after_submissions: Some(k), ..options() })?;
        let mask = mask_on(&gpu, 64).and_then(|_| mask_on(&gpu, 64));
        let lost = matches!(mask, Err(GpuMaskError::Gpu(GpuError::Lost { .. })));
        check(lost, format!("after submission {k}: {:?}", mask.map(|m| m.size)))?;
    }
    Ok(())
}

/// A device as an application makes it, with counters for its handlers.
struct Caller {
    device: wgpu::Device,
    queue: wgpu::Queue,
    errors: Arc<AtomicU32>,
    losses: Arc<AtomicU32>,
}

fn caller() -> Result<Caller, Failed> {
    let ours = Gpu::open_with(&options())?;
    // The handlers of our own device are replaced by the caller's, as an application would set them.
    let (errors, losses) = (Arc::new(AtomicU32::new(0)), Arc::new(AtomicU32::new(0)));
    let (device, queue) = (ours.device().clone(), ours.queue().clone());
    let (on_error, on_loss) = (Arc::clone(&errors), Arc::clone(&losses));
    device.on_uncaptured_error(Arc::new(move |_| {
        on_error.fetch_add(1, Ordering::SeqCst);
    }));
    device.set_device_lost_callback(move |_, _| {
        on_loss.fetch_add(1, Ordering::SeqCst);
    });
    Ok(Caller { device, queue, errors, losses })
}

fn provoke_an_error(device: &wgpu::Device) {
    let _ = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("mapped for reading and writing"),
        size: 4,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::MAP_WRITE,
        mapped_at_creation: false,
    });
}

fn a_callers_handlers_stay() -> Outcome {
    let caller = caller()?;
    let gpu = Gpu::on_device(caller.device.clone(), caller.queue.clone());
    for _ in 0..20 {
        mask_on(&gpu, 32)?;
    }
    let refused = ComputeKernel::from_source(&gpu, "main_x", "fn main_x() { return 1; }", &[]);
    check(refused.is_err(), "a broken shader was accepted")?;
    check(caller.errors.load(Ordering::SeqCst) == 0, "our own errors reached the caller's handler")?;
    provoke_an_error(&caller.device);
    check(caller.errors.load(Ordering::SeqCst) == 1, "the caller's error handler was replaced")?;
    caller.device.destroy();
    let _ = caller.device.poll(wgpu::PollType::Poll);
    check(caller.losses.load(Ordering::SeqCst) == 1, "the caller's lost-device callback was replaced")
}

fn a_callers_lost_device_is_seen() -> Outcome {
    let caller = caller()?;
    let gpu = Gpu::on_device(caller.device.clone(), caller.queue.clone());
    mask_on(&gpu, 32)?;
    caller.device.destroy();
    let mask = mask_on(&gpu, 32);
    check(matches!(mask, Err(GpuMaskError::Gpu(_))), "a mask came from a lost device")
}

fn a_device_that_does_not_finish_is_hung() -> Outcome {
    let gpu = Gpu::open_with(&GpuOptions { timeout: Duration::from_nanos(1), ..options() })?;
    let shape = DropShape::new(2.0e-3).expect("2 mm is a drop");
    // A tenth of a second of work for the fastest GPU there is.
    let options = MaskOptions { size: 1024, ..MaskOptions::default() };
    let repeats = if gpu.adapter().is_software() { 10 } else { 1000 };
    let time = GpuTracer::new(&gpu)?.time_drop(&shape, &options, repeats);
    check(matches!(time, Err(GpuMaskError::Gpu(GpuError::Hung { .. }))), format!("{time:?}"))
}

fn threads_share_a_device() -> Outcome {
    let gpu = adapter::open()?;
    let first = mask_on(&gpu, 48)?;
    let same = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8).map(|_| scope.spawn(|| mask_on(&gpu, 48))).collect();
        threads.into_iter().all(|t| t.join().is_ok_and(|m| m.is_ok_and(|m| m == first)))
    });
    check(same, "threads got different masks")
}

fn an_unknown_adapter_is_told_with_those_there_are() -> Outcome {
    match Gpu::open(&AdapterChoice::Named("no such adapter".to_owned())) {
        Err(error @ GpuError::AdapterNotFound { .. }) => {
            let name = adapter::open()?.adapter().name.clone();
            check(error.to_string().contains(&name), error.to_string())
        }
        other => Err(format!("{other:?}").into()),
    }
}

fn passes_are_timed() -> Outcome {
    let gpu = Gpu::open_with(&options())?;
    let shape = DropShape::new(2.0e-3).expect("2 mm is a drop");
    let time =
        GpuTracer::new(&gpu)?.time_drop(&shape, &MaskOptions { size: 64, ..MaskOptions::default() }, 4)?;
    check(time.wall > Duration::ZERO, "no time passed")?;
    check(time.device.is_some() == gpu.adapter().timestamps, "the device's clock is used where there is one")
}

fn webgpu_limits_are_enough() -> Outcome {
    let gpu = Gpu::open_with(&GpuOptions { limits: LimitSet::WebGpuDefault, ..options() })?;
    check(gpu.device().limits() == wgpu::Limits::default(), "other limits than asked for")?;
    // 1024^2 texels of 48 bytes are within the 128 MiB that every WebGPU device binds; 4096^2 are not.
    mask_on(&gpu, 1024)?;
    let refused = mask_on(&gpu, 4096);
    check(
        matches!(refused, Err(GpuMaskError::Gpu(GpuError::OverLimit { .. }))),
        format!("{:?}", refused.map(|m| m.size)),
    )
}
