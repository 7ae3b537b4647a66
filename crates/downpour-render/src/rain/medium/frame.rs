//! Optical depth of unresolved rain along a ray.

use bytemuck::{Pod, Zeroable};
use downpour_math::ops;
use downpour_shaders::render::medium::{
    MEDIUM_BOX, MEDIUM_COLUMNS, MEDIUM_CYLINDER, MEDIUM_EVERYWHERE, MEDIUM_FAR, MEDIUM_NEAR, MEDIUM_QUARTERS,
    MEDIUM_SLICES, MEDIUM_SPHERE,
};
use downpour_sim::resolved::Region;
use glam::{Vec2, Vec3, Vec3Swizzles as _, Vec4};

use super::RainMedium;
use crate::rain::project::project_class;

/// Uniforms of the unresolved rain of a picture. The same layout as `MediumFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MediumFrame {
    /// Columns of the grid of open air.
    pub columns: u32,
    /// Its rows.
    pub rows: u32,
    /// One of `MEDIUM_DARK`, `MEDIUM_LAMPS`, `MEDIUM_SPOTS`.
    pub lit: u32,
    /// Class of drops whose mean radiance the medium uses.
    pub shape: u32,
    /// Optical depth of level rays within the region: at 0.25 m, then a factor of 2^(1/3) farther each.
    pub depths: [[f32; 4]; MEDIUM_QUARTERS as usize],
    /// Unit vector against the mean fall.
    pub rise: [f32; 3],
    /// Extinction of all drops, 1/m, for level rays.
    pub all: f32,
    /// Center of the region in which drops are simulated, relative to the scene's origin, m.
    pub center: [f32; 3],
    /// One of `MEDIUM_EVERYWHERE`, `MEDIUM_BOX`, `MEDIUM_SPHERE`, `MEDIUM_CYLINDER`.
    pub region: u32,
    /// Edges of a box; radius and height of others, m.
    pub size: [f32; 3],
    /// Relative excess of the area of a drop's outline from straight above over that from the side.
    pub flatness: f32,
    /// The eye, relative to the scene's origin, m.
    pub eye: [f32; 3],
    /// 1: no obstacle shelters anything from the rain.
    pub open: u32,
    /// A pane before the eye, which keeps rain off this side of it: unit normal away from the eye, and its distance, m; 0: none.
    pub pane: [f32; 4],
    /// Fog: extinction at its base, 1/m; inverse of its height, 1/m (0: the same everywhere); height of the eye above its base, m;
    /// albedo.
    pub fog: [f32; 4],
    /// Fog: width of its phase function, radians; its asymmetry; the rest is unused.
    pub fog_phase: [f32; 4],
    /// Streaks of unresolved drops: unit vector against their motion past the eye.
    pub axis: [f32; 3],
    /// Seed of their places.
    pub seed: u32,
    /// Another axis.
    pub across: [f32; 3],
    /// 1 if drops have streaks, 0 if the medium is even.
    pub is_grainy: u32,
    /// The third axis.
    pub beside: [f32; 3],
    /// Unused.
    pub unused: u32,
    /// Streaks by distance.
    pub shells: [MediumShell; MEDIUM_SLICES as usize],
}

/// Unresolved drops of a shell of distances: their streaks on the picture. The same layout as `MediumShell` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MediumShell {
    /// Number of drops over a pixel that would stand still; 0: there are none.
    pub count: f32,
    /// Length of a streak across the ray, in pixels.
    pub pixels: f32,
    /// Whole rows of streaks that have passed since time 0.
    pub row: u32,
    /// Part of another row.
    pub part: f32,
}

impl MediumFrame {
    /// A medium before an eye, on a picture of so many columns and rows; without lamps, and with nothing that keeps rain off.
    pub(crate) fn new(medium: &RainMedium, eye: Vec3, [width, height]: [u32; 2]) -> Self {
        let mut depths = [[0.0; 4]; MEDIUM_QUARTERS as usize];
        depths.as_flattened_mut().copy_from_slice(&medium.depths);
        let (region, center, size) = match medium.region {
            Region::Box { center, size } => (MEDIUM_BOX, center, size),
            Region::Sphere { center, radius } => (MEDIUM_SPHERE, center, glam::DVec3::splat(radius)),
            Region::Cylinder { base, radius, height } => {
                let center = base + glam::DVec3::Y * (0.5 * height);
                (MEDIUM_CYLINDER, center, glam::DVec3::new(radius, height, radius))
            }
            _ => (MEDIUM_EVERYWHERE, glam::DVec3::ZERO, glam::DVec3::ONE),
        };
        let [fog, fog_phase] = medium.fog.map_or([[0.0; 4]; 2], |fog| super::fog::uniforms(&fog, eye.y));
        let rows = (f64::from(MEDIUM_COLUMNS) * f64::from(height) / f64::from(width.max(1))).round();
        Self {
            depths,
            rise: medium.rise.into(),
            all: medium.all,
            center: center.as_vec3().into(),
            region,
            size: size.as_vec3().into(),
            flatness: medium.flatness,
            eye: eye.into(),
            open: 1,
            columns: MEDIUM_COLUMNS,
            rows: rows.clamp(1.0, f64::from(2 * MEDIUM_COLUMNS)) as u32,
            lit: 0,
            shape: project_class(medium.row),
            pane: medium.pane.map_or([0.0; 4], |pane| pane.outward.extend(pane.distance).into()),
            fog,
            fog_phase,
            axis: Vec3::Y.into(),
            seed: 0,
            across: Vec3::X.into(),
            is_grainy: 0,
            beside: Vec3::Z.into(),
            unused: 0,
            shells: [MediumShell::default(); MEDIUM_SLICES as usize],
        }
    }

    /// Area of the drops' outlines seen along a unit direction, over that from the side.
    pub(super) fn medium_outline(&self, direction: Vec3) -> f32 {
        1.0 + self.flatness * direction.y * direction.y
    }

    /// Optical depth of a level ray within the region.
    pub(super) fn medium_within(&self, distance: f32) -> f32 {
        let at = |entry: u32| self.depths[(entry / 4) as usize][(entry % 4) as usize];
        if distance <= MEDIUM_NEAR {
            return at(0) * distance / MEDIUM_NEAR;
        }
        let last = 4 * MEDIUM_QUARTERS - 1;
        let entry = ((3.0 * ops::log2(distance / MEDIUM_NEAR)) as u32).min(last);
        let near = medium_node(entry);
        let here = at(entry);
        if entry == last {
            return here + self.all * (distance - near);
        }
        let there = at(entry + 1);
        here + (there - here) * ((distance - near) / (medium_node(entry + 1) - near)).clamp(0.0, 1.0)
    }

    /// First and last distance of the part of a ray of unit direction that is in the region.
    fn medium_region(&self, origin: Vec3, direction: Vec3) -> Vec2 {
        let offset = origin - Vec3::from(self.center);
        let whole = Vec2::new(0.0, MEDIUM_FAR);
        let size = Vec3::from(self.size);
        match self.region {
            MEDIUM_BOX => {
                let half = size * 0.5;
                let x = medium_slab(offset.x, direction.x, half.x);
                let y = medium_slab(offset.y, direction.y, half.y);
                let z = medium_slab(offset.z, direction.z, half.z);
                medium_both(medium_both(x, y), z)
            }
            MEDIUM_SPHERE => {
                let outside = offset.dot(offset) - size.x * size.x;
                medium_both(medium_roots(1.0, offset.dot(direction), outside), whole)
            }
            MEDIUM_CYLINDER => {
                let up = medium_slab(offset.y, direction.y, size.y * 0.5);
                let across = direction.xz().dot(direction.xz());
                let outside = offset.xz().dot(offset.xz()) - size.x * size.x;
                if across < 1.0e-9 {
                    return if outside < 0.0 { medium_both(up, whole) } else { Vec2::splat(MEDIUM_FAR) };
                }
                medium_both(up, medium_roots(across, offset.xz().dot(direction.xz()), outside))
            }
            _ => whole,
        }
    }

    /// Distance at which a ray from the eye comes through the pane.
    pub(in crate::rain) fn medium_begin(&self, direction: Vec3) -> f32 {
        let pane = Vec4::from(self.pane);
        if pane.w <= 0.0 {
            return 0.0;
        }
        (pane.w / direction.dot(pane.truncate()).max(1.0e-9)).min(MEDIUM_FAR)
    }

    /// A ray of unit direction from the eye: the part of it that is in the region, and where it comes through the pane.
    pub(crate) fn medium_span(&self, direction: Vec3) -> Vec3 {
        self.medium_region(self.eye.into(), direction).extend(self.medium_begin(direction))
    }

    /// Optical depth of all unresolved drops up to a distance, on whichever side of the pane.
    fn medium_path(&self, distance: f32, region: Vec2) -> f32 {
        let low = distance.min(region.x);
        let high = (distance - region.y).max(0.0);
        let within = self.medium_within(distance.clamp(region.x, region.y)) - self.medium_within(region.x);
        self.all * (low + high) + within
    }

    /// Optical depth of unresolved drops up to a distance along a ray from the eye, if nothing but the pane keeps rain off.
    pub(crate) fn medium_depth(&self, distance: f32, span: Vec3, outline: f32) -> f32 {
        (self.medium_path(distance.max(span.z), span.xy()) - self.medium_path(span.z, span.xy())) * outline
    }
}

/// Distance of an entry of the table, m.
pub(super) fn medium_node(entry: u32) -> f32 {
    MEDIUM_NEAR * ops::exp2(entry as f32 / 3.0)
}

/// First and last distance of a coordinate between `-half` and `half`, of a ray that begins at `from`.
fn medium_slab(from: f32, rate: f32, half: f32) -> Vec2 {
    if rate.abs() < 1.0e-9 {
        return if from.abs() <= half { Vec2::new(0.0, MEDIUM_FAR) } else { Vec2::new(MEDIUM_FAR, 0.0) };
    }
    let (a, b) = ((-half - from) / rate, (half - from) / rate);
    Vec2::new(a.min(b), a.max(b))
}

/// First and last distance at which `a t^2 + 2 b t + c` is below 0, for `a` above 0.
pub(super) fn medium_roots(a: f32, b: f32, c: f32) -> Vec2 {
    let root = b * b - a * c;
    if root <= 0.0 {
        return Vec2::new(MEDIUM_FAR, 0.0);
    }
    Vec2::new(-b - root.sqrt(), -b + root.sqrt()) / a
}

/// The part of two parts of a ray that both have, from its beginning on; nothing is `MEDIUM_FAR` twice.
pub(super) fn medium_both(a: Vec2, b: Vec2) -> Vec2 {
    let low = a.x.max(b.x).max(0.0);
    let high = a.y.min(b.y);
    if high > low { Vec2::new(low, high) } else { Vec2::splat(MEDIUM_FAR) }
}
