//! Mask of a drop of revolution. Twin of `shaders/wgsl/mask/drop.wgsl`.
//!
//! [`trace_drop`] is the fast path: SIMD, rows in parallel, and half of the texels, because a drop of revolution is
//! mirror-symmetric. [`trace_drop_scalar`] is the plain loop over all texels, the twin of the GPU kernel; the two
//! give the same bits. [`trace_drop_f64`] is the reference for both.

use downpour_drop::shape::DropShape;
use downpour_math::real::{Lanes, Real, Simd, WithLanes, with_widest_lanes};
use downpour_shaders::mask::{MASK_TRACE_REFLECTIONS, MASK_TRACE_STEPS};
use rayon::prelude::*;

use crate::silhouette::mask_silhouette_cut;
use crate::trace::{TracedDrop, mask_trace_through};
use crate::{Mask, MaskError, MaskOptions, MaskTexel};

/// Upper bound of the number of SIMD lanes.
const MAX_LANES: usize = 64;

/// Newton steps of the reference.
const REFERENCE_STEPS: u32 = 16;

/// Texel as the tracer returns it, before it is stored.
struct Texel<R> {
    direction: [R; 3],
    coverage: R,
    reflected: [R; 3],
    transmittance: R,
    internal: [R; 3],
    internal_transmittance: R,
    reflections: R,
}

/// Texel of width `pixel` centered at (x, y).
#[inline(always)]
fn mask_drop_texel<R: Real>(drop: &TracedDrop, pixel: R, x: R, y: R) -> Texel<R> {
    let zero = x.constant(0.0);
    let cut = mask_silhouette_cut(drop, pixel, x, y);
    let traced = zero.less(cut.traced);
    if !zero.any(traced) {
        return Texel {
            direction: [zero; 3],
            coverage: zero,
            reflected: [zero; 3],
            transmittance: zero,
            internal: [zero; 3],
            internal_transmittance: zero,
            reflections: zero,
        };
    }
    let through = mask_trace_through(drop, cut.sample[0], cut.sample[1]);
    let keep = |value: R| R::select(traced, value, zero);
    Texel {
        direction: through.direction.map(keep),
        coverage: keep(cut.coverage),
        reflected: through.reflected.map(keep),
        transmittance: keep(through.transmittance),
        internal: through.internal.map(keep),
        internal_transmittance: keep(through.internal_transmittance),
        reflections: keep(through.reflections),
    }
}

impl Texel<f32> {
    fn store(&self) -> MaskTexel {
        MaskTexel {
            direction: self.direction,
            coverage: self.coverage,
            reflected: self.reflected,
            transmittance: self.transmittance,
            internal: self.internal,
            internal_transmittance: self.internal_transmittance,
            reflections: self.reflections as u32,
            padding: [0; 3],
        }
    }
}

/// Prepares a shape in a view for the tracer; returns it with the mask without its texels.
pub(crate) fn prepare(shape: &DropShape, options: &MaskOptions) -> Result<(TracedDrop, Mask), MaskError> {
    options.check()?;
    let radius = shape.equivalent_radius();
    let wide = shape.max_half_width() / radius;
    let tall = 0.5 * (shape.extent_up() + shape.extent_down()) / radius;
    let drop = TracedDrop {
        coefficients: shape.coefficients(),
        up: options.view.up(),
        index: options.refractive_index,
        inverse_wide: 1.0 / (wide * wide),
        inverse_tall: 1.0 / (tall * tall),
        steps: MASK_TRACE_STEPS,
    };
    let size = f64::from(options.size);
    let mask = Mask {
        size: options.size,
        diameter: shape.diameter(),
        view: options.view,
        refractive_index: options.refractive_index,
        half_extent: wide * size / (size - 2.0),
        texels: Vec::new(),
    };
    Ok((drop, mask))
}

/// Traces the mask of a drop (fast path).
///
/// ```
/// use downpour_drop::DropShape;
/// use downpour_mask::{MaskOptions, trace_drop};
/// let mask = trace_drop(&DropShape::new(2.0e-3)?, &MaskOptions { size: 64, ..MaskOptions::default() })?;
/// let middle = mask.texel(32, 32);
/// assert_eq!(middle.coverage, 1.0);
/// assert!(middle.direction[2] < -0.99); // nearly straight through
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`MaskError::Size`] or [`MaskError::OutOfRange`] if an option is out of range.
pub fn trace_drop(shape: &DropShape, options: &MaskOptions) -> Result<Mask, MaskError> {
    let (drop, mut mask) = prepare(shape, options)?;
    let size = options.size as usize;
    mask.texels = vec![MaskTexel::default(); size * size];
    let pixel = mask.texel_width() as f32;
    mask.texels.par_chunks_mut(size).enumerate().for_each(|(row, texels)| {
        let y = center(size, size - 1 - row, pixel);
        with_widest_lanes(Row { drop: &drop, pixel, y, texels });
    });
    Ok(mask)
}

/// Center of texel `index` of `size`, from the left or from below.
#[inline(always)]
fn center(size: usize, index: usize, pixel: f32) -> f32 {
    (index as f32 + 0.5 - size as f32 * 0.5) * pixel
}

/// One row of a mask, traced with SIMD: the right half, mirrored to the left.
struct Row<'a> {
    drop: &'a TracedDrop,
    pixel: f32,
    y: f32,
    texels: &'a mut [MaskTexel],
}

impl WithLanes for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(mut self, simd: S) {
        let size = self.texels.len();
        let lanes = Lanes::<S>::COUNT;
        debug_assert!(lanes <= MAX_LANES, "a machine with vectors of more than {MAX_LANES} numbers");
        let mut column = size / 2;
        while column < size {
            let count = lanes.min(size - column);
            let mut x = [0.0; MAX_LANES];
            for (k, x) in x[..lanes].iter_mut().enumerate() {
                // Lanes past the edge repeat the last texel.
                *x = center(size, column + k.min(count - 1), self.pixel);
            }
            let texel = mask_drop_texel(
                self.drop,
                Lanes::splat(simd, self.pixel),
                Lanes::load(simd, &x[..lanes]),
                Lanes::splat(simd, self.y),
            );
            self.write(column, count, &texel);
            column += count;
        }
    }
}

impl Row<'_> {
    /// Stores the lanes of `texel` at `column` and, mirrored, on the other side.
    #[inline(always)]
    fn write<S: Simd>(&mut self, column: usize, count: usize, texel: &Texel<Lanes<S>>) {
        let [dx, dy, dz] = texel.direction;
        let [rx, ry, rz] = texel.reflected;
        let [ix, iy, iz] = texel.internal;
        let mut columns = [[0.0f32; MAX_LANES]; 13];
        let fractions =
            [texel.coverage, texel.transmittance, texel.internal_transmittance, texel.reflections];
        let fields = [dx, dy, dz, rx, ry, rz, ix, iy, iz].into_iter().chain(fractions);
        for (field, into) in fields.zip(&mut columns) {
            field.store(into);
        }
        let [
            dx,
            dy,
            dz,
            rx,
            ry,
            rz,
            ix,
            iy,
            iz,
            coverage,
            transmittance,
            internal_transmittance,
            reflections,
        ] = &columns;
        let last = self.texels.len() - 1;
        for k in 0..count {
            let right = MaskTexel {
                direction: [dx[k], dy[k], dz[k]],
                coverage: coverage[k],
                reflected: [rx[k], ry[k], rz[k]],
                transmittance: transmittance[k],
                internal: [ix[k], iy[k], iz[k]],
                internal_transmittance: internal_transmittance[k],
                reflections: reflections[k] as u32,
                padding: [0; 3],
            };
            let mut left = right;
            left.direction[0] = -left.direction[0];
            left.reflected[0] = -left.reflected[0];
            left.internal[0] = -left.internal[0];
            // The center column of an odd size is its own mirror image: the right one is written last.
            self.texels[last - (column + k)] = left;
            self.texels[column + k] = right;
        }
    }
}

/// Traces the mask of a drop with a plain loop over all texels, one at a time: the twin of the GPU kernel.
///
/// # Errors
/// As [`trace_drop`].
pub fn trace_drop_scalar(shape: &DropShape, options: &MaskOptions) -> Result<Mask, MaskError> {
    let (drop, mut mask) = prepare(shape, options)?;
    let size = options.size as usize;
    let pixel = mask.texel_width() as f32;
    mask.texels = (0..size * size)
        .map(|i| {
            let (x, y) = (center(size, i % size, pixel), center(size, size - 1 - i / size, pixel));
            mask_drop_texel(&drop, pixel, x, y).store()
        })
        .collect();
    Ok(mask)
}

/// Traces the mask of a drop in f64, rounded to f32 at the end: the reference for the other two.
///
/// # Errors
/// As [`trace_drop`].
pub fn trace_drop_f64(shape: &DropShape, options: &MaskOptions) -> Result<Mask, MaskError> {
    let (mut drop, mut mask) = prepare(shape, options)?;
    drop.steps = REFERENCE_STEPS;
    let pixel = mask.texel_width();
    mask.texels = (0..options.size)
        .flat_map(|row| (0..options.size).map(move |column| (column, row)))
        .map(|(column, row)| {
            let [x, y] = mask.texel_center(column, row);
            let texel = mask_drop_texel(&drop, pixel, x, y);
            let round = |v: f64| v as f32;
            Texel {
                direction: texel.direction.map(round),
                coverage: round(texel.coverage),
                reflected: texel.reflected.map(round),
                transmittance: round(texel.transmittance),
                internal: texel.internal.map(round),
                internal_transmittance: round(texel.internal_transmittance),
                reflections: round(texel.reflections),
            }
            .store()
        })
        .collect();
    Ok(mask)
}

/// Value of [`MaskTexel::reflections`] for light that does not leave the drop.
pub const LOST: u32 = MASK_TRACE_REFLECTIONS + 1;
