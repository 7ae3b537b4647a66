//! Pictures that were drawn, with what the window shows about them.

use std::sync::Arc;

use downpour::sim::field::VisibleDrops;
use downpour::trace::frame_scene::FrameScene;
use egui::ColorImage;
use glam::{DVec2, DVec3};

/// A picture.
#[derive(Debug)]
pub struct Drawn {
    /// Number of the question.
    pub number: u64,
    /// Revision of the document that it shows.
    pub revision: u64,
    /// Time, s.
    pub time_s: f64,
    /// Columns and rows.
    pub size: [u32; 2],
    /// Samples along an edge of a pixel.
    pub samples: u32,
    /// Its pixels in sRGB, opaque, rows from the top.
    pub image: Arc<ColorImage>,
    /// The camera that it is seen by.
    pub view: PictureView,
    /// The scene, for rays to its surfaces.
    pub frame_scene: Arc<FrameScene>,
    /// Number of drops in it.
    pub drops_drawn: usize,
    /// The drops that it could show, and the indices of those in it, nearest first, where they were asked for.
    pub drops: Option<(VisibleDrops, Vec<u32>)>,
    /// Time of each pass, ms.
    pub passes: Vec<(&'static str, f64)>,
    /// Time until it was on its way, ms.
    pub begin_ms: f64,
    /// Time that it took, ms: from the question, or from the picture before if that was under way, to the picture.
    pub frame_ms: f64,
    /// True if a flash of lightning is in it: such a picture is drawn several times and says nothing of the next.
    pub is_in_flash: bool,
    /// Adapter that drew it.
    pub adapter: String,
    /// Brightness of its pixels.
    pub histogram: Histogram,
}

/// A camera in f64 with its picture's edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureView {
    /// Position of the eye, m.
    pub eye: DVec3,
    /// Unit vector to the right.
    pub right: DVec3,
    /// Unit vector up in the picture.
    pub up: DVec3,
    /// Unit view direction.
    pub forward: DVec3,
    /// Tangent of half the vertical field of view.
    pub half_height: f64,
    /// Width over height.
    pub aspect: f64,
}

impl PictureView {
    /// The camera of an eye, up +Y.
    #[must_use]
    pub fn new(eye: DVec3, forward: DVec3, fov_y: f64, aspect: f64) -> Self {
        let forward = forward.try_normalize().unwrap_or(DVec3::NEG_Z);
        let right = forward.cross(DVec3::Y).try_normalize().unwrap_or(DVec3::X);
        let half_height = downpour::math::ops::f64::tan(fov_y * 0.5);
        Self { eye, right, up: right.cross(forward), forward, half_height, aspect }
    }

    /// Place of a point in the picture, 0 to 1 from the upper left corner, and its depth in m; `None` behind the eye.
    #[must_use]
    pub fn project(&self, point: DVec3) -> Option<(DVec2, f64)> {
        let offset = point - self.eye;
        let depth = offset.dot(self.forward);
        (depth > 1.0e-3).then(|| {
            let x = offset.dot(self.right) / (depth * self.half_height * self.aspect);
            let y = offset.dot(self.up) / (depth * self.half_height);
            (DVec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * y), depth)
        })
    }

    /// Unit direction of the ray through a place of the picture.
    #[must_use]
    pub fn ray(&self, place: DVec2) -> DVec3 {
        let (x, y) = (2.0 * place.x - 1.0, 1.0 - 2.0 * place.y);
        let aside = self.right * (x * self.half_height * self.aspect) + self.up * (y * self.half_height);
        (self.forward + aside).normalize()
    }

    /// Meters at a depth for the height of the picture.
    #[must_use]
    pub fn height_at(&self, depth: f64) -> f64 {
        2.0 * self.half_height * depth
    }
}

/// Bins of a histogram.
pub(super) const BINS: usize = 64;

/// Pixels that are counted, about.
const COUNTED: usize = 1 << 17;

/// Distribution of the brightness of pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// Fraction of the pixels by their luma, from black to white.
    pub bins: [f32; BINS],
    /// Fraction of the pixels with a channel that is white.
    pub white: f32,
    /// Fraction of the pixels that are black.
    pub black: f32,
}

impl Histogram {
    /// Histogram of pixels, by their luma of Rec. 709: of all of them, or of evenly spread ones of a large picture.
    #[must_use]
    pub fn of(pixels: &[[u8; 4]]) -> Self {
        // Odd, so that they are not of a few columns.
        let step = (pixels.len() / COUNTED) | 1;
        let mut counts = [0u32; BINS];
        let (mut white, mut black) = (0u32, 0u32);
        for &[r, g, b, _] in pixels.iter().step_by(step) {
            let luma = (2126 * u32::from(r) + 7152 * u32::from(g) + 722 * u32::from(b)) / 10_000;
            counts[(luma as usize * BINS) / 256] += 1;
            white += u32::from(r.max(g).max(b) == 255);
            black += u32::from(r.max(g).max(b) == 0);
        }
        let all = (pixels.len().div_ceil(step) as f32).max(1.0);
        Self {
            bins: counts.map(|count| count as f32 / all),
            white: white as f32 / all,
            black: black as f32 / all,
        }
    }
}

/// Passes of the scene without rain.
const PLATE_PASSES: [&str; 3] = ["scene", "skylight", "refine"];

impl Drawn {
    /// Time of the scene without rain, ms.
    #[must_use]
    pub fn plate_ms(&self) -> f64 {
        self.passes.iter().filter(|(name, _)| PLATE_PASSES.contains(name)).map(|(_, ms)| ms).sum()
    }

    /// Time of everything else, ms.
    #[must_use]
    pub fn rain_ms(&self) -> f64 {
        self.frame_ms - self.plate_ms()
    }

    /// The nearest surface along a ray from the eye, m from it; `None` for the sky.
    #[must_use]
    pub fn distance(&self, direction: DVec3) -> Option<f64> {
        self.nearest(self.view.eye, direction)
    }

    /// The surface below a point, m.
    #[must_use]
    pub fn ground_below(&self, point: DVec3) -> Option<DVec3> {
        self.nearest(point, DVec3::NEG_Y).map(|distance| point - DVec3::Y * distance)
    }

    fn nearest(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let origin = (origin - self.frame_scene.origin).as_vec3().to_array();
        let data = &self.frame_scene.data;
        let direction = direction.as_vec3().to_array();
        let hit = downpour::bvh::bvh_hit(&data.nodes, &data.triangles, origin, direction, 0.0, f32::INFINITY);
        hit.map(|hit| f64::from(hit.distance))
    }

    /// Corners of the box round the scene, m.
    #[must_use]
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let (low, high) = self.frame_scene.data.bounds();
        (low.as_dvec3() + self.frame_scene.origin, high.as_dvec3() + self.frame_scene.origin)
    }

    /// The list of drops that are drawn, as `downpour render --dump-drops` writes it, where it was asked for.
    #[must_use]
    pub fn drops_csv(&self) -> Option<String> {
        use std::fmt::Write as _;
        let mut text = String::from("id,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,diameter_mm,kind\n");
        let (drops, in_picture) = self.drops.as_ref()?;
        for drop in in_picture.iter().filter_map(|&index| drops.drops.get(index as usize)) {
            let [x, y, z] = drop.position.to_array();
            let [vx, vy, vz] = drop.velocity.map(|v| v + 0.0);
            let (mm, kind) = (drop.diameter * 1.0e3, drop.kind.name());
            let _ = writeln!(text, "{},{x},{y},{z},{vx},{vy},{vz},{mm},{kind}", drop.id);
        }
        Some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_goes_through_its_place() {
        let view = PictureView::new(DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.3, -0.2, -1.0), 0.9, 16.0 / 9.0);
        for place in [DVec2::new(0.5, 0.5), DVec2::new(0.1, 0.9), DVec2::new(0.97, 0.2)] {
            let (found, depth) = view.project(view.eye + view.ray(place) * 7.0).unwrap();
            assert!((found - place).length() < 1.0e-12 && depth > 0.0 && depth <= 7.0 + 1.0e-9);
        }
        assert_eq!(view.project(view.eye - view.forward), None);
        // The upper edge is half the field of view above the center.
        let angle = view.ray(DVec2::new(0.5, 0.0)).angle_between(view.forward);
        assert!((angle - 0.45).abs() < 1.0e-12);
    }

    #[test]
    fn the_histogram_counts_every_pixel_once() {
        let histogram =
            Histogram::of(&[[0, 0, 0, 255], [255; 4], [128, 128, 128, 255], [128, 128, 128, 255]]);
        assert_eq!(histogram.bins.iter().sum::<f32>(), 1.0);
        assert_eq!((histogram.bins[0], histogram.bins[32], histogram.bins[63]), (0.25, 0.5, 0.25));
        assert_eq!((histogram.white, histogram.black), (0.25, 0.25));
        // Of a large picture: the left half is dark.
        let large: Vec<[u8; 4]> =
            (0..1920 * 1080).map(|i| [if i % 1920 < 960 { 0 } else { 255 }; 4]).collect();
        let histogram = Histogram::of(&large);
        assert!((histogram.bins.iter().sum::<f32>() - 1.0).abs() < 1.0e-5);
        assert!((histogram.black - 0.5).abs() < 0.01 && (histogram.white - 0.5).abs() < 0.01);
    }
}
