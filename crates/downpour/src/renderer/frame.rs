//! A frame that was made.

use std::path::Path;
use std::time::Instant;

use crate::output_file::replace_file;
use downpour_render::file::{glow_channels, layer_channels, write_exr, write_exr_channels, write_png};
use downpour_render::picture::Picture;
use downpour_render::rain::RainMedium;
use downpour_render::tone::{Tone, ToneCurve, ToneEdges, ToneLayers, tone_picture};
use downpour_sim::field::VisibleDrops;

use super::RendererError;
use super::computer::Painted;
use super::drops::Drops;
use super::truth::{Truth, TruthOf};

/// A frame, in layers, with the drops in it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Frame {
    /// Its time, s.
    pub time_s: f64,
    /// Its layers: the scene without rain, the rain, their distances.
    pub picture: Picture,
    /// The drops that it could show, in the world.
    pub drops: VisibleDrops,
    /// The rain that is not drawn drop by drop.
    pub medium: RainMedium,
    /// Rain rate of the drops, mm/h, where it was asked for.
    pub measured_rate_mm_h: Option<f64>,
    /// The factor from radiance to [`Frame::pixels`].
    pub exposure: f32,
    /// Tone curve of [`Frame::pixels`].
    pub tone: ToneCurve,
    /// Filter of the edges of things brighter than white in [`Frame::pixels`].
    pub edges: ToneEdges,
    /// Truth about its pixels, where it was asked for.
    pub truth: Option<Truth>,
    /// Triangles of the scene, all copies counted.
    pub triangles: usize,
    /// Time until it was on its way, ms: of a GPU, all that its host does for it in the thread that asked for it.
    pub begin_ms: f64,
    /// Time from its begin until its picture was at hand, ms; other frames may have been begun meanwhile.
    pub frame_ms: f64,
}

/// A frame that was begun: its picture may still be on the device.
#[derive(Debug)]
pub struct PendingFrame {
    pub(super) picture: Painted,
    /// The same in the light of lightning alone.
    pub(super) flashes: Vec<Painted>,
    pub(super) begin: Instant,
    pub(super) begin_ms: f64,
    pub(super) time_s: f64,
    pub(super) triangles: usize,
    pub(super) drops: Drops,
    pub(super) medium: RainMedium,
    pub(super) measured_rate_mm_h: Option<f64>,
    pub(super) exposure: f32,
    pub(super) tone: ToneCurve,
    pub(super) edges: ToneEdges,
    pub(super) truth: Option<Box<TruthOf>>,
}

impl PendingFrame {
    /// Waits for the frame.
    ///
    /// # Errors
    /// [`RendererError`]: what the GPU says.
    pub fn finish(self) -> Result<Frame, RendererError> {
        let (mut picture, found) = self.picture.finish()?;
        let drops = self.drops.with(found);
        let truth = self.truth.map(|of| of.find(&picture, &drops)).transpose()?;
        for flash in self.flashes {
            let (flash, _) = flash.finish()?;
            picture.add_light(&flash);
            picture.passes.push(("flash", flash.passes.iter().map(|(_, ms)| ms).sum()));
        }
        Ok(Frame {
            time_s: self.time_s,
            picture,
            drops,
            truth,
            medium: self.medium,
            measured_rate_mm_h: self.measured_rate_mm_h,
            exposure: self.exposure,
            tone: self.tone,
            edges: self.edges,
            triangles: self.triangles,
            begin_ms: self.begin_ms,
            frame_ms: self.begin.elapsed().as_secs_f64() * 1.0e3,
        })
    }
}

impl Frame {
    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.picture.size
    }

    /// Linear radiance in the unit of the sky, rows from the top.
    #[must_use]
    pub fn radiance(&self) -> Vec<[f32; 3]> {
        self.picture.radiance()
    }

    /// The picture to look at, sRGB, rows from the top.
    #[must_use]
    pub fn pixels(&self) -> Vec<[u8; 3]> {
        let radiance = self.radiance();
        let layers = ToneLayers { size: self.size(), radiance: &radiance, glow: &self.picture.glow };
        let tone = Tone { exposure: self.exposure, curve: self.tone, edges: self.edges };
        tone_picture(&layers, &tone)
    }

    /// The bytes of a PNG of [`Frame::pixels`].
    ///
    /// # Errors
    /// [`RendererError::Render`] if it cannot be packed.
    pub fn png(&self) -> Result<Vec<u8>, RendererError> {
        let [width, height] = self.size();
        Ok(write_png(width, height, &self.pixels())?)
    }

    /// The bytes of an OpenEXR of [`Frame::radiance`].
    ///
    /// # Errors
    /// As [`Frame::png`].
    pub fn exr(&self) -> Result<Vec<u8>, RendererError> {
        let [width, height] = self.size();
        Ok(write_exr(width, height, &self.radiance())?)
    }

    /// The bytes of an OpenEXR of all layers: R, G, B; clean.R, .G, .B; rain.R, .G, .B; transmittance.Y; depth.Z (meters along
    /// the ray, 1e30 for the sky); with glow also glow.R, .G, .B, so that `R = clean.R * transmittance.Y + rain.R + glow.R` but for panes. With [`Frame::truth`] also of the drop that a pixel shows most of `drop.id_low` and
    /// `drop.id_high` (the halves of its id), `drop.diameter_mm` (0: none), `drop.distance_m` and `drop.alpha`; and of the surface behind
    /// it `wetness.Y`, `water.depth_mm`, `motion.X` and `motion.Y` (pixels per second, to the right and down).
    ///
    /// # Errors
    /// As [`Frame::png`].
    pub fn exr_layers(&self) -> Result<Vec<u8>, RendererError> {
        let ([width, height], picture) = (self.size(), &self.picture);
        let mut channels = layer_channels(&picture.clean, &picture.rain, Some(&picture.radiance()));
        channels.extend(glow_channels(&picture.glow));
        channels.extend(self.truth.as_ref().map(Truth::channels).into_iter().flatten());
        Ok(write_exr_channels([width, height], channels)?)
    }

    /// Writes a .png ([`Frame::png`]) or an .exr ([`Frame::exr`]); complete or not at all. A file that is there is replaced.
    ///
    /// # Errors
    /// [`RendererError::Name`] for another ending, [`RendererError::Write`] for what the system does not let us write.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), RendererError> {
        let path = path.as_ref();
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let bytes = match extension.as_deref() {
            Some("png") => self.png()?,
            Some("exr") => self.exr()?,
            _ => {
                let path = format!("frame {}", path.display());
                return Err(RendererError::Name { path, allowed: ".png or .exr" });
            }
        };
        replace_file(path, &bytes).map_err(|error| RendererError::Write {
            path: path.display().to_string(),
            reason: error.to_string(),
        })
    }
}
