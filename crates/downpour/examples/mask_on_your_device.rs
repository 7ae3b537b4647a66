//! The refraction mask of a drop, traced on a device that the application made.
//!
//! Downpour never asks for a device of its own here, and never replaces the application's error handlers.
//!
//! `cargo run -p downpour --features wgpu --example mask_on_your_device -- drop.exr`

use std::error::Error;

use downpour::drop::DropShape;
use downpour::gpu::{Gpu, wgpu};
use downpour::mask::file::exr::{Precision, write_exr};
use downpour::mask::gpu::GpuTracer;
use downpour::mask::{MaskOptions, trace_drop};

fn main() -> Result<(), Box<dyn Error>> {
    // What the application has anyway.
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::PRIMARY;
    let instance = wgpu::Instance::new(descriptor);
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;

    // What Downpour adds.
    let gpu = Gpu::on_device(device, queue);
    let tracer = GpuTracer::new(&gpu)?;
    let shape = DropShape::new(3.0e-3)?;
    let options = MaskOptions { size: 256, ..MaskOptions::default() };
    let mask = tracer.trace_drop(&shape, &options)?;

    // The CPU has the same formulas.
    let reference = trace_drop(&shape, &options)?;
    let covered = |m: &downpour::mask::Mask| m.texels.iter().map(|t| f64::from(t.coverage)).sum::<f64>();
    println!("{}: {:.2} texels covered", gpu.adapter().name, covered(&mask));
    println!("CPU: {:.2} texels covered", covered(&reference));

    if let Some(path) = std::env::args_os().nth(1) {
        std::fs::write(path, write_exr(&mask, Precision::Float)?)?;
    }
    Ok(())
}
