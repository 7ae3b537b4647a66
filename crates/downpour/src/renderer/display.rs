//! Frames for a display: pixels to look at, without their layers.

#[cfg(feature = "wgpu")]
use std::time::Instant;

use downpour_render::picture::DeviceUse;
#[cfg(feature = "wgpu")]
use downpour_render::tone::Tone;
#[cfg(feature = "wgpu")]
use downpour_trace::gpu::DisplayReadback;

use super::frame::PendingFrame;
use super::{Renderer, RendererError};

/// A frame for a display.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct DisplayFrame {
    /// Its time, s.
    pub time_s: f64,
    /// Columns and rows.
    pub size: [u32; 2],
    /// Red, green, blue and alpha of each pixel in sRGB, rows from the top.
    pub pixels: Vec<[u8; 4]>,
    /// Factor from radiance to pixels before the tone curve.
    pub exposure: f32,
    /// Drops that were looked at.
    pub drops_simulated: u64,
    /// Drops whose outline touches the picture.
    pub drops_on_screen: usize,
    /// Those of them that the scene does not hide altogether.
    pub drops_drawn: usize,
    /// The passes in their order, with the milliseconds that each took.
    pub passes: Vec<(&'static str, f64)>,
    /// Use of the device that drew it; `None` on the CPU.
    pub device: Option<DeviceUse>,
    /// Time until it was on its way, ms.
    pub begin_ms: f64,
    /// Time from its begin until its pixels were at hand, ms; other frames may have been begun meanwhile.
    pub frame_ms: f64,
}

/// A frame for a display that was begun.
#[derive(Debug)]
pub struct PendingDisplay(Pending);

#[derive(Debug)]
enum Pending {
    /// With all of its layers.
    Whole(Box<PendingFrame>),
    #[cfg(feature = "wgpu")]
    Pixels { read: Box<DisplayReadback>, time_s: f64, exposure: f32, begin: Instant, begin_ms: f64 },
}

impl Renderer {
    /// Begins the frame of a time in seconds for a display. On a GPU its layers and its drops stay there and its pixels are made there, so
    /// that it is at hand sooner than a [`Frame`](super::Frame), and the same within 1 of 255. The first frame, those seen
    /// through a pane and all of a CPU are made as [`Renderer::begin_frame`] does.
    ///
    /// # Errors
    /// As [`Renderer::frame`].
    pub fn begin_display(&mut self, time_s: f64) -> Result<PendingDisplay, RendererError> {
        #[cfg(feature = "wgpu")]
        if self.drawn > 0
            && self.weather.glass.is_none()
            && let Some(exposure) = self.exposure
            && let Some(pixels) = self.display_of_device(time_s, exposure)?
        {
            return Ok(PendingDisplay(pixels));
        }
        Ok(PendingDisplay(Pending::Whole(Box::new(self.begin_frame(time_s)?))))
    }

    /// The frame of a time in seconds for a display.
    ///
    /// # Errors
    /// As [`Renderer::frame`].
    pub fn display(&mut self, time_s: f64) -> Result<DisplayFrame, RendererError> {
        self.begin_display(time_s)?.finish()
    }

    /// The frame as a GPU makes it; `None` where none draws.
    #[cfg(feature = "wgpu")]
    fn display_of_device(&mut self, time_s: f64, exposure: f32) -> Result<Option<Pending>, RendererError> {
        let begin = Instant::now();
        if self.drawer.finder().is_none() {
            return Ok(None);
        }
        let told = &mut |_| {};
        let frame_scene = self.seen(time_s, told)?;
        let drops = self.drops(&frame_scene, time_s, told)?;
        let medium = self.shower.medium(&frame_scene, drops.resolved(), &self.masks, time_s)?;
        let options = self.picture_options(&frame_scene, time_s, medium)?;
        let exposure = exposure * self.weather.exposure_factor(time_s);
        let (curve, edges) = (self.weather.camera.tone, self.weather.camera.edges);
        let tone = Tone { exposure, curve, edges };
        let of = self.plate_use(&frame_scene, time_s);
        let flashes = self.flash_pictures(time_s, &drops, told)?;
        let (seen, drawn) = ((&frame_scene, &drops), (&*self.masks, &options));
        let read = self.drawer.display(of, &tone, seen, drawn, &flashes)?;
        self.drawn += 1;
        let begin_ms = begin.elapsed().as_secs_f64() * 1.0e3;
        let pixels = |read| Pending::Pixels { read: Box::new(read), time_s, exposure, begin, begin_ms };
        Ok(read.map(pixels))
    }
}

impl PendingDisplay {
    /// Waits for the frame.
    ///
    /// # Errors
    /// [`RendererError`]: what the GPU says.
    pub fn finish(self) -> Result<DisplayFrame, RendererError> {
        match self.0 {
            Pending::Whole(frame) => {
                let frame = frame.finish()?;
                let pixels = frame.pixels().into_iter().map(|[r, g, b]| [r, g, b, 255]).collect();
                Ok(DisplayFrame {
                    time_s: frame.time_s,
                    size: frame.size(),
                    pixels,
                    exposure: frame.exposure,
                    drops_simulated: frame.drops.simulated,
                    drops_on_screen: frame.picture.drops_on_screen,
                    drops_drawn: frame.picture.drawn.len(),
                    passes: frame.picture.passes,
                    device: frame.picture.device,
                    begin_ms: frame.begin_ms,
                    frame_ms: frame.frame_ms,
                })
            }
            #[cfg(feature = "wgpu")]
            Pending::Pixels { read, time_s, exposure, begin, begin_ms } => {
                let picture = read.finish()?;
                Ok(DisplayFrame {
                    time_s,
                    size: picture.size,
                    pixels: picture.pixels,
                    exposure,
                    drops_simulated: picture.drops_simulated,
                    drops_on_screen: picture.drops_on_screen,
                    drops_drawn: picture.drops_drawn,
                    passes: picture.passes,
                    device: picture.device,
                    begin_ms,
                    frame_ms: begin.elapsed().as_secs_f64() * 1.0e3,
                })
            }
        }
    }
}
