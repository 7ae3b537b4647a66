//! Enumeration and choice of GPU adapters.

use crate::{GpuError, drivers};

/// Criterion for the choice of an adapter.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AdapterChoice {
    /// The best one: discrete before integrated, virtual and software adapters.
    #[default]
    Auto,
    /// The first one whose name or driver contains this text, ignoring case.
    Named(String),
}

/// An adapter and its capabilities.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterDescription {
    /// Name of the device.
    pub name: String,
    /// Name of the driver.
    pub driver: String,
    /// Version of the driver, as the driver reports it.
    pub driver_info: String,
    /// `vulkan`, `metal`, `dx12`, `webgpu` or `noop`.
    pub backend: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// True if passes can be timed by timestamps of the device.
    pub timestamps: bool,
    /// True if 32-bit float textures can be filtered.
    pub float32_filterable: bool,
    /// True if shaders may compute with 16-bit floats.
    pub shader_f16: bool,
    /// True if shaders may use subgroup operations.
    pub subgroups: bool,
    /// Maximum width and height of a texture.
    pub max_texture_2d: u32,
    /// Maximum number of layers of a texture array.
    pub max_texture_layers: u32,
    /// Maximum size of a buffer in bytes.
    pub max_buffer_bytes: u64,
    /// Maximum size of a storage buffer binding in bytes.
    pub max_storage_binding_bytes: u64,
    /// Maximum number of invocations per workgroup.
    pub max_invocations_per_workgroup: u32,
}

impl AdapterDescription {
    pub(crate) fn new(info: &wgpu::AdapterInfo, features: wgpu::Features, limits: &wgpu::Limits) -> Self {
        let kind = match info.device_type {
            wgpu::DeviceType::DiscreteGpu => "discrete",
            wgpu::DeviceType::IntegratedGpu => "integrated",
            wgpu::DeviceType::VirtualGpu => "virtual",
            wgpu::DeviceType::Cpu => "software",
            wgpu::DeviceType::Other => "other",
        };
        Self {
            name: info.name.clone(),
            driver: info.driver.clone(),
            driver_info: info.driver_info.clone(),
            backend: info.backend.to_str().to_owned(),
            kind,
            timestamps: features.contains(wgpu::Features::TIMESTAMP_QUERY),
            float32_filterable: features.contains(wgpu::Features::FLOAT32_FILTERABLE),
            shader_f16: features.contains(wgpu::Features::SHADER_F16),
            subgroups: features.contains(wgpu::Features::SUBGROUP),
            max_texture_2d: limits.max_texture_dimension_2d,
            max_texture_layers: limits.max_texture_array_layers,
            max_buffer_bytes: limits.max_buffer_size,
            max_storage_binding_bytes: limits.max_storage_buffer_binding_size,
            max_invocations_per_workgroup: limits.max_compute_invocations_per_workgroup,
        }
    }

    /// True for a driver that computes on the CPU.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.kind == "software"
    }
}

/// Supported backends. OpenGL is excluded: its software driver writes wrong 3-D textures without an error, and it
/// lacks formats that are needed.
pub const BACKENDS: wgpu::Backends = wgpu::Backends::VULKAN
    .union(wgpu::Backends::METAL)
    .union(wgpu::Backends::DX12)
    .union(wgpu::Backends::BROWSER_WEBGPU);

/// All adapters, the one that [`AdapterChoice::Auto`] picks first.
#[must_use]
pub fn adapters() -> Vec<AdapterDescription> {
    enumerate().iter().map(describe).collect()
}

pub(crate) fn describe(adapter: &wgpu::Adapter) -> AdapterDescription {
    AdapterDescription::new(&adapter.get_info(), adapter.features(), &adapter.limits())
}

/// Place of an adapter in the order of preference, by its kind: the lower, the better.
#[must_use]
pub fn preference(adapter: &wgpu::Adapter) -> u8 {
    match adapter.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

/// All adapters in order of preference; equal ones keep the order of the system.
pub(crate) fn enumerate() -> Vec<wgpu::Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = BACKENDS;
    let instance = wgpu::Instance::new(descriptor);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(BACKENDS));
    adapters.sort_by_key(preference);
    adapters
}

/// Returns the adapter of `choice`.
///
/// # Errors
/// [`GpuError::NoAdapter`] lists the drivers that were tried, [`GpuError::AdapterNotFound`] the available
/// adapters.
pub(crate) fn choose(choice: &AdapterChoice) -> Result<wgpu::Adapter, GpuError> {
    let mut adapters = enumerate();
    if adapters.is_empty() {
        return Err(GpuError::NoAdapter { tried: drivers::tried(BACKENDS), way_out: drivers::REMEDY });
    }
    match choice {
        AdapterChoice::Auto => Ok(adapters.swap_remove(0)),
        AdapterChoice::Named(wanted) => {
            let lower = wanted.to_lowercase();
            let names: Vec<String> = adapters
                .iter()
                .map(|a| format!("\"{}\" ({})", a.get_info().name, a.get_info().driver))
                .collect();
            match names.iter().position(|name| name.to_lowercase().contains(&lower)) {
                Some(index) => Ok(adapters.swap_remove(index)),
                None => Err(GpuError::AdapterNotFound { wanted: wanted.clone(), found: names.join(", ") }),
            }
        }
    }
}
