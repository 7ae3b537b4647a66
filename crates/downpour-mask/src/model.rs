//! The mask of a drop given as a mesh. Twin of `shaders/wgsl/mask/model.wgsl`.
//!
//! Rays are the same as for a drop of revolution: refraction at the first surface, total reflections inside,
//! refraction at the last; and light reflected inside once without being totally reflected. Normals are interpolated
//! over the triangles. A texel whose corners and center agree is covered or not; the others are sampled by 8 by 8
//! rays and traced at the middle of those that hit, or, if the middle misses, at the nearest of them.
//!
//! Limits: light that leaves the mesh and would enter it again (a hollow in the outline) is not followed.

use downpour_drop::optics::{optics_fresnel_polarized, optics_reflect, optics_refract};
use downpour_math::vector::{add_scaled, normalize, scale};
use downpour_shaders::mask::{MASK_MODEL_MIN_DISTANCE, MASK_MODEL_SUBSAMPLES, MASK_TRACE_REFLECTIONS};
use rayon::prelude::*;

use crate::closed_mesh::ClosedMesh;
use crate::trace::{Exit, mask_trace_plane_turn, mask_trace_reflectance};
use crate::{Mask, MaskError, MaskOptions, MaskTexel, View};
use downpour_bvh::{Bvh, Hit};

/// A mesh rotated into the frame of a view, with its BVH.
#[derive(Clone, Debug)]
pub struct TracedModel {
    pub(crate) bvh: Bvh,
    /// Normals of the three corners of each triangle.
    pub(crate) normals: Vec<[[f32; 3]; 3]>,
    /// Start of the rays along z, in front of the model.
    pub(crate) front: f32,
    pub(crate) half_extent: f64,
    pub(crate) index: f32,
}

impl TracedModel {
    /// Turns a mesh into the frame of the view of `options`.
    ///
    /// # Errors
    /// [`MaskError::Size`] or [`MaskError::OutOfRange`] if an option is out of range.
    pub fn new(mesh: &ClosedMesh, options: &MaskOptions) -> Result<Self, MaskError> {
        options.check()?;
        let [_, cos, sin] = options.view.up().map(|c| c as f32);
        let turn = |p: [f32; 3]| [p[0], p[1] * cos - p[2] * sin, p[1] * sin + p[2] * cos];
        let positions: Vec<_> = mesh.positions.iter().map(|p| turn(*p)).collect();
        let corners: Vec<_> = mesh.triangles.iter().map(|t| t.map(|i| positions[i as usize])).collect();
        let normals = mesh.triangles.iter().map(|t| t.map(|i| turn(mesh.normals[i as usize]))).collect();
        let wide = corners.iter().flatten().flat_map(|p| [p[0].abs(), p[1].abs()]).fold(0.0, f32::max);
        let front = corners.iter().flatten().map(|p| p[2]).fold(f32::NEG_INFINITY, f32::max) + 1.0;
        let size = f64::from(options.size);
        Ok(Self {
            bvh: Bvh::new(&corners),
            normals,
            front,
            half_extent: f64::from(wide) * size / (size - 2.0),
            index: options.refractive_index as f32,
        })
    }

    /// Hit of the viewer's ray through (x, y) with the mesh, if any.
    fn mask_model_hit(&self, x: f32, y: f32) -> Option<Hit> {
        self.bvh.hit([x, y, self.front], [0.0, 0.0, -1.0], MASK_MODEL_MIN_DISTANCE)
    }

    /// The interpolated normal at a hit.
    fn mask_model_normal(&self, hit: &Hit) -> [f32; 3] {
        let [a, b, c] = self.normals[hit.triangle as usize];
        let first = scale(a, 1.0 - hit.u - hit.v);
        normalize(add_scaled(add_scaled(first, b, hit.u), c, hit.v))
    }

    /// Exit of light that starts at `start`, along `inside`, after total reflections; `None` if it does not leave. A ray
    /// without an exit has slipped along an edge of the surface: it counts as lost.
    fn mask_model_exit(&self, start: [f32; 3], inside: [f32; 3]) -> Option<Exit<f32>> {
        let (mut point, mut inside) = (start, inside);
        for reflections in 0..=MASK_TRACE_REFLECTIONS {
            let hit = self.bvh.hit(point, inside, MASK_MODEL_MIN_DISTANCE)?;
            let normal = self.mask_model_normal(&hit);
            point = add_scaled(point, inside, hit.distance);
            let (outside, cos2) = optics_refract(inside, scale(normal, -1.0), self.index);
            if cos2 >= 0.0 {
                return Some(Exit {
                    point,
                    normal,
                    inside,
                    outside,
                    reflections: reflections as f32,
                    lost: 0.0,
                });
            }
            inside = normalize(optics_reflect(inside, normal));
        }
        None
    }

    /// The texel at (x, y) for a ray that hits at `hit`, with the coverage left at 0.
    fn mask_model_through(&self, x: f32, y: f32, hit: &Hit) -> MaskTexel {
        let incident = [0.0, 0.0, -1.0];
        let index = self.index;
        let entry_normal = self.mask_model_normal(hit);
        let [entry_s, entry_p] = optics_fresnel_polarized(entry_normal[2].max(0.0), index);
        let entered = 1.0 - (entry_s + entry_p) * 0.5;
        let reflected = normalize(optics_reflect(incident, entry_normal));
        let (refracted, _) = optics_refract(incident, entry_normal, 1.0 / index);
        let inside = normalize(refracted);
        let Some(exit) = self.mask_model_exit([x, y, self.front - hit.distance], inside) else {
            return MaskTexel {
                direction: inside,
                reflected,
                internal: inside,
                reflections: MASK_TRACE_REFLECTIONS + 1,
                ..MaskTexel::default()
            };
        };
        let mut polarized = 0.0;
        if exit.reflections == 0.0 {
            polarized = (entry_p - entry_s) * 0.5 * mask_trace_plane_turn(inside, entry_normal, exit.normal);
        }
        let [exit_s, exit_p] = mask_trace_reflectance(&exit, index);
        let transmittance = entered * (1.0 - (exit_s + exit_p) * 0.5) + polarized * (exit_p - exit_s) * 0.5;
        let direction = normalize(exit.outside);
        let texel = MaskTexel {
            direction,
            reflected,
            transmittance,
            internal: direction,
            reflections: exit.reflections as u32,
            ..MaskTexel::default()
        };
        let back = normalize(optics_reflect(exit.inside, exit.normal));
        let Some(second) = self.mask_model_exit(exit.point, back) else { return texel };
        let kept = entered - transmittance;
        let mut kept_polarized = (entered * (exit_s - exit_p) + polarized * (exit_s + exit_p)) * 0.5;
        if second.reflections == 0.0 {
            kept_polarized *= mask_trace_plane_turn(back, exit.normal, second.normal);
        } else {
            kept_polarized = 0.0;
        }
        let [second_s, second_p] = mask_trace_reflectance(&second, index);
        MaskTexel {
            internal: normalize(second.outside),
            internal_transmittance: kept * (1.0 - (second_s + second_p) * 0.5)
                + kept_polarized * (second_p - second_s) * 0.5,
            ..texel
        }
    }

    /// Texel of width `pixel` centered at (x, y).
    fn mask_model_texel(&self, x: f32, y: f32, pixel: f32) -> MaskTexel {
        let half = 0.5 * pixel;
        let center = self.mask_model_hit(x, y);
        let corners = [[-half, -half], [half, -half], [-half, half], [half, half]]
            .map(|[dx, dy]| self.mask_model_hit(x + dx, y + dy).is_some());
        if center.is_none() && corners == [false; 4] {
            return MaskTexel::default();
        }
        if let Some(hit) = center.filter(|_| corners == [true; 4]) {
            return MaskTexel { coverage: 1.0, ..self.mask_model_through(x, y, &hit) };
        }
        // The outline cuts the texel.
        let n = MASK_MODEL_SUBSAMPLES;
        let step = pixel / n as f32;
        let sample = |i: u32| {
            let (column, row) = (i % n, i / n);
            [x - half + (column as f32 + 0.5) * step, y - half + (row as f32 + 0.5) * step]
        };
        let mut count = 0u32;
        let mut sum = [0.0f32; 2];
        for i in 0..n * n {
            let [px, py] = sample(i);
            if self.mask_model_hit(px, py).is_some() {
                count += 1;
                sum = [sum[0] + px, sum[1] + py];
            }
        }
        if count == 0 {
            return MaskTexel::default();
        }
        let middle = [sum[0] / count as f32, sum[1] / count as f32];
        let coverage = count as f32 / (n * n) as f32;
        if let Some(hit) = self.mask_model_hit(middle[0], middle[1]) {
            return MaskTexel { coverage, ..self.mask_model_through(middle[0], middle[1], &hit) };
        }
        // The covered part is not convex: take the sample nearest to its middle.
        let mut best = (f32::INFINITY, [0.0; 2], None);
        for i in 0..n * n {
            let [px, py] = sample(i);
            let square = (px - middle[0]) * (px - middle[0]) + (py - middle[1]) * (py - middle[1]);
            if square < best.0
                && let Some(hit) = self.mask_model_hit(px, py)
            {
                best = (square, [px, py], Some(hit));
            }
        }
        match best {
            (_, [px, py], Some(hit)) => MaskTexel { coverage, ..self.mask_model_through(px, py, &hit) },
            _ => MaskTexel::default(),
        }
    }
}

/// Traces the mask of a drop model, rows in parallel. The model's +Y is the drop's axis.
///
/// `diameter` is written to the mask, in meters; `None` takes the model's units for meters.
///
/// # Errors
/// [`MaskError::Size`] or [`MaskError::OutOfRange`] if an option is out of range.
pub fn trace_model(
    mesh: &ClosedMesh,
    options: &MaskOptions,
    diameter: Option<f64>,
) -> Result<Mask, MaskError> {
    Ok(traced(&TracedModel::new(mesh, options)?, mesh, options, diameter))
}

/// Traces the masks of a drop model from several views, all at the scale of the one that shows it largest.
///
/// # Errors
/// As [`trace_model`].
pub fn trace_model_views(
    mesh: &ClosedMesh,
    options: &MaskOptions,
    views: &[View],
) -> Result<Vec<Mask>, MaskError> {
    let seen = views.iter().map(|&view| {
        let options = MaskOptions { view, ..*options };
        TracedModel::new(mesh, &options).map(|model| (model, options))
    });
    let mut seen: Vec<(TracedModel, MaskOptions)> = seen.collect::<Result<_, _>>()?;
    let widest = seen.iter().map(|(model, _)| model.half_extent).fold(0.0, f64::max);
    let traced = seen.iter_mut().map(|(model, options)| {
        model.half_extent = widest;
        traced(model, mesh, options, None)
    });
    Ok(traced.collect())
}

/// Traces a turned model.
fn traced(model: &TracedModel, mesh: &ClosedMesh, options: &MaskOptions, diameter: Option<f64>) -> Mask {
    let mut mask = empty(mesh, options, diameter, model);
    let size = options.size as usize;
    let pixel = mask.texel_width() as f32;
    mask.texels = vec![MaskTexel::default(); size * size];
    let middle = size as f32 * 0.5;
    mask.texels.par_chunks_mut(size).enumerate().for_each(|(row, texels)| {
        let y = (middle - row as f32 - 0.5) * pixel;
        for (column, texel) in texels.iter_mut().enumerate() {
            let x = (column as f32 + 0.5 - middle) * pixel;
            *texel = model.mask_model_texel(x, y, pixel);
        }
    });
    mask
}

/// A mask of the model without its texels.
pub(crate) fn empty(
    mesh: &ClosedMesh,
    options: &MaskOptions,
    diameter: Option<f64>,
    model: &TracedModel,
) -> Mask {
    Mask {
        size: options.size,
        diameter: diameter.unwrap_or(mesh.diameter),
        view: options.view,
        refractive_index: options.refractive_index,
        half_extent: model.half_extent,
        texels: Vec::new(),
    }
}
