//! A streak in time: where its drop is at an instant of the exposure, what shape it has then, and the rays that pass it. Twin of
//! `shaders/wgsl/render/streak_path.wgsl`, where the method is described.

use downpour_drop::oscillation::{drop_oscillation_inverse_cube_root, drop_oscillation_sine};
use downpour_drop::shape::{COEFFICIENTS, DropShapeCoefficients};
use downpour_mask::wobble::WobbleDrop;
use glam::{Vec2, Vec3};

use super::glint::drop_glint_right;
use super::streak::{ScreenDrop, streak_depth};
use super::streak_span::{streak_span, streak_span_time};

/// A streak that has a profile, or a class of drops that has a mean. The same layout as `StreakPath` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct StreakPath {
    /// Coefficients of the shape at rest.
    pub shape: DropShapeCoefficients,
    /// The first four coefficients of the volume over that of the shape at rest.
    pub volume: [f32; 4],
    /// Fifth coefficient of the volume.
    pub volume_last: f32,
    /// Half the width of the shape at rest, in equivalent radii.
    pub wide: f32,
    /// Half its height.
    pub tall: f32,
    /// Refractive index of water relative to air.
    pub index: f32,
    /// Cosine and sine of the azimuth of the lobe of the mode (3,1), from +X toward +Z.
    pub lobe: [f32; 2],
    /// Amplitudes of the modes (2,0) and (3,1), over the radius.
    pub amplitudes: [f32; 2],
    /// Instants whose rays are traced.
    pub rows: u32,
    /// Columns across the motion; along a chord there are as many rays.
    pub columns: u32,
    /// Instants of the profile.
    pub profile_rows: u32,
    /// Columns of the profile for each of the rays'.
    pub fine: u32,
    /// First of its rays.
    pub first_ray: u32,
    /// First of its entries in the table.
    pub first_entry: u32,
    /// Index of the drop among the picture's.
    pub drop: u32,
    /// 0.
    pub unused: u32,
}

/// A drop at the time of a row of its profile.
#[derive(Clone, Copy, Debug)]
pub(super) struct StreakInstant {
    /// Middle of the drop on the plane.
    pub(super) middle: Vec2,
    /// Equivalent radius on the plane.
    pub(super) scale: f32,
    pub(super) time: f32,
    /// Time in which it moves by an equivalent radius.
    pub(super) pace: f32,
    /// Fraction of the way along a chord by which its rays go through other points of the plane.
    pub(super) follow: f32,
    /// See [`StreakSpan`](super::streak_span::StreakSpan).
    pub(super) funnel: f32,
}

/// A drop at the time of a row of its profile, by the fraction of the rows before it.
pub(super) fn streak_path_instant(drop: &ScreenDrop, row: f32) -> StreakInstant {
    let span = streak_span(drop);
    let time = streak_span_time(&span, row);
    let way = time * drop.depth_ratio / (1.0 - time + time * drop.depth_ratio).max(1.0e-20);
    let scale = drop.slope / streak_depth(drop.depth_ratio, time);
    let faster = way + (1.0 - way) * drop.depth_ratio;
    let rate = drop.depth_ratio / (faster * faster).max(1.0e-12);
    let along = Vec2::from(drop.along);
    let moves = along.dot(along).sqrt().max(1.0e-20);
    StreakInstant {
        middle: Vec2::from(drop.start) + along * way,
        scale,
        time,
        pace: rate * scale / moves,
        follow: 1.0 - span.parallel,
        funnel: span.funnel,
    }
}

/// The unit vector along the motion on the plane, and the one across it.
pub(super) fn streak_path_axes(drop: &ScreenDrop) -> [Vec2; 2] {
    let along = Vec2::from(drop.along);
    let along = along / along.dot(along).sqrt().max(1.0e-20);
    [along, Vec2::new(along.y, -along.x)]
}

impl StreakPath {
    /// s2 and s3 at a time.
    pub(super) fn streak_path_displacement(&self, drop: &ScreenDrop, time: f32) -> [f32; 2] {
        [
            self.amplitudes[0] * drop_oscillation_sine(drop.mode_phase[2] + drop.cycles[0] * time),
            self.amplitudes[1] * drop_oscillation_sine(drop.mode_phase[3] + drop.cycles[1] * time),
        ]
    }

    /// The coefficients of the shape, as the tracer wants them.
    pub(super) fn coefficients(&self) -> [f64; COEFFICIENTS] {
        let DropShapeCoefficients { c0, c1, c2 } = self.shape;
        let all = [c0, c1, c2].concat();
        std::array::from_fn(|k| all[k].into())
    }

    /// The drop with these displacements; `coefficients` are [`StreakPath::coefficients`].
    pub(super) fn streak_path_body(
        &self,
        coefficients: [f64; COEFFICIENTS],
        [s2, s3]: [f32; 2],
    ) -> WobbleDrop<f32> {
        let [x, y, z, w] = self.volume;
        let even = s2 * (x + s2 * (y + s2 * z));
        let odd = s3 * s3 * (w + s2 * self.volume_last);
        let size = drop_oscillation_inverse_cube_root(1.0 + (even + odd));
        let wide = self.wide * (1.0 - 0.5 * s2) * size;
        let tall = self.tall * (1.0 + s2) * size;
        WobbleDrop {
            coefficients,
            state: [s2, s3, size],
            index: self.index.into(),
            inverse_wide: 1.0 / (wide * wide),
            inverse_tall: 1.0 / (tall * tall),
        }
    }

    /// A vector of the world in the frame of the drop.
    pub(super) fn streak_path_turned(&self, v: Vec3) -> Vec3 {
        let [cosine, sine] = self.lobe;
        Vec3::new(v.x * cosine + v.z * sine, v.y, v.z * cosine - v.x * sine)
    }

    /// The inverse.
    pub(super) fn streak_path_back(&self, v: Vec3) -> Vec3 {
        let [cosine, sine] = self.lobe;
        Vec3::new(v.x * cosine - v.z * sine, v.y, v.z * cosine + v.x * sine)
    }

    /// A ray of the pixel whose ray is `point.x` beside the path, when it is `point.y` ahead of the drop's middle, in the frame of the
    /// drop: the point on the plane, and the direction.
    pub(super) fn streak_path_line(
        &self,
        drop: &ScreenDrop,
        instant: &StreakInstant,
        point: Vec2,
    ) -> [Vec3; 2] {
        let [along, across] = streak_path_axes(drop);
        let offset = across * (point.x * (1.0 + instant.funnel * point.y)) + along * point.y;
        let through = across * point.x + along * (instant.follow * point.y);
        let towards = Vec3::from(drop.towards);
        let right = drop_glint_right(towards);
        let up = right.cross(towards);
        let position = instant.middle + through * instant.scale;
        let direction = towards + right * position.x + up * position.y;
        let direction = direction / direction.dot(direction).sqrt();
        let origin = right * offset.x + up * offset.y;
        [self.streak_path_turned(origin), self.streak_path_turned(direction)]
    }
}
