//! The window without a window: passes with given events, and pictures of them.

use std::path::Path;

use egui::{Event, Modifiers, PointerButton, Pos2, Rect, Vec2};

use crate::app::{App, Wish};
use crate::document::write_picture;
use crate::raster::Raster;
use crate::theme;

/// Time between two passes, s.
const PASS_S: f64 = 1.0 / 60.0;

/// Passes in which what fades in is there.
const FADE_PASSES: u32 = 15;

/// A window without a window.
pub struct Offscreen {
    context: egui::Context,
    raster: Raster,
    size: [u32; 2],
    time_s: f64,
    primitives: Vec<egui::ClippedPrimitive>,
}

impl std::fmt::Debug for Offscreen {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Offscreen").field("size", &self.size).finish_non_exhaustive()
    }
}

impl Offscreen {
    /// A window of some pixels, at 100 %.
    #[must_use]
    pub fn new(size: [u32; 2]) -> Self {
        let context = egui::Context::default();
        theme::apply(&context);
        let primitives = Vec::new();
        Self { context, raster: Raster::default(), size, time_s: 0.0, primitives }
    }

    /// The context.
    #[must_use]
    pub fn context(&self) -> &egui::Context {
        &self.context
    }

    /// One pass with events. Returns the wishes of the application.
    pub fn pass(&mut self, app: &mut App, events: Vec<Event>) -> Vec<Wish> {
        self.time_s += PASS_S;
        let [width, height] = self.size.map(|edge| edge as f32);
        let input = egui::RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, Vec2::new(width, height))),
            time: Some(self.time_s),
            predicted_dt: PASS_S as f32,
            events,
            focused: true,
            ..Default::default()
        };
        let mut output = self.context.run_ui(input, |ui| app.frame(ui));
        self.raster.update(&mut output.textures_delta);
        self.primitives = self.context.tessellate(output.shapes, output.pixels_per_point);
        app.take_wishes()
    }

    /// Presses and releases a key. Returns the wishes of the application.
    pub fn key(&mut self, app: &mut App, modifiers: Modifiers, key: egui::Key) -> Vec<Wish> {
        let event = |pressed| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers };
        let mut wishes = self.pass(app, vec![Event::ModifiersChanged(modifiers), event(true)]);
        wishes.extend(self.pass(app, vec![event(false), Event::ModifiersChanged(Modifiers::NONE)]));
        wishes
    }

    /// Drags the pointer from a place to another.
    pub fn drag(&mut self, app: &mut App, from: Pos2, to: Pos2) {
        const STEPS: u8 = 8;
        let button = |pos, pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        self.pass(app, vec![Event::PointerMoved(from)]);
        self.pass(app, vec![button(from, true)]);
        for step in 1..=STEPS {
            let at = from + (to - from) * (f32::from(step) / f32::from(STEPS));
            self.pass(app, vec![Event::PointerMoved(at)]);
        }
        self.pass(app, vec![button(to, false)]);
        self.pass(app, vec![Event::PointerGone]);
    }

    /// Passes until menus and dialogs have come up: they fade in.
    pub fn rest(&mut self, app: &mut App) {
        for _ in 0..FADE_PASSES {
            self.pass(app, Vec::new());
        }
    }

    /// Passes until the newest picture is shown. False if that takes longer than ten minutes.
    pub fn settle(&mut self, app: &mut App) -> bool {
        self.pass(app, Vec::new());
        let is_drawn = app.engine().wait(std::time::Duration::from_secs(600));
        self.pass(app, Vec::new());
        self.pass(app, Vec::new());
        is_drawn
    }

    /// The window as it was drawn last.
    #[must_use]
    pub fn pixels(&self) -> Vec<[u8; 3]> {
        self.raster.draw(&self.primitives, self.size.map(|edge| edge as usize), 1.0, theme::PANEL)
    }

    /// Writes the window as a PNG.
    ///
    /// # Errors
    /// The message of the encoder or of the system.
    pub fn screenshot(&self, path: &Path) -> Result<(), String> {
        write_picture(path, self.size, &self.pixels())
    }
}
