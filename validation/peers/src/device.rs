//! Device that everything is timed on.

use downpour::gpu::adapter::{BACKENDS, preference};
use downpour::gpu::wgpu;

/// A device with its queue, adapter and instance: Bevy takes all four.
pub(crate) struct Device {
    pub(crate) instance: wgpu::Instance,
    pub(crate) adapter: wgpu::Adapter,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
}

impl Device {
    /// Opens the adapter whose name or driver contains a text, else the best one: discrete before integrated, virtual and software.
    /// The device has the adapter's limits, and the features that Bevy would ask for except experimental ones.
    ///
    /// # Errors
    /// No adapter, none of the name, or no device on it.
    pub(crate) fn open(wanted: Option<&str>) -> Result<Self, String> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = BACKENDS;
        // As Bevy does in a release build.
        descriptor.flags.remove(wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL);
        let instance = wgpu::Instance::new(descriptor);
        let adapter = choose(&instance, wanted)?;
        let info = adapter.get_info();
        let mut features = adapter.features() - wgpu::Features::all_experimental_mask();
        if info.device_type == wgpu::DeviceType::DiscreteGpu {
            features.remove(wgpu::Features::MAPPABLE_PRIMARY_BUFFERS);
        }
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("peers"),
            required_features: features,
            required_limits: adapter.limits(),
            ..Default::default()
        }))
        .map_err(|error| format!("no device on the adapter {}: {error}", info.name))?;
        Ok(Self { instance, adapter, device, queue })
    }

    /// Name and driver of the adapter.
    pub(crate) fn name(&self) -> String {
        let wgpu::AdapterInfo { name, driver, driver_info, backend, .. } = self.adapter.get_info();
        format!("{name} ({driver} {driver_info}, {backend})")
    }

    /// Waits until the device is idle.
    ///
    /// # Errors
    /// The device is lost.
    pub(crate) fn wait(&self) -> Result<(), String> {
        let poll = wgpu::PollType::wait_indefinitely();
        self.device.poll(poll).map(|_| ()).map_err(|error| format!("waiting for the device failed: {error}"))
    }
}

fn choose(instance: &wgpu::Instance, wanted: Option<&str>) -> Result<wgpu::Adapter, String> {
    let mut adapters = pollster::block_on(instance.enumerate_adapters(BACKENDS));
    adapters.sort_by_key(preference);
    let named = |adapter: &wgpu::Adapter| {
        let wgpu::AdapterInfo { name, driver, .. } = adapter.get_info();
        format!("\"{name}\" ({driver})")
    };
    let names: Vec<String> = adapters.iter().map(named).collect();
    let lower = wanted.unwrap_or_default().to_lowercase();
    match names.iter().position(|name| name.to_lowercase().contains(&lower)) {
        Some(index) => Ok(adapters.swap_remove(index)),
        None if names.is_empty() => {
            Err("no adapter: install a driver of Vulkan, such as Mesa's lavapipe".to_owned())
        }
        None => Err(format!("no adapter is called \"{lower}\"; there are {}", names.join(", "))),
    }
}
