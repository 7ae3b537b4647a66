//! The window of the system around the application.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use crate::app::{App, AppOptions, Wish};
use crate::document::Document;
use crate::theme;

/// Reason why there is no window.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum WindowError {
    /// There is no display to open a window on.
    #[error(
        "no display ({reason}); allowed: a session with X11 or Wayland (DISPLAY or WAYLAND_DISPLAY), or --script FILE, which needs none"
    )]
    NoDisplay {
        /// Message of the system.
        reason: String,
    },
    /// No adapter can draw a window.
    #[error(
        "no adapter for a window ({reason}); allowed: a driver of Vulkan, Metal or Direct3D 12, or --script FILE, which needs none"
    )]
    NoAdapter {
        /// Message of the system.
        reason: String,
    },
    /// Anything else.
    #[error("the window ended: {reason}")]
    Other {
        /// Message of the system.
        reason: String,
    },
}

/// Opens the window and runs it until it is closed.
///
/// # Errors
/// [`WindowError`]; changes that were not saved are in the recovery file.
pub fn run(document: Document, size: [u32; 2], options: AppOptions) -> Result<(), WindowError> {
    let other = |error: std::io::Error| WindowError::Other { reason: error.to_string() };
    if cfg!(all(unix, not(target_os = "macos"))) {
        let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        if !is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") && !is_set("WAYLAND_SOCKET") {
            let reason = "neither DISPLAY nor WAYLAND_DISPLAY is set".to_owned();
            return Err(WindowError::NoDisplay { reason });
        }
    }
    let app = App::new(document, options).map_err(other)?;
    let [width, height] = size.map(|edge| edge as f32);
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Downpour")
            .with_inner_size([width, height])
            .with_drag_and_drop(true),
        ..Default::default()
    };
    let create = move |creation: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        theme::apply(&creation.egui_ctx);
        let context = creation.egui_ctx.clone();
        app.engine().on_answer(move || context.request_repaint());
        let (send_shot, shots) = channel();
        let title = String::new();
        Ok(Box::new(Shell { app, title, is_closing: false, is_full: false, send_shot, shots })
            as Box<dyn eframe::App>)
    };
    eframe::run_native("Downpour", native, Box::new(create)).map_err(|error| {
        let reason = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        match error {
            eframe::Error::Winit(_) | eframe::Error::WinitEventLoop(_) => WindowError::NoDisplay { reason },
            eframe::Error::Wgpu(_) => WindowError::NoAdapter { reason },
            _ => WindowError::Other { reason },
        }
    })
}

struct Shell {
    app: App,
    title: String,
    is_closing: bool,
    is_full: bool,
    /// Pictures of the window, which the system gives back after it has drawn it.
    send_shot: Sender<Arc<egui::ColorImage>>,
    shots: Receiver<Arc<egui::ColorImage>>,
}

impl eframe::App for Shell {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        self.app.frame(ui);
        let context = ui.ctx().clone();
        let mark = if self.app.document().is_dirty() { "* " } else { "" };
        let title = format!("{mark}{} - Downpour", self.app.document().title());
        if title != self.title {
            context.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
        if context.input(|input| input.viewport().close_requested())
            && !self.is_closing
            && !self.app.may_close()
        {
            context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
        }
        for wish in self.app.take_wishes() {
            match wish {
                Wish::Close => {
                    if self.app.dialog().is_none()
                        && (self.is_closing || self.app.may_close() || self.app.is_discarded())
                    {
                        self.is_closing = true;
                        context.send_viewport_cmd(egui::ViewportCommand::Close);
                    }
                }
                Wish::FullScreen => {
                    self.is_full = !self.is_full;
                    context.send_viewport_cmd(egui::ViewportCommand::Fullscreen(self.is_full));
                }
                Wish::Screenshot => {
                    let (send, waker) = (self.send_shot.clone(), context.clone());
                    context.request_screenshot(move |image| {
                        // The window may be gone by then.
                        let _ = send.send(image);
                        waker.request_repaint();
                    });
                }
            }
        }
        for image in self.shots.try_iter() {
            let pixels: Vec<[u8; 3]> =
                image.pixels.iter().map(|pixel| [pixel.r(), pixel.g(), pixel.b()]).collect();
            let place = self.app.screenshot_place();
            self.app.save_pixels(&place, image.size.map(|edge| edge as u32), &pixels);
        }
        context.request_repaint_after(Duration::from_millis(500));
    }

    fn on_exit(&mut self) {
        if self.app.is_discarded() || !self.app.document().is_dirty() {
            self.app.document_mut().discard_recovery();
        }
    }
}
