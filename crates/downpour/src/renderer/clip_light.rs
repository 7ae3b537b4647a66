//! The light of the frames of a clip before a frame, with which its own is averaged.

use downpour_math::OutOfRange;
use downpour_render::RenderError;
use downpour_render::rain::RainMedium;
use downpour_trace::frame_scene::FrameScene;
use downpour_trace::kept::PlateUse;
use downpour_trace::running_light::RunningFrame;
use downpour_trace::temporal::{LightWindow, MAX_LIGHT_FRAMES};

use super::{Progress, Renderer, RendererError};

/// Frames of a clip over which the light of sky and surfaces on surfaces is averaged, against flicker: a temporal filter.
///
/// It is the mean of what a frame and those before it have found on the same surface ([`downpour_trace::temporal`]). A frame that is rendered
/// alone is that of the clip: the light of the frames before it is found first, which takes as long as their scenes do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipLight {
    /// Number of frames with the frame itself, 1 to [`ClipLight::MAX_FRAMES`]; 1: each has its own light. Near the clip's first frame there
    /// are fewer.
    pub frames: u32,
    /// Frames per second of the clip, above 0. Its frame 0 is at [`RendererOptions::first_s`](super::RendererOptions::first_s).
    pub frames_per_s: f64,
}

impl ClipLight {
    /// Number of frames that halves the noise.
    pub const FRAMES: u32 = 4;

    /// Greatest number of frames.
    pub const MAX_FRAMES: u32 = MAX_LIGHT_FRAMES as u32;

    /// # Errors
    /// [`RendererError::Render`] for numbers out of range.
    pub(super) fn check(&self) -> Result<(), RendererError> {
        let bad = |quantity, found, unit, allowed: &'static str| {
            let allowed = allowed.into();
            Err(RenderError::OutOfRange(OutOfRange { quantity, found, unit, allowed }).into())
        };
        if !(1..=Self::MAX_FRAMES).contains(&self.frames) {
            return bad("frames over which light is averaged", f64::from(self.frames), "", "1 to 8");
        }
        if !(self.frames_per_s > 0.0 && self.frames_per_s.is_finite()) {
            return bad("frames of a clip", self.frames_per_s, "1/s", "above 0");
        }
        Ok(())
    }

    /// Times in seconds of the frames before that of a time, the latest first, as far as the clip has begun.
    fn before(&self, first_s: f64, time_s: f64) -> [Option<f64>; MAX_LIGHT_FRAMES - 1] {
        let at = |number: f64| first_s + number / self.frames_per_s;
        let number = (time_s - first_s) * self.frames_per_s;
        let whole = number.round();
        // The times of whole frames are those of the clip to the bit.
        let number = if at(whole).to_bits() == time_s.to_bits() { whole } else { number };
        std::array::from_fn(|k| {
            let back = k + 1;
            let before = number - back as f64;
            (back < self.frames as usize && before >= 0.0).then(|| at(before))
        })
    }
}

impl Renderer {
    /// Parts of a frame's plate that stay, and frames with which its light is averaged.
    pub(super) fn plate_use(&self, frame_scene: &FrameScene, time_s: f64) -> PlateUse {
        let window = |light: ClipLight| LightWindow {
            time_s,
            origin: frame_scene.origin,
            before_s: light.before(self.options.first_s, time_s),
        };
        let running =
            RunningFrame { time_s, origin: frame_scene.origin, frames: self.options.running_frames };
        PlateUse {
            kept_frames: self.options.kept_frames,
            light: self.clip_light().map(window),
            running: Some(running),
        }
    }

    /// Frames over which light is averaged, if there are several. The light of a plate that is refined has its mean over frames there.
    fn clip_light(&self) -> Option<ClipLight> {
        self.options.clip_light.filter(|light| self.options.kept_frames == 0 && light.frames > 1)
    }

    /// Finds the light of the frames before that of a time, as far as it is not there.
    pub(super) fn find_light_before(
        &mut self,
        time_s: f64,
        told: &mut dyn FnMut(Progress),
    ) -> Result<(), RendererError> {
        let Some(light) = self.clip_light() else { return Ok(()) };
        let before = light.before(self.options.first_s, time_s);
        for time_s in before.into_iter().flatten().rev().collect::<Vec<_>>() {
            if self.drawer.has_light(time_s) {
                continue;
            }
            let frame_scene = self.wet(time_s, told)?;
            told(Progress { what: "light of the frames before", parts: [0; 2] });
            let options = self.picture_options(&frame_scene, time_s, RainMedium::default())?;
            if let Some(window) = self.plate_use(&frame_scene, time_s).light {
                self.drawer.find_light(&window, &frame_scene, &options)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_before_are_those_of_the_clip_to_the_bit() {
        let light = ClipLight { frames: 4, frames_per_s: 23.976 };
        let at = |number: u32| 7.3 + f64::from(number) / 23.976;
        for number in [3, 10, 997] {
            let before = light.before(7.3, at(number));
            assert_eq!(before[..3], [1, 2, 3].map(|back| Some(at(number - back))));
            assert_eq!(before[3..], [None; 4]);
        }
        // The first frames have fewer.
        assert_eq!(light.before(7.3, at(1))[..2], [Some(7.3), None]);
        assert_eq!(light.before(7.3, 7.3), [None; 7]);
        // Between two frames.
        let between = light.before(0.0, 1.0 / 16.0);
        assert!((between[0].unwrap_or_default() - (1.0 / 16.0 - 1.0 / 23.976)).abs() < 1.0e-12);
        assert_eq!(between[1], None);
    }

    #[test]
    fn numbers_out_of_range_are_errors() {
        for (frames, frames_per_s) in [(0, 24.0), (9, 24.0), (4, 0.0), (4, f64::NAN), (4, f64::INFINITY)] {
            assert!(ClipLight { frames, frames_per_s }.check().is_err(), "{frames} {frames_per_s}");
        }
        assert!(ClipLight { frames: 8, frames_per_s: 1.0e-3 }.check().is_ok());
    }
}
