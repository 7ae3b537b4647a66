//! Every shader is valid, and every kernel becomes a pipeline on a device with WebGPU's default limits; one needs a storage buffer more, and
//! has another one in its place on such a device.

use downpour_gpu::wgpu;
use downpour_gpu::{ComputeKernel, Gpu};
use downpour_shaders::render::scene::{TRACE_KERNEL, TRACE_STORAGE_BUFFERS};
use downpour_shaders::{Module, compose, kernels, modules};
use downpour_tests::signature::parse;

/// wgpu's noop device: it validates, and computes nothing.
fn noop() -> Gpu {
    noop_with(wgpu::Limits::default())
}

fn noop_with(required_limits: wgpu::Limits) -> Gpu {
    let descriptor = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
    let (device, queue) = wgpu::Device::noop(&descriptor);
    Gpu::on_device(device, queue)
}

#[test]
fn every_module_is_valid_with_what_it_uses() {
    for module in modules() {
        let parsed = parse(&compose(&[module]));
        let mut validator = naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            // WebGPU has `unpack2x16float` without any feature; naga counts it as a capability.
            naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32,
        );
        if let Err(error) = validator.validate(&parsed) {
            panic!("{}: {}", module.path, error.emit_to_string(&compose(&[module])));
        }
    }
}

#[test]
fn every_kernel_makes_a_pipeline() {
    let gpu = noop();
    let more = noop_with(wgpu::Limits {
        max_storage_buffers_per_shader_stage: TRACE_STORAGE_BUFFERS,
        ..wgpu::Limits::default()
    });
    for kernel in kernels() {
        let needs_more = kernel.entry == TRACE_KERNEL.entry;
        let gpu = if needs_more { &more } else { &gpu };
        ComputeKernel::new(gpu, kernel, &[]).unwrap_or_else(|error| panic!("{}: {error}", kernel.entry));
    }
}

#[test]
fn a_broken_kernel_makes_none() {
    let gpu = noop();
    let error =
        ComputeKernel::from_source(&gpu, "main_broken", "fn main_broken() -> u32 { return 1.5; }", &[])
            .expect_err("an invalid shader was accepted");
    assert!(error.to_string().contains("main_broken"), "{error}");
}

#[test]
fn workgroup_sizes_are_what_the_shaders_say() {
    for kernel in kernels() {
        let parsed = parse(&kernel.source());
        let entry = parsed.entry_points.iter().find(|e| e.name == kernel.entry);
        let entry = entry.unwrap_or_else(|| panic!("{} is not in {}", kernel.entry, kernel.module.path));
        assert_eq!(entry.workgroup_size, kernel.workgroup, "{}", kernel.entry);
    }
}

#[test]
fn modules_are_listed_once() {
    // A file may stand over different modules of the same functions.
    let used = |m: &Module| m.uses.iter().map(|used| used.path).collect::<Vec<_>>();
    let mut listed: Vec<_> = modules().map(|m| (m.path, used(m))).collect();
    let n = listed.len();
    listed.sort_unstable();
    listed.dedup();
    assert_eq!(listed.len(), n);
}
