//! Every shader is valid, and every kernel becomes a pipeline on a device with WebGPU's default limits; one needs a storage buffer more, and
//! has another one in its place on such a device.

use downpour_gpu::wgpu;
use downpour_gpu::{ComputeKernel, Gpu};
use downpour_shaders::render::scene::{TRACE_KERNEL, TRACE_STORAGE_BUFFERS};
use downpour_shaders::{Module, compose, kernels, modules};
use downpour_tests::reach;
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

/// Uniform blocks with a first word that kernels read, and that stays from picture to picture: it is a size, a number or an origin.
const FIRST_WORDS_THAT_STAY: &[&str] = &[
    "atlas_data_frame",
    "collision_map",
    "collision_map_frame",
    "compose_size",
    "drop_light_frame",
    "glass_claim_frame",
    "glass_decide_frame",
    "glass_height_frame",
    "glass_normal_frame",
    "glass_settle_frame",
    "glass_smooth_frame",
    "glass_transfer_frame",
    "glow_coarse",
    "glow_given",
    "host_environment_frame",
    "host_plate_frame",
    "layers_frame",
    "mask_drop_traced",
    "mask_model",
    "medium_frame",
    "profiles_frame",
    "puddle_grid",
    "pyramid_level",
    "refine_frame",
    "specimen_lamps",
    "specimen_streak",
    "specimen_view",
    "step_grid",
    "tiles_frame",
    "tone_frame",
    "wind_field_grid",
    "wind_field_spread_frame",
];

/// Byte of a uniform block at which a pointer points, if its text says it.
fn place_in_block(
    module: &naga::Module,
    of: &naga::Function,
    pointer: naga::Handle<naga::Expression>,
) -> Option<(String, naga::Handle<naga::Type>, u32)> {
    match of.expressions[pointer] {
        naga::Expression::GlobalVariable(variable) => {
            let variable = &module.global_variables[variable];
            let is_block = variable.space == naga::AddressSpace::Uniform;
            is_block.then(|| (variable.name.clone().unwrap_or_default(), variable.ty, 0))
        }
        naga::Expression::AccessIndex { base, index } => {
            let (name, ty, at) = place_in_block(module, of, base)?;
            match &module.types[ty].inner {
                naga::TypeInner::Struct { members, .. } => {
                    let member = &members[index as usize];
                    Some((name, member.ty, at + member.offset))
                }
                naga::TypeInner::Array { base, stride, .. } => Some((name, *base, at + stride * index)),
                _ => Some((name, ty, at + 4 * index)),
            }
        }
        _ => None,
    }
}

/// No kernel reads the first word of a uniform block that changes from picture to picture: Mesa's software driver (22.3) puts what it reads
/// there into the kernel, and compiles it for each value, which takes seconds for the largest.
#[test]
fn first_words_of_uniform_blocks_stay_from_picture_to_picture() {
    let mut read = std::collections::BTreeSet::new();
    for kernel in kernels() {
        let parsed = parse(&kernel.source());
        let reached = reach::from_entry(&parsed, kernel.entry, &[]);
        let functions = parsed.functions.iter().map(|(_, function)| function);
        let entries = parsed.entry_points.iter().filter(|e| e.name == kernel.entry).map(|e| &e.function);
        let called = functions.filter(|f| f.name.as_ref().is_some_and(|name| reached.contains(name)));
        for function in called.chain(entries) {
            for (_, expression) in function.expressions.iter() {
                let naga::Expression::Load { pointer } = expression else { continue };
                if let Some((name, _, 0)) = place_in_block(&parsed, function, *pointer) {
                    read.insert(name);
                }
            }
        }
    }
    let stay = FIRST_WORDS_THAT_STAY.iter().map(|&name| name.to_owned()).collect();
    assert_eq!(read, stay, "blocks whose first word is read");
}
