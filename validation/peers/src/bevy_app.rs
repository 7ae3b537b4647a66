//! Bevy without a window, on the shared device.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use bevy::app::{PluginsState, TerminalCtrlCHandlerPlugin};
use bevy::camera::{Hdr, ManualTextureViewHandle, RenderTarget};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::log::{Level, LogPlugin};
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::renderer::{RenderAdapter, RenderAdapterInfo, RenderDevice, RenderInstance, RenderQueue};
use bevy::render::settings::RenderCreation;
use bevy::render::texture::{ManualTextureView, ManualTextureViews};
use bevy::render::view::Msaa;
use bevy::tasks::tick_global_task_pools_on_main_thread;
use bevy::time::TimeUpdateStrategy;
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use downpour::gpu::wgpu;

use crate::contender::Contender;
use crate::device::Device;
use crate::{EYE_M, FOV_Y, SIZE, STEP_S, picture};

/// Handle of the texture that the camera draws to.
const TARGET: ManualTextureViewHandle = ManualTextureViewHandle(0);

/// True once an app has set the logger, of which a process has one.
static HAS_LOGGER: AtomicBool = AtomicBool::new(false);

/// An app of Bevy that draws to a texture, a frame per call.
pub(crate) struct BevyApp {
    app: App,
    target: wgpu::Texture,
    /// Change of the app when the first drops are on the picture.
    settled: Option<fn(&mut App)>,
}

impl BevyApp {
    /// Creates an app on the device: the default plugins without a window and without rendering in a thread of its own, and an HDR
    /// camera without multisampling or a tone curve. `add` adds plugins, resources and systems, `dress` components of the camera.
    ///
    /// # Errors
    /// Bevy's adapter is not the device's.
    pub(crate) fn new(
        device: &Device,
        add: impl FnOnce(&mut App),
        dress: impl FnOnce(&mut EntityWorldMut<'_>),
    ) -> Result<Self, String> {
        let format = wgpu::TextureFormat::Rgba8UnormSrgb;
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let target = picture::texture(device, format, usage);
        let creation = RenderCreation::manual(
            RenderDevice::from(device.device.clone()),
            RenderQueue::new(device.queue.clone()),
            RenderAdapterInfo::new(device.adapter.get_info()),
            RenderAdapter::new(device.adapter.clone()),
            RenderInstance::new(device.instance.clone()),
        );
        let window =
            WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() };
        let render =
            RenderPlugin { render_creation: creation, synchronous_pipeline_compilation: true, ..default() };
        let plugins = DefaultPlugins
            .set(window)
            .set(render)
            .disable::<WinitPlugin>()
            .disable::<PipelinedRenderingPlugin>()
            .disable::<TerminalCtrlCHandlerPlugin>();
        let plugins = match HAS_LOGGER.swap(true, Ordering::Relaxed) {
            true => plugins.disable::<LogPlugin>(),
            false => plugins.set(LogPlugin { level: Level::WARN, ..default() }),
        };
        let mut app = App::new();
        app.add_plugins(plugins);
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(STEP_S)));
        add(&mut app);
        let view = target.create_view(&wgpu::TextureViewDescriptor::default());
        let view = ManualTextureView::with_default_format(view.into(), UVec2::from(SIZE));
        app.world_mut().resource_mut::<ManualTextureViews>().insert(TARGET, view);
        let mut camera = app.world_mut().spawn((
            Camera3d::default(),
            Camera { clear_color: Color::linear_rgb(0.1, 0.1, 0.1).into(), ..default() },
            RenderTarget::TextureView(TARGET),
            Projection::Perspective(PerspectiveProjection { fov: FOV_Y, ..default() }),
            Transform::from_xyz(0.0, EYE_M, 0.0).looking_to(Vec3::NEG_Z, Vec3::Y),
            Hdr,
            Msaa::Off,
            Tonemapping::None,
            DebandDither::Disabled,
        ));
        dress(&mut camera);
        while app.plugins_state() == PluginsState::Adding {
            tick_global_task_pools_on_main_thread();
        }
        app.finish();
        app.cleanup();
        check_adapter(device, &app)?;
        Ok(Self { app, target, settled: None })
    }

    /// Sets a change of the app that is made when the first drops are on the picture.
    pub(crate) fn when_settled(self, change: fn(&mut App)) -> Self {
        Self { settled: Some(change), ..self }
    }

    /// The app.
    pub(crate) fn app(&self) -> &App {
        &self.app
    }
}

/// # Errors
/// Bevy's adapter is not the device's.
fn check_adapter(device: &Device, app: &App) -> Result<(), String> {
    let wanted = device.adapter.get_info();
    let found = app.world().get_resource::<RenderAdapterInfo>();
    match found {
        Some(found) if (&found.name, found.backend) == (&wanted.name, wanted.backend) => Ok(()),
        _ => Err(format!(
            "Bevy renders on the adapter \"{}\", all else on \"{}\": times on two adapters are not compared",
            found.map_or("none", |found| &found.name),
            wanted.name
        )),
    }
}

impl Contender for BevyApp {
    fn frame(&mut self) -> Result<(), String> {
        self.app.update();
        match self.app.should_exit() {
            None => Ok(()),
            Some(exit) => Err(format!("Bevy quits with {exit:?}: its messages above say why")),
        }
    }

    fn picture(&self) -> Option<&wgpu::Texture> {
        Some(&self.target)
    }

    fn settled(&mut self) {
        if let Some(change) = self.settled.take() {
            change(&mut self.app);
        }
    }
}
