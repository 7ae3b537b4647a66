//! A wgpu device that hands everything on to another one, and sees the shaders that pass.
//!
//! Library code makes its kernels itself, from text that is compiled in. Between it and the device stands a [`Relay`]: it
//! keeps pipelines, so that a kernel is compiled once however often cases make it; it notes which kernels were dispatched
//! and with which `override` constants; and it can put other text in the place of a function's. Only what Downpour uses is
//! handed on: buffers, compute pipelines and passes, readback.

mod device;
mod handles;
mod pass;

use std::collections::{BTreeSet, HashMap};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::ThreadId;

use downpour_gpu::Gpu;
use downpour_gpu::wgpu;

use crate::reach;

/// Reason why a call panics: the relay does not forward it.
const NOT_HANDED_ON: &str = "a relay hands on compute only";

/// A kernel that was dispatched: its entry point, and the constants that it was given (bits of f64).
pub type Dispatched = (String, Vec<(String, u64)>);

/// The name of the number that chooses among several wrong texts, as the text of a [`Swap`] reads it.
pub const CHOSEN: &str = "relay_chosen";

/// Text that stands in the place of a function's. It may read [`CHOSEN`], which [`Relay::choose`] sets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Swap {
    /// The function's name.
    pub function: String,
    /// The function as it is, with its signature: the text that is looked for.
    pub right: String,
    /// Text that is compiled instead.
    pub wrong: String,
}

/// The number that wrong texts read, on the device.
#[derive(Debug)]
struct Chosen {
    buffer: wgpu::Buffer,
    device: wgpu::Device,
    queue: wgpu::Queue,
}

/// The part of a relay that its owner and its device share.
#[derive(Clone, Debug, Default)]
pub struct Relay {
    state: Arc<Mutex<State>>,
}

#[derive(Debug, Default)]
struct State {
    swap: Option<Swap>,
    chosen: Option<Chosen>,
    pipelines: HashMap<Key, Made>,
    /// Those with the swapped text: kept until the next swap.
    wrong: HashMap<Key, Made>,
    reached: HashMap<(String, String), Arc<BTreeSet<String>>>,
    /// By thread: cases run beside each other.
    dispatched: HashMap<ThreadId, BTreeSet<Dispatched>>,
}

/// A pipeline, and the bindings of its second group if it reads [`CHOSEN`].
#[derive(Clone, Debug)]
struct Made {
    pipeline: wgpu::ComputePipeline,
    choice: Option<wgpu::BindGroup>,
}

/// Text, entry point and constants of a pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Key {
    source: String,
    entry: String,
    constants: Vec<(String, u64)>,
}

impl Relay {
    /// A context whose device hands on to that of `gpu`, and what steers it.
    #[must_use]
    pub fn before(gpu: &Gpu) -> (Self, Gpu) {
        let relay = Self::default();
        let buffer = gpu.device().create_buffer(&wgpu::BufferDescriptor {
            label: Some(CHOSEN),
            size: 16,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let (device, queue) = (gpu.device().clone(), gpu.queue().clone());
        relay.lock().chosen = Some(Chosen { buffer, device, queue });
        let device = device::RelayDevice { relay: relay.clone(), inner: gpu.device().clone() };
        let queue = device::RelayQueue { inner: gpu.queue().clone() };
        let relayed = Gpu::on_device(wgpu::Device::from_custom(device), wgpu::Queue::from_custom(queue));
        (relay, relayed)
    }

    /// Puts other text in the place of a function's, from the next pipeline on; `None`: none any more.
    pub fn swap(&self, swap: Option<Swap>) {
        let mut state = self.lock();
        state.swap = swap;
        state.wrong.clear();
    }

    /// Sets the number that a wrong text reads.
    pub fn choose(&self, number: u32) {
        if let Some(chosen) = &self.lock().chosen {
            chosen.queue.write_buffer(&chosen.buffer, 0, &number.to_le_bytes());
        }
    }

    /// The bindings that a pipeline needs to read the number, if it does.
    fn choice(&self, pipeline: &wgpu::ComputePipeline, source: &str) -> Option<wgpu::BindGroup> {
        let state = self.lock();
        let chosen = state.chosen.as_ref().filter(|_| source.contains(CHOSEN))?;
        Some(chosen.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(CHOSEN),
            layout: &pipeline.get_bind_group_layout(1),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: chosen.buffer.as_entire_binding() }],
        }))
    }

    /// The kernels that this thread has dispatched since its last call.
    #[must_use]
    pub fn take_dispatched(&self) -> BTreeSet<Dispatched> {
        self.lock().dispatched.remove(&std::thread::current().id()).unwrap_or_default()
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn note(&self, dispatched: &Dispatched) {
        let mut state = self.lock();
        state.dispatched.entry(std::thread::current().id()).or_default().insert(dispatched.clone());
    }

    /// The pipeline of a text: one that was made before, or a new one.
    fn pipeline(&self, inner: &wgpu::Device, mut key: Key) -> Made {
        let mut state = self.lock();
        let swap = state.swap.clone().filter(|swap| key.source.contains(&swap.right));
        let swap = swap.filter(|swap| state.reaches(&key, &swap.function));
        if let Some(swap) = &swap {
            key.source = key.source.replace(&swap.right, &swap.wrong);
            if swap.wrong.contains(CHOSEN) {
                key.source += &format!("\n@group(1) @binding(0) var<uniform> {CHOSEN}: u32;\n");
            }
        }
        let made = if swap.is_some() { &state.wrong } else { &state.pipelines };
        if let Some(made) = made.get(&key) {
            return made.clone();
        }
        drop(state);
        let module = inner.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(&key.entry),
            source: wgpu::ShaderSource::Wgsl(key.source.as_str().into()),
        });
        let constants: Vec<(&str, f64)> =
            key.constants.iter().map(|(name, bits)| (name.as_str(), f64::from_bits(*bits))).collect();
        let pipeline = inner.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&key.entry),
            layout: None,
            module: &module,
            entry_point: Some(&key.entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                ..Default::default()
            },
            cache: None,
        });
        let choice = self.choice(&pipeline, &key.source);
        let made = Made { pipeline, choice };
        let mut state = self.lock();
        let kept = if swap.is_some() { &mut state.wrong } else { &mut state.pipelines };
        kept.insert(key, made.clone());
        made
    }
}

impl State {
    fn reaches(&mut self, key: &Key, function: &str) -> bool {
        let at = (key.source.clone(), key.entry.clone());
        let found = self.reached.entry(at).or_insert_with(|| {
            let parsed = naga::front::wgsl::parse_str(&key.source);
            Arc::new(parsed.map(|module| reach::from_entry(&module, &key.entry, &[])).unwrap_or_default())
        });
        found.contains(function)
    }
}
